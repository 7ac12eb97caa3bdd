// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core and the device around it, clock by clock: the device answers the carrier that the core
//! makes and the pad that it selects.
//!
//! ```text
//! carrier w, of the sample before ─┬─ 0.8·w                                   sensing voltage
//!                                  └─ a_k·(w·cos δ − w′)/sin δ                 a terminal's current, a quarter of a turn ahead
//! ```
//!
//! w′ is the carrier a sample earlier, δ its phase between two samples: what has changed the core's
//! timing changes the device's with it. The haptic voltage is constant.

use std::f64::consts::TAU;

use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Edit, State, Submodule, Visitor};
use hapticore_hdl::bundle::{Bundle, Field};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Memory;
use hapticore_hdl::signal::{Signal, code};
use hapticore_model::blocks::core::{Core, Inputs};
use hapticore_model::blocks::position::TablePort;

use super::bits::{Bits, Words};
use crate::stability::bench::Bench;

/// What does not change from clock to clock.
pub struct Device {
    /// Profile and calibration.
    pub bench: Bench,
    /// The core's configuration.
    pub core: Core,
    idle: Inputs<Signal<Bits>>,
}

/// What does.
#[derive(Clone)]
pub struct Now {
    /// The core's registers and memories.
    pub core: State<Core, Bits>,
    /// Clocks since the last strobe.
    count: u64,
    channel: usize,
    /// The carrier at the last two samples.
    wave: [f64; 2],
    /// The pad that is driven.
    pad: Option<usize>,
    /// The carrier's word now.
    carrier: f64,
    serve: Option<usize>,
    words: [i64; 8],
}

/// What is asked of the core beside its samples in a clock.
#[derive(Clone, Copy, Default)]
pub struct Ask {
    /// Its input `clear`.
    pub clear: bool,
    /// A word of the calibration's table: address and number.
    pub table: Option<(usize, f64)>,
}

impl Device {
    /// A core of a profile, its slots cut to what the estimator needs.
    pub fn short(name: &str) -> Self {
        Device::with(Bench::with(shortened(Bench::of(name).profile)))
    }

    /// The same core with another calibration.
    pub fn with(bench: Bench) -> Self {
        let core = Core::new(&bench.profile);
        let codes = core.idle_inputs(&bench.calibration);
        let idle =
            Inputs::map(Inputs::zip(codes, core.inputs()), |(word, format)| code(word, format));
        Device { idle, core, bench }
    }

    /// Clocks of a slot of each pad.
    pub fn round(&self) -> u64 {
        self.bench.profile.pads * self.bench.profile.slot_clocks()
    }

    /// Just before the first strobe, the calibration written.
    pub fn start(&self) -> Now {
        let mut now = Now {
            core: self.core.reset(),
            count: 0,
            channel: 0,
            wave: [0.0; 2],
            pad: None,
            carrier: 0.0,
            serve: None,
            words: [0; 8],
        };
        let words = self.bench.calibration.words(&self.bench.profile);
        for (address, word) in words.into_iter().enumerate() {
            let inputs = self.inputs(&now, Ask { table: Some((address, word)), clear: false });
            step(&self.core, &mut now.core, inputs);
        }
        now
    }

    fn inputs(&self, now: &Now, ask: Ask) -> Inputs<Signal<Bits>> {
        let mut inputs = self.idle;
        inputs.clear = code(ask.clear.into(), inputs.clear.format);
        inputs.code = code(self.code(now), inputs.code.format);
        if let Some((address, word)) = ask.table {
            let port = &mut inputs.calibration.table;
            let format = self.core.estimator().table().format;
            *port = TablePort {
                write: code(1, port.write.format),
                address: code(address as i64, port.address.format),
                word: code(format.code_saturating(word), port.word.format),
            };
        }
        inputs
    }

    /// What the ADC gives of the channel that was asked for.
    fn code(&self, now: &Now) -> i64 {
        let (terminals, [wave, before]) = (self.bench.terminals(), now.wave);
        let (sin, cos) = (TAU * self.bench.profile.turns_per_sample()).sin_cos();
        let fraction = match (now.channel.checked_sub(terminals), now.pad) {
            (None, Some(pad)) => {
                let share = [0.1, 0.06, 0.07, 0.08, 0.05, 0.09][(now.channel + pad) % 6];
                share * (wave * cos - before) / sin
            }
            (None, None) => 0.0,
            (Some(0), _) => 0.8 * wave,
            (Some(_), _) => 0.3,
        };
        self.bench.code(fraction).into()
    }

    /// A clock, and the frame that is finished with it.
    pub fn clock(&self, now: &mut Now, ask: Ask) -> Option<Frame> {
        let strobe = now.count == 0;
        if strobe {
            (now.wave, now.pad) = ([now.carrier, now.wave[0]], now.serve);
        }
        now.count = (now.count + 1) % self.bench.profile.clocks_per_sample;
        let mut inputs = self.inputs(now, ask);
        inputs.strobe = code(strobe.into(), inputs.strobe.format);
        let out = step(&self.core, &mut now.core, inputs);
        now.channel = out.channel.value.0 as usize;
        now.carrier = out.carrier.format.real(out.carrier.value.0);
        now.serve = (out.closed.value.0 != 0).then_some(out.serve.value.0 as usize);
        let port = out.frames;
        if port.valid.value.0 != 0 {
            now.words[port.index.value.0 as usize % 8] = port.frame.value.0;
        }
        let set = |flag: Signal<Bits>| flag.value.0 != 0;
        set(port.done).then(|| Frame {
            pad: port.pad.value.0 as usize,
            codes: now.words,
            flags: Flags {
                clipped: set(port.clipped),
                saturated: set(port.saturated),
                invalid: set(port.invalid),
                lost: set(port.lost),
                lifted: set(port.lifted),
            },
        })
    }

    /// Everything that the next clocks depend on.
    pub fn state(&self, now: &Now) -> Vec<i64> {
        let mut all = Everything(Vec::with_capacity(1 << 14));
        self.core.visit("core", &now.core, &mut all);
        let waves = now.wave.map(|wave| wave.to_bits() as i64);
        let pad = |pad: Option<usize>| pad.map_or(-1, |pad| pad as i64);
        all.0.extend(waves);
        all.0.extend([now.count as i64, now.channel as i64, pad(now.pad), pad(now.serve)]);
        all.0
    }

    /// Takes every register to zero; memories keep their words, as at a reset in hardware.
    pub fn reset(&self, now: &mut Now) {
        self.core.edit(&mut now.core, &mut Zero);
    }
}

/// Out of line: the core is large.
#[inline(never)]
fn step(
    core: &Core,
    state: &mut State<Core, Bits>,
    inputs: Inputs<Signal<Bits>>,
) -> hapticore_model::blocks::core::Outputs<Signal<Bits>> {
    core.clock(state, inputs)
}

/// A profile whose slots are as short as the estimator allows.
fn shortened(mut profile: Profile) -> Profile {
    // The program's loop is the same, however often it is run through.
    profile.position.steps = 4;
    profile.pads = 2;
    profile.slot.open = 2;
    let samples = 4 * profile.samples_per_period().round() as u64;
    let with_settle = |settle: u64| {
        let mut profile = profile.clone();
        profile.slot.settle = settle;
        let profile = profile.with_window(samples);
        hapticore_model::check(&profile).is_ok().then_some(profile)
    };
    (0..1000).find_map(|periods| with_settle(98 + 5 * periods)).expect("a slot that is long enough")
}

struct Everything(Vec<i64>);

impl Visitor<Bits> for Everything {
    fn enter(&mut self, _name: &'static str) {}
    fn register(&mut self, _field: &'static Field, _format: Format, value: Bits) {
        self.0.push(value.0);
    }
    fn memory(&mut self, _memory: &Memory, words: &Words) {
        self.0.extend(words.words.iter().map(|word| word.0));
        self.0.push(words.data.0);
    }
    fn leave(&mut self) {}
}

struct Zero;

impl Edit<Bits> for Zero {
    fn word(&mut self, _format: Format, _value: Bits) -> Bits {
        Bits(0)
    }
    fn memory(&mut self, _memory: &Memory, words: &mut Words) {
        words.data = Bits(0);
    }
}
