// SPDX-License-Identifier: MIT OR Apache-2.0
//! Slots made ahead of the core, by processors that have nothing else to do.
//!
//! A plant looks at slots in their order, since effects have states; their samples follow from what it saw,
//! so that any plant of the case makes them, and results do not depend on threads. Whoever has nothing else
//! to do looks at the next slot and makes it: helpers, and the core's thread while its own next slot is being
//! made. A queue keeps so many slots at most. Helpers that find it full leave, and are called again when it is
//! half empty.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, TryLockError};

use hapticore_scene::{EffectCost, Plant, Truth};
use rayon::Scope;

use crate::engine::{Signals, Slot};
use crate::maker::Maker;

/// More would wait for each other: slots are looked at one after the other, and a fifth of the time that a slot
/// with samples takes is that.
const MOST_HELPERS: usize = 3;

/// A slot for the core.
pub(crate) struct Made {
    /// What the plant knows.
    pub truth: Truth,
    /// What the core is given.
    pub slot: Slot,
    /// The largest sample, as a fraction of full scale.
    pub peak: f64,
}

/// Slots of a case, made ahead of whoever takes them.
pub(crate) struct Ahead<New> {
    /// Looks at slots.
    plant: Mutex<Plant>,
    queue: Mutex<Queue<Made>>,
    /// Makes another maker, where all are at work.
    new: New,
    idle: Mutex<Vec<Maker>>,
}

impl<New: Fn() -> Maker + Sync> Ahead<New> {
    /// Slots up to the last of `slots`, of which so many are kept at most; makers of samples are made when
    /// they are needed.
    pub fn new(plant: Plant, (slots, most): (usize, usize), new: New) -> Self {
        let queue = Mutex::new(Queue::new(slots, most));
        Ahead { plant: Mutex::new(plant), queue, new, idle: Mutex::default() }
    }

    /// Calls helpers, if half of the queue is empty and there are slots left to make.
    pub fn call_helpers<'s>(&'s self, scope: &Scope<'s>) {
        let most = MOST_HELPERS.min(rayon::current_num_threads() - 1);
        let missing = self.queue().missing_helpers(most);
        (0..missing).for_each(|_| scope.spawn(|_| self.help()));
    }

    fn help(&self) {
        while self.queue().has_room() {
            self.make_next_or_yield();
        }
        self.queue().helpers -= 1;
    }

    fn make_next_or_yield(&self) {
        if !self.make_next() {
            std::thread::yield_now();
        }
    }

    /// The next slot in their order, none after the last. While another thread makes it, this one makes
    /// those that come then.
    ///
    /// # Panics
    /// Where the maker of a slot has panicked.
    pub fn take(&self) -> Option<Made> {
        loop {
            let next = self.queue().take();
            match next {
                Next::Slot(made) => return Some(made),
                Next::End => return None,
                Next::NotYet => self.make_next_or_yield(),
                Next::Never => panic!("the maker of a slot panicked"),
            }
        }
    }

    /// Takes back the memory of a slot's signals.
    pub fn give_back(&self, signals: Signals) {
        self.queue().free.push(signals);
    }

    /// No slot is looked at any more.
    pub fn stop(&self) {
        self.queue().stop();
    }

    /// Looks at the next slot and makes it, if there is one, the queue has room for it, and nobody else looks
    /// at one.
    fn make_next(&self) -> bool {
        let Some((number, seen, mut made)) = self.look() else {
            return false;
        };
        let failing = StopIfPanicking(&self.queue);
        let maker = self.idle().pop();
        let mut maker = maker.unwrap_or_else(&self.new);
        made.peak = maker.make(&seen, &mut made.slot.signals);
        self.idle().push(maker);
        drop(failing);
        self.queue().put(number, made);
        true
    }

    /// Looks at the next slot, whose place in the queue is taken from then on.
    fn look(&self) -> Option<(usize, hapticore_scene::Slot, Made)> {
        let mut plant = match self.plant.try_lock() {
            Err(TryLockError::WouldBlock) => return None,
            tried => tried.expect("no effect panics"),
        };
        let (number, signals) = self.queue().reserve()?;
        let (seen, truth) = (plant.slot(number), plant.truth(number));
        let slot = Slot { pad: truth.pad, signals };
        Some((number, seen, Made { truth, slot, peak: 0.0 }))
    }

    /// What effects have cost.
    pub fn effects(self) -> Vec<EffectCost> {
        let looking = self.plant.into_inner().expect("no effect panics").effects();
        let makers = self.idle.into_inner().expect("no maker panics");
        makers.into_iter().fold(looking, |sum, mut maker| {
            let costs = maker.plant().effects();
            sum.into_iter().zip(&costs).map(|(sum, cost)| sum.and(cost)).collect()
        })
    }

    fn queue(&self) -> MutexGuard<'_, Queue<Made>> {
        self.queue.lock().expect("nobody panics at the queue")
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Maker>> {
        self.idle.lock().expect("nobody panics with idle makers")
    }
}

/// Slots that have been looked at and are still to be taken.
struct Queue<T> {
    /// One after the other; none where a slot is still being made.
    places: VecDeque<Option<T>>,
    /// How many slots have been taken.
    taken: usize,
    /// How many slots there are.
    slots: usize,
    /// The most places.
    most: usize,
    /// Memory of slots that the core is done with.
    free: Vec<Signals>,
    /// Helpers that have been called and have not left.
    helpers: usize,
    /// A thread panicked at a slot, which nobody will make.
    failed: bool,
}

/// What there is to take.
#[derive(Debug, PartialEq)]
enum Next<T> {
    Slot(T),
    /// It is still to be made, or being made.
    NotYet,
    /// Nobody will make it.
    Never,
    End,
}

impl<T> Queue<T> {
    fn new(slots: usize, most: usize) -> Self {
        let (places, free) = (VecDeque::with_capacity(most.min(slots)), Vec::new());
        Queue { places, taken: 0, slots, most, free, helpers: 0, failed: false }
    }

    /// A place for the next slot: its number, and memory for its signals.
    fn reserve(&mut self) -> Option<(usize, Signals)> {
        self.has_room().then(|| {
            self.places.push_back(None);
            (self.reserved() - 1, self.free.pop().unwrap_or(Signals::NONE))
        })
    }

    /// How many slots have been given a place.
    fn reserved(&self) -> usize {
        self.taken + self.places.len()
    }

    /// Whether another slot can be looked at.
    fn has_room(&self) -> bool {
        self.reserved() < self.slots && self.places.len() < self.most
    }

    fn put(&mut self, number: usize, made: T) {
        self.places[number - self.taken] = Some(made);
    }

    fn take(&mut self) -> Next<T> {
        let first = self.places.front_mut().and_then(Option::take);
        let Some(made) = first else {
            return match (self.failed, self.taken == self.slots) {
                (true, _) => Next::Never,
                (_, true) => Next::End,
                _ => Next::NotYet,
            };
        };
        self.places.pop_front();
        self.taken += 1;
        Next::Slot(made)
    }

    fn stop(&mut self) {
        self.slots = self.reserved();
    }

    /// How many helpers may be called, so that there are no more than `most`; they are counted as called.
    fn missing_helpers(&mut self, most: usize) -> usize {
        if !self.has_room() || 2 * self.places.len() > self.most {
            return 0;
        }
        let missing = most.saturating_sub(self.helpers);
        self.helpers += missing;
        missing
    }
}

/// Lets nobody wait for a slot whose maker panics.
struct StopIfPanicking<'q>(&'q Mutex<Queue<Made>>);

impl Drop for StopIfPanicking<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.lock().expect("nobody panics at the queue").failed = true;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::AssertUnwindSafe;
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
            let slot = Slot { pad: truth.pad, signals };
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

    /// With room for one, helpers leave after each slot and are called again.
    #[test]
    fn slots_are_those_made_one_by_one_however_few_are_kept() {
        with_hockey("samples", |case| {
            let maker = || Maker::new(case.plant().expect("a plant"), &case.profile, true, false);
            let mut one_by_one = maker();
            let expected: Vec<_> =
                (0..40).map(|slot| format!("{:?}", one_by_one.signals(slot).0)).collect();
            for (most, threads) in [(1, 1), (1, 2), (2, 2), (1, 5), (3, 5), (100, 5)] {
                let ahead = Ahead::new(case.plant().expect("a plant"), (40, most), maker);
                let take = || {
                    let signals = ahead.take()?.slot.signals;
                    let text = format!("{signals:?}");
                    ahead.give_back(signals);
                    Some(text)
                };
                let run = || {
                    rayon::in_place_scope(|helpers| {
                        let next = || {
                            ahead.call_helpers(helpers);
                            take()
                        };
                        std::iter::from_fn(next).collect::<Vec<_>>()
                    })
                };
                assert_eq!(in_threads(threads, run), expected, "{most} kept, {threads} threads");
            }
        });
    }

    #[test]
    fn slots_are_taken_in_their_order_in_whatever_order_they_are_made() {
        let mut queue = Queue::new(4, 3);
        let numbers: Vec<_> = std::iter::from_fn(|| queue.reserve()).map(|place| place.0).collect();
        assert_eq!(numbers, [0, 1, 2], "no more than there is room for");
        queue.put(2, "slot 2");
        queue.put(1, "slot 1");
        assert_eq!(queue.take(), Next::NotYet);
        queue.put(0, "slot 0");
        assert_eq!(queue.take(), Next::Slot("slot 0"));
        assert_eq!(queue.reserve().map(|place| place.0), Some(3));
        assert!(queue.reserve().is_none(), "all have a place");
        queue.put(3, "slot 3");
        for slot in ["slot 1", "slot 2", "slot 3"] {
            assert_eq!(queue.take(), Next::Slot(slot));
        }
        assert_eq!(queue.take(), Next::End);
    }

    #[test]
    fn helpers_are_called_once_where_half_of_the_queue_is_empty() {
        let mut queue = Queue::new(8, 4);
        assert_eq!(queue.missing_helpers(2), 2);
        assert_eq!(queue.missing_helpers(2), 0, "they have been called");
        (0..3).for_each(|_| assert!(queue.reserve().is_some()));
        queue.helpers = 0;
        assert_eq!(queue.missing_helpers(2), 0, "three of four places are taken");
        queue.put(0, "slot 0");
        assert_eq!(queue.take(), Next::Slot("slot 0"));
        assert_eq!(queue.missing_helpers(2), 2);
        queue.helpers = 1;
        queue.stop();
        assert_eq!(queue.missing_helpers(2), 0, "nothing is left to make");
    }

    #[test]
    fn a_helper_that_panics_ends_the_run() {
        with_hockey("samples", |case| {
            let run = || {
                let core = std::thread::current().id();
                let new = || {
                    assert_eq!(std::thread::current().id(), core, "a helper");
                    Maker::new(case.plant().expect("a plant"), &case.profile, true, false)
                };
                let ahead = Ahead::new(case.plant().expect("a plant"), (case.slots, 16), new);
                rayon::in_place_scope(|helpers| {
                    ahead.call_helpers(helpers);
                    while ahead.queue().places.is_empty() {
                        std::thread::yield_now();
                    }
                    while ahead.take().is_some() {}
                });
            };
            let ran = std::panic::catch_unwind(AssertUnwindSafe(|| in_threads(2, run)));
            assert!(ran.is_err());
        });
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
