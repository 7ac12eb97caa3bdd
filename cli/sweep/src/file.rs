// SPDX-License-Identifier: MIT OR Apache-2.0
//! A plan's file as it is written, and the lines that its messages name.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Display;

use anyhow::{Result, bail, ensure};
use serde::{Deserialize, Serialize};
use toml::Spanned;

use crate::axis::{Axis, MOST, Points, Side, Values};

/// How exactly the core is run: what needs no clocks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Fidelity {
    /// The equations in floating point.
    Float,
    /// The core's results to the bit.
    #[default]
    Fixed,
}

impl Display for Fidelity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(hapticore_run::engine::Fidelity::from(*self).name())
    }
}

impl From<Fidelity> for hapticore_run::engine::Fidelity {
    fn from(fidelity: Fidelity) -> Self {
        match fidelity {
            Fidelity::Float => hapticore_run::engine::Fidelity::Float,
            Fidelity::Fixed => hapticore_run::engine::Fidelity::Fixed,
        }
    }
}

/// A plan's file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    pub scene: Spanned<String>,
    pub case: Option<Spanned<String>>,
    pub profile: Option<Spanned<String>>,
    pub fidelity: Option<Fidelity>,
    pub slots: Option<Spanned<i64>>,
    pub predicted: Option<Spanned<i64>>,
    pub seeds: Option<Spanned<Vec<i64>>>,
    pub axes: Option<Spanned<Axes>>,
    pub random: Option<Spanned<Random>>,
}

/// What is varied on either side.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axes {
    #[serde(default)]
    pub profile: Keys,
    #[serde(default)]
    pub scene: Keys,
}

/// What is drawn.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Random {
    pub count: u64,
    #[serde(default = "first")]
    pub seed: u64,
    #[serde(default)]
    pub profile: Keys,
    #[serde(default)]
    pub scene: Keys,
}

fn first() -> u64 {
    1
}

/// Keys as they are written, each perhaps a table of further ones.
type Keys = BTreeMap<Spanned<String>, toml::Value>;

impl File {
    /// Reads a plan's text.
    ///
    /// # Errors
    /// No TOML, an unknown key, a value of another kind: `LINE: what`.
    pub fn parse(text: &str) -> Result<File, String> {
        toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(1, |span| line(text, span.start));
            format!("{at}: {}", error.message().replace('\n', " "))
        })
    }

    /// A whole number of the plan.
    ///
    /// # Errors
    /// It is below `least`.
    pub fn whole(
        &self,
        lines: &Lines,
        key: &str,
        number: &Option<Spanned<i64>>,
        default: usize,
        least: usize,
    ) -> Result<usize> {
        let Some(number) = number else { return Ok(default) };
        match usize::try_from(*number.get_ref()) {
            Ok(whole) if (least..=1_000_000).contains(&whole) => Ok(whole),
            _ => bail!(
                "{}: expected {least} to 1000000, got {}",
                lines.at(&Some(number.clone()), key),
                number.get_ref()
            ),
        }
    }

    /// The seeds; the scene's own where there are none.
    ///
    /// # Errors
    /// An empty list, a negative number, the same twice.
    pub fn seeds(&self, lines: &Lines, own: u64) -> Result<Vec<u64>> {
        let Some(seeds) = &self.seeds else { return Ok(vec![own]) };
        let whole: Result<Vec<u64>, _> =
            seeds.get_ref().iter().map(|seed| u64::try_from(*seed)).collect();
        let each_once = |seeds: &[u64]| seeds.iter().collect::<HashSet<_>>().len() == seeds.len();
        match whole {
            Ok(whole) if !whole.is_empty() && each_once(&whole) => Ok(whole),
            _ => bail!(
                "{}: expected whole numbers, each once, got {:?}",
                lines.at(&self.seeds, "seeds"),
                seeds.get_ref()
            ),
        }
    }

    /// What is varied: a grid, or draws.
    ///
    /// # Errors
    /// Both, or values that are none.
    pub fn points(&self, lines: &Lines) -> Result<Points> {
        let sides = |profile: &Keys, scene: &Keys| -> Result<Vec<Axis>> {
            // What makes a plant anew varies slowest, so that neighbours share it.
            let mut axes = lines.axes(Side::Scene, scene)?;
            axes.extend(lines.axes(Side::Profile, profile)?);
            Ok(axes)
        };
        match (&self.axes, &self.random) {
            (Some(_), Some(random)) => bail!(
                "{}:{}: random: expected either [axes] or [random], got both",
                lines.name(),
                lines.line(random.span().start)
            ),
            (None, Some(random)) => {
                let Random { count, seed, profile, scene } = random.get_ref();
                Ok(Points::Random { count: *count, seed: *seed, axes: sides(profile, scene)? })
            }
            (axes, None) => {
                let none = Axes::default();
                let of = axes.as_ref().map_or(&none, Spanned::get_ref);
                let axes = sides(&of.profile, &of.scene)?;
                for axis in &axes {
                    let message =
                        "expected a list or { from, to, step }: only [random] draws without steps";
                    ensure!(axis.values.list().is_some(), "{}: {message}", lines.of_axis(axis));
                }
                Ok(Points::Grid(axes))
            }
        }
    }
}

/// Lines of a plan's file, for messages.
pub struct Lines {
    name: String,
    text: String,
    axes: BTreeMap<(Side, String), usize>,
}

impl Lines {
    /// Those of a plan's text.
    pub fn of(name: &str, text: &str, file: &File) -> Self {
        let random = file.random.as_ref().map(Spanned::get_ref);
        let axes = file.axes.as_ref().map(Spanned::get_ref);
        let profile = [random.map(|of| &of.profile), axes.map(|of| &of.profile)];
        let scene = [random.map(|of| &of.scene), axes.map(|of| &of.scene)];
        let mut lines = BTreeMap::new();
        for (side, keys) in [(Side::Profile, profile), (Side::Scene, scene)] {
            for key in keys.into_iter().flatten().flat_map(BTreeMap::keys) {
                lines.insert((side, key.get_ref().clone()), line(text, key.span().start));
            }
        }
        Lines { name: name.into(), text: text.into(), axes: lines }
    }

    /// The plan's file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The line of a byte.
    pub fn line(&self, at: usize) -> usize {
        line(&self.text, at)
    }

    /// `FILE:LINE: KEY` of a value.
    pub fn at<T>(&self, value: &Option<Spanned<T>>, key: &str) -> String {
        match value {
            Some(value) => format!("{}:{}: {key}", self.name, self.line(value.span().start)),
            None => format!("{}: {key}", self.name),
        }
    }

    /// `FILE:LINE: KEY` of an axis.
    pub fn of_axis(&self, axis: &Axis) -> String {
        self.of_key(axis.side, &axis.key)
    }

    fn of_key(&self, side: Side, key: &str) -> String {
        // A key may be written as a table of further ones, in the line of the first.
        let mut written = key;
        let at = loop {
            match (self.axes.get(&(side, written.into())), written.rsplit_once('.')) {
                (Some(at), _) => break format!(":{at}"),
                (None, Some((outer, _))) => written = outer,
                (None, None) => break String::new(),
            }
        };
        let side = if side == Side::Profile { "profile" } else { "scene" };
        format!("{}{at}: {side}.{key}", self.name)
    }

    fn axes(&self, side: Side, keys: &Keys) -> Result<Vec<Axis>> {
        let mut axes = Vec::new();
        for (key, value) in keys {
            self.read(side, key.get_ref(), value, &mut axes)?;
            let values = axes.iter().filter_map(|axis| Some(axis.values.list()?.len()));
            ensure!(
                values.sum::<usize>() as f64 <= MOST,
                "{}: expected at most {MOST} values of all axes",
                self.of_key(side, key.get_ref())
            );
        }
        axes.sort_by(|a: &Axis, b| a.key.cmp(&b.key));
        if let Some(pair) = axes.windows(2).find(|pair| pair[0].key == pair[1].key) {
            bail!("{}: expected each key once", self.of_axis(&pair[1]));
        }
        Ok(axes)
    }

    fn read(&self, side: Side, key: &str, value: &toml::Value, axes: &mut Vec<Axis>) -> Result<()> {
        let values = Values::read(value)
            .map_err(|message| anyhow::anyhow!("{}: {message}", self.of_key(side, key)))?;
        match (values, value) {
            (Some(values), _) => axes.push(Axis { side, key: key.into(), values }),
            (None, toml::Value::Table(inner)) => {
                for (part, value) in inner {
                    self.read(side, &format!("{key}.{part}"), value, axes)?;
                }
            }
            (None, _) => (),
        }
        Ok(())
    }
}

fn line(text: &str, at: usize) -> usize {
    text[..at.min(text.len())].matches('\n').count() + 1
}
