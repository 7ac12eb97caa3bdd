// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs by slot, as a log, or as a scene file that `hapticore simulate` runs without a page.
//!
//! A log applied to the same case gives the same rows, to the bit. So does the scene file, since the knots of a finger
//! that is led are those of a `timeline`; but where a line is cut short by the next, or a motion of the scene by a hand,
//! the knot between has been rounded, and places differ by 10⁻¹² mm.

mod script;
mod timeline;

use hapticore_host::SlotClock;
use hapticore_run::control::plant::FAR_MM;
use hapticore_run::stepper::{Input, RELEASE_S, Stepper};
use hapticore_scene::DEFAULT_LOAD_G;
use serde::Serialize;
use toml::{Table, Value};

use crate::protocol::{Opening, Recorded, Recording};
use script::Scripts;
use timeline::{Motion, Steps, Track};

/// The most inputs of a log: a finger that is led 60 times a second for four hours.
const MOST: usize = 1_000_000;

/// Where in a slot a target or a wall changes: after its beginning, and before its window's middle and its end, where
/// the simulation asks for them.
const WITHIN_SLOT: f64 = 0.25;

/// An input, and the slot before which it was applied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Entry {
    /// Number of the slot.
    pub slot: usize,
    /// What was done.
    #[serde(flatten)]
    pub input: Input,
}

/// All inputs since a scene was opened.
#[derive(Debug, Clone)]
pub struct Log {
    opening: Opening,
    /// The case as a scene of its own, in TOML.
    document: String,
    /// Number of the case, on which noise depends.
    index: usize,
    clock: SlotClock,
    entries: Vec<Entry>,
    /// More inputs have come than it holds.
    overflows: bool,
}

/// A log as a file.
#[derive(Serialize)]
struct LogFile<'a> {
    #[serde(flatten)]
    opening: &'a Opening,
    slots: usize,
    slot_s: f64,
    inputs: &'a [Entry],
}

impl Log {
    /// An empty log of a case: the case as a scene of its own, its number, and when its slots begin.
    pub fn new(opening: Opening, document: &str, (index, clock): (usize, SlotClock)) -> Log {
        let document = document.to_string();
        Log { opening, document, index, clock, entries: Vec::new(), overflows: false }
    }

    /// Adds an input.
    pub fn add(&mut self, slot: usize, input: Input) {
        match self.entries.len() < MOST {
            true => self.entries.push(Entry { slot, input }),
            false => self.overflows = true,
        }
    }

    /// How many inputs there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The inputs.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    fn check(&self) -> Result<(), String> {
        match self.overflows {
            true => Err(format!("record: expected at most {MOST} inputs; record from the start")),
            false => Ok(()),
        }
    }

    /// The log as JSON.
    ///
    /// # Errors
    /// More inputs than a log holds.
    pub fn text(&self, slots: usize) -> Result<Recorded, String> {
        self.check()?;
        let file = LogFile {
            opening: &self.opening,
            slots,
            slot_s: self.clock.seconds(1),
            inputs: &self.entries,
        };
        let text = serde_json::to_string_pretty(&file).map_err(|error| error.to_string())?;
        Ok(Recorded {
            format: Recording::Log,
            name: format!("{}-live.json", stem(&self.opening.scene)),
            exact: true,
            note: String::new(),
            text,
        })
    }

    /// The case with its inputs as a scene file of this many slots.
    ///
    /// # Errors
    /// More inputs than a log holds, no slot, a case that sweeps.
    pub fn scene(&self, slots: usize, stepper: &Stepper) -> Result<Recorded, String> {
        self.check()?;
        let mut root: Table = self.document.parse().map_err(|error| format!("record: {error}"))?;
        if slots == 0 || !root.contains_key("duration_s") {
            return Err(
                "record: expected slots of a scene with duration_s; to log writes others".into()
            );
        }
        let mut notes = self.write_inputs(&mut root, slots)?;
        self.write_head(&mut root, slots, stepper);
        if root.contains_key("error_budget_percent") {
            notes.push("error_budget_percent chooses levels anew".into());
        }
        let name = format!("{}-live.toml", stem(&self.opening.scene));
        let text = format!("{}\n{root}", self.comment(&name, &notes));
        let (exact, note) = (notes.is_empty(), notes.join("; "));
        Ok(Recorded { format: Recording::Scene, name, exact, note, text })
    }

    fn comment(&self, name: &str, notes: &[String]) -> String {
        let case = if self.index > 0 { format!(" --case {LIVE}") } else { String::new() };
        let core = self.opening.core.as_deref().filter(|core| *core != "fixed");
        let core = core.map_or(String::new(), |core| format!(" --core {core}"));
        let differs = match notes.is_empty() {
            true => "the rows that hapticore live has shown, to the bit".into(),
            false => format!("the rows that hapticore live has shown, but: {}", notes.join("; ")),
        };
        format!(
            "# SPDX-License-Identifier: MIT OR Apache-2.0\n# Recorded by hapticore live. \
             hapticore simulate {name}{case}{core} gives {differs}.\n"
        )
    }

    /// Title, duration, profile and cases.
    fn write_head(&self, root: &mut Table, slots: usize, stepper: &Stepper) {
        root.remove("criterion");
        let title = root.get("title").and_then(Value::as_str).unwrap_or_default();
        root.insert("title".into(), format!("{title}, recorded live").into());
        // Half a slot more, so that rounding leaves out none.
        root.insert("duration_s".into(), self.time_s(slots, 0.5).into());
        if let Some(profile) = &self.opening.profile {
            root.insert("profile".into(), profile.as_str().into());
        }
        // The controller is tuned at a load that would follow from the recorded one.
        if let Some(control) = root.get_mut("control").and_then(Value::as_table_mut) {
            control.entry("nominal_load_g").or_insert(stepper.plant().mean_load_g().into());
        }
        if self.index > 0 {
            let before = (0..self.index).map(|n| format!("not recorded {n}"));
            let case =
                |name: String| Value::Table(Table::from_iter([("name".to_string(), name.into())]));
            let cases = before.chain([LIVE.to_string()]).map(case).collect();
            root.insert("case".into(), Value::Array(cases));
        }
    }

    /// What was done to pads and walls; what of it cannot be written exactly.
    fn write_inputs(&self, root: &mut Table, slots: usize) -> Result<Vec<String>, String> {
        let before = root.clone();
        let mut scripts = Scripts::new(&before, self.clock.seconds(slots));
        let pads = before.get("pad").and_then(Value::as_array).map_or(0, Vec::len);
        let halves = before.get("halves");
        let quadrants = halves.and_then(|halves| halves.get("quadrants")?.as_bool()) == Some(true);
        let mut notes = Vec::new();
        for pad in 0..pads {
            let written = self.pad(pad, &mut scripts, &mut notes)?;
            root["pad"][pad].as_table_mut().expect("a pad is a table").extend(written);
        }
        if let Some(wall) = root.get_mut("wall").and_then(Value::as_table_mut) {
            let written = self.wall(wall, [true, quadrants], &mut notes)?;
            wall.extend(written);
        }
        if let Some(arena) = root.get_mut("arena").and_then(Value::as_table_mut) {
            self.serves(arena);
        }
        Ok(notes)
    }

    /// The keys of a pad that inputs have changed.
    fn pad(&self, pad: usize, scripts: &mut Scripts, notes: &mut Vec<String>) -> Written {
        let mut written = Vec::new();
        let motions: Vec<Motion> = self.motions(pad).collect();
        if !motions.is_empty() {
            let track = Track::of(motions.into_iter(), scripts.place(pad)?);
            written.push(("position_mm".to_string(), track.written(notes)));
        }
        for (key, default) in DEFAULTS {
            let steps = Steps::of(self.values(pad, key));
            if !steps.is_empty() {
                let script = scripts.value(pad, key, default)?;
                written.push((key.to_string(), steps.written(&script, notes)));
            }
        }
        Ok(written)
    }

    /// The keys of the walls that inputs have changed.
    fn wall(&self, wall: &Table, there: [bool; 2], notes: &mut Vec<String>) -> Written {
        let word = |key: &str| wall.get(key).and_then(Value::as_str);
        let above = [word("inside") == Some("right"), word("inside_y") == Some("above")];
        let mut written = Vec::new();
        for (axis, key) in ["surface_mm", "surface_y_mm"].into_iter().enumerate() {
            let steps = Steps::of(self.walls(axis, above[axis]));
            if steps.is_empty() || !there[axis] {
                continue;
            }
            let script = Scripts::of_key(wall, key, 0.0).ok_or_else(|| {
                format!("record: wall.{key}: expected a number or a timeline; to log writes others")
            })?;
            written.push((key.to_string(), steps.written(&script, notes)));
        }
        Ok(written)
    }

    /// When pucks were served, besides those of the scene.
    fn serves(&self, arena: &mut Table) {
        let served = self.entries.iter().filter(|entry| entry.input == Input::Serve);
        let mut serve_s: Vec<f64> =
            served.map(|entry| self.time_s(entry.slot, WITHIN_SLOT)).collect();
        if serve_s.is_empty() {
            return;
        }
        let scripted = arena.get("serve_s").and_then(Value::as_array).into_iter().flatten();
        serve_s.extend(
            scripted.filter_map(|of| of.as_float().or(of.as_integer().map(|whole| whole as f64))),
        );
        serve_s.sort_by(f64::total_cmp);
        arena.insert("serve_s".into(), serve_s.into());
    }

    /// How the finger of a pad was led.
    fn motions(&self, pad: usize) -> impl Iterator<Item = Motion> {
        self.entries.iter().filter_map(move |entry| {
            let from_s = self.clock.seconds(entry.slot);
            let (of, within_s, to_mm) = match entry.input {
                Input::Lead { pad, to_mm, within_s } => (pad, within_s, Some(to_mm)),
                Input::Release { pad } => (pad, RELEASE_S, None),
                _ => return None,
            };
            (of == pad).then_some(Motion { from_s, at_s: from_s + within_s, to_mm })
        })
    }

    /// Values of a pad's key, and from when on they hold.
    fn values(&self, pad: usize, key: &str) -> impl Iterator<Item = [f64; 2]> {
        self.entries.iter().filter_map(move |entry| {
            let (of, value, within) = match (&entry.input, key) {
                (Input::Press { pad, load_g }, "load_g") => (*pad, *load_g, 0.0),
                (Input::Voltage { pad, v_rms }, "haptic_v_rms") => (*pad, *v_rms, 0.0),
                (Input::Push { pad, newtons }, "push_x_n") => (*pad, newtons[0], 0.0),
                (Input::Push { pad, newtons }, "push_y_n") => (*pad, newtons[1], 0.0),
                (Input::Target { pad, newtons }, "target_n") => (*pad, *newtons, WITHIN_SLOT),
                _ => return None,
            };
            (of == pad).then_some([self.time_s(entry.slot, within), value])
        })
    }

    /// Places of a wall, and from when on they hold.
    fn walls(&self, axis: usize, above: bool) -> impl Iterator<Item = [f64; 2]> {
        let off_mm = if above { FAR_MM } else { -FAR_MM };
        self.entries.iter().filter_map(move |entry| {
            let Input::Wall { x_mm, y_mm, off } = entry.input else { return None };
            let mm = if off { Some(off_mm) } else { [x_mm, y_mm][axis] };
            Some([self.time_s(entry.slot, WITHIN_SLOT), mm?])
        })
    }

    fn time_s(&self, slot: usize, within: f64) -> f64 {
        self.clock.seconds(slot) + within * self.clock.seconds(1)
    }
}

/// What was written, by key.
type Written = Result<Vec<(String, Value)>, String>;

/// The keys of a pad that hold values, and what they are in a scene that leaves them out.
const DEFAULTS: [(&str, f64); 5] = [
    ("load_g", DEFAULT_LOAD_G),
    ("haptic_v_rms", 0.0),
    ("target_n", 0.0),
    ("push_x_n", 0.0),
    ("push_y_n", 0.0),
];

/// The case's name in a scene that has others before it.
const LIVE: &str = "live";

fn stem(scene: &str) -> &str {
    let base = scene.rsplit(['/', '\\']).next().unwrap_or(scene);
    base.strip_suffix(".toml").unwrap_or(base)
}
