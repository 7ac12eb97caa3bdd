// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[arena]`: a table of air hockey, whose mallets are the scene's pads.
//!
//! The plant does not play: a host does, from the frames of the core. A pad plays the half in which it starts. Source:
//! Nakamura and Yamamoto, IEEE Trans. Haptics 2016, whose game this is after; docs/physics.md §6.

use crate::device::Device;
use crate::effects::split_electrode::QUADRANTS;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::pad::TARGET_N;

/// Keys of `[wall]` that the arena decides.
const OF_WALL: [&str; 4] = ["surface_mm", "inside", "surface_y_mm", "inside_y"];

keys! { KEYS:
    /// Half of the table's length and of its height, at most half of the sheet; its centre is the sheet's.
    HALF_MM: [f64; 2] = Key::pair("half_mm", Limits::above(0.0, 1e4)).or(&[300.0, 180.0]);
    /// Half of a goal's width, in the middle of either short side, at least the puck's radius.
    GOAL_HALF_MM: Option<f64> = Key::number("goal_half_mm", Limits::above(0.0, 1e4)).usually("a third of half the height");
    /// Radius of a mallet, at most a quarter of the smaller of `half_mm`.
    MALLET_RADIUS_MM: Option<f64> = Key::number("mallet_radius_mm", Limits::above(0.0, 2.5e3)).usually("the pad's");
    /// Radius of the puck, at most a quarter of the smaller of `half_mm`.
    PUCK_RADIUS_MM: Option<f64> = Key::number("puck_radius_mm", Limits::above(0.0, 2.5e3)).usually("12, or the most that is allowed");
    /// Mass of the puck.
    PUCK_G: f64 = Key::number("puck_g", Limits::within(0.1, 1e3)).or(20.0);
    /// Coefficient of the puck's friction on the table.
    PUCK_MU: f64 = Key::number("puck_mu", Limits::within(0.0, 10.0)).or(0.02);
    /// Where the puck is served.
    PUCK_MM: [f64; 2] = Key::pair("puck_mm", Limits::within(-1e4, 1e4)).or(&[0.0; 2]);
    /// How fast the puck is served, along x and y.
    PUCK_MM_S: [f64; 2] = Key::pair("puck_mm_s", Limits::within(-1e4, 1e4)).or(&[0.0; 2]);
    /// Speed after by speed before an impact on a wall.
    RESTITUTION_WALL: f64 = Key::number("restitution_wall", Limits::within(0.0, 1.0)).or(0.9);
    /// Speed after by speed before an impact on a mallet.
    RESTITUTION_MALLET: f64 = Key::number("restitution_mallet", Limits::within(0.0, 1.0)).or(0.8);
    /// How long a mallet feels an impact.
    IMPACT_MS: f64 = Key::number("impact_ms", Limits::within(1.0, 1e3)).or(30.0);
    /// The most that an impact gives.
    FORCE_N: f64 = Key::number("force_n", Limits::within(0.0, 100.0)).or(1.0);
    /// Times, rising, at which a new puck is served, besides the first.
    SERVE_S: Option<Vec<f64>> = Key::numbers("serve_s", Limits::within(0.0, 1e5));
}

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
        let half_mm = table.get(&HALF_MM)?;
        if half_mm.iter().zip(sheet_mm).any(|(half, sheet)| *half > sheet) {
            let message =
                format!("expected at most {sheet_mm:?}, half of the sheet, got {half_mm:?}");
            return Err(table.error("half_mm", message));
        }
        let [half_x_mm, half_y_mm] = half_mm;
        let most_mm = 0.25 * half_x_mm.min(half_y_mm);
        let radius = |key: Key<Option<f64>>, default: f64| {
            table.get(&key.within(Limits::above(0.0, most_mm)).or(default.min(most_mm)))
        };
        let puck_radius_mm = radius(PUCK_RADIUS_MM, 12.0)?;
        let goal = Limits::within(puck_radius_mm, half_y_mm);
        let [reach_x_mm, reach_y_mm] = half_mm.map(|half| half - puck_radius_mm);
        let puck_mm = table.get(&PUCK_MM)?;
        if puck_mm[0].abs() > reach_x_mm || puck_mm[1].abs() > reach_y_mm {
            let message = format!(
                "expected a place within ±{reach_x_mm} and ±{reach_y_mm} mm, got {puck_mm:?}"
            );
            return Err(table.error("puck_mm", message));
        }
        Ok(Some(ArenaPlan {
            half_mm,
            goal_half_mm: table.get(&GOAL_HALF_MM.within(goal).or(half_y_mm / 3.0))?,
            mallet_radius_mm: radius(MALLET_RADIUS_MM, device.pad_diameter_mm / 2.0)?,
            puck_radius_mm,
            puck_g: table.get(&PUCK_G)?,
            puck_mu: table.get(&PUCK_MU)?,
            puck_mm,
            puck_mm_s: table.get(&PUCK_MM_S)?,
            restitution_wall: table.get(&RESTITUTION_WALL)?,
            restitution_mallet: table.get(&RESTITUTION_MALLET)?,
            impact_ms: table.get(&IMPACT_MS)?,
            force_n: table.get(&FORCE_N)?,
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
    if !halves.map_or(Ok(false), |halves| halves.get(&QUADRANTS))? {
        let message =
            "expected [halves] with quadrants = true too: the arena has walls along x and y";
        return Err(table.error("", message));
    }
    if let Some(key) = OF_WALL.into_iter().find(|key| wall.node(key).is_some()) {
        return Err(wall.error(key, "expected none with [arena], which places the walls"));
    }
    if root.node("duration_s").is_none() {
        return Err(table.error("", "expected duration_s too: a game goes on in time"));
    }
    let aimed = |pad: &&&Table| pad.has(&TARGET_N);
    match root.tables("pad")?.iter().find(aimed) {
        Some(pad) => {
            Err(pad.error("target_n", "expected none with [arena], whose impacts are the targets"))
        }
        None => Ok(()),
    }
}

/// When pucks are served.
fn serves(table: &Table) -> Result<Vec<f64>, SceneError> {
    let serve_s = table.get(&SERVE_S)?.unwrap_or_default();
    match serve_s.is_sorted() {
        true => Ok(serve_s),
        false => Err(table.error("serve_s", "expected times that rise")),
    }
}
