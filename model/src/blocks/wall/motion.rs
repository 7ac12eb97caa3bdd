// SPDX-License-Identifier: MIT OR Apache-2.0
//! The direction of motion: a pad that slides along the surface is not braked.
//!
//! ```text
//! x̄, ȳ: the filtered place, ȳ += (y − ȳ)/4;   a: a point that follows it;   r: the play
//! n, t: the way from a to x̄, ȳ, inwards and along the surface
//! |n| > r or |t| > r            a += (x̄, ȳ − a)/4
//! |t| > 2n and |t| > r/2         gain = 0:   the pad goes by less than 27° to the surface
//! ```
//!
//! In a corner a wall holds back what leaves the other. Where the user begins to leave that, the way is taken to be along this
//! one's surface, n = 0, t = r. From then on 4t stands for t, since a pad that is drawn out of the corner goes into this wall, too.
//! It does until the user has left the other wall and the pad goes into this one.
//!
//! A pad that brakes is held against its motion, wherever the wall is. While it slides along the surface the brake cannot hold
//! it off the wall, and what it gives is drag. The way from the point is a direction that needs neither speed nor time: a pad
//! that stands still keeps it, noise of the place within the play does not change it. Source: docs/physics.md §6.
//!
//! | signal | format | unit | overflow |
//! | ȳ, a | x̄'s | mm | cannot: a mean |
//! | n, t | one bit more | mm | cannot |

use super::rule::{filtered, number};
use super::{In, Kept, Registers, Regs, Wall};
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Proved, Saturate, Signal, zero};

impl Wall {
    /// The way from the point that follows, before it does.
    #[inline(always)]
    pub(super) fn moved<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let way = |way: Signal<V>| way.resize(self.motion(), Proved);
        let normal = way(r.kept.anchor - r.kept.filtered);
        let tangential = way(r.kept.along - r.kept.anchor_along);
        let turns = turns(&r.kept, &i);
        Registers {
            normal: turns.select(zero(normal.format), normal),
            tangential: turns.select(self.play(1.0), tangential),
            ..r
        }
    }

    /// The point follows.
    #[inline(always)]
    pub(super) fn led<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let play = self.play::<V>(1.0);
        let is_far = play.less_than(r.normal.abs()) | play.less_than(r.tangential.abs());
        let follow = |anchor: Signal<V>, place: Signal<V>| {
            is_far.select(filtered(anchor, place, 2, anchor.format), anchor)
        };
        let (turns, k) = (turns(&r.kept, &i), r.kept);
        let behind = (k.along - play).resize(k.along.format, Saturate);
        let kept = Kept {
            anchor: turns.select(k.filtered, follow(k.anchor, k.filtered)),
            anchor_along: turns.select(behind, follow(k.anchor_along, k.along)),
            other_free: i.other_free,
            ..k
        };
        Registers { kept, ..r }
    }

    /// Whether the way is along the surface.
    #[inline(always)]
    pub(super) fn judged<V: Interpretation>(&self, r: Regs<V>, i: In<V>) -> Regs<V> {
        let (least, normal) = (self.play::<V>(0.5), r.normal.scaled(1));
        let turned = i.other_free | r.kept.turned;
        let tangential = r.tangential.abs();
        let wide = Format::unsigned(tangential.format.width + 2, tangential.format.frac);
        let [far, near] = [tangential.scaled(2), tangential].map(|way| way.resize(wide, Proved));
        let tangential = turned.select(far, near);
        let slides = normal.less_than(tangential) & least.less_than(tangential);
        Registers { slides, kept: Kept { turned: turned & slides, ..r.kept }, ..r }
    }

    /// A share of the play.
    #[inline(always)]
    fn play<V: Interpretation>(&self, share: f64) -> Signal<V> {
        number(share * 1e-3 * self.rule.play_um as f64, self.motion())
    }
}

/// The user has begun to leave the other wall.
#[inline(always)]
fn turns<V: Interpretation>(k: &Kept<Signal<V>>, i: &In<V>) -> Signal<V> {
    i.other_free & !k.other_free
}
