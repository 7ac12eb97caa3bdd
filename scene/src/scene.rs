// SPDX-License-Identifier: MIT OR Apache-2.0
//! A scene, read and checked.
//!
//! Its keys are declared beside what reads them; `reference::SECTIONS` lists them all.

use crate::case::Case;
use crate::criterion::Criterion;
use crate::error::SceneError;
use crate::format::{self, Table};
use crate::head::{self, Figure, Record, is_whole};
use crate::reference;
use crate::variant::{calibrated, variants};

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
            then.refuse_unknown(reference::elsewhere)?;
            let [now, before] = [&case, &then_case].map(|case| case.device.terminals());
            if now != before {
                let message =
                    format!("expected the {now} terminals that the device has, got {before}");
                return Err(tree.error("calibration.set", message));
            }
            case.nominal.clone_from(&then_case.nominal);
            case.calibrated = Some(Box::new(then_case));
        }
        tree.refuse_unknown(reference::elsewhere)?;
        debug_assert_eq!(reference::undeclared(tree.asked()), Vec::<String>::new());
        Ok(case)
    }

    fn read_head(root: &Table, file: &str, cases: &[String]) -> Result<Scene, SceneError> {
        Ok(Scene {
            name: stem(file).to_string(),
            file: file.to_string(),
            title: root.get(&head::TITLE)?,
            summary: root.get(&head::SUMMARY)?,
            profile: root.get(&head::PROFILE)?,
            window_samples: root.get(&head::WINDOW_SAMPLES)?,
            settle_samples: root.get(&head::SETTLE_SAMPLES)?,
            seed: root.get(&head::SEED)?,
            figure: root.get(&head::FIGURE)?,
            record: head::record(root)?,
            cases: Vec::new(),
            criteria: root
                .tables("criterion")?
                .iter()
                .map(|one| Criterion::read(one, cases))
                .collect::<Result<_, _>>()?,
        })
    }
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::gallery;

    /// Tables and keys that no bundled scene has.
    const OTHERS: [&str; 3] = [
        "title = \"t\"\n[calibration]\nset = { \"device.mu\" = 0.1 }\n[sheet]\nslope_percent = [1, 0]\n\
         [[sheet.patch]]\ncentre_mm = [0, 0]\nsize_mm = [9, 9]\nohm_per_square = 9\n[device]\n\
         [temperature]\ntempco_ppm_per_k = 1\nspring_percent_per_k = 1\n[gap]\n\
         [[pad]]\nposition_mm = { raster = { nx = 2, ny = 2 } }\n\
         load_g = { sweep = { from = 1, to = 2, points = 3 } }\n[release]\n[friction]\n",
        "title = \"t\"\nduration_s = 1\n[charge]\nshare = 0.1\ntime_constant_s = 1\n[halves]\nstrips = 4\n[gap]\n\
         [[pad]]\nposition_mm = { circle = { radius_mm = 9, period_s = 1 } }\n\
         load_g = { sine = { amplitude = 1, mean = 2, frequency_hz = 1 } }\n",
        "title = \"t\"\nduration_s = 1\n[[pad]]\n\
         position_mm = { lissajous = { amplitude_mm = [1, 2], frequency_hz = [1, 2] } }\n[sensor]\n\
         haptic_leakage = true\nhaptic_leakage_of_others = true\nnoise_density_na_per_rthz = 1\n",
    ];

    /// Every key that reading a scene asks for.
    fn asked(text: &str) -> Vec<String> {
        let root = format::parse(text).unwrap();
        let variants = variants(&root).unwrap();
        let names: Vec<_> = variants.iter().map(|variant| variant.name.clone()).collect();
        Scene::read_head(&root, "s.toml", &names).unwrap();
        let mut asked = Vec::new();
        for variant in variants {
            let mut tree = root.clone();
            for (key, node) in variant.set {
                format::apply(&mut tree, &key, node).unwrap();
            }
            Scene::read_case(&tree, &variant.name).unwrap();
            asked.extend(tree.asked());
        }
        asked
    }

    #[test]
    fn every_key_that_is_read_is_declared_and_the_other_way_round() {
        let texts = gallery::all().iter().map(|(_, text)| *text).chain(OTHERS);
        let asked: BTreeSet<String> = texts.flat_map(asked).collect();
        let unknown = reference::undeclared(asked.iter().cloned().collect());
        assert!(unknown.is_empty(), "read and not declared: {unknown:?}");
        let read: BTreeSet<_> = asked
            .iter()
            .filter_map(|path| reference::key(path))
            .map(|(section, key)| (section.path, key.name))
            .collect();
        let declared = reference::SECTIONS
            .iter()
            .flat_map(|section| section.keys().map(|key| (section.path, key.name)));
        let unread: Vec<_> = declared.filter(|key| !read.contains(key)).collect();
        assert!(unread.is_empty(), "declared and not read: {unread:?}");
    }
}
