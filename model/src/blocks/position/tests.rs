// SPDX-License-Identifier: MIT OR Apache-2.0
//! Places: those of the rounded Newton steps; the clocks they take.

use super::program::Program;
use super::{Inputs, Position, TablePort};
use crate::support::device::calibration;
use crate::support::random::Random;
use crate::support::{Bench, MILLION, cases, check, check_latency_of, check_rest, show, within};
use hapticore_contract::calibration::PositionTable;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Interpretation;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::real::Real;
use hapticore_hdl::interpretations::shadow::Shadow;
use hapticore_hdl::signal::{code, constant, zero};
use hapticore_reference::rounded::{self, Exact};

/// Half of the tables are a device's, and half are any words, of which few have a place for any
/// ratios.
#[test]
fn places_are_those_of_the_rounded_newton_steps() {
    let with = |calibrated| Profile::all().into_iter().map(move |profile| (calibrated, profile));
    for (seed, (calibrated, profile)) in (0..).zip([true, false].into_iter().flat_map(with)) {
        let f = &profile.formats;
        let block = Position::new(&profile);
        let (mut random, share) = (Random::new(seed), block.inputs().share);
        let any = (0..block.table().words).map(|_| random.word(f.table)).collect();
        let of_device = calibration(&profile)
            .position
            .words
            .into_iter()
            .map(|word| f.table.code_saturating(word));
        let words: Vec<i64> = if calibrated { of_device.collect() } else { any };
        let mut bench = Bench::new(block);
        for (address, &word) in words.iter().enumerate() {
            bench.clock(Inputs {
                table: TablePort { write: 1, address: address as i64, word },
                ..no_place()
            });
        }
        let words: Vec<Exact> = words.into_iter().map(|word| Exact::of(word, f.table)).collect();
        let quiet = |i: Inputs<i64>| Inputs { table: TablePort { write: 0, ..i.table }, ..i };
        let cases = cases(&bench.block, MILLION / 1000, seed).map(quiet);
        let reference = rounded::Position::new(&profile, &words);
        check(&mut bench, cases, |i| {
            let place = reference.place([i.r_x, i.r_y].map(|code| Exact::of(code, f.ratio)));
            let [x, y] = [place.x, place.y].map(|mm| mm.code(f.position));
            let sheet = place.sheet.code(profile.sheet());
            let (invalid, saturated) = (place.invalid.into(), place.saturated.into());
            let lost = reference.any_open(Exact::of(i.share, share)).into();
            [
                ("x", x),
                ("y", y),
                ("sheet", sheet),
                ("invalid", invalid),
                ("lost", lost),
                ("saturated", saturated),
            ]
        });
    }
}

fn no_place() -> Inputs<i64> {
    Inputs::of(0)
}

#[test]
fn latency_is_the_clocks_measured() {
    for profile in Profile::all() {
        let block = Position::new(&profile);
        check_latency_of(block.clone(), block.latency(), |i: Inputs<i64>| Inputs {
            table: TablePort { write: 0, ..i.table },
            ..i
        });
    }
}

/// A place's x, y and resistance, without their rounding, as an interpretation with numbers computes them.
fn ideal_place<V: Interpretation>(bench: &mut Bench<Position, V>, ratios: [f64; 2]) -> [f64; 3] {
    let formats = bench.block.inputs();
    let number = |real: f64, format: Format| constant::<V>(real, format);
    let started = Inputs {
        start: number(1.0, formats.start),
        r_x: number(ratios[0], formats.r_x),
        r_y: number(ratios[1], formats.r_y),
        share: number(0.5, formats.share),
        table: TablePort::map(formats.table, zero),
    };
    let held = Inputs { start: number(0.0, formats.start), ..started };
    let mut outputs = V::step(&bench.block, &mut bench.state, started);
    for _ in 0..bench.block.latency() {
        outputs = V::step(&bench.block, &mut bench.state, held);
    }
    assert_eq!(V::unrounded(outputs.done), 1.0, "done after the latency");
    [outputs.x, outputs.y, outputs.sheet].map(V::unrounded)
}

/// The block of a profile in an interpretation with numbers, with a table's words.
fn calibrated<V: Interpretation>(profile: &Profile, table: &PositionTable) -> Bench<Position, V> {
    let mut bench = Bench::<_, V>::read(Position::new(profile));
    for (address, &word) in table.words.iter().enumerate() {
        bench.block.set_word(&mut bench.state, address, constant(word, profile.formats.table));
    }
    bench
}

fn check_numbers<V: Interpretation>(profile: &Profile, table: &PositionTable, ratios: [f64; 2]) {
    let [x, y, sheet] = ideal_place(&mut calibrated::<V>(profile, table), ratios);
    let found = table.look_up(ratios[0], ratios[1]);
    let off = [x - found.x, y - found.y, sheet - found.sheet];
    assert!(off.iter().all(|off| off.abs() < 1e-9), "{}, {ratios:?}: {off:?}", profile.name);
}

/// Of ratios that are no codes. A word's step is ten thousand times as large as what is allowed here.
#[test]
fn numbers_that_are_not_rounded_have_the_place_of_the_splines() {
    for profile in Profile::of_distinct_words() {
        let table = calibration(&profile).position;
        for ratios in [[-0.48671, 0.26713], [0.19329, -0.35787]] {
            check_numbers::<Shadow>(&profile, &table, ratios);
        }
        check_numbers::<Real>(&profile, &table, [0.53329, 0.01713]);
    }
}

/// Also where a step is held at four cells, as the first one to a far place is; some of these end
/// within the table.
#[test]
fn numbers_that_are_not_rounded_take_the_step_of_the_codes() {
    for (seed, mut profile) in (0..).zip(Profile::of_distinct_words()) {
        profile.position.steps = 1;
        let mut bench = calibrated::<Shadow>(&profile, &calibration(&profile).position);
        let mut random = Random::new(seed);
        for _ in 0..40 {
            let ratios = [(); 2].map(|()| random.below(2000) as f64 / 1000.0 - 1.0);
            let place = ideal_place(&mut bench, ratios);
            let codes = &bench.state.registers;
            let codes = [codes.x, codes.y].map(|shadow| shadow.code);
            let codes = codes.map(|code| profile.formats.position.real(code));
            for (place, code) in place.into_iter().zip(codes) {
                assert!((place - code).abs() < 1.0, "{}, {ratios:?}", profile.name);
            }
        }
    }
}

/// Flags among them, and those of the place before gone: with any words most places are saturated and invalid, with
/// those of a device few.
#[test]
fn places_that_are_found_at_once_are_those_of_the_program() {
    // Words in one memory, and in two banks.
    for name in ["small", "fine"] {
        let profile = Profile::bundled(name).expect("bundled");
        let (word, mut random) = (profile.formats.table, Random::new(5));
        let of_device = calibration(&profile).position.words;
        let any = of_device.iter().map(|_| random.word(word)).collect();
        let of_device = of_device.into_iter().map(|real| word.code_saturating(real)).collect();
        for words in [of_device, any] {
            check_at_once(&profile, words);
        }
    }
}

fn check_at_once(profile: &Profile, words: Vec<i64>) {
    let [mut clocked, mut at_once, mut by_statements] =
        [(); 3].map(|()| Bench::new(Position::new(profile)));
    for bench in [&mut clocked, &mut by_statements] {
        for (address, &word) in words.iter().enumerate() {
            let word = code(word, profile.formats.table);
            bench.block.set_word(&mut bench.state, address, word);
        }
    }
    at_once.block.place_at_once(words);
    by_statements.block.place_by_statements();
    let half = profile.formats.ratio.max_code() as i64 / 2;
    let quiet = |i: Inputs<i64>| Inputs { table: TablePort { write: 0, ..i.table }, start: 0, ..i };
    for (k, i) in (0..).zip(cases(&clocked.block, MILLION / 5000, 3).map(quiet)) {
        // Along one axis, both or none surely on the sheet.
        let i = if k % 2 == 0 { Inputs { r_x: i.r_x % half, ..i } } else { i };
        let i = if k % 3 == 0 { Inputs { r_y: i.r_y % half, ..i } } else { i };
        let expected = show::<super::Outputs>(clocked.operate(i).0);
        for bench in [&mut at_once, &mut by_statements] {
            bench.clock(Inputs { start: 1, ..i });
            assert_eq!(
                show::<super::Outputs>(bench.clock(i)),
                expected,
                "of {}",
                show::<Inputs>(i)
            );
        }
    }
}

#[test]
fn an_instruction_names_a_word_of_the_scratch_memory() {
    for profile in Profile::of_distinct_words() {
        let bench = Bench::new(Position::new(&profile));
        let registers = bench.state.load(&bench.block);
        let decoded = bench.block.decode(&registers);
        assert_eq!(decoded.slot.format, bench.block.scratch.address(), "{}", profile.name);
    }
}

#[test]
fn half_of_a_step_is_a_code_of_its_format() {
    for profile in Profile::of_distinct_words() {
        let half = Position::new(&profile).half::<i64>();
        assert!(within(half.value, half.format), "{}", half.format);
        assert_eq!(half.format.real(half.value), profile.formats.table.lsb() / 2.0);
    }
}

/// A signal has the name of its operation, so that a waveform can be read.
#[test]
fn signals_are_named_as_their_operations() {
    let program = Program::new(Profile::bundled("small").expect("bundled").formats.table);
    for instruction in program.instructions {
        let operation = instruction.operation;
        let letters = operation.name().strip_prefix("is_").unwrap_or_default().replace('_', "");
        assert_eq!(letters, format!("{operation:?}").to_lowercase());
    }
}

#[test]
fn without_a_start_there_is_no_place() {
    for profile in Profile::of_distinct_words() {
        check_rest(Position::new(&profile), &["start", "write"]);
    }
}
