// SPDX-License-Identifier: MIT OR Apache-2.0
//! An effect as a scene asks for it: its fidelity levels and the level in use.

use std::sync::Arc;

use super::effect::Effect;
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Table};
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
    /// What a slot costs, as the `speed` example measured it, with what is built before spread over
    /// 100 000 slots, ns: an error budget takes the cheapest level that fits.
    pub cost_ns: f64,
    /// There are scenes that it refuses, so that it has to be asked before a run.
    pub limited: bool,
    /// It answers another question than the other levels: it is none of their approximations.
    apart: bool,
    /// What it is compared with, where that is not the next level.
    finer: Option<&'static str>,
    /// Building it takes longer than many a run.
    slow_to_build: bool,
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
        Level {
            word,
            label: word.to_string(),
            cost_ns,
            limited: false,
            apart: false,
            finer: None,
            slow_to_build: false,
            build: Arc::new(build),
        }
    }

    /// The same level, which refuses some scenes.
    pub fn limited(self) -> Self {
        Level { limited: true, ..self }
    }

    /// The same level, as one that answers a question of its own.
    pub fn apart(self) -> Self {
        Level { apart: true, ..self }
    }

    /// The same level, whose error is its difference from level `word`: one that is more exact by
    /// far, where the next one is not, or costs more.
    pub fn against(self, word: &'static str) -> Self {
        Level { finer: Some(word).filter(|word| *word != self.word), ..self }
    }

    /// The same level, as one that takes long to build.
    pub fn slow_to_build(self) -> Self {
        Level { slow_to_build: true, ..self }
    }

    /// The same level, with its numbers beside its word.
    pub fn labelled(self, label: String) -> Self {
        Level { label, ..self }
    }
}

/// The key that names an effect's level.
pub(crate) type Rung = Key<Option<&'static str>>;

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
    /// `rung`, which declares them all; `usual` where it does not.
    pub fn with_levels(
        name: &'static str,
        table: Option<&Table>,
        rung: &Rung,
        levels: Vec<Level>,
        usual: &str,
    ) -> Result<Option<Spec>, SceneError> {
        Spec::with_questions(name, table, rung, levels, usual, &[])
    }

    /// The same, where `rung` may also be the word of a question that several levels answer, so that
    /// an error budget chooses among them; beside it, which one does without a budget.
    pub fn with_questions(
        name: &'static str,
        table: Option<&Table>,
        rung: &Rung,
        levels: Vec<Level>,
        usual: &str,
        questions: &[(&'static str, &'static str)],
    ) -> Result<Option<Spec>, SceneError> {
        let of_levels = levels.iter().map(|level| level.word);
        let words: Vec<_> = of_levels.chain(questions.iter().map(|(word, _)| *word)).collect();
        debug_assert!(
            words.iter().all(|word| rung.about.words().contains(word)),
            "{name}: {words:?}"
        );
        let word = table.map_or(Ok(None), |table| table.choice(rung.about.name, &words))?;
        let question = questions.iter().find(|(question, _)| Some(*question) == word);
        let level = question.map_or(word.unwrap_or(usual), |(_, usual)| usual);
        let chosen = levels.iter().position(|known| known.word == level);
        let chosen = chosen.expect("the usual level is one of the effect's");
        Ok(Some(Spec { name, levels, chosen, named: word.is_some() && question.is_none() }))
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
        !self.named && self.rivals().len() > 1
    }

    /// The same effect at each level that answers the same question, coarsest first.
    pub fn rivals(&self) -> Vec<Spec> {
        let rivals = |n: &usize| *n == self.chosen || !self.level().apart && !self.levels[*n].apart;
        (0..self.levels.len()).filter(rivals).map(|chosen| self.at(chosen)).collect()
    }

    /// The same effect at the finest level that answers the same question.
    pub fn finest(&self) -> Spec {
        self.rivals().pop().expect("at least the level itself")
    }

    /// The same effect at the level that it has among others, where it has that level too.
    pub fn as_in(&self, others: &[Spec]) -> Spec {
        let other = others.iter().find(|other| other.name == self.name);
        let is_same = |level: &Level| other.is_some_and(|other| other.is_at(level.word));
        self.levels.iter().position(is_same).map_or_else(|| self.clone(), |n| self.at(n))
    }

    /// The levels that others can be compared with, of which only the last is as good as the finest:
    /// all where that takes long to build, else the finest alone.
    pub fn stand_ins(&self) -> Vec<Spec> {
        let mut rivals = self.rivals();
        match rivals.last() {
            Some(finest) if finest.level().slow_to_build => rivals.drain(1..).collect(),
            _ => rivals.pop().into_iter().collect(),
        }
    }

    /// The same effect at the next coarser level that answers the same question.
    pub fn coarser(&self) -> Option<Spec> {
        self.rivals().into_iter().rfind(|rival| rival.chosen < self.chosen)
    }

    /// The same effect at the level that its error is measured against.
    pub fn finer(&self) -> Option<Spec> {
        let finer = |rival: &Spec| match self.level().finer {
            Some(word) => rival.is_at(word),
            None => rival.chosen > self.chosen,
        };
        self.rivals().into_iter().find(finer)
    }

    fn at(&self, chosen: usize) -> Spec {
        Spec { chosen, ..self.clone() }
    }

    /// The effect at work.
    pub fn build(&self, setting: &Setting) -> Effect {
        (self.level().build)(setting)
    }
}
