// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[charge]`: charge that gathers in the insulators under a voltage with a mean, so that the
//! attraction drifts.
//!
//!   F_e ∝ (V − V_c)²,   V_c = Σx_i,   τ_i·ẋ_i = s_i·V − x_i
//!
//! V is the source's voltage with its polarity, as `carrier.haptic_wave` has it. A positive share
//! screens the pad, whose attraction decays; under a negative one it rises, as by Johnsen and
//! Rahbek. Under "sine" nothing gathers, and what a start leaves decays; under "square" what one
//! polarity gathers the other takes away. Neither number is known of any device: somebody has to
//! measure them, so they have no default. A sensor of C and V does not see the charge.
//!
//! Between steps and turns the voltage is taken as a line, for which x is exact; a sine over time as
//! lines of 1 ms. A calibration is of insulators without charge. Source: Nakamura and Yamamoto,
//! ROBOMECH Journal 4:18, 2017; docs/physics.md §7.

use super::effect::{Effect, PadEffect};
use super::pad::{Charge, Pad};
use super::spec::{Setting, Spec};
use super::tick::{Tick, slack_s};
use crate::device::{Device, EPSILON_0};
use crate::drive::PadDrive;
use crate::error::SceneError;
use crate::few::Few;
use crate::format::{Key, Limits, Table, keys};
use crate::stimulus::Moment;

/// The most time constants.
const MOST_TRAPS: usize = 4;

/// The longest line that a voltage is taken as, s.
const STEP_S: f64 = 1e-3;

keys! { KEYS:
    /// The charge in the end, as a share of a constant voltage: up to four shares, of 0.99 together at most.
    SHARE: Vec<f64> = Key::one_or_several("share", Limits::within(-10.0, 0.99)).required("a number from -10 to 0.99");
    /// How slowly each share follows the voltage; a list as long as that of shares.
    TIME_CONSTANT_S: Vec<f64> = Key::one_or_several("time_constant_s", Limits::within(1e-9, 1e6))
        .required("a number from 0.000000001 to 1000000");
    /// What each share holds at the start of the case; a list as long as that of shares.
    START_V: Option<Vec<f64>> = Key::one_or_several("start_v", Limits::within(-1e5, 1e5)).usually("0");
}

/// One share of the charge.
#[derive(Clone, Copy, Debug, Default)]
struct Trap {
    share: f64,
    time_constant_s: f64,
    start_v: f64,
}

/// One value per trap.
type Each<T> = Few<T, MOST_TRAPS>;

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("charge")? else { return Ok(None) };
    let traps = read_traps(table)?;
    let pad_m2 = device.pad_area_m2;
    let label = traps
        .iter()
        .map(|trap| format!("{} in {} s", trap.share, trap.time_constant_s))
        .collect::<Vec<_>>()
        .join(", ");
    let build =
        move |_: &Setting| Effect::Pad(Box::new(Charging { traps, pad_m2, pads: Vec::new() }));
    Ok(Spec::new("charge", label, build))
}

fn read_traps(table: &Table) -> Result<Each<Trap>, SceneError> {
    let (shares, times_s) = (table.get(&SHARE)?, table.get(&TIME_CONSTANT_S)?);
    let starts_v = table.get(&START_V)?.unwrap_or_else(|| vec![0.0; shares.len()]);
    if shares.len() > MOST_TRAPS || shares.iter().sum::<f64>() > 0.99 {
        let expected = format!("expected at most {MOST_TRAPS} shares that add up to 0.99 at most");
        return Err(table.error("share", format!("{expected}, got {shares:?}")));
    }
    for (key, found) in [("time_constant_s", times_s.len()), ("start_v", starts_v.len())] {
        if found != shares.len() {
            let expected = format!("expected {}, one for each share", shares.len());
            return Err(table.error(key, format!("{expected}, got {found}")));
        }
    }
    let each = shares.into_iter().zip(times_s).zip(starts_v);
    let trap = |((share, time_constant_s), start_v)| Trap { share, time_constant_s, start_v };
    Ok(each.map(trap).collect())
}

struct Charging {
    traps: Each<Trap>,
    pad_m2: f64,
    pads: Vec<Option<Track>>,
}

/// What a pad's traps hold at a time at which that is kept, V.
#[derive(Clone, Copy, Debug)]
struct Track {
    tick: Tick,
    volts: Each<f64>,
}

impl Charging {
    /// The track that is kept of a pad.
    fn kept(&mut self, index: usize) -> Track {
        if self.pads.len() <= index {
            self.pads.resize(index + 1, None);
        }
        let start = || Track { tick: Tick::default(), volts: self.traps.map(|trap| trap.start_v) };
        self.pads[index].unwrap_or_else(start)
    }

    /// What the traps hold at a later time, before which nothing steps.
    fn at(&self, from: &Track, time_s: f64, drive: &PadDrive) -> Each<f64> {
        let span_s = time_s - from.tick.time_s;
        let volts = [
            drive.signed_v(Moment::at(from.tick.time_s + slack_s(STEP_S))),
            drive.signed_v(Moment::before(time_s)),
        ];
        let traps = self.traps.iter().zip(from.volts);
        traps.map(|(trap, held_v)| trap.after(held_v, volts, span_s)).collect()
    }
}

impl Trap {
    /// What it holds after a time in which the voltage goes from one value to another.
    fn after(&self, held_v: f64, [from_v, to_v]: [f64; 2], span_s: f64) -> f64 {
        let spans = span_s / self.time_constant_s;
        let gone = -(-spans).exp_m1();
        let lag_v = (to_v - from_v) * gone / spans;
        held_v + gone * (self.share * from_v - held_v) + self.share * (to_v - from_v - lag_v)
    }
}

impl PadEffect for Charging {
    /// A calibration is of insulators without charge.
    fn act(&mut self, _: &mut Pad) {}

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        let mut track = self.kept(pad.index);
        let next_event_s = |after_s: f64| drive.next_pull_event_s(after_s);
        while let Some(next) = track.tick.next(STEP_S, pad.time_s, next_event_s) {
            track = Track { volts: self.at(&track, next.time_s, drive), tick: next };
        }
        self.pads[pad.index] = Some(track);
        let ahead = track.tick.ahead_s(STEP_S, pad.time_s).is_some();
        let volts = if ahead { self.at(&track, pad.time_s, drive) } else { track.volts };
        let signed_v = drive.signed_v(Moment::before(pad.time_s));
        let rate =
            |(trap, volt): (&Trap, &f64)| (trap.share * signed_v - volt) / trap.time_constant_s;
        pad.charge = Some(Charge {
            volt: volts.iter().sum(),
            volt_per_s: self.traps.iter().zip(volts.iter()).map(rate).sum(),
            polarity: pad.polarity,
        });
        let pulling_v = pad.pulling_v(pad.haptic_v_rms);
        pad.attraction_n =
            (pad.capacitance_f * pulling_v).powi(2) / (2.0 * EPSILON_0 * self.pad_m2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against Euler's rule at a millionth of the span.
    #[test]
    fn a_trap_follows_a_line_of_voltage_exactly() {
        let trap = Trap { share: -0.4, time_constant_s: 0.3, start_v: 0.0 };
        for (volts, span_s) in
            [([0.0, 350.0], 0.2), ([-350.0, -350.0], 2.0), ([100.0, -50.0], 1e-4)]
        {
            let steps = 1_000_000;
            let step_s = span_s / f64::from(steps);
            let exact = (0..steps).fold(37.0, |held_v, n| {
                let along = (f64::from(n) + 0.5) / f64::from(steps);
                let volt = volts[0] + along * (volts[1] - volts[0]);
                held_v + step_s * (trap.share * volt - held_v) / trap.time_constant_s
            });
            let found = trap.after(37.0, volts, span_s);
            assert!((found - exact).abs() < 3e-4, "{found} {exact}");
        }
    }
}
