// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reports: the page of a run (`hapticore_report`) and, drawn by the same parts, those of other commands.
//!
//! | module | the page of |
//! | --- | --- |
//! | `calibration` | a device's calibration |
//! | `tradeoff` | what accuracy costs |
//! | [`sweep_plan`] | a plan of many points |

mod calibration;
pub mod sweep_plan;
mod tradeoff;

pub use calibration::of_calibration;
pub use hapticore_report::html;
use hapticore_report::{axis, fig3_maps, figure, map, number, page, paint, plot, series, tables};
pub use sweep_plan::of_sweep;
pub use tradeoff::of_tradeoff;
