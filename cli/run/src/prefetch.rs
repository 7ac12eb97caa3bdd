// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots generated ahead of the core, on threads of their own.
//!
//! A plant evaluates slots in order, since effects have states. The samples of a slot follow from what the plant
//! evaluated, so that any plant of the case generates the same and results do not depend on threads. A worker
//! evaluates the next slot, queues a channel for it, and generates its samples into that channel. The core receives
//! the channels, hence the slots, in order. The queue is bounded: workers wait while it is full.

use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, ScopedJoinHandle};

use hapticore_scene::{EffectCost, Plant, Truth};

use crate::engine::Slot;
use crate::maker::Maker;

/// More would wait for each other: a fifth of a slot's time is its evaluation, which is sequential.
const MOST_WORKERS: usize = 4;

/// A slot for the core.
pub(crate) struct PreparedSlot {
    /// What the plant knows.
    pub truth: Truth,
    /// What the core receives.
    pub slot: Slot,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
}

/// Slots still to be evaluated, and the plant that evaluates them.
struct Source {
    plant: Plant,
    numbers: Range<usize>,
}

/// Calls `consume` with slots 0 to `slots`, in order, while workers generate up to `kept` of them ahead. Each worker
/// generates with a maker of its own. Returns its result and what effects have cost.
///
/// # Panics
/// If a worker panics.
pub(crate) fn prefetch<T>(
    plant: Plant,
    (slots, kept): (usize, usize),
    maker: impl Fn() -> Maker + Sync,
    consume: impl FnOnce(&mut dyn Iterator<Item = PreparedSlot>) -> T,
) -> (T, Vec<EffectCost>) {
    let source = Mutex::new(Source { plant, numbers: 0..slots });
    let (queue, queued) = sync_channel(kept);
    let (result, workers) = thread::scope(|scope| {
        let workers: Vec<_> = (0..rayon::current_num_threads().min(MOST_WORKERS))
            .map(|_| (queue.clone(), &source, &maker))
            .map(|(queue, source, maker)| scope.spawn(move || work(source, &queue, maker())))
            .collect();
        drop(queue);
        // A worker that panics sends no slot.
        let result = consume(&mut queued.iter().map_while(|slot| slot.recv().ok()));
        // Workers stop at their next slot.
        drop(queued);
        (result, workers.into_iter().map(join).collect::<Vec<_>>())
    });
    let evaluation = source.into_inner().expect("no worker panicked").plant.effects();
    (result, workers.into_iter().fold(evaluation, sum))
}

fn join<T>(worker: ScopedJoinHandle<T>) -> T {
    worker.join().unwrap_or_else(|panic| resume_unwind(panic))
}

fn sum(costs: Vec<EffectCost>, others: Vec<EffectCost>) -> Vec<EffectCost> {
    costs.into_iter().zip(&others).map(|(cost, other)| cost.and(other)).collect()
}

/// Prepares slots until there are no more, or the core has stopped; returns what effects have cost.
fn work(
    source: &Mutex<Source>,
    queue: &SyncSender<Receiver<PreparedSlot>>,
    mut maker: Maker,
) -> Vec<EffectCost> {
    while let Some((evaluated, truth, sender)) = evaluate_next(source, queue) {
        let (signals, peak) = maker.generate(&evaluated);
        let slot = Slot { pad: truth.pad, signals };
        // Nothing receives it if the core has stopped.
        let _ = sender.send(PreparedSlot { truth, slot, peak });
    }
    maker.plant().effects()
}

/// Evaluates the next slot and queues a channel for it.
fn evaluate_next(
    source: &Mutex<Source>,
    queue: &SyncSender<Receiver<PreparedSlot>>,
) -> Option<(hapticore_scene::Slot, Truth, SyncSender<PreparedSlot>)> {
    let mut source = source.lock().ok()?;
    let number = source.numbers.next()?;
    let (evaluated, truth) = (source.plant.slot(number), source.plant.truth(number));
    let (sender, receiver) = sync_channel(1);
    // With the lock held, so that slots are queued in order.
    queue.send(receiver).ok()?;
    Some((evaluated, truth, sender))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use anyhow::bail;

    use super::*;
    use crate::capture::Recorder;
    use crate::case::{Case, Settings, record_truth};
    use crate::engine::Fidelity;
    use crate::inputs;
    use crate::session::Session;

    const FIXED: Settings = Settings { fidelity: Fidelity::Fixed, errors: false };

    /// Four pads for half a second, 294 slots: more than are kept at a time.
    fn with_hockey(carrier: &str, run: impl Fn(&Case)) {
        let set = [("duration_s", "0.5"), ("carrier.rung", carrier)];
        let set = set.map(|(key, value)| (key.to_string(), value.to_string()));
        let scene = Arc::new(inputs::scene("hockey", &set).expect("a scene"));
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
            (FIXED.options(), None),
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
            let slot = Slot { pad: truth.pad, signals };
            session.slot(&slot, Some(record_truth(&truth))).expect("a slot of the case")
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

    #[test]
    fn slots_are_those_made_one_by_one_however_few_are_kept() {
        with_hockey("samples", |case| {
            let maker = || Maker::new(case.plant().expect("a plant"), &case.profile, true, false);
            let mut one_by_one = maker();
            let expected: Vec<_> =
                (0..40).map(|slot| format!("{:?}", one_by_one.signals(slot).0)).collect();
            for (kept, threads) in [(0, 1), (1, 1), (1, 2), (2, 2), (1, 5), (3, 5), (100, 5)] {
                let plant = case.plant().expect("a plant");
                let text = |of: PreparedSlot| format!("{:?}", of.slot.signals);
                let take = |slots: &mut dyn Iterator<Item = _>| slots.map(text).collect::<Vec<_>>();
                let run = || prefetch(plant, (40, kept), maker, take).0;
                assert_eq!(in_threads(threads, run), expected, "{kept} kept, {threads} threads");
            }
        });
    }

    #[test]
    fn workers_end_if_the_core_stops_early() {
        with_hockey("samples", |case| {
            for taken in [0, 1, 20] {
                let made = AtomicUsize::new(0);
                let maker = || {
                    made.fetch_add(1, Ordering::Relaxed);
                    Maker::new(case.plant().expect("a plant"), &case.profile, true, false)
                };
                let plant = case.plant().expect("a plant");
                let take = |slots: &mut dyn Iterator<Item = _>| slots.take(taken).count();
                let run = || prefetch(plant, (case.slots, 2), maker, take).0;
                assert_eq!(in_threads(2, run), taken);
                assert_eq!(made.into_inner(), 2, "a maker per worker");
            }
        });
    }

    #[test]
    #[should_panic(expected = "a worker")]
    fn a_worker_that_panics_ends_the_run() {
        with_hockey("samples", |case| {
            let plant = case.plant().expect("a plant");
            let take = |slots: &mut dyn Iterator<Item = PreparedSlot>| slots.count();
            in_threads(2, || prefetch(plant, (case.slots, 16), || panic!("a worker"), take));
        });
    }

    /// Takes this many slots, then no more.
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
