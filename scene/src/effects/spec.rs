// SPDX-License-Identifier: MIT OR Apache-2.0
//! An effect as a scene asks for it: its fidelity levels and the one that is used.

use std::sync::Arc;

use super::effect::Effect;
use crate::device::Device;
use crate::error::SceneError;
use crate::format::Table;
use crate::timing::Timing;

/// An effect as the scene asks for it.
#[derive(Clone)]
pub(crate) struct Spec {
    /// Its table, or table and key.
    pub name: &'static str,
    /// From the coarsest to the finest; a single one where the effect is one way or not at all.
    levels: Vec<Level>,
    chosen: usize,
    /// The scene names the level itself, so that an error budget leaves it alone.
    named: bool,
}

/// One way to evaluate an effect.
#[derive(Clone)]
pub(crate) struct Level {
    /// What a scene writes.
    word: &'static str,
    /// What a run says: the word, and its numbers where it has some.
    pub label: String,
    /// What a slot costs, as the `speed` example measured it, ns: an error budget takes the
    /// cheapest level that fits.
    pub cost_ns: f64,
    /// There are scenes that it refuses, so that it has to be asked before a run.
    pub limited: bool,
    build: Builder,
}

type Builder = Arc<dyn Fn(&Setting) -> Effect + Send + Sync>;

/// What an effect may know of the run it is built for.
pub(crate) struct Setting<'a> {
    pub device: &'a Device,
    pub timing: &'a Timing,
    pub seed: u64,
    /// Which case of the scene: its noise differs from the other cases', its hardware does not.
    pub case: usize,
}

impl Level {
    /// A level that a scene asks for by `word`.
    pub fn new(
        word: &'static str,
        cost_ns: f64,
        build: impl Fn(&Setting) -> Effect + Send + Sync + 'static,
    ) -> Self {
        Level { word, label: word.to_string(), cost_ns, limited: false, build: Arc::new(build) }
    }

    /// The same level, which refuses some scenes.
    pub fn limited(self) -> Self {
        Level { limited: true, ..self }
    }

    /// The same level, with its numbers beside its word.
    pub fn labelled(self, label: String) -> Self {
        Level { label, ..self }
    }
}

impl Spec {
    /// An effect that has one way to be evaluated; `label` says how much of it there is.
    pub fn new(
        name: &'static str,
        label: impl Into<String>,
        build: impl Fn(&Setting) -> Effect + Send + Sync + 'static,
    ) -> Option<Spec> {
        let levels = vec![Level::new("", 0.0, build).labelled(label.into())];
        Some(Spec { name, levels, chosen: 0, named: true })
    }

    /// An effect with levels, from the coarsest to the finest, of which `table` names one as
    /// `rung`; `usual` where it does not.
    pub fn with_levels(
        name: &'static str,
        table: Option<&Table>,
        levels: Vec<Level>,
        usual: &str,
    ) -> Result<Option<Spec>, SceneError> {
        let words: Vec<_> = levels.iter().map(|level| level.word).collect();
        let word = table.map_or(Ok(None), |table| table.choice("rung", &words))?;
        let chosen = words.iter().position(|known| *known == word.unwrap_or(usual));
        let chosen = chosen.expect("the usual level is one of the effect's");
        Ok(Some(Spec { name, levels, chosen, named: word.is_some() }))
    }

    /// The level that is used.
    pub fn level(&self) -> &Level {
        &self.levels[self.chosen]
    }

    /// Whether the level that is used is the one a scene writes so.
    pub fn is_at(&self, word: &str) -> bool {
        self.level().word == word
    }

    /// Whether an error budget may choose the level.
    pub fn is_free(&self) -> bool {
        !self.named && self.levels.len() > 1
    }

    /// The same effect at each of its levels, coarsest first.
    pub fn all(&self) -> Vec<Spec> {
        (0..self.levels.len()).map(|chosen| self.at(chosen)).collect()
    }

    /// The same effect at its finest level.
    pub fn finest(&self) -> Spec {
        self.at(self.levels.len() - 1)
    }

    /// The same effect one level up.
    pub fn finer(&self) -> Option<Spec> {
        (self.chosen + 1 < self.levels.len()).then(|| self.at(self.chosen + 1))
    }

    fn at(&self, chosen: usize) -> Spec {
        Spec { chosen, ..self.clone() }
    }

    /// The effect at work.
    pub fn build(&self, setting: &Setting) -> Effect {
        (self.level().build)(setting)
    }
}
