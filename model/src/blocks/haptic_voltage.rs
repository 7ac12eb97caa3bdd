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
//! A haptic voltage whose period is longer than the window is read by its phase; windows that are spread evenly over whole
//! periods are right in the mean. Until a pad has had N windows since reset or `clear` its last one alone counts.
//!
//! Latency: one clock; with N > 1, N + 3, which the currents' outlasts. Source: paper, eq. 7 (the force follows the square);
//! PHYSICS §3 (the gap follows the RMS).

use super::demodulator::Demodulator;
use crate::block::{Block, Cell};
use crate::format::{BIT, Format};
use crate::memory::{Memory, Write};
use crate::profile::Profile;
use crate::signal::{Exact, HalfEven, Never, Signal, Value, Wrap, bit, code, int, zero};
use crate::{bundle, parts, when};

bundle! {
    /// The inputs: the demodulator's sums.
    pub struct Inputs {
        /// Windows of before count no more.
        clear,
        /// The pad of the window; stable until the next window's sums.
        pad,
        /// Asserted for one cycle with each sum.
        valid,
        /// The number of the sum; the last is that of the squares.
        index,
        /// The sum.
        sum,
    }
}

bundle! {
    /// The outputs: registers.
    pub struct Outputs {
        /// The mean square.
        mean_square,
        /// A window's mean square is saturated.
        saturated,
    }
}

bundle! {
    /// The registers. `newest` is that of the last window, `round` its number among the pad's last, `filled` whether all of
    /// them are of windows since reset or `clear`.
    pub struct Registers {
        busy, count, newest, round, filled, total, mean_square, saturated,
    }
}

parts! {
    /// The memory within.
    pub struct Parts of HapticVoltage {
        squares: Memory,
    }
}

/// The configuration.
#[derive(Debug, Clone)]
pub struct HapticVoltage {
    squares: Memory,
    /// Windows that are averaged.
    windows: u64,
    shift: i8,
    sums: u64,
    sum: Format,
    pad: Format,
    registers: Registers<Format>,
}

impl HapticVoltage {
    /// The haptic voltage of a profile.
    pub fn new(profile: &Profile) -> Self {
        let demodulator = Demodulator::new(profile);
        let (windows, square) = (profile.haptic.windows, profile.formats.mean_square);
        let pad = Format::counter(profile.pads - 1);
        let registers = Registers {
            busy: BIT,
            count: Format::counter(windows + 1),
            newest: square,
            round: Format::counter((windows - 1).max(1)),
            filled: BIT,
            total: Format { width: square.width + windows.ilog2() as u8, ..square },
            mean_square: square,
            saturated: BIT,
        };
        HapticVoltage {
            squares: Memory::new("squares", (windows as usize) << pad.width, square).never_colliding(),
            windows,
            shift: profile.square_shift(),
            sums: demodulator.sums(),
            sum: demodulator.sum(),
            pad,
            registers,
        }
    }

    /// Clocks from the last sum to the mean square.
    pub fn latency(&self) -> u64 {
        if self.windows == 1 { 1 } else { self.windows + 3 }
    }

    /// The window's squares are there: with one window these are the result.
    #[inline(always)]
    fn accept<V: Value>(&self, r: Registers<Signal<V>>, i: Inputs<Signal<V>>) -> Registers<Signal<V>> {
        let (newest, saturated) = i.sum.scaled(-self.shift).saturate(r.newest.format, HalfEven);
        if self.windows == 1 {
            return Registers { mean_square: newest, saturated, ..r };
        }
        // Pads are served in turn: with the first one all begin another round.
        let round = (r.round + int(1)).fit(r.round.format, Exact, Wrap);
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
    fn add<V: Value>(&self, r: Registers<Signal<V>>, data: Signal<V>) -> Registers<Signal<V>> {
        let most = code(self.squares.format.max_code() as i64, self.squares.format);
        let adds = r.count.at_least(int(2));
        let total = (r.total + data).fit(r.total.format, Exact, Wrap);
        let ends = r.count.is(self.windows + 1);
        let mean = total.scaled(-(self.windows.ilog2() as i8)).fit(r.mean_square.format, HalfEven, Never);
        let held = r.filled.select(data, r.newest).at_least(most);
        Registers {
            busy: !ends,
            count: (r.count + int(1)).fit(r.count.format, Exact, Wrap),
            total: adds.select(total, r.total),
            mean_square: ends.select(r.filled.select(mean, r.newest), r.mean_square),
            saturated: (adds & held) | (r.count.at_least(int(1)) & r.saturated),
            ..r
        }
    }

    /// One clock of the memory: the newest square goes in, and then all of the pad's come out.
    #[inline(always)]
    fn access<V: Value>(&self, cell: &mut Cell<Self, V>, r: &Registers<Signal<V>>, pad: Signal<V>) {
        let writes = r.busy & r.count.is(0);
        let read = (r.count - int(1)).bits(0, r.round.format.width);
        let write = Write { enable: writes, address: pad.concat(r.round), data: r.newest };
        self.squares.access(&mut cell.parts.squares, pad.concat(read), write);
    }
}

impl Block for HapticVoltage {
    const NAME: &'static str = "haptic_voltage";
    type Inputs = Inputs;
    type Outputs = Outputs;
    type Registers = Registers;
    type Parts<V: Value> = Parts<V>;

    #[inline]
    fn inputs(&self) -> Inputs<Format> {
        Inputs { clear: BIT, pad: self.pad, valid: BIT, index: Format::counter(self.sums - 1), sum: self.sum }
    }

    #[inline]
    fn outputs(&self) -> Outputs<Format> {
        let Registers { mean_square, saturated, .. } = self.registers;
        Outputs { mean_square, saturated }
    }

    #[inline(always)]
    fn registers(&self) -> Registers<Format> {
        let r = self.registers;
        Registers { busy: BIT, count: r.count.counting(), round: r.round.counting(), filled: BIT, saturated: BIT, ..r }
    }

    #[inline(always)]
    fn clock<V: Value>(&self, cell: &mut Cell<Self, V>, i: Inputs<Signal<V>>) -> Outputs<Signal<V>> {
        let r = cell.load(self);
        let outputs = Outputs { mean_square: r.mean_square, saturated: r.saturated };
        if (i.valid | r.busy | i.clear).idle() {
            return outputs;
        }
        let squares = (i.valid & i.index.is(self.sums - 1)).named("squares_valid");
        if self.windows == 1 {
            cell.store(self, when!(V, Registers, squares, self.accept(r, i), r));
            return outputs;
        }
        let data = self.squares.data(&mut cell.parts.squares);
        self.access(cell, &r, i.pad);
        let next = when!(V, Registers, squares, self.accept(r, i), when!(V, Registers, r.busy, self.add(r, data), r));
        let cleared = Registers { round: int(0), filled: bit(false), ..next };
        cell.store(self, when!(V, Registers, i.clear, cleared, next));
        outputs
    }
}
