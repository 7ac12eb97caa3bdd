// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[[pad]]`: what one pad does. A sweep runs over all combinations of what is swept, the position
//! fastest, then the load, the haptic voltage, the capacitance and the eccentricity.

use crate::device::{Device, EPSILON_0};
use crate::effects::pad::{FilmChange, Pad};
use crate::effects::sheet::ideal::ideal_split;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::input_limits::{LOAD, PUSH, VOLTAGE};
use crate::stimulus::{Moment, Stimulus, next_multiple};
use crate::trajectory::{self, SLACK_MM, Trajectory};
use crate::truth::Setpoint;

/// Capacitance of a pad that neither names one nor has a gap, pF: 5 kΩ at 100 kHz.
const CAPACITANCE_PF: f64 = 318.0;

/// The load on a pad that names none, g.
pub const DEFAULT_LOAD_G: f64 = 20.0;

keys! { KEYS:
    /// The pad's name, by which overrides know it.
    NAME: Option<String> = Key::text("name").usually("pad and its number");
    /// Mass that presses the pad.
    LOAD_G: Stimulus = Key::stimulus("load_g", LOAD).or(DEFAULT_LOAD_G);
    /// Haptic voltage of the source; with `[control]` a pad has `target_n` instead.
    HAPTIC_V_RMS: Stimulus = Key::stimulus("haptic_v_rms", VOLTAGE).or(0.0);
    /// Capacitance between pad and sheet, where no `[gap]` decides it.
    CAPACITANCE: Stimulus = Key::stimulus("capacitance_pf", Limits::above(0.0, 1e6)).or(CAPACITANCE_PF);
    /// Eccentricity of the push, right of the pad's centre, at most a quarter of its diameter; with `[halves]`.
    ECCENTRICITY_MM: Stimulus = Key::stimulus("eccentricity_mm", Limits::within(-2.5e3, 2.5e3)).or(0.0);
    /// The force that the pad shall have; with `[control]`.
    TARGET_N: Option<Stimulus> = Key::over_time("target_n", Limits::within(0.0, 100.0)).usually("0");
    /// A push along x besides the finger's; with `[hand]`.
    PUSH_X_N: Option<Stimulus> = Key::over_time("push_x_n", PUSH).usually("0");
    /// A push along y besides the finger's; with `[hand]`.
    PUSH_Y_N: Option<Stimulus> = Key::over_time("push_y_n", PUSH).usually("0");
}

/// What one pad does: its trajectory and its stimuli.
#[derive(Clone, Debug)]
pub(crate) struct PadPlan {
    pub name: String,
    trajectory: Trajectory,
    load_g: Stimulus,
    haptic_v_rms: Stimulus,
    capacitance_pf: Stimulus,
    eccentricity_mm: Stimulus,
    /// The force that a controller shall give; zero without one.
    target_n: Stimulus,
    /// Along x and y; a pad without a finger is not pushed.
    push_n: [Stimulus; 2],
    /// Its insulators charge, so that a turn of the haptic voltage's polarity changes what pulls it.
    pub charges: bool,
    /// How far from the sheet's centre its centre may be, mm.
    pub reach_mm: [f64; 2],
    /// A finger moves it, so that pushes act on it.
    pub has_finger: bool,
}

impl PadPlan {
    pub fn read(
        table: &Table,
        index: usize,
        device: &Device,
        has: Tables,
    ) -> Result<PadPlan, SceneError> {
        if has.gap && table.has(&CAPACITANCE) {
            return Err(table.error(
                "capacitance_pf",
                "expected no capacitance of its own, since [gap] decides it",
            ));
        }
        let push = |key| match has.finger {
            true => over_time(table, key, "a push"),
            false => Ok(Stimulus::Constant(0.0)),
        };
        let reach_mm = device.electrode_offset_mm();
        let eccentricity_mm = match has.split_electrode {
            true => table.get(&ECCENTRICITY_MM.within(Limits::within(-reach_mm, reach_mm)))?,
            false => Stimulus::Constant(0.0),
        };
        let target_n = read_target(table, has)?;
        Ok(PadPlan {
            eccentricity_mm,
            target_n,
            push_n: [push(&PUSH_X_N)?, push(&PUSH_Y_N)?],
            charges: has.charge,
            reach_mm: trajectory::reach_mm(table, device)?,
            has_finger: has.finger,
            name: table.get(&NAME)?.unwrap_or_else(|| format!("pad {index}")),
            trajectory: Trajectory::read(table, device)?,
            load_g: table.get(&LOAD_G)?,
            haptic_v_rms: table.get(&HAPTIC_V_RMS)?,
            capacitance_pf: table.get(&CAPACITANCE)?,
        })
    }

    fn stimuli(&self) -> [&Stimulus; 7] {
        let ([x, y], target) = (&self.push_n, &self.target_n);
        [
            &self.load_g,
            &self.haptic_v_rms,
            &self.capacitance_pf,
            &self.eccentricity_mm,
            target,
            x,
            y,
        ]
    }

    /// Points of the whole sweep; one where nothing is swept.
    pub fn points(&self) -> usize {
        let points = self.stimuli().into_iter().map(Stimulus::points);
        points.fold(self.trajectory.points(), usize::saturating_mul)
    }

    /// Whether anything depends on time.
    pub fn moves(&self) -> bool {
        self.trajectory.moves() || self.stimuli().into_iter().any(Stimulus::moves)
    }

    /// Points that differ in position alone are one group.
    pub fn group(&self, point: usize) -> usize {
        point % self.points() / self.trajectory.points()
    }

    /// The keys that are swept, as [`Setpoint::get`] knows them.
    pub fn swept(&self) -> Vec<&'static str> {
        let stimuli = [
            ("load_g", &self.load_g),
            ("haptic_v_rms", &self.haptic_v_rms),
            ("capacitance_pf", &self.capacitance_pf),
            ("eccentricity_mm", &self.eccentricity_mm),
        ];
        let place = ["x_mm", "y_mm"].into_iter().filter(|_| self.trajectory.points() > 1);
        place
            .chain(
                stimuli
                    .into_iter()
                    .filter(|(_, stimulus)| stimulus.points() > 1)
                    .map(|(key, _)| key),
            )
            .collect()
    }

    /// What the pad is set to.
    pub fn set(&self, point: usize, moment: Moment) -> Setpoint {
        let [x_mm, y_mm] = self.trajectory.at(point, moment.time_s);
        let [load, haptic, capacitance, eccentricity] = self.swept_values(point);
        Setpoint {
            x_mm,
            y_mm,
            load_g: self.load_g.at(load, moment),
            haptic_v_rms: self.haptic_v_rms.at(haptic, moment),
            capacitance_pf: self.capacitance_pf.at(capacitance, moment),
            eccentricity_mm: self.eccentricity_mm.at(eccentricity, moment),
            target_n: self.target_n(moment),
        }
    }

    /// Load, haptic voltage and eccentricity of what the pad is set to: what moves its gap.
    pub fn set_of_gap(&self, point: usize, moment: Moment) -> [f64; 3] {
        let [load, haptic, _, eccentricity] = self.swept_values(point);
        [
            self.load_g.at(load, moment),
            self.haptic_v_rms.at(haptic, moment),
            self.eccentricity_mm.at(eccentricity, moment),
        ]
    }

    /// Which value of load, haptic voltage, capacitance and eccentricity a point of the sweep has,
    /// up to multiples of their numbers.
    fn swept_values(&self, point: usize) -> [usize; 4] {
        if point == 0 {
            return [0; 4];
        }
        let load = point / self.trajectory.points();
        let haptic = load / self.load_g.points();
        let capacitance = haptic / self.haptic_v_rms.points();
        [load, haptic, capacitance, capacitance / self.capacitance_pf.points()]
    }

    /// Whether anything pushes the pad off its centre, besides a hand.
    pub fn is_pushed_off_centre(&self) -> bool {
        self.eccentricity_mm.extremes().into_iter().any(|mm| mm != 0.0)
    }

    /// The force that a controller shall give, N.
    pub fn target_n(&self, moment: Moment) -> f64 {
        self.target_n.at(0, moment)
    }

    /// The largest force that a controller shall give at any time, N.
    pub fn largest_target_n(&self) -> f64 {
        self.target_n.extremes().into_iter().fold(0.0, f64::max)
    }

    /// The load halfway between the least and the largest that the scene ever sets, g.
    pub fn middle_load_g(&self) -> f64 {
        let loads_g = self.load_g.extremes();
        let least_g = loads_g.iter().copied().fold(f64::INFINITY, f64::min);
        let largest_g = loads_g.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        0.5 * (least_g + largest_g)
    }

    /// The largest capacitance that the scene ever sets the pad to, pF; none where it sets none.
    pub fn set_capacitance_pf(&self) -> Option<f64> {
        let is_set = self.capacitance_pf != Stimulus::Constant(CAPACITANCE_PF);
        is_set.then(|| self.capacitance_pf.extremes().into_iter().fold(0.0, f64::max))
    }

    /// What pushes the pad besides its finger, N.
    pub fn push_n(&self, moment: Moment) -> [f64; 2] {
        [0, 1].map(|axis| self.push_n[axis].at(0, moment))
    }

    /// When the source's voltage next steps or turns.
    pub fn next_voltage_event_s(&self, after_s: f64) -> f64 {
        self.haptic_v_rms.next_event_s(after_s)
    }

    /// When the load next steps or turns.
    pub fn next_load_event_s(&self, after_s: f64) -> f64 {
        self.load_g.next_event_s(after_s)
    }

    /// When next the push leaves the centre otherwise, or a sweep sets load, voltage or eccentricity
    /// anew, whose points last `point_s` each.
    pub fn next_pressure_event_s(&self, after_s: f64, point_s: f64) -> f64 {
        let swept = [&self.load_g, &self.eccentricity_mm, &self.haptic_v_rms];
        let set_anew = if swept.into_iter().any(|s| s.points() > 1) {
            next_multiple(point_s * self.trajectory.points() as f64, after_s)
        } else {
            f64::INFINITY
        };
        self.eccentricity_mm.next_event_s(after_s).min(set_anew)
    }

    /// When the pad next turns back on its trajectory.
    pub fn next_turn_s(&self, after_s: f64, least_s: f64) -> f64 {
        self.trajectory.next_turn_s(after_s, least_s)
    }

    /// When what pushes the pad next steps or turns.
    pub fn next_push_event_s(&self, after_s: f64) -> f64 {
        let [x, y] = &self.push_n;
        x.next_event_s(after_s).min(y.next_event_s(after_s))
    }

    /// When next the pad is placed anew, or its capacitance steps or turns.
    pub fn next_motion_event_s(&self, after_s: f64, point_s: f64) -> f64 {
        let placed =
            if self.points() > 1 { next_multiple(point_s, after_s) } else { f64::INFINITY };
        placed.min(self.capacitance_pf.next_event_s(after_s))
    }
}

/// The pad before any effect: an even gap on an ideal sheet.
pub(crate) fn pad_as_set(
    index: usize,
    time_s: f64,
    set: &Setpoint,
    push_n: [f64; 2],
    device: &Device,
) -> Pad {
    let (place, capacitance_f) = ([set.x_mm, set.y_mm], 1e-12 * set.capacitance_pf);
    Pad {
        eccentricity_mm: set.eccentricity_mm,
        push_n,
        ..still(index, time_s, place, set.load_g, set.haptic_v_rms, capacitance_f, device)
    }
}

/// A stimulus that is not swept; zero where there is none.
pub(crate) fn over_time(
    table: &Table,
    key: &Key<Option<Stimulus>>,
    what: &str,
) -> Result<Stimulus, SceneError> {
    let stimulus = table.get(key)?.unwrap_or(Stimulus::Constant(0.0));
    match stimulus.points() {
        1 => Ok(stimulus),
        points => Err(table.error(
            key.about.name,
            format!("expected {what} over time, got a sweep of {points} points"),
        )),
    }
}

/// A target force, over time only; a pad with one has no voltage of its own.
fn read_target(table: &Table, has: Tables) -> Result<Stimulus, SceneError> {
    if !has.control {
        return Ok(Stimulus::Constant(0.0));
    }
    if table.has(&HAPTIC_V_RMS) {
        let message = "expected none, since [control] decides it; a pad has target_n instead";
        return Err(table.error("haptic_v_rms", message));
    }
    over_time(table, &TARGET_N, "a force")
}

/// The tables of a scene that give a pad's keys their meaning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tables {
    pub gap: bool,
    pub finger: bool,
    pub split_electrode: bool,
    pub control: bool,
    pub charge: bool,
}

/// A resting pad, for a calibration.
pub(crate) fn resting(at_mm: [f64; 2], load_g: f64, haptic_v_rms: f64, device: &Device) -> Pad {
    still(0, 0.0, at_mm, load_g, haptic_v_rms, CAPACITANCE_PF * 1e-12, device)
}

/// A resting pad, as far as a frame describes it.
pub(crate) fn pad_of_frame(at_mm: [f64; 2], capacitance_pf: f64, device: &Device) -> Pad {
    still(0, 0.0, at_mm, 0.0, 0.0, capacitance_pf * 1e-12, device)
}

fn still(
    index: usize,
    time_s: f64,
    at: [f64; 2],
    load_g: f64,
    haptic_v_rms: f64,
    capacitance_f: f64,
    device: &Device,
) -> Pad {
    let reach_mm = device.reach_mm();
    let attraction_n =
        (capacitance_f * haptic_v_rms).powi(2) / (2.0 * EPSILON_0 * device.pad_area_m2);
    Pad {
        index,
        part: None,
        time_s,
        x_mm: at[0],
        y_mm: at[1],
        load_g,
        source_v_rms: haptic_v_rms,
        supply: None,
        haptic_v_rms,
        capacitance_f,
        attraction_n,
        uneven: false,
        force_n: None,
        eccentricity_mm: 0.0,
        direction: 0.0,
        polarity: 0.0,
        charge: None,
        stiffness: 1.0,
        electrodes_f: [0.0; 4],
        hand_n: [0.0; 2],
        push_n: [0.0; 2],
        finger: None,
        friction_n: 0.0,
        film: FilmChange::NONE,
        split: ideal_split(at[0], at[1], device),
        sheet_ohm: 0.0.into(),
        transfer: None,
        leakage_of_others_a: None,
        over_edge: at[0].abs() > reach_mm[0] + SLACK_MM || at[1].abs() > reach_mm[1] + SLACK_MM,
        touching: false,
    }
}
