// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a client must know of a simulated case: sizes, names, inputs, limits; and the samples of a slot.

use anyhow::{Context, Result};
use hapticore_run::engine::Fidelity;
use hapticore_run::record::Provenance;
use hapticore_run::stepper::Stepper;
use hapticore_scene::{Measure, Quantity, Scene, Setpoint, gallery, reference};

use crate::presets;
use crate::protocol::{
    Arena, COLUMNS, Hello, InputInfo, Limits, Opening, Pad, SettingInfo, SlotCodes, VERSION, Wall,
};

/// Keys of scenes that are worth changing: key, label, least and largest value of a slider. Units and meanings are declared.
const SETTINGS: [(&str, &str, [f64; 2]); 10] = [
    ("wall.stiffness_n_per_mm", "Stiffness of the wall", [0.05, 2.0]),
    ("arena.puck_g", "Mass of the puck", [5.0, 100.0]),
    ("arena.impact_ms", "How long an impact is felt", [5.0, 100.0]),
    ("control.rail_v", "Largest drive, RMS", [50.0, 500.0]),
    ("device.mu", "Friction coefficient", [0.02, 0.5]),
    ("halves.mismatch_percent", "Mismatch of the electrodes", [-5.0, 5.0]),
    ("sensor.noise_ppm_rms", "Noise of the ADC", [0.0, 500.0]),
    ("sensor.quantisation_bits", "Resolution of the ADC", [8.0, 24.0]),
    ("sheet.terminal_ohm", "Resistance of each terminal", [0.0, 1000.0]),
    ("sheet.ohm_per_square", "Resistance of the sheet per square", [50.0, 500.0]),
];

/// All that does not change of a case.
///
/// # Errors
/// A case that is no scene of its own.
pub fn hello(opening: &Opening, fidelity: Fidelity, stepper: &Stepper) -> Result<Hello> {
    let (case, plant) = (stepper.case(), stepper.plant());
    let (scene, index) = (&*case.scene, case.index);
    let of = &scene.cases[index];
    let device = plant.device();
    let document: toml::Table = of.document.parse().context("the case as a scene")?;
    let set = case.plant()?.truth(0).set;
    let pad = |name: &&str| Pad { name: name.to_string(), parts_mm: plant.parts_mm().to_vec() };
    let provenance = Provenance::new();
    Ok(Hello {
        protocol: VERSION,
        version: provenance.version,
        commit: provenance.commit,
        source: "scene",
        scene: scene.name.clone(),
        title: scene.title.clone(),
        summary: scene.summary.trim().to_string(),
        case: of.name.clone(),
        case_index: index,
        cases: scene.cases.iter().map(|case| case.name.clone()).collect(),
        profile: case.profile.name.clone(),
        fidelity: fidelity.name().to_string(),
        set: opening.set.clone(),
        command: command(opening, scene, index, fidelity),
        warnings: of.doubts.clone(),
        slot_us: 1e6 * case.clock.seconds(1),
        parts: plant.parts(),
        pads: plant.pad_names().iter().map(pad).collect(),
        sheet_mm: [device.width_mm, device.height_mm],
        pad_diameter_mm: device.pad_diameter_mm,
        terminals_mm: device.terminals_mm.clone(),
        columns: COLUMNS.to_vec(),
        inputs: inputs(stepper, &document, &set),
        settings: settings(&document),
        leads: true,
        hand: document.contains_key("hand"),
        controller: case.plan().is_some(),
        walls: walls(stepper),
        arena: arena(stepper),
        limits: limits(scene, index, stepper),
        truth: true,
        speed: 1.0,
        scenes: gallery::all().iter().map(|(name, _)| *name).collect(),
        presets: presets::all(),
    })
}

/// The command that runs the same scene to its end.
fn command(opening: &Opening, scene: &Scene, index: usize, fidelity: Fidelity) -> String {
    let mut words = vec!["hapticore".into(), "simulate".into(), opening.scene.clone()];
    let mut option = |name: &str, value: &str| words.extend([name.to_string(), value.to_string()]);
    opening.set.iter().for_each(|(key, value)| option("--set", &format!("{key}={value}")));
    if scene.cases.len() > 1 {
        option("--case", &scene.cases[index].name);
    }
    opening.profile.iter().for_each(|profile| option("--profile", profile));
    if fidelity != Fidelity::Fixed {
        option("--core", fidelity.name());
    }
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.,=/:+".contains(c);
    match word.chars().all(plain) && !word.is_empty() {
        true => word.to_string(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

fn inputs(stepper: &Stepper, document: &toml::Table, set: &Setpoint) -> Vec<InputInfo> {
    let info = |name, unit, label, least, most: f64, value: f64| InputInfo {
        name,
        unit,
        label,
        least,
        most: most.max(value),
        value,
        per: "pad",
    };
    let mut inputs = vec![info("pad.load_g", "g", "Load", 0.0, 200.0, set.load_g)];
    match stepper.case().plan() {
        None => inputs.push(info(
            "pad.haptic_v_rms",
            "V",
            "Haptic voltage, RMS",
            0.0,
            400.0,
            set.haptic_v_rms,
        )),
        // With walls these give the target.
        Some(plan) if plan.wall.is_none() => {
            inputs.push(info("pad.target_n", "N", "Target force", 0.0, 1.0, set.target_n));
        }
        Some(_) => (),
    }
    if document.contains_key("hand") {
        inputs.push(info("pad.push_x_n", "N", "Push along x", -2.0, 2.0, 0.0));
        inputs.push(info("pad.push_y_n", "N", "Push along y", -2.0, 2.0, 0.0));
    }
    inputs
}

fn settings(document: &toml::Table) -> Vec<SettingInfo> {
    let of_table = |&(key, label, [least, most]): &(&'static str, &'static str, [f64; 2])| {
        let (table, name) = key.split_once('.')?;
        let table = document.get(table)?.as_table()?;
        let (_, declared) = reference::key(key)?;
        let (unit, says) = (declared.unit().unwrap_or_default(), declared.says());
        let number =
            |value: &toml::Value| value.as_float().or(value.as_integer().map(|value| value as f64));
        let value = table.get(name).and_then(number);
        Some(SettingInfo { key, unit, label, says, least, most, value })
    };
    SETTINGS.iter().filter_map(of_table).collect()
}

/// Of an arena each pad has walls of its own, which are those of its reach.
fn walls(stepper: &Stepper) -> Vec<Wall> {
    if stepper.game().is_some() {
        return Vec::new();
    }
    let Some(wall) = stepper.case().plan().and_then(|plan| plan.wall.as_ref()) else {
        return Vec::new();
    };
    let side = |above| if above { "above" } else { "below" };
    let x = Wall { axis: "x", mm: wall.surface_mm(0.0), inside: side(wall.right) };
    let y = wall.along_y.as_ref().map(|along_y| Wall {
        axis: "y",
        mm: along_y.surface_mm(0.0),
        inside: side(along_y.above),
    });
    std::iter::once(x).chain(y).collect()
}

fn arena(stepper: &Stepper) -> Option<Arena> {
    let game = stepper.game()?;
    let rules = game.rules();
    Some(Arena {
        half_mm: rules.half_mm,
        goal_half_mm: rules.goal_half_mm,
        mallet_radius_mm: rules.mallet_radius_mm,
        puck_radius_mm: rules.puck_radius_mm,
        reach_mm: game.reaches_mm().collect(),
    })
}

fn limits(scene: &Scene, index: usize, stepper: &Stepper) -> Limits {
    let is_error = |measure| matches!(measure, Measure::MaxAbsError | Measure::RmsError);
    let limit = |of: Quantity| {
        let criteria = scene.criteria.iter().filter(|criterion| {
            criterion.of == of
                && is_error(criterion.measure)
                && criterion.covers(&scene.cases[index].name)
        });
        criteria.map(|criterion| criterion.limit).reduce(f64::min)
    };
    Limits {
        position_mm: limit(Quantity::PositionMm),
        force_n: limit(Quantity::ForceN),
        rail_v: stepper.case().plan().map(|plan| plan.rail_v),
    }
}

/// The ADC codes of the last slot.
pub fn codes(stepper: &Stepper) -> SlotCodes {
    let profile = &stepper.case().profile;
    let channels = profile.channels();
    let names = (1..=channels - 2).map(|n| format!("I{n}")).chain(["V_s".into(), "V_h".into()]);
    let slot = stepper.slot().saturating_sub(1);
    let codes = stepper.codes().unwrap_or_default();
    let channel = |n: usize| codes.iter().skip(n).step_by(channels).copied().collect();
    SlotCodes {
        slot,
        pad: slot % stepper.plant().served(),
        channels: names.collect(),
        full_scale: (1.0 / profile.formats.adc.lsb()) as i32,
        sample_rate_hz: stepper.plant().device().sample_rate_hz,
        codes: if codes.is_empty() { Vec::new() } else { (0..channels).map(channel).collect() },
    }
}

#[cfg(test)]
mod tests {
    use hapticore_scene::reference;

    use super::SETTINGS;

    #[test]
    fn each_slider_is_of_a_declared_key_and_within_its_range() {
        for (key, _, ends) in SETTINGS {
            let (_, declared) = reference::key(key).unwrap_or_else(|| panic!("{key} is no key"));
            let limits = declared.limits();
            assert!(ends.iter().all(|end| limits.holds(*end)), "{key}: {ends:?} of {limits}");
        }
    }
}
