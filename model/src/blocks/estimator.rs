// SPDX-License-Identifier: MIT OR Apache-2.0
//! Estimator: from a window's sums to a frame, each stage starting the next.
//!
//! ```text
//! sums ─ currents ─ ratio ─ position ─ capacitance ─ force ─ frames ─ words
//!      └ haptic voltage ───────────────────────────────┘
//! ```
//!
//! For a force controller, which cannot wait for the position, a prompt estimate comes first: the
//! capacitance with the sheet's resistance at the pad's last place, and its force.
//!
//! ```text
//! sums ─ currents ─ capacitance ─ force ─ prompt           (sheet: that of the pad's last frame)
//!                       ratio ─ position ─ capacitance ─ force ─ frames
//! ```
//!
//! One slot is in flight at a time, so that nothing of one pad can meet anything of another. A
//! profile's slots are longer than the latency: a frame is finished before the next sums come. A
//! prompt estimate therefore finds the resistance of the pad's last slot, whichever pads came
//! between. Latency: the sum of the stages', from the last sum to the last word.
//!
//! Sums that come earlier, after an upset of the multiplexer, are dropped. Those of the window after them are taken
//! even while the estimator is busy, so that an upset of `busy` does not stop the core.

mod alone;
mod run_on;

use self::run_on::Given;
use super::capacitance::{self, Capacitance};
use super::currents::{self, Currents};
use super::force::{self, Force};
use super::force_table::{self, ForceTable};
use super::frames::{self, Frames};
use super::haptic_voltage::{self, HapticVoltage};
use super::marks;
use super::position::{self, Position, TablePort};
use super::ratio::{self, Ratio};
use hapticore_contract::calibration::ForceTable as Words;
use hapticore_contract::profile::{ForceLaw, Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{Proved, Saturate, Signal, bit, code, constant, int, zero};
use hapticore_hdl::{block, bundle, call, when};

bundle! {
    /// What a calibration sets. The words of the position table are written while no slot is under way.
    pub struct Calibration {
        /// Calibration: gain of the capacitance, pF at an admittance of 1.
        capacitance_gain,
        /// Calibration: gain of the force, N/pF² at a full-scale haptic mean square.
        force_gain,
        /// Calibration: capacitance at or below which a pad is lifted, pF.
        contact_capacitance,
        table as TablePort,
    }
}

bundle! {
    /// A frame: its words one after the other, and what holds for the whole of it.
    pub struct FramePort {
        /// Asserted for one cycle for each word of a frame.
        valid,
        /// The number of the word's field.
        index,
        /// Word of the frame, a code in the field's format.
        frame,
        /// Asserted with the last word.
        done,
        /// Pad of the frame.
        pad,
        /// A code was at full scale of the ADC.
        clipped,
        /// A word is saturated.
        saturated,
        /// No position or capacitance has these currents; the last valid results are given out.
        invalid,
        /// A terminal is open.
        lost,
        /// The pad does not touch; its last valid place is given out.
        lifted,
    }
}

bundle! {
    /// An estimate before its frame. Its words are stable until the frame's force replaces them.
    pub struct PromptPort {
        /// Asserted for one cycle: the estimate that comes before the frame is valid.
        prompt,
        /// Pad of the estimate.
        prompt_pad,
        /// Capacitance with the sheet's resistance at the pad's last place, pF.
        prompt_capacitance,
        /// Its haptic force, N.
        prompt_force,
        /// Gain of that force, N/pF² at a full-scale haptic mean square.
        prompt_gain,
        /// No capacitance has these currents, or a code or a word is at its limit.
        prompt_invalid,
        /// The pad does not touch.
        prompt_lifted,
    }
}

block! {
    /// The estimator: makes a frame of a window's sums.
    pub struct Estimator("estimator") {
        pads: u64,
        /// Whether there is a prompt estimate.
        prompts: bool,
        force_gain: Format,
        /// For interpretations that know every bit: blocks run through their clocks as they are started.
        hurried: bool,
    }
    submodules {
        /// The sheet's resistance at the last place of each pad that has one.
        sheets: Memory,
        currents: Currents,
        ratio: Ratio,
        position: Position,
        haptic_voltage: HapticVoltage,
        capacitance: Capacitance,
        /// By eq. 8.
        force_estimator: Option<Force>,
        /// With a table, where that is the law.
        force_table: Option<ForceTable>,
        frames: Frames,
    }
    inputs(estimator) {
        /// Mean squares of earlier windows no longer count, nor what a prompt estimate takes of earlier slots.
        clear: BIT,
        /// Asserted for one cycle with each of the demodulator's sums.
        valid: BIT,
        /// The number of the sum.
        index: estimator.haptic_voltage.inputs().index,
        sum: estimator.haptic_voltage.inputs().sum,
        /// Pad whose slot the window belongs to.
        pad: estimator.pad(),
        /// A code of the window was at full scale.
        clipped: BIT,
        calibration as Calibration: estimator.calibration(),
    }
    outputs(estimator) {
        frames as FramePort: estimator.frame(),
        prompt as PromptPort: estimator.prompt(),
    }
    registers(estimator) {
        busy: BIT,
        /// The window's sums are dropped: they came before the last frame was finished.
        dropping: BIT,
        /// The prompt estimate is under way.
        early: BIT.where_present(estimator.prompts),
        /// The prompt estimate has been given: the frame's follows.
        follow: BIT.where_present(estimator.prompts),
        /// The pad of the prompt estimate does not touch.
        lifted: BIT.where_present(estimator.prompts),
        pad: estimator.pad(),
        clipped: BIT,
        /// Pads with a place.
        placed: marks::format(estimator.pads).where_present(estimator.prompts),
    }
}

impl Estimator {
    /// The estimator of a profile.
    ///
    /// # Errors
    /// The first of its blocks that cannot be.
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        if profile.control.is_some() {
            marks::check(profile)?;
        }
        let (currents, law) = (Currents::try_new(profile)?, profile.force.law);
        let sheets = Memory::new("sheets", profile.pads as usize, profile.sheet());
        Ok(Estimator {
            prompts: profile.control.is_some(),
            hurried: false,
            sheets: sheets.dont_care_on_collision().in_block(),
            ratio: Ratio::try_new(profile, currents.sums(), currents.least())?,
            position: Position::new(profile),
            haptic_voltage: HapticVoltage::try_new(profile)?,
            capacitance: Capacitance::try_new(profile, currents.amplitude())?,
            force_estimator: (law == ForceLaw::Eq8).then(|| Force::try_new(profile)).transpose()?,
            force_table: (law == ForceLaw::Table)
                .then(|| ForceTable::try_new(profile))
                .transpose()?,
            force_gain: profile.formats.force_gain,
            frames: Frames::new(profile),
            pads: profile.pads,
            currents,
        })
    }

    #[inline(always)]
    fn pad(&self) -> Format {
        Format::counter(self.pads - 1)
    }

    /// The formats of the calibration.
    fn calibration(&self) -> Calibration<Format> {
        let (capacitance_gain, force_gain) = (self.capacitance.inputs().gain, self.force_gain);
        let contact_capacitance = self.capacitance.outputs().capacitance;
        let table = TablePort { address: self.table().address(), ..self.position.inputs().table };
        Calibration { capacitance_gain, force_gain, contact_capacitance, table }
    }

    /// The formats of a frame.
    #[inline(always)]
    fn frame(&self) -> FramePort<Format> {
        let frames::Outputs { valid, index, word, done } = self.frames.outputs();
        let (pad, [clipped, saturated, invalid, lost, lifted]) = (self.pad(), [BIT; 5]);
        FramePort {
            valid,
            index,
            frame: word,
            done,
            pad,
            clipped,
            saturated,
            invalid,
            lost,
            lifted,
        }
    }

    /// The formats of a prompt estimate.
    #[inline(always)]
    fn prompt(&self) -> PromptPort<Format> {
        let formats = PromptPort {
            prompt: BIT,
            prompt_pad: self.pad(),
            prompt_capacitance: self.capacitance.outputs().capacitance,
            prompt_force: self.frames.inputs().haptic_force,
            prompt_gain: self.force_gain,
            prompt_invalid: BIT,
            prompt_lifted: BIT,
        };
        PromptPort::map(formats, |format| format.where_present(self.prompts))
    }

    /// Clocks from the last sum to the prompt estimate.
    pub fn prompt_latency(&self) -> u64 {
        self.currents.latency() + self.capacitance.latency() + self.force_latency()
    }

    fn force_latency(&self) -> u64 {
        self.force_estimator.as_ref().map_or(0, Force::latency)
            + self.force_table.as_ref().map_or(0, ForceTable::latency)
    }

    /// Clocks from the last sum to the last word.
    pub fn latency(&self) -> u64 {
        let stages = [
            self.currents.latency(),
            self.ratio.latency(),
            self.position.latency(),
            self.capacitance.latency(),
            self.force_latency(),
            self.frames.latency(),
        ];
        let prompt =
            if self.prompts { self.prompt_latency() - self.currents.latency() + 1 } else { 0 };
        prompt + stages.into_iter().sum::<u64>()
    }

    /// From now on interpretations that know every bit need not look at all blocks in each clock:
    /// [`Position::place_at_once`], and the others run through their clocks as they are started.
    pub(crate) fn place_at_once(&mut self, table: Vec<i64>) {
        self.position.place_at_once(table);
        self.hurry();
    }

    /// The same with [`Position::place_by_statements`].
    pub(crate) fn place_by_statements(&mut self) {
        self.position.place_by_statements();
        self.hurry();
    }

    fn hurry(&mut self) {
        self.hurried = true;
        self.currents.hurry();
        self.ratio.hurry();
        self.capacitance.hurry();
    }

    /// What the table port writes: the position table, and behind it the force table where there
    /// is one.
    pub fn table(&self) -> Memory {
        let (position, force) = (self.position.table(), &self.force_table);
        let words = position.words + force.as_ref().map_or(0, |_| Words::WORDS);
        Memory { words, ..position.clone() }
    }

    /// Sets the words that the table port writes, without its clocks.
    pub(crate) fn set_table<V: Interpretation>(&self, state: &mut State<Self, V>, words: &[f64]) {
        let (format, of_position) = (self.position.table().format, self.position.table().words);
        for (address, &word) in words.iter().enumerate() {
            let word = constant(word, format);
            match address.checked_sub(of_position) {
                None => self.position.set_word(&mut state.submodules.position, address, word),
                Some(address) => {
                    let within = state.submodules.force_table.as_mut();
                    let (block, within) = self.force_table.as_ref().zip(within).expect("has words");
                    block.set_word(within, address, word);
                }
            }
        }
    }

    /// The port of the position table, and that of the force table where there is one.
    #[inline(always)]
    fn table_ports<V: Interpretation>(
        &self,
        port: TablePort<Signal<V>>,
    ) -> [TablePort<Signal<V>>; 2] {
        let Some(force) = &self.force_table else { return [port; 2] };
        let words = self.position.table().words as u64;
        let address = self.position.inputs().table.address;
        let last = code(words as i64 - 1, port.address.format);
        let behind = port.address.at_least(int(words)).named("force_word");
        let of_position = port.address.at_most(last).resize(address, Proved);
        let of_force = (port.address - int(words)).resize(force.inputs().table.address, Saturate);
        [
            TablePort { write: port.write & !behind, address: of_position, ..port },
            TablePort { write: port.write & behind, address: of_force, ..port },
        ]
    }

    /// The force: by eq. 8, or with the table where there is one; and the gain that it has of
    /// (C·V)².
    #[inline(always)]
    fn force<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: force::In<V>,
        (clear, hold, pad, table): (Signal<V>, Signal<V>, Signal<V>, TablePort<Signal<V>>),
    ) -> (force::Out<V>, Signal<V>) {
        let force::Inputs { start, capacitance, mean_square, gain } = i;
        let (by_eq8, by_table) = (&self.force_estimator, &self.force_table);
        if let Some((block, within)) =
            by_eq8.as_ref().zip(state.submodules.force_estimator.as_mut())
        {
            return (block.call("force_estimator", within, i), gain);
        }
        let (block, within) = by_table
            .as_ref()
            .zip(state.submodules.force_table.as_mut())
            .expect("one law or the other");
        let hold = hold.where_present(block.inputs().hold);
        let clear = clear.where_present(block.inputs().clear);
        let inputs =
            force_table::Inputs { start, clear, hold, pad, capacitance, mean_square, gain, table };
        let force_table::Outputs { done, haptic_force, factored_gain, saturated } =
            block.call("force_table", within, inputs);
        (force::Outputs { done, haptic_force, saturated }, factored_gain)
    }

    /// The position block's configuration.
    pub fn position(&self) -> &Position {
        &self.position
    }

    /// The currents block's configuration.
    pub fn currents(&self) -> &Currents {
        &self.currents
    }
}

impl Block for Estimator {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        self.cycle::<V, false>(state, i)
    }
}

impl Estimator {
    /// A clock, in which blocks that are started run through theirs if they are to. Apart from
    /// [`Block::clock`], which is slower with so much as the question.
    #[inline(always)]
    pub(crate) fn clock_running_on<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        i: In<V>,
    ) -> Out<V> {
        self.cycle::<V, true>(state, i)
    }

    #[inline(always)]
    fn cycle<V: Interpretation, const RUNS_ON: bool>(
        &self,
        state: &mut State<Self, V>,
        i: In<V>,
    ) -> Out<V> {
        let r = state.load(self);
        if (i.valid | r.busy | i.calibration.table.write | i.clear).can_skip() {
            return self.quiet(state, r, &i);
        }
        let Inputs { index, sum, .. } = i;
        let early = r.busy & !r.dropping;
        let drops = index.is(0).select(early, r.dropping).named("drops");
        let valid = i.valid & !drops;
        let to_currents = currents::Inputs { valid, index, sum };
        let currents = call!(self.currents, state, to_currents);
        let pad = valid.select(i.pad, r.pad);
        let to_haptic = haptic_voltage::Inputs { clear: i.clear, pad, valid, index, sum };
        let haptic = call!(self.haptic_voltage, state, to_haptic);
        let currents::Outputs { x, y, corners, least, .. } = currents;
        let start = if self.prompts { r.follow } else { currents.done };
        let to_ratio = ratio::Inputs { start, x, y, corners, least };
        let ratio = call!(self.ratio, state, to_ratio);
        let [of_position, of_force] = self.table_ports(i.calibration.table);
        let inputs = position::Inputs {
            start: ratio.done,
            r_x: ratio.r_x,
            r_y: ratio.r_y,
            share: ratio.share,
            table: of_position,
        };
        let position = call!(self.position, state, inputs);
        let invalid_place = ratio.invalid | position.invalid;
        let sheet = self.sheet(state, &r, pad, &position, invalid_place);
        let to_capacitance = capacitance::Inputs {
            start: position.done | (currents.done & bit(self.prompts)),
            total: currents.total,
            sense: currents.sense,
            sheet,
            gain: i.calibration.capacitance_gain,
        };
        let capacitance = call!(self.capacitance, state, to_capacitance);
        let contact = i.calibration.contact_capacitance;
        let lifted = contact.at_least(capacitance.capacitance).named("is_lifted");
        let to_force = force::Inputs {
            start: capacitance.done,
            capacitance: capacitance.capacitance,
            mean_square: haptic.mean_square,
            gain: i.calibration.force_gain,
        };
        let (force, gain) = self.force(state, to_force, (i.clear, self.early(&r), r.pad, of_force));
        let invalid = invalid_place | capacitance.invalid;
        let inputs = frames::Inputs {
            start: if self.prompts { force.done & !r.early } else { force.done },
            pad: r.pad,
            invalid,
            lifted,
            r_x: self.frames.ratio(ratio.r_x),
            r_y: self.frames.ratio(ratio.r_y),
            x: position.x,
            y: position.y,
            sheet: position.sheet,
            capacitance: capacitance.capacitance,
            haptic_force: force.haptic_force,
            mean_square: haptic.mean_square,
        };
        let frames = call!(self.frames, state, inputs);
        let held = currents.saturated
            | haptic.saturated
            | position.saturated
            | capacitance.saturated
            | force.saturated;
        let held = held.named("any_saturated");
        let prompt_done = (force.done & self.early(&r)).named("prompt_done");
        let prompt = PromptPort {
            prompt: prompt_done,
            prompt_pad: r.pad,
            prompt_capacitance: capacitance.capacitance,
            prompt_force: force.haptic_force,
            prompt_gain: gain,
            prompt_invalid: prompt_done & (held | capacitance.invalid | r.clipped),
            prompt_lifted: prompt_done & lifted,
        };
        let prompt = self.where_prompt(prompt);
        let next = Registers {
            busy: valid | (r.busy & !frames.done),
            dropping: i.valid.select(drops, r.dropping),
            early: (currents.done | (self.early(&r) & !force.done)).where_present(r.early.format),
            follow: prompt_done.where_present(r.follow.format),
            lifted: prompt_done.select(lifted, r.lifted).where_present(r.lifted.format),
            pad,
            clipped: valid.select(i.clipped, r.clipped),
            placed: self.placed(&r, &i, pad, position.done & !invalid_place),
        };
        state.store(self, next);
        if RUNS_ON && self.hurried {
            self.run_on(
                state,
                Given { to_currents, to_haptic, to_ratio, to_capacitance, to_force },
            );
        }
        let gate = |a: Signal<V>| when!(frames.valid => a, else zero(a.format));
        let frames = FramePort {
            valid: frames.valid,
            index: gate(frames.index),
            frame: gate(frames.word),
            done: frames.done,
            pad: r.pad,
            clipped: r.clipped,
            saturated: gate(held),
            invalid: gate(invalid),
            lost: gate(position.lost),
            lifted: gate(lifted),
        };
        Outputs { frames, prompt }
    }
}

impl Estimator {
    /// The outputs while idle: no frame, and so nothing about one; of the last prompt estimate, the
    /// words.
    #[inline(always)]
    fn quiet<V: Interpretation>(&self, state: &State<Self, V>, r: Regs<V>, i: &In<V>) -> Out<V> {
        let nothing = FramePort::map(self.frame(), zero);
        let frames = FramePort { pad: r.pad, clipped: r.clipped, ..nothing };
        if !self.prompts {
            return Outputs { frames, prompt: PromptPort::map(self.prompt(), zero) };
        }
        let within = &state.submodules;
        let (force, gain) = self.last_force(state, i.calibration.force_gain);
        let prompt = PromptPort {
            prompt: bit(false),
            prompt_pad: r.pad,
            prompt_capacitance: within.capacitance.load(&self.capacitance).capacitance,
            prompt_force: force,
            prompt_gain: gain,
            prompt_invalid: bit(false),
            prompt_lifted: bit(false),
        };
        Outputs { frames, prompt }
    }

    /// The last force and its gain, as they are held.
    #[inline(always)]
    fn last_force<V: Interpretation>(
        &self,
        state: &State<Self, V>,
        gain: Signal<V>,
    ) -> (Signal<V>, Signal<V>) {
        let (by_eq8, by_table) = (&self.force_estimator, &self.force_table);
        let within = &state.submodules;
        if let Some((block, within)) = by_eq8.as_ref().zip(within.force_estimator.as_ref()) {
            return (within.load(block).haptic_force, gain);
        }
        let (block, within) =
            by_table.as_ref().zip(within.force_table.as_ref()).expect("one law or the other");
        let held = within.load(block);
        (held.haptic_force, held.factored_gain)
    }

    /// The ports of a prompt estimate, where there is one.
    #[inline(always)]
    fn where_prompt<V: Interpretation>(
        &self,
        prompt: PromptPort<Signal<V>>,
    ) -> PromptPort<Signal<V>> {
        let with_formats = PromptPort::zip(prompt, self.prompt());
        PromptPort::map(with_formats, |(signal, format)| signal.where_present(format))
    }

    /// The sheet's resistance: at the pad's last place during the prompt estimate, then at this
    /// one, which is kept where it is valid and the pad touches.
    #[inline(always)]
    fn sheet<V: Interpretation>(
        &self,
        state: &mut State<Self, V>,
        r: &Regs<V>,
        pad: Signal<V>,
        position: &position::Out<V>,
        invalid: Signal<V>,
    ) -> Signal<V> {
        if !self.prompts {
            return position.sheet;
        }
        let last = self.sheets.data(&mut state.submodules.sheets);
        let enable = position.done & !invalid & !r.lifted;
        let write = Write { enable, address: pad, data: position.sheet };
        self.sheets.access(&mut state.submodules.sheets, pad, write);
        r.early.select(self.where_placed(r, last), position.sheet)
    }

    /// The sheet's resistance at the pad's last place, nothing where it has none.
    #[inline(always)]
    fn where_placed<V: Interpretation>(&self, r: &Regs<V>, last: Signal<V>) -> Signal<V> {
        marks::is_marked(r.placed, r.pad).select(last, zero(last.format))
    }

    /// Pads with a place after this clock.
    #[inline(always)]
    fn placed<V: Interpretation>(
        &self,
        r: &Regs<V>,
        i: &In<V>,
        pad: Signal<V>,
        found: Signal<V>,
    ) -> Signal<V> {
        if !self.prompts {
            return r.placed;
        }
        marks::unless(i.clear, marks::written(r.placed, (found, pad), bit(true)))
    }

    /// Whether the prompt estimate is in progress.
    #[inline(always)]
    fn early<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        if self.prompts { r.early } else { bit(false) }
    }
}

#[cfg(test)]
mod tests;
