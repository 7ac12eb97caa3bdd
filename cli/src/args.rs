// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::LazyLock;

use clap::{Parser, Subcommand, ValueEnum};
use hapticore_run::engine::Fidelity;
use hapticore_run::provenance;

mod host;

use host::HOST;
pub use host::HostArgs;

/// Simulate, replay and inspect the hapticore sensing core.
#[derive(Debug, Parser)]
#[command(version = VERSION.as_str(), after_help = EXIT)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Version and commit.
static VERSION: LazyLock<String> = LazyLock::new(provenance::version);

const EXIT: &str = "Exit status: 0 all criteria pass, 1 one fails, 2 bad input.";

/// Subcommands of `hapticore`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the bundled scenes: their cases, effects and criteria
    Scenes(ScenesArgs),
    /// Print every table and key that a scene may have, with meaning, unit, default and range
    #[command(after_help = REFERENCE)]
    Reference(ReferenceArgs),
    /// Write a commented scene, profile or set-up that runs as it is
    #[command(after_help = NEW)]
    New(NewArgs),
    /// Run a scene through the core and check its criteria
    #[command(after_help = SIMULATE)]
    Simulate(SimulateArgs),
    /// Run recorded ADC samples through the core
    #[command(after_help = REPLAY)]
    Replay(ReplayArgs),
    /// Print the core as Verilog, alone or with all that a board needs for a bitstream
    #[command(after_help = HDL)]
    Hdl(HdlArgs),
    /// Print what a core's registers and position table take: a device's calibration as codes
    #[command(after_help = CODES)]
    Codes(CodesArgs),
    /// Tell what accuracy costs: errors of profiles, predicted and measured, beside latency and area
    #[command(after_help = TRADEOFF)]
    Tradeoff(TradeoffArgs),
    /// Run a plan of many points on all cores or many hosts, and collect what they are off and cost
    #[command(after_help = SWEEP, args_conflicts_with_subcommands = true)]
    Sweep(SweepArgs),
    /// Make a device's calibration from what was measured of it: places, loads, full scales
    #[command(after_help = CALIBRATE)]
    Calibrate(CalibrateArgs),
    /// Show a scene in a browser, in real time: drag pads, press them, move walls
    #[command(after_help = LIVE)]
    Live(LiveArgs),
    /// Connect to a board, real or virtual: start it up, show and record what it measures, check its wiring
    #[command(after_help = HOST)]
    Host(HostArgs),
}

const SIMULATE: &str = "Examples:
  hapticore simulate fig6
  hapticore simulate fig3 --case rest --set sheet.terminal_ohm=500
  hapticore simulate hockey --core clock --waves vcd
  hapticore simulate hockey --capture hockey.wav && hapticore replay hockey.wav

Exit status: 0 all criteria pass, 1 one fails, 2 bad input.";

const REPLAY: &str = "A capture is CSV (a header naming columns among i1 … i6, v_sense, v_haptic, pad; one row of integer codes per ADC
sample; lines \"# key = value\" before it may give sample_rate_hz, bits and, for volts, full_scale_v), WAV (channels in that order;
integers of 16 to 32 bits or floats; RIFF or RF64) or SigMF (real samples). CSV of oscilloscopes is read with --channels. Slots begin
where no current flows, while the switch is open.

Examples:
  hapticore replay hockey.wav
  hapticore replay scope.csv --channels _,i1,i2,i3,i4,i5,i6,v_sense,v_haptic --full-scale-v 10
  recorder | hapticore replay - --calibration mine.toml

Exit status: 0 done, 2 bad input.";

const HDL: &str = "Examples:
  hapticore hdl --board ulx3s --out build && build/build.sh
  hapticore hdl --profile small --out verilog
  hapticore hdl --calibration mine.toml --out verilog
  hapticore hdl --profile fast --control inverse --dac ad5664 --out verilog

A print takes the place of an earlier one in its folder. Names of modules begin with hapticore_ and the profile's name.

Exit status: 0 done, 2 bad input.";

const TRADEOFF: &str = "Each word of the profile is made longer and shorter, and the window too, one after the other. Errors are RMS, of the core
against the ideal estimator on the same samples before any ADC. With --target the cheapest profile that meets it is
searched, verified by running it, and written as profile.toml.

Examples:
  hapticore tradeoff
  hapticore tradeoff --profile small --scene fig6
  hapticore tradeoff --scene fig9                      # drive words, too
  hapticore tradeoff --target force=1mN,position=0.1mm

Exit status: 0 done, 1 no profile that was found meets the target, 2 bad input.";

/// Arguments of `tradeoff`.
#[derive(Debug, Clone, clap::Args)]
pub struct TradeoffArgs {
    /// The profile that is varied: a bundled name (small, standard, fine, fast) or a TOML file
    /// [default: standard]
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// A scene that profiles are tried on: its first case, of a force loop the first that is closed; may be
    /// given several times [default: fig3, fig6, hockey]
    #[arg(long, value_name = "SCENE")]
    pub scene: Vec<String>,
    /// Slots of each scene; of force loops and split pads twenty times as many, from the beginning on
    #[arg(long, value_name = "N", default_value_t = 96)]
    pub slots: usize,
    /// Search the cheapest profile with these errors at most: force=1mN,position=0.1mm,capacitance=0.1%
    #[arg(long, value_name = "ERRORS")]
    pub target: Option<String>,
    /// The FPGA family whose LUT4 a search saves [default: ice40 where the profile's multipliers take at most
    /// 16 bits, else ecp5]
    #[arg(long, value_name = "FAMILY", value_parser = ["ecp5", "ice40"])]
    pub family: Option<String>,
    /// Also tell what one more bit of each word that is searched would buy
    #[arg(long)]
    pub explain: bool,
    /// Also synthesise the profile, and the one that was found, for both FPGA families: takes minutes, and
    /// the tools that synth/tools fetches
    #[arg(long)]
    pub synth: bool,
    /// Where results go
    #[arg(long, value_name = "DIR", default_value = "out/tradeoff")]
    pub out: PathBuf,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
}

const SWEEP: &str = "A plan is TOML: a scene, a profile, and what of both is varied (docs/sweep.md). A point is named by the hash of all that it is
made of: what is in the store is done, by whatever host, and what is collected has the same bytes.

Examples:
  hapticore sweep plan.toml
  hapticore sweep plan.toml --store shared/store --list > chunks.jsonl
  parallel hapticore sweep run --store shared/store {} :::: chunks.jsonl
  hapticore sweep collect plan.toml --store shared/store
  hapticore sweep submit plan.toml --store shared/store --engine hq --dry-run

Exit status: 0 done, 1 a point is missing, 2 bad input, or a host that differs.";

/// Arguments of `sweep`.
#[derive(Debug, Clone, clap::Args)]
pub struct SweepArgs {
    /// One of the steps alone.
    #[command(subcommand)]
    pub step: Option<SweepStep>,
    /// The plan, and where its points and results are.
    #[command(flatten)]
    pub places: Option<SweepPlaces>,
    /// Print the plan as chunks of some seconds instead, one line of JSON each
    #[arg(long)]
    pub list: bool,
    /// How many points are run at a time [default: one per processor core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
}

/// A plan and its folders.
#[derive(Debug, Clone, clap::Args)]
pub struct SweepPlaces {
    /// The plan, a TOML file
    pub plan: PathBuf,
    /// The folder of all that was run; several plans and hosts may share it [default:
    /// out/sweep/PLAN/store]
    #[arg(long, value_name = "DIR")]
    pub store: Option<PathBuf>,
    /// Where results go [default: a folder results beside the store]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
}

/// Steps of `sweep`.
#[derive(Debug, Clone, Subcommand)]
pub enum SweepStep {
    /// Run chunks: lines of `--list`. Points that are in the store are done
    Run {
        /// The folder of all that was run
        #[arg(long, value_name = "DIR")]
        store: PathBuf,
        /// A line, or - for lines from standard input
        line: String,
    },
    /// Collect what was run, and list what is missing
    Collect(SweepPlaces),
    /// Hand a plan's chunks to an engine
    Submit {
        /// The plan and its folders.
        #[command(flatten)]
        places: SweepPlaces,
        /// What distributes chunks
        #[arg(long, value_enum)]
        engine: SweepEngine,
        /// Print the commands instead of running them
        #[arg(long)]
        dry_run: bool,
    },
}

/// What distributes chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SweepEngine {
    /// HyperQueue
    Hq,
    /// A Slurm array
    Slurm,
    /// GNU parallel
    Parallel,
    /// Snakemake
    Snakemake,
}

const CALIBRATE: &str = "Each file is known by what is in it:
  places  CSV: x_mm, y_mm, v_sense [V], and per terminal i1 … iN [A], or with phase i1, i1_deg … or i1_re, i1_im …; maybe sheet_ohm
  loads   CSV: haptic_v_rms, force_n or friction_n and load_g, and capacitance_pf or i_total (or i1 …) and v_sense
  setup   TOML: pads, sample_rate_hz, carrier_hz, current_full_scale_a, sense_full_scale_v, haptic_full_scale_v; maybe mu,
          gravity_m_s2, force_k, [terminals] x, y, places_mm, [sheet] width_mm, height_mm, ohm_per_square, terminal_ohm
Currents and v_sense are amplitudes (peak), places mm from the sheet's middle. docs/calibrate.md says more.
Without places, capacitances under loads give the [gap] of a scene:
  CSV: load_n or load_g, capacitance_pf, maybe run
  TOML: [device] pad_diameter_mm, [gap] insulator_um, insulator_permittivity

Examples:
  hapticore calibrate places.csv loads.csv device.toml --out mine.toml
  hapticore calibrate c-over-load.csv pad.toml --out gap.toml

Exit status: 0 done, 2 bad input, or data that do not tell what is asked of them.";

/// Arguments of `calibrate`.
#[derive(Debug, Clone, clap::Args)]
pub struct CalibrateArgs {
    /// What was measured: places and loads as CSV, full scales and rates as TOML; or capacitances under loads, for a
    /// scene's `[gap]`
    #[arg(required = true)]
    pub data: Vec<PathBuf>,
    /// The profile whose position table is tried on the places: a bundled name or a TOML file
    /// [default: standard]
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// Where the calibration goes, and FILE.report.html beside it
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
}

const LIVE: &str = "Only this machine reaches the page, unless --listen names another address. docs/live.md describes page and messages.

Examples:
  hapticore live
  hapticore live hockey --open
  hapticore live peg --set wall.surface_mm=0 --speed 0.1 --port 0

Exit status: 0 ended by Ctrl-C, 2 bad input.";

/// Arguments of `live`.
#[derive(Debug, Clone, clap::Args)]
pub struct LiveArgs {
    /// A bundled scene (see `hapticore scenes`) or a TOML file
    #[arg(default_value = "peg")]
    pub scene: String,
    /// Set a key of the scene: sensor.noise_ppm_rms=40, wall.surface_mm=0
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// The case, by its name or its number from 0 [default: the first]
    #[arg(long, value_name = "CASE")]
    pub case: Option<String>,
    /// The core's profile: a bundled name (small, standard, fine, fast) or a TOML file
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// How exactly the core is run
    #[arg(long, value_enum, default_value_t = Core::Fixed)]
    pub core: Core,
    /// The port of the page; 0 takes a free one
    #[arg(long, value_name = "PORT", default_value_t = 8091)]
    pub port: u16,
    /// Open the page in a browser
    #[arg(long)]
    pub open: bool,
    /// Device time by wall time: 0.1 is ten times slower, 0 begins paused
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    pub speed: f64,
    /// Let other machines reach the page at this address of this machine; 0.0.0.0 for all
    #[arg(long, value_name = "ADDRESS", requires = "token")]
    pub listen: Option<std::net::IpAddr>,
    /// What others must have in the page's address, as ?token=TOKEN
    #[arg(long, value_name = "TOKEN", requires = "listen", value_parser = token)]
    pub token: Option<String>,
}

const CODES: &str = "csv: name, address, code, value, format; constants have no address. readmemh: two's complement in hexadecimal, a word a
line, the position table from address 0 on and the constants behind it, in the order in which they stand there. c: a header.
All begin with comments that say what they are of. Of a profile with a force controller its words follow: settings, then curve,
targets and, where the profile has walls, surfaces.

Terminals and pads of a bundled profile become those of the calibration, as with `hapticore hdl --calibration FILE`.

Examples:
  hapticore codes --calibration mine.toml --format readmemh --out codes.hex
  hapticore codes --profile small --calibration mine.toml --format c > codes.h
  hapticore codes --profile out/fig9/profile.toml --tuning out/fig9/tuning.toml

Exit status: 0 done, 2 bad input.";

/// Arguments of `codes`.
#[derive(Debug, Clone, clap::Args)]
pub struct CodesArgs {
    /// The core's profile: a bundled name (small, standard, fine, fast) or a TOML file [default:
    /// standard]
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// The device's calibration [default: the paper's display's]
    #[arg(long, value_name = "FILE")]
    pub calibration: Option<PathBuf>,
    /// The tuning of the profile's force controller, as `simulate` writes it beside a scene's frames
    /// [default: all words as after a reset, which drive nothing]
    #[arg(long, value_name = "FILE")]
    pub tuning: Option<PathBuf>,
    /// What is printed
    #[arg(long, value_enum, default_value_t = CodesFormat::Csv)]
    pub format: CodesFormat,
    /// Where it goes [default: standard output]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// How codes are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CodesFormat {
    /// CSV table
    Csv,
    /// For Verilog's $readmemh
    Readmemh,
    /// C header
    C,
}

/// Arguments of `hdl`.
#[derive(Debug, Clone, clap::Args)]
pub struct HdlArgs {
    /// A board: its top, constraints and a script that makes a bitstream, too; of a command with the feature `boards`
    #[arg(long, value_name = "ulx3s|icebreaker")]
    pub board: Option<String>,
    /// Bits a second of the board's serial line [default: 1000000; fast with 4,000 frames a second needs 3000000]
    #[arg(long, value_name = "N", requires = "board")]
    pub baud: Option<u64>,
    /// The core's profile: a bundled name (small, standard, fine, fast) or a TOML file [default: the
    /// board's, else standard]
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// A device's calibration, whose terminals and pads a bundled profile takes
    #[arg(long, value_name = "FILE")]
    pub calibration: Option<PathBuf>,
    /// Prints the core with a force controller of this law [default: as the profile has it]
    #[arg(long, value_name = "open|proportional|integral|inverse")]
    pub control: Option<String>,
    /// Prints the pins of a converter for the controller's drives: one bit of sigma-delta per pad, a
    /// serial converter of 4 or 8 channels, or a word of 16 bits with address and write strobe
    #[arg(long, value_name = "pulses|ad5664|ad5664r|ad5668|parallel")]
    pub dac: Option<String>,
    /// The voltage of a drive word of full scale: the board reports it, and a host that means another is refused
    #[arg(long, value_name = "VOLTS", default_value_t = 500, requires = "dac", value_parser = clap::value_parser!(u16).range(1..))]
    pub full_scale_v: u16,
    /// The clock of a top of your own, without --board: words that cease are zero after 100 ms of it
    #[arg(long, value_name = "HERTZ", default_value_t = 25_000_000, requires = "dac", conflicts_with = "board", value_parser = clap::value_parser!(u64).range(1_000_000..=200_000_000))]
    pub clock_hz: u64,
    /// Its wave: a square turns with every SLOTS slots of a pad, by default with as many as take 4.2 ms; a sine has a
    /// period of CLOCKS
    #[arg(
        long,
        value_name = "dc|square[:SLOTS]|sine:CLOCKS",
        default_value = "square",
        requires = "dac"
    )]
    pub wave: String,
    /// Where the files go
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `scenes`.
#[derive(Debug, clap::Args)]
pub struct ScenesArgs {
    /// Tell all of one scene: what it is about, its cases, pads, effects and criteria
    #[arg(long, value_name = "NAME")]
    pub show: Option<String>,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
}

const REFERENCE: &str = "Examples:
  hapticore reference                       # all tables
  hapticore reference wall                  # a table, as gap, pad, pad.position_mm or stimulus
  hapticore reference gap.rung              # a key; a name without a table finds it in all tables
  hapticore reference criteria              # measures; columns: quantities and columns
  hapticore reference profile               # also calibration, of which [calibration] is a scene's table; live messages
  hapticore reference --schema > scene.schema.json
  hapticore reference --man ~/.local/share/man/man1 && man hapticore-simulate

An editor with a TOML language server takes the schema by a first line \"#:schema ./scene.schema.json\" of the scene.

Exit status: 0 done, 2 bad input.";

/// Arguments of `reference`.
#[derive(Debug, clap::Args)]
pub struct ReferenceArgs {
    /// A table or a key of scenes: wall, wall.force_n, force_n; or scene, columns, criteria, profile, calibration, messages
    /// [default: scene]
    pub key: Option<String>,
    /// Print it as JSON
    #[arg(long, conflicts_with_all = ["markdown", "schema"])]
    pub json: bool,
    /// Print it as Markdown
    #[arg(long, conflicts_with = "schema")]
    pub markdown: bool,
    /// Print a JSON Schema, for editors: of scenes, or with profile, calibration, messages of those
    #[arg(long)]
    pub schema: bool,
    /// Write the manual pages of all commands into a folder, such as ~/.local/share/man/man1
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["key", "json", "markdown", "schema"])]
    pub man: Option<PathBuf>,
}

const NEW: &str = "Examples:
  hapticore new scene mine.toml && hapticore simulate mine.toml
  hapticore new profile words.toml && hapticore simulate fig6 --profile words.toml

Exit status: 0 done, 2 bad input, or there is such a file.";

/// Arguments of `new`.
#[derive(Debug, clap::Args)]
pub struct NewArgs {
    /// What is written
    #[arg(value_enum)]
    pub kind: NewKind,
    /// The file, which must not exist
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

/// What `new` writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum NewKind {
    /// A scene with cases and criteria
    Scene,
    /// A core's word lengths, counts and timings
    Profile,
    /// A scene with a virtual wall
    Wall,
    /// A scene with a force loop
    Loop,
    /// What is known of a display before it is measured, for calibrate
    Calibration,
}

/// Arguments that choose how the core is run.
#[derive(Debug, Clone, clap::Args)]
pub struct CoreArgs {
    /// How exactly the core is run
    #[arg(long, value_enum, default_value_t = Core::Fixed)]
    pub core: Core,
    /// The core's profile: a bundled name (small, standard, fine, fast) or a TOML file
    #[arg(long, value_name = "PROFILE")]
    pub profile: Option<String>,
    /// Also find the rounding error of every signal, against the same signal without rounding
    #[arg(long)]
    pub errors: bool,
    /// Print results as JSON
    #[arg(long)]
    pub json: bool,
    /// Print warnings and errors alone; the exit status tells the rest
    #[arg(short, long)]
    pub quiet: bool,
    /// Also print what effects cost, the seed, version and commit
    #[arg(short, long, conflicts_with = "quiet")]
    pub verbose: bool,
}

/// Arguments of `simulate`.
#[derive(Debug, Clone, clap::Args)]
pub struct SimulateArgs {
    /// A bundled scene (see `hapticore scenes`) or a TOML file
    pub scene: String,
    /// How the core is run.
    #[command(flatten)]
    pub core: CoreArgs,
    /// Set a key of the scene: sheet.terminal_ohm=500, pad.0.load_g=50, sensor.quantisation_bits=12
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_value)]
    pub set: Vec<(String, String)>,
    /// Run only the cases of these names
    #[arg(long, value_name = "NAME")]
    pub case: Vec<String>,
    /// Write waveforms of the core's signals, with a save file for GTKWave
    #[arg(long, value_enum)]
    pub waves: Option<Waves>,
    /// What to write waveforms of, in seconds of the first case [default: the first two slots]
    #[arg(long, value_name = "FROM..TO", value_parser = window)]
    pub waves_window: Option<Range<f64>>,
    /// Save the ADC samples of the case that is run, and a calibration beside them for `hapticore
    /// replay`
    #[arg(long, value_name = "FILE.csv|FILE.wav")]
    pub capture: Option<PathBuf>,
    /// Measure the force loops about this force, N: a sine on the drive, and one on the target, at
    /// one frequency after the other
    #[arg(long, value_name = "NEWTONS", value_parser = above_zero)]
    pub bode: Option<f64>,
    /// Run a force loop that is predicted to be unstable
    #[arg(long)]
    pub unstable: bool,
    /// Where results go [default: out/SCENE and what differs from the default, as
    /// out/fig6-pad.0.load_g=50]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `replay`.
#[derive(Debug, Clone, clap::Args)]
pub struct ReplayArgs {
    /// A capture: NAME.csv, NAME.wav, NAME.sigmf-meta, or - for CSV or WAV from standard input
    pub capture: PathBuf,
    /// How the core is run.
    #[command(flatten)]
    pub core: CoreArgs,
    /// The device's calibration [default: CAPTURE.calibration.toml where there is one, else the
    /// nominal device's]
    #[arg(long, value_name = "FILE")]
    pub calibration: Option<PathBuf>,
    /// How many pads are selected in turn [default: as in the calibration, else in the profile]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=256))]
    pub pads: Option<u64>,
    /// What the columns or channels of the capture are, in their order; _ leaves one out [default:
    /// as its header says, else i1 … iN, v_sense, v_haptic and perhaps pad]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub channels: Option<Vec<String>>,
    /// Bits of integer codes that are at the bottom of wider samples, or have no `# bits` in CSV
    #[arg(long, value_name = "BITS", value_parser = clap::value_parser!(u8).range(2..=32))]
    pub bits: Option<u8>,
    /// The samples are volts at the ADC, this many at the end of its range (CSV, floats)
    #[arg(long, value_name = "VOLTS", value_parser = above_zero)]
    pub full_scale_v: Option<f64>,
    /// Leave out this many samples at the beginning, so that the next whole slot is that of pad 0
    #[arg(long, value_name = "SAMPLES")]
    pub skip: Option<u64>,
    /// Take what is there of a file that is cut short, or whose head names more samples
    #[arg(long)]
    pub truncated: bool,
    /// Where results go [default: out/replay-CAPTURE and what differs from the default]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// How exactly the core is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Core {
    /// The equations in floating point
    Float,
    /// The core's results to the bit, slot by slot
    Fixed,
    /// Every clock of the core
    Clock,
}

impl From<Core> for Fidelity {
    fn from(core: Core) -> Self {
        match core {
            Core::Float => Fidelity::Float,
            Core::Fixed => Fidelity::Fixed,
            Core::Clock => Fidelity::Clock,
        }
    }
}

impl CoreArgs {
    /// How exactly the core is run.
    pub fn fidelity(&self) -> Fidelity {
        self.core.into()
    }

    /// Whether neither progress nor words for people are printed.
    pub fn is_silent(&self) -> bool {
        self.json || self.quiet
    }
}

/// Formats of waveform files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Waves {
    /// Text that every viewer reads
    Vcd,
    /// GTKWave's own, much smaller
    Fst,
    /// No waveforms
    None,
}

fn key_value(text: &str) -> Result<(String, String), String> {
    let split = text.split_once('=').map(|(key, value)| (key.trim().into(), value.trim().into()));
    split
        .filter(|(key, _): &(String, String)| !key.is_empty())
        .ok_or_else(|| "expected KEY=VALUE".into())
}

/// The fewest characters of a token: more than anybody tries.
const TOKEN: usize = 16;

fn token(text: &str) -> Result<String, String> {
    let is_plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    match is_plain && text.len() >= TOKEN {
        true => Ok(text.into()),
        false => Err(format!("expected at least {TOKEN} letters, digits, - and _")),
    }
}

fn above_zero(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| number.is_finite() && *number > 0.0)
        .ok_or_else(|| "expected a number above 0".into())
}

fn window(text: &str) -> Result<Range<f64>, String> {
    let seconds = |text: &str| {
        text.trim().parse::<f64>().ok().filter(|time| time.is_finite() && *time >= 0.0)
    };
    let range = text.split_once("..").and_then(|(from, to)| Some(seconds(from)?..seconds(to)?));
    range
        .filter(|range| range.start < range.end)
        .ok_or_else(|| "expected two times such as 0.1..0.2".into())
}
