// SPDX-License-Identifier: MIT OR Apache-2.0
//! What core, reference, host and boards agree on: word lengths and timings, the words of a frame,
//! the numbers of a calibration.
//!
//! | module | holds |
//! | --- | --- |
//! | [`profile`] | word formats, counts and timings of a core, from TOML; `small`, `standard`, `fine` and `fast` are bundled |
//! | [`frame`] | the words that a core gives for each slot: order, formats, and the numbers that they stand for |
//! | [`control`] | the force controller: its law and formats, the numbers that tune it |
//! | [`calibration`] | what makes a core the sensor of a device: the position table and two gains |
//! | [`format`](mod@format) | number formats, of the hardware language |
//!
//! Quantities are in the core's own units:
//!
//! | quantity | unit |
//! | --- | --- |
//! | currents, sensing voltage, haptic voltage | full scale of the ADC |
//! | ratios r_x, r_y | 1: shares of the total current |
//! | positions | mm from the middle of the sheet, x along the long edges |
//! | resistance of the sheet | full scales of voltage per full scale of current |
//! | capacitance; force | pF; N |
//! | times | clocks of the core, or samples of the ADC |
//!
//! Absent: blocks, clocks, files. A core of a profile is built by `hapticore-model`, whose `check`
//! also asks the blocks; what a core should find follows from the equations in
//! `hapticore-reference`. Neither is known here.
//!
//! A frame of a board with the bundled profile `small`, as numbers:
//!
//! ```
//! use hapticore_contract::frame::{Field, Flags, Frame};
//! use hapticore_contract::profile::Profile;
//!
//! let profile = Profile::bundled("small")?;
//! // Eight words, integers, as they come over the line.
//! let frame = Frame { pad: 2, codes: [13107, -6554, 3200, -1600, 1500, 4096, 512, 900], flags: Flags::default() };
//! let measurement = frame.measurement(&profile);
//!
//! assert_eq!(Field::X.format(&profile).to_string(), "s16.5");
//! assert_eq!((measurement.x_mm, measurement.y_mm), (100.0, -50.0));
//! assert!((measurement.r_x - 0.8).abs() < 1e-4 && !measurement.flags.invalid);
//! # Ok::<(), hapticore_contract::profile::ProfileError>(())
//! ```

pub mod calibration;
pub mod control;
pub mod frame;
pub mod profile;

/// Number formats alone: who depends on the contract, as the reference does, sees nothing else of
/// the hardware language.
pub use hapticore_hdl::format;
