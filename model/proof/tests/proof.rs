// SPDX-License-Identifier: MIT OR Apache-2.0
//! The range interpretation proves that nothing overflows, and would notice if something did.

use std::thread;

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::{ForceLaw, Profile};
use hapticore_hdl::block;
use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_violations, whole};
use hapticore_hdl::memory::{Memory, Storage};
use hapticore_hdl::signal::{HalfEven, Proved, Signal, bit, int, zero};
use hapticore_model::blocks::controller::{self, Controller};
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::demodulator::Demodulator;
use hapticore_model::parse_profile;
use hapticore_proof::{close, prove};
use hapticore_rtl::netlist;

/// What relates several signals: solvers prove it from the netlists
/// (`synth/tests/toolchain/claims.rs`), and every test build checks each of these narrowings at each
/// clock.
const ASSUMPTIONS: [&str; 3] = [
    "a square is not negative",
    "the remainder of a division stays below its denominator",
    "the remainder of a square root is at most twice the root so far",
];

#[test]
fn no_signal_of_a_bundled_profile_can_overflow() {
    for profile in Profile::all() {
        let proof = prove(&profile);
        let mut assumptions = proof.assumptions.clone();
        assumptions.sort_unstable();
        println!(
            "{}: {} clocks in {} rounds, {} registers",
            profile.name,
            proof.clocks,
            proof.rounds,
            proof.registers.len()
        );
        assert!(proof.holds(), "{}: {:?}", profile.name, proof.violations.first());
        assert_eq!(
            assumptions, ASSUMPTIONS,
            "{}: the assumptions that the proof relies on",
            profile.name
        );
    }
}

#[test]
fn a_mean_over_windows_cannot_overflow() {
    let mut profile = with("small", "windows", "64").expect("a profile");
    // The program's loop is the same, however often it is run through; so are pads.
    profile.position.steps = 1;
    profile.pads = 2;
    let proof = prove(&profile);
    assert!(proof.holds(), "{:?}", proof.violations.first());
}

/// Drive words of every law: any operands and tuning, any curve, as often as it takes to close.
#[test]
fn no_signal_of_a_force_controller_can_overflow() {
    for profile in Profile::all() {
        for law in [Law::Open, Law::Proportional, Law::Integral, Law::Inverse] {
            let control = Some(Control::of(&profile, law));
            let block = Controller::try_new(&Profile { control, ..profile.clone() }).unwrap();
            take_violations();
            let mut state = block.reset();
            let (closed, _) = close(&block, &mut state, |state| drive_word(&block, state));
            assert_eq!(take_violations(), [], "{} {law:?}", profile.name);
            assert!(closed, "{} {law:?}", profile.name);
        }
    }
}

fn drive_word(block: &Controller, state: &mut State<Controller, Range>) {
    let formats = block.inputs();
    let any = controller::Inputs::map(formats, |format| Signal { value: whole(format), format });
    let mut held = controller::Inputs { start: bit(false), ..any };
    let words = Range { low: 0, high: block.words_of_curve() as i128 - 1 };
    held.tuning.curve_address.value = words;
    block.call("controller", state, controller::Inputs { start: bit(true), ..held });
    (0..block.latency()).for_each(|_| {
        block.call("controller", state, held);
    });
}

/// The core with its prompt estimate.
#[test]
fn no_signal_of_a_core_with_a_controller_can_overflow() {
    let mut profile = Profile::bundled("small").expect("bundled");
    // The program's loop is the same, however often it is run through.
    profile.position.steps = 1;
    profile.control = Some(Control::of(&profile, Law::Inverse));
    let proof = prove(&profile);
    assert!(proof.holds(), "{:?}", proof.violations.first());
}

#[test]
fn a_force_table_cannot_overflow() {
    for mut profile in Profile::all() {
        profile.force.law = ForceLaw::Table;
        profile.position.steps = 1;
        // With one, the filters are held once a frame.
        profile.control = Some(Control::of(&profile, Law::Open));
        let proof = prove(&profile);
        assert!(proof.holds(), "{}: {:?}", profile.name, proof.violations.first());
    }
}

block! {
    /// A first-order low-pass, written in two ways.
    struct LowPass("low_pass") {
        by_difference: bool,
    }
    submodules {}
    inputs(low_pass) {
        x: BYTE,
    }
    outputs(low_pass) {
        y: BYTE,
    }
    registers(low_pass) {
        y: BYTE,
    }
}

const BYTE: Format = Format::unsigned(8, 0);

impl Block for LowPass {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let r = state.load(self);
        let next = if self.by_difference {
            r.y + (i.x - r.y).scaled(-4)
        } else {
            (r.y * int(15) + i.x).scaled(-4)
        };
        state.store(self, Registers { y: next.quantize(BYTE, HalfEven, Proved) });
        Outputs { y: r.y }
    }
}

/// Whether a filter's state closes without a violation, and after how many rounds.
fn filtered(by_difference: bool) -> (bool, u64) {
    let filter = LowPass { by_difference };
    let mut state = filter.reset();
    take_violations();
    let (closed, rounds) = close(&filter, &mut state, |state| {
        filter.clock(state, Inputs { x: Signal { value: whole(BYTE), format: BYTE } });
    });
    (closed && take_violations().is_empty(), rounds)
}

/// A filter's state grows for ever unless it is widened. y + (x − y)/16 stays within its format
/// just as well, but intervals do not know that both y are the same.
#[test]
fn a_filter_is_proved_where_its_state_stands_once() {
    let (proved, rounds) = filtered(false);
    assert!(proved && rounds <= 5, "{rounds} rounds");
    assert!(!filtered(true).0, "the difference exceeds the format in intervals");
}

#[test]
fn every_register_stays_within_its_format() {
    for (name, format, range) in prove(&Profile::bundled("small").unwrap()).registers {
        assert!(whole(format).holds(range), "{name} {format}: {range:?}");
    }
}

#[test]
fn one_sample_too_many_is_noticed() {
    let profile = Profile::bundled("standard").unwrap();
    let demodulator = Demodulator::try_new(&profile).unwrap();
    let (adc, wave) = (whole(profile.formats.adc), whole(profile.formats.oscillator));
    let product = Signal { value: adc, format: profile.formats.adc }
        * Signal { value: wave, format: profile.formats.oscillator };
    let sum_of = |samples: u64| {
        take_violations();
        let mut sum: Signal<Range> = zero(demodulator.sum());
        (0..samples).for_each(|_| sum = demodulator.accumulate(bit(false), sum, product));
        take_violations().len()
    };
    assert_eq!(
        sum_of(profile.slot.integrate),
        0,
        "the sum holds a whole window of the worst samples"
    );
    let headroom = 1u64 << (64 - (profile.slot.integrate - 1).leading_zeros());
    assert!(sum_of(headroom + 1) > 0, "more than its guard bits are for overflows, and is seen to");
}

#[test]
fn a_register_one_bit_short_is_noticed() {
    take_violations();
    let byte: Signal<Range> =
        Signal { value: whole(Format::unsigned(8, 0)), format: Format::unsigned(8, 0) };
    (byte + int(1)).resize(Format::unsigned(8, 0), Proved);
    let found = take_violations();
    assert_eq!(found.len(), 1);
    let message = found[0].to_string();
    assert!(message.starts_with("model/proof/tests/proof.rs:"), "{message}");
    assert!(message.ends_with(": 1 … 256 lacks 1 bit in u8.0"), "{message}");
}

#[test]
fn an_address_beyond_a_memory_is_noticed() {
    let address = Format::unsigned(4, 0);
    for (words, beyond) in [(16, false), (15, true)] {
        let memory = Memory::new("squares", words, BYTE);
        let mut state = <Range as Storage>::words(&memory);
        take_violations();
        memory.read(&mut state, Signal { value: whole(address), format: address });
        let found: Vec<String> = take_violations().iter().map(ToString::to_string).collect();
        assert_eq!(found.len(), usize::from(beyond), "{found:?}");
        for message in found {
            assert!(message.ends_with(": address 0 … 15 leaves the memory squares"), "{message}");
        }
    }
}

#[test]
fn a_violation_names_the_instance() {
    let filter = LowPass { by_difference: true };
    let mut state = filter.reset();
    take_violations();
    let any = Inputs { x: Signal { value: whole(BYTE), format: BYTE } };
    for _ in 0..40 {
        filter.call("filter", &mut state, any);
    }
    let message = take_violations()[0].to_string();
    assert!(message.starts_with("filter, model/proof/tests/proof.rs:"), "{message}");
    assert!(message.contains("lacks 1 bit in u8.0"), "{message}");
}

/// A profile with one entry of its text replaced.
fn with(profile: &str, key: &str, value: &str) -> Result<Profile, String> {
    let text = hapticore_contract::profile::BUNDLED
        .iter()
        .find(|(name, _)| *name == profile)
        .expect("bundled")
        .1;
    let is_key = |line: &&str| line.split('=').next().is_some_and(|word| word.trim() == key);
    let line = text.lines().find(is_key).unwrap_or_else(|| panic!("{profile} has {key}"));
    parse_profile(&text.replace(line, &format!("{key} = {value}")))
        .map_err(|error| error.to_string())
}

const FORMATS: [&str; 14] = [
    "adc",
    "oscillator",
    "iq",
    "total",
    "ratio",
    "table",
    "position",
    "admittance",
    "capacitance",
    "mean_square",
    "square",
    "force",
    "capacitance_gain",
    "force_gain",
];

/// How many formats of a key are accepted, each of them proved, and how many refused.
fn tried(key: &str) -> [usize; 2] {
    let (mut accepted, mut refused) = (0, 0);
    for sign in ['s', 'u'] {
        for width in [1, 4, 13, 18, 24, 30, 63] {
            for frac in [-3, 0, 3, width / 2, width - 2, width - 1, width, width + 20] {
                let Ok(mut profile) = with("small", key, &format!("\"{sign}{width}.{frac}\""))
                else {
                    refused += 1;
                    continue;
                };
                accepted += 1;
                // The program's loop is the same, however often it is run through; so are pads, and
                // the samples before a window.
                profile.position.steps = 1;
                (profile.pads, profile.slot.settle) = (2, 100);
                netlist::of_core(&Core::new(&profile));
                let violations = prove(&profile).violations;
                assert!(
                    violations.is_empty(),
                    "{key} {sign}{width}.{frac}: {:?}",
                    violations.first()
                );
            }
        }
    }
    [accepted, refused]
}

#[test]
fn any_profile_that_is_accepted_elaborates_and_is_proved() {
    // One lane of every other key beside one of the remaining keys.
    let lane = |first: usize| {
        FORMATS.iter().skip(first).step_by(2).map(|key| tried(key)).collect::<Vec<_>>()
    };
    let lanes = thread::scope(|scope| {
        let other = scope.spawn(|| lane(1));
        [lane(0), other.join().expect("every profile is proved")]
    });
    let [accepted, refused] =
        [0, 1].map(|which| lanes.iter().flatten().map(|counts| counts[which]).sum::<usize>());
    println!("{accepted} accepted, {refused} refused");
    assert!(accepted > 50 && refused > 50);
}

/// Words of other profiles that get longer: a core of them is one that can be printed, or is refused.
#[test]
fn longer_words_are_refused_or_elaborate() {
    let (mut accepted, mut refused) = (0, 0);
    for mut profile in Profile::of_distinct_words() {
        for _ in 0..8 {
            let f = &mut profile.formats;
            for format in
                [&mut f.iq, &mut f.total, &mut f.admittance, &mut f.capacitance, &mut f.square]
            {
                (format.width, format.frac) = (format.width + 1, format.frac + 1);
            }
            match hapticore_model::check(&profile) {
                Ok(()) => {
                    netlist::of_core(&Core::new(&profile));
                    accepted += 1;
                }
                Err(_) => refused += 1,
            }
        }
    }
    assert!(accepted > 3 && refused > 3, "{accepted} accepted, {refused} refused");
}

#[test]
fn bad_profiles_say_what_was_expected() {
    for (key, value, words) in [
        ("clocks_per_sample", "12", "clocks_per_sample: expected 13 to 65536, got 12"),
        (
            "integrate",
            "501",
            "slot.integrate: expected five samples of each of 100 periods, got 501",
        ),
        ("periods", "200", "carrier.periods: expected 2 to 166, got 200"),
        ("amplitude", "140000", "carrier.amplitude: expected 32767 to 65535, got 140000"),
        // The read-out of polyphase sums.
        ("settle", "15", "slot.settle: expected more than 576 clocks of blanking, got 480"),
        (
            "settle",
            "346",
            "slot.settle: expected whole periods of five samples before the window, got 351",
        ),
        ("iq", "\"u14.13\"", "formats.iq: expected a signed format, got u14.13"),
        ("iq", "\"14.13\"", "expected a format such as \"s18.17\""),
        ("x", "[1, 1, 1, 1, 0, 0]", "terminals.x: expected both signs"),
        ("window", "\"hamming\"", "unknown variant `hamming`"),
        ("columns", "131", "position.columns: expected 5 to 65, got 131"),
        ("windows", "3", "haptic.windows: expected a power of two, 64 at most, got 3"),
        ("windows", "0", "haptic.windows: expected a power of two, 64 at most, got 0"),
        ("columns", "16", "position.columns: expected an odd number, got 16"),
    ] {
        let message = with("small", key, value).expect_err(key);
        assert!(message.contains(words), "{key} = {value}: {message}");
    }
    let message = parse_profile("name = \"x\"\nwidth = 3").unwrap_err().to_string();
    assert!(message.starts_with("2: "), "the line is named: {message}");
}
