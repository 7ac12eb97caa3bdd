// SPDX-License-Identifier: MIT OR Apache-2.0
//! Changes of format: rounding, then overflow.

use super::scope::{Id, Scope};
use super::text::{Kind, Text};
use crate::format::Format;
use crate::interpretations::netlist::Node;
use crate::signal::{Overflow, Rounding};

impl Scope<'_> {
    /// The text of a wire in another format.
    pub fn fit(&mut self, node: Node, a: Node, rounding: Rounding, overflow: Overflow) -> Text {
        let (from, to) = (self.format(a), self.format(node));
        let drop = i32::from(from.frac) - i32::from(to.frac);
        if drop > 0 {
            return self.narrowed(a, (drop as u8, rounding), to, overflow);
        }
        let shift = -drop as u8;
        if overflow == Overflow::Saturate {
            let width = from.width + shift;
            let text = self.extended(a, width, to.frac);
            let id = if shift == 0 {
                self.id(a)
            } else {
                self.declare("shifted", width, from.signed, &text, "")
            };
            self.held(id, to)
        } else if from.width + shift <= to.width {
            self.extended(a, to.width, to.frac)
        } else {
            self.low_bits(a, to.width, shift)
        }
    }

    /// The low bits of a code moved up.
    fn low_bits(&mut self, a: Node, width: u8, shift: u8) -> Text {
        if shift >= width {
            return Text::atom(format!("{width}'d0"));
        }
        let id = self.id(a);
        let low = self.slice(id, width - shift - 1, 0);
        Text::atom(if shift == 0 { low } else { format!("{{{low}, {shift}'d0}}") })
    }

    /// Without the `drop` low bits.
    fn narrowed(
        &mut self,
        a: Node,
        (drop, rounding): (u8, Rounding),
        to: Format,
        overflow: Overflow,
    ) -> Text {
        let id = self.id(a);
        let id = self.at_least(id, drop + 1);
        let (kept, signed) = (self.width(id) - drop, self.signed(id));
        // A carry may need one bit more; bits beyond the new format matter to saturation only.
        let exact = kept + u8::from(rounding == Rounding::HalfEven);
        let width = if overflow == Overflow::Saturate { exact } else { exact.min(to.width) };
        let floor = self.floor(id, drop, width);
        let text = match rounding {
            Rounding::HalfEven => {
                Text::operation(format!("{floor} + {}", self.round_up(id, drop, width)))
            }
            _ => Text::atom(floor),
        };
        if overflow != Overflow::Saturate && width == to.width {
            return text;
        }
        let rounded = self.declare("rounded", width, signed, &text, "");
        if overflow == Overflow::Saturate {
            self.held(rounded, to)
        } else {
            self.stretched(rounded, to.width)
        }
    }

    /// `width` bits above the dropped ones, with at most one bit of sign in front.
    fn floor(&mut self, id: Id, drop: u8, width: u8) -> String {
        let top = self.width(id) - 1;
        if drop + width - 1 <= top {
            return self.slice(id, drop + width - 1, drop);
        }
        let kept = self.slice(id, top, drop);
        let sign = if self.signed(id) { self.slice(id, top, top) } else { "1'b0".into() };
        format!("{{{sign}, {kept}}}")
    }

    /// One where the dropped part is over a half, or is a half and the kept part is odd.
    fn round_up(&mut self, id: Id, drop: u8, width: u8) -> String {
        let (half, odd) = (self.slice(id, drop - 1, drop - 1), self.slice(id, drop, drop));
        let above = match drop {
            1 => odd,
            2 => format!("({odd} | {})", self.slice(id, 0, 0)),
            _ => format!("({odd} | (|{}))", self.slice(id, drop - 2, 0)),
        };
        if width == 1 {
            format!("({half} & {above})")
        } else {
            format!("{{{}'d0, {half} & {above}}}", width - 1)
        }
    }

    /// With its sign in front.
    fn stretched(&mut self, id: Id, width: u8) -> Text {
        let wide = self.at_least(id, width);
        Text::atom(self.slice(wide, width - 1, 0))
    }

    /// Held at full scale of a format with the same point.
    fn held(&mut self, id: Id, to: Format) -> Text {
        let (width, signed) = (self.width(id), self.signed(id));
        match (signed, to.signed) {
            (true, true) if width > to.width => self.held_signed(id, to.width),
            (false, true) if width >= to.width => self.held_unsigned(id, to.width - 1, true),
            (false, false) if width > to.width => self.held_unsigned(id, to.width, false),
            (true, false) => self.held_positive(id, to.width),
            _ => self.stretched(id, to.width),
        }
    }

    fn held_signed(&mut self, id: Id, width: u8) -> Text {
        let top = self.width(id) - 1;
        let (sign, above, low) = (
            self.slice(id, top, top),
            self.slice(id, top, width - 1),
            self.slice(id, width - 1, 0),
        );
        let fits = format!("({above} == {{{}{{{sign}}}}})", top + 2 - width);
        let limit =
            if width == 1 { sign } else { format!("{{{sign}, {{{}{{~{sign}}}}}}}", width - 1) };
        Text { text: format!("{fits} ? {low} : {limit}"), kind: Kind::Select }
    }

    /// Bits of an unsigned code; all ones where any above is set. With a zero in front for a signed
    /// format.
    fn held_unsigned(&mut self, id: Id, width: u8, signed: bool) -> Text {
        let top = self.width(id) - 1;
        let (above, low) = (self.slice(id, top, width), self.slice(id, width - 1, 0));
        let limit = format!("{{{width}{{1'b1}}}}");
        let text = match signed {
            true => format!("(|{above}) ? {{1'b0, {limit}}} : {{1'b0, {low}}}"),
            false => format!("(|{above}) ? {limit} : {low}"),
        };
        Text { text, kind: Kind::Select }
    }

    /// A signed code as an unsigned one: zero where it is negative.
    fn held_positive(&mut self, id: Id, width: u8) -> Text {
        let top = self.width(id) - 1;
        let sign = self.slice(id, top, top);
        let zero = format!("{sign} ? {width}'d0");
        let text = if top > width {
            let (above, low) = (self.slice(id, top - 1, width), self.slice(id, width - 1, 0));
            format!("{zero} : (|{above}) ? {{{width}{{1'b1}}}} : {low}")
        } else if top == width {
            format!("{zero} : {}", self.slice(id, width - 1, 0))
        } else {
            format!("{zero} : {{{}'d0, {}}}", width - top, self.slice(id, top - 1, 0))
        };
        Text { text, kind: Kind::Select }
    }
}
