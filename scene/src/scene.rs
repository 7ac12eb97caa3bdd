// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene, read and checked.
//!
//! ```toml
//! title = "Force over position"
//! summary = "One pad rastered over the sheet"
//! profile = "standard"            # the core's; default "standard"
//! window_samples = 5000           # of the core's window, where the profile's is too short for the haptic frequency
//! settle_samples = 390            # before the window, where the profile's slots are too long
//! seed = 1                        # of noise and mismatch; default 1
//! figure = "fig3"                 # fig3 | fig4 | fig6 | fig7 | fig9 | fig13 | fig15 | hockey; how a report draws it
//! record = ["frames", "report"]   # frames | report | capture | waves
//! dwell_slots = 1                 # slots of each pad at each point of a sweep, or
//! duration_s = 2.0                # time, where pads move and nothing is swept
//! uncouple = true                 # the host takes out of measurements what [coupling] did to them
//! error_budget_percent = 0.1      # chooses the levels that the effects' tables leave open; see `budget`
//!
//! [[pad]]                         # 1 to 16; selected for one slot each in turn
//! name = "mallet"
//! position_mm = [0, 0]            # see `trajectory`
//! load_g = 50                     # see `stimulus`; also haptic_v_rms, capacitance_pf; with
//!                                 # [hand] push_x_n, push_y_n; with [halves] eccentricity_mm
//!
//! [device]                        # width_mm, height_mm, pad_diameter_mm, mu, gravity_m_s2
//! [sheet]                         # effects, each with its `rung`; see `effects`
//! [supply]
//! [charge]
//! [gap]
//! [halves]
//! [hand]
//! [release]
//! [friction]
//! [temperature]
//! [shunt]
//! [coupling]
//! [switching]
//! [carrier]
//! [sensor]
//!
//! [control]                       # see `control`
//! [wall]                          # see `wall`
//! [arena]                         # see `arena`
//!
//! [[case]]                        # variants of the scene, run one after the other; a single "main" where there is none
//! name = "500-ohm"
//! set = { "sheet.terminal_ohm" = 500 }
//!
//! [calibration]                   # the device as it was calibrated, where it has changed since
//! set = { "device.mu" = 0.12 }    # keys as in a case's `set`; false takes one away
//!
//! [[criterion]]                   # see `criterion`
//! ```

use crate::case::Case;
use crate::criterion::Criterion;
use crate::error::SceneError;
use crate::format::{self, Table};
use crate::variant::{calibrated, is_whole, variants};

/// How a report draws the scene, after the paper's figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// The sensor's sum over pad position.
    Fig3,
    /// The sensor's sum over load and haptic voltage.
    Fig4,
    /// Friction and eq. 8 over the haptic voltage.
    Fig6,
    /// Friction, eq. 8 and the pad's voltage over time.
    Fig7,
    /// The force beside its target.
    Fig9,
    /// The direction that is read over the eccentricity of the push.
    Fig13,
    /// A pad at a wall: its place, the hand's force and the wall's over time.
    Fig15,
    /// Paths of several pads.
    Hockey,
}

/// Something that running a scene writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Record {
    /// One row per finished slot.
    Frames,
    /// A report with figures.
    Report,
    /// The ADC's samples.
    Capture,
    /// Waveforms of the core's signals.
    Waves,
}

/// A scene of one or more cases.
///
/// ```
/// use hapticore_scene::Scene;
///
/// let text = "title = \"two loads\"\n[[pad]]\nposition_mm = [0, 0]\n\
///             [[case]]\nname = \"light\"\nset = { \"pad.0.load_g\" = 20 }\n\
///             [[case]]\nname = \"heavy\"\nset = { \"pad.0.load_g\" = 100 }\n";
/// let overrides = [("seed".to_string(), "7".to_string())]; // as --set seed=7
/// let scene = Scene::parse(text, "loads.toml", &overrides)?;
/// assert_eq!((scene.name.as_str(), scene.profile.as_str(), scene.seed), ("loads", "standard", 7));
/// assert_eq!(scene.cases[1].name, "heavy");
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    /// The file's name without folder and `.toml`.
    pub name: String,
    /// The file, as messages name it.
    pub file: String,
    /// Title of the scene, one line.
    pub title: String,
    /// A few sentences.
    pub summary: String,
    /// Name of the core's profile.
    pub profile: String,
    /// Samples of the core's integration window, where the scene does not leave it to the profile.
    pub window_samples: Option<u64>,
    /// Samples for a pad to settle before its window, where the scene does not leave it to the
    /// profile.
    pub settle_samples: Option<u64>,
    /// Seed of noise and mismatch.
    pub seed: u64,
    /// How a report draws it.
    pub figure: Option<Figure>,
    /// What running it writes.
    pub record: Vec<Record>,
    /// Variants, run one after the other.
    pub cases: Vec<Case>,
    /// The criteria that a run checks.
    pub criteria: Vec<Criterion>,
}

impl Scene {
    /// Reads a scene. `file` is its name in messages; `overrides` are keys and values as in `--set
    /// KEY=VALUE` and win over the file and its cases.
    ///
    /// # Errors
    /// A text that is no scene: the message names file, line and key, what was expected and what
    /// was found.
    pub fn parse(
        text: &str,
        file: &str,
        overrides: &[(String, String)],
    ) -> Result<Scene, SceneError> {
        Scene::read(text, file, overrides).map_err(|error| error.in_file(file))
    }

    fn read(text: &str, file: &str, overrides: &[(String, String)]) -> Result<Scene, SceneError> {
        let mut root = format::parse(text)?;
        override_all(&mut root, overrides)?;
        let variants = variants(&root)?;
        let names: Vec<String> = variants.iter().map(|variant| variant.name.clone()).collect();
        let mut scene = Scene::read_head(&root, file, &names)?;
        for variant in variants {
            let mut tree = root.clone();
            for (key, node) in variant.set {
                format::apply(&mut tree, &key, node)?;
            }
            // What belongs to the whole scene has been read, and no case can have changed it.
            let of_cases = overrides.iter().filter(|(key, _)| !is_whole(key)).cloned();
            override_all(&mut tree, &of_cases.collect::<Vec<_>>())?;
            let case = Scene::read_case(&tree, &variant.name)?;
            scene.cases.push(case.sharing_effects(&scene.cases));
        }
        Ok(scene)
    }

    fn read_case(tree: &Table, name: &str) -> Result<Case, SceneError> {
        let mut case = Case::read(tree, name)?;
        if let Some(then) = calibrated(tree)? {
            let then_case = Case::read(&then, name)?;
            then.refuse_unknown()?;
            let [now, before] = [&case, &then_case].map(|case| case.device.terminals());
            if now != before {
                let message =
                    format!("expected the {now} terminals that the device has, got {before}");
                return Err(tree.error("calibration.set", message));
            }
            case.nominal.clone_from(&then_case.nominal);
            case.calibrated = Some(Box::new(then_case));
        }
        tree.refuse_unknown()?;
        Ok(case)
    }

    fn read_head(root: &Table, file: &str, cases: &[String]) -> Result<Scene, SceneError> {
        let figures = [
            ("fig3", Figure::Fig3),
            ("fig4", Figure::Fig4),
            ("fig6", Figure::Fig6),
            ("fig7", Figure::Fig7),
            ("fig9", Figure::Fig9),
            ("fig13", Figure::Fig13),
            ("fig15", Figure::Fig15),
            ("hockey", Figure::Hockey),
        ];
        let figure = root.choice("figure", &figures.map(|(name, _)| name))?;
        Ok(Scene {
            name: stem(file).to_string(),
            file: file.to_string(),
            title: root.require("title", "text", root.text("title")?)?,
            summary: root.text("summary")?.unwrap_or_default(),
            profile: root.text("profile")?.unwrap_or_else(|| "standard".to_string()),
            window_samples: root.whole("window_samples", 1, 1 << 20)?,
            settle_samples: root.whole("settle_samples", 0, 1 << 20)?,
            seed: root.whole("seed", 0, i64::MAX as u64)?.unwrap_or(1),
            figure: figures
                .into_iter()
                .find(|(name, _)| Some(*name) == figure)
                .map(|(_, figure)| figure),
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
    let Some(words) = root.texts("record")? else {
        return Ok(vec![Record::Frames, Record::Report]);
    };
    let record = |word: &String| match word.as_str() {
        "frames" => Ok(Record::Frames),
        "report" => Ok(Record::Report),
        "capture" => Ok(Record::Capture),
        "waves" => Ok(Record::Waves),
        other => Err(root.error(
            "record",
            format!("expected \"frames\", \"report\", \"capture\" or \"waves\", got {other:?}"),
        )),
    };
    words.iter().map(record).collect()
}

fn override_all(root: &mut Table, overrides: &[(String, String)]) -> Result<(), SceneError> {
    overrides
        .iter()
        .try_for_each(|(key, value)| format::apply(root, key, format::parse_value(key, value)?))
}

fn stem(file: &str) -> &str {
    let base = file.rsplit(['/', '\\']).next().unwrap_or(file);
    base.strip_suffix(".toml").unwrap_or(base)
}
