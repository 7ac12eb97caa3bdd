// SPDX-License-Identifier: MIT OR Apache-2.0
//! Board tops in rust-hdl: the board, its reset, the output primitive of SCLK, and the pins.
//!
//! ```text
//! power-up: 255 clocks ─┬─(or)─ reset ─┬─ board ─ pins
//! button ─ synchroniser ┘              └─ adc_reset
//!                                sclk_run ─ DDR output ─ sclk: high, then low, in a clock with a pulse; else high
//! ```
//!
//! The kernel here only wires: what computes is in blocks. The reset is the FPGA's loading of
//! registers with their initial values, then 255 clocks (the ADC's full reset takes 3.2 µs);
//! loading itself takes long enough for all supplies. Lamps and button may be active low.

use super::whole;
use rust_hdl_core::prelude::*;
use rust_hdl_widgets::prelude::{BitSynchronizer, DFF};

crate::component! {
    /// The board as a rust-hdl component, for an ADC of `CHANNELS` channels and for `PADS` pads.
    pub struct BoardComponent<const CHANNELS, const PADS> of whole::Board {
        inputs { dout: Bits<CHANNELS>, busy: Bit, rx: Bit }
        outputs {
            convst: Bit, cs_n: Bit, sclk_run: Bit, sdi: Bit, carrier: Bit, select: Bits<PADS>, tx: Bit, enabled: Bit, late: Bit,
            adc_reset: Bit
        }
    }
}

crate::component! {
    /// The board with a serial converter for its pads, as a rust-hdl component.
    pub struct DriveBoardComponent<const CHANNELS, const PADS> of whole::Board {
        inputs { dout: Bits<CHANNELS>, busy: Bit, rx: Bit }
        outputs {
            convst: Bit, cs_n: Bit, sclk_run: Bit, sdi: Bit, carrier: Bit, select: Bits<PADS>, tx: Bit, enabled: Bit, late: Bit,
            adc_reset: Bit, dac_sync_n: Bit, dac_sclk: Bit, dac_sdi: Bit, dac_polarity: Bits<PADS>, dac_live: Bit
        }
    }
}

/// Asserted for 255 clocks after the FPGA has been configured. rust-hdl's `AutoReset` adds an integer of 32 bits to its count,
/// at which linters stop.
#[derive(LogicBlock)]
#[allow(missing_docs)]
pub struct PowerUp {
    pub clock: Signal<In, Clock>,
    pub reset: Signal<Out, Bit>,
    one: Constant<Bits<8>>,
    count: DFF<Bits<8>>,
}

impl Default for PowerUp {
    fn default() -> Self {
        PowerUp {
            clock: Signal::default(),
            reset: Signal::default(),
            one: Constant::new(1.into()),
            count: DFF::default(),
        }
    }
}

impl Logic for PowerUp {
    #[hdl_gen]
    fn update(&mut self) {
        self.count.clock.next = self.clock.val();
        self.count.d.next = self.count.q.val();
        self.reset.next = false;
        if !self.count.q.val().all() {
            self.count.d.next = self.count.q.val() + self.one.val();
            self.reset.next = true;
        }
    }
}

/// Which primitive puts SCLK out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Primitive {
    /// Lattice ECP5's ODDRX1F.
    Oddrx1f,
    /// Lattice iCE40's SB_IO with a DDR output.
    SbIo,
}

impl Primitive {
    fn verilog(self) -> &'static str {
        match self {
            Primitive::Oddrx1f => {
                "ODDRX1F output_cell (.D0(1'b1), .D1(~run), .SCLK(clock), .RST(1'b0), .Q(sclk));"
            }
            Primitive::SbIo => {
                "SB_IO #(.PIN_TYPE(6'b0100_00)) output_cell (\n    .PACKAGE_PIN(sclk), .OUTPUT_CLK(clock), .D_OUT_0(1'b1), .D_OUT_1(~run)\n);"
            }
        }
    }
}

/// SCLK's output cell. It has no model in rust-hdl, whose clocks have no halves: [`crate::board`]'s
/// tests run its Verilog.
pub struct SclkOutput {
    /// The core's clock.
    pub clock: Signal<In, Clock>,
    /// A pulse in this clock.
    pub run: Signal<In, Bit>,
    /// Pin: serial clock of the ADC.
    pub sclk: Signal<Out, Bit>,
    primitive: Primitive,
}

impl SclkOutput {
    /// With this primitive.
    pub fn new(primitive: Primitive) -> Self {
        SclkOutput {
            clock: Signal::default(),
            run: Signal::default(),
            sclk: Signal::default(),
            primitive,
        }
    }
}

impl Logic for SclkOutput {
    fn update(&mut self) {
        self.sclk.next = true;
    }

    fn connect(&mut self) {
        self.sclk.connect();
    }

    fn hdl(&self) -> Verilog {
        Verilog::Wrapper(Wrapper { code: self.primitive.verilog().into(), cores: String::new() })
    }
}

impl Block for SclkOutput {
    fn connect_all(&mut self) {
        self.connect();
    }

    fn update_all(&mut self) {
        self.update();
        self.clock.update_all();
        self.run.update_all();
        self.sclk.update_all();
    }

    fn has_changed(&self) -> bool {
        self.clock.has_changed() || self.run.has_changed() || self.sclk.has_changed()
    }

    fn accept(&self, name: &str, probe: &mut dyn Probe) {
        probe.visit_start_scope(name, self);
        self.clock.accept("clock", probe);
        self.run.accept("run", probe);
        self.sclk.accept("sclk", probe);
        probe.visit_end_scope(name, self);
    }
}

/// A board's top: with further pins of the board, as they are.
macro_rules! top {
    ($(#[$meta:meta])* $name:ident of $board:ident, $($pin:ident: $width:ty,)*) => {
        $(#[$meta])*
        #[derive(LogicBlock)]
        #[allow(missing_docs)]
        pub struct $name<const CHANNELS: usize, const PADS: usize> {
            pub clock: Signal<In, Clock>,
            pub button: Signal<In, Bit>,
            pub rx: Signal<In, Bit>,
            pub tx: Signal<Out, Bit>,
            pub adc_reset: Signal<Out, Bit>,
            pub convst: Signal<Out, Bit>,
            pub busy: Signal<In, Bit>,
            pub cs_n: Signal<Out, Bit>,
            pub sclk: Signal<Out, Bit>,
            pub sdi: Signal<Out, Bit>,
            pub dout: Signal<In, Bits<CHANNELS>>,
            pub carrier: Signal<Out, Bit>,
            pub pads: Signal<Out, Bits<PADS>>,
            pub enabled: Signal<Out, Bit>,
            pub late: Signal<Out, Bit>,
            $(pub $pin: Signal<Out, $width>,)*
            active_low: Constant<Bit>,
            power_up: PowerUp,
            pressed: BitSynchronizer,
            hold: DFF<Bit>,
            board: $board<CHANNELS, PADS>,
            pulses: SclkOutput,
        }

        impl<const CHANNELS: usize, const PADS: usize> $name<CHANNELS, PADS> {
            /// The top of a board, whose button and lamps may be active low.
            pub fn new(board: whole::Board, primitive: Primitive, active_low: bool) -> Self {
                $name {
                    clock: Signal::default(),
                    button: Signal::default(),
                    rx: Signal::default(),
                    tx: Signal::default(),
                    adc_reset: Signal::default(),
                    convst: Signal::default(),
                    busy: Signal::default(),
                    cs_n: Signal::default(),
                    sclk: Signal::default(),
                    sdi: Signal::default(),
                    dout: Signal::default(),
                    carrier: Signal::default(),
                    pads: Signal::default(),
                    enabled: Signal::default(),
                    late: Signal::default(),
                    $($pin: Signal::default(),)*
                    active_low: Constant::new(active_low),
                    power_up: PowerUp::default(),
                    pressed: BitSynchronizer::default(),
                    hold: DFF::default(),
                    board: $board::new(board),
                    pulses: SclkOutput::new(primitive),
                }
            }
        }

        impl<const CHANNELS: usize, const PADS: usize> Logic for $name<CHANNELS, PADS> {
            #[hdl_gen]
            fn update(&mut self) {
                self.power_up.clock.next = self.clock.val();
                self.pressed.clock.next = self.clock.val();
                self.pressed.sig_in.next = self.button.val() ^ self.active_low.val();
                self.hold.clock.next = self.clock.val();
                self.hold.d.next = self.power_up.reset.val() | self.pressed.sig_out.val();
                self.board.clock.next = self.clock.val();
                self.board.reset.next = self.hold.q.val();
                self.adc_reset.next = self.hold.q.val() | self.board.adc_reset.val();
                self.board.busy.next = self.busy.val();
                self.board.dout.next = self.dout.val();
                self.board.rx.next = self.rx.val();
                self.convst.next = self.board.convst.val();
                self.cs_n.next = self.board.cs_n.val();
                self.sdi.next = self.board.sdi.val();
                self.carrier.next = self.board.carrier.val();
                self.pads.next = self.board.select.val();
                self.tx.next = self.board.tx.val();
                self.enabled.next = self.board.enabled.val() ^ self.active_low.val();
                self.late.next = self.board.late.val() ^ self.active_low.val();
                self.pulses.clock.next = self.clock.val();
                self.pulses.run.next = self.board.sclk_run.val();
                self.sclk.next = self.pulses.sclk.val();
                $(self.$pin.next = self.board.$pin.val();)*
            }
        }
    };
}

top! {
    /// A board's top.
    Top of BoardComponent,
}

top! {
    /// The top of a board that drives its pads through a serial converter.
    DriveTop of DriveBoardComponent, dac_sync_n: Bit, dac_sclk: Bit, dac_sdi: Bit, dac_polarity: Bits<PADS>, dac_live: Bit,
}
