// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force controller: a pad's drive word from its target force and its last estimate.
//!
//! ```text
//! s = √F_t,   D = curve(s), linear between its cells                              (paper, eq. 9: D = K·√F_t)
//! open           d = D
//! proportional   d = D + c,         c += α·(K·(F_t − F) − c)                      (paper, Fig. 8b: α = 1)
//! integral       d = D + K·e + c,   c += K_i·e,   e = √F_t − √F
//! inverse        d = B + c·B,       c += K_i·e',  B = min(√(F_t/G / (k·C²)), D)   (docs/physics.md §6)
//! e' = √F_t of the pad's last frame, whose drive the force is of, − √F
//! F_t = the host's force, or that of the pad's wall where it is larger
//! drive = d, held within 0 … rail, and within slew of the pad's last; 0 at once while off or lifted, at most the rail at once
//! c as before of an invalid estimate; against a limit that holds the drive as far as drive − (D + K·e), never back
//! ```
//!
//! ```text
//! target ─[√]─ s ─[curve]─(interpolate)─ D ─┬───────────────────────[min]─┬─(limits)─ drive
//! C ─(²)─(× k)─┐                            │                         │   │
//! target ─(÷ G)─[divider]─[√]───────────────┼─────────────────────────┘   │
//! force ─(target −)─(× K)─(× α)─ c ─────────┴─(+)─────────────────────────┘
//! force ─[√]─(s −)─(× K_i)─ c ─(× min)──────────(+ of the inverse law's min)
//! ```
//!
//! | signal        | format                 | unit            | overflow                    |
//! | drive         | profile                | full scale      | held within 0 … rail        |
//! | s, D          | drive's, finer with F  | full scale      | held within 0 … full scale  |
//! | K·e           | the same, with a sign  | full scale      | saturates                   |
//! | c             | the same, 8 bits finer | full scale      | saturates                   |
//! | e of a trim   | the drive's, ± 2^-6    | full scale      | saturates                   |
//! | c of a trim   | 8 bits finer, ± ½      | of the drive    | saturates                   |
//! | k·C²          | square's width, u·.·−4 | N               | saturates                   |
//! | F_t/G         | target's, 3 bits more  | N               | saturates                   |
//! | quotient      | drive's, twice         | full scale²     | saturates: then D is less   |
//!
//! Nothing winds up: a limit is the rail, zero, or the slew limit, against which a trim stays as it is. A zero
//! denominator gives the limit D. While an estimate is invalid the drive stays; see `faults.rs` for what takes it to
//! zero. Narrowing rounds half to even.
//!
//! **Safe state.** A pad's last drive word, its correction and its count of invalid estimates are in memories, which no
//! reset clears. They count only where the pad is known: a mark per pad, set with its drive word. A reset clears the
//! marks, and so does every clock that is off. Off is: `clear`, a drive that is not enabled, a fault, a curve that has
//! not been written completely since the reset, or ticks that have not begun. While off the drive is zero, and a drive
//! word in progress becomes zero; a drive then begins at zero, within slew, its correction at zero. Slew limits no
//! other fall: with a slew of zero a drive stays where it is, and what is off is zero all the same. In the
//! proportional and integral laws, s is so fine that the roots of two forces are never the same, for a loop settles
//! wherever its error is zero.
//!
//! One multiplier, one square root and one divider serve all steps. Latency: the sum of the law's
//! tasks and a clock, from `start` to `done`.

mod faults;
mod laws;
mod tasks;
mod words;

use super::divider::{self, Divider};
use super::marks;
use super::multiplier::{self, Multiplier};
use super::rests::Rests;
use super::sqrt::{self, SquareRoot};
use crate::buildable::{fits, rounds};
pub use faults::Faults;
use faults::Watch;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Signal, Wrap, bit, int, zero};
use hapticore_hdl::states::States;
use hapticore_hdl::{block, bundle, call, when};
use laws::Found;
use tasks::Task;

bundle! {
    /// What tunes a controller. Words are stable while a drive word is being made.
    pub struct Tuning {
        /// Controller: drives follow their targets; else they go to zero.
        enable,
        /// Controller: one over the haptic mean square at full drive.
        full_drive,
        /// Controller: gain of the error.
        proportional,
        /// Controller: filter or integral gain.
        correction,
        /// Controller: largest drive word.
        rail,
        /// Controller: largest change of a drive word from frame to frame.
        slew,
        /// Controller: a larger force is a fault, N.
        force_cap,
        /// Controller: writes a word of the curve.
        curve_write,
        /// Controller: number of the curve's word.
        curve_address,
        /// Controller: word of the curve, a drive word.
        curve_word,
    }
}

block! {
    /// The force controller.
    pub struct Controller("controller") {
        law: Law,
        drive: Format,
        /// Roots of forces, and drives before they are narrowed.
        fine: Format,
        target: Format,
        gain: Format,
        /// Bits of a target's scale: it is below 2^shift.
        shift: i8,
        pad: Format,
        capacitance: Format,
        force: Format,
        force_gain: Format,
        square: Format,
        /// Of the square root.
        radicand: Format,
        /// Of the multiplier's operands.
        left: Format,
        right: Format,
        pads_in_all: u64,
        invalid_frames: u64,
        silent_ticks: u64,
        has_walls: bool,
        /// Code of the largest rise after contact.
        contact_slew: i64,
    }
    submodules {
        multiplier: Multiplier,
        sqrt: SquareRoot,
        divider: Divider,
        /// Drive words of the curve.
        points: Memory,
        /// Of each pad that is known: whether it rises after contact, invalid frames in a row, the drive word, and √F_t
        /// with a trim.
        pads: Memory,
        /// Of each pad that is known: what corrects the curve.
        corrections: Memory,
    }
    inputs(block) {
        /// Begins; all others are valid and stable until `done`.
        start: BIT,
        /// Pad whose drive word is made.
        pad: block.pad,
        /// The force that the pad shall have, N.
        target: block.target,
        /// The force that its wall asks for, N: the pad shall have it where it is larger.
        of_wall: block.force.where_present(block.has_walls),
        /// Capacitance of the pad, pF.
        capacitance: block.capacitance,
        /// Haptic force of the pad, N.
        measured: block.force,
        /// Gain of the force, N/pF² at a full-scale haptic mean square.
        force_gain: block.force_gain,
        /// The estimate is invalid.
        invalid: BIT,
        /// Every pad begins anew: a drive word that is under way becomes zero.
        clear: BIT,
        /// The pad does not touch.
        lifted: BIT,
        /// Asserted for one cycle every millisecond.
        tick: BIT,
        /// The host is alive.
        alive: BIT,
        /// Clears faults.
        clear_faults: BIT,
        tuning as Tuning: block.tuning(),
    }
    outputs(block) {
        /// Asserted for one cycle when the drive word is valid.
        done: BIT,
        /// Drive word of the pad, drive's full scale; stable until the next `done`, zero while off.
        drive: block.drive,
        /// The larger of both forces.
        target: block.target.where_present(block.has_walls),
        /// The drive is at zero and should be less.
        low: BIT,
        /// The drive is at its rail and should be more.
        high: BIT,
        faults as Faults: Faults::of(BIT),
    }
    registers(block) {
        task in Task,
        count: Format::counter(7),
        left: block.left,
        right: block.right,
        sqrt_start: BIT,
        divide: BIT,
        root: block.fine,
        curve_drive: block.fine,
        /// Product of the step before.
        factor: block.of_inverse(block.square.integer()),
        /// F_t/G.
        numerator: block.of_inverse(block.numerator_format()),
        /// √F_t of this frame, which the next one's error is of.
        asked: block.of_inverse(block.fine),
        /// √F_t − √F.
        error: block.of_roots(block.error_format()),
        /// What comes on top of the curve in proportion: to the error, or by the trim to the drive.
        proportional: block.of_feedback(block.correction_format()),
        /// The filter's new state, or the integral or the trim with this frame.
        correction: block.of_feedback(block.kept_format()),
        /// Of the pad, as its memory has it: a clock late, so that no path goes from memory to memory.
        pad_word: block.pads.format,
        /// Before slew: within 0 and the rail.
        wanted: block.drive,
        /// What slew allows.
        least: block.drive,
        most: block.drive,
        drive: block.drive,
        low: BIT,
        high: BIT,
        watch as Watch: Watch::registers(block.silent_ticks),
        /// Pads whose words in memories count.
        known: marks::format(block.pads_in_all),
        /// It has been off since the drive word was begun.
        void: BIT,
        /// Words of the curve that have been written, from the first on.
        curve_words: Format::counter(block.points.words as u64),
        done: BIT,
    }
}

impl Controller {
    /// The controller of a profile.
    ///
    /// # Errors
    /// A profile without a controller, a word that is none of the model's.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let Some(control) = &profile.control else {
            return Err(ProfileError::value("control", "a table", "none"));
        };
        control.check()?;
        marks::check(profile)?;
        // A root tells no more bits apart than half of its radicand's.
        let most = 2 * words::fine(control, &profile.formats).frac - control.target_shift();
        if control.target.frac > most {
            let expected = format_args!("{most} fractional bits at most beside control.drive");
            return Err(ProfileError::value("control.target", expected, control.target));
        }
        let block = Self::of(profile, control);
        fits("control.drive", "the dividend of the inverse law", block.divider.dividend.width)?;
        for (name, product, to) in block.products() {
            rounds("control.gain", name, product, to)?;
        }
        Ok(block)
    }

    fn of(profile: &Profile, control: &Control) -> Self {
        let f = &profile.formats;
        let &Control { law, drive, target, gain, cells, .. } = control;
        let pad = Format::counter(profile.pads - 1);
        let words = 1 << pad.width;
        let square = Format::unsigned(2 * drive.width, 2 * drive.frac);
        let fine = words::fine(control, f);
        let radicand = words::radicand(control, fine);
        let (left, right) = words::operands(control, f);
        let invalid = Format::counter(control.invalid_frames);
        let asked = if law == Law::Inverse { fine.width } else { 0 };
        let word = Format::unsigned(1 + invalid.width + drive.width + asked, 0);
        Controller {
            multiplier: Multiplier::new(left, right, profile.multiplier),
            sqrt: SquareRoot::new(radicand, fine.frac),
            divider: Divider::new(words::numerator(target), words::stiffness(f.square), square),
            points: Memory::new("points", cells as usize + 1, drive).dont_care_on_collision(),
            // Few pads would make registers of them, a word after the other.
            pads: Memory::new("pads", words, word).dont_care_on_collision().in_block(),
            corrections: Memory::new("corrections", words, words::kept(law, fine))
                .dont_care_on_collision()
                .in_block(),
            radicand,
            law,
            drive,
            fine,
            target,
            gain,
            shift: control.target_shift(),
            pad,
            capacitance: f.capacitance,
            force: f.force,
            force_gain: f.force_gain,
            square: f.square,
            left,
            right,
            invalid_frames: control.invalid_frames,
            pads_in_all: profile.pads,
            silent_ticks: control.silent_ms,
            has_walls: profile.wall.is_some(),
            contact_slew: drive.code_saturating(control.contact_slew()),
        }
    }

    /// The formats of the tuning.
    fn tuning(&self) -> Tuning<Format> {
        Tuning {
            enable: BIT,
            full_drive: self.gain,
            proportional: self.gain,
            correction: self.gain,
            rail: self.drive,
            slew: self.drive,
            force_cap: self.force,
            curve_write: BIT,
            curve_address: self.points.address(),
            curve_word: self.drive,
        }
    }

    /// Words of the curve: one more than its cells.
    pub fn words_of_curve(&self) -> usize {
        self.points.words
    }

    /// From now on interpretations that know every bit have roots and quotients in the clock after
    /// they are asked for: a drive word then comes before [`Controller::latency`] is over.
    pub(crate) fn hurry(&mut self) {
        self.sqrt.hurry();
        self.divider.hurry();
    }

    /// Clocks from `start` to `done`.
    pub fn latency(&self) -> u64 {
        1 + Task::of(self.law).iter().map(|task| self.clocks(*task)).sum::<u64>()
    }

    fn clocks(&self, task: Task) -> u64 {
        match task {
            Task::Idle => 0,
            Task::Root | Task::InverseRoot | Task::ForceRoot => self.sqrt.latency() + 1,
            Task::Divide => self.divider.latency() + 1,
            Task::Curve => 2,
            Task::Combine | Task::Limit => 1,
            _ => self.multiplier.latency() + 2,
        }
    }
}

impl Rests for Controller {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        !r.task.at(Task::Idle) | r.done
    }
}

impl Block for Controller {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let i = Inputs { target: self.larger(&i), ..i };
        let outputs = self.outputs_now(&r, &i);
        let idle = r.task.at(Task::Idle);
        let off = self.off(&r, &i);
        let told = i.alive | i.clear_faults | i.tick | i.tuning.curve_write;
        if (i.start | told | (off & !r.known.is(0)) | self.under_way(&r)).can_skip() {
            return outputs;
        }
        let (found, ends) = self.find(state, &r, &i, idle);
        let still = Registers {
            sqrt_start: bit(false),
            divide: bit(false),
            done: bit(false),
            watch: r.watch.heard(&i, self.silent_ticks),
            drive: off.select(zero(self.drive), r.drive),
            curve_words: self.curve_words(&r, &i),
            ..r
        };
        let begin = Registers {
            task: Task::Root.signal(),
            count: int(0),
            sqrt_start: bit(true),
            void: off,
            ..still
        };
        let void = Registers { void: r.void | off, ..still };
        let next = when!(i.start => begin, idle => still, else self.work(void, &i, &found, ends));
        self.keep(state, &r, &i, next.drive, &found);
        let next = Registers { known: self.known(&void, &i, off), ..next };
        state.store(self, next);
        outputs
    }
}

impl Controller {
    /// The force that the pad shall have: the host's, or the wall's where it is larger.
    #[inline(always)]
    fn larger<V: Interpretation>(&self, i: &In<V>) -> Signal<V> {
        if !self.has_walls {
            return i.target;
        }
        let (of_wall, _) = i.of_wall.saturate(self.target, HalfEven);
        i.target.less_than(of_wall).select(of_wall, i.target)
    }

    /// Pads that are known after this clock: with its drive word a pad is.
    #[inline(always)]
    fn known<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>, off: Signal<V>) -> Signal<V> {
        let made = (r.task.at(Task::Limit), i.pad);
        marks::unless(off, marks::written(r.known, made, !r.void))
    }

    /// Words of the curve that have been written, from the first on, after this clock.
    #[inline(always)]
    fn curve_words<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Signal<V> {
        let next = i.tuning.curve_write & i.tuning.curve_address.equals(r.curve_words);
        // No word has the address of the count of all.
        (r.curve_words + next).resize(r.curve_words.format, Wrap)
    }

    #[inline(always)]
    fn outputs_now<V: Interpretation>(&self, r: &Regs<V>, i: &In<V>) -> Out<V> {
        let target = i.target.where_present(self.outputs().target);
        let faults = r.watch.latched;
        let drive = self.off(r, i).select(zero(self.drive), r.drive);
        // A drive that slew holds is at no limit yet, and an invalid estimate says nothing of it.
        let low = r.low & r.drive.is(0) & !i.invalid;
        let high = r.high & !r.drive.less_than(i.tuning.rail) & !i.invalid;
        Outputs { done: r.done, drive, target, low, high, faults }
    }

    /// What the blocks and memories within give, and whether the task ends with it.
    #[inline(always)]
    fn find<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
        idle: Signal<V>,
    ) -> (Found<V>, Signal<V>) {
        let inputs = multiplier::Inputs { enable: !idle, left: r.left, right: r.right };
        let product = call!(self.multiplier, state, inputs).product;
        let (divided, quotient) = self.divided(state, r);
        let radicand = self.radicand(r, i, quotient);
        let inputs = sqrt::Inputs { start: r.sqrt_start, radicand };
        let root = call!(self.sqrt, state, inputs);
        let within = &mut state.submodules;
        let (pad, asked) = self.without_asked(r.pad_word);
        let pad_word = self.pads.data(&mut within.pads);
        let correction = match self.feeds_back() {
            true => self.corrections.data(&mut within.corrections),
            false => zero(self.kept_format()),
        };
        let known = marks::is_marked(r.known, i.pad);
        let counts = |word: Signal<V>| known.select(word, zero(word.format));
        let found = Found {
            product,
            root: root.sqrt,
            curve: self.curve_word(state, r, i),
            rises: pad.msb(),
            invalid: pad.bits(self.drive.width, pad.format.width - self.drive.width - 1),
            last: pad.bits(0, self.drive.width).as_code(self.drive).at_most(i.tuning.rail),
            asked,
            pad_word: counts(pad_word),
            correction: counts(correction),
        };
        (found, self.ends(r, root.done, divided))
    }

    /// Whether the division is done, and its quotient.
    #[inline(always)]
    fn divided<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
    ) -> (Signal<V>, Signal<V>) {
        if self.law != Law::Inverse {
            return (bit(false), zero(self.radicand));
        }
        let denominator = r.factor.as_code(self.stiffness_format());
        let inputs = divider::Inputs { start: r.divide, numerator: r.numerator, denominator };
        let divided = call!(self.divider, state, inputs);
        (divided.done, divided.quotient)
    }

    /// The word of the curve that was asked for. That of the cell's lower end is asked for first,
    /// then that of its upper one.
    #[inline(always)]
    fn curve_word<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
    ) -> Signal<V> {
        let curve = self.points.data(&mut state.submodules.points);
        let (bits, upper) = (self.cell_bits(), !(r.task.at(Task::Curve) & r.count.is(0)));
        let cell = r.root.bits(self.fine.width - bits, bits);
        let Tuning { curve_write: enable, curve_address: address, curve_word: data, .. } = i.tuning;
        let read = (cell + upper).resize(self.points.address(), Proved);
        let write = Write { enable, address, data };
        self.points.access(&mut state.submodules.points, read, write);
        curve
    }

    /// A clock of a task; where it ends, the next begins.
    #[inline(always)]
    fn work<V: Interpretation>(
        &self,
        r: Regs<V>,
        i: &In<V>,
        found: &Found<V>,
        ends: Signal<V>,
    ) -> Regs<V> {
        let loads = self.multiplies(&r) & r.count.is(0);
        let (left, right) = self.operands(&r, i, found);
        let (combine, limit) = (self.at(&r, Task::Combine), self.at(&r, Task::Limit));
        let [wanted, low, high] = self.wanted(&r, i);
        let [least, most] = self.slewed(i, found);
        Registers {
            task: ends.select(self.following(&r), r.task),
            count: ends.select(int(0), r.count.increment()),
            left: loads.select(left, r.left),
            right: loads.select(right, r.right),
            sqrt_start: ends & self.root_follows(&r),
            divide: ends & self.at(&r, Task::Target),
            wanted: combine.select(wanted, r.wanted),
            low: combine.select(low, r.low),
            high: combine.select(high, r.high),
            least: combine.select(least, r.least),
            most: combine.select(most, r.most),
            drive: limit.select(self.limited(&r, i, found.last), r.drive),
            pad_word: found.pad_word,
            done: limit,
            watch: self.faults_found(r.watch, i, found.invalid, combine),
            ..self.take(r, found, ends)
        }
    }

    /// What is known of the pad is written with the last task; until then it is read.
    #[inline(always)]
    fn keep<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        i: &In<V>,
        drive: Signal<V>,
        found: &Found<V>,
    ) {
        let enable = r.task.at(Task::Limit);
        let rises = self.rises(r, i, found.rises, drive);
        let data = rises.concat(self.invalid_count(i, found.invalid)).concat(drive.integer());
        let data = self.with_asked(data, r, i, found);
        let write = Write { enable, address: i.pad, data };
        self.pads.access(&mut state.submodules.pads, i.pad, write);
        if self.feeds_back() {
            let kept = self.kept_correction(r, drive, found.correction);
            let valid = i.invalid.select(found.correction, kept);
            let data = i.lifted.select(zero(valid.format), valid);
            let write = Write { enable, address: i.pad, data };
            self.corrections.access(&mut state.submodules.corrections, i.pad, write);
        }
    }

    /// What is known of a pad with the root of its last target, where the law's error is of it.
    #[inline(always)]
    fn with_asked<V: Interpretation>(
        &self,
        data: Signal<V>,
        r: &Regs<V>,
        i: &In<V>,
        found: &Found<V>,
    ) -> Signal<V> {
        if self.law != Law::Inverse {
            return data;
        }
        let asked = i.invalid.select(found.asked, r.asked);
        data.concat(i.lifted.select(zero(self.fine), asked).integer())
    }

    /// Both again: what is known of a pad, and the root of its last target.
    #[inline(always)]
    fn without_asked<V: Interpretation>(&self, word: Signal<V>) -> (Signal<V>, Signal<V>) {
        if self.law != Law::Inverse {
            return (word, zero(self.fine));
        }
        let bits = self.fine.width;
        (word.bits(bits, word.format.width - bits), word.bits(0, bits).as_code(self.fine))
    }

    /// Whether the law has an error.
    #[inline(always)]
    fn feeds_back(&self) -> bool {
        self.law != Law::Open
    }

    /// Whether the error of the law is one of roots.
    #[inline(always)]
    fn roots_force(&self) -> bool {
        matches!(self.law, Law::Integral | Law::Inverse)
    }

    /// Bits of the number of a cell of the curve.
    #[inline(always)]
    fn cell_bits(&self) -> u8 {
        (self.points.words - 1).ilog2() as u8
    }
}

#[cfg(test)]
mod hard_cases;
#[cfg(test)]
mod rig;
#[cfg(test)]
mod safe_state;
#[cfg(test)]
mod tests;
