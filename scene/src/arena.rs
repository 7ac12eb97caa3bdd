// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[arena]`: a table of air hockey, whose mallets are the scene's pads.
//!
//! ```toml
//! [wall]                       # stiffness and largest force of the arena's walls; their places are the arena's
//!
//! [arena]
//! half_mm = [300, 180]         # half of its length and of its height; its centre is the sheet's
//! goal_half_mm = 60            # half of a goal's width, in the middle of either short side
//! mallet_radius_mm = 15        # default: the pad's
//! puck_radius_mm = 12
//! puck_g = 20
//! puck_mu = 0.02               # its friction on the table
//! puck_mm = [0, 0]             # where it is served, and how fast
//! puck_mm_s = [0, 0]
//! restitution_wall = 0.9       # speed after by speed before
//! restitution_mallet = 0.8
//! impact_ms = 30               # for so long a mallet feels an impact
//! force_n = 1                  # the most that an impact gives
//! serve_s = [1.5, 4]           # when a new puck is served, besides the first
//! ```
//!
//! The plant does not play: a host does, from the frames of the core. A pad plays the half in which it starts. Source:
//! Nakamura and Yamamoto, IEEE Trans. Haptics 2016, whose game this is after; docs/physics.md §6.

use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Limits, Table};

/// Keys of `[wall]` that the arena decides.
const OF_WALL: [&str; 4] = ["surface_mm", "inside", "surface_y_mm", "inside_y"];

/// A table of air hockey as a scene asks for it.
///
/// ```
/// use hapticore_scene::Scene;
///
/// let text = "title = \"t\"\nduration_s = 1\n[gap]\n[halves]\nquadrants = true\nsenses = \"each\"\n[control]\n[wall]\n\
///             [arena]\npuck_g = 30\n[[pad]]\nposition_mm = [-150, 0]\n";
/// let arena = Scene::parse(text, "t.toml", &[])?.cases[0].arena.clone().unwrap();
/// assert_eq!((arena.half_mm, arena.mallet_radius_mm, arena.puck_g), ([300.0, 180.0], 15.0, 30.0));
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ArenaPlan {
    /// Half of its length and of its height, mm.
    pub half_mm: [f64; 2],
    /// Half of a goal's width, mm.
    pub goal_half_mm: f64,
    /// Radius of a mallet, mm.
    pub mallet_radius_mm: f64,
    /// Radius of the puck, mm.
    pub puck_radius_mm: f64,
    /// Mass of the puck, g.
    pub puck_g: f64,
    /// Coefficient of the puck's friction on the table.
    pub puck_mu: f64,
    /// Where the puck is served, mm.
    pub puck_mm: [f64; 2],
    /// Its velocity then, mm/s.
    pub puck_mm_s: [f64; 2],
    /// Speed after by speed before an impact on a wall.
    pub restitution_wall: f64,
    /// The same on a mallet.
    pub restitution_mallet: f64,
    /// How long a mallet feels an impact, ms.
    pub impact_ms: f64,
    /// The most that an impact gives, N.
    pub force_n: f64,
    /// When a new puck is served besides the first, s, rising.
    pub serve_s: Vec<f64>,
}

impl ArenaPlan {
    /// The table, where there is one.
    pub(crate) fn read(root: &Table, device: &Device) -> Result<Option<ArenaPlan>, SceneError> {
        let Some(table) = root.table("arena")? else { return Ok(None) };
        check_scene(root, table)?;
        let sheet_mm = [device.width_mm, device.height_mm].map(|size_mm| size_mm / 2.0);
        let half_mm = table.pair("half_mm", Limits::above(0.0, 1e4))?.unwrap_or([300.0, 180.0]);
        if half_mm.iter().zip(sheet_mm).any(|(half, sheet)| *half > sheet) {
            let message =
                format!("expected at most {sheet_mm:?}, half of the sheet, got {half_mm:?}");
            return Err(table.error("half_mm", message));
        }
        let [half_x_mm, half_y_mm] = half_mm;
        let most_mm = 0.25 * half_x_mm.min(half_y_mm);
        let radius = |key, default: f64| {
            table.number_or(key, Limits::above(0.0, most_mm), default.min(most_mm))
        };
        let puck_radius_mm = radius("puck_radius_mm", 12.0)?;
        let goal = Limits::within(puck_radius_mm, half_y_mm);
        let [reach_x_mm, reach_y_mm] = half_mm.map(|half| half - puck_radius_mm);
        let places = Limits::within(-1e4, 1e4);
        let puck_mm = table.pair("puck_mm", places)?.unwrap_or_default();
        if puck_mm[0].abs() > reach_x_mm || puck_mm[1].abs() > reach_y_mm {
            let message = format!(
                "expected a place within ±{reach_x_mm} and ±{reach_y_mm} mm, got {puck_mm:?}"
            );
            return Err(table.error("puck_mm", message));
        }
        let share = |key, default| table.number_or(key, Limits::within(0.0, 1.0), default);
        Ok(Some(ArenaPlan {
            half_mm,
            goal_half_mm: table.number_or("goal_half_mm", goal, half_y_mm / 3.0)?,
            mallet_radius_mm: radius("mallet_radius_mm", device.pad_diameter_mm / 2.0)?,
            puck_radius_mm,
            puck_g: table.number_or("puck_g", Limits::within(0.1, 1e3), 20.0)?,
            puck_mu: table.number_or("puck_mu", Limits::within(0.0, 10.0), 0.02)?,
            puck_mm,
            puck_mm_s: table.pair("puck_mm_s", Limits::within(-1e4, 1e4))?.unwrap_or_default(),
            restitution_wall: share("restitution_wall", 0.9)?,
            restitution_mallet: share("restitution_mallet", 0.8)?,
            impact_ms: table.number_or("impact_ms", Limits::within(1.0, 1e3), 30.0)?,
            force_n: table.number_or("force_n", Limits::within(0.0, 100.0), 1.0)?,
            serve_s: serves(table)?,
        }))
    }
}

/// What an arena needs of the other tables of its scene, and what it decides in their place.
fn check_scene(root: &Table, table: &Table) -> Result<(), SceneError> {
    let Some(wall) = root.table("wall")? else {
        return Err(
            table.error("", "expected [wall] too, which says how stiff the arena's walls are")
        );
    };
    let halves = root.table("halves")?;
    if !halves.map_or(Ok(false), |halves| halves.flag("quadrants"))? {
        let message =
            "expected [halves] with quadrants = true too: the arena has walls along x and y";
        return Err(table.error("", message));
    }
    if let Some(key) = OF_WALL.into_iter().find(|key| wall.get(key).is_some()) {
        return Err(wall.error(key, "expected none with [arena], which places the walls"));
    }
    if root.get("duration_s").is_none() {
        return Err(table.error("", "expected duration_s too: a game goes on in time"));
    }
    let aimed = |pad: &&&Table| pad.get("target_n").is_some();
    match root.tables("pad")?.iter().find(aimed) {
        Some(pad) => {
            Err(pad.error("target_n", "expected none with [arena], whose impacts are the targets"))
        }
        None => Ok(()),
    }
}

/// When pucks are served.
fn serves(table: &Table) -> Result<Vec<f64>, SceneError> {
    let serve_s = table.numbers("serve_s", Limits::within(0.0, 1e5))?.unwrap_or_default();
    match serve_s.is_sorted() {
        true => Ok(serve_s),
        false => Err(table.error("serve_s", "expected times that rise")),
    }
}
