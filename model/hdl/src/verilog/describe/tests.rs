// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names of every operation, spelled out and by kind.

use super::{hashes, name};
use crate::block::{Block, Interpretation, State};
use crate::format::{BIT, Format};
use crate::interpretations::netlist::Netlist;
use crate::memory::Memory;
use crate::signal::{HalfEven, Saturate, code, int};

crate::block! {
    /// An output of each operation, of short names and of a long one.
    struct Described("described") {}
    submodules { m: Memory }
    inputs(block) {
        a: Format::signed(3, 1),
        b: Format::unsigned(3, 1),
        p: BIT,
        q: BIT,
        a_name_of_many_letters: Format::signed(3, 1),
    }
    outputs(block) {
        sum: Format::signed(5, 1),
        difference: Format::signed(5, 1),
        product: Format::signed(6, 2),
        less: BIT,
        equal: BIT,
        is_zero: BIT,
        and: BIT,
        or: BIT,
        not: BIT,
        joined: Format::unsigned(4, 0),
        magnitude: Format::unsigned(3, 1),
        narrowed: Format::signed(2, 0),
        bits: Format::unsigned(2, 0),
        moved: BIT,
        of_memory: BIT,
        of_digit: Format::signed(4, 0),
        of_negative: Format::signed(4, 1),
        long_sum: Format::signed(5, 1),
        long_difference: Format::signed(5, 1),
        long_product: Format::signed(6, 2),
        long_less: BIT,
        long_equal: BIT,
        long_joined: Format::unsigned(6, 0),
        long_magnitude: Format::unsigned(3, 1),
        long_narrowed: Format::signed(2, 0),
        long_bits: Format::unsigned(2, 0),
        long_choice: Format::signed(4, 1),
        long_and: BIT,
    }
    registers(block) {}
}

impl Block for Described {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        self.m.read(&mut state.submodules.m, i.p);
        let word = self.m.data::<V>(&mut state.submodules.m);
        let (long, narrow) = (i.a_name_of_many_letters, Format::signed(2, 0));
        Outputs {
            sum: i.a + i.b,
            difference: i.a - i.b,
            product: i.a * i.b,
            less: i.a.less_than(i.b),
            equal: i.a.equals(i.b),
            is_zero: i.b.is(0),
            and: i.p & i.q,
            or: i.p | i.q,
            not: !i.p,
            joined: i.b.concat(i.p),
            magnitude: i.a.abs(),
            narrowed: i.a.quantize(narrow, HalfEven, Saturate),
            bits: i.b.bits(1, 2),
            moved: i.b.scaled(1).less_than(i.a),
            of_memory: word & i.p,
            of_digit: int(3) - i.p,
            of_negative: i.p + code(-1, Format::signed(2, 1)),
            long_sum: long + i.b,
            long_difference: long - i.b,
            long_product: long * i.b,
            long_less: long.less_than(i.b),
            long_equal: long.equals(i.b),
            long_joined: i.b.concat(long.bits(0, 3)),
            long_magnitude: long.abs(),
            long_narrowed: long.quantize(narrow, HalfEven, Saturate),
            long_bits: long.bits(1, 2),
            long_choice: i.p.select(long, i.b),
            long_and: i.p & long.msb(),
        }
    }
}

#[test]
fn short_operations_are_spelled_and_long_ones_have_their_kind() {
    let netlist = Netlist::of(&Described { m: Memory::new("m", 2, BIT) });
    let (module, hashes) = (netlist.top(), hashes(netlist.top()));
    let names = module.outputs.iter().map(|output| {
        let name = name(module, &hashes, output.node);
        let kind = name.split('_').next().expect("a word").to_string();
        if output.name.starts_with("long_") { kind } else { name }
    });
    let spelled = "a_plus_b a_minus_b a_times_b a_below_b a_is_b b_is_0 p_and_q p_or_q not_p b_beside_p \
        magnitude_of_a a_to_2 b_from_1 b_below_a m_word_and_p quantized_3_minus_p_to_4 p_plus_minus_1";
    let kinds = "sum difference product less equal joined magnitude quantized bits choice bit";
    assert_eq!(names.collect::<Vec<_>>().join(" "), format!("{spelled} {kinds}"));
}
