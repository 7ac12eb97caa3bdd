// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fits the sixth and the seventh height of the gap's patches to the jumps of the paper's Fig. 7, at
//! 1.0 s and 2.8 s under 50 g and 350 V RMS: with the drive's mean square and with its 200 Hz sine.
//!
//! `cargo run --release -p hapticore-scene --example fit_heights`
//!
//! Each height is bisected by the jump that it places; the other one moves that jump by little, so
//! three rounds are enough.

use hapticore_scene::{Plant, Scene, SceneError, Timing};

/// When patches pull in, s.
const JUMPS_S: [f64; 2] = [1.0, 2.8];

/// Where the heights are looked for, µm.
const BETWEEN_UM: [[f64; 2]; 2] = [[37.5, 38.9], [39.2, 40.5]];

const ROUNDS: usize = 3;

/// Slots of a period of the haptic voltage, so that each meets the sine at the same phase.
const SLOT_S: f64 = 5e-3;

/// What the capacitance rises by in a slot of a jump at least, pF; creep makes 0.1 of it.
const JUMP_PF: f64 = 2.0;

/// The drive's own jump is over by then, s.
const CLOSED_S: f64 = 0.3;

fn main() -> Result<(), SceneError> {
    for drive in ["rms", "sine"] {
        let mut heights_um = [38.2, 39.85];
        for _ in 0..ROUNDS {
            for jump in 0..2 {
                heights_um[jump] = bisect(drive, heights_um, jump)?;
            }
        }
        println!("{drive}: {heights_um:.4?} µm, jumps at {:.3?} s", jumps_s(drive, heights_um)?);
    }
    Ok(())
}

/// The height that places a jump, the other one held.
fn bisect(drive: &str, heights_um: [f64; 2], jump: usize) -> Result<f64, SceneError> {
    let [mut low, mut high] = BETWEEN_UM[jump];
    while high - low > 2e-5 {
        let mut tried = heights_um;
        tried[jump] = 0.5 * (low + high);
        let late = jumps_s(drive, tried)?.get(jump).is_none_or(|at_s| *at_s > JUMPS_S[jump]);
        *if late { &mut high } else { &mut low } = tried[jump];
    }
    Ok(0.5 * (low + high))
}

/// When the capacitance jumps after the drive's own jump at 0 s.
fn jumps_s(drive: &str, [sixth, seventh]: [f64; 2]) -> Result<Vec<f64>, SceneError> {
    let text = format!(
        "title = \"Fig. 7\"\nduration_s = 3.5\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n\
         haptic_v_rms = 350\n[supply]\n[carrier]\nhaptic_hz = 200\n[gap]\nrung = \"tr-bdf2\"\n\
         drive = \"{drive}\"\nrest_um = [12, 26.4, 27.7, 29.3, 33.6, {sixth}, {seventh}, 55]\n\
         area_shares = [0.365, 0.11, 0.065, 0.04, 0.025, 0.1, 0.1, 0.195]\n\
         load_shares = [{crests}, 0, 0, 0, 0, 0, 0, 0]\n",
        crests = 1.0 / 0.365
    );
    let timing = Timing {
        pads: 1,
        slot_samples: 5000,
        window_start: 0,
        window_samples: 1000,
        samples_per_period: 10.0,
        signs: None,
    };
    let mut plant = Plant::new(&Scene::parse(&text, "fig7", &[])?, 0, &timing)?;
    let slots = (3.5 / SLOT_S) as usize;
    let capacitance: Vec<f64> = (0..slots).map(|slot| plant.truth(slot).capacitance_pf).collect();
    let rises: Vec<f64> = capacitance.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let steepest = |n: &usize| {
        let [before, now, after] = [rises[n - 1], rises[*n], rises[n + 1]];
        now > JUMP_PF && before < now && after <= now
    };
    // Between the middles of two slots; a parabola through three rises says where.
    let at_s = |n: usize| {
        let [before, now, after] = [rises[n - 1], rises[n], rises[n + 1]];
        (n as f64 + 1.0 + 0.5 * (after - before) / (2.0 * now - before - after)) * SLOT_S
    };
    let from = (CLOSED_S / SLOT_S) as usize;
    Ok((from..rises.len() - 1).filter(steepest).map(at_s).collect())
}
