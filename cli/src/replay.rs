// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore replay`: recorded ADC samples through the core, in constant memory.

use std::collections::{BTreeMap, VecDeque};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::profile::serving;
use hapticore_host::{DeviceCalibration, Residual, SlotClock, residual};
use hapticore_run::capture::{self, Adc, BROKEN, Cut, Described, Shape, Slots, Source};
use hapticore_run::engine::{Signals, Slot};
use hapticore_run::haptic::Meter;
use hapticore_run::record::{Provenance, Record, Row, Rows};
use hapticore_run::session::Options;
use hapticore_run::session::Session;
use hapticore_run::wiring::Wiring;
use hapticore_run::{calibrate, inputs, interrupt, silent};

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
        sample_rate_hz: Some(device.device.sample_rate_hz),
        truncated: args.truncated,
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
    let mut slots = Slots::new(source.as_mut(), Shape::of(&profile), args.skip.unwrap_or(0))?;
    let left = replay.run(&mut slots, args.core.json)?;
    let of_slots = slots.notes();
    let mut record = replay.finish(name, &profile, args)?;
    record.warnings.extend(of_slots);
    record.warnings.extend(calibration.is_none().then(|| uncalibrated(args)));
    record.warnings.extend(other_pads(args, &device));
    record.warnings.extend(source.notes());
    record.provenance.calibration = calibration;
    output.write("summary.json", summary(&record))?;
    output.write("report.html", report::html(&record))?;
    let files = output.keep()?;
    let silent = silent::text(&profile, device.device.sample_rate_hz);
    print_result(args, &record, (left, &silent), &files);
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

fn other_pads(args: &ReplayArgs, device: &DeviceCalibration) -> Option<String> {
    let pads = args.pads.filter(|pads| *pads != device.pads)?;
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
struct Replay {
    session: Session,
    residual: Residual,
    frames: Frames,
    rows: Thinned,
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
        let (fidelity, errors) = (args.core.fidelity(), args.core.errors);
        let options = Options { fidelity, errors, reference: true };
        Ok(Replay {
            residual: device.residual(&calibration),
            session: Session::new(profile, (device, &calibration), (options, None), (0, clock))?,
            frames: Frames::create(output, None)?,
            rows: Thinned::default(),
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
            start: Instant::now(),
        })
    }

    /// Runs all slots; the samples left over at the end.
    fn run(&mut self, slots: &mut Slots<'_>, quiet: bool) -> Result<usize> {
        let bar = progress::bar(None, "slots", quiet);
        while let Some(cut) = slots.next_slot()? {
            self.slot(cut)?;
            bar.inc(1);
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
        bar.finish_and_clear();
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
            self.frames.row(&row)?;
            self.rows.push(row);
        }
        Ok(())
    }

    fn finish(self, name: String, profile: &Profile, args: &ReplayArgs) -> Result<Record> {
        let of_table = self.residual.warning(residual::LIMIT_MM);
        let mut warnings: Vec<String> = self.wiring.notes();
        warnings.extend(self.meter.warnings(profile));
        warnings.extend(of_table);
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

fn add_flag(row: &mut Row, flag: &str) {
    if !row.flags.is_empty() {
        row.flags.push('+');
    }
    row.flags.push_str(flag);
}

fn print_result(
    args: &ReplayArgs,
    record: &Record,
    (left, silent): (usize, &str),
    files: &[PathBuf],
) {
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
    say!("{silent}");
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
