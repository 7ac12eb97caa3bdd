// SPDX-License-Identifier: MIT OR Apache-2.0
//! The graph of small blocks: which operation drives each output, what is shared, what constants
//! settle.

mod parts;

use super::*;
use crate::signal::{Exact, Floor, HalfEven, Proved, Saturate, bit, code};

mod operations {
    use super::*;

    crate::block! {
        /// Every operation of the language.
        pub struct Operations("operations") {}
        submodules {}
        inputs(block) {
            a: Format::signed(4, 1),
            gone: Format::NONE,
            b: Format::unsigned(3, 0),
            /// A bit.
            bit: BIT,
            other: BIT,
        }
        outputs(block) {
            sum: Format::signed(6, 1),
            difference: Format::signed(6, 1),
            product: Format::signed(7, 1),
            square: Format::unsigned(7, 2),
            magnitude: Format::unsigned(4, 1),
            quantized: Format::signed(3, 0),
            unchanged: Format::signed(4, 1),
            moved: Format::signed(4, -1),
            cut: Format::unsigned(2, 0),
            joined: Format::unsigned(6, 0),
            less: BIT,
            equal: BIT,
            both: BIT,
            either: BIT,
            inverse: BIT,
            choice: Format::signed(5, 1),
            constant: Format::signed(4, 1),
            absent: Format::NONE,
            none: BIT,
        }
        registers(block) {}
    }

    impl Block for Operations {
        fn clock<V: Interpretation>(&self, _state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            Outputs {
                sum: i.a + i.b,
                difference: i.a - i.b,
                product: i.a * i.b,
                square: i.a.square(),
                magnitude: i.a.abs(),
                quantized: i.a.quantize(Format::signed(3, 0), HalfEven, Saturate),
                unchanged: i.a.quantize(i.a.format, Floor, Saturate),
                moved: i.a.scaled(2),
                cut: i.a.bits(1, 2),
                joined: i.b.concat(i.b),
                less: i.a.less_than(i.b),
                equal: i.a.equals(i.b),
                both: i.bit & i.other,
                either: i.bit | i.other,
                inverse: !i.bit,
                choice: i.bit.select(i.a, i.b),
                constant: crate::signal::constant(-1.25, Format::signed(4, 1)),
                absent: i.bit.where_present(Format::NONE),
                none: i.bit,
            }
        }
    }
}

/// The operation and format that drive an output.
fn driver<'a>(module: &'a Module, output: &str) -> (&'a Op, Format) {
    let named = module.outputs.iter().find(|named| named.name == output).expect("an output");
    let wire = &module.wires[named.node.0 as usize];
    (&wire.op, wire.format)
}

fn input(module: &Module, name: &str) -> Node {
    module.inputs.iter().find(|named| named.name == name).expect("an input").node
}

#[test]
fn every_operation_is_a_wire_of_its_format() {
    let netlist = Netlist::of(&operations::Operations {});
    let module = netlist.top();
    let [a, b, bit, other] = ["a", "b", "bit", "other"].map(|name| input(module, name));
    let is = |output, op: Op, format: &str| {
        let format: Format = format.parse().expect("a format");
        assert_eq!(driver(module, output), (&op, format), "{output}");
    };
    is("sum", Op::Add(a, b), "s6.1");
    is("difference", Op::Sub(a, b), "s6.1");
    is("product", Op::Mul(a, b), "s7.1");
    is("square", Op::Mul(a, a), "u7.2");
    is("magnitude", Op::Abs(a), "u4.1");
    is("quantized", Op::Fit(a, HalfEven, Saturate), "s3.0");
    is("unchanged", Op::Input(0), "s4.1");
    is("moved", Op::Scale(a), "s4.-1");
    is("cut", Op::Bits(a, 1), "u2.0");
    is("joined", Op::Concat(b, b), "u6.0");
    is("less", Op::Less(a, b), "u1.0");
    is("equal", Op::Equal(a, b), "u1.0");
    is("both", Op::And(bit, other), "u1.0");
    is("either", Op::Or(bit, other), "u1.0");
    is("inverse", Op::Not(bit), "u1.0");
    is("choice", Op::Select(bit, a, b), "s5.1");
    is("constant", Op::Constant(-2), "s4.1");
    is("none", Op::Input(2), "u1.0");
    assert!(module.outputs.iter().all(|named| named.name != "absent"));
    let inputs: Vec<_> = module.inputs.iter().map(|named| (named.name, named.about)).collect();
    assert_eq!(inputs, [("a", ""), ("b", ""), ("bit", "A bit."), ("other", "")]);
    assert_eq!((module.name, module.resets, module.held.clone()), ("operations", true, None));
    assert!(module.path.ends_with("operations::Operations"));
}

/// Reads a module of one input bit and no other part, and gives what `act` makes of the bit.
fn with_bit<T>(act: impl FnOnce(Signal<Node>) -> T) -> T {
    READER.with_borrow_mut(|reader| *reader = Reader::default());
    READER.with_borrow_mut(|reader| reader.open.push(Open::default()));
    act(Signal { value: wire(Op::Input(0), BIT), format: BIT })
}

#[test]
fn constants_settle_bits() {
    with_bit(|a| {
        let [no, yes] = [false, true].map(bit::<Node>);
        let node = |of: Signal<Node>| of.value;
        assert_eq!([a & yes, yes & a, a | no, no | a].map(node), [a.value; 4]);
        assert_eq!([a & no, no & a, no & yes, yes & no, no & no, no | no].map(node), [no.value; 6]);
        assert_eq!(
            [a | yes, yes | a, no | yes, yes | no, yes | yes, yes & yes].map(node),
            [yes.value; 6]
        );
        assert_eq!(
            (settled(yes.value), settled(no.value), settled(a.value)),
            (Some(1), Some(0), None)
        );
    });
}

/// Two settled bits are one bit, of a word of three bits an order that its format decides is none.
#[test]
fn formats_and_constants_settle_orders() {
    with_bit(|a| {
        let [no, yes] = [false, true].map(|code| bit::<Node>(code).value);
        assert_eq!([!bit::<Node>(true), !bit::<Node>(false)].map(|bit| bit.value), [no, yes]);
        let word = a.concat(a).concat(a);
        let number = |real, format: Format| crate::signal::constant::<Node>(real, format);
        let (whole, halves) = (Format::signed(6, 0), Format::signed(6, 1));
        let order = |a: Signal<Node>, b: Signal<Node>| settled(a.less_than(b).value);
        assert_eq!(order(word, number(0.0, whole)), Some(0));
        assert_eq!(order(word, number(0.5, halves)), None);
        assert_eq!(order(word, number(7.0, halves)), None);
        assert_eq!(order(word, number(7.5, halves)), Some(1));
        assert_eq!(order(number(7.0, whole), word), Some(0));
        assert_eq!(order(number(6.5, halves), word), None);
        assert_eq!(order(number(-0.5, halves), word), Some(1));
        assert_eq!(order(number(0.0, whole), word), None);
        assert_eq!(order(number(1.0, whole), number(1.5, halves)), Some(1));
    });
}

#[test]
fn constants_and_equal_alternatives_settle_choices() {
    with_bit(|bit_signal| {
        let [a, b] = [3, 1].map(|value| code::<Node>(value, Format::unsigned(2, 0)));
        let op = |of: Signal<Node>| {
            with_module(|open| open.module.wires[of.value.0 as usize].op.clone())
        };
        assert_eq!(
            (bit(true).select(a, b).value, bit(false).select(a, b).value),
            (a.value, b.value)
        );
        assert_eq!(bit_signal.select(a, a).value, a.value);
        assert_eq!(op(bit_signal.select(a, b)), Op::Select(bit_signal.value, a.value, b.value));
        let wide = code::<Node>(1, Format::signed(4, 1));
        assert_eq!(op(bit(false).select(wide, b)), Op::Fit(b.value, Exact, Proved));
        assert_eq!(bit(false).select(wide, b).format, Format::signed(4, 1));
        let finer = Signal { format: Format::unsigned(2, 1), ..a };
        assert_eq!(op(bit_signal.select(a, finer)), Op::Select(bit_signal.value, a.value, a.value));
        let nothing = code::<Node>(0, Format::NONE);
        assert_eq!(bit_signal.select(nothing, nothing).value, nothing.value);
    });
}

#[test]
fn equal_operations_share_a_wire() {
    with_bit(|a| {
        assert_eq!(((a + a).value, (!a).value), ((a + a).value, (!a).value));
        assert_ne!((a + a).value, (a - a).value);
        let count = with_module(|open| open.module.wires.len());
        assert_eq!((a - a).value, Node(count as u32 - 1), "it was the last");
        assert_eq!(with_module(|open| open.module.wires.len()), count);
    });
}

#[test]
fn a_wire_keeps_its_first_name_and_knows_no_bit() {
    with_bit(|a| {
        let named = a.named("first").named("second");
        assert_eq!(named.value, a.value);
        assert_eq!(with_module(|open| open.module.wires[a.value.0 as usize].name), Some("first"));
        assert!(!crate::signal::is_known(&a) && !a.can_skip());
    });
}

#[test]
#[should_panic(expected = "a wire has no code before the circuit runs")]
fn a_wire_has_no_code() {
    with_bit(<Node as Value>::code);
}

#[test]
#[should_panic(expected = "s64.0 is wider than 63 bits")]
fn a_wire_is_no_wider_than_a_code() {
    with_bit(|_| {
        let wide = code::<Node>(0, Format::signed(63, 0));
        wide + wide
    });
}
