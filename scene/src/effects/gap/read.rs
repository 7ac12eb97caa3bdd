// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[gap]` as a scene writes it.

use std::f64::consts::TAU;

use super::dynamic::Method;
use super::pad::{Gap, Motion};
use super::read_rubber::read_rubber;
use super::rubber::Rubber;
use crate::device::Device;
use crate::effects::effect::Effect;
use crate::effects::spec::{Level, Rung, Setting, Spec};
use crate::effects::temperature;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::wave::HapticWave;

/// The longest step, µs.
const LONGEST_US: f64 = 1000.0;

/// The longest step whose contact is explicit, µs.
const LONGEST_SEMI_IMPLICIT_US: f64 = 200.0;

/// The question that all levels of a gap in motion answer, and the level that does without a budget.
const MOVING: (&str, &str) = ("moving", "tr-bdf2");

/// Levels, and what a slot of 1.7 ms costs at its usual step, ns.
const LEVELS: [(&str, Motion, f64); 7] = [
    ("static", Motion::Static, 500.0),
    ("hysteresis", Motion::Hysteresis, 4e3),
    ("quasi-static", Motion::QuasiStatic, 400.0),
    ("semi-implicit", Motion::Dynamic(Method::SemiImplicit), 1.4e3),
    ("implicit-euler", Motion::Dynamic(Method::ImplicitEuler), 3.6e3),
    ("trapezoid", Motion::Dynamic(Method::Trapezoid), 4.3e3),
    ("tr-bdf2", Motion::Dynamic(Method::TrBdf2), 6.9e3),
];

keys! { KEYS:
    /// How the gap is computed: at rest (`static`, `hysteresis`) or in motion; `moving` leaves the level of the moving gap to
    /// the error budget.
    RUNG: Option<&'static str> = Rung::choice("rung", words).usually("tr-bdf2 with [control], else static");
    /// Whether the attraction follows the RMS of the haptic voltage or its sine.
    DRIVE: &'static str = Key::choice("drive", || vec!["rms", "sine"]).or("rms");
    /// Time step; at most 1000, of `semi-implicit` at most 200.
    STEP_US: Option<f64> = Key::number("step_us", Limits::within(0.01, 1e9)).usually("100 in motion, else 1000");
}

/// The words of `rung`.
fn words() -> Vec<&'static str> {
    LEVELS.iter().map(|(word, ..)| *word).chain([MOVING.0]).collect()
}

pub(in super::super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    read_raised(root, device, 0.0)
}

/// The same with patches that bear no load higher by a share of their heights.
pub(in super::super) fn read_raised(
    root: &Table,
    device: &Device,
    raised: f64,
) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("gap")? else { return Ok(None) };
    let named = table.get(&RUNG)?;
    let rubber = read_rubber(table, device)?.raised(raised);
    if raised != 0.0 && rubber.patches.iter().all(|patch| patch.load_share > 0.0) {
        let message = "expected a patch that bears no load, with halves.height_mismatch_percent, which raises these";
        return Err(table.error("load_shares", message));
    }
    let sine = table.get(&DRIVE)? == "sine";
    if sine && device.haptic_wave != HapticWave::Sine {
        let got = device.haptic_wave.name();
        let message = format!("expected \"rms\" where carrier.haptic_wave is no sine, got {got:?}");
        return Err(table.error("drive", message));
    }
    let stiffest = temperature::stiffest(root)?;
    let led = stiffest.is_some() || root.table("charge")?.is_some() || is_tilted(root)?;
    let sine_rad_s = sine.then_some(TAU * device.haptic_hz);
    let asked_us = table.get(&STEP_US)?;
    let mut levels = Vec::new();
    for (word, motion, cost_ns) in LEVELS {
        let asked_us = asked_us.filter(|_| named == Some(word));
        let step_us = asked_us.unwrap_or(usual_step_us(motion));
        check_step(table, motion, step_us)?;
        if let Err(message) = check_spring(&rubber, stiffest.unwrap_or(1.0), motion, step_us) {
            // A budget does without it.
            if named == Some(word) {
                return Err(table.error("rung", message));
            }
            continue;
        }
        let rubber = rubber.clone();
        let build = move |_: &Setting| {
            let gap = Gap::new(rubber.clone(), motion, step_us * 1e-6, sine_rad_s);
            Effect::Pad(Box::new(gap.led(led)))
        };
        let label = if motion == Motion::Static {
            word.to_string()
        } else {
            format!("{word} {step_us} µs")
        };
        let level = Level::new(word, cost_ns, build).labelled(label);
        levels.push(match motion {
            Motion::Static | Motion::Hysteresis => level.apart(),
            // None of these is more exact than the next by far.
            Motion::QuasiStatic | Motion::Dynamic(Method::SemiImplicit | Method::ImplicitEuler) => {
                level.against("trapezoid")
            }
            Motion::Dynamic(_) => level,
        });
    }
    // A loop acts on a pad faster than its gap follows: with a gap that settles immediately it swings, or
    // seems calmer than it is.
    let usual = if root.node("control").is_some() { MOVING.1 } else { "static" };
    Spec::with_questions("gap", Some(table), &RUNG, levels, usual, &[MOVING])
}

/// Whether the hand tilts the pad, so that its force, which is kept at times of its own, acts on the patches.
fn is_tilted(root: &Table) -> Result<bool, SceneError> {
    let Some(halves) = root.table("halves")?.filter(|_| root.node("hand").is_some()) else {
        return Ok(false);
    };
    let height_mm = halves.node("push_height_mm").and_then(|node| node.value.number());
    Ok(height_mm != Some(0.0))
}

fn usual_step_us(motion: Motion) -> f64 {
    match motion {
        Motion::Dynamic(_) => 100.0,
        _ => LONGEST_US,
    }
}

fn check_step(table: &Table, motion: Motion, step_us: f64) -> Result<(), SceneError> {
    let (longest_us, reason) = match motion {
        Motion::Dynamic(Method::SemiImplicit) => {
            (LONGEST_SEMI_IMPLICIT_US, "a longer step bounces off the contact")
        }
        _ => (LONGEST_US, "near the fold a longer step pulls in seconds too early or too late"),
    };
    if step_us <= longest_us {
        return Ok(());
    }
    Err(table
        .error("step_us", format!("expected at most {longest_us}, since {reason}, got {step_us}")))
}

/// Whether the rubber is soft enough for steps whose spring is explicit.
fn check_spring(
    rubber: &Rubber,
    stiffness: f64,
    motion: Motion,
    step_us: f64,
) -> Result<(), String> {
    let Motion::Dynamic(method) = motion else { return Ok(()) };
    let spring = stiffness * (1.0 + rubber.law.creep_share) * rubber.law.spring_pa_per_m;
    let stiffest = rubber.stiffest_pa_per_m(method, 1e-6 * step_us);
    if spring <= stiffest {
        return Ok(());
    }
    Err(format!(
        "expected rubber of at most {stiffest:.1e} Pa/m with all that creeps of it, beyond which steps of \
         {step_us} µs swing ever wider, got {spring:.1e}; a shorter step_us or tr-bdf2 holds more"
    ))
}
