// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every table that a scene may have, with its keys as they are declared beside what reads them: the one list from which
//! the reference, its page and the schema for editors are printed.
//!
//! ```
//! use hapticore_scene::reference;
//!
//! let (section, key) = reference::key("pad.mallet.load_g").unwrap();
//! assert_eq!((section.heading().as_str(), key.name, key.unit()), ("[[pad]]", "load_g", Some("g")));
//! assert!(reference::key("pad.mallet.load").is_none());
//! ```

use crate::effects::{
    carrier, charge, coupling, finger, friction, gap, release, sensor, sheet, shunt,
    split_electrode, supply, switching, temperature,
};
use crate::{
    arena, case, control, criterion, device, head, pad, stimulus, terminals, trajectory, variant,
    wall, wave,
};

pub use crate::format::{KeyInfo, Kind, Limits, Otherwise};

/// A table, and what may stand in it.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Its dotted path, empty of the scene itself. A stimulus, which many keys take, has the path `stimulus`.
    pub path: &'static str,
    /// What the table models, in a sentence.
    pub says: &'static str,
    /// A scene may have several of it.
    pub is_list: bool,
    lists: &'static [&'static [&'static KeyInfo]],
}

impl Section {
    /// Its keys.
    pub fn keys(&self) -> impl Iterator<Item = &'static KeyInfo> + use<> {
        self.lists.iter().copied().flatten().copied()
    }

    /// The key of this name.
    pub fn key(&self, name: &str) -> Option<&'static KeyInfo> {
        self.keys().find(|key| key.name == name)
    }

    /// The tables in it.
    pub fn tables(&self) -> impl Iterator<Item = &'static Section> {
        let inside = |section: &&Section| {
            let parent = section.path.rsplit_once('.').map_or("", |(parent, _)| parent);
            parent == self.path && !section.path.is_empty() && section.path != STIMULUS
        };
        SECTIONS.iter().filter(inside)
    }

    /// Its last name: `patch` of `sheet.patch`.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or_default()
    }

    /// It is a form of keys' values, a stimulus or places of a pad, and no table that a scene has of its own.
    pub fn is_form(&self) -> bool {
        self.path.starts_with(STIMULUS) || self.path.starts_with("pad.")
    }

    /// As a scene writes it: `[wall]`, `[[pad]]`, `stimulus.sine`.
    pub fn heading(&self) -> String {
        match (self.path, self.is_list) {
            ("", _) => "scene".to_string(),
            (path, true) => format!("[[{path}]]"),
            (path, false) if self.is_form() => path.to_string(),
            (path, false) => format!("[{path}]"),
        }
    }
}

const STIMULUS: &str = "stimulus";

const fn table(
    path: &'static str,
    says: &'static str,
    lists: &'static [&'static [&'static KeyInfo]],
) -> Section {
    Section { path, says, is_list: false, lists }
}

const fn tables(
    path: &'static str,
    says: &'static str,
    lists: &'static [&'static [&'static KeyInfo]],
) -> Section {
    Section { path, says, is_list: true, lists }
}

/// Every table of a scene.
#[rustfmt::skip]
pub static SECTIONS: &[Section] = &[
    table("", "The scene as a whole.", &[head::KEYS, case::KEYS]),
    tables("pad", "1 to 16 pads, selected for one slot each in turn.", &[pad::KEYS, trajectory::KEYS]),
    table("pad.position_mm", "Places of a pad over a sweep or over time.", &[trajectory::FORM_KEYS]),
    table("pad.position_mm.raster", "A grid of places, row by row from the bottom left.", &[trajectory::RASTER_KEYS]),
    table("pad.position_mm.line", "There and back at even speed.", &[trajectory::LINE_KEYS, trajectory::PERIOD_KEYS]),
    table("pad.position_mm.circle", "Anticlockwise round a circle.", &[trajectory::CIRCLE_KEYS, trajectory::PERIOD_KEYS, trajectory::CENTRE_KEYS]),
    table("pad.position_mm.lissajous", "A sine along either axis.", &[trajectory::LISSAJOUS_KEYS, trajectory::CENTRE_KEYS]),
    table("pad.position_mm.timeline", "From point to point.", &[trajectory::TIMELINE_KEYS]),
    table("stimulus", "What a quantity may be in place of a number: one form of these.", &[stimulus::FORM_KEYS]),
    table("stimulus.sweep", "Evenly spaced values, in place of a list.", &[stimulus::RANGE_KEYS]),
    table("stimulus.sine", "A sine over time.", &[stimulus::SINE_KEYS]),
    table("device", "Sizes of sheet and pads, friction.", &[device::KEYS]),
    table("sheet", "The resistive sheet, which splits a pad's current among the terminals.", &[sheet::KEYS, sheet::film::KEYS, terminals::KEYS, sheet::geometry::KEYS]),
    tables("sheet.patch", "A rectangle of the film with another resistance; the last one that covers a place holds.", &[sheet::film::PATCH_KEYS]),
    table("temperature", "Temperature of the film and of the rubber since the calibration.", &[temperature::KEYS]),
    table("shunt", "Capacitance from the sheet to the panel behind it, and the panel's noise.", &[shunt::KEYS, shunt::panel::KEYS]),
    table("coupling", "Currents that other pads draw from the selected one.", &[coupling::KEYS]),
    table("switching", "Transient after a pad is connected.", &[switching::KEYS]),
    table("supply", "Limiting resistor and transformer of the haptic voltage.", &[supply::KEYS, wave::SUPPLY_KEYS]),
    table("charge", "Charge in the insulators under a voltage with a mean.", &[charge::KEYS]),
    table("gap", "Air gap of patches of the rubber, which pull in and creep.", &[gap::KEYS, gap::RUBBER_KEYS]),
    table("halves", "Split electrode, for the direction of the push.", &[split_electrode::KEYS]),
    table("hand", "Finger that drags the pad by a spring and a damper.", &[finger::KEYS]),
    table("release", "Friction that falls later than the attraction.", &[release::KEYS]),
    table("friction", "Haptic force and friction.", &[friction::KEYS, friction::DRIFT_KEYS]),
    table("carrier", "Sensing carrier and wave of the haptic voltage; always present.", &[carrier::KEYS, device::CARRIER_KEYS, wave::KEYS]),
    table("sensor", "Sensor chain: full scales of the device, and errors, each switched on by its key.", &[device::FULL_SCALE_KEYS, sensor::KEYS]),
    table("control", "Force controller around the pads, whose `target_n` takes the place of `haptic_v_rms`.", &[control::KEYS]),
    table("wall", "Virtual walls in the core, which the force controller makes felt; with `[control]` and `[halves]`.", &[wall::KEYS]),
    table("arena", "Table of air hockey that the run's host plays; the pads are mallets.", &[arena::KEYS]),
    tables("case", "A variant of the scene; one named `main` where there is none.", &[variant::KEYS, variant::SET_KEYS]),
    table("calibration", "The device as it was calibrated, where it has changed since.", &[variant::SET_KEYS]),
    tables("criterion", "A claim of the scene, which a run checks.", &[criterion::KEYS]),
];

/// The table at a dotted path, in which numbers and names of list entries may stand, and the rest of the path.
fn walk(path: &str) -> (&'static Section, Vec<&str>) {
    let mut here = &SECTIONS[0];
    let mut parts = path.split('.').peekable();
    while let Some(part) = parts.peek().copied() {
        let takes_stimulus =
            |key: &KeyInfo| matches!(key.kind, Kind::Stimulus(_) | Kind::OverTime(_));
        let inside = match here.key(part) {
            Some(key) if takes_stimulus(key) => {
                SECTIONS.iter().find(|table| table.path == STIMULUS)
            }
            _ => here.tables().find(|table| table.name() == part),
        };
        let is_last = parts.clone().nth(1).is_none();
        match inside {
            Some(inside) if !(is_last && here.key(part).is_some()) => here = inside,
            None if here.is_list && here.key(part).is_none() && !is_last => {}
            _ => break,
        }
        parts.next();
    }
    (here, parts.collect())
}

/// The key at a dotted path, such as `wall.force_n` or `pad.0.load_g`, and the table that it stands in.
pub fn key(path: &str) -> Option<(&'static Section, &'static KeyInfo)> {
    let (section, rest) = walk(path);
    let [name] = rest[..] else { return None };
    section.key(name).map(|key| (section, key))
}

/// The table at a dotted path.
pub fn section(path: &str) -> Option<&'static Section> {
    SECTIONS.iter().find(|section| section.path == path)
}

/// What is said of a path that nothing in a scene reads, where it means something: what it needs, or where it belongs.
pub(crate) fn elsewhere(path: &str) -> Option<String> {
    let table = || section(path).filter(|table| !table.is_form());
    let says = key(path).map(|(_, key)| key.says()).or_else(|| Some(table()?.says));
    if let Some(says) = says {
        return Some(format!("without effect in this scene. What it is for: {says}"));
    }
    let name = path.rsplit('.').next().unwrap_or_default();
    let table = SECTIONS.iter().find(|table| !table.is_form() && table.key(name).is_some())?;
    let at = match (table.path, table.is_list) {
        ("", _) => format!("a key of the scene, above its first table: {name}"),
        (path, true) => format!("a key of [[{path}]]: {path}.0.{name}"),
        (path, false) => format!("a key of [{path}]: {path}.{name}"),
    };
    Some(format!("expected elsewhere, {at}"))
}

/// The keys of a read scene that are not declared, by their dotted paths: none, or a declaration is missing.
pub(crate) fn undeclared(asked: Vec<String>) -> Vec<String> {
    let is_declared = |path: &String| {
        let (section, rest) = walk(path);
        let is_free = |key: &KeyInfo| matches!(key.kind, Kind::Keys | Kind::Ranges);
        let Some(name) = rest.first() else { return true };
        section.key(name).is_some_and(|key| rest.len() == 1 || is_free(key))
    };
    asked.into_iter().filter(|path| !is_declared(path)).collect()
}

/// Units by the ends of names.
#[rustfmt::skip]
const UNITS: [(&str, &str); 44] = [
    ("force_k", "N/(F·V)²"), ("_na_per_rthz", "nA/√Hz"), ("_percent_per_k", "%/K"), ("_ppm_per_k", "ppm/K"), ("_per_square", "Ω"), ("nanofarad_per_m2", "nF/m²"),
    ("_n_s_per_m", "N·s/m"), ("_n_per_mm", "N/mm"), ("_n_per_m", "N/m"), ("_pa_per_m", "Pa/m"), ("_mm_per_s", "mm/s"),
    ("_kg_m2", "kg/m²"), ("_m_s2", "m/s²"), ("_mm_s", "mm/s"), ("_pa_s", "Pa·s"), ("_v_rms", "V RMS"),
    ("_ns_rms", "ns RMS"), ("_ppm_rms", "ppm RMS"), ("_lsb_rms", "LSB RMS"), ("_percent", "%"), ("_kohm", "kΩ"),
    ("_ohm", "Ω"), ("_turns", "turns"), ("_bits", "bits"), ("_khz", "kHz"), ("_hz", "Hz"),
    ("_mv", "mV"), ("_ma", "mA"), ("_mh", "mH"), ("_mm", "mm"), ("_ms", "ms"),
    ("_um", "µm"), ("_us", "µs"), ("_pf", "pF"), ("_kg", "kg"), ("_pa", "Pa"),
    ("_v", "V"), ("_h", "H"), ("_n", "N"), ("_g", "g"), ("_k", "K"),
    ("_s", "s"), ("_mn", "mN"), ("_a", "A"),
];

impl KeyInfo {
    /// The unit that its name ends with.
    pub fn unit(&self) -> Option<&'static str> {
        unit(self.name)
    }
}

/// The unit that a name ends with, of a scene's key or another file's.
pub fn unit(name: &str) -> Option<&'static str> {
    UNITS.iter().find(|(end, _)| name.ends_with(end)).map(|(_, unit)| *unit)
}
