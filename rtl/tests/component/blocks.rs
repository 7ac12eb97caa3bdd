// SPDX-License-Identifier: MIT OR Apache-2.0
//! Components: the model in rust-hdl's simulator, and the printed modules in rust-hdl's Verilog,
//! alike at every clock.

use crate::harness::{Design, Ports, mismatch, simulated};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::Format;
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::divider::Divider;
use hapticore_model::blocks::multiplexer::Multiplexer;
use hapticore_rtl::board::sigma_delta::SigmaDelta;
use hapticore_rtl::component;
use rust_hdl_core::prelude::*;

component! {
    /// Divides 8 bits by 8 bits.
    pub struct Quotient of Divider {
        inputs { start: Bit, numerator: Bits<8>, denominator: Bits<8> }
        outputs { done: Bit, quotient: Bits<9>, saturated: Bit }
    }
}

component! {
    /// A carrier of 6 bits.
    pub struct Carrier of SigmaDelta {
        inputs { carrier: Bits<6> }
        outputs { pulse: Bit }
    }
}

component! {
    /// Serves the pads of the small profile.
    pub struct Turns of Multiplexer {
        inputs { strobe: Bit, clear: Bit }
        outputs { sample: Bit, restart: Bit, integrate: Bit, first: Bit, last: Bit, pad: Bits<2>, closed: Bit }
    }
}

/// A divider twice, and a modulator that has a say in when one of them starts: in a kernel of
/// rust-hdl's.
#[derive(LogicBlock)]
struct Pair {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    start: Signal<In, Bit>,
    a: Signal<In, Bits<8>>,
    b: Signal<In, Bits<8>>,
    done: Signal<Out, Bit>,
    once: Signal<Out, Bits<9>>,
    twice: Signal<Out, Bits<9>>,
    pulse: Signal<Out, Bit>,
    first: Quotient,
    second: Quotient,
    modulator: Carrier,
}

impl Pair {
    fn new() -> Self {
        let integer = Format::unsigned(8, 0);
        let divider = Divider::new(integer, integer, Format::unsigned(9, 8));
        Pair {
            clock: Signal::default(),
            reset: Signal::default(),
            start: Signal::default(),
            a: Signal::default(),
            b: Signal::default(),
            done: Signal::default(),
            once: Signal::default(),
            twice: Signal::default(),
            pulse: Signal::default(),
            first: Quotient::new(divider.clone()),
            second: Quotient::new(divider),
            modulator: Carrier::new(SigmaDelta::new(Format::signed(6, 5))),
        }
    }
}

impl Logic for Pair {
    #[hdl_gen]
    fn update(&mut self) {
        self.first.clock.next = self.clock.val();
        self.first.reset.next = self.reset.val();
        self.first.start.next = self.start.val();
        self.first.numerator.next = self.a.val();
        self.first.denominator.next = self.b.val();
        self.second.clock.next = self.clock.val();
        self.second.reset.next = self.reset.val();
        self.second.start.next = self.modulator.pulse.val() & self.start.val();
        self.second.numerator.next = self.b.val();
        self.second.denominator.next = self.a.val();
        self.modulator.clock.next = self.clock.val();
        self.modulator.reset.next = self.reset.val();
        self.modulator.carrier.next = self.a.val().get_bits::<6>(0);
        self.done.next = self.first.done.val() | self.second.done.val();
        self.once.next = self.first.quotient.val();
        self.twice.next = self.second.quotient.val();
        self.pulse.next = self.modulator.pulse.val();
    }
}

impl Design for Pair {
    const PORTS: (Ports, Ports) = (
        &[("reset", 1), ("start", 1), ("a", 8), ("b", 8)],
        &[("done", 1), ("once", 9), ("twice", 9), ("pulse", 1)],
    );
    const CLOCKED: bool = true;
    const UNKNOWN: usize = 1;

    fn set(&mut self, inputs: &[u64]) {
        self.reset.next = inputs[0] != 0;
        self.start.next = inputs[1] != 0;
        self.a.next = inputs[2].into();
        self.b.next = inputs[3].into();
    }

    fn get(&self) -> Vec<u64> {
        let bit = |bit: bool| u64::from(bit);
        vec![
            bit(self.done.val()),
            self.once.val().to_u64(),
            self.twice.val().to_u64(),
            bit(self.pulse.val()),
        ]
    }

    fn clock(&mut self, high: bool) {
        self.clock.next = high.into();
    }
}

/// Clocks for which numbers are held: a divider asks for them until its quotient is there.
const HELD: u64 = 32;
/// At which of them a division starts, perhaps over one in progress.
const STARTS: [u64; 3] = [3, 7, 12];

/// Resets, then starts now and then with ever other numbers.
fn inputs() -> Vec<Vec<u64>> {
    let numbers = |k: u64| [(k * 7919) >> 3 & 0xff, (k * 104_729) >> 5 & 0xff];
    let step = |k: u64| {
        let [a, b] = numbers(k / HELD);
        vec![u64::from(k < 2 || k == 900), u64::from(STARTS.contains(&(k % HELD))), a, b]
    };
    (0..2_000).map(step).collect()
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn components_are_alike_in_simulation_and_in_verilog() {
    assert_eq!(mismatch(Pair::new(), &inputs()), None);
}

#[test]
fn a_component_divides_as_its_block_does() {
    let outputs = simulated(&mut Pair::new(), &inputs());
    let quotients: Vec<u64> = outputs.iter().map(|outputs| outputs[1]).collect();
    let [a, b] = [7919 * 30 / 8 % 256, (30 * 104_729u64) >> 5 & 0xff];
    let expected = ((a as f64 / b as f64 * 256.0).round_ties_even() as u64).min(511);
    assert_eq!(quotients[31 * HELD as usize - 1], expected, "{a} / {b}");
}

#[test]
fn each_printed_module_is_there_once() {
    let mut pair = Pair::new();
    pair.connect_all();
    let text = component::verilog(&pair);
    assert_eq!(text.matches("\nmodule hapticore_divider ").count(), 1);
    assert_eq!(text.matches("hapticore_divider block (").count(), 2);
}

#[test]
#[should_panic(expected = "the inputs of divider")]
fn a_component_of_other_widths_is_refused() {
    let (wide, fraction) = (Format::unsigned(9, 0), Format::unsigned(9, 8));
    Quotient::new(Divider::new(wide, Format::unsigned(8, 0), fraction));
}

#[test]
fn any_block_has_a_component() {
    let profile = Profile::bundled("small").expect("bundled");
    let mut turns = Turns::new(Multiplexer::new(&profile));
    turns.connect_all();
    assert!(component::verilog(&turns).contains("module hapticore_multiplexer"));
    // As it stands at the top of this file.
    let declared = component::declaration(&Multiplexer::new(&profile), "Multiplexer", "Turns");
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let here =
        include_str!("blocks.rs").replace("    /// Serves the pads of the small profile.\n", "");
    let here =
        words(&here[here.find("component! {\n    pub struct Turns").expect("declared above")..]);
    assert!(here.starts_with(&words(&declared)), "{declared}");
    // Blocks whose ports have names that Verilog or rust-hdl would not take would not come this
    // far.
    let core = Core::new(&profile);
    for text in [
        component::declaration(&core, "Core", "Sensor"),
        component::declaration(core.estimator(), "Estimator", "Estimate"),
        component::declaration(core.demodulator(), "Demodulator", "LockIn"),
        component::declaration(core.oscillator(), "Oscillator", "Nco"),
        component::declaration(core.estimator().position(), "Position", "Place"),
    ] {
        assert!(!text.contains(" force:") && !text.contains(" config:"), "{text}");
    }
}
