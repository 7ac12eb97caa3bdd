// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a PC beside a board needs, and nothing else: no simulator, no command, no Verilog.
//!
//! A board sends bytes. This library finds packets in them, converts the core's words to volts,
//! picofarads, millimetres and newtons, and cancels the crosstalk of the pads. In the other
//! direction it sends a device's calibration to the board.
//!
//! ```text
//! board ─ bytes ─ Decoder ─ Packet ─ Readout ─ Quantities, flags
//!   │                                     ├─ Units, CrosstalkCanceller, Placement
//!   └─ bytes ─ encode ─ Command ─ startup ┴─ DeviceCalibration ─ mine.toml
//! ```
//!
//! | module | does |
//! | --- | --- |
//! | [`decoder`], [`packet`] | messages from bytes: frames, heartbeats, and what was damaged |
//! | [`command`], [`startup`] | bytes to the board: calibration, ADC, on and off; whether it took them |
//! | [`command_decoder`] | the board's side of commands |
//! | [`bringup`] | all of that step by step, with a test of the ADC's data lines |
//! | [`link`] | a serial port or a connection that is kept open, with a board that is brought up and armed over it |
//! | [`ad7606c`] | the ADC's registers, for programs that stand in for a board |
//! | [`air_hockey`] | a game on the frames of pads: puck, impacts, walls |
//! | [`drive`] | bytes to a board that drives its pads: tuning, targets, walls |
//! | [`device`], [`residual`] | the calibration of a device: its file, its words for a core, how well its table fits |
//! | [`profile`] | the core's profile, for the terminals and pads of a device |
//! | [`units`], [`quantities`] | physical units; the one list of what a slot measures |
//! | [`typed`] | words as numbers of the crate `fixed`, for programs that compute without floating point |
//! | [`crosstalk`] | what other pads did to a measurement, taken out |
//! | [`placement`] | pads at the edge, pads that touch |
//! | [`readout`] | all of that in one: a frame to a row of `frames.csv` |
//!
//! The numbers of the line itself (framing, registers, version) are `hapticore-protocol`'s, which
//! the gateware shares.
//!
//! # A first example
//!
//! A recording of four pads on a board, as a serial line gave it:
//!
//! ```
//! use hapticore_host::{Decoder, DeviceCalibration, Readout, profile};
//!
//! let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
//! let profile = device.profile(&profile::load("small")?)?;
//! let mut readout = Readout::new(&profile, &device);
//! let mut decoder = Decoder::new(&profile);
//! let bytes = std::fs::read("recordings/hockey.bin")?;
//! let frames = decoder.decode(bytes).filter_map(|message| message.ok()?.frame());
//! let measurements = frames.map(|packet| packet.frame.measurement(&profile));
//! let forces: Vec<f64> = measurements.map(|slot| readout.convert(&slot).0.force_n).collect();
//! assert_eq!(forces.len(), 5);
//! assert!(forces.iter().all(|newton| (0.0..0.5).contains(newton)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `examples/board_to_csv.rs` is the same as a program: bytes on standard input, CSV on standard
//! output.

pub mod ad7606c;
pub mod air_hockey;
pub mod bringup;
pub mod command;
pub mod command_decoder;
pub mod crosstalk;
pub mod decoder;
pub mod device;
pub mod drive;
#[cfg(test)]
mod garbled;
pub mod laws;
mod line;
pub mod link;
pub mod packet;
pub mod placement;
pub mod profile;
pub mod quantities;
pub mod readout;
pub mod residual;
pub mod startup;
pub mod text;
pub mod typed;
pub mod units;

pub use command::{Command, encode};
pub use command_decoder::{CommandDecoder, Refused};
pub use crosstalk::{
    CrosstalkCanceller, NominalSheet, PadEstimate, Ratios, SheetModel, UniformSheet,
};
pub use decoder::Decoder;
pub use device::{DeviceCalibration, DeviceError, Found, Raster, Scales, Signs, found, open_share};
pub use laws::{ForceLaws, Laws};
pub use line::Damage;
pub use packet::{Driven, Heartbeat, Message, Packet, Status};
pub use placement::Placement;
pub use profile::LoadProfileError;
pub use quantities::{QUANTITIES, Quantities, Quantity, quantity};
pub use readout::{COLUMNS, Readout};
pub use residual::Residual;
pub use typed::{Word, WordError};
pub use units::{SlotClock, Units, flag_names};

pub use hapticore_contract::calibration::Calibration;
pub use hapticore_contract::control;
pub use hapticore_contract::frame::{Field, Flags, Frame, Measurement};
pub use hapticore_contract::profile::{Profile, ProfileError};
pub use hapticore_protocol::framing::{END, VERSION, digest};
pub use hapticore_protocol::output::{Dac, Output, Wave};
pub use hapticore_protocol::{
    CalibrationWords, Constant, ConstantWord, DriveWord, Register, Request, Setting, WordFormats,
};
