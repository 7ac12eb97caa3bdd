// SPDX-License-Identifier: MIT OR Apache-2.0
//! Haptic voltage: its mean square over the demodulator's window, or over a pad's last few windows.
//!
//! ```text
//! m = Σ w[n]·h[n]² · 2^-shift        (the weighted sum comes from the demodulator; the host knows Σ w)
//! mean_square = 1/N · Σ m            over the pad's last N windows, N a power of two
//! ```
//!
//! ```text
//! sum ─[round half even, saturate]─┬─────────────────────────────────────────────────┬─ mean_square     (N = 1)
//!                                  └─[squares: N of every pad]─(+)─[round half even]─┘
//! ```
//!
//! | signal      | format  | unit             | overflow           |
//! | mean_square | profile | full scale²      | saturates, flagged |
//! | total       | exact   | full scale²      | cannot             |
//!
//! A haptic voltage whose period is longer than the window is read by its phase; windows that are
//! spread evenly over whole periods are right in the mean. Until a pad has had N windows since
//! reset or `clear` its last one alone counts.
//!
//! Latency: one clock; with N > 1, N + 3, which the currents' outlasts. Source: paper, eq. 7 (the
//! force follows the square); docs/physics.md §3 (the gap follows the RMS).

use super::demodulator::Demodulator;
use super::rests::Rests;
use crate::buildable::rounds;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::memory::{Memory, Write};
use hapticore_hdl::signal::{HalfEven, Proved, Signal, Wrap, bit, code, int, zero};
use hapticore_hdl::{block, when};

block! {
    /// The mean square of the haptic voltage.
    pub struct HapticVoltage("haptic_voltage") {
        /// Windows that are averaged.
        windows: u64,
        shift: i8,
        sums: u64,
        sum: Format,
        pad: Format,
        square: Format,
    }
    submodules {
        squares: Memory,
    }
    inputs(haptic) {
        /// Windows before this cycle no longer count.
        clear: BIT,
        /// The pad of the window; stable until the next window's sums.
        pad: haptic.pad,
        /// Asserted for one cycle with each sum.
        valid: BIT,
        /// Number of the sum; the last is the mean square.
        index: Format::counter(haptic.sums - 1),
        /// Sum of a window, from the demodulator.
        sum: haptic.sum,
    }
    outputs(haptic) {
        /// Mean square of the haptic voltage, full scale².
        mean_square: haptic.square,
        /// A window's mean square is saturated.
        saturated: BIT,
    }
    registers(haptic) {
        busy: BIT,
        count: Format::counter(haptic.windows + 1),
        /// That of the last window.
        newest: haptic.square,
        /// The number of the last window among the pad's last.
        round: Format::counter((haptic.windows - 1).max(1)),
        /// All of them are of windows since reset or `clear`.
        filled: BIT,
        total: Format { width: haptic.square.width + haptic.windows.ilog2() as u8, ..haptic.square },
        mean_square: haptic.square,
        saturated: BIT,
    }
}

impl HapticVoltage {
    /// The haptic voltage of a profile.
    ///
    /// # Errors
    /// A mean square to which no word of the model can be rounded; sums as
    /// [`Demodulator::try_new`].
    pub fn try_new(profile: &Profile) -> Result<Self, ProfileError> {
        let demodulator = Demodulator::try_new(profile)?;
        let (windows, square) = (profile.haptic.windows, profile.formats.mean_square);
        let (pad, shift) = (Format::counter(profile.pads - 1), profile.square_shift());
        let sum = demodulator.sum().scaled(-shift);
        rounds("formats.mean_square", "a window's sum of squares", sum, square)?;
        Ok(HapticVoltage {
            squares: Memory::new("squares", (windows as usize) << pad.width, square)
                .dont_care_on_collision(),
            windows,
            shift,
            sums: demodulator.sums(),
            sum: demodulator.sum(),
            pad,
            square,
        })
    }

    /// The clocks from the last sum to the mean square, one after the other, where every bit is known.
    #[inline(never)]
    pub(crate) fn run_on<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) {
        let held = Inputs { valid: bit(false), clear: bit(false), ..i };
        while V::known_bit(state.registers.busy) == Some(true) {
            self.clock(state, held);
        }
    }

    /// Clocks from the last sum to the mean square.
    pub fn latency(&self) -> u64 {
        if self.windows == 1 { 1 } else { self.windows + 3 }
    }

    /// The window's squares are there: with one window these are the result.
    #[inline(always)]
    fn accept<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let (newest, saturated) = i.sum.scaled(-self.shift).saturate(r.newest.format, HalfEven);
        if self.windows == 1 {
            return Registers { mean_square: newest, saturated, ..r };
        }
        // Pads are selected in turn: with the first one all begin another round.
        let round = r.round.increment();
        let begins = i.pad.is(0);
        Registers {
            busy: bit(true),
            count: int(0),
            newest,
            round: begins.select(round, r.round),
            filled: r.filled | (begins & round.is(0)),
            total: zero(r.total.format),
            ..r
        }
    }

    /// A clock of the sum over the pad's windows: the newest is written, then all are read.
    #[inline(always)]
    fn add<V: Interpretation>(&self, r: Regs<V>, data: Signal<V>) -> Regs<V> {
        let most = code(self.squares.format.max_code() as i64, self.squares.format);
        let adds = r.count.at_least(int(2));
        let total = (r.total + data).resize(r.total.format, Wrap);
        let ends = r.count.is(self.windows + 1);
        let mean = total.scaled(-(self.windows.ilog2() as i8)).quantize(
            r.mean_square.format,
            HalfEven,
            Proved,
        );
        let held = r.filled.select(data, r.newest).at_least(most);
        Registers {
            busy: !ends,
            count: r.count.increment(),
            total: adds.select(total, r.total),
            mean_square: ends.select(r.filled.select(mean, r.newest), r.mean_square),
            saturated: (adds & held) | (r.count.at_least(int(1)) & r.saturated),
            ..r
        }
    }

    /// One clock of the memory: the newest square goes in, and then all of the pad's come out.
    #[inline(always)]
    fn access<V: Interpretation>(&self, state: &mut State<Self, V>, r: &Regs<V>, pad: Signal<V>) {
        let writes = r.busy & r.count.is(0);
        let read = (r.count - int(1)).bits(0, r.round.format.width);
        let write = Write { enable: writes, address: pad.concat(r.round), data: r.newest };
        self.squares.access(&mut state.submodules.squares, pad.concat(read), write);
    }
}

impl Rests for HapticVoltage {
    #[inline(always)]
    fn under_way<V: Interpretation>(&self, r: &Regs<V>) -> Signal<V> {
        r.busy
    }
}

impl Block for HapticVoltage {
    #[inline(always)]
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let outputs = Outputs { mean_square: r.mean_square, saturated: r.saturated };
        if (i.valid | self.under_way(&r) | i.clear).can_skip() {
            return outputs;
        }
        let squares = (i.valid & i.index.is(self.sums - 1)).named("squares_valid");
        if self.windows == 1 {
            state.store(self, when!(squares => self.accept(r, i), else r));
            return outputs;
        }
        let data = self.squares.data(&mut state.submodules.squares);
        self.access(state, &r, i.pad);
        let next =
            when!(squares => self.accept(r, i), else when!(r.busy => self.add(r, data), else r));
        let cleared = Registers { round: int(0), filled: bit(false), ..next };
        state.store(self, when!(i.clear => cleared, else next));
        outputs
    }
}

#[cfg(test)]
mod tests;
