// SPDX-License-Identifier: MIT OR Apache-2.0
//! One variant of a scene, read: the device, what its pads do, which effects are on and how long it
//! lasts.

use std::sync::Arc;

use crate::arena::ArenaPlan;
use crate::control::ControlPlan;
use crate::device::Device;
use crate::doubts;
use crate::effects::{EFFECTS, SPLITTING, Spec, carrier, part};
use crate::error::SceneError;
use crate::format::{Key, Limits, Node, Table, Value, keys};
use crate::pad::{PadPlan, Tables};
use crate::stimulus::Moment;
use crate::timing::Timing;

/// The most pads of a scene.
const MOST_PADS: usize = 16;

/// The most points of a sweep, every combination of the quantities that a pad sweeps.
const MOST_POINTS: usize = 10_000_000;

keys! { KEYS:
    /// How long the scene goes on, where pads move and nothing is swept.
    DURATION_S: Option<f64> = Key::number("duration_s", Limits::above(0.0, 1e5));
    /// Slots of each pad at each point of a sweep.
    DWELL_SLOTS: Option<u64> = Key::whole("dwell_slots", 1, 1_000_000).usually("1");
    /// The host takes out of measurements what `[coupling]` did to them.
    UNCOUPLE: bool = Key::flag("uncouple");
    /// Largest error that fidelity levels may add: chooses the levels that the effects' tables leave open.
    ERROR_BUDGET_PERCENT: Option<f64> = Key::number("error_budget_percent", Limits::above(0.0, 100.0));
}

/// Keys of a scene that say what is done with its device, and not what that is.
const DONE_WITH_IT: [&str; 10] = [
    "title",
    "summary",
    "case",
    "criterion",
    "pad",
    "control",
    "wall",
    "arena",
    "duration_s",
    "dwell_slots",
];

/// Those of them that say what its pads do.
const OF_PADS: [&str; 5] = ["pad", "wall", "arena", "duration_s", "dwell_slots"];

/// Keys of `[sheet]` of which the host knows nothing: what makes a film non-uniform.
const UNEVEN: [&str; 2] = ["slope_percent", "patch"];

/// One variant of a scene.
///
/// ```
/// use hapticore_scene::Scene;
///
/// let text = "title = \"t\"\n[[pad]]\nname = \"puck\"\nposition_mm = [0, 0]\nload_g = { sweep = [20, 50] }\n[gap]\n";
/// let case = &Scene::parse(text, "t.toml", &[])?.cases[0];
/// assert_eq!((case.name.as_str(), case.pad_names(), case.swept()), ("main", vec!["puck"], vec!["load_g"]));
/// assert_eq!(case.effects(), [("gap", "static"), ("carrier", "phasor")]);
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone)]
pub struct Case {
    /// The case's name, `main` for a scene without cases.
    pub name: String,
    /// The case as a scene of its own, in TOML, with everything that it and `--set` set.
    pub document: String,
    /// The device in this case; its sample rate is not a number until a plant is built for a
    /// profile.
    pub device: Device,
    /// The force controller that drives the pads, where the scene has one.
    pub control: Option<ControlPlan>,
    /// The table of air hockey that the pads play on, where the scene has one.
    pub arena: Option<ArenaPlan>,
    pub(crate) pads: Vec<PadPlan>,
    /// All that the scene says of the device, and what its pads do, but for their target forces.
    of_device: Arc<toml::Table>,
    of_pads: Arc<toml::Table>,
    /// Where what each slot of a pad serves lies, mm right of the pad's centre and above it.
    pub(crate) parts_mm: Vec<[f64; 2]>,
    pub(crate) effects: Vec<Spec>,
    pub(crate) length: Length,
    /// Error that all levels together may leave, where the scene names one: until they are chosen,
    /// nothing can be run.
    pub(crate) budget_percent: Option<f64>,
    /// What the host knows of the device, where it takes out of measurements what other pads did to
    /// them: the effects that split a current, on a film that is even.
    pub(crate) nominal: Option<Vec<Spec>>,
    /// What its user must know before using the results, a sentence each, which begins with the key that is the cause.
    pub doubts: Vec<String>,
    /// The case as it was when the device was calibrated, where that is not as it is now.
    pub(crate) calibrated: Option<Box<Case>>,
}

/// How long a case lasts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Length {
    Sweep { points: usize, dwell_slots: usize },
    Time { duration_s: f64 },
}

impl std::fmt::Debug for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let effects: Vec<_> =
            self.effects.iter().map(|effect| (effect.name, &effect.level().label)).collect();
        f.debug_struct("Case")
            .field("name", &self.name)
            .field("pads", &self.pads)
            .field("effects", &effects)
            .finish()
    }
}

impl Case {
    /// Names of the pads, in the order of their slots.
    pub fn pad_names(&self) -> Vec<&str> {
        self.pads.iter().map(|pad| pad.name.as_str()).collect()
    }

    /// Where the pads start, mm right of the sheet's centre and above it.
    pub fn starts_mm(&self) -> Vec<[f64; 2]> {
        let set = |pad: &PadPlan| pad.set(0, Moment::at(0.0));
        self.pads.iter().map(|pad| [set(pad).x_mm, set(pad).y_mm]).collect()
    }

    /// The parts of each pad that have slots of their own; one where it is served as a whole.
    pub fn parts(&self) -> usize {
        self.parts_mm.len()
    }

    /// Where they lie, mm right of the pad's centre and above it.
    pub fn parts_mm(&self) -> &[[f64; 2]] {
        &self.parts_mm
    }

    /// What a core serves, slot after slot: the pads, or the parts of each.
    ///
    /// ```
    /// use hapticore_scene::Scene;
    ///
    /// let text = "title = \"t\"\n[[pad]]\nname = \"puck\"\nposition_mm = [0, 0]\n[gap]\n\
    ///             [halves]\nsenses = \"each\"\n";
    /// let case = &Scene::parse(text, "t.toml", &[])?.cases[0];
    /// assert_eq!(case.served_names(), ["puck, left", "puck, right"]);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn served_names(&self) -> Vec<String> {
        let parts: &[&str] = match self.parts_mm.len() {
            1 => &[""],
            4 => &[", top left", ", bottom left", ", bottom right", ", top right"],
            parts => &[", left", ", right", ", brake"][..parts],
        };
        let of_pad = |pad: &PadPlan| {
            let name = pad.name.clone();
            parts.iter().map(move |part| format!("{name}{part}"))
        };
        self.pads.iter().flat_map(of_pad).collect()
    }

    /// Finished slots under a core of this timing.
    pub fn slots(&self, timing: &Timing) -> usize {
        match self.length {
            Length::Sweep { points, dwell_slots } => {
                points * dwell_slots * self.pads.len() * self.parts_mm.len()
            }
            Length::Time { duration_s } => {
                let rate_hz = self.device.clone().sampled(timing).sample_rate_hz;
                (duration_s * rate_hz / timing.slot_samples as f64).floor() as usize
            }
        }
    }

    /// The keys of the pads that are swept, as [`Setpoint::get`](crate::Setpoint::get) knows them.
    pub fn swept(&self) -> Vec<&'static str> {
        let mut keys: Vec<&str> = Vec::new();
        for key in self.pads.iter().flat_map(PadPlan::swept) {
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
        keys
    }

    /// Whether the device is another case's, at the same levels, and serves as many pads, whatever is done with it: both
    /// have one calibration.
    ///
    /// ```
    /// use hapticore_scene::Scene;
    ///
    /// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[gap]\n\
    ///             [[case]]\nname = \"light\"\nset = { \"pad.0.load_g\" = 20 }\n\
    ///             [[case]]\nname = \"heavy\"\nset = { \"pad.0.load_g\" = 100 }\n\
    ///             [[case]]\nname = \"worn\"\nset = { \"device.mu\" = 0.3 }\n";
    /// let cases = Scene::parse(text, "t.toml", &[])?.cases;
    /// assert!(cases[1].has_device_of(&cases[0]) && !cases[2].has_device_of(&cases[0]));
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn has_device_of(&self, other: &Case) -> bool {
        self.of_device == other.of_device
            && self.pads.len() == other.pads.len()
            && self.effects() == other.effects()
    }

    /// What of the device has changed since it was calibrated: `gap.insulator_um: 16 → 20.8`, with `default` where the
    /// scene says nothing.
    ///
    /// ```
    /// use hapticore_scene::Scene;
    ///
    /// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[device]\nmu = 0.3\n\
    ///             [calibration]\nset = { \"device.mu\" = 0.12 }\n";
    /// let case = &Scene::parse(text, "worn.toml", &[])?.cases[0];
    /// assert_eq!(case.changed_since_calibration(), ["device.mu: 0.12 → 0.3"]);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn changed_since_calibration(&self) -> Vec<String> {
        let Some(then) = &self.calibrated else { return Vec::new() };
        let mut now = (*self.of_device).clone();
        now.remove("calibration");
        let mut changes = Vec::new();
        differences("", &now.into(), &(*then.of_device).clone().into(), &mut changes);
        changes
    }

    /// Whether the pads do the same on the same device, but for the forces that a controller shall give them.
    ///
    /// ```
    /// use hapticore_scene::Scene;
    ///
    /// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\ntarget_n = 0\n[gap]\n[friction]\n[control]\n\
    ///             [[case]]\nname = \"weak\"\nset = { \"pad.0.target_n\" = 0.3 }\n\
    ///             [[case]]\nname = \"strong\"\nset = { \"pad.0.target_n\" = 0.6 }\n\
    ///             [[case]]\nname = \"heavy\"\nset = { \"pad.0.load_g\" = 80 }\n";
    /// let cases = Scene::parse(text, "t.toml", &[])?.cases;
    /// assert!(cases[1].differs_in_targets_alone(&cases[0]) && !cases[2].differs_in_targets_alone(&cases[0]));
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn differs_in_targets_alone(&self, other: &Case) -> bool {
        self.has_device_of(other) && self.of_pads == other.of_pads
    }

    /// The same case with the effects of the first of others that has the same device, so that what they compute
    /// of it is computed once.
    pub(crate) fn sharing_effects(self, others: &[Case]) -> Case {
        match others.iter().find(|other| self.has_device_of(other)) {
            Some(Case { effects, nominal, calibrated, .. }) => {
                let calibrated = self.calibrated.zip(calibrated.as_ref());
                let calibrated = calibrated
                    .map(|(then, other)| Case { effects: other.effects.clone(), ..*then }.into());
                Case { effects: effects.clone(), nominal: nominal.clone(), calibrated, ..self }
            }
            None => self,
        }
    }

    /// The effects that are on, with their levels.
    pub fn effects(&self) -> Vec<(&'static str, &str)> {
        self.effects.iter().map(|effect| (effect.name, effect.level().label.as_str())).collect()
    }

    /// Whether the scene wants the float core to demodulate samples too, carrier level `samples`.
    pub fn sampled(&self) -> bool {
        self.effects
            .iter()
            .any(|effect| effect.name == carrier::CARRIER && effect.is_at(carrier::SAMPLES))
    }

    pub(crate) fn read(root: &Table, name: &str) -> Result<Case, SceneError> {
        let device = Device::read(root)?;
        let effects: Vec<Spec> = EFFECTS
            .iter()
            .filter_map(|read| read(root, &device).transpose())
            .collect::<Result<_, _>>()?;
        let has = |name| effects.iter().any(|effect| effect.name == name);
        let control = ControlPlan::read(root, &device)?;
        let arena = ArenaPlan::read(root, &device)?;
        let has = Tables {
            gap: has("gap"),
            finger: has("hand"),
            split_electrode: has("halves"),
            control: control.is_some(),
            charge: has("charge"),
        };
        let parts_mm = part::centres_mm(root, &device)?;
        let tables = root.tables("pad")?;
        if tables.is_empty() || tables.len() > MOST_PADS {
            return Err(root.error(
                "pad",
                format!("expected 1 to {MOST_PADS} tables headed [[pad]], got {}", tables.len()),
            ));
        }
        let plan = |(index, table): (usize, &&Table)| PadPlan::read(table, index, &device, has);
        let pads = tables.iter().enumerate().map(plan).collect::<Result<Vec<_>, _>>()?;
        let budget_percent = root.get(&ERROR_BUDGET_PERCENT)?;
        let cancels_crosstalk = root.get(&UNCOUPLE)?;
        if cancels_crosstalk && !effects.iter().any(|effect| effect.name == "coupling") {
            return Err(
                root.error("uncouple", "expected a [coupling] that could be taken out again")
            );
        }
        let nominal = if cancels_crosstalk { Some(nominal(root, &device)?) } else { None };
        let length = Length::read(root, &pads)?;
        let doubts = doubts::of_scene(root, (&device, &effects), control.as_ref(), &pads)?;
        Ok(Case {
            name: name.to_string(),
            document: document(root, name),
            of_device: of_device(root).into(),
            of_pads: of_pads(root).into(),
            length,
            device,
            control,
            arena,
            pads,
            parts_mm,
            effects,
            budget_percent,
            nominal,
            doubts,
            calibrated: None,
        })
    }
}

/// The text of a scene that is this case alone, with the criteria that cover it.
fn document(root: &Table, name: &str) -> String {
    let mut alone = root.clone();
    alone.remove("case");
    if let Some(Node { value: Value::List(criteria), .. }) = alone.find("criterion") {
        criteria.retain_mut(|node| match &mut node.value {
            Value::Table(criterion) => keep_covering(criterion, name),
            _ => true,
        });
    }
    alone.to_toml().to_string()
}

/// Adds the keys by which two values differ.
fn differences(key: &str, now: &toml::Value, then: &toml::Value, changes: &mut Vec<String>) {
    if let (toml::Value::Table(now), toml::Value::Table(then)) = (now, then) {
        let others = then.keys().filter(|key| !now.contains_key(*key));
        for name in now.keys().chain(others) {
            let none = toml::Value::from("default");
            let [now, then] = [now, then].map(|table| table.get(name).unwrap_or(&none));
            let dotted = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
            differences(&dotted, now, then, changes);
        }
    } else if now != then {
        let text = |value: &toml::Value| match value {
            toml::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        changes.push(format!("{key}: {} → {}", text(then), text(now)));
    }
}

/// What the scene says of its device.
fn of_device(root: &Table) -> toml::Table {
    let mut device = root.to_toml();
    device.retain(|key, _| !DONE_WITH_IT.contains(&key));
    device
}

/// What the scene says of its pads and their time, but for their target forces.
fn of_pads(root: &Table) -> toml::Table {
    let mut pads = root.to_toml();
    pads.retain(|key, _| OF_PADS.contains(&key));
    for pad in pads.get_mut("pad").and_then(|pads| pads.as_array_mut()).into_iter().flatten() {
        pad.as_table_mut().and_then(|pad| pad.remove("target_n"));
    }
    pads
}

/// Whether a criterion covers the case; it then names cases no more.
fn keep_covering(criterion: &mut Table, name: &str) -> bool {
    let is_name = |node: &Node| matches!(&node.value, Value::Text(text) if text == name);
    let covers = |node: &Node| match &node.value {
        Value::List(names) => names.iter().any(is_name),
        _ => is_name(node),
    };
    let all = ["case", "cases"].map(|key| criterion.find(key).is_none_or(|node| covers(node)));
    ["case", "cases"].into_iter().for_each(|key| criterion.remove(key));
    all == [true; 2]
}

/// Effects that split a current among the terminals, as they would be with a uniform film.
fn nominal(root: &Table, device: &Device) -> Result<Vec<Spec>, SceneError> {
    let mut even = root.clone();
    if let Node { value: Value::Table(sheet), .. } =
        even.entry("sheet", || unreachable!("coupling needs a sheet"))
    {
        UNEVEN.iter().for_each(|key| sheet.remove(key));
    }
    let specs = EFFECTS.iter().filter_map(|read| read(&even, device).transpose());
    let splitting = |spec: &Spec| SPLITTING.contains(&spec.name);
    specs.filter(|spec| spec.as_ref().is_ok_and(splitting)).collect()
}

impl Length {
    fn read(root: &Table, pads: &[PadPlan]) -> Result<Length, SceneError> {
        let duration_s = root.get(&DURATION_S)?;
        let dwell = root.get(&DWELL_SLOTS)?;
        let points = pads.iter().map(PadPlan::points).max().unwrap_or(1);
        if points > MOST_POINTS {
            let message = format!("expected at most {MOST_POINTS} points of a sweep, got more");
            return Err(root.error("pad", message));
        }
        match (duration_s, dwell) {
            (Some(duration_s), None) if points == 1 => Ok(Length::Time { duration_s }),
            (Some(_), None) => {
                Err(root.error("duration_s", "expected none, since the sweep decides the duration"))
            }
            (Some(_), Some(_)) => {
                Err(root.error("dwell_slots", "expected either this or duration_s"))
            }
            (None, None) if pads.iter().any(PadPlan::moves) && points == 1 => Err(root.error(
                "duration_s",
                "expected a number above 0, since a pad changes over time, but it is missing",
            )),
            (None, dwell) => Ok(Length::Sweep { points, dwell_slots: dwell.unwrap_or(1) as usize }),
        }
    }
}
