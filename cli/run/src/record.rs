// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run leaves: rows, criteria, effects. Everything written (CSV, JSON, HTML, the terminal's
//! tables) is made from it.

use std::collections::BTreeMap;
use std::path::PathBuf;

use hapticore_host::Residual;
pub use hapticore_host::{Laws, Quantities};
use hapticore_scene::Setpoint;
use serde::Serialize;

use crate::control::Gains;
use crate::findings::Findings;

/// A finished slot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Which case of the scene.
    pub case: usize,
    /// The middle of the slot's window, counted on over the cases.
    pub time_s: f64,
    /// Pad number, from 0.
    pub pad: usize,
    /// What the core says.
    pub measured: Quantities,
    /// Names of the flags that are set, joined by `+`.
    pub flags: String,
    /// The force by eq. 8 and by the force table, from the core's capacitance and voltage; where the
    /// device has a table.
    pub laws: Option<Laws>,
    /// What the plant knows, where there is one.
    pub truth: Option<Truth>,
    /// What a controller made of it, where there is one.
    pub driven: Option<Driven>,
    /// The game that the pads play, where the scene has an arena.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub game: Option<GameRow>,
    /// The floating-point reference on the same samples, and eq. 6 alone, where they were asked
    /// for.
    pub reference: Option<Reference>,
}

/// The rows of a run, as its cases left them: a long run's are not copied into one list.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows(Vec<Vec<Row>>);

impl Rows {
    /// The rows of cases, one after the other; cases without rows are left out.
    pub fn of_cases(cases: impl IntoIterator<Item = Vec<Row>>) -> Self {
        Rows(cases.into_iter().filter(|rows| !rows.is_empty()).collect())
    }

    /// The rows of each case, which are one at least.
    pub fn cases(&self) -> impl Iterator<Item = &[Row]> {
        self.0.iter().map(Vec::as_slice)
    }

    /// All rows.
    pub fn iter(&self) -> std::iter::Flatten<std::slice::Iter<'_, Vec<Row>>> {
        self.0.iter().flatten()
    }

    /// How many they are.
    pub fn len(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl FromIterator<Row> for Rows {
    fn from_iter<T: IntoIterator<Item = Row>>(rows: T) -> Self {
        let mut cases: Vec<Vec<Row>> = Vec::new();
        for row in rows {
            match cases.last_mut() {
                Some(last) if last[0].case == row.case => last.push(row),
                _ => cases.push(vec![row]),
            }
        }
        Rows(cases)
    }
}

impl<'a> IntoIterator for &'a Rows {
    type Item = &'a Row;
    type IntoIter = std::iter::Flatten<std::slice::Iter<'a, Vec<Row>>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// What a controller made of a slot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Driven {
    /// The force that the pad should have, N.
    pub target_n: f64,
    /// The haptic voltage that the pad has from then on, V rms.
    pub drive_v_rms: f64,
    /// The drive is at zero or at its rail, and should be beyond.
    pub limited: bool,
    /// A fault keeps the drives at zero.
    pub fault: bool,
    /// The user leaves the pad's wall, where it has one.
    pub free: Option<bool>,
    /// The force that the core measured, N, where the host takes out of frames what other pads did to them: a controller
    /// acts on this one.
    pub core_n: Option<f64>,
    /// The wall that is known by the slot's part; none of other parts, and where the wall is off.
    #[serde(skip)]
    pub wall: Option<WallPlace>,
}

/// Where a wall is, along x, or along y for the part by which that one is known.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WallPlace {
    /// Its surface as the pad's last part meets it, mm from the sheet's centre.
    pub surface_mm: f64,
    /// How deep that part lies within, mm; negative outside.
    pub depth_mm: f64,
}

/// A game of air hockey as a slot begins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct GameRow {
    /// Where the puck is, mm right of the sheet's centre and above it.
    pub puck_mm: [f64; 2],
    /// Its speed, mm/s.
    pub puck_mm_s: f64,
    /// The force of impacts on the slot's pad, N.
    pub impact_n: f64,
    /// Goals of the left player and of the right one.
    pub score: [u32; 2],
}

/// What the plant knows of a slot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Truth {
    /// Quantities of the slot, in physical units.
    pub quantities: Quantities,
    /// The load on the pad.
    pub load_g: f64,
    /// Friction that acts on the pad; zero where no law of motion makes it.
    pub friction_n: f64,
    /// What of it is the haptic force's.
    pub haptic_friction_n: f64,
    /// Force of the hand on the pad along x, where there is one.
    pub hand_x_n: f64,
    /// The same along y.
    #[serde(skip)]
    pub hand_y_n: f64,
    /// The part of a split pad that the slot serves.
    pub part: usize,
    /// What the scene sets the pad to.
    #[serde(skip)]
    pub set: Setpoint,
    /// The point of the sweep, the same for all slots at one place and setting.
    pub point: usize,
    /// The group that the slot belongs to: all settings but the position.
    pub group: usize,
    /// The pad reaches over the edge.
    pub over_edge: bool,
    /// The pad lies on another one; known where pads are coupled.
    pub touching: bool,
}

impl Truth {
    /// By how much the force is more than its target, N.
    pub fn off_target_n(&self) -> f64 {
        self.quantities.force_n - self.set.target_n
    }
}

/// What the floating-point reference says of a slot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Reference {
    /// Quantities of the slot, in physical units.
    pub quantities: Quantities,
    /// The capacitance by eq. 6 alone.
    pub capacitance_eq6_pf: f64,
    /// The force from it.
    pub force_eq6_n: f64,
}

/// A criterion of the scene and what was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Criterion {
    /// Name, as in the scene.
    pub name: String,
    /// What was measured, in `unit`.
    pub measured: f64,
    /// What it may be at most.
    pub limit: f64,
    /// Whether it holds. One that is not applicable does, with `measured` no number.
    pub pass: bool,
    /// The unit of both.
    pub unit: String,
    /// Something to compare with: what it is (eq. 6 alone, an affine fit) and its value in `unit`.
    #[serde(rename = "beside")]
    pub baseline: Option<(String, f64)>,
    /// Whether any slot meets the criterion's condition.
    pub applicable: bool,
    /// Of which slots the limit bounds the error one by one; none of means, of other measures and under a condition.
    #[serde(skip)]
    pub bounds: Option<Bounds>,
}

/// The slots whose error a criterion bounds, each for itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// The quantity, as in `frames.csv`; a position is `position_mm`.
    pub of: &'static str,
    /// Names of the cases; all where empty.
    pub cases: Vec<String>,
}

/// An effect of the scene and what it cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// Name, as in the scene.
    pub name: String,
    /// How exactly it was simulated.
    #[serde(rename = "rung")]
    pub level: String,
    /// Wall time, s.
    pub seconds: f64,
    /// A finer level and the largest difference from it on the scene, percent.
    pub finer: Option<(String, f64)>,
}

/// The largest rounding error of a signal, from the shadow interpretation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SignalError {
    /// The signal, with its instances: `estimator.force_estimator.haptic_force`.
    pub signal: String,
    /// Number format, for example `u20.17`.
    pub format: String,
    /// The largest difference from the signal without rounding, in its own unit.
    pub max_error: f64,
    /// The same in codes of its format.
    pub max_codes: f64,
}

/// The largest and the rms error of the force by either law, N, over all slots with a truth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ForceLawErrors {
    /// Of eq. 8: largest, rms.
    pub eq8_n: [f64; 2],
    /// Of the force table: largest, rms.
    pub table_n: [f64; 2],
}

impl ForceLawErrors {
    /// The errors over rows; none where none has both a truth and a table.
    pub fn of(rows: &Rows) -> Option<ForceLawErrors> {
        let pair = |row: &Row| Some((row.laws?, row.truth?.quantities.force_n));
        let pairs: Vec<_> = rows.iter().filter_map(pair).collect();
        let errors = |of: fn(&Laws) -> f64| {
            let off = || pairs.iter().map(move |(laws, truth_n)| of(laws) - truth_n);
            let squares: f64 = off().map(|off| off * off).sum();
            [off().map(f64::abs).fold(0.0, f64::max), (squares / pairs.len() as f64).sqrt()]
        };
        (!pairs.is_empty()).then(|| ForceLawErrors {
            eq8_n: errors(|laws| laws.eq8_n),
            table_n: errors(|laws| laws.table_n),
        })
    }
}

/// Where a run comes from: enough to repeat it.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Provenance {
    /// The version of this program.
    pub version: String,
    /// The commit that it was built from, with `-modified` where the sources were; none where that
    /// is not known.
    pub commit: Option<String>,
    /// The command line, word by word.
    pub command: Vec<String>,
    /// The seed of noise and mismatch.
    pub seed: Option<u64>,
    /// What `--set` set, in its order.
    pub set: Vec<(String, String)>,
    /// Each case as a scene of its own in TOML, with everything that cases and `--set` set.
    pub resolved_scene: BTreeMap<String, String>,
    /// The calibration file of a replay; none where the nominal device's was taken, or a scene was
    /// run.
    pub calibration: Option<PathBuf>,
}

/// How stable a force loop is about a steady force.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Stability {
    /// The force, N.
    pub force_n: f64,
    /// From a pad's slot to its next, s.
    pub frame_s: f64,
    /// From the middle of a window to the middle of the time for which its drive is held, s.
    pub delay_s: f64,
    /// Where the open loop has the magnitude 1, Hz; none where it never does.
    pub crossover_hz: Option<f64>,
    /// By how much the phase may fall there, degrees.
    pub phase_margin_deg: Option<f64>,
    /// The largest factor on the gains with which the loop is stable; none where all are.
    pub gain_margin: Option<f64>,
    /// What a step from zero to the force does, where that was simulated.
    pub step: Option<Step>,
}

/// A step of a force loop's target from zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Step {
    /// By how much of the target the measured force exceeds it at most.
    pub overshoot_percent: f64,
    /// From the lowest to the highest force of the last third, between turns of the wave, by the target.
    pub swing_percent: f64,
    /// Mean force of the last third, N.
    pub rest_n: f64,
}

/// A force loop as it was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bode {
    /// Name of the case.
    pub case: String,
    /// Margins as predicted and as measured.
    pub predicted: Stability,
    /// See `predicted`.
    pub measured: Stability,
    /// Where the true force follows a sine of the target with 3 dB less than at the lowest
    /// frequency, Hz; none where it never does.
    pub bandwidth_hz: Option<f64>,
    /// By frequency.
    pub points: Vec<BodePoint>,
}

/// A force loop at a frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BodePoint {
    /// Frequency, Hz.
    pub hz: f64,
    /// Open loop as measured: gain, dB, and phase, degrees.
    pub open: [f64; 2],
    /// The same as predicted.
    pub predicted: [f64; 2],
    /// From target to true force, dB.
    pub closed_db: f64,
}

/// A whole run.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Record {
    /// The scene's or capture's name.
    pub scene: String,
    /// Title of the scene.
    pub title: String,
    /// What it is about.
    pub summary: String,
    /// Which figures to draw: `fig3`, `fig4`, `fig6`, `fig7`, `fig9`, `fig13`, `fig15`, `hockey`; any other gets the
    /// general ones.
    pub figure: Option<String>,
    /// Name of the profile.
    pub profile: String,
    /// `float`, `fixed` or `clock`.
    pub fidelity: String,
    /// The names of the cases.
    pub cases: Vec<String>,
    /// The names of the pads.
    pub pads: Vec<String>,
    /// The effects that were on.
    pub effects: Vec<Effect>,
    /// Criteria of the scene with their measurements.
    pub criteria: Vec<Criterion>,
    /// Rounding errors by signal, where they were asked for.
    pub errors: Vec<SignalError>,
    /// Simulated time, s.
    pub simulated_seconds: f64,
    /// Wall-clock time of the run, s.
    pub wall_seconds: f64,
    /// Flagged frames, how far controlled pads are off their targets, and what sticks.
    #[serde(skip_serializing_if = "Findings::is_empty")]
    pub findings: Findings,
    /// What its user must know before using the results.
    pub warnings: Vec<String>,
    /// What the position table leaves of its own places; of several cases the worst.
    pub position_table: Option<Residual>,
    /// Width and height of the sheet, where they are known.
    pub sheet_mm: Option<[f64; 2]>,
    /// The keys of the pads that are swept.
    pub swept: Vec<&'static str>,
    /// The law of the force controller of each case that has one.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub laws: BTreeMap<String, &'static str>,
    /// The gains of each case whose law or curve has any, given or computed.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub gains: BTreeMap<String, Gains>,
    /// Where it comes from.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What either law of the force leaves of the true force, where the device has a force table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_laws: Option<ForceLawErrors>,
    /// How stable the force loop of each case is predicted to be, where there is one.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub stability: BTreeMap<String, Stability>,
    /// The force loops as they were measured, where that was asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bode: Vec<Bode>,
    /// When the run began: `2026-11-30T01:02:03Z`.
    pub date: String,
    /// What one code of each of a frame's words is, for those that are proportional to it; zero of others, and of a capture.
    #[serde(skip)]
    pub codes: Quantities,
    /// One row per finished slot.
    #[serde(skip)]
    pub rows: Rows,
}
