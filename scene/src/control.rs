// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[control]`: a force controller in the place of the scene's haptic voltages.
//!
//! ```toml
//! [[pad]]
//! target_n = { timeline = [[0, 0], [0.5, 0], [0.5, 0.6]] }   # the force that the pad shall have
//!
//! [control]
//! law = "inverse"        # open | proportional | integral | inverse
//! force = "eq8"          # eq8 | table: how the core estimates the force; else as the profile says
//! curve = "steady"       # steady: the voltage that gives a force at rest; square-root: V = K·√F, eq. 9;
//!                        # linear: V = K·F
//! ```
//!
//! The plant does not control: it takes the voltages that somebody sets
//! ([`Plant::set_drive`](crate::Plant::set_drive)). This is what a run is asked to close around it,
//! in volts and newtons. Source: paper, eq. 9 and Fig. 8; docs/physics.md §6.

use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Limits, Table};
use crate::wall::WallPlan;

/// How a drive follows from target and measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlLaw {
    /// The curve alone: eq. 9.
    Open,
    /// The curve and a filtered multiple of the force's error: Fig. 8b.
    Proportional,
    /// The curve, a multiple and an integral of the error of the force's root.
    Integral,
    /// The voltage that gives the target at the capacitance just measured, limited by the curve.
    Inverse,
}

const LAWS: [(&str, ControlLaw); 4] = [
    ("open", ControlLaw::Open),
    ("proportional", ControlLaw::Proportional),
    ("integral", ControlLaw::Integral),
    ("inverse", ControlLaw::Inverse),
];

impl ControlLaw {
    /// Its name in a scene.
    pub fn name(self) -> &'static str {
        LAWS.iter().find(|(_, law)| *law == self).map_or("", |(name, _)| name)
    }
}

/// How a core estimates the force that a controller receives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceEstimate {
    /// Eq. 8, with one constant k.
    Eq8,
    /// Eq. 8, with k from a table over capacitance and past voltage.
    Table,
}

const FORCES: [(&str, ForceEstimate); 2] =
    [("eq8", ForceEstimate::Eq8), ("table", ForceEstimate::Table)];

/// Which voltage goes with a force before anything is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveCurve {
    /// V = K·√F.
    SquareRoot,
    /// V = K·F: with a wall, a voltage that goes with the depth.
    Linear,
    /// The voltage that holds the force in steady state under the nominal load.
    Steady,
}

const CURVES: [(&str, DriveCurve); 3] = [
    ("square-root", DriveCurve::SquareRoot),
    ("linear", DriveCurve::Linear),
    ("steady", DriveCurve::Steady),
];

/// What a curve, a full scale or a cap may be.
const LIMITS: Limits = Limits::within(1e-6, 1e6);

/// The rail where none is given, by what the haptic channel reads: noise and the sensing signal come on top.
const HEADROOM: f64 = 0.95;

/// α where the gain follows from the device: a correction without a filter swings immediately.
const FILTER: f64 = 0.2;

/// The trim's time constant where none is given, s: some milliseconds of pull-in move it little, and five of 0.3 N take 0.14 s.
const TRIM_S: f64 = 0.015;

/// A force controller as a scene asks for it.
///
/// ```
/// use hapticore_scene::{ControlLaw, Scene};
///
/// let text = "title = \"t\"\nduration_s = 1\n[control]\nrail_v = 400\n\
///             [[pad]]\nposition_mm = [0, 0]\ntarget_n = 0.3\n";
/// let control = Scene::parse(text, "t.toml", &[])?.cases[0].control.clone().unwrap();
/// assert_eq!((control.law, control.rail_v, control.feed_forward_v), (ControlLaw::Inverse, 400.0, None));
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ControlPlan {
    /// How a drive follows from target and measurement.
    pub law: ControlLaw,
    /// How the core estimates the force, where not as its profile says.
    pub force: Option<ForceEstimate>,
    /// Which voltage goes with a force.
    pub curve: DriveCurve,
    /// Factor on the curve's voltage; with the inverse law, how far beyond the curve the drive may
    /// go.
    pub curve_factor: f64,
    /// Load at which the steady curve is measured, g. None where it is that of the case's pads.
    pub nominal_load_g: Option<f64>,
    /// K of eq. 9, V/√N; of a linear curve, V/N. None where it follows from the device's steady curve.
    pub feed_forward_v: Option<f64>,
    /// Gain of the error: V/N with `proportional`, V/√N with `integral`. None where it follows from device and profile.
    pub proportional_v: Option<f64>,
    /// α, the share of the correction that a frame takes on.
    pub filter: f64,
    /// With `inverse` the time constant of the trim to the force that is read, s, at 1 N: 1/√F times as long at F. No
    /// trim where it is zero.
    pub trim_s: f64,
    /// Integral gain, V/(√N·s). None where it follows from device and profile.
    pub integral_v: Option<f64>,
    /// The drive's full scale, V rms.
    pub full_scale_v: f64,
    /// The largest drive, V rms.
    pub rail_v: f64,
    /// The largest change of a drive from frame to frame, V rms.
    pub slew_v: f64,
    /// A measured force beyond it takes every drive to zero, N.
    pub force_cap_n: f64,
    /// The walls, where the scene has them.
    pub wall: Option<WallPlan>,
}

impl ControlPlan {
    /// Whether its law or its curve has gains, given or computed.
    pub fn has_gains(&self) -> bool {
        self.law != ControlLaw::Inverse || self.curve != DriveCurve::Steady
    }

    /// The table, where there is one.
    pub(crate) fn read(root: &Table, device: &Device) -> Result<Option<ControlPlan>, SceneError> {
        let Some(table) = root.table("control")? else { return Ok(None) };
        let number = |key, default| table.number_or(key, LIMITS, default);
        let law = table.word("law", &LAWS)?.unwrap_or(ControlLaw::Inverse);
        let inverse = law == ControlLaw::Inverse;
        let curve = if inverse { DriveCurve::Steady } else { DriveCurve::SquareRoot };
        let full_scale_v = number("full_scale_v", 500.0)?;
        let within = Limits::within(1e-6, full_scale_v);
        let proportional_v = table.number("proportional_v", Limits::within(0.0, 1e5))?;
        let integral_v = table.number("integral_v", Limits::within(0.0, 1e7))?;
        let computed = proportional_v.is_none() && law == ControlLaw::Proportional;
        let filter = if computed { FILTER } else { 1.0 };
        Ok(Some(ControlPlan {
            law,
            force: table.word("force", &FORCES)?,
            curve: table.word("curve", &CURVES)?.unwrap_or(curve),
            curve_factor: number("curve_factor", if inverse { 1.13 } else { 1.0 })?,
            nominal_load_g: table.number("nominal_load_g", Limits::within(0.0, 1e5))?,
            feed_forward_v: table.number("feed_forward_v", LIMITS)?,
            proportional_v,
            filter: table.number_or("filter", Limits::above(0.0, 1.0), filter)?,
            trim_s: table.number_or("trim_s", Limits::within(0.0, 1e3), TRIM_S)?,
            integral_v,
            rail_v: table.number_or(
                "rail_v",
                within,
                full_scale_v.min(HEADROOM * device.readable_v()),
            )?,
            slew_v: table.number_or("slew_v", within, full_scale_v)?,
            force_cap_n: number("force_cap_n", 1e6)?,
            wall: WallPlan::read(root)?,
            full_scale_v,
        }))
    }
}
