// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of the core: scenes, captures and a lab's data in; records and calibrations out. It knows
//! no command line and writes no report.
//!
//! | module | does |
//! | --- | --- |
//! | [`inputs`] | scenes and profiles from names and files |
//! | [`calibrate`] | the calibration of a simulated device |
//! | [`digitiser`] | the one place where fractions of full scale meet codes |
//! | [`engine`] | the core at its three fidelities behind one trait |
//! | [`session`] | slots in, rows out: the core, the reference beside it, rounding errors |
//! | [`maker`] | what a plant gives the core of its slots |
//! | `prefetch` | slots generated on other threads, while the core works on those before |
//! | [`case`] | a case of a scene, run |
//! | [`simulation`], [`replay`] | a whole scene, a whole capture, and the record of it |
//! | [`stepper`] | the same slot by slot, with inputs while it runs |
//! | [`control`] | the force loop of a scene: controller, tuning, and what closes it |
//! | [`criteria`] | what a scene claims, measured |
//! | [`errors`] | rounding errors of every signal |
//! | [`findings`] | what a run leaves to be known at its end: flags, tracking, what limits a drive |
//! | [`capture`] | ADC samples in CSV, WAV and SigMF files |
//! | [`haptic`] | whether the core's window is long enough for the haptic voltage |
//! | [`lab`] | a device's calibration from what a lab measured |
//! | [`silent`] | what no check of a recording can see |
//! | [`wiring`] | whether a recording's channels are the device's: sign, order, gain |
//! | [`record`], [`columns`], [`provenance`] | what a run leaves, its rows as columns, and where it comes from |
//! | [`interrupt`], [`number`] | stopping a run; numbers in messages |

pub mod calibrate;
pub mod capture;
pub mod case;
pub mod columns;
pub mod control;
pub mod criteria;
pub mod digitiser;
pub mod direction;
pub mod engine;
pub mod errors;
pub mod findings;
pub mod haptic;
pub mod inputs;
pub mod interrupt;
pub mod lab;
pub mod maker;
pub mod number;
mod prefetch;
pub mod provenance;
pub mod record;
pub mod replay;
pub mod session;
pub mod silent;
pub mod simulation;
pub mod stepper;
pub mod tuning_file;
pub mod wiring;
