// SPDX-License-Identifier: MIT OR Apache-2.0
//! Protocol 1: the messages between server and clients, JSON text over one WebSocket at `/ws`.
//!
//! Every number has its unit in its name, as in files. Unknown fields are ignored, an unknown type is answered with
//! `error`. [`VERSION`] rises only where a meaning changes.
//!
//! | from a client | does |
//! | --- | --- |
//! | `{"type":"lead","pad":0,"mm":[3.2,150]}` | the finger (the pad itself without a hand) moves on a line and arrives after `within_s`, default 0.012 |
//! | `{"type":"release","pad":0}` | the finger follows the scene again |
//! | `{"type":"set","pad":0,"load_g":60}` | sets one input of `hello.inputs`, without its `pad.` |
//! | `{"type":"target","pad":0,"n":0.3}` | force that the controller gives, N |
//! | `{"type":"wall","x_mm":-1.5,"y_mm":0}` | moves the walls; `"mm"` is `"x_mm"`; `"off":true` takes them away |
//! | `{"type":"serve"}` | serves a new puck, in a scene with an arena |
//! | `{"type":"arm","on":true}` | lets a board's drive follow its targets, while this client stays; `false` takes it to 0 V |
//! | `{"type":"alive"}` | sign of life: a client that has armed a drive and sends nothing for 1 s takes it to 0 V |
//! | `{"type":"disable"}` | disables a board: pads open, drives at 0 V |
//! | `{"type":"enable"}` | brings a disabled board up again, its drive off |
//! | `{"type":"pace","speed":0.1}` | device time by wall time; 0 pauses |
//! | `{"type":"step","slots":8}` | runs slots now; time stands until the next `pace` or until this client leaves |
//! | `{"type":"slot"}` | asks for the ADC codes of the last slot |
//! | `{"type":"record","to":"start"}` | starts the scene anew at 0 s, with an empty log |
//! | `{"type":"record","to":"scene"}` | asks for all inputs since then as a scene file; `"log"`: as a log of inputs by slot |
//! | `{"type":"open","scene":"hockey","set":{"sensor.noise_ppm_rms":40},"case":0}` | replaces the scene for all clients, once it is set up |
//! | `{"type":"subscribe","columns":["time_s","pad","force_n"],"every":"slot","format":"binary"}` | asks for every slot; `"every":"frame"` ends it |
//!
//! | from the server | when |
//! | --- | --- |
//! | `hello` | first, and after each `open`: all that does not change |
//! | `frames` | up to 60 times a second: the latest of each pad, as columns |
//! | `status` | every second |
//! | `event` | a pad changes its state |
//! | `note` | a board is found, refused, lost, restarted: what happened, what to do |
//! | `done`, `error` | exactly one for each command with an `id`; errors also without |
//! | `slot`, `recorded` | answers to `slot` and `record`, before `done` |
//! | `rows`, or binary | slots that were subscribed to |
//!
//! A binary message has the header `HPL1`, the numbers of columns and rows (16 bits each), then each column as 64-bit
//! floats; all little-endian. A value that a scene does not have is `null`, in binary not a number.

mod columns;
mod request;
mod state;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};

pub use columns::{COLUMNS, Column, PadRow};
pub use request::{BadRequest, Request};
pub use state::State;

/// The version of the protocol that a server speaks.
pub const VERSION: u32 = 1;

/// The longest message of a client that is read, bytes.
pub const LONGEST: usize = 64 << 10;

/// The most slots of one `step`.
pub const MOST_SLOTS: usize = 10_000;

/// Device time by wall time: 0, or within these.
pub const SPEEDS: [f64; 2] = [0.001, 10.0];

/// What a client asks for.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Command {
    /// Leads the finger, or a pad without hand.
    Lead {
        /// Pad number, from 0.
        pad: usize,
        /// Where it goes, mm right of the sheet's centre and above it.
        mm: [f64; 2],
        /// After which time it arrives, s; none: 0.012.
        #[serde(skip_serializing_if = "Option::is_none")]
        within_s: Option<f64>,
    },
    /// Gives the finger back to the scene.
    Release {
        /// Pad number, from 0.
        pad: usize,
    },
    /// Sets one input of a pad.
    Set {
        /// Pad number, from 0.
        pad: usize,
        /// Which one, and its value.
        #[serde(flatten)]
        setting: Setting,
    },
    /// Sets the force that a controller gives a pad.
    Target {
        /// Pad number, from 0.
        pad: usize,
        /// Force, N.
        n: f64,
    },
    /// Moves the walls.
    Wall {
        /// Surface of the wall along x, mm right of the sheet's centre; none: as it is.
        #[serde(skip_serializing_if = "Option::is_none")]
        x_mm: Option<f64>,
        /// Surface of the wall along y, mm above the sheet's centre; none: as it is.
        #[serde(skip_serializing_if = "Option::is_none")]
        y_mm: Option<f64>,
        /// Takes the walls away.
        #[serde(skip_serializing_if = "std::ops::Not::not")]
        #[schemars(default)]
        off: bool,
    },
    /// Serves a new puck, where the scene has an arena.
    Serve,
    /// Lets a board's drive follow its targets, or takes it to 0 V.
    Arm {
        /// It follows.
        on: bool,
    },
    /// A sign of life of a client that has armed a drive.
    Alive,
    /// Disables a board.
    Disable,
    /// Brings a disabled board up again, its drive off.
    Enable,
    /// Sets how fast device time runs.
    Pace {
        /// Device time by wall time; 0 pauses.
        speed: f64,
    },
    /// Runs slots, then lets time stand.
    Step {
        /// How many.
        #[schemars(range(min = 1, max = MOST_SLOTS))]
        slots: usize,
    },
    /// Asks for the ADC codes of the last slot.
    Slot,
    /// Records.
    Record {
        /// What.
        to: Recording,
    },
    /// Replaces the scene.
    Open(Opening),
    /// Asks for every slot.
    Subscribe(Subscription),
}

/// An input of a pad, and its value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// Load, g.
    LoadG(f64),
    /// Force besides the finger's, along x, N.
    PushXN(f64),
    /// Force besides the finger's, along y, N.
    PushYN(f64),
    /// Haptic voltage of the source, V rms, where no controller decides it.
    HapticVRms(f64),
    /// Force that a controller gives, N.
    TargetN(f64),
}

/// What `record` does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Recording {
    /// Starts the scene anew.
    Start,
    /// A scene file.
    Scene,
    /// A log of inputs by slot.
    Log,
}

/// The scene that a source simulates.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Opening {
    /// A bundled scene.
    pub scene: String,
    /// Keys and values as in `--set KEY=VALUE`.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "as_map")]
    #[schemars(with = "Option<BTreeMap<String, String>>")]
    pub set: Vec<(String, String)>,
    /// Number or name of the case; none for the first.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub case: Option<String>,
    /// A bundled profile; none for the scene's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<String>,
    /// `float`, `fixed` or `clock`; none for the source's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub core: Option<String>,
}

/// Keys and values as an object.
fn as_map<S: Serializer>(set: &[(String, String)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(set.iter().map(|(key, value)| (key, value)))
}

/// Which columns of every slot a client wants.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Subscription {
    /// Names of columns, at least one.
    pub columns: Vec<String>,
    /// `slot`, or `frame` for none.
    pub every: Every,
    /// How they are sent.
    #[serde(default)]
    pub format: Format,
}

/// How often rows are sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Every {
    /// Each slot, several in one message.
    Slot,
    /// None besides `frames`.
    Frame,
}

/// How rows are sent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// As `rows`.
    #[default]
    Json,
    /// As a binary message.
    Binary,
}

/// What a server sends.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Answer {
    /// All that does not change.
    Hello(Box<Hello>),
    /// The latest frame of each pad.
    Frames(Frames),
    /// How the source keeps up.
    Status(Status),
    /// A pad changes its state.
    Event(Event),
    /// Something that happened to a board.
    Note {
        /// What happened, and what to do.
        text: String,
    },
    /// A command was carried out, before this slot.
    Done {
        /// The command's.
        id: u64,
        /// Number of the next slot.
        slot: usize,
    },
    /// A command was refused and has changed nothing.
    Error {
        /// The command's, where it had one.
        #[serde(skip_serializing_if = "Option::is_none")]
        id: Option<u64>,
        /// Cause and cure.
        message: String,
    },
    /// The ADC codes of a slot.
    Slot(SlotCodes),
    /// A recording.
    Recorded(Recorded),
    /// Slots that were subscribed to.
    Rows {
        /// Names of the columns.
        columns: Vec<String>,
        /// The values of each slot.
        rows: Vec<Vec<Option<f64>>>,
    },
}

impl Answer {
    /// The message as text.
    pub fn text(&self) -> String {
        serde_json::to_string(self).expect("messages are plain data")
    }
}

/// All that does not change of a source.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Hello {
    /// Version of the protocol.
    pub protocol: u32,
    /// Version of the program.
    pub version: String,
    /// Commit that it was built from, where that is known.
    pub commit: Option<String>,
    /// `scene` or `board`.
    pub source: &'static str,
    /// The scene's name.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// What it is about.
    pub summary: String,
    /// The case's name.
    pub case: String,
    /// Number of the case, from 0.
    pub case_index: usize,
    /// Names of all cases.
    pub cases: Vec<String>,
    /// Name of the profile.
    pub profile: String,
    /// `float`, `fixed` or `clock`.
    pub fidelity: String,
    /// What the scene was opened with: keys and values as in `--set KEY=VALUE`.
    #[serde(serialize_with = "as_map")]
    #[schemars(with = "BTreeMap<String, String>")]
    pub set: Vec<(String, String)>,
    /// The command that runs the same scene without a page.
    pub command: String,
    /// What its user must know before using the results.
    pub warnings: Vec<String>,
    /// Length of a slot, µs.
    pub slot_us: f64,
    /// Slots of each pad: parts of a split pad, each with a slot of its own.
    pub parts: usize,
    /// The pads.
    pub pads: Vec<Pad>,
    /// Width and height of the sheet, mm.
    pub sheet_mm: [f64; 2],
    /// Diameter of a pad, mm.
    pub pad_diameter_mm: f64,
    /// Where the terminals are, mm from the sheet's centre.
    pub terminals_mm: Vec<[f64; 2]>,
    /// Columns of `frames.pads` that have a unit: `name`, `unit` and `label` of each.
    #[schemars(with = "Vec<BTreeMap<String, String>>")]
    pub columns: Vec<Column>,
    /// Inputs of each pad.
    pub inputs: Vec<InputInfo>,
    /// Keys of the scene that are worth changing: with `open`, in its `set`.
    pub settings: Vec<SettingInfo>,
    /// Clients can lead fingers.
    pub leads: bool,
    /// The pads hang on a finger by a spring.
    pub hand: bool,
    /// A controller drives the pads.
    pub controller: bool,
    /// Walls, along x first.
    pub walls: Vec<Wall>,
    /// The table of air hockey, where the scene has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arena: Option<Arena>,
    /// What the scene allows.
    pub limits: Limits,
    /// `frames` have `true_…` columns.
    pub truth: bool,
    /// Device time by wall time that is asked for.
    pub speed: f64,
    /// Names of the bundled scenes.
    pub scenes: Vec<&'static str>,
    /// Scenes with something to try.
    pub presets: Vec<Preset>,
}

/// A scene with something to try.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Preset {
    /// In an address: `?preset=wall`.
    pub name: &'static str,
    /// On its button.
    pub label: &'static str,
    /// What to do, and what shows.
    pub hint: &'static str,
    /// The scene, its keys and its case.
    #[serde(flatten)]
    pub opening: Opening,
}

/// A pad.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Pad {
    /// Its name.
    pub name: String,
    /// Where its parts lie, mm from its centre.
    pub parts_mm: Vec<[f64; 2]>,
}

/// An input of each pad.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct InputInfo {
    /// `pad.` and the key of `set`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// Least value of a slider.
    pub least: f64,
    /// Largest value of a slider.
    pub most: f64,
    /// Value of the first pad as the scene begins.
    pub value: f64,
    /// `pad`.
    pub per: &'static str,
}

/// A key of the scene that is worth changing.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SettingInfo {
    /// The key, as in `--set`.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// What it means, as `hapticore reference` has it.
    pub says: &'static str,
    /// Least value of a slider.
    pub least: f64,
    /// Largest value of a slider.
    pub most: f64,
    /// Its value in the scene, where the scene gives one.
    pub value: Option<f64>,
}

/// A wall.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Wall {
    /// `x` or `y`: the axis that it lies across.
    pub axis: &'static str,
    /// Its surface, mm from the sheet's centre, as the scene begins.
    pub mm: f64,
    /// On which side of the surface its inside is: `below` or `above`, in coordinates.
    pub inside: &'static str,
}

/// A table of air hockey, whose mallets are the pads. Its centre is the sheet's.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Arena {
    /// Half of its length and of its height, mm.
    pub half_mm: [f64; 2],
    /// Half of a goal's width, mm.
    pub goal_half_mm: f64,
    /// Radius of a mallet, mm.
    pub mallet_radius_mm: f64,
    /// Radius of the puck, mm.
    pub puck_radius_mm: f64,
    /// Where the centre of each pad may be: from and to along x, then along y, mm. Beyond are its walls.
    pub reach_mm: Vec<[[f64; 2]; 2]>,
}

/// The puck and the score.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Game {
    /// Where the puck is, mm right of the sheet's centre and above it.
    pub puck_mm: [f64; 2],
    /// Its velocity, mm/s.
    pub puck_mm_s: [f64; 2],
    /// Goals of the left player and of the right one.
    pub score: [u32; 2],
}

/// What a scene allows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Limits {
    /// Error of a position, mm.
    pub position_mm: Option<f64>,
    /// Error of a force, N.
    pub force_n: Option<f64>,
    /// The largest drive, V rms.
    pub rail_v: Option<f64>,
}

/// The latest frame of each pad.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Frames {
    /// Number of the next slot.
    pub slot: usize,
    /// When it begins, s of device time.
    pub time_s: f64,
    /// A row of each pad that has had a frame; sent as columns.
    #[serde(serialize_with = "columns::as_columns")]
    #[schemars(with = "BTreeMap<String, Vec<Option<f64>>>")]
    pub pads: Vec<PadRow>,
    /// Amplitudes of the terminals' currents in the last slot, as fractions of full scale.
    pub terminals: Vec<f64>,
    /// Amplitudes of the sensing and the haptic voltage there, likewise.
    pub voltages: Vec<f64>,
    /// Surfaces of the walls, mm; `null` where a wall is off.
    pub walls: Vec<Option<f64>>,
    /// The puck and the score, where the scene has an arena.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub game: Option<Game>,
}

/// How the source keeps up.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Status {
    /// Device time by wall time, as reached in the last second.
    pub speed: f64,
    /// As asked for; 0 where time is paused.
    pub asked_speed: f64,
    /// A client steps, and time stands.
    pub stepped: bool,
    /// How late the loop woke up, ms: median, 99th percentile, largest.
    pub late_ms: [f64; 3],
    /// Wall time that was left out since the scene was opened, since it could not be kept up with, s.
    pub skipped_s: f64,
    /// Clients.
    pub clients: usize,
    /// Messages that this client has missed, since it did not read them in time.
    pub dropped: u64,
    /// Inputs since the scene was opened.
    pub inputs: usize,
    /// The scene that is being set up.
    pub opening: Option<String>,
    /// Why the source has stopped, where it has.
    pub stopped: Option<String>,
    /// The line to the board, of a source that is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<LineStatus>,
}

/// The line to a board.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct LineStatus {
    /// Its name.
    pub name: String,
    /// Where the session is, in a word: `measuring`, `armed`, `off`, `silent` …
    pub phase: &'static str,
    /// The drive follows its targets.
    pub armed: bool,
    /// Age of the last packet, ms.
    pub age_ms: f64,
    /// Frames and heartbeats that have come.
    pub packets: u64,
    /// Frames that were lost on the line.
    pub lost: u64,
    /// Frames that the board has dropped, since its line was busy.
    pub dropped: u64,
    /// Packets that were damaged on the line.
    pub damaged: u64,
    /// Packets that report a refused command.
    pub refused: u64,
}

/// A pad changes its state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Event {
    /// When, s of device time.
    pub time_s: f64,
    /// Pad number, from 0.
    pub pad: usize,
    /// The state that it is in now.
    pub state: State,
    /// What happened, in words.
    pub what: String,
}

/// The ADC codes of a slot's window.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SlotCodes {
    /// Number of the slot.
    pub slot: usize,
    /// The pad, or part of one, that it serves, counted over all pads.
    pub pad: usize,
    /// Names of the channels.
    pub channels: Vec<String>,
    /// The code of full scale.
    pub full_scale: i32,
    /// Samples a second.
    pub sample_rate_hz: f64,
    /// Codes of each channel; empty where the scene has phasors alone.
    pub codes: Vec<Vec<i32>>,
}

/// A recording.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Recorded {
    /// `scene` or `log`.
    pub format: Recording,
    /// A name for its file.
    pub name: String,
    /// Simulating it gives the same rows, to the bit.
    pub exact: bool,
    /// What of it is not exact, in words; empty where all is.
    pub note: String,
    /// The file's text.
    pub text: String,
}
