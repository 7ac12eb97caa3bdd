// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs of a core, clock by clock: the calibration through its port, then sets of ADC codes.
//! And the inputs of a block alone, one operation after the other.

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::sync::Arc;

use fastrand::Rng;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Memory;
use hapticore_model::blocks::core::{Core, Inputs, Outputs};
use hapticore_model::blocks::position::TablePort;
use hapticore_run::case::Case;
use hapticore_run::engine::Signals;
use hapticore_run::inputs;
use hapticore_run::maker::Maker;

/// What the core receives of the plant: sets of codes, one for each strobe.
pub type Samples = Box<dyn Iterator<Item = Vec<i64>>>;

/// A stimulus for [`Trace::record`](crate::lockstep::Trace::record).
pub struct Stimulus {
    constants: Inputs<i64>,
    formats: Inputs<Format>,
    /// Words of the calibration that are still to be written.
    table: Box<dyn Iterator<Item = (i64, i64)>>,
    samples: Samples,
    codes: Vec<i64>,
    clock: u64,
    clocks_per_sample: u64,
    /// Other constants with each slot of this many clocks.
    recalibrate: Option<(Rng, u64)>,
    /// Writes into the table while it is in use.
    disturb: Option<(Rng, Memory)>,
}

impl Stimulus {
    /// The inputs of the next clock.
    pub fn next(&mut self, outputs: &[i64]) -> Option<Vec<i64>> {
        let inputs = match self.table.next() {
            Some((address, word)) => {
                self.constants.with_table(TablePort { write: 1, address, word })
            }
            None => self.sample(outputs)?,
        };
        let mut codes = Vec::with_capacity(Inputs::FIELDS.len());
        Inputs::each(inputs, |_, code| codes.push(code));
        Some(codes)
    }

    /// What stays, addresses and words of the table, and the sets of codes.
    pub fn into_parts(self) -> (Inputs<i64>, impl Iterator<Item = (i64, i64)>, Samples) {
        (self.constants, self.table, self.samples)
    }

    fn sample(&mut self, outputs: &[i64]) -> Option<Inputs<i64>> {
        let strobe = self.clock.is_multiple_of(self.clocks_per_sample);
        if strobe {
            self.codes = self.samples.next()?;
        }
        if let Some((rng, _)) =
            self.recalibrate.as_mut().filter(|(_, slot)| self.clock.is_multiple_of(*slot))
        {
            self.constants = Inputs::map(self.formats, |format| anything(rng, format));
        }
        self.clock += 1;
        let channel =
            Outputs::FIELDS.iter().position(|field| field.name == "channel").expect("a port");
        let code = self.codes[outputs[channel] as usize];
        let inputs = Inputs { strobe: i64::from(strobe), code, ..self.constants };
        Some(match &mut self.disturb {
            Some((rng, table)) => disturbed(inputs, rng, table),
            None => inputs,
        })
    }
}

/// The ends of a format's range, their neighbours and those of zero, and otherwise anything.
pub fn corner(rng: &mut Rng, format: Format) -> i64 {
    let (low, high) = (format.min_code() as i64, format.max_code() as i64);
    match rng.u8(..8) {
        0 => low,
        1 => high,
        2 => (low + 1).min(high),
        3 => 0,
        4 => 1.min(high),
        5 => (-1).max(low),
        _ => rng.i64(low..=high),
    }
}

/// Any code, each alike.
fn anything(rng: &mut Rng, format: Format) -> i64 {
    rng.i64(format.min_code() as i64..=format.max_code() as i64)
}

/// A corner, any code, one of two bits, or of ones, or one of any length with any number of zeros
/// at its end. Products of such codes are of every size, and halves, or what is next to them, come
/// often where they are rounded.
pub fn shaped(rng: &mut Rng, format: Format) -> i64 {
    match rng.u8(..8) {
        0 => corner(rng, format),
        1 | 2 => anything(rng, format),
        kind => {
            let length = rng.u8(..=format.width.min(61));
            let (code, zeros) = (rng.i64(0..1 << length), rng.u8(..=length));
            let code = match kind {
                3 => (1 << length) + (1 << zeros),
                4 => (1 << length) - 1,
                _ => code >> zeros << zeros,
            };
            let code = if format.min_code() == 0 || rng.bool() { code } else { -code };
            code.clamp(format.min_code() as i64, format.max_code() as i64)
        }
    }
}

/// Operations of a block alone: operands that hold while it works, one cycle of `start`, and idle
/// cycles until some clocks after `done`. Where words stream in (`valid`, `index`), all of them
/// follow one after the other. A table of `words` words is filled first, and some of it is written
/// anew before each operation. Operands are [`shaped`], or one of them is such that its product
/// with another ends in a one, zeros and a one, next to a half. A block without `done` has `clocks`
/// clocks.
///
/// # Panics
/// Where the block has neither `start` nor `valid`.
pub fn operations<B: Block>(
    block: &B,
    seed: u64,
    operations: usize,
    words: i64,
    clocks: u32,
) -> impl FnMut(&[i64]) -> Option<Vec<i64>> + use<B> {
    let mut rng = Rng::with_seed(seed);
    let (formats, outputs) =
        (ports::<B::Inputs>(block.inputs()), ports::<B::Outputs>(block.outputs()));
    let names: Vec<_> = formats.iter().map(|(name, _)| *name).collect();
    let at = move |wanted: &str| names.iter().position(|name| *name == wanted);
    let done = outputs.iter().position(|(name, _)| *name == "done");
    let mut operands = vec![0; formats.len()];
    let mut script: VecDeque<Vec<i64>> = VecDeque::new();
    let (mut left, mut first, mut waiting) = (operations, true, 0);
    let mut alike = Rng::with_seed(!seed);
    move |outputs| {
        waiting = if done.is_some_and(|done| outputs[done] == 1) {
            0_u32
        } else {
            waiting.saturating_sub(1)
        };
        if script.is_empty() && waiting == 0 {
            left = left.checked_sub(1)?;
            waiting = if done.is_some() { 1 << 20 } else { clocks };
            operands = formats.iter().map(|&(_, format)| shaped(&mut rng, format)).collect();
            next_to_half(&mut rng, &mut operands, &formats);
            if let Some(window) = at("window") {
                // The oscillator's window is not negative, and the demodulator relies on it.
                operands[window] = operands[window].abs().min(formats[window].1.max_code() as i64);
            }
            let strobes = ["start", "valid", "write"].map(&at);
            strobes.iter().flatten().for_each(|&strobe| operands[strobe] = 0);
            let with = |of: &[(Option<usize>, i64)]| {
                let mut row = operands.clone();
                of.iter().for_each(|&(port, code)| row[port.expect("a port")] = code);
                row
            };
            if let (Some(_), Some(word)) = (strobes[2], at("word")) {
                let addresses: Vec<_> = if first {
                    (0..words).collect()
                } else {
                    (0..8).map(|_| rng.i64(0..words)).collect()
                };
                for address in addresses {
                    let code = shaped(&mut rng, formats[word].1);
                    script.push_back(with(&[
                        (strobes[2], 1),
                        (at("address"), address),
                        (Some(word), code),
                    ]));
                }
            }
            first = false;
            (0..rng.u8(..4)).for_each(|_| script.push_back(operands.clone()));
            if strobes[0].is_some() {
                script.push_back(with(&[(strobes[0], 1)]));
            } else {
                let (index, sum) = (at("index").expect("a port"), at("sum").expect("a port"));
                // Now and then all of one sign and about one size: of words that are not saturated,
                // the total is.
                let size = alike.bool().then(|| formats[sum].1.max_code() as i64 >> alike.u8(..12));
                for word in 0..=words {
                    let code = size.map_or_else(
                        || shaped(&mut rng, formats[sum].1),
                        |size| size - alike.i64(0..=size / 4),
                    );
                    script.push_back(with(&[
                        (strobes[1], 1),
                        (Some(index), word),
                        (Some(sum), code),
                    ]));
                }
            }
        }
        Some(script.pop_front().unwrap_or_else(|| operands.clone()))
    }
}

/// The names and formats of a bundle's ports: of its fields, those that are there.
pub fn ports<S: Bundle>(formats: S::Of<Format>) -> Vec<(&'static str, Format)> {
    let mut ports = Vec::new();
    S::each(formats, |field, format| {
        ports.extend((!format.is_none()).then_some((field.name, format)));
    });
    ports
}

/// Now and then, makes one operand such that the lowest bits of its product with another, odd one
/// are a one, zeros and a one.
fn next_to_half(rng: &mut Rng, operands: &mut [i64], formats: &[(&str, Format)]) {
    let (a, b) = (rng.usize(..operands.len()), rng.usize(..operands.len()));
    let (width, low) = (formats[b].1.width.min(32), formats[b].1.min_code() as i64);
    if a == b || operands[a] % 2 == 0 || rng.bool() {
        return;
    }
    // Newton's iteration for 1/a modulo 2^64: from 3 bits that are right to 96.
    let odd = operands[a];
    let inverse = (0..5).fold(odd, |x, _| x.wrapping_mul(2_i64.wrapping_sub(odd.wrapping_mul(x))));
    let wanted = 1 + (1 << rng.u8(width / 2..=width));
    operands[b] = (inverse.wrapping_mul(wanted) & ((1 << width) - 1)) + low;
}

/// Writes into the table while it is read, now and then.
fn disturbed(inputs: Inputs<i64>, rng: &mut Rng, table: &Memory) -> Inputs<i64> {
    let write = i64::from(rng.u8(..16) == 0);
    inputs.with_table(TablePort {
        write,
        address: rng.i64(0..table.words as i64),
        word: corner(rng, table.format),
    })
}

/// Slots of a scene's first case, each used for every pad of the profile in turn where the scene
/// has fewer.
///
/// # Panics
/// Where there is no such scene.
pub fn scene(profile: &Profile, name: &str, slots: usize) -> Stimulus {
    let scene = Arc::new(inputs::scene(name, &[]).expect("bundled"));
    let case = Case::new(&scene, 0, profile, &[]).expect("a case");
    let calibration = case.calibration().expect("a calibration").clone();
    let mut maker = Maker::new(case.plant().expect("a plant"), &case.profile, true, true);
    let (channels, last) = (profile.channels(), case.slots);
    let samples = (0..slots).flat_map(move |slot| {
        let Signals::Samples { codes, .. } = maker.sample(slot % last).0 else {
            unreachable!("it was asked for samples")
        };
        codes
            .chunks_exact(channels)
            .map(|set| set.iter().map(|&code| code.into()).collect())
            .collect::<Vec<Vec<i64>>>()
    });
    let core = Core::new(profile);
    let formats = core.inputs();
    let words: Vec<_> = calibration
        .words(profile)
        .into_iter()
        .map(|word| formats.calibration.table.word.code_saturating(word))
        .collect();
    Stimulus {
        constants: core.idle_inputs(&calibration),
        formats,
        table: Box::new(
            words.into_iter().enumerate().map(|(address, word)| (address as i64, word)),
        ),
        samples: Box::new(samples),
        codes: vec![0; channels],
        clock: 0,
        clocks_per_sample: profile.clocks_per_sample,
        recalibrate: None,
        disturb: None,
    }
}

/// Tones in step with the carrier, of any phase, or all of one, and of no, small, full or clipped
/// amplitude. Each slot has other tones and another calibration, with tables as of [`random`].
/// Where random codes average out, these fill every word. In half of the slots they begin late: of
/// a tone that lasts, a window's cosine adds nothing to the sum, whatever its sign.
pub fn tones(profile: &Profile, seed: u64, slots: u64) -> Stimulus {
    let (mut rng, channels, adc) = (Rng::with_seed(!seed), profile.channels(), profile.formats.adc);
    let (samples, turns_per_sample) = (profile.slot.samples(), profile.turns_per_sample());
    let tone = |rng: &mut Rng| (rng.f64(), [0.0, 0.01, 0.1, 0.5, 0.9, 1.0, 3.0][rng.usize(..7)]);
    let mut onsets = Rng::with_seed(seed ^ 1 << 32);
    let others: Vec<bool> = profile.terminals.x.iter().map(|&sign| sign <= 0).collect();
    let slot = move |slot| {
        let onset = if onsets.bool() { 0 } else { onsets.u64(..samples) };
        let mut tones: Vec<(f64, f64)> = (0..channels).map(|_| tone(&mut rng)).collect();
        if rng.bool() {
            let one = tones[0].0;
            tones.iter_mut().for_each(|(phase, _)| *phase = one);
        }
        if slot % 4 == 3 {
            // All current at the terminals on the right: a ratio of one, the largest word there is.
            tones
                .iter_mut()
                .zip(&others)
                .filter(|(_, other)| **other)
                .for_each(|((_, level), _)| *level = 0.0);
        }
        (0..samples).map(move |sample| {
            let turns = sample as f64 * turns_per_sample;
            let code = |&(phase, level): &(f64, f64)| match sample < onset {
                true => 0,
                false => adc.code_saturating(level * (TAU * (turns + phase)).cos()),
            };
            tones.iter().map(code).collect()
        })
    };
    let recalibrate = Some((Rng::with_seed(seed), samples * profile.clocks_per_sample));
    Stimulus {
        samples: Box::new((0..slots).flat_map(slot)),
        recalibrate,
        ..random(profile, seed, 0)
    }
}

/// Anything at all, corners more than their share: calibration, tables written while they are read,
/// and codes.
pub fn random(profile: &Profile, seed: u64, slots: u64) -> Stimulus {
    let mut rng = Rng::with_seed(seed);
    let core = Core::new(profile);
    let memory = core.estimator().table();
    let constants = Inputs::map(core.inputs(), |format| corner(&mut rng, format));
    let table: Vec<i64> = (0..memory.words).map(|_| corner(&mut rng, memory.format)).collect();
    let (channels, adc, disturb) = (profile.channels(), profile.formats.adc, (rng.fork(), memory));
    let samples = (0..slots * profile.slot.samples())
        .map(move |_| (0..channels).map(|_| corner(&mut rng, adc)).collect());
    Stimulus {
        constants: Inputs { strobe: 0, clear: 0, code: 0, ..constants }
            .with_table(TablePort::of(0)),
        formats: core.inputs(),
        table: Box::new(
            table.into_iter().enumerate().map(|(address, word)| (address as i64, word)),
        ),
        samples: Box::new(samples),
        codes: vec![0; channels],
        clock: 0,
        clocks_per_sample: profile.clocks_per_sample,
        recalibrate: None,
        disturb: Some(disturb),
    }
}
