// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bench on which a simulated device is calibrated: its gap, friction and supply alone, under
//! loads and voltages of its own, so that nothing that a scene judges is ever seen.
//!
//! | readings | loads, g | voltage, V rms |
//! | --- | --- | --- |
//! | settled | 20, 100 | 18 from 60 to 400, up and down |
//! | steps of 4 s, 98 readings each, evenly over the logarithm of time | 20, 100, 100 | 350, 350, 400 |
//! | rise and fall of 0.5 s, as half a sine, 72 readings each, evenly | 20, 100 | 400 |
//!
//! As many as a laboratory takes, 510, of one gap that moves: a table that has seen no voltage fall
//! gradually reads a force that falls too high. Of a gap without time (`static`) the settled readings on the
//! way up, for the way down is another device's.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use hapticore_contract::profile::Profile;
use hapticore_host::device::{RECENT_S, RELEASE_V};
use hapticore_scene::{Plant, Scene, Timing, Truth};
use toml::{Table, Value};

use crate::interrupt;
use crate::lab::force_table::Reading;

/// Loads of settled readings, g.
const LOADS_G: [f64; 2] = [20.0, 100.0];
/// Load and voltage of steps.
const STEPS: [[f64; 2]; 3] = [[20.0, 350.0], [100.0, 350.0], [100.0, 400.0]];
/// Readings of a step.
const OF_STEP: usize = 98;
/// Slots of a step: one a millisecond.
const STEP_SLOTS: usize = 4000;
/// Load and largest voltage of rises and falls.
const SINES: [[f64; 2]; 2] = [[20.0, 400.0], [100.0, 400.0]];
/// Slots of a rise and fall, one a millisecond, and of how many of them one is read.
const SINE_SLOTS: usize = 500;
const SINE_EVERY: usize = 7;
/// Slots that each settled voltage is held for.
const HELD: usize = 4;

/// Tables of a scene that decide its forces.
const TABLES: [&str; 6] = ["device", "gap", "friction", "supply", "temperature", "calibration"];

/// Keys of `[carrier]` that decide how much of the voltage a supply lets through.
const WAVE: [&str; 3] = ["haptic_hz", "haptic_wave", "haptic_turn_s"];

/// A simulated device on the bench.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    tables: Table,
    wave: Table,
    /// With a controller a gap moves unless its level says otherwise.
    is_controlled: bool,
}

impl Bench {
    /// The device of a scene, as TOML; none where it has no gap, for then eq. 8 holds exactly.
    ///
    /// # Errors
    /// A text that is no TOML.
    pub fn of(scene: &str) -> Result<Option<Bench>> {
        let mut scene: Table = toml::from_str(scene).context("the scene of a case")?;
        let carrier = scene.get("carrier").and_then(Value::as_table);
        let of_wave = |key: &&str| Some((key.to_string(), carrier?.get(*key)?.clone()));
        let wave: Table = WAVE.iter().filter_map(of_wave).collect();
        let tables: Table = TABLES.iter().filter_map(|key| scene.remove_entry(*key)).collect();
        let is_controlled = scene.contains_key("control");
        let has_gap = tables.contains_key("gap");
        Ok(has_gap.then_some(Bench { tables, wave, is_controlled }))
    }

    /// Whether the gap has no time of its own.
    pub fn is_static(&self) -> bool {
        let level = self.tables["gap"].get("rung").and_then(Value::as_str);
        level.map_or(!self.is_controlled, |level| level == "static")
    }

    /// What one pad reads in slots of a millisecond, while its voltage steps as told.
    ///
    /// # Errors
    /// A device that cannot be.
    pub fn record(
        &self,
        level: &str,
        load_g: f64,
        steps: &[[f64; 2]],
        slots: usize,
    ) -> Result<Vec<Truth>> {
        let mut scene = self.tables.clone();
        // What the device was when it was calibrated is what stands on the bench.
        scene.remove("calibration");
        let mut gap = scene["gap"].as_table().cloned().unwrap_or_default();
        gap.insert("rung".into(), level.into());
        gap.remove("drive");
        if level != "tr-bdf2" {
            gap.remove("step_us");
        }
        scene.insert("gap".into(), gap.into());
        scene.insert(
            "friction".into(),
            Table::from_iter([("rung".into(), "coulomb".into())]).into(),
        );
        scene.insert("carrier".into(), self.wave.clone().into());
        let timeline: Vec<Value> = steps.iter().map(|&at| Value::from(at.to_vec())).collect();
        let volts = Table::from_iter([("timeline".into(), timeline.into())]);
        let pad = Table::from_iter([
            ("position_mm".into(), vec![0.0, 0.0].into()),
            ("load_g".into(), load_g.into()),
            ("haptic_v_rms".into(), volts.into()),
        ]);
        scene.insert("pad".into(), vec![Value::from(pad)].into());
        scene.insert("title".into(), "bench".into());
        scene.insert("duration_s".into(), (slots as f64 / 1000.0).into());
        let set = self.as_calibrated();
        let scene = Scene::parse(&scene.to_string(), "bench", &set)?;
        let mut plant = Plant::new(&scene, 0, &timing())?;
        Ok((0..slots).map(|slot| plant.truth(slot)).collect())
    }

    /// What the scene says of the device as it was calibrated.
    fn as_calibrated(&self) -> Vec<(String, String)> {
        let set = self.tables.get("calibration").and_then(|table| table.get("set"));
        let set = set.and_then(Value::as_table).into_iter().flatten();
        let of_bench = |(key, _): &(&String, &Value)| {
            TABLES.iter().any(|table| key.split('.').next() == Some(table)) && *key != "gap.rung"
        };
        set.filter(of_bench).map(|(key, value)| (key.clone(), value.to_string())).collect()
    }

    /// Settled readings at each voltage in turn, each on the branch that the pad comes from.
    ///
    /// # Errors
    /// As [`Bench::record`].
    pub fn settled(&self, load_g: f64, volts: &[f64]) -> Result<Vec<Reading>> {
        let at_s = |index: usize| (HELD * index) as f64 / 1000.0;
        let held = |(index, volt): (usize, &f64)| [[at_s(index), *volt], [at_s(index + 1), *volt]];
        let steps: Vec<_> = volts.iter().enumerate().flat_map(held).collect();
        let record = self.record("hysteresis", load_g, &steps, HELD * volts.len())?;
        let last = record.chunks(HELD).filter_map(|held| held.last());
        let reading = |t: &Truth| Reading::settled(t.capacitance_pf, t.haptic_v_rms, t.force_n);
        Ok(last.map(reading).collect())
    }

    /// Readings each millisecond of a step of the voltage, its filters as a core's with frames of a
    /// millisecond.
    ///
    /// # Errors
    /// As [`Bench::record`].
    pub fn step(&self, load_g: f64, volt: f64, slots: usize) -> Result<Vec<Reading>> {
        let steps = [[0.0, volt], [slots as f64 / 1000.0, volt]];
        Ok(moving(&self.record("tr-bdf2", load_g, &steps, slots)?))
    }

    /// Readings each millisecond of a voltage that rises and falls as half a sine, its filters as
    /// those of a step.
    ///
    /// # Errors
    /// As [`Bench::record`].
    pub fn sine(&self, load_g: f64, volt: f64, slots: usize) -> Result<Vec<Reading>> {
        let at_s = |slot: usize| slot as f64 / 1000.0;
        let held = |slot: usize| {
            let volt = volt * (PI * slot as f64 / slots as f64).sin();
            [[at_s(slot), volt], [at_s(slot + 1), volt]]
        };
        let steps: Vec<_> = (0..slots).flat_map(held).collect();
        Ok(moving(&self.record("tr-bdf2", load_g, &steps, slots)?))
    }

    /// The readings of a calibration.
    ///
    /// # Errors
    /// As [`Bench::record`].
    pub fn readings(&self) -> Result<Vec<Reading>> {
        let up: Vec<f64> = (3..=20).map(|n| 20.0 * f64::from(n)).collect();
        let down = up.iter().rev().filter(|_| !self.is_static());
        let volts: Vec<f64> = up.iter().chain(down).copied().collect();
        let mut readings = Vec::new();
        for load_g in LOADS_G {
            interrupt::check()?;
            readings.extend(self.settled(load_g, &volts)?);
        }
        for [load_g, volt] in STEPS.into_iter().filter(|_| !self.is_static()) {
            interrupt::check()?;
            let step = self.step(load_g, volt, STEP_SLOTS)?;
            readings.extend(logarithmic(OF_STEP, STEP_SLOTS).map(|slot| step[slot]));
        }
        for [load_g, volt] in SINES.into_iter().filter(|_| !self.is_static()) {
            interrupt::check()?;
            readings.extend(self.sine(load_g, volt, SINE_SLOTS)?.iter().step_by(SINE_EVERY));
        }
        Ok(readings)
    }
}

/// Slots of a record, evenly over the logarithm of time, none twice.
fn logarithmic(count: usize, slots: usize) -> impl Iterator<Item = usize> {
    let at = move |n: usize| {
        let share = n as f64 / (count - 1) as f64;
        let slot = (share * ((slots - 1) as f64).ln()).exp().round() as usize;
        slot.max(n).min(slots - 1)
    };
    (0..count).map(at)
}

/// Readings of slots of a millisecond, with the filters of V_s and V_m.
pub fn moving(record: &[Truth]) -> Vec<Reading> {
    let shares = [RECENT_S, hapticore_host::device::MEAN_S].map(|s| -(-1e-3 / s).exp_m1());
    let mut past = [0.0; 2];
    let mut reading = |t: &Truth| {
        for (past, share) in past.iter_mut().zip(shares) {
            *past = match t.haptic_v_rms < RELEASE_V {
                true => 0.0,
                false => *past + share * (t.haptic_v_rms - *past),
            };
        }
        let [recent_v, mean_v] = past;
        let settled = Reading::settled(t.capacitance_pf, t.haptic_v_rms, t.force_n);
        Reading { recent_v, mean_v, ..settled }
    };
    record.iter().map(&mut reading).collect()
}

/// One pad, slots of a millisecond.
fn timing() -> Timing {
    let profile = Profile::bundled("standard").expect("bundled");
    Timing {
        pads: 1,
        slot_samples: 1000,
        window_start: 0,
        window_samples: 1000,
        ..crate::inputs::timing(&profile)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bench(scene: &str) -> Option<Bench> {
        Bench::of(scene).unwrap()
    }

    /// Its force is that of its patches, with friction and without.
    #[test]
    fn a_gap_without_friction_has_readings_too() {
        assert!(bench("[friction]\n").is_none());
        let forces_n = |scene: &str| {
            let readings = bench(scene).expect("a gap").settled(50.0, &[200.0, 300.0]).unwrap();
            readings.iter().map(|reading| reading.force_n).collect::<Vec<_>>()
        };
        let alone = forces_n("[gap]\n");
        assert_eq!(alone, forces_n("[gap]\n[friction]\n"));
        assert!((alone[1] - 0.2560).abs() < 0.0005, "{alone:?}"); // docs/physics.md §3
    }

    #[test]
    fn a_gap_under_a_controller_moves_on_the_bench() {
        assert!(bench("[gap]\n").expect("a gap").is_static());
        assert!(!bench("[gap]\n[control]\n").expect("a gap").is_static());
        assert!(bench("[gap]\nrung = \"static\"\n[control]\n").expect("a gap").is_static());
    }
}
