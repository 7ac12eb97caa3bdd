// SPDX-License-Identifier: MIT OR Apache-2.0
//! Forces with a table: those of the rounded reference, whatever words, pads and voltages follow one
//! another; the clocks they take.

use super::{ForceTable, Inputs, Table, TablePort};
use crate::support::device::calibration;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, cases, check, check_latency_of, check_rest, operations};
use hapticore_contract::calibration::PastVoltage;
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::{BIT, Format};
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::{bit, constant, zero};
use hapticore_reference::rounded::{self, Exact};
use std::cell::RefCell;

/// Tables that follow one another.
const TABLES: u64 = 40;

/// Every bundled profile with a controller, which receives an estimate before the frame's.
fn with_prompts() -> impl Iterator<Item = Profile> {
    let control = |profile: &Profile| Some(Control::of(profile, Law::Inverse));
    Profile::all().into_iter().map(move |profile| Profile { control: control(&profile), ..profile })
}

fn bench(profile: &Profile) -> Bench<ForceTable> {
    Bench::new(ForceTable::try_new(profile).unwrap())
}

/// Writes a table and gives the reference of the same words; pads keep what they have had.
fn write(
    bench: &mut Bench<ForceTable>,
    words: &[i64],
    word: Format,
    inputs: Inputs<i64>,
) -> Vec<Exact> {
    for (address, &word) in (0..).zip(words) {
        let table = TablePort { write: 1, address, word };
        bench.clock(Inputs { start: 0, table, ..inputs });
    }
    words.iter().map(|&code| Exact::of(code, word)).collect()
}

fn quiet(i: Inputs<i64>) -> Inputs<i64> {
    Inputs { clear: 0, table: TablePort { write: 0, ..i.table }, ..i }
}

/// Words as a calibration has them, or any.
fn words(random: &mut Random, word: Format, any: bool) -> Vec<i64> {
    let usual = ForceTableWords(random);
    if any { (0..Table::WORDS).map(|_| random.word(word)).collect() } else { usual.codes(word) }
}

/// Words of a table of factors about one, of filters that settle.
struct ForceTableWords<'a>(&'a mut Random);

impl ForceTableWords<'_> {
    fn codes(self, word: Format) -> Vec<i64> {
        let random = self.0;
        let rows = std::array::from_fn(|_| {
            [random.between(0.5, 2.0), random.between(-1.0, 1.0), random.between(-3.0, 3.0)]
        });
        let (recent, mean) = (random.between(0.05, 1.0), random.between(1e-4, 0.06));
        let table = Table { rows, recent, mean, release: random.between(0.0, 0.1) };
        table.words().iter().map(|&real| word.code_saturating(real)).collect()
    }
}

#[test]
fn forces_are_those_of_the_table() {
    for (seed, profile) in (0..).zip(with_prompts()) {
        let (f, mut random) = (&profile.formats, Random::new(seed));
        let mut bench = bench(&profile);
        let reference = RefCell::new(rounded::ForceTable::of_words(&profile, vec![]));
        let mut cases = cases(&bench.block, MILLION / 10, seed).map(quiet);
        for round in 0..TABLES {
            let Some(first) = cases.next() else { break };
            let codes = words(&mut random, f.table, round % 2 == 1);
            let words = write(&mut bench, &codes, f.table, first);
            reference.borrow_mut().calibrate(words);
            if random.below(3) == 0 {
                bench.clock(Inputs { start: 0, clear: 1, ..first });
                if profile.control.is_some() {
                    reference.borrow_mut().clear();
                }
            }
            let inputs = cases.by_ref().take((operations(MILLION / 10) / TABLES) as usize);
            // Half of the capacitances within the table, and its ends.
            let within = |mut i: Inputs<i64>| {
                let row = Exact::new(i128::from(random.below(11)), 6) + Exact::new(320, 0);
                let at = row.real()
                    + [0.0, f.capacitance.lsb(), -f.capacitance.lsb(), 31.7]
                        [random.below(4) as usize];
                if random.below(2) == 0 {
                    i.capacitance = f.capacitance.code_saturating(at);
                }
                if random.below(8) == 0 {
                    i.mean_square = 0;
                }
                i
            };
            let inputs: Vec<_> = inputs.map(within).collect();
            check(&mut bench, inputs.into_iter(), |i| {
                let numbers = [
                    Exact::of(i.capacitance, f.capacitance),
                    Exact::of(i.mean_square, f.mean_square),
                    Exact::of(i.gain, f.force_gain),
                ];
                let pad = (i.pad as u64 % profile.pads) as usize;
                let mut reference = reference.borrow_mut();
                let expected = if i.hold == 1 {
                    reference.prompt(&profile, pad, numbers)
                } else {
                    reference.force(&profile, pad, numbers)
                };
                [
                    ("haptic_force", expected.force.code(f.force)),
                    ("factored_gain", expected.gain.code(f.force_gain)),
                    ("saturated", expected.saturated.into()),
                ]
            });
        }
        bench.check_registers();
    }
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let block = ForceTable::try_new(&profile).unwrap();
        check_latency_of(block.clone(), block.latency(), quiet);
    }
}

/// A constant factor of one is eq. 8, to the bit; but for a voltage of full scale, which its word
/// does not hold.
#[test]
fn a_flat_table_is_eq_8() {
    for (seed, profile) in (0..).zip(Profile::all()) {
        let f = &profile.formats;
        let mut bench = bench(&profile);
        let flat = Table::default().words().map(|real| f.table.code_saturating(real));
        let mut cases = cases(&bench.block, MILLION / 100, seed).map(quiet);
        let first = cases.next().expect("a case");
        write(&mut bench, &flat, f.table, first);
        check(&mut bench, cases, |i| {
            let [capacitance, mean_square, gain] = [
                Exact::of(i.capacitance, f.capacitance),
                Exact::of(i.mean_square, f.mean_square),
                Exact::of(i.gain, f.force_gain),
            ];
            let expected = rounded::force(&profile, [capacitance, mean_square, gain]);
            let full = mean_square.real().sqrt() >= 1.0 - profile.force.voltage.lsb() / 2.0;
            [
                ("haptic_force", expected.force.code(f.force)),
                ("factored_gain", i.gain),
                ("saturated", (expected.saturated | full).into()),
            ]
        });
    }
}

#[test]
fn a_root_of_too_many_digits_is_refused() {
    let mut profile = Profile::bundled("standard").expect("bundled");
    profile.formats.mean_square = Format::unsigned(63, 63);
    let refused = ForceTable::try_new(&profile).expect_err("64 digits").to_string();
    assert!(refused.contains("the radicand of its root"), "{refused}");
    // Two digits for each bit of the root; a bit before the point makes one more.
    for (mean_square, is_refused) in [("u62.62", false), ("u63.62", true), ("u62.60", false)] {
        profile.formats.mean_square = mean_square.parse().expect("a format");
        let refused = ForceTable::try_new(&profile).err().map(|error| error.to_string());
        let by_root = refused.is_some_and(|refused| refused.contains("the radicand of its root"));
        assert_eq!(by_root, is_refused, "{mean_square}");
    }
}

/// Three words of a row, sixteen times their fraction at most: one is added as it is, one times a voltage, and one
/// times a difference of two. Rows to the last, and no twice as many.
#[test]
fn sums_and_rows_have_the_range_of_the_table() {
    for profile in Profile::of_distinct_words() {
        let block = ForceTable::try_new(&profile).unwrap();
        let most = profile.force.voltage.real(profile.force.voltage.max_code() as i64);
        let sum = 16.0 * (1.0 + 2.0 * most);
        let range = block.sum();
        assert!(range.real(range.max_code() as i64) >= sum, "{range}: {sum}");
        let last = Table::STEP_PF * (Table::ROWS - 1) as f64;
        let offset = block.offset();
        let reach = offset.real(offset.max_code() as i64);
        assert!((last..2.0 * last).contains(&reach), "{offset}: {last} pF");
    }
}

/// A force without rounding is that of the table in floating point.
#[test]
fn numbers_that_are_not_rounded_have_the_force_of_the_table() {
    for profile in Profile::of_distinct_words() {
        let (f, table) = (&profile.formats, calibration(&profile).force_table);
        let mut bench = Bench::<_, Shadow>::read(ForceTable::try_new(&profile).unwrap());
        for (address, word) in table.words().into_iter().enumerate() {
            bench.block.set_word(&mut bench.state, address, constant(word, f.table));
        }
        let formats = bench.block.inputs();
        let number = |real: f64, format: Format| constant::<Shadow>(real, format);
        let (mut past, pad) = (PastVoltage::default(), number(0.0, formats.pad));
        for (capacitance, mean_square) in [(401.234_567, 0.123_456_7), (777.765_432, 0.345_678_9)] {
            let quiet = Inputs {
                start: bit(false),
                clear: number(0.0, formats.clear),
                hold: number(0.0, formats.hold),
                pad,
                capacitance: number(capacitance, formats.capacitance),
                mean_square: number(mean_square, formats.mean_square),
                gain: number(2e-6, formats.gain),
                table: TablePort::map(formats.table, zero),
            };
            bench.block.clock(&mut bench.state, Inputs { start: number(1.0, BIT), ..quiet });
            for _ in 0..bench.block.latency() {
                bench.block.clock(&mut bench.state, quiet);
            }
            past.follow(&table, mean_square.sqrt());
            let eq8 = 2e-6 * capacitance * capacitance * mean_square;
            let expected = eq8 * table.factor(capacitance, past);
            let got = bench.state.registers.haptic_force.real;
            assert!((got / expected - 1.0).abs() < 1e-9, "{}: {got}, {expected}", profile.name);
        }
    }
}

#[test]
fn without_a_start_there_is_no_force() {
    for profile in with_prompts() {
        check_rest(bench(&profile).block, &["start", "write"]);
    }
}
