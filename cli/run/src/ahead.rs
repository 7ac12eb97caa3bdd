// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots made ahead of the core: some are made, by all processors, while the core works on those before.
//!
//! A plant looks at slots in their order, since effects have states; their samples follow from what it saw,
//! so that any plant of the case makes them, and results do not depend on threads.

use std::sync::Mutex;

use hapticore_scene::{EffectCost, Plant, Slot, Truth};
use rayon::prelude::*;

use crate::engine;
use crate::engine::Signals;
use crate::maker::Maker;

/// A slot on its way to the core.
pub(crate) struct Made {
    /// As the plant looked at it.
    seen: Slot,
    /// What the plant knows.
    pub truth: Truth,
    /// What the core is given.
    pub slot: engine::Slot,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
}

/// Slots that are worth being made apart.
const LEAST: usize = 16;

/// Slots of a case in their order, some at a time.
pub(crate) struct Look {
    plant: Plant,
    /// The first that it has not looked at.
    next: usize,
    slots: usize,
}

impl Look {
    /// Slots up to the last of so many.
    pub fn new(plant: Plant, slots: usize) -> Self {
        Look { plant, next: 0, slots }
    }

    /// Looks at the next slots, so many or half of those that are left, in the memory of some that are done
    /// with: after the last have been made all processors but one wait for the core.
    pub fn at(&mut self, count: usize, done: Vec<Made>) -> Vec<Made> {
        let left = self.slots - self.next;
        let slots = self.next..self.next + count.min(left.div_ceil(2).max(LEAST)).min(left);
        self.next = slots.end;
        let used = done.into_iter().map(|made| made.slot.signals);
        let signals = used.chain(std::iter::repeat(Signals::NONE));
        slots.zip(signals).map(|(slot, signals)| self.look(slot, signals)).collect()
    }

    fn look(&mut self, slot: usize, signals: Signals) -> Made {
        let (seen, truth) = (self.plant.slot(slot), self.plant.truth(slot));
        let slot = engine::Slot { pad: truth.pad, signals };
        Made { seen, truth, slot, peak: 0.0 }
    }

    /// What effects on pads have cost.
    pub fn effects(&self) -> Vec<EffectCost> {
        self.plant.effects()
    }
}

/// Makers of samples, one for each processor that makes some.
pub(crate) struct Makers<New> {
    new: New,
    idle: Mutex<Vec<Maker>>,
}

impl<New: Fn() -> Maker + Sync> Makers<New> {
    /// None yet: `new` makes one when it is needed.
    pub fn new(new: New) -> Self {
        Makers { new, idle: Mutex::new(Vec::new()) }
    }

    /// Makes what the core is given of slots that have been looked at.
    pub fn make(&self, some: &mut [Made]) {
        some.par_iter_mut().with_max_len(1).for_each(|made| {
            let idle = || self.idle.lock().expect("no maker panics");
            let maker = idle().pop();
            let mut maker = maker.unwrap_or_else(&self.new);
            made.peak = maker.make(&made.seen, &mut made.slot.signals);
            idle().push(maker);
        });
    }

    /// What effects have cost here and, before, elsewhere.
    pub fn effects(self, elsewhere: Vec<EffectCost>) -> Vec<EffectCost> {
        let makers = self.idle.into_inner().expect("no maker panics");
        makers.into_iter().fold(elsewhere, |sum, mut maker| {
            let costs = maker.plant().effects();
            sum.into_iter().zip(&costs).map(|(sum, cost)| sum.and(cost)).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use anyhow::bail;

    use super::*;
    use crate::capture::Recorder;
    use crate::case::{Case, Settings, record_truth};
    use crate::engine::Fidelity;
    use crate::inputs;
    use crate::session::Session;

    const FIXED: Settings = Settings { fidelity: Fidelity::Fixed, errors: false };

    /// Four pads for half a second, 294 slots: more than are made at a time, but no multiple of it.
    fn with_hockey(carrier: &str, run: impl Fn(&Case)) {
        let set = [("duration_s", "0.5"), ("carrier.rung", carrier)];
        let set = set.map(|(key, value)| (key.to_string(), value.to_string()));
        let scene = inputs::scene("hockey", &set).expect("a scene");
        let profile = inputs::profile(&scene.profile).expect("bundled");
        run(&Case::new(&scene, 0, &profile, &[]).expect("a case"));
    }

    fn in_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(run)
    }

    type Evaluations = Vec<(&'static str, u64)>;

    fn evaluations(effects: &[EffectCost]) -> Evaluations {
        effects.iter().map(|effect| (effect.name, effect.evaluations)).collect()
    }

    /// Rows of a slot after the other, by one plant, how often each effect was evaluated, and the largest sample.
    fn one_by_one(case: &Case) -> (String, Evaluations, f64) {
        let calibration = case.calibration().expect("words");
        let mut session = Session::new(
            &case.profile,
            (&case.device, calibration),
            (Fidelity::Fixed, None),
            false,
            (case.number, case.clock),
        )
        .expect("a session");
        let sampled = case.scene.cases[case.index].sampled();
        let plant = case.plant().expect("a plant").metered();
        let mut maker = Maker::new(plant, &case.profile, sampled, false);
        let mut largest = 0f64;
        let rows = (0..case.slots).filter_map(|number| {
            let (truth, (signals, peak)) = (maker.plant().truth(number), maker.signals(number));
            largest = largest.max(peak);
            let slot = engine::Slot { pad: truth.pad, signals };
            session.slot(&slot, Some(record_truth(&truth)))
        });
        let rows = format!("{:?}", rows.collect::<Vec<_>>());
        (rows, evaluations(&maker.plant().effects()), largest)
    }

    #[test]
    fn rows_are_those_of_slots_made_one_by_one_whatever_the_threads() {
        for carrier in ["samples", "phasor"] {
            with_hockey(carrier, |case| {
                let (rows, evaluated, largest) = one_by_one(case);
                for threads in [1, 2, 5] {
                    let run = || case.run(&FIXED, None, &|| ());
                    let outcome = in_threads(threads, run).expect("a run");
                    assert_eq!(format!("{:?}", outcome.rows), rows, "{carrier}, {threads}");
                    assert_eq!(evaluations(&outcome.effects), evaluated, "{carrier}, {threads}");
                    assert_eq!(outcome.peak, largest, "{carrier}, {threads}");
                }
            });
        }
    }

    /// Takes so many slots, then no more.
    struct Full(AtomicUsize);

    impl Recorder for Full {
        fn slot(&mut self, _: usize, _: &[i32]) -> anyhow::Result<()> {
            match self.0.fetch_sub(1, Ordering::Relaxed) {
                1 => bail!("no space left"),
                _ => Ok(()),
            }
        }

        fn keep(self: Box<Self>) -> anyhow::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_capture_that_cannot_go_on_ends_the_run() {
        with_hockey("samples", |case| {
            for slots in [1, 150, 290] {
                let mut full = Full(AtomicUsize::new(slots));
                let outcome = in_threads(2, || case.run(&FIXED, Some(&mut full), &|| ()));
                let error = outcome.err().expect("an error");
                assert_eq!(error.to_string(), "no space left", "{slots}");
            }
        });
    }
}
