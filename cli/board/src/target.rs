// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which board a command line means, and what it is brought up with.
//!
//! | name | board |
//! | --- | --- |
//! | `/dev/ttyUSB1` | at a serial port |
//! | `tcp:ADDRESS:PORT` | behind ser2net, or a virtual board in another process |
//! | `virtual`, `virtual:SCENE` | a scene, in this process |

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use hapticore_contract::control::{Control, Law, Tuning};
use hapticore_contract::profile::Profile;
use hapticore_host::link::{Line, Plan, line};
use hapticore_host::startup::AdcSetup;
use hapticore_host::{Dac, DeviceCalibration, Output, Wave};
use hapticore_protocol::framing::packet_bytes;
use hapticore_run::case::Case;
use hapticore_run::columns::Columns;
use hapticore_run::inputs;
use hapticore_run::tuning_file::TuningFile;

use crate::faults::Request;
use crate::virtual_board::{Made, VirtualBoard};
use crate::virtual_line::Running;

/// The scene of `virtual`.
const SCENE: &str = "hockey";
/// Bits a second of a board's line.
const BAUD: u32 = 1_000_000;
/// Of a virtual board whose frames need more.
const FAST_BAUD: u32 = 3_000_000;
/// The clock of the ULX3S.
const CLOCK_HZ: u64 = 25_000_000;

/// What a command line says of a board.
#[derive(Debug, Clone, Default)]
pub struct Asked {
    /// Port, address or `virtual`.
    pub port: String,
    /// Keys of a virtual board's scene.
    pub set: Vec<(String, String)>,
    /// What is wrong with a virtual board.
    pub faults: Vec<Request>,
    /// The device's calibration.
    pub calibration: Option<PathBuf>,
    /// The profile that the board was printed for.
    pub profile: Option<String>,
    /// Bits a second.
    pub baud: Option<u32>,
    /// The law of the controller that it was printed with.
    pub control: Option<String>,
    /// The converter that it was printed for.
    pub dac: Option<String>,
    /// The wave that it was printed for.
    pub wave: Option<String>,
    /// The voltage of a drive word of full scale that it was printed for.
    pub full_scale_v: Option<u16>,
    /// The tuning of its controller.
    pub tuning: Option<PathBuf>,
}

/// A board that can be connected to.
pub struct Target {
    /// Its line.
    pub line: Box<dyn Line>,
    /// What it is brought up with.
    pub plan: Plan,
    /// Its device.
    pub device: DeviceCalibration,
    /// What is to be known of the device besides.
    pub described: Described,
    /// The board itself, where it is a virtual one.
    pub running: Option<Running>,
}

impl Target {
    /// The same board once more, for a connection after this one has ended.
    ///
    /// # Errors
    /// As [`line()`]: the name of a line that is none.
    pub fn again(&self) -> Result<Target> {
        let line: Box<dyn Line> = match &self.running {
            Some(running) => Box::new(running.clone()),
            None => line(&self.line.name(), self.plan.baud).map_err(anyhow::Error::msg)?,
        };
        let Target { plan, device, described, running, .. } = self;
        let (plan, device) = (plan.clone(), device.clone());
        Ok(Target { line, plan, device, described: described.clone(), running: running.clone() })
    }
}

/// Columns of the rows of a board that is brought up with a plan.
pub fn columns(plan: &Plan) -> Columns {
    Columns::of_board(plan.output.is_some(), plan.profile.wall.is_some())
}

/// What a page shows of a device.
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// What the board is.
    pub title: String,
    /// Width and height of the sheet, mm: at least those of the calibration's places.
    pub sheet_mm: [f64; 2],
    /// Diameter of a pad, mm.
    pub pad_diameter_mm: f64,
    /// Where the terminals are, mm, where that is known.
    pub terminals_mm: Vec<[f64; 2]>,
    /// Names of the pads.
    pub pads: Vec<String>,
    /// Where the parts of a pad lie, mm from its centre.
    pub parts_mm: Vec<[f64; 2]>,
    /// The largest drive, V rms, of a board that drives.
    pub rail_v: Option<f64>,
}

/// The board of a command line.
///
/// # Errors
/// A name that is none, a file that cannot be used; the message names option or file, and what was expected.
pub fn target(asked: &Asked) -> Result<Target> {
    let is_virtual = asked.port == "virtual" || asked.port.starts_with("virtual:");
    if is_virtual { virtual_board(asked) } else { real_board(asked) }
}

/// The virtual board of a name alone, not yet running: for programs that step it in device time.
///
/// # Errors
/// As [`target`].
pub fn virtual_device(asked: &Asked) -> Result<VirtualBoard> {
    let scene = asked.port.strip_prefix("virtual:").unwrap_or(SCENE);
    let scene = inputs::scene(scene, &asked.set)?;
    let profile = inputs::profile(asked.profile.as_ref().unwrap_or(&scene.profile))?;
    VirtualBoard::new(scene, 0, &profile, |case| made(case, asked.baud))
}

fn virtual_board(asked: &Asked) -> Result<Target> {
    let printed = [
        ("--control", asked.control.is_some()),
        ("--dac", asked.dac.is_some()),
        ("--wave", asked.wave.is_some()),
        ("--full-scale-v", asked.full_scale_v.is_some()),
    ];
    if let Some((option, _)) = printed.iter().find(|(_, is)| *is) {
        bail!("{option}: expected none with a virtual board: its scene says how it drives");
    }
    let board = virtual_device(asked)?;
    let (case, made) = (board.case().clone(), board.made());
    let device = match &asked.calibration {
        Some(file) => calibration_of(file, case.profile.terminals.x.len())?,
        None => (**case.device).clone(),
    };
    let plant = case.plant()?;
    let tuning = match &asked.tuning {
        Some(file) => Some(TuningFile::read(file, &case.profile)?.tuning()),
        None => case.tuning(&plant)?,
    };
    let of_device = plant.device();
    let described = Described {
        title: format!("virtual board: {}", case.scene.title),
        sheet_mm: [of_device.width_mm, of_device.height_mm],
        pad_diameter_mm: of_device.pad_diameter_mm,
        terminals_mm: of_device.terminals_mm.clone(),
        pads: plant.pad_names().iter().map(|name| name.to_string()).collect(),
        parts_mm: plant.parts_mm().to_vec(),
        rail_v: case.plan().map(|plan| plan.rail_v),
    };
    let running = Running::new(&asked.port, board);
    asked.faults.iter().try_for_each(|fault| fault.act(&running)).context("--fault")?;
    let profile = (*case.profile).clone();
    let plan = plan(&device, profile, (made.output, tuning), made.baud)?;
    Ok(Target { line: Box::new(running.clone()), plan, device, described, running: Some(running) })
}

/// The calibration of a file, for a board of so many terminals.
fn calibration_of(file: &Path, terminals: usize) -> Result<DeviceCalibration> {
    let device = DeviceCalibration::read(file)?;
    let got = device.terminals.x.len();
    ensure!(
        got == terminals,
        "{}: expected a calibration of {terminals} terminals, as the scene's board has, got {got}",
        file.display()
    );
    Ok(device)
}

/// How the virtual board of a case is made.
fn made(case: &Case, baud: Option<u32>) -> Made {
    let output = case.plan().map(|plan| Output {
        dac: Dac::Ad5664r,
        wave: Wave::Dc,
        full_scale_v: plan.full_scale_v.round().clamp(1.0, f64::from(u16::MAX)) as u16,
        clock_hz: CLOCK_HZ,
    });
    let needed = 10.0 * packet_bytes(&case.profile) as f64 / case.clock.seconds(1);
    let fitting = if needed > f64::from(BAUD) { FAST_BAUD } else { BAUD };
    Made { baud: baud.unwrap_or(fitting), clock_hz: CLOCK_HZ as f64, output }
}

fn real_board(asked: &Asked) -> Result<Target> {
    ensure!(asked.set.is_empty(), "--set: expected none: only virtual boards have a scene");
    let baud = asked.baud.unwrap_or(BAUD);
    let line = line(&asked.port, baud).map_err(anyhow::Error::msg)?;
    ensure!(
        asked.faults.is_empty(),
        "--fault: expected none: only virtual boards break on request"
    );
    let Some(file) = &asked.calibration else {
        bail!("--calibration: expected the device's calibration, as hapticore calibrate writes it");
    };
    let device = DeviceCalibration::read(file)?;
    let profile = inputs::profile(asked.profile.as_deref().unwrap_or("standard"))?;
    let profile = inputs::buildable(device.profile(&profile)?)?;
    let profile = match &asked.control {
        Some(law) => with_controller(profile, law)?,
        None => profile,
    };
    let output = output(asked, &profile)?;
    let tuning = match &asked.tuning {
        Some(file) => Some(TuningFile::read(file, &profile)?.tuning()),
        None => None,
    };
    let described = described(&asked.port, &device, output.as_ref(), tuning.as_ref());
    let plan = plan(&device, profile, (output, tuning), baud)?;
    Ok(Target { line, plan, device, described, running: None })
}

fn plan(
    device: &DeviceCalibration,
    profile: Profile,
    (output, tuning): (Option<Output>, Option<Tuning>),
    baud: u32,
) -> Result<Plan> {
    let calibration = device.for_profile(&profile).context("--calibration")?;
    let adc = AdcSetup::default();
    Ok(Plan { profile, calibration, adc, output, tuning, baud, all_lines: false })
}

fn with_controller(profile: Profile, name: &str) -> Result<Profile> {
    let law = Law::ALL.into_iter().find(|law| law.name() == name).with_context(|| {
        let names = Law::ALL.map(Law::name).join(", ");
        format!("--control: expected one of {names}, got \"{name}\"")
    })?;
    let control = Control { law, ..profile.control.clone().unwrap_or(Control::of(&profile, law)) };
    inputs::buildable(Profile { control: Some(control), ..profile })
}

/// What a board with a controller drives its pads with.
fn output(asked: &Asked, profile: &Profile) -> Result<Option<Output>> {
    if profile.control.is_none() {
        ensure!(asked.dac.is_none(), "--dac: expected the controller's law too: --control LAW");
        return Ok(None);
    }
    let Some(dac) = &asked.dac else {
        bail!("--dac: expected the converter that this board with a controller was printed for");
    };
    Ok(Some(Output {
        dac: dac.parse().context("--dac")?,
        wave: Wave::on_board(
            asked.wave.as_deref().unwrap_or("square"),
            profile.frame_clocks(),
            CLOCK_HZ,
        )
        .context("--wave")?,
        full_scale_v: asked.full_scale_v.unwrap_or(Output::FULL_SCALE_V),
        clock_hz: CLOCK_HZ,
    }))
}

/// What a calibration says of its device.
fn described(
    port: &str,
    device: &DeviceCalibration,
    output: Option<&Output>,
    tuning: Option<&Tuning>,
) -> Described {
    let parts = device.parts.max(1);
    let pads = device.pads / parts;
    let reach =
        |axis: usize| device.map.places.iter().map(|place| place[axis].abs()).fold(1.0, f64::max);
    let pad_diameter_mm = device.device.pad_diameter_mm.unwrap_or(30.0);
    let rail = output.zip(tuning);
    Described {
        title: format!("board at {port}"),
        sheet_mm: [0, 1].map(|axis| 2.0 * reach(axis) + pad_diameter_mm),
        pad_diameter_mm,
        terminals_mm: Vec::new(),
        pads: (0..pads).map(|pad| format!("pad {pad}")).collect(),
        parts_mm: vec![[0.0; 2]; parts as usize],
        rail_v: rail.map(|(output, tuning)| f64::from(output.full_scale_v) * tuning.rail),
    }
}
