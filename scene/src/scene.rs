// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene, read and checked.
//!
//! ```toml
//! title = "Force over position"
//! summary = "One pad rastered over the sheet"
//! profile = "standard"            # the core's; default "standard"
//! seed = 1                        # of noise and mismatch; default 1
//! figure = "fig3"                 # fig3 | fig4 | fig6 | hockey; how a report draws it
//! record = ["frames", "report"]   # frames | report | capture | waves
//! dwell_slots = 1                 # slots of each pad at each point of a sweep, or
//! duration_s = 2.0                # time, where pads move and nothing is swept
//!
//! [[pad]]                         # 1 to 16; served one slot each in turn
//! name = "mallet"
//! position_mm = [0, 0]            # see `path`
//! load_g = 50                     # see `course`; also haptic_v_rms, capacitance_pf
//!
//! [device]                        # width_mm, height_mm, pad_diameter_mm, mu
//! [sheet]                         # effects, each with its `rung`; see `effects`
//! [gap]
//! [friction]
//! [carrier]
//! [sensor]
//!
//! [[case]]                        # variants of the scene, run one after the other; a single "main" where there is none
//! name = "500-ohm"
//! set = { "sheet.terminal_ohm" = 500 }
//!
//! [[criterion]]                   # see `criterion`
//! ```

use crate::criterion::Criterion;
use crate::device::Device;
use crate::effects::{EFFECTS, Spec, carrier};
use crate::error::SceneError;
use crate::format::{self, Limits, Node, Table};
use crate::pad::PadPlan;

/// The most pads of a scene.
const MOST_PADS: usize = 16;

/// Keys that belong to the scene as a whole, so that a case cannot set them.
const WHOLE: [&str; 8] = ["title", "summary", "profile", "seed", "figure", "record", "case", "criterion"];

/// How a report draws the scene, after the paper's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// The sensor's sum over pad position.
    Fig3,
    /// The sensor's sum over load and haptic voltage.
    Fig4,
    /// Friction and eq. 8 over the haptic voltage.
    Fig6,
    /// Paths of several pads.
    Hockey,
}

/// Something that running a scene writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// One row per finished slot.
    Frames,
    /// The figures.
    Report,
    /// The ADC's samples.
    Capture,
    /// Waveforms of the core's signals.
    Waves,
}

/// A scene of one or more cases.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The file's name without folder and `.toml`.
    pub name: String,
    /// One line.
    pub title: String,
    /// A few sentences.
    pub summary: String,
    /// Name of the core's profile.
    pub profile: String,
    /// Seed of noise and mismatch.
    pub seed: u64,
    /// How a report draws it.
    pub figure: Option<Figure>,
    /// What running it writes.
    pub record: Vec<Record>,
    /// Variants, run one after the other.
    pub cases: Vec<Case>,
    /// What it claims.
    pub criteria: Vec<Criterion>,
}

/// One variant of a scene.
#[derive(Clone)]
pub struct Case {
    /// The case's name, `main` for a scene without cases.
    pub name: String,
    /// The device in this case; its sample rate is not a number until a plant is built for a profile.
    pub device: Device,
    pub(crate) pads: Vec<PadPlan>,
    pub(crate) effects: Vec<Spec>,
    pub(crate) length: Length,
}

/// How long a case lasts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Length {
    Sweep { points: usize, dwell_slots: usize },
    Time { duration_s: f64 },
}

impl std::fmt::Debug for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let effects: Vec<_> = self.effects.iter().map(|effect| (effect.name, &effect.rung)).collect();
        f.debug_struct("Case").field("name", &self.name).field("pads", &self.pads).field("effects", &effects).finish()
    }
}

impl Case {
    /// Names of the pads, in the order of their slots.
    pub fn pad_names(&self) -> Vec<&str> {
        self.pads.iter().map(|pad| pad.name.as_str()).collect()
    }

    /// The effects that are on, with their rungs.
    pub fn effects(&self) -> Vec<(&'static str, &str)> {
        self.effects.iter().map(|effect| (effect.name, effect.rung.as_str())).collect()
    }

    /// Whether the scene wants the float core to demodulate samples too, carrier rung `samples`.
    pub fn sampled(&self) -> bool {
        self.effects.iter().any(|effect| effect.name == "carrier" && effect.rung == carrier::SAMPLES)
    }

    fn read(root: &Table, name: &str) -> Result<Case, SceneError> {
        let device = Device::read(root)?;
        let effects: Vec<Spec> =
            EFFECTS.iter().filter_map(|read| read(root, &device).transpose()).collect::<Result<_, _>>()?;
        let has_gap = effects.iter().any(|effect| effect.name == "gap");
        let tables = root.tables("pad")?;
        if tables.is_empty() || tables.len() > MOST_PADS {
            return Err(
                root.error("pad", format!("expected 1 to {MOST_PADS} tables headed [[pad]], got {}", tables.len()))
            );
        }
        let plan = |(index, table): (usize, &&Table)| PadPlan::read(table, index, &device, has_gap);
        let pads = tables.iter().enumerate().map(plan).collect::<Result<Vec<_>, _>>()?;
        Ok(Case { name: name.to_string(), length: Length::read(root, &pads)?, device, pads, effects })
    }
}

impl Length {
    fn read(root: &Table, pads: &[PadPlan]) -> Result<Length, SceneError> {
        let duration_s = root.number("duration_s", Limits::above(0.0, 1e5))?;
        let dwell = root.whole("dwell_slots", 1, 1_000_000)?;
        let points = pads.iter().map(PadPlan::points).max().unwrap_or(1);
        match (duration_s, dwell) {
            (Some(duration_s), None) if points == 1 => Ok(Length::Time { duration_s }),
            (Some(_), None) => Err(root.error("duration_s", "expected none, since the sweep decides the duration")),
            (Some(_), Some(_)) => Err(root.error("dwell_slots", "expected either this or duration_s")),
            (None, None) if pads.iter().any(PadPlan::moves) && points == 1 => {
                Err(root
                    .error("duration_s", "expected a number above 0, since a pad changes over time, but it is missing"))
            }
            (None, dwell) => Ok(Length::Sweep { points, dwell_slots: dwell.unwrap_or(1) as usize }),
        }
    }
}

impl Scene {
    /// Reads a scene. `file` is its name in messages; `overrides` are keys and values as in `--set KEY=VALUE` and win over
    /// the file and its cases.
    pub fn parse(text: &str, file: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
        Scene::read(text, file, overrides).map_err(|error| error.in_file(file))
    }

    fn read(text: &str, file: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
        let mut root = format::parse(text)?;
        override_all(&mut root, overrides)?;
        let variants = variants(&root)?;
        let names: Vec<String> = variants.iter().map(|variant| variant.name.clone()).collect();
        let mut scene = Scene::read_head(&root, stem(file), &names)?;
        for variant in variants {
            let mut tree = root.clone();
            for (key, node) in variant.set {
                format::apply(&mut tree, &key, node)?;
            }
            override_all(&mut tree, overrides)?;
            scene.cases.push(Case::read(&tree, &variant.name)?);
            tree.refuse_unknown()?;
        }
        Ok(scene)
    }

    fn read_head(root: &Table, name: &str, cases: &[String]) -> Result<Scene, SceneError> {
        let figures =
            [("fig3", Figure::Fig3), ("fig4", Figure::Fig4), ("fig6", Figure::Fig6), ("hockey", Figure::Hockey)];
        let figure = root.choice("figure", &figures.map(|(name, _)| name))?;
        Ok(Scene {
            name: name.to_string(),
            title: root.require("title", "text", root.text("title")?)?,
            summary: root.text("summary")?.unwrap_or_default(),
            profile: root.text("profile")?.unwrap_or_else(|| "standard".to_string()),
            seed: root.whole("seed", 0, i64::MAX as u64)?.unwrap_or(1),
            figure: figures.into_iter().find(|(name, _)| Some(*name) == figure).map(|(_, figure)| figure),
            record: read_record(root)?,
            cases: Vec::new(),
            criteria: root
                .tables("criterion")?
                .iter()
                .map(|one| Criterion::read(one, cases))
                .collect::<Result<_, _>>()?,
        })
    }
}

fn read_record(root: &Table) -> Result<Vec<Record>, SceneError> {
    let Some(words) = root.texts("record")? else { return Ok(vec![Record::Frames, Record::Report]) };
    let record =
        |word: &String| match word.as_str() {
            "frames" => Ok(Record::Frames),
            "report" => Ok(Record::Report),
            "capture" => Ok(Record::Capture),
            "waves" => Ok(Record::Waves),
            other => Err(root
                .error("record", format!("expected \"frames\", \"report\", \"capture\" or \"waves\", got {other:?}"))),
        };
    words.iter().map(record).collect()
}

/// A case before it is read: its name and what it sets.
struct Variant {
    name: String,
    set: Vec<(String, Node)>,
}

fn variants(root: &Table) -> Result<Vec<Variant>, SceneError> {
    let mut variants: Vec<Variant> = Vec::new();
    for table in root.tables("case")? {
        let variant = Variant::read(table)?;
        if variants.iter().any(|other| other.name == variant.name) {
            return Err(table.error("name", format!("expected a name of its own, got {:?} again", variant.name)));
        }
        variants.push(variant);
    }
    if variants.is_empty() {
        variants.push(Variant { name: "main".to_string(), set: Vec::new() });
    }
    Ok(variants)
}

impl Variant {
    fn read(table: &Table) -> Result<Variant, SceneError> {
        let name = table.require("name", "text", table.text("name")?)?;
        let mut set = Vec::new();
        for (key, node) in table.table("set")?.into_iter().flat_map(Table::all) {
            if WHOLE.contains(&key.split('.').next().unwrap_or_default()) {
                return Err(table.error("set", format!("{key} belongs to the whole scene, a case cannot set it")));
            }
            set.push((key.to_string(), node.moved_to(key)));
        }
        Ok(Variant { name, set })
    }
}

fn override_all(root: &mut Table, overrides: &[(String, String)]) -> Result<(), SceneError> {
    overrides.iter().try_for_each(|(key, value)| format::apply(root, key, format::parse_value(key, value)?))
}

fn stem(file: &str) -> &str {
    let base = file.rsplit(['/', '\\']).next().unwrap_or(file);
    base.strip_suffix(".toml").unwrap_or(base)
}
