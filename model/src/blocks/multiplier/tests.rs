// SPDX-License-Identifier: MIT OR Apache-2.0
//! Products: all of short words however they are halved, their clocks, and those of numbers that
//! are not rounded.

use super::{Inputs, Multiplier};
use crate::support::{Bench, within};
use hapticore_hdl::block::Block;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::{Signal, bit, is_set};

fn formats(texts: [&str; 2]) -> [Format; 2] {
    texts.map(|text| text.parse().expect("a format"))
}

fn codes(format: Format) -> impl Iterator<Item = i64> + Clone {
    (-64..128).filter(move |code| within(*code, format))
}

/// Operands follow one another clock by clock; every product comes after the latency.
#[test]
fn products_are_exact_however_operands_are_halved() {
    for texts in [["s5.0", "s4.0"], ["u5.0", "u3.0"], ["s4.0", "u5.0"], ["u6.0", "s3.0"]] {
        for hardware in 2..=7 {
            let [left, right] = formats(texts);
            let mut bench = Bench::new(Multiplier::new(left, right, hardware));
            let pairs = codes(left).flat_map(|a| codes(right).map(move |b| (a, b)));
            let latency = bench.block.latency() as usize;
            let after = std::iter::repeat_n(None, latency).chain(pairs.clone().map(Some));
            for ((left, right), product) in pairs.zip(after) {
                let out = bench.clock(Inputs { enable: 1, left, right });
                if let Some((a, b)) = product {
                    assert_eq!(out.product, a * b, "{a} × {b} of {texts:?}, {hardware} bits");
                    bench.check_registers();
                }
            }
        }
    }
}

/// An unsigned operand beside a signed one needs a bit more.
#[test]
fn an_operand_is_halved_where_it_is_wider_than_a_multiplier() {
    let clocks = |texts, hardware| {
        let [left, right] = formats(texts);
        Multiplier::new(left, right, hardware).latency()
    };
    assert_eq!([5, 4].map(|bits| clocks(["s5.0", "s3.0"], bits)), [1, 2]);
    assert_eq!([5, 4].map(|bits| clocks(["u3.0", "u5.0"], bits)), [1, 2]);
    assert_eq!([5, 4].map(|bits| clocks(["u4.0", "s3.0"], bits)), [1, 2]);
    assert_eq!([5, 4].map(|bits| clocks(["s3.0", "u4.0"], bits)), [1, 2]);
}

#[test]
fn a_step_ends_with_its_product() {
    for (hardware, at_once) in [(8, true), (4, false)] {
        let [left, right] = formats(["s5.0", "s5.0"]);
        let block = Multiplier::new(left, right, hardware);
        let ready = [false, true].map(|busy| is_set(block.ready(bit::<i64>(busy))));
        assert_eq!(ready, [at_once, true], "{hardware} bits");
    }
}

#[test]
fn what_is_not_enabled_stays() {
    for hardware in [8, 4] {
        let [left, right] = formats(["s5.0", "s5.0"]);
        let mut bench = Bench::new(Multiplier::new(left, right, hardware));
        for _ in 0..2 {
            bench.clock(Inputs { enable: 1, left: 7, right: -9 });
        }
        for _ in 0..3 {
            assert_eq!(bench.clock(Inputs { enable: 0, left: 3, right: 3 }).product, -63);
        }
    }
}

/// What halving cuts off a number is in the other half.
#[test]
fn numbers_that_are_not_rounded_have_their_product() {
    for (texts, hardware) in [(["s6.0", "s6.0"], 4), (["u5.0", "s6.0"], 5), (["s6.0", "u3.0"], 4)] {
        let [left, right] = formats(texts);
        let block = Multiplier::new(left, right, hardware);
        let of = |code: i64, off: f64, format| Signal {
            value: Shadow { code, real: code as f64 + off },
            format,
        };
        let (a, b) = (of(13, 0.3, left), of(3, -0.4, right));
        let mut state = block.reset::<Shadow>();
        for _ in 0..block.latency() {
            block.clock(&mut state, Inputs { enable: bit(true), left: a, right: b });
        }
        let Shadow { code, real } = state.registers.product;
        assert_eq!(code, 39, "{texts:?}");
        assert!((real - 13.3 * 2.6).abs() < 1e-9, "{texts:?}: {real}");
    }
}

#[test]
#[should_panic(expected = "s4.1 × s4.0 is of codes as integers")]
fn operands_are_integers() {
    let [left, right] = formats(["s4.1", "s4.0"]);
    Multiplier::new(left, right, 18);
}

#[test]
#[should_panic(expected = "s4.0 × s4.1 is of codes as integers")]
fn both_operands_are_integers() {
    let [left, right] = formats(["s4.0", "s4.1"]);
    Multiplier::new(left, right, 18);
}

/// A partial product has the bits of its halves, and no more.
#[test]
fn partial_products_are_as_wide_as_their_halves() {
    let [left, right] = formats(["s6.0", "u5.0"]);
    let r = Multiplier::new(left, right, 5).registers();
    let of = [r.high_high, r.high_low, r.low_high, r.low_low, r.product].map(|f| f.to_string());
    assert_eq!(of, ["s6.-5", "s5.-3", "u6.-2", "u5.0", "s11.0"]);
    let whole = Multiplier::new(left, right, 6).registers();
    assert_eq!(whole.high_high.to_string(), "s11.0");
}
