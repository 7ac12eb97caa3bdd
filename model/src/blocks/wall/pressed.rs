// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force of a stationary push, which falls where the push reads weaker: rule B.
//!
//! ```text
//! ū += (u − ū)/8;   r, d: ū and the deepest x̄ of the push, taken where PUSH is entered and outside of the wall
//! PUSH, last F > latch      y = min(y, 0)
//! x̄ < d − slip              gain += 4/ramp;   r = ū,   d = (d + x̄)/2,   q = 0
//! otherwise                 ū < r: r += (ū − r)/4;   d < x̄ − slip: d += (x̄ − slip − d)/16;   q += 1
//!   q > quiet, ū − r > σ    gain −= 1/ramp
//!   otherwise               gain += 1/ramp,   up to 1
//! ```
//!
//! Patches that a push has pulled in stay closed when it ends, so that the level of u is lost beyond some force. Its
//! change is not: where the push becomes weaker, u rises. The force that falls then either lets the pad slip inwards,
//! for the hand still pushes, and returns immediately; or the patches open and the direction can be read. Source:
//! docs/physics.md §6.
//!
//! | signal | format | unit | overflow |
//! | ū, r | s16.16 | – | cannot: a mean |
//! | d | x̄'s | mm | cannot: a mean with x̄, or with less than x̄ and more than d |
//! | gain | u11.10 | – | held within 0 and 1 |

use super::rule::{counted, filtered, number};
use super::{GAIN, Kept, Registers, Regs, Wall};
use hapticore_contract::profile::Release;
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::signal::{HalfEven, Proved, Signal, Wrap, code, int, zero};

bundle! {
    /// What is kept of a push.
    pub struct Pressed {
        /// Filtered direction.
        slow,
        /// The least of it since the last slip inwards.
        slipped,
        /// Place of that slip.
        deep,
        /// Frames since then.
        quiet,
        /// The last force was so large that no reading lets go.
        latched,
    }
}

/// The format of filtered directions.
const SLOW: Format = Format::signed(16, 16);

impl Wall {
    /// The force of a stationary push may fall.
    #[inline(always)]
    pub(super) fn fades(&self) -> bool {
        self.rule.rule == Release::Sequential && self.rule.quiet_frames > 0
    }

    #[inline(always)]
    pub(super) fn pressed_formats(&self) -> Pressed<Format> {
        let all = Pressed {
            slow: SLOW,
            slipped: SLOW,
            deep: self.filtered(),
            quiet: Format::counter(self.rule.quiet_frames.max(1)),
            latched: BIT,
        };
        <Pressed as bundle::Bundle>::map(all, |format| format.where_present(self.fades()))
    }

    /// What is kept of a pad at its first frame.
    #[inline(always)]
    pub(super) fn unpressed<V: Interpretation>(
        &self,
        factory: Signal<V>,
        x: Signal<V>,
    ) -> Pressed<Signal<V>> {
        let formats = self.pressed_formats();
        let none = <Pressed as bundle::Bundle>::map(formats, zero);
        if !self.fades() {
            return none;
        }
        let slow = factory.resize(SLOW, Proved);
        Pressed { slow, slipped: slow, deep: x.resize(formats.deep, Proved), ..none }
    }

    /// ū with the direction of the frame.
    #[inline(always)]
    pub(super) fn slow<V: Interpretation>(&self, old: Signal<V>, u: Signal<V>) -> Signal<V> {
        if self.fades() { filtered(old, u, 3, SLOW) } else { old }
    }

    /// y, where it may speak for letting go.
    #[inline(always)]
    pub(super) fn heard<V: Interpretation>(&self, k: &Kept<Signal<V>>, y: Signal<V>) -> Signal<V> {
        if !self.fades() {
            return y;
        }
        (k.pressed.latched & !k.free & !y.msb()).select(zero(y.format), y)
    }

    /// Whether the pad slips inwards, and whether the push reads weaker than at its last slip.
    #[inline(always)]
    pub(super) fn doubted<V: Interpretation>(&self, r: Regs<V>, rough: Signal<V>) -> Regs<V> {
        if !self.fades() {
            return r;
        }
        let k = r.kept;
        let of = k.pressed;
        let sigma = rough.select(number(2f64.powi(-7), SLOW), number(2f64.powi(-8), SLOW));
        Registers {
            slips: k.filtered.less_than(of.deep - self.slip()),
            weaker: sigma.less_than(of.slow - of.slipped),
            ..r
        }
    }

    #[inline(always)]
    fn slip<V: Interpretation>(&self) -> Signal<V> {
        number(1e-3 * self.rule.slip_um as f64, self.filtered())
    }

    /// What is kept behind a frame of a push that goes on.
    #[inline(always)]
    pub(super) fn pressed<V: Interpretation>(&self, r: &Regs<V>) -> Kept<Signal<V>> {
        let k = r.kept;
        let of = k.pressed;
        let quiet = self.rule.quiet_frames;
        let behind = k.filtered - self.slip();
        // Slowly, so that no single place that is read too far out makes a slip of the next ones.
        let follows = of.deep.less_than(behind).select(behind, of.deep);
        let followed = filtered(of.deep, follows, 4, of.deep.format);
        let slipped = (of.deep + k.filtered).scaled(-1).quantize(of.deep.format, HalfEven, Proved);
        let lower = of.slow.less_than(of.slipped);
        let pressed = Pressed {
            slipped: r
                .slips
                .select(of.slow, lower.select(filtered(of.slipped, of.slow, 2, SLOW), of.slipped)),
            deep: r.slips.select(slipped, followed),
            quiet: r.slips.select(zero(of.quiet.format), counted(of.quiet, quiet)),
            ..of
        };
        let falls = !r.slips & r.weaker & of.quiet.is(quiet);
        let step = self.gain_step::<V>();
        let steps = r.slips.select(step.scaled(2), falls.select(-step, step));
        Kept { gain: within_one(k.gain + steps), pressed, ..k }
    }

    /// What is kept where a push begins: of here and now.
    #[inline(always)]
    pub(super) fn begun<V: Interpretation>(&self, k: &Kept<Signal<V>>) -> Pressed<Signal<V>> {
        let of = k.pressed;
        if !self.fades() {
            return of;
        }
        Pressed { slipped: of.slow, deep: k.filtered, quiet: zero(of.quiet.format), ..of }
    }

    /// What is saved: with what the force says.
    #[inline(always)]
    pub(super) fn with_force<V: Interpretation>(
        &self,
        kept: Kept<Signal<V>>,
        force: Signal<V>,
    ) -> Kept<Signal<V>> {
        if !self.fades() {
            return kept;
        }
        let latch = self.force.code_saturating(1e-3 * self.rule.latch_mn as f64);
        let latched = code(latch, self.force).less_than(force);
        Kept { pressed: Pressed { latched, ..kept.pressed }, ..kept }
    }
}

/// A gain within 0 and 1.
#[inline(always)]
fn within_one<V: Interpretation>(gain: Signal<V>) -> Signal<V> {
    let one = number(1.0, GAIN);
    let most = one.less_than(gain).select(one, gain.resize(GAIN, Wrap));
    gain.less_than(int(0)).select(zero(GAIN), most)
}
