// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[wall]`: the numbers of a virtual wall's sequential test (docs/physics.md §6). Times are frames
//! of the pad, lengths µm, so that the model needs no seconds.

use super::{
    Profile, ProfileError,
    check::{ensure, within},
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When a wall lets a pad go.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Release {
    /// Never: eq. 11.
    Never,
    /// In each frame whose push leads out, as it reads: eq. 12.
    Direct,
    /// When a sequential test on the push, or play of the position, says so.
    #[default]
    Sequential,
}

/// A virtual wall of a split pad. What a profile does not name is as in rule A at 1 ms frames.
///
/// ```
/// use hapticore_contract::profile::{Profile, Wall};
///
/// let mut profile = Profile::bundled("small")?;
/// assert_eq!(profile.wall, None, "no bundled profile has a wall");
/// profile.wall = Some(Wall { engage: 0, ..Wall::A });
/// let message = profile.check_values().unwrap_err().to_string();
/// assert_eq!(message, "wall.engage: expected 1 to 63, got 0");
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Wall {
    /// Slots of a pad, one for each of its parts. With 2 parts, left and right sense and brake; with 3, the last brakes
    /// alone. With 4, quadrants sense and brake, top left, bottom left, bottom right and top right, with a wall along
    /// either axis.
    #[schemars(range(min = 2, max = 4))]
    pub parts: u64,
    /// When it lets go.
    pub rule: Release,
    /// h1: evidence, in standard deviations, that lets go.
    #[schemars(range(min = 1, max = 63))]
    pub release: u64,
    /// h2: evidence that engages again.
    #[schemars(range(min = 1, max = 63))]
    pub engage: u64,
    /// bf in sixteenths: by how much of the friction's asymmetry letting go is advanced.
    #[schemars(range(min = 0, max = 255))]
    pub advance_16: u64,
    /// kb in sixteenths: by how much of it engaging is delayed.
    #[schemars(range(min = 0, max = 255))]
    pub delay_16: u64,
    /// Frames that a state lasts at least.
    #[schemars(range(min = 0, max = 1023))]
    pub dwell_frames: u64,
    /// Frames in which the force comes back when the wall engages again.
    #[schemars(range(min = 1, max = 1023))]
    pub ramp_frames: u64,
    /// Frames without voltage after which the direction is learnt.
    #[schemars(range(min = 1, max = 1023))]
    pub zero_frames: u64,
    /// Speed from which it is learnt, µm per frame.
    #[schemars(range(min = 1, max = 10000))]
    pub learn_um: u64,
    /// Speed beyond which only play releases, or nothing engages, µm per frame.
    #[schemars(range(min = 1, max = 10000))]
    pub fast_um: u64,
    /// Play of the position, µm; also the way after which a direction of motion counts: half of it along the surface is
    /// sliding.
    #[schemars(range(min = 1, max = 10000))]
    pub play_um: u64,
    /// Distance from the wall at which air is free, µm.
    #[schemars(range(min = 1, max = 10000))]
    pub clear_um: u64,
    /// Frames without a slip inwards after which the force of a push that reads weaker falls; 0 where it never
    /// does.
    #[schemars(range(min = 0, max = 1023))]
    pub quiet_frames: u64,
    /// What counts as a slip, µm.
    #[schemars(range(min = 1, max = 10000))]
    pub slip_um: u64,
    /// The force beyond which no direction reading releases, where a stationary push's force may fall, mN.
    #[schemars(range(min = 0, max = 10000))]
    pub latch_mn: u64,
}

impl Wall {
    /// Rule A, for a pad whose sensing strips stay at a low voltage.
    pub const A: Wall = Wall {
        parts: 3,
        rule: Release::Sequential,
        release: 3,
        engage: 8,
        advance_16: 5,
        delay_16: 16,
        dwell_frames: 20,
        ramp_frames: 40,
        zero_frames: 10,
        learn_um: 10,
        fast_um: 20,
        play_um: 200,
        clear_um: 200,
        quiet_frames: 0,
        slip_um: 25,
        latch_mn: 750,
    };
    /// Rule B, for halves that sense and brake.
    pub const B: Wall = Wall {
        parts: 2,
        release: 4,
        engage: 12,
        advance_16: 0,
        delay_16: 24,
        dwell_frames: 64,
        quiet_frames: 100,
        ..Wall::A
    };
    /// Rule B along both axes, for quadrants that sense and brake.
    pub const QUADRANTS: Wall = Wall { parts: 4, ..Wall::B };
    /// The part of a pad by whose number its wall along y is known; that along x by the last one's.
    pub const PART_OF_Y: u64 = 2;
}

impl Wall {
    /// The axes along which a pad has a wall: x alone, or x and y.
    pub fn axes(&self) -> u64 {
        if self.parts == 4 { 2 } else { 1 }
    }

    /// The same times and speeds with frames of another length than 1 ms.
    ///
    /// ```
    /// use hapticore_contract::profile::Wall;
    ///
    /// let wall = Wall::A.at_frames_of(4.0);
    /// assert_eq!((wall.ramp_frames, wall.fast_um, wall.play_um), (10, 80, 200));
    /// ```
    pub fn at_frames_of(self, milliseconds: f64) -> Wall {
        let frames = |count: u64| (count as f64 / milliseconds).round() as u64;
        let um = |speed: u64| ((speed as f64 * milliseconds).round() as u64).clamp(1, 10_000);
        Wall {
            dwell_frames: frames(self.dwell_frames).min(1023),
            ramp_frames: frames(self.ramp_frames).clamp(1, 1023),
            zero_frames: frames(self.zero_frames).clamp(1, 1023),
            quiet_frames: match self.quiet_frames {
                0 => 0,
                quiet => frames(quiet).clamp(1, 1023),
            },
            learn_um: um(self.learn_um),
            fast_um: um(self.fast_um),
            ..self
        }
    }
}

impl Default for Wall {
    fn default() -> Self {
        Wall::A
    }
}

impl Profile {
    pub(super) fn check_wall(&self) -> Result<(), ProfileError> {
        let Some(wall) = self.wall else { return Ok(()) };
        for (field, value, low, high) in [
            ("wall.parts", wall.parts, 2, 4),
            ("wall.release", wall.release, 1, 63),
            ("wall.engage", wall.engage, 1, 63),
            ("wall.advance_16", wall.advance_16, 0, 255),
            ("wall.delay_16", wall.delay_16, 0, 255),
            ("wall.dwell_frames", wall.dwell_frames, 0, 1023),
            ("wall.ramp_frames", wall.ramp_frames, 1, 1023),
            ("wall.zero_frames", wall.zero_frames, 1, 1023),
            ("wall.learn_um", wall.learn_um, 1, 10_000),
            ("wall.fast_um", wall.fast_um, 1, 10_000),
            ("wall.play_um", wall.play_um, 1, 10_000),
            ("wall.clear_um", wall.clear_um, 1, 10_000),
            ("wall.quiet_frames", wall.quiet_frames, 0, 1023),
            ("wall.slip_um", wall.slip_um, 1, 10_000),
            ("wall.latch_mn", wall.latch_mn, 0, 10_000),
        ] {
            within(field, value, low, high)?;
        }
        ensure(self.control.is_some(), "control", "a table, since [wall] drives the pads", "none")?;
        let parts = wall.parts;
        ensure(
            self.pads.is_multiple_of(parts),
            "pads",
            format_args!("a multiple of wall.parts, {parts}"),
            self.pads,
        )
    }
}
