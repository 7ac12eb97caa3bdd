// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where slots begin in a recording: at the border that is visible in its samples.
//!
//! ```text
//!   slot:  open │ settle │ integrate      while the switch is open no current flows into any terminal
//!   e[n] = Σ_k (i_k[n] − mean of i_k)²    a border is visible where the mean of e over `open` samples is below QUIET of
//!                                         the slots' mean: a carrier of one period or more within `open` has about all of it
//! ```
//!
//! A slot is whole where the next border is one slot behind its own. A slot that is shorter or longer
//! has lost or repeated samples. The pad's last whole slot takes its place, so that the core holds its
//! values, and its frame carries the flag [`BROKEN`]. A `pad` column shows borders, too, and a column
//! of times says how many samples are missing. What was skipped is in [`Slots::notes`].

use std::collections::VecDeque;

use anyhow::{Result, bail, ensure};
use hapticore_contract::profile::Profile;

use super::stream::Source;

/// The flag of a frame whose slot lost or repeated samples: its values are the pad's last.
pub const BROKEN: &str = "broken";

/// The energy of a visible border, as a part of that of the slots about it.
const QUIET: f64 = 0.02;

/// A border is as quiet as any point within `NEAR` samples, up to the factor `ALIKE` and the part
/// `TINY` of the slots' energy.
const NEAR: usize = 4;

/// See [`NEAR`].
const ALIKE: f64 = 4.0;

/// See [`NEAR`].
const TINY: f64 = 1e-5;

/// Parts of a slot, the first and the last of which are compared.
const PART: usize = 10;

/// Currents that differ by more than this part are those of another pad.
const OTHER: f64 = 0.05;

/// The shape of slots.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// Samples of a slot.
    pub samples: usize,
    /// Of them with no pad connected.
    pub open: usize,
    /// Channels of a sample; the sensing and the haptic voltage are the last.
    pub channels: usize,
    /// Pads that are selected in turn.
    pub pads: usize,
    /// A border holds a whole period of the carrier: it can be told from a zero crossing.
    pub is_visible: bool,
}

impl Shape {
    /// That of a profile's slots.
    pub fn of(profile: &Profile) -> Self {
        let slot = &profile.slot;
        Shape {
            samples: slot.samples() as usize,
            open: slot.open as usize,
            channels: profile.channels(),
            pads: profile.pads as usize,
            is_visible: slot.open as f64 >= profile.samples_per_period() - 1.0,
        }
    }
}

/// A slot of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Cut {
    /// Its pad.
    pub pad: usize,
    /// Its codes.
    pub codes: Vec<i32>,
    /// It lost or repeated samples, and has the codes of the pad's last whole slot.
    pub is_broken: bool,
}

/// What was found at a border, or was not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Border {
    /// One is where it should be.
    Here,
    /// The next one is this many samples behind the slot's first.
    After(usize),
    /// None is visible.
    Unseen,
}

/// The slots of a recording, in turn.
pub struct Slots<'a> {
    source: &'a mut dyn Source,
    shape: Shape,
    codes: VecDeque<i32>,
    energies: VecDeque<f64>,
    /// Each sample's pad; none of a sample that is missing.
    pads: VecDeque<Option<usize>>,
    /// Whether each sample is in the recording.
    present: VecDeque<bool>,
    means: Option<Vec<f64>>,
    has_pads: bool,
    missing: u64,
    ended: bool,
    is_aligned: bool,
    was_broken: bool,
    /// Slots that are lost behind a broken one.
    owed: usize,
    /// Samples before the buffer's first.
    at: u64,
    slots: usize,
    last: Vec<Option<Vec<i32>>>,
    row: Vec<i32>,
    notes: Vec<String>,
    unseen: usize,
    broken: usize,
    first_broken: Option<String>,
    is_timed: bool,
}

impl<'a> Slots<'a> {
    /// The slots of a recording behind its first `skip` samples.
    pub fn new(source: &'a mut dyn Source, shape: Shape, skip: u64) -> Result<Self> {
        let mut slots = Slots {
            source,
            shape,
            codes: VecDeque::new(),
            energies: VecDeque::new(),
            pads: VecDeque::new(),
            present: VecDeque::new(),
            means: None,
            has_pads: false,
            missing: 0,
            ended: false,
            is_aligned: false,
            was_broken: false,
            owed: 0,
            at: 0,
            slots: 0,
            last: vec![None; shape.pads],
            row: Vec::new(),
            notes: Vec::new(),
            unseen: 0,
            broken: 0,
            first_broken: None,
            is_timed: false,
        };
        for sample in 0..skip {
            let read = slots.source.row(&mut slots.row)?;
            ensure!(
                read.is_some(),
                "{}: --skip: expected fewer samples than the recording has, {sample}, got {skip}",
                slots.source.place()
            );
            slots.row.clear();
            slots.at += 1;
        }
        Ok(slots)
    }

    /// The next slot; none where no whole one is left.
    ///
    /// # Errors
    /// A recording that cannot be read, or whose pads are not in turn.
    pub fn next_slot(&mut self) -> Result<Option<Cut>> {
        if !self.is_aligned {
            self.align()?;
        }
        let (length, pad) = (self.shape.samples, self.slots % self.shape.pads);
        self.fill(2 * length + self.shape.open)?;
        if self.pads.len() < length {
            return Ok(None);
        }
        if self.owed > 0 {
            self.owed -= 1;
            return Ok(Some(self.held(pad, 0)));
        }
        if self.is_behind(pad) {
            return Ok(Some(self.held(pad, 0)));
        }
        self.check_pad(pad)?;
        let is_whole = |slots: &Self| slots.present.iter().take(length).all(|present| *present);
        let border = self.border();
        let could_be_seen = self.pads.len() >= length + self.shape.open;
        self.unseen += usize::from(could_be_seen && border == Border::Unseen);
        let cut = match border {
            Border::Here | Border::Unseen if is_whole(&*self) => {
                let codes: Vec<i32> =
                    self.codes.iter().take(length * self.shape.channels).copied().collect();
                self.drop_samples(length);
                self.last[pad] = Some(codes.clone());
                (self.slots, self.was_broken) = (self.slots + 1, false);
                Cut { pad, codes, is_broken: false }
            }
            Border::After(samples) => {
                self.owed = usize::from(self.is_of_two_pads(samples));
                self.held(pad, samples)
            }
            _ => self.held(pad, length),
        };
        Ok(Some(cut))
    }

    /// Whether whole slots are lost before this one, by the column of pads.
    fn is_behind(&self, pad: usize) -> bool {
        let front = self.pads.front().copied().flatten();
        self.was_broken && front.is_some_and(|front| front != pad && front < self.shape.pads)
    }

    /// The pad's last whole slot in place of the next `samples` samples.
    fn held(&mut self, pad: usize, samples: usize) -> Cut {
        let at = self.at;
        self.first_broken.get_or_insert_with(|| format!("sample {at}, pad {pad}"));
        self.drop_samples(samples);
        (self.slots, self.broken, self.was_broken) = (self.slots + 1, self.broken + 1, true);
        let codes = self.last[pad].clone();
        let codes = codes.unwrap_or_else(|| vec![0; self.shape.samples * self.shape.channels]);
        Cut { pad, codes, is_broken: true }
    }

    /// Samples of a slot.
    pub fn slot_samples(&self) -> usize {
        self.shape.samples
    }

    /// Samples that are left behind the last whole slot.
    pub fn left(&self) -> usize {
        self.pads.len()
    }

    /// Where the recording is, for messages.
    pub fn place(&self) -> String {
        self.source.place()
    }

    /// What was skipped, replaced, or not visible: users of the frames must know it.
    pub fn notes(&self) -> Vec<String> {
        let name = self.source.place();
        let name = name.rsplit_once(':').map_or(name.as_str(), |(file, _)| file);
        let mut notes = self.notes.clone();
        if let Some(first) = &self.first_broken {
            let turn = if self.has_pads || self.is_timed || self.shape.pads == 1 {
                ""
            } else {
                ". After a loss of more than a slot pads would be numbered wrongly: record a column pad or time"
            };
            notes.push(format!(
                "SAMPLES ARE LOST OR REPEATED: {} of {} slots are broken, the first at {first}. Their frames carry `{BROKEN}` and hold \
                 the pad's last values{turn}",
                self.broken, self.slots
            ));
        }
        if self.shape.is_visible && 2 * self.unseen > self.slots {
            notes.push(format!(
                "no slot borders are visible in {} of {} slots (no current while the switch is open): slots were counted from the first \
                 sample on, and lost samples go unnoticed",
                self.unseen, self.slots
            ));
        }
        if !self.shape.is_visible {
            notes.push(format!(
                "slot borders of {} samples are too short to be seen: slots were counted from the first sample on, and lost samples go \
                 unnoticed",
                self.shape.open
            ));
        }
        notes.iter().map(|note| format!("{name}: {note}")).collect()
    }
}

/// The buffer.
impl Slots<'_> {
    /// Reads until the buffer has `samples` samples or the source ends.
    fn fill(&mut self, samples: usize) -> Result<()> {
        while self.pads.len() < samples && !self.ended {
            if self.missing > 0 {
                self.missing -= 1;
                self.push(None, false);
                continue;
            }
            self.row.clear();
            match self.source.row(&mut self.row)? {
                None => self.ended = true,
                Some(sampled) if sampled.lost > 0 => {
                    (self.missing, self.is_timed) = (sampled.lost, true);
                    let row = std::mem::take(&mut self.row);
                    while self.missing > 0 {
                        self.missing -= 1;
                        self.push(None, false);
                    }
                    self.row = row;
                    self.push(sampled.pad, true);
                }
                Some(sampled) => self.push(sampled.pad, true),
            }
        }
        if self.means.is_none() {
            self.take_means();
        }
        Ok(())
    }

    fn push(&mut self, pad: Option<usize>, is_present: bool) {
        self.has_pads |= pad.is_some();
        if is_present {
            self.codes.extend(&self.row);
        } else {
            self.codes.extend(std::iter::repeat_n(0, self.shape.channels));
        }
        let terminals = self.shape.channels - 2;
        let energy = |means: &Vec<f64>| {
            let off = |(code, mean): (&i32, &f64)| (f64::from(*code) - mean).powi(2);
            self.row[..terminals].iter().zip(means).map(off).sum()
        };
        let energy = if is_present { self.means.as_ref().map_or(0.0, energy) } else { 0.0 };
        self.energies.push_back(energy);
        self.pads.push_back(pad);
        self.present.push_back(is_present);
    }

    /// The currents' means, which are offsets of the ADC, and the energies of what has been read.
    fn take_means(&mut self) {
        let (channels, samples) = (self.shape.channels, self.pads.len().max(1));
        let terminals = channels - 2;
        let mut means = vec![0.0; terminals];
        for (index, code) in self.codes.iter().enumerate() {
            if index % channels < terminals {
                means[index % channels] += f64::from(*code) / samples as f64;
            }
        }
        for (sample, energy) in self.energies.iter_mut().enumerate() {
            let code = |k: usize| f64::from(self.codes[sample * channels + k]);
            *energy = (0..terminals).map(|k| (code(k) - means[k]).powi(2)).sum();
        }
        self.means = Some(means);
    }

    fn drop_samples(&mut self, samples: usize) {
        let samples = samples.min(self.pads.len());
        self.codes.drain(..samples * self.shape.channels);
        self.energies.drain(..samples);
        self.pads.drain(..samples);
        self.present.drain(..samples);
        self.at += samples as u64;
    }
}

/// Borders.
impl Slots<'_> {
    /// Skips to the first border.
    fn align(&mut self) -> Result<()> {
        self.is_aligned = true;
        let (length, open) = (self.shape.samples, self.shape.open);
        self.fill(2 * length + open)?;
        if self.by_pad() {
            return self.align_by_pad();
        }
        if !self.shape.is_visible || self.pads.len() < length + open {
            return Ok(());
        }
        let level = self.level();
        let Some(border) = self.best(0, length, level) else { return Ok(()) };
        if self.is_border(0, level) && self.is_alike(0, border, level) {
            return Ok(());
        }
        if border >= length - open {
            self.put_before(length - border);
            return Ok(());
        }
        self.notes.push(format!(
            "THE RECORDING BEGINS WITHIN A SLOT: {border} samples before the first border were skipped. The first whole slot counts as \
             that of pad 0; --skip N skips more"
        ));
        self.drop_samples(border);
        Ok(())
    }

    /// Whether borders are seen by a column of pads.
    fn by_pad(&self) -> bool {
        self.has_pads && self.shape.pads > 1
    }

    /// Skips to the first whole slot of pad 0.
    fn align_by_pad(&mut self) -> Result<()> {
        let mut skipped = 0;
        while let Some(first) = self.pads.front().copied().flatten() {
            let run = self.pads.iter().take_while(|pad| **pad == Some(first)).count();
            if first == 0 && run >= self.shape.samples {
                break;
            }
            let rest = self.pads.len() == run && self.ended;
            if rest || run > self.shape.samples {
                break;
            }
            skipped += run;
            self.drop_samples(run);
            self.fill(2 * self.shape.samples + self.shape.open)?;
        }
        if skipped > 0 {
            self.notes.push(format!(
                "THE RECORDING BEGINS WITHIN A ROTATION: {skipped} samples before the first whole slot of pad 0 were skipped"
            ));
        }
        Ok(())
    }

    /// Where the border behind the slot at the buffer's front is.
    fn border(&self) -> Border {
        let (length, open) = (self.shape.samples, self.shape.open);
        if self.by_pad() {
            let first = self.pads.front().copied().flatten();
            let run = self.pads.iter().take_while(|pad| pad.is_none() || **pad == first).count();
            return if run < length && run < self.pads.len() {
                Border::After(run)
            } else {
                Border::Here
            };
        }
        if !self.shape.is_visible || self.pads.len() < length + open {
            return Border::Unseen;
        }
        let level = self.level();
        if self.is_border(length, level) {
            return Border::Here;
        }
        let end = (2 * length).min(self.pads.len() - open);
        let found = (open + 1..end).find(|at| self.quietness(*at) <= QUIET * level);
        let found = found.and_then(|at| self.best(at, (at + open).min(end), level));
        found.map_or(
            Border::Unseen,
            |at| if at == length { Border::Here } else { Border::After(at) },
        )
    }

    /// The mean energy of a sample of the larger of the two slots that are read.
    fn level(&self) -> f64 {
        let length = self.shape.samples;
        let mean =
            |from: usize| self.energies.iter().skip(from).take(length).sum::<f64>() / length as f64;
        mean(0).max(mean(length))
    }

    /// The mean energy of the samples of a border that would begin here.
    fn quietness(&self, at: usize) -> f64 {
        let open = self.shape.open;
        self.energies.range(at..at + open).sum::<f64>() / open as f64
    }

    /// Whether a border begins here: it is quiet, and not as if it began some samples before or
    /// behind.
    fn is_border(&self, at: usize, level: f64) -> bool {
        let quiet = self.quietness(at);
        let last = self.pads.len() - self.shape.open;
        let (from, to) = (at.saturating_sub(NEAR), (at + NEAR).min(last));
        let is_least = |near: usize| self.is_alike(at, near, level);
        quiet <= QUIET * level && (from..=to).all(is_least)
    }

    /// Whether a place is as quiet as another.
    fn is_alike(&self, at: usize, other: usize, level: f64) -> bool {
        self.quietness(at) <= ALIKE * self.quietness(other) + TINY * level
    }

    /// Whether `samples` samples, more than a slot has, are of two pads whose border is lost: the
    /// currents' proportions in the first and in the last part differ.
    fn is_of_two_pads(&self, samples: usize) -> bool {
        let (open, channels) = (self.shape.open, self.shape.channels);
        if samples <= self.shape.samples || self.by_pad() || self.shape.pads == 1 {
            return false;
        }
        let part = (self.shape.samples / PART).max(1);
        let energies = |from: usize| -> Vec<f64> {
            let of = |k: usize| {
                let code = |at: usize| f64::from(self.codes[at * channels + k]);
                (from..from + part).map(|at| code(at).powi(2)).sum::<f64>().sqrt()
            };
            (0..channels - 2).map(of).collect()
        };
        let (first, last) = (energies(open), energies(samples - part));
        let off: f64 = first.iter().zip(&last).map(|(a, b)| (a - b).abs()).sum();
        off > OTHER * first.iter().chain(&last).sum::<f64>()
    }

    /// Puts samples before the first: a recording that begins within the time that the switch is
    /// open lacks nothing else.
    fn put_before(&mut self, samples: usize) {
        for _ in 0..samples {
            (0..self.shape.channels).for_each(|_| self.codes.push_front(0));
            self.energies.push_front(0.0);
            self.pads.push_front(None);
            self.present.push_front(true);
        }
        self.at = self.at.saturating_sub(samples as u64);
    }

    /// The quietest place among these, where it is quiet enough.
    fn best(&self, from: usize, to: usize, level: f64) -> Option<usize> {
        let best = (from..to).min_by(|a, b| self.quietness(*a).total_cmp(&self.quietness(*b)))?;
        (self.quietness(best) <= QUIET * level && level > 0.0).then_some(best)
    }

    /// Checks the column of pads against the rotation.
    fn check_pad(&mut self, pad: usize) -> Result<()> {
        let Some(got) = self.pads.front().copied().flatten() else { return Ok(()) };
        let length = self.shape.samples;
        let runs_on = self.pads.iter().take(length + 1).all(|next| *next == Some(got));
        let behind = self.pads.get(length).copied().flatten().filter(|_| self.by_pad() && runs_on);
        let (wanted, slot, got) = match behind {
            _ if got != pad => (pad, self.slots, got),
            Some(next) => ((pad + 1) % self.shape.pads, self.slots + 1, next),
            None => return Ok(()),
        };
        let pads = self.shape.pads;
        bail!(
            "{}: sample {}: pad: expected {wanted} in slot {slot} of a rotation of {pads}, with slots of {length} samples, got {got}; --pads \
             and --profile say otherwise",
            self.source.place(),
            self.at + if behind.is_some() && wanted != pad { length as u64 } else { 0 },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::Sampled;

    const SHAPE: Shape = Shape { samples: 60, open: 10, channels: 4, pads: 3, is_visible: true };

    /// Codes with the slot's number as the haptic voltage, and what a column says of each.
    struct Samples(std::vec::IntoIter<([i32; 4], Sampled)>);

    impl Source for Samples {
        fn row(&mut self, codes: &mut Vec<i32>) -> Result<Option<Sampled>> {
            Ok(self.0.next().map(|(row, sampled)| {
                codes.extend(row);
                sampled
            }))
        }

        fn sample_rate_hz(&self) -> Option<f64> {
            None
        }

        fn place(&self) -> String {
            "c.csv:7".into()
        }
    }

    fn samples(slots: usize, has_pads: bool) -> Vec<([i32; 4], Sampled)> {
        let sample = |n: usize| {
            let (slot, at) = (n / 60, n % 60);
            let wave = (1e4 * (at as f64 * 0.635).sin()) as i32;
            let current = if at < 10 { 3 - 7 * (at as i32 % 2) } else { wave };
            let pad = has_pads.then_some(slot % 3);
            ([current, -current / 2, wave, slot as i32], Sampled { pad, lost: 0 })
        };
        (0..60 * slots).map(sample).collect()
    }

    /// Pads, numbers of the slots whose codes they have, and which of them are broken; the notes.
    fn cut(samples: Vec<([i32; 4], Sampled)>, skip: u64) -> (Vec<(usize, i32, bool)>, Vec<String>) {
        let mut source = Samples(samples.into_iter());
        let mut slots = Slots::new(&mut source, SHAPE, skip).unwrap();
        let mut cuts = Vec::new();
        while let Some(Cut { pad, codes, is_broken }) = slots.next_slot().unwrap() {
            assert_eq!(codes.len(), 240);
            assert!(
                codes.iter().skip(3).step_by(4).all(|slot| *slot == codes[3]),
                "of one slot alone"
            );
            cuts.push((pad, codes[3], is_broken));
        }
        (cuts, slots.notes())
    }

    #[test]
    fn a_whole_recording_is_cut_as_it_is() {
        for has_pads in [false, true] {
            let (cuts, notes) = cut(samples(9, has_pads), 0);
            assert_eq!(cuts, (0..9).map(|n| (n as usize % 3, n, false)).collect::<Vec<_>>());
            assert!(notes.is_empty(), "{notes:?}");
        }
    }

    #[test]
    fn a_recording_that_begins_while_the_switch_is_open_lacks_nothing() {
        for first in [1, 5, 9, 10] {
            let (cuts, notes) = cut_codes(samples(9, false).split_off(first));
            assert_eq!((cuts.len(), notes.len()), (9, 0), "{first}: {notes:?}");
            let haptic = |codes: &Vec<i32>| codes[43];
            assert!(cuts.iter().map(haptic).eq(0..9), "{first}");
        }
    }

    /// The codes of all slots, and the notes.
    fn cut_codes(samples: Vec<([i32; 4], Sampled)>) -> (Vec<Vec<i32>>, Vec<String>) {
        let mut source = Samples(samples.into_iter());
        let mut slots = Slots::new(&mut source, SHAPE, 0).unwrap();
        let mut cuts = Vec::new();
        while let Some(cut) = slots.next_slot().unwrap() {
            cuts.push(cut.codes);
        }
        (cuts, slots.notes())
    }

    #[test]
    fn what_comes_before_the_first_border_is_skipped_and_said() {
        for first in [12, 33, 59] {
            let (cuts, notes) = cut(samples(9, false).split_off(first), 0);
            assert_eq!(
                cuts,
                (0..8).map(|n| (n as usize % 3, n + 1, false)).collect::<Vec<_>>(),
                "{first}"
            );
            assert!(
                notes[0].starts_with("c.csv: ")
                    && notes[0].contains(&format!(" {} samples", 60 - first)),
                "{notes:?}"
            );
            let (cuts, notes) = cut(samples(9, true).split_off(first), 0);
            assert_eq!(cuts[0], (0, 3, false), "{first}: from pad 0 on");
            assert_eq!(notes.len(), 1);
        }
        let (cuts, notes) = cut(samples(9, false).split_off(33), 27 + 120);
        assert_eq!((cuts[0], notes.len()), ((0, 3, false), 0));
    }

    #[test]
    fn a_slot_that_lost_or_repeated_samples_is_replaced_and_those_behind_are_whole() {
        for (from, to) in [(13, 50), (20, 31), (12, 24), (30, 58), (33, 34)] {
            for has_pads in [false, true] {
                let mut lost = samples(12, has_pads);
                lost.drain(5 * 60 + from..5 * 60 + to);
                let mut repeated = samples(12, has_pads);
                let again = repeated[5 * 60 + from..5 * 60 + to].to_vec();
                repeated.splice(5 * 60 + from..5 * 60 + from, again);
                for (samples, is_lost) in [(lost, true), (repeated, false)] {
                    if has_pads && !is_lost {
                        continue;
                    }
                    let (cuts, notes) = cut(samples, 0);
                    let expected =
                        |n: i32| if n == 5 { (2, 2, true) } else { (n as usize % 3, n, false) };
                    assert_eq!(
                        cuts,
                        (0..12).map(expected).collect::<Vec<_>>(),
                        "{from} {to} {is_lost}"
                    );
                    assert!(notes[0].contains("the first at sample 300, pad 2"), "{notes:?}");
                }
            }
        }
    }

    #[test]
    fn with_a_column_lost_slots_leave_the_pads_in_turn() {
        let mut of_pads = samples(12, true);
        of_pads.drain(5 * 60 + 13..7 * 60 + 20);
        let (cuts, _) = cut(of_pads, 0);
        assert_eq!(cuts[5..9], [(2, 2, true), (0, 3, true), (1, 4, true), (2, 8, false)]);
        let mut timed = samples(12, false);
        timed.drain(5 * 60 + 13..7 * 60 + 20);
        timed[5 * 60 + 13].1.lost = 127;
        let (cuts, notes) = cut(timed, 0);
        assert_eq!(cuts.len(), 12);
        assert!(cuts[5..8].iter().all(|(_, _, is_broken)| *is_broken) && cuts[8] == (2, 8, false));
        assert!(!notes[0].contains("numbered wrongly"), "{notes:?}");
    }
}
