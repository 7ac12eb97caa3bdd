// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[wall]`: virtual walls that split pads meet, in the core that controls their force.
//!
//! The force is k_w·depth, so that eqs. 11 and 12, whose voltage goes with the depth, need a
//! `control.curve` that makes it of the force: `linear`. Source: paper, eqs. 10 to 12; docs/physics.md
//! §6.

use crate::effects::split_electrode::{QUADRANTS, SENSES};
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, Word, keys};
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

impl Word for WallRule {
    const WORDS: &[(&str, WallRule)] = &[
        ("sequential", WallRule::Sequential),
        ("direct", WallRule::Direct),
        ("never", WallRule::Never),
    ];
}

keys! { KEYS:
    /// When the wall lets a pad go: `sequential` by a test on the push and by play of the position, `direct` by eq. 12,
    /// `never` as eq. 11.
    RULE: WallRule = Key::words("rule").or_word("sequential");
    /// Where the wall begins along x.
    SURFACE_MM: Option<Stimulus> = Key::over_time("surface_mm", Limits::within(-1e4, 1e4)).usually("0");
    /// On which side of `surface_mm` the wall's inside is.
    INSIDE: &'static str = Key::choice("inside", || vec!["left", "right"]).or("left");
    /// Where the wall along y begins, with `halves.quadrants`.
    SURFACE_Y_MM: Option<Stimulus> = Key::over_time("surface_y_mm", Limits::within(-1e4, 1e4)).usually("0");
    /// On which side of `surface_y_mm` the inside of the wall along y is, with `halves.quadrants`.
    INSIDE_Y: &'static str = Key::choice("inside_y", || vec!["below", "above"]).or("below");
    /// Force of the wall for each millimetre of depth.
    STIFFNESS_N_PER_MM: f64 = Key::number("stiffness_n_per_mm", Limits::within(0.0, 15.0)).or(0.5);
    /// The most that the wall gives.
    FORCE_N: f64 = Key::number("force_n", Limits::within(0.0, 100.0)).or(1.0);
    /// Way back of the pad after which the hand has turned, whatever the push reads; half of it along the surface is sliding.
    PLAY_MM: Option<f64> = Key::number("play_mm", Limits::within(0.001, 10.0)).usually("the profile's, 0.2");
    /// The direction keeps its offset, which is otherwise taken out at the factory and then in free air.
    UNCALIBRATED: bool = Key::flag("uncalibrated");
}

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
            let keys = [SURFACE_Y_MM.about.name, INSIDE_Y.about.name];
            return match keys.into_iter().find(|key| table.node(key).is_some()) {
                Some(key) => Err(table.error(key, "expected [halves] with quadrants = true too")),
                None => Ok(None),
            };
        }
        let surface_mm = over_time(table, &SURFACE_Y_MM, "a place")?;
        Ok(Some(WallAlongY { above: table.get(&INSIDE_Y)? == "above", surface_mm }))
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
        let senses = halves.map_or(Ok(""), |halves| halves.get(&SENSES))?;
        if senses != "each" {
            let message = "expected [halves] with senses = \"each\" too, which read the direction";
            return Err(table.error("", message));
        }
        if root.node("control").is_none() {
            return Err(table.error("", "expected [control] too, which gives the wall's force"));
        }
        let quadrants = halves.map_or(Ok(false), |halves| halves.get(&QUADRANTS))?;
        let surface_mm = over_time(table, &SURFACE_MM, "a place")?;
        Ok(Some(WallPlan {
            rule: table.get(&RULE)?,
            right: table.get(&INSIDE)? == "right",
            stiffness_n_per_mm: table.get(&STIFFNESS_N_PER_MM)?,
            force_n: table.get(&FORCE_N)?,
            play_mm: table.get(&PLAY_MM)?,
            calibrated: !table.get(&UNCALIBRATED)?,
            along_y: WallAlongY::read(table, quadrants)?,
            surface_mm,
        }))
    }

    /// Where the wall's surface is at a time, mm right of the sheet's centre.
    pub fn surface_mm(&self, time_s: f64) -> f64 {
        self.surface_mm.at(0, Moment::at(time_s))
    }
}
