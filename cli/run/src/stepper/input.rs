// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs of a stepper: what a hand does, and what is set in place of what the scene asks for.

use hapticore_scene::DriveError;
use serde::{Deserialize, Serialize};

use super::{Source, Stepper};
use crate::control::plant::{LoopPlant, WallInput};

/// How long a released finger takes back to where the scene has it, s.
pub const RELEASE_S: f64 = 0.012;

/// How long a finger may take to a place, s.
const WITHIN_S: [f64; 2] = [1e-4, 3600.0];

/// An input, which holds until the next of its kind. `pad` is the number of a pad of the scene, whatever
/// its parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Input {
    /// The finger, or the pad itself where it hangs on none, goes on a line from where it is to a place.
    Lead {
        /// Which pad.
        pad: usize,
        /// The place, mm from the sheet's centre.
        to_mm: [f64; 2],
        /// After how long it is there, 0.0001 to 3600 s.
        within_s: f64,
    },
    /// The finger follows the scene again, after a line of [`RELEASE_S`]. Load, push, target and voltage
    /// stay as they were set.
    Release {
        /// Which pad.
        pad: usize,
    },
    /// The load on a pad.
    Press {
        /// Which pad.
        pad: usize,
        /// The load, g.
        load_g: f64,
    },
    /// A push on a pad besides its finger, where the scene has a `[hand]`.
    Push {
        /// Which pad.
        pad: usize,
        /// Along x and y, N.
        newtons: [f64; 2],
    },
    /// The force that the controller gives a pad, where the case has a controller.
    Target {
        /// Which pad.
        pad: usize,
        /// The force, N.
        newtons: f64,
    },
    /// Where walls begin from now on, where the case has them. A wall without a place stays as it is.
    Wall {
        /// The wall along x, mm right of the sheet's centre.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        x_mm: Option<f64>,
        /// The wall along y, mm above the sheet's centre.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        y_mm: Option<f64>,
        /// There is no wall until one is given a place again.
        #[serde(default)]
        off: bool,
    },
    /// A new puck, where the case has an arena.
    Serve,
    /// The haptic voltage at a pad's source, where the case has no controller.
    Voltage {
        /// Which pad.
        pad: usize,
        /// The voltage, V rms.
        v_rms: f64,
    },
}

/// An input that a case does not take.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum InputError {
    /// There is no such pad.
    #[error("pad: expected below {pads}, got {pad}")]
    NoPad {
        /// Which was asked for.
        pad: usize,
        /// Pads of the case.
        pads: usize,
    },
    /// A value is out of its range, or no number.
    #[error("{key}: expected {} to {}, got {value}", range[0], range[1])]
    Range {
        /// Which value, with its unit.
        key: &'static str,
        /// The least and the largest.
        range: [f64; 2],
        /// What was given.
        value: f64,
    },
    /// The plant does not take it.
    #[error("{key}: {error}")]
    Plant {
        /// Which input.
        key: &'static str,
        /// Why.
        error: DriveError,
    },
    /// The case has nothing that takes it.
    #[error("{key}: {why}")]
    Absent {
        /// Which input.
        key: &'static str,
        /// What it needs.
        why: &'static str,
    },
}

/// Refuses a value out of its range.
fn within(key: &'static str, value: f64, range: [f64; 2]) -> Result<(), InputError> {
    let holds = (range[0]..=range[1]).contains(&value);
    if holds { Ok(()) } else { Err(InputError::Range { key, range, value }) }
}

impl Stepper {
    /// Applies an input from the beginning of the next slot on.
    ///
    /// # Errors
    /// No such pad, a value that is not finite or out of its range, an input that nothing of the case
    /// takes. An error changes nothing.
    pub fn apply(&mut self, input: &Input) -> Result<(), InputError> {
        match *input {
            Input::Lead { pad, to_mm, within_s } => self.lead(pad, to_mm, within_s),
            Input::Release { pad } => {
                let from_s = self.time_s();
                self.set_at("release", pad, |plant| plant.release(pad, from_s, from_s + RELEASE_S))
            }
            Input::Press { pad, load_g } => {
                let from_s = self.time_s();
                self.set_at("load_g", pad, |plant| plant.press(pad, load_g, from_s))
            }
            Input::Push { pad, newtons } => {
                let from_s = self.time_s();
                self.set_at("push", pad, |plant| plant.push(pad, newtons, from_s))
            }
            Input::Target { pad, newtons } => self.target(pad, newtons),
            Input::Wall { x_mm, y_mm, off } => self.wall([x_mm, y_mm], off),
            Input::Serve => self.serve(),
            Input::Voltage { pad, v_rms } => self.voltage(pad, v_rms),
        }
    }

    fn lead(&mut self, pad: usize, to_mm: [f64; 2], within_s: f64) -> Result<(), InputError> {
        within("within_s", within_s, WITHIN_S)?;
        let from_s = self.time_s();
        self.set_at("lead", pad, |plant| plant.lead(pad, to_mm, from_s, from_s + within_s))
    }

    fn voltage(&mut self, pad: usize, v_rms: f64) -> Result<(), InputError> {
        if matches!(self.source, Source::Closed(_)) {
            let why = "expected a case without [control], whose controller sets the voltage";
            return Err(InputError::Absent { key: "voltage", why });
        }
        let (from_s, parts) = (self.time_s(), self.plant().parts());
        self.set_at("voltage", pad, |plant| plant.set_drive(pad * parts, from_s, v_rms))
    }

    fn serve(&mut self) -> Result<(), InputError> {
        let Some(arena) = &mut self.arena else {
            return Err(InputError::Absent { key: "serve", why: "expected a case with [arena]" });
        };
        arena.serve();
        Ok(())
    }

    /// Refuses what the game of an arena decides.
    fn check_no_game(&self, key: &'static str) -> Result<(), InputError> {
        let why = "expected a case without [arena], whose game sets targets and walls";
        if self.arena.is_some() { Err(InputError::Absent { key, why }) } else { Ok(()) }
    }

    fn target(&mut self, pad: usize, newtons: f64) -> Result<(), InputError> {
        self.check_no_game("target")?;
        let control = self.case.profile.control.as_ref();
        let most_n = control.map(|control| control.target.real(control.target.max_code() as i64));
        let Some((plant, most_n)) = self.closed().zip(most_n) else {
            let why = "expected a case with [control]";
            return Err(InputError::Absent { key: "target", why });
        };
        let pads = plant.inputs().targets_n.len();
        let target_n =
            plant.inputs().targets_n.get_mut(pad).ok_or(InputError::NoPad { pad, pads })?;
        within("target_n", newtons, [0.0, most_n])?;
        *target_n = Some(newtons);
        Ok(())
    }

    fn wall(&mut self, places_mm: [Option<f64>; 2], off: bool) -> Result<(), InputError> {
        self.check_no_game("wall")?;
        let scene = self.case.plan().and_then(|plan| plan.wall.as_ref());
        let has_walls = [scene.is_some(), scene.is_some_and(|wall| wall.along_y.is_some())];
        let device = self.plant().device();
        let half_mm = [device.width_mm, device.height_mm].map(|size_mm| size_mm / 2.0);
        let absent = |why| Err(InputError::Absent { key: "wall", why });
        let Some(plant) = self.closed().filter(|_| has_walls[0]) else {
            return absent("expected a case with [wall]");
        };
        match (places_mm, off) {
            ([None, None], true) => plant.inputs().walls = [WallInput::Off; 2],
            ([None, None], false) => return absent("expected x_mm, y_mm or off"),
            (_, true) => return absent("expected either a place or off"),
            ([_, Some(_)], false) if !has_walls[1] => {
                return absent("expected no y_mm: the case has no wall along y");
            }
            (places_mm, false) => {
                for (axis, key) in ["x_mm", "y_mm"].into_iter().enumerate() {
                    let range = [-half_mm[axis], half_mm[axis]];
                    places_mm[axis].map_or(Ok(()), |mm| within(key, mm, range))?;
                }
                for (wall, place_mm) in plant.inputs().walls.iter_mut().zip(places_mm) {
                    *wall = place_mm.map_or(*wall, WallInput::At);
                }
            }
        }
        Ok(())
    }

    /// The plant of a case with a controller.
    fn closed(&mut self) -> Option<&mut LoopPlant> {
        match &mut self.source {
            Source::Open(_) => None,
            Source::Closed(plant) => Some(plant),
        }
    }

    /// An input of the plant at a pad.
    fn set_at(
        &mut self,
        key: &'static str,
        pad: usize,
        set: impl FnOnce(&mut hapticore_scene::Plant) -> Result<(), DriveError>,
    ) -> Result<(), InputError> {
        let pads = self.plant().served() / self.plant().parts();
        if pad >= pads {
            return Err(InputError::NoPad { pad, pads });
        }
        set(self.source.maker().plant()).map_err(|error| InputError::Plant { key, error })
    }
}
