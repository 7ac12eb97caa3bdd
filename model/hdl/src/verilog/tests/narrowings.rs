// SPDX-License-Identifier: MIT OR Apache-2.0
//! Changes of format: each combination of signs and widths that is printed in its own way.

use crate::block::{Block, Interpretation, State};
use crate::format::Format;
use crate::signal::{Floor, HalfEven, Proved, Saturate, Signal, Wrap};

crate::block! {
    /// Every narrowing.
    pub struct Narrowings("narrowings") {}
    submodules {}
    inputs(block) {
        s: Format::signed(8, 4),
        u: Format::unsigned(8, 4),
        one: Format::signed(2, 3),
    }
    outputs(block) {
        even_1: Format::signed(5, 3),
        even_2: Format::signed(5, 2),
        even_4: Format::signed(5, 0),
        even_unsigned: Format::unsigned(3, 2),
        even_to_signed: Format::signed(3, 2),
        even_to_unsigned: Format::unsigned(3, 2),
        even_proved: Format::signed(6, 2),
        even_wrapped: Format::signed(4, 2),
        even_bit: Format::unsigned(1, 2),
        even_wide: Format::signed(9, 2),
        even_wide_unsigned: Format::unsigned(9, 2),
        even_unsigned_same: Format::unsigned(7, 2),
        even_of_less: Format::signed(4, 0),
        floor: Format::signed(6, 2),
        floor_wrapped: Format::unsigned(3, 2),
        floor_saturated: Format::signed(3, 2),
        floor_wide: Format::signed(9, 2),
        floor_of_less: Format::signed(2, 0),
        saturated: Format::signed(5, 4),
        saturated_bit: Format::signed(1, 4),
        saturated_unsigned: Format::unsigned(5, 4),
        saturated_same: Format::signed(8, 4),
        saturated_wide: Format::signed(10, 4),
        positive: Format::unsigned(5, 4),
        positive_same: Format::unsigned(7, 4),
        positive_wide: Format::unsigned(9, 4),
        to_signed: Format::signed(5, 4),
        to_signed_wide: Format::signed(10, 4),
        shifted: Format::signed(6, 6),
        shifted_wide: Format::signed(12, 6),
        shifted_wrapped: Format::signed(6, 6),
        shifted_off: Format::unsigned(2, 6),
        shifted_proved: Format::signed(10, 6),
        low: Format::unsigned(4, 4),
        extended: Format::signed(11, 5),
        extended_unsigned: Format::unsigned(11, 5),
    }
    registers(block) {}
}

impl Block for Narrowings {
    fn clock<V: Interpretation>(&self, _state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let to = self.outputs();
        let even = |of: Signal<V>, to| of.quantize(to, HalfEven, Saturate);
        let wrapped = |of: Signal<V>, to| of.resize(to, Wrap);
        let saturated = |of: Signal<V>, to| of.resize(to, Saturate);
        Outputs {
            even_1: even(i.s, to.even_1),
            even_2: even(i.s, to.even_2),
            even_4: even(i.s, to.even_4),
            even_unsigned: even(i.u, to.even_unsigned),
            even_to_signed: even(i.u, to.even_to_signed),
            even_to_unsigned: even(i.s, to.even_to_unsigned),
            even_proved: i.s.quantize(to.even_proved, HalfEven, Proved),
            even_wrapped: i.s.quantize(to.even_wrapped, HalfEven, Wrap),
            even_bit: i.u.quantize(to.even_bit, HalfEven, Wrap),
            even_wide: i.s.quantize(to.even_wide, HalfEven, Wrap),
            even_wide_unsigned: even(i.u, to.even_wide_unsigned),
            even_unsigned_same: even(i.u, to.even_unsigned_same),
            even_of_less: even(i.one, to.even_of_less),
            floor: i.s.quantize(to.floor, Floor, Proved),
            floor_wrapped: i.s.quantize(to.floor_wrapped, Floor, Wrap),
            floor_saturated: i.s.quantize(to.floor_saturated, Floor, Saturate),
            floor_wide: i.s.quantize(to.floor_wide, Floor, Proved),
            floor_of_less: i.one.quantize(to.floor_of_less, Floor, Proved),
            saturated: saturated(i.s, to.saturated),
            saturated_bit: saturated(i.s, to.saturated_bit),
            saturated_unsigned: saturated(i.u, to.saturated_unsigned),
            saturated_same: saturated(i.u, to.saturated_same),
            saturated_wide: saturated(i.s, to.saturated_wide),
            positive: saturated(i.s, to.positive),
            positive_same: saturated(i.s, to.positive_same),
            positive_wide: saturated(i.s, to.positive_wide),
            to_signed: saturated(i.u, to.to_signed),
            to_signed_wide: saturated(i.u, to.to_signed_wide),
            shifted: saturated(i.s, to.shifted),
            shifted_wide: saturated(i.s, to.shifted_wide),
            shifted_wrapped: wrapped(i.s, to.shifted_wrapped),
            shifted_off: wrapped(i.s, to.shifted_off),
            shifted_proved: i.s.resize(to.shifted_proved, Proved),
            low: wrapped(i.s, to.low),
            extended: i.s.resize(to.extended, Proved),
            extended_unsigned: i.u.resize(to.extended_unsigned, Proved),
        }
    }
}
