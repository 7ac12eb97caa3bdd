// SPDX-License-Identifier: MIT OR Apache-2.0
//! A rust-hdl design of one's own around a block of this project: a meter that divides each pair of
//! its input numbers, and counts those whose quotient is below a half. The division is the core's
//! divider, correctly rounded; the counting is rust-hdl's, with its widgets. Simulated here, and
//! printed as Verilog with `--verilog`.

use hapticore_hdl::format::Format;
use hapticore_model::blocks::divider::Divider;
use hapticore_rtl::component;
use rust_hdl_core::prelude::*;
use rust_hdl_widgets::prelude::DFF;

component! {
    /// 12 bits by 12 bits, a quotient of 13 bits with 12 of them after the point.
    pub struct Quotient of Divider {
        inputs { start: Bit, numerator: Bits<12>, denominator: Bits<12> }
        outputs { done: Bit, quotient: Bits<13>, saturated: Bit }
    }
}

/// A rust-hdl design that wraps the ratio block.
#[derive(LogicBlock)]
struct RatioMeter {
    clock: Signal<In, Clock>,
    reset: Signal<In, Bit>,
    measure: Signal<In, Bit>,
    a: Signal<In, Bits<12>>,
    b: Signal<In, Bits<12>>,
    ready: Signal<Out, Bit>,
    ratio: Signal<Out, Bits<13>>,
    below_half: Signal<Out, Bits<8>>,
    half: Constant<Bits<13>>,
    divider: Quotient,
    count: DFF<Bits<8>>,
}

impl RatioMeter {
    fn new() -> Self {
        let (integer, fraction) = (Format::unsigned(12, 0), Format::unsigned(13, 12));
        RatioMeter {
            clock: Signal::default(),
            reset: Signal::default(),
            measure: Signal::default(),
            a: Signal::default(),
            b: Signal::default(),
            ready: Signal::default(),
            ratio: Signal::default(),
            below_half: Signal::default(),
            half: Constant::new(bits(1 << 11)),
            divider: Quotient::new(Divider::new(integer, integer, fraction)),
            count: DFF::default(),
        }
    }
}

impl Logic for RatioMeter {
    #[hdl_gen]
    fn update(&mut self) {
        self.divider.clock.next = self.clock.val();
        self.divider.reset.next = self.reset.val();
        self.divider.start.next = self.measure.val();
        self.divider.numerator.next = self.a.val();
        self.divider.denominator.next = self.b.val();
        self.ready.next = self.divider.done.val();
        self.ratio.next = self.divider.quotient.val();
        self.count.clock.next = self.clock.val();
        self.count.d.next = self.count.q.val();
        if self.divider.done.val() & (self.divider.quotient.val() < self.half.val()) {
            self.count.d.next = self.count.q.val() + 1;
        }
        self.below_half.next = self.count.q.val();
    }
}

/// Divides some pairs in rust-hdl's simulator: the ratios it gives, in 4096ths.
fn simulate(pairs: &'static [(u64, u64)]) {
    let mut simulation = Simulation::new();
    simulation.add_clock(5, |meter: &mut Box<RatioMeter>| meter.clock.next = !meter.clock.val());
    simulation.add_testbench(move |mut sim: Sim<RatioMeter>| {
        let mut meter = sim.init()?;
        let mut below = 0;
        for &(a, b) in pairs {
            meter.a.next = a.into();
            meter.b.next = b.into();
            meter.measure.next = true;
            wait_clock_cycle!(sim, clock, meter);
            meter.measure.next = false;
            meter = sim.watch(|meter| meter.ready.val(), meter)?;
            let ratio = meter.ratio.val().to_u64();
            let expected = (a as f64 / b as f64 * 4096.0).round_ties_even() as u64;
            println!("{a:4} / {b:4} = {ratio:4} / 4096");
            sim_assert_eq!(sim, ratio, expected, meter);
            below += u64::from(ratio < 2048);
            wait_clock_cycles!(sim, clock, meter, 2);
            sim_assert_eq!(sim, meter.below_half.val().to_u64(), below, meter);
        }
        sim.done(meter)
    });
    simulation.run(Box::new(RatioMeter::new()), 1_000_000).expect("every ratio is as expected");
}

fn main() {
    if std::env::args().any(|argument| argument == "--verilog") {
        let mut meter = RatioMeter::new();
        meter.connect_all();
        println!("{}", component::verilog(&meter));
    } else {
        simulate(&[(1, 3), (2, 3), (1000, 4095), (4095, 4095), (17, 4000), (3000, 2000), (0, 5)]);
    }
}
