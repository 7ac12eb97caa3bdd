// SPDX-License-Identifier: MIT OR Apache-2.0
//! The plant of an electrostatic visuo-haptic display, simulated in SI units and `f64`: sheet, gap,
//! friction, carrier and sensor chain, each an opt-in effect, and the scenes that say what is done
//! with it. It gives what an ADC at the display would see, and beside it the truth that a sensing
//! core has to find.
//!
//! A scene is TOML. Whatever effect has no table in it is not there: no state, no cost.
//! [`Scene::parse`] reads and checks it, [`Plant::new`] sets one of its cases up for a core's
//! [`Timing`], and from then on slots are asked for one after the other:
//!
//! ```
//! use hapticore_scene::{Complex, Plant, Scene, Timing};
//!
//! let text = r#"
//!     title = "A pad of 318 pF on a sheet with six terminals"
//!     [[pad]]
//!     position_mm = [120, -60]
//!     haptic_v_rms = 150
//!     [sheet]
//!     ohm_per_square = 150
//! "#;
//! let scene = Scene::parse(text, "my.toml", &[])?;
//! let timing = Timing {
//!     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
//! };
//! let mut plant = Plant::new(&scene, 0, &timing)?;
//!
//! // The truth of the first slot …
//! let truth = plant.truth(0);
//! assert_eq!((truth.x_mm, truth.y_mm), (120.0, -60.0));
//! assert!(truth.r_x > 0.0 && truth.r_y < 0.0 && (72.0..190.0).contains(&truth.sheet_ohm));
//! // … what a demodulator finds of it: six terminals, then the sensing voltage, in fractions of full scale …
//! let mut phasors = [Complex::default(); 7];
//! plant.phasors(0, &mut phasors);
//! let total: Complex = phasors[..6].iter().sum();
//! assert!((total.norm() * 4e-3 - 1e-3).abs() < 1e-5); // 1 mA of a full scale of 4 mA: 5 V through 5 kΩ
//! // … and its samples, eight channels at each instant.
//! let mut samples = Vec::new();
//! plant.samples(0, 700..1700, &mut samples);
//! assert_eq!(samples.len(), 8 * 1000);
//! # Ok::<(), hapticore_scene::SceneError>(())
//! ```
//!
//! | to | see |
//! | --- | --- |
//! | read a scene, choose its fidelity by an error budget | [`Scene`], [`Case`], [`SceneError`] |
//! | run a case: truth, phasors, ADC samples, calibrations | [`Plant`], [`Slot`], [`Truth`], [`Timing`], [`EffectCost`] |
//! | drive a pad by a controller or a recording | [`Plant::set_drive`], [`DriveError`] |
//! | move a pad's finger, press and push the pad while a case runs | [`Plant::lead`], [`Plant::release`], [`Plant::press`], [`Plant::push`] |
//! | know the display that a scene describes | [`Device`], [`signs_by_place`] |
//! | name a quantity, its unit and its truth | [`Quantity`] |
//! | know what a scene claims | [`Criterion`], [`Measure`] |
//! | know the force loop, the walls and the game that a scene asks for | [`ControlPlan`], [`WallPlan`], [`ArenaPlan`] |
//! | start from a bundled scene | [`gallery`] |
//! | know every table and key of a scene | [`mod@reference`] |
//!
//! Inside, from the bottom up:
//!
//! | modules | what they hold |
//! | --- | --- |
//! | `error`, `format` | messages with file, line and key; TOML as a tree that knows which keys were read |
//! | `terminals`, `device`, `ratios` | where the terminals are, sizes and full scales, signs of the ratios |
//! | `stimulus`, `trajectory`, `pad`, `pad_inputs`, `input_limits`, `drive` | what a pad does over a sweep or over time, or is made to do |
//! | `effects` | one file or folder for each effect; `effects::EFFECTS` is the list of all |
//! | `case`, `head`, `scene`, `criterion`, `quantity` | a scene as it is read |
//! | `reference` | all tables with their keys |
//! | `plant`, `budget`, `nominal` | a case at work; errors of the fidelity levels; the sheet as its host knows it |
//!
//! The plant knows no bit widths of the core and writes no file.

mod arena;
mod budget;
mod case;
mod control;
mod criterion;
mod device;
mod doubts;
mod drive;
mod effects;
mod error;
mod few;
mod format;
pub mod gallery;
mod head;
mod input_limits;
mod nominal;
mod pad;
mod pad_inputs;
mod plant;
mod quantity;
mod random;
mod ratios;
pub mod reference;
mod rotor;
mod scene;
mod stimulus;
mod suggest;
mod terminals;
mod threads;
mod timing;
mod trajectory;
mod truth;
mod variant;
mod wall;
mod wave;

pub use arena::ArenaPlan;
pub use budget::LevelDeviation;
pub use case::Case;
pub use control::{ControlLaw, ControlPlan, DriveCurve, ForceEstimate};
pub use criterion::{Criterion, Measure, Per, Where};
pub use device::{Device, EPSILON_0};
pub use effects::{Compression, EffectCost};
pub use error::{Place, SceneError};
pub use head::{Figure, Record};
pub use input_limits::DriveError;
pub use nominal::NominalSheet;
pub use num_complex::Complex64 as Complex;
pub use pad::DEFAULT_LOAD_G;
pub use pad_inputs::{FingerPath, Line};
pub use plant::{Plant, Slot};
pub use quantity::Quantity;
pub use ratios::signs_by_place;
pub use scene::Scene;
pub use suggest::did_you_mean;
pub use terminals::{LEAST_TERMINALS, MOST_TERMINALS, PerTerminal};
pub use timing::Timing;
pub use truth::{ForcePoint, MapPoint, PadMeasurement, Setpoint, Truth};
pub use wall::{WallAlongY, WallPlan, WallRule};
pub use wave::HapticWave;
