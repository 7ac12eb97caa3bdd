// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[wall]`: virtual walls that split pads meet, in the core that controls their force.
//!
//! ```toml
//! [halves]
//! senses = "each"            # the core reads the direction of the push from the parts of a pad
//!
//! [control]                  # the wall gives the force that the controller aims at
//!
//! [wall]
//! rule = "sequential"        # sequential | direct (eq. 12) | never (eq. 11): when it lets go
//! surface_mm = 0             # along x; may move: see `stimulus`
//! inside = "left"            # left | right of its surface
//! surface_y_mm = 0           # with halves.quadrants: of the wall along y, which may move, too
//! inside_y = "below"         # below | above its surface
//! stiffness_n_per_mm = 0.5
//! force_n = 1                # the most that it gives
//! play_mm = 0.2              # way back after which the hand has turned, whatever the push reads
//! uncalibrated = false       # else the direction's offset is taken out: at the factory, then in free air
//! ```
//!
//! The force is k_w·depth, so that eqs. 11 and 12, whose voltage goes with the depth, need a
//! `control.curve` that makes it of the force: `linear`. Source: paper, eqs. 10 to 12; docs/physics.md
//! §6.

use crate::error::SceneError;
use crate::format::{Limits, Table};
use crate::pad::over_time;
use crate::stimulus::{Moment, Stimulus};

/// When a wall lets a pad go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallRule {
    /// When a sequential test on the push, or play of the position, says so.
    Sequential,
    /// In each slot whose push leads out: eq. 12.
    Direct,
    /// Never: eq. 11.
    Never,
}

const RULES: [(&str, WallRule); 3] = [
    ("sequential", WallRule::Sequential),
    ("direct", WallRule::Direct),
    ("never", WallRule::Never),
];

/// Virtual walls as a scene asks for them.
///
/// ```
/// use hapticore_scene::{Scene, WallRule};
///
/// let text = "title = \"t\"\nduration_s = 1\n[gap]\n[halves]\nsenses = \"each\"\n[control]\n[wall]\n\
///             rule = \"direct\"\n[[pad]]\nposition_mm = [0, 0]\n";
/// let case = &Scene::parse(text, "t.toml", &[])?.cases[0];
/// let wall = case.control.as_ref().unwrap().wall.clone().unwrap();
/// assert_eq!((wall.rule, wall.stiffness_n_per_mm, wall.surface_mm(0.5)), (WallRule::Direct, 0.5, 0.0));
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct WallPlan {
    /// When it lets go.
    pub rule: WallRule,
    /// Its inside is right of its surface.
    pub right: bool,
    /// Stiffness, N/mm.
    pub stiffness_n_per_mm: f64,
    /// The largest force, N.
    pub force_n: f64,
    /// Way back of the pad after which the hand has turned, mm, where not as the profile says: some
    /// four times the noise of the place.
    pub play_mm: Option<f64>,
    /// The direction's offset is taken out.
    pub calibrated: bool,
    /// The wall along y, where pads are split in quadrants.
    pub along_y: Option<WallAlongY>,
    surface_mm: Stimulus,
}

/// The wall along y.
#[derive(Clone, Debug, PartialEq)]
pub struct WallAlongY {
    /// Its inside is above its surface.
    pub above: bool,
    surface_mm: Stimulus,
}

impl WallAlongY {
    /// The table's, of pads that are split in quadrants.
    fn read(table: &Table, quadrants: bool) -> Result<Option<WallAlongY>, SceneError> {
        if !quadrants {
            let keys = ["surface_y_mm", "inside_y"];
            return match keys.into_iter().find(|key| table.get(key).is_some()) {
                Some(key) => Err(table.error(key, "expected [halves] with quadrants = true too")),
                None => Ok(None),
            };
        }
        let surface = Stimulus::read(table, "surface_y_mm", Limits::within(-1e4, 1e4))?;
        Ok(Some(WallAlongY {
            above: table.choice("inside_y", &["below", "above"])? == Some("above"),
            surface_mm: over_time(table, "surface_y_mm", "a place", surface)?,
        }))
    }

    /// Where its surface is at a time, mm above the sheet's centre.
    pub fn surface_mm(&self, time_s: f64) -> f64 {
        self.surface_mm.at(0, Moment::at(time_s))
    }
}

impl WallPlan {
    /// The table, where there is one.
    pub(crate) fn read(root: &Table) -> Result<Option<WallPlan>, SceneError> {
        let Some(table) = root.table("wall")? else { return Ok(None) };
        let halves = root.table("halves")?;
        let senses =
            halves.map_or(Ok(None), |halves| halves.choice("senses", &["together", "each"]))?;
        if senses != Some("each") {
            let message = "expected [halves] with senses = \"each\" too, which read the direction";
            return Err(table.error("", message));
        }
        if root.get("control").is_none() {
            return Err(table.error("", "expected [control] too, which gives the wall's force"));
        }
        let quadrants = halves.map_or(Ok(false), |halves| halves.flag("quadrants"))?;
        let surface = Stimulus::read(table, "surface_mm", Limits::within(-1e4, 1e4))?;
        let surface_mm = over_time(table, "surface_mm", "a place", surface)?;
        Ok(Some(WallPlan {
            rule: table.word("rule", &RULES)?.unwrap_or(WallRule::Sequential),
            right: table.choice("inside", &["left", "right"])? == Some("right"),
            stiffness_n_per_mm: table.number_or(
                "stiffness_n_per_mm",
                Limits::within(0.0, 15.0),
                0.5,
            )?,
            force_n: table.number_or("force_n", Limits::within(0.0, 100.0), 1.0)?,
            play_mm: table.number("play_mm", Limits::within(0.001, 10.0))?,
            calibrated: !table.flag("uncalibrated")?,
            along_y: WallAlongY::read(table, quadrants)?,
            surface_mm,
        }))
    }

    /// Where the wall's surface is at a time, mm right of the sheet's centre.
    pub fn surface_mm(&self, time_s: f64) -> f64 {
        self.surface_mm.at(0, Moment::at(time_s))
    }
}
