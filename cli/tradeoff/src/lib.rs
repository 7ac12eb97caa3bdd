// SPDX-License-Identifier: MIT OR Apache-2.0
//! What accuracy costs: errors of profiles, predicted and measured, beside latency and area.
//!
//! | module | does |
//! | --- | --- |
//! | [`knobs`] | what of a profile is varied, and within which limits |
//! | [`points`] | slots of a scene: what every profile is tried on |
//! | [`bench`](mod@bench) | those slots with the device's calibration, shared by profiles that differ in words alone |
//! | [`loops`] | what a core changes of force loops and of pads that are served part by part |
//! | [`errors`] | errors of force, capacitance and position, predicted and measured |
//! | [`mod@forecast`] | errors and cost over all scenes, before a core has run |
//! | [`mod@cost`] | latency, and area from the core's own netlist |
//! | [`mod@sweep`] | one knob after the other about a profile |
//! | [`mod@front`] | the points that no other beats |
//! | [`mod@search`] | the cheapest profile for a stated error |
//! | [`mod@model`], [`exact`] | what words add and cost; branch and bound over their lengths |
//! | [`target`] | stated errors |
//! | [`outcome`] | all of it, from names of profile and scenes to rows and the profile that was found |
//! | [`synthesis`] | what synthesis makes of a core, beside the estimate |
//!
//! Errors are the core's against the ideal estimator, which sees the same samples without an ADC's
//! rounding. What the estimator's equations leave of a scene's truth is another matter:
//! `hapticore simulate` tells it.

pub mod bench;
pub mod cost;
pub mod errors;
pub mod exact;
pub mod forecast;
pub mod front;
pub mod knobs;
pub mod loops;
pub mod model;
pub mod outcome;
pub mod points;
pub mod search;
pub mod sweep;
pub mod synthesis;
pub mod target;
