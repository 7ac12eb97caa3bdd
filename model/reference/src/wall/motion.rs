// SPDX-License-Identifier: MIT OR Apache-2.0
//! The direction of motion: a pad that slides along the surface is not braked.
//!
//! ```text
//! ȳ += (y − ȳ)/4;   a: a point that follows x̄, ȳ;   n, t: the way from it, inwards and along the surface;   r: the play
//! |n| > r or |t| > r      a += (x̄, ȳ − a)/4
//! |t| > 2n and |t| > r/2   gain = 0
//! ```
//!
//! Friction acts against the motion: of a pad that slides along the surface it is drag and holds it off nothing.

/// The point that follows the pad at the distance of the play, mm across the surface and along it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    anchor_mm: Option<[f64; 2]>,
    along_mm: f64,
    other_free: bool,
    /// The user has left the pad's other wall, and the pad has not gone into this one since.
    turned: bool,
}

impl Motion {
    /// Whether it does, at a filtered place across the surface, negative within the wall, and a place along it.
    ///
    /// `other_free`: the user leaves the pad's other wall. Where he begins to, the way is taken to be along this one's surface.
    pub fn slides(
        &mut self,
        [filtered_mm, along_mm]: [f64; 2],
        other_free: bool,
        play_mm: f64,
    ) -> bool {
        let anchor_mm = self.anchor_mm.get_or_insert_with(|| {
            self.along_mm = along_mm;
            [filtered_mm, along_mm]
        });
        self.along_mm += (along_mm - self.along_mm) / 4.0;
        let place_mm = [filtered_mm, self.along_mm];
        if other_free && !std::mem::replace(&mut self.other_free, other_free) {
            *anchor_mm = [filtered_mm, self.along_mm - play_mm];
        }
        let inwards = anchor_mm[0] - place_mm[0];
        let mut along = (place_mm[1] - anchor_mm[1]).abs();
        if inwards.abs().max(along) > play_mm {
            for (anchor, place) in anchor_mm.iter_mut().zip(place_mm) {
                *anchor += (place - *anchor) / 4.0;
            }
        }
        self.other_free = other_free;
        self.turned |= other_free;
        if self.turned {
            along *= 4.0;
        }
        let slides = along > 2.0 * inwards && along > play_mm / 2.0;
        self.turned &= slides;
        slides
    }
}
