// SPDX-License-Identifier: MIT OR Apache-2.0
//! Recorded ADC samples through the core, in constant memory: rows go to a sink as they are finished.

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::profile::serving;
use hapticore_host::{DeviceCalibration, Residual, SlotClock, residual};

use crate::capture::{self, Adc, BROKEN, Cut, Described, Shape, Slots, Source};
use crate::engine::{Fidelity, Signals, Slot};
use crate::findings::{Findings, Tally};
use crate::haptic::Meter;
use crate::record::{Provenance, Quantities, Record, Row, Rows};
use crate::session::{MOST_PADS, Options, Session};
use crate::wiring::Wiring;
use crate::{calibrate, inputs, interrupt, provenance, silent};

/// The profile where none is named.
const PROFILE: &str = "standard";

/// What is replayed, and how.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The capture: NAME.csv, NAME.wav, NAME.sigmf-meta, or - for standard input.
    pub capture: PathBuf,
    /// The device's calibration; where none is named that beside the capture, else the nominal device's.
    pub calibration: Option<PathBuf>,
    /// The core's profile: a bundled name or a file.
    pub profile: Option<String>,
    /// How exactly the core is run.
    pub fidelity: Fidelity,
    /// Whether rounding errors are asked for.
    pub errors: bool,
    /// Whether the floating-point reference runs on the same samples.
    pub reference: bool,
    /// How many pads are selected in turn.
    pub pads: Option<u64>,
    /// What the channels of the capture are, in their order.
    pub channels: Option<Vec<String>>,
    /// Bits of integer codes.
    pub bits: Option<u8>,
    /// Volts at the end of the ADC's range, where samples are volts.
    pub full_scale_v: Option<f64>,
    /// Samples left out at the beginning.
    pub skip: u64,
    /// Whether a file that is cut short is taken.
    pub truncated: bool,
}

impl Plan {
    /// Checks numbers that no capture has.
    fn check(&self) -> Result<()> {
        let pads = self.pads.unwrap_or(1);
        ensure!((1..=MOST_PADS).contains(&pads), "--pads: expected 1 to {MOST_PADS}, got {pads}");
        let bits = self.bits.unwrap_or(2);
        ensure!((2..=32).contains(&bits), "--bits: expected 2 to 32, got {bits}");
        let volts = self.full_scale_v.unwrap_or(1.0);
        ensure!(
            volts > 0.0 && volts.is_finite(),
            "--full-scale-v: expected a number above 0, got {volts}"
        );
        Ok(())
    }
}

/// What a replay leaves besides its rows.
pub struct Replayed {
    /// The record, without rows.
    pub record: Record,
    /// Samples at the end that are no whole slot.
    pub left: usize,
    /// What no check of a recording can see.
    pub silent: String,
}

/// Replays a capture; `sink` takes each row, `progress` is called after each slot.
///
/// # Errors
/// Bad input, an interruption, what the sink returns.
pub fn run(
    plan: &Plan,
    sink: &mut dyn FnMut(Row) -> Result<()>,
    progress: &dyn Fn(),
) -> Result<Replayed> {
    plan.check()?;
    let profile = inputs::profile(plan.profile.as_deref().unwrap_or(PROFILE))?;
    let calibration = calibration(plan);
    let device = match &calibration {
        Some(path) => DeviceCalibration::read(path)?,
        None => calibrate::nominal(&profile)?,
    };
    let profile = inputs::buildable(device.profile(&profile)?)?;
    let adc = Adc { terminals: profile.terminals.x.len(), format: profile.formats.adc };
    let described = Described {
        channels: plan.channels.clone(),
        bits: plan.bits,
        full_scale_v: plan.full_scale_v,
        sample_rate_hz: Some(device.device.sample_rate_hz),
        truncated: plan.truncated,
    };
    let mut source = capture::open(&plan.capture, adc, &described)?;
    let profile = Arc::new(serving(&profile, plan.pads.unwrap_or(device.pads) as usize));
    check_rate(source.as_ref(), &device, &profile)?;
    let named = || {
        calibration
            .as_ref()
            .map_or("the nominal calibration".into(), |path| path.display().to_string())
    };
    let mut replay = Replay::new(plan, &profile, &device, sink).with_context(named)?;
    let mut slots = Slots::new(source.as_mut(), Shape::of(&profile), plan.skip)?;
    let left = replay.run(&mut slots, progress)?;
    let of_slots = slots.notes();
    let mut record = replay.finish(&profile, plan);
    record.warnings.extend(of_slots);
    record.warnings.extend(calibration.is_none().then(|| uncalibrated(plan)));
    record.warnings.extend(other_pads(plan, &device));
    record.warnings.extend(source.notes());
    record.provenance.calibration = calibration;
    Ok(Replayed { record, left, silent: silent::text(&profile, device.device.sample_rate_hz) })
}

/// The calibration named, or that of the capture.
fn calibration(plan: &Plan) -> Option<PathBuf> {
    let of_capture = Some(capture::calibration_path(&plan.capture)).filter(|path| path.exists());
    plan.calibration.clone().or(of_capture)
}

fn uncalibrated(plan: &Plan) -> String {
    format!(
        "{}: NO CALIBRATION. Every position, capacitance and force was computed for the paper's display (860 × 500 mm, six \
         terminals), not for the device that was recorded; --calibration FILE names its own",
        plan.capture.display()
    )
}

fn other_pads(plan: &Plan, device: &DeviceCalibration) -> Option<String> {
    let pads = plan.pads.filter(|pads| *pads != device.pads)?;
    Some(format!(
        "--pads {pads}: the calibration is of {} pads; where the recording has as many, every frame is of another pad than it names",
        device.pads
    ))
}

/// Checks that capture, calibration and profile are of one sample rate and one carrier.
fn check_rate(source: &dyn Source, device: &DeviceCalibration, profile: &Profile) -> Result<()> {
    let (rate, carrier) = (device.device.sample_rate_hz, device.device.carrier_hz);
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
    if let Some(got) = source.sample_rate_hz().filter(|got| !same(*got, rate)) {
        bail!(
            "{}: sample_rate_hz: expected {rate}, as in the calibration, got {got}: the core samples its carrier {} times a \
             period, so resample the capture, or calibrate at its rate",
            source.place(),
            profile.samples_per_period()
        );
    }
    let (samples, name) = (profile.samples_per_period(), &profile.name);
    ensure!(
        same(rate, carrier * samples),
        "--profile {name}: carrier: expected {} samples per period, as in the calibration, got {samples}",
        rate / carrier
    );
    Ok(())
}

/// A capture on its way through the core.
struct Replay<'a> {
    session: Session,
    residual: Residual,
    /// Takes each row, whole.
    sink: &'a mut dyn FnMut(Row) -> Result<()>,
    clock: SlotClock,
    blanking_codes: usize,
    channels: usize,
    meter: Meter,
    wiring: Wiring,
    /// Flags of slots whose rows are still to come.
    flags: VecDeque<Vec<String>>,
    waiting: Vec<Row>,
    /// That of all frames, once it is decided.
    channels_flag: Option<Option<&'static str>>,
    pads: usize,
    slots: usize,
    tally: Tally,
    start: Instant,
    date: String,
}

impl<'a> Replay<'a> {
    fn new(
        plan: &Plan,
        profile: &Arc<Profile>,
        device: &DeviceCalibration,
        sink: &'a mut dyn FnMut(Row) -> Result<()>,
    ) -> Result<Self> {
        let clock = SlotClock::new(profile, device.device.sample_rate_hz, 0.0);
        let channels = profile.channels();
        let calibration = device.for_profile(profile)?;
        let options =
            Options { fidelity: plan.fidelity, errors: plan.errors, reference: plan.reference };
        Ok(Replay {
            residual: device.residual(&calibration),
            session: Session::new(profile, (device, &calibration), (options, None), (0, clock))?,
            sink,
            clock,
            blanking_codes: profile.slot.blanking() as usize * channels,
            channels,
            meter: Meter::new(profile, device.device.sample_rate_hz),
            wiring: Wiring::new(profile, device, &calibration),
            flags: VecDeque::new(),
            waiting: Vec::new(),
            channels_flag: None,
            pads: profile.pads as usize,
            slots: 0,
            tally: Tally::default(),
            start: Instant::now(),
            date: provenance::now(),
        })
    }

    /// Runs all slots; the samples left over at the end.
    fn run(&mut self, slots: &mut Slots<'_>, progress: &dyn Fn()) -> Result<usize> {
        while let Some(cut) = slots.next_slot()? {
            self.slot(cut)?;
            progress();
        }
        ensure!(
            self.slots > 0,
            "{}: expected samples of one slot at least, {}, got {}",
            slots.place(),
            slots.slot_samples(),
            slots.left()
        );
        let last = self.session.finish()?;
        last.into_iter().try_for_each(|row| self.row(row))?;
        self.write()?;
        Ok(slots.left())
    }

    /// Takes a whole slot to the core.
    fn slot(&mut self, Cut { pad, codes, is_broken }: Cut) -> Result<()> {
        interrupt::check()?;
        let mut flags = vec![BROKEN.to_string()];
        if !is_broken {
            self.meter.append((self.slots, pad), &codes, self.channels);
            flags = self.wiring.window(&codes[self.blanking_codes..]);
        }
        self.flags.push_back(flags);
        let slot = Slot { pad, signals: Signals::Samples { codes, blanking: self.blanking_codes } };
        let row = self.session.slot(&slot, None)?;
        row.into_iter().try_for_each(|row| self.row(row))?;
        self.slots += 1;
        Ok(())
    }

    fn row(&mut self, mut row: Row) -> Result<()> {
        for flag in self.flags.pop_front().unwrap_or_default() {
            add_flag(&mut row, &flag);
        }
        self.waiting.push(row);
        if self.channels_flag.is_none() && !self.wiring.is_decided() {
            return Ok(());
        }
        self.write()
    }

    /// Writes the rows that waited until order and gains of the channels could be judged.
    fn write(&mut self) -> Result<()> {
        let flag = *self.channels_flag.get_or_insert_with(|| self.wiring.flag());
        for mut row in std::mem::take(&mut self.waiting) {
            flag.into_iter().for_each(|flag| add_flag(&mut row, flag));
            self.tally.add(&row);
            (self.sink)(row)?;
        }
        Ok(())
    }

    fn finish(self, profile: &Profile, plan: &Plan) -> Record {
        let of_table = self.residual.warning(residual::LIMIT_MM);
        let mut warnings: Vec<String> = self.wiring.notes();
        warnings.extend(self.meter.warnings(profile));
        warnings.extend(of_table);
        let pads: Vec<_> = (0..self.pads).map(|pad| format!("pad {pad}")).collect();
        let flagged = self.tally.flagged("main", &pads);
        Record {
            title: format!("Replay of {}", plan.capture.display()),
            scene: plan.capture.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            summary: "Recorded ADC samples, replayed.".into(),
            figure: None,
            profile: profile.name.clone(),
            fidelity: plan.fidelity.name().into(),
            cases: vec!["main".into()],
            pads,
            effects: Vec::new(),
            criteria: Vec::new(),
            force_laws: None,
            errors: self.session.errors(),
            simulated_seconds: self.clock.seconds(self.slots),
            wall_seconds: self.start.elapsed().as_secs_f64(),
            findings: Findings { flagged, ..Findings::default() },
            warnings,
            position_table: Some(self.residual),
            sheet_mm: None,
            swept: Vec::new(),
            laws: BTreeMap::new(),
            gains: BTreeMap::new(),
            stability: BTreeMap::new(),
            bode: Vec::new(),
            date: self.date,
            codes: Quantities::default(),
            provenance: Provenance::new(),
            rows: Rows::default(),
        }
    }
}

fn add_flag(row: &mut Row, flag: &str) {
    if !row.flags.is_empty() {
        row.flags.push('+');
    }
    row.flags.push_str(flag);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_no_capture_has_are_refused_before_it_is_opened() {
        let plan = Plan {
            capture: "no-such.csv".into(),
            calibration: None,
            profile: None,
            fidelity: Fidelity::Fixed,
            errors: false,
            reference: false,
            pads: None,
            channels: None,
            bits: None,
            full_scale_v: None,
            skip: 0,
            truncated: false,
        };
        let wrong = [
            ("--pads", Plan { pads: Some(0), ..plan.clone() }),
            ("--pads", Plan { pads: Some(257), ..plan.clone() }),
            ("--bits", Plan { bits: Some(1), ..plan.clone() }),
            ("--bits", Plan { bits: Some(33), ..plan.clone() }),
            ("--full-scale-v", Plan { full_scale_v: Some(0.0), ..plan.clone() }),
            ("--full-scale-v", Plan { full_scale_v: Some(f64::NAN), ..plan.clone() }),
        ];
        let refusal = |plan: &Plan| {
            run(plan, &mut |_| Ok(()), &|| ()).err().map(|error| format!("{error:#}"))
        };
        for (flag, plan) in wrong {
            let message = refusal(&plan).expect("an error");
            assert!(message.starts_with(flag), "{message}");
        }
        assert!(refusal(&plan).expect("an error").contains("no-such.csv"));
    }
}
