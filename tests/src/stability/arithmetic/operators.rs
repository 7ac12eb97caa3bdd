// SPDX-License-Identifier: MIT OR Apache-2.0
//! Narrowing, products, quotients and square roots of operands that break circuits.

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{HalfEven, Saturate, Signal, bit, code};
use hapticore_model::blocks::divider::{self, Divider};
use hapticore_model::blocks::sqrt::{self, SquareRoot};
use hapticore_reference::rounded::{Exact, round, round_quotient, round_sqrt};

use crate::stability::Outcome;
use crate::stability::bench::PROFILES;

/// Every tie, either sign.
pub fn rounding_ties() -> Outcome {
    let wide = Format::signed(12, 8);
    let codes = || wide.min_code() as i64..=wide.max_code() as i64;
    let (mut compared, mut worst, mut floor) = (0, 0f64, 0f64);
    for dropped in 1..=8i8 {
        let narrow = Format::signed(12, 8 - dropped);
        let mut sums = [0.0; 2];
        for of in codes() {
            let exact = Exact::of(of, wide);
            let rounded: Signal<i64> = code::<i64>(of, wide).quantize(narrow, HalfEven, Saturate);
            assert_eq!(
                rounded.value,
                round(exact, narrow).value.code(narrow),
                "{of} of {wide} as {narrow}"
            );
            let (real, lsb) = (wide.real(of), narrow.lsb());
            sums[0] += narrow.real(rounded.value) / lsb - real / lsb;
            sums[1] += (real / lsb).floor() - real / lsb;
            compared += 1;
        }
        let count = codes().count() as f64;
        worst = worst.max((sums[0] / count).abs());
        floor = floor.min(sums[1] / count);
    }
    Outcome::default()
        .equal(compared)
        .at_most("mean error", worst, 1e-12, "LSB")
        .rivals(format!("rounding down (SUServo, PyRPL): mean error {floor:.3} LSB"))
}

/// Codes of few ones, few zeros and runs, and neighbours of powers of two: of unsigned `width` bits.
fn patterns(width: u8) -> Vec<i64> {
    let most = (1i64 << width) - 1;
    let mut codes = vec![0, 1, most, most - 1, most >> 1, (most >> 1) + 1];
    for high in 0..width {
        let one = 1i64 << high;
        codes.extend([one, one - 1, one + 1, most - one, most & !(one - 1)]);
        // Two ones, two zeros, and a run of ones between two bits.
        for low in (0..high).step_by(3) {
            codes.extend([one | 1 << low, most - (one | 1 << low), one - (1 << low)]);
        }
    }
    codes.retain(|code| (0..=most).contains(code));
    codes.sort_unstable();
    codes.dedup();
    codes
}

/// Products, quotients and square roots of patterns.
pub fn operand_patterns() -> Outcome {
    let wide = Format::signed(24, 22);
    let signed: Vec<i64> =
        patterns(23).into_iter().flat_map(|code| [code, -code, -code - 1]).collect();
    let narrow = Format::signed(24, 22);
    let mut compared = 0;
    for (n, &a) in signed.iter().enumerate() {
        for &b in signed.iter().skip(n % 11).step_by(11) {
            let product: Signal<i64> = code::<i64>(a, wide) * code::<i64>(b, wide);
            let exact = round(Exact::of(a, wide) * Exact::of(b, wide), narrow);
            let rounded: Signal<i64> = product.quantize(narrow, HalfEven, Saturate);
            assert_eq!(rounded.value, exact.value.code(narrow), "{a} × {b}");
            compared += 1;
        }
    }
    let quotient =
        Quotient::new(Format::unsigned(20, 18), Format::unsigned(18, 16), Format::unsigned(22, 20));
    let denominators = patterns(18);
    for (n, &numerator) in patterns(20).iter().enumerate() {
        for &denominator in denominators.iter().skip(n % 37).step_by(37) {
            quotient.check(numerator, denominator);
            compared += 1;
        }
    }
    for radicand in patterns(40) {
        check_sqrt(
            &SquareRoot::new(Format::unsigned(40, 36), 18),
            Format::unsigned(40, 36),
            18,
            radicand,
        );
        compared += 1;
    }
    Outcome::default().equal(compared)
}

/// A divider and its formats.
struct Quotient {
    block: Divider,
    numerator: Format,
    denominator: Format,
    quotient: Format,
}

impl Quotient {
    fn new(numerator: Format, denominator: Format, quotient: Format) -> Self {
        let block = Divider::new(numerator, denominator, quotient);
        Quotient { block, numerator, denominator, quotient }
    }

    /// Divides, and says whether the quotient saturates.
    fn check(&self, numerator: i64, denominator: i64) -> bool {
        let mut state: State<Divider, i64> = self.block.reset();
        let inputs = divider::Inputs {
            start: bit(true),
            numerator: code(numerator, self.numerator),
            denominator: code(denominator, self.denominator),
        };
        let quiet = divider::Inputs { start: bit(false), ..inputs };
        let mut given = self.block.step(&mut state, inputs);
        for _ in 0..self.block.latency() {
            given = self.block.step(&mut state, quiet);
        }
        let operands = format!("{numerator} / {denominator}");
        assert_eq!(given.done.value, 1, "{operands}: done after the latency");
        let (code, saturated) = match denominator {
            0 => (self.quotient.max_code() as i64, true),
            _ => {
                let [n, d] = [
                    Exact::of(numerator, self.numerator),
                    Exact::of(denominator, self.denominator),
                ];
                let exact = round_quotient(n, d, self.quotient);
                (exact.value.code(self.quotient), exact.held)
            }
        };
        assert_eq!(
            (given.quotient.value, given.saturated.value != 0),
            (code, saturated),
            "{operands}"
        );
        saturated
    }
}

/// Quotients that no code can hold.
pub fn quotient_overflow() -> Outcome {
    let divider =
        Quotient::new(Format::unsigned(16, 8), Format::unsigned(12, 8), Format::unsigned(14, 10));
    let (mut compared, mut saturated) = (0, 0);
    for &numerator in &patterns(16) {
        for denominator in [0, 1, 2, 3, 15, 16, 17, 255, 256, 4095] {
            saturated += u64::from(divider.check(numerator, denominator));
            compared += 1;
        }
    }
    assert!(saturated > 100, "many of them overflow");
    Outcome::of(format!("{saturated} saturate with the flag")).equal(compared)
}

/// Square roots of the largest words of all profiles.
pub fn square_roots() -> Outcome {
    let mut compared = 0;
    for name in PROFILES {
        let profile = Profile::bundled(name).expect("bundled");
        let part = profile.formats.total;
        // Of two squares, as `currents` takes it.
        let (radicand, frac) = (Format::unsigned(2 * part.width - 1, 2 * part.frac), part.frac);
        let block = SquareRoot::new(radicand, frac);
        let most = radicand.max_code() as i64;
        let largest = (most as f64).sqrt() as i64;
        let squares = [1, 2, 3, largest / 2, largest - 1, largest].map(|root| root * root);
        let near = squares.into_iter().flat_map(|square| [square - 1, square, square + 1]);
        for of in near.chain([0, most, most - 1]).filter(|of| (0..=most).contains(of)) {
            check_sqrt(&block, radicand, frac, of);
            compared += 1;
        }
    }
    Outcome::default().equal(compared)
}

fn check_sqrt(block: &SquareRoot, radicand: Format, frac: i8, of: i64) {
    let mut state: State<SquareRoot, i64> = block.reset();
    let inputs = sqrt::Inputs { start: bit(true), radicand: code(of, radicand) };
    let quiet = sqrt::Inputs { start: bit(false), ..inputs };
    let mut given = block.step(&mut state, inputs);
    for _ in 0..block.latency() {
        given = block.step(&mut state, quiet);
    }
    assert_eq!(given.done.value, 1, "√{of}: done after the latency");
    let exact = round_sqrt(Exact::of(of, radicand), frac);
    assert_eq!(given.sqrt.value, exact.code(block.sqrt()), "√{of}");
}
