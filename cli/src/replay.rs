// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore replay`: recorded ADC samples through the core, in constant memory.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::profile::serving;
use hapticore_host::{DeviceCalibration, Residual, SlotClock, residual};
use hapticore_run::capture::{self, Adc, Described, Source};
use hapticore_run::engine::{Signals, Slot};
use hapticore_run::haptic::{self, Meter};
use hapticore_run::record::{Provenance, Record, Row, Rows};
use hapticore_run::session::Session;
use hapticore_run::{calibrate, inputs, interrupt};

use crate::args::ReplayArgs;
use crate::output::{Frames, Output, summary};
use crate::{console, folder, print, progress, report, say};

/// The profile where none is named.
const PROFILE: &str = "standard";

/// Rows kept for the report: of longer captures every second, fourth, … row.
const MOST_ROWS: usize = 1 << 15;

/// Replays a capture.
///
/// # Errors
/// Bad input, files that cannot be written, an interruption; then nothing is written.
pub fn run(args: &ReplayArgs) -> Result<bool> {
    let profile = inputs::profile(args.core.profile.as_deref().unwrap_or(PROFILE))?;
    let calibration = calibration(args);
    let device = match &calibration {
        Some(path) => DeviceCalibration::read(path)?,
        None => calibrate::nominal(&profile)?,
    };
    let profile = inputs::buildable(device.profile(&profile)?)?;
    let adc = Adc { terminals: profile.terminals.x.len(), format: profile.formats.adc };
    let described = Described {
        channels: args.channels.clone(),
        bits: args.bits,
        full_scale_v: args.full_scale_v,
    };
    let mut source = capture::open(&args.capture, adc, &described)?;
    let pads = args.pads.unwrap_or(device.pads);
    let profile = Arc::new(serving(&profile, pads as usize));
    check_rate(source.as_ref(), &device, &profile)?;
    let name = args.capture.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = args.out.clone().unwrap_or_else(|| folder::of_capture(args));
    let output = Output::new(&folder)?;
    let named = || {
        calibration
            .as_ref()
            .map_or("the nominal calibration".into(), |path| path.display().to_string())
    };
    let mut replay = Replay::new(args, &profile, &device, &output).with_context(named)?;
    let left = replay.run(source.as_mut(), args.core.json)?;
    let mut record = replay.finish(name, &profile, args)?;
    record.warnings.extend(calibration.is_none().then(|| uncalibrated(args)));
    record.warnings.extend(source.notes());
    record.provenance.calibration = calibration;
    output.write("summary.json", summary(&record))?;
    output.write("report.html", report::html(&record))?;
    let files = output.keep()?;
    print_result(args, &record, left, &files);
    Ok(true)
}

/// The calibration named, or that of the capture.
fn calibration(args: &ReplayArgs) -> Option<PathBuf> {
    let of_capture = Some(capture::calibration_path(&args.capture)).filter(|path| path.exists());
    args.calibration.clone().or(of_capture)
}

fn uncalibrated(args: &ReplayArgs) -> String {
    format!(
        "{}: NO CALIBRATION. Every position, capacitance and force was computed for the paper's display (860 × 500 mm, six \
         terminals), not for the device that was recorded; --calibration FILE names its own",
        args.capture.display()
    )
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
struct Replay {
    session: Session,
    residual: Residual,
    frames: Frames,
    rows: Thinned,
    clock: SlotClock,
    slot_codes: usize,
    blanking_codes: usize,
    channels: usize,
    meter: Meter,
    sample_rate_hz: f64,
    pads: usize,
    slots: usize,
    start: Instant,
}

impl Replay {
    fn new(
        args: &ReplayArgs,
        profile: &Arc<Profile>,
        device: &DeviceCalibration,
        output: &Output,
    ) -> Result<Self> {
        let clock = SlotClock::new(profile, device.device.sample_rate_hz, 0.0);
        let channels = profile.channels();
        let calibration = device.for_profile(profile)?;
        Ok(Replay {
            residual: device.residual(&calibration),
            session: Session::new(
                profile,
                (device, &calibration),
                (args.core.fidelity(), None),
                args.core.errors,
                (0, clock),
            )?,
            frames: Frames::create(output, None)?,
            rows: Thinned::default(),
            clock,
            slot_codes: profile.slot.samples() as usize * channels,
            blanking_codes: profile.slot.blanking() as usize * channels,
            channels,
            meter: Meter::default(),
            sample_rate_hz: device.device.sample_rate_hz,
            pads: profile.pads as usize,
            slots: 0,
            start: Instant::now(),
        })
    }

    /// Runs all slots; the samples left over at the end.
    fn run(&mut self, source: &mut dyn Source, quiet: bool) -> Result<usize> {
        let bar = progress::bar(None, quiet);
        let mut codes = Vec::with_capacity(self.slot_codes);
        while let Some(sampled) = source.row(&mut codes)? {
            let pad = self.slots % self.pads;
            if let Some(got) = sampled.pad.filter(|got| *got != pad) {
                let slot = self.slots;
                bail!(
                    "{}: pad: expected {pad} in slot {slot} of a rotation of {}, got {got}",
                    source.place(),
                    self.pads
                );
            }
            if codes.len() == self.slot_codes {
                codes = self.slot(pad, codes)?;
                bar.inc(1);
            }
        }
        let (samples, got) = (self.slot_codes / self.channels, codes.len() / self.channels);
        ensure!(
            self.slots > 0,
            "{}: expected samples of one slot at least, {samples}, got {got}",
            source.place()
        );
        let last = self.session.finish();
        last.into_iter().try_for_each(|row| self.row(row))?;
        bar.finish_and_clear();
        Ok(codes.len() / self.channels)
    }

    /// Takes a whole slot to the core; its buffer, emptied.
    fn slot(&mut self, pad: usize, codes: Vec<i32>) -> Result<Vec<i32>> {
        interrupt::check()?;
        self.meter.append(&codes, self.channels);
        let slot = Slot { pad, signals: Signals::Samples { codes, blanking: self.blanking_codes } };
        let row = self.session.slot(&slot, None);
        row.into_iter().try_for_each(|row| self.row(row))?;
        self.slots += 1;
        match slot.signals {
            Signals::Samples { mut codes, .. } => {
                codes.clear();
                Ok(codes)
            }
            Signals::Phasors { .. } => unreachable!("a capture has samples"),
        }
    }

    fn row(&mut self, row: Row) -> Result<()> {
        self.frames.row(&row)?;
        self.rows.push(row);
        Ok(())
    }

    /// Says where the core's window is too short for the haptic voltage that was recorded.
    fn haptic_warning(&self, profile: &Profile) -> Option<String> {
        let full_scale = 1.0 / profile.formats.adc.lsb();
        let (Ok(frequency) | Err(frequency)) =
            self.meter.frequency(full_scale)?.map_err(|samples| 1.0 / samples);
        haptic::warning(profile, frequency * self.sample_rate_hz, self.sample_rate_hz)
    }

    fn finish(self, name: String, profile: &Profile, args: &ReplayArgs) -> Result<Record> {
        let of_table = self.residual.warning(residual::LIMIT_MM);
        let warnings = self.haptic_warning(profile).into_iter().chain(of_table).collect();
        self.frames.finish()?;
        Ok(Record {
            title: format!("Replay of {}", args.capture.display()),
            scene: name,
            summary: "Recorded ADC samples, replayed.".into(),
            figure: None,
            profile: profile.name.clone(),
            fidelity: args.core.fidelity().name().into(),
            cases: vec!["main".into()],
            pads: (0..self.pads).map(|pad| format!("pad {pad}")).collect(),
            effects: Vec::new(),
            criteria: Vec::new(),
            force_laws: None,
            errors: self.session.errors(),
            simulated_seconds: self.clock.seconds(self.slots),
            wall_seconds: self.start.elapsed().as_secs_f64(),
            findings: Default::default(),
            warnings,
            position_table: Some(self.residual),
            sheet_mm: None,
            swept: Vec::new(),
            laws: BTreeMap::new(),
            gains: BTreeMap::new(),
            stability: BTreeMap::new(),
            bode: Vec::new(),
            provenance: Provenance::new(),
            rows: Rows::of_cases([self.rows.kept]),
        })
    }
}

fn print_result(args: &ReplayArgs, record: &Record, left: usize, files: &[PathBuf]) {
    print::warnings(record);
    if args.core.json {
        console::print(format_args!("{}", summary(record)));
        return;
    }
    let core = args.core.fidelity();
    say!("{} · core {} · profile {}", record.title, core.name(), record.profile);
    if left > 0 {
        say!("{left} samples at the end are no whole slot and were left out");
    }
    print::finish(record, files);
}

/// Rows evenly thinned, so that they stay few.
struct Thinned {
    kept: Vec<Row>,
    every: usize,
    seen: usize,
}

impl Default for Thinned {
    fn default() -> Self {
        Thinned { kept: Vec::new(), every: 1, seen: 0 }
    }
}

impl Thinned {
    fn push(&mut self, row: Row) {
        if self.seen.is_multiple_of(self.every) {
            self.kept.push(row);
        }
        self.seen += 1;
        if self.kept.len() > MOST_ROWS {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
        }
    }
}
