// SPDX-License-Identifier: MIT OR Apache-2.0
//! The force controller of a core: its law and formats, and the numbers that tune it to a device.
//!
//! A controller gives a pad's drive word after each of its slots. Drive words are fractions of the
//! drive's full scale; s = √F is a fraction of the root of the largest target.
//!
//! ```text
//! open           d = D(s)
//! proportional   d = D(s) + c,          c += α·(K·(F_t − F) − c)          (paper, Fig. 8b: α = 1)
//! integral       d = D(s) + K·e + c,    c += K_i·e,   e = √F_t − √F
//! inverse        d = B + c·B,           c += K_i·e,   B = min(√(F_t / (k·C²·G)), D(s)),   |e| ≤ 2^-6, |c| ≤ ½
//! ```
//!
//! D is a curve that the host writes: the paper's feed-forward K·√F (eq. 9), a measured steady
//! curve, or, with the inverse law, the limit that keeps a pad of small capacitance from
//! overshooting as it is pulled in. G is the haptic mean square at full drive, at the pad. Against a
//! limit that holds the drive c goes as far as the limit lets it, a trim not at all: nothing winds up.
//!
//! With the inverse law c is a slow trim: the share by which the drive is more, or less, than device and supply
//! were calibrated for, until the force that is read is the target. Its error is that of the target before, whose drive
//! the force is of. It is limited, so that the milliseconds
//! in which a pad is pulled in move it little, and it stays as it is while the target is zero.

use hapticore_hdl::format::Format;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a drive word follows from target and measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// The curve alone (eq. 9).
    Open,
    /// The curve and a filtered multiple of the force's error (Fig. 8b).
    Proportional,
    /// The curve, a multiple and an integral of the error of the force's root.
    Integral,
    /// The voltage that gives the target at the capacitance just measured, limited by the curve and trimmed to the
    /// force that is read.
    Inverse,
}

impl Law {
    /// All laws.
    pub const ALL: [Law; 4] = [Law::Open, Law::Proportional, Law::Integral, Law::Inverse];

    /// Its name in a profile: `inverse`.
    pub fn name(self) -> &'static str {
        match self {
            Law::Open => "open",
            Law::Proportional => "proportional",
            Law::Integral => "integral",
            Law::Inverse => "inverse",
        }
    }
}

/// After contact a drive rises by 2^-[`CONTACT_SLEW_FRAC`] of full scale from frame to frame at most.
const CONTACT_SLEW_FRAC: i32 = 6;

/// The controller of a core.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// How a drive word follows from target and measurement.
    pub law: Law,
    /// Drive words: a fraction, unsigned. Roots of forces have the same format.
    pub drive: Format,
    /// Target forces, N: unsigned, one integer bit at least.
    pub target: Format,
    /// Gains.
    pub gain: Format,
    /// Cells of the curve, a power of two.
    #[schemars(range(min = 4, max = 1024))]
    pub cells: u64,
    /// The number of invalid frames of a pad in a row that are a fault.
    #[schemars(range(min = 1, max = 1048576))]
    pub invalid_frames: u64,
    /// Milliseconds without a sign of life from the host that are a fault; the last may be a part of one.
    #[serde(default = "silent_ms")]
    #[schemars(range(min = 2, max = 1000))]
    pub silent_ms: u64,
}

fn silent_ms() -> u64 {
    Control::SILENT_MS
}

impl Control {
    /// The time after which a host is missed where a profile does not say, ms.
    pub const SILENT_MS: u64 = 100;

    /// The inverse law's trim counts an error of roots to ±2^-[`Control::TRIM_ERROR_BITS`] of full scale.
    pub const TRIM_ERROR_BITS: u8 = 6;
    /// The inverse law's trim is ±2^-[`Control::TRIM_BITS`] of the drive at most.
    pub const TRIM_BITS: u8 = 1;

    /// The largest step of the trim for each root and frame: a quarter of that at which a pad whose force follows a frame late
    /// swings at full scale (K_i·√F/√F_full below 1, docs/physics.md §6).
    pub const MOST_TRIM_STEP: f64 = 0.25;

    /// Fractional bits by which a target is moved down to be below one; even, as its root is then
    /// moved by half of it.
    pub fn target_shift(&self) -> i8 {
        let bits = self.target.integer_bits().max(0) as i8;
        bits + (bits & 1)
    }

    /// The largest rise of a drive word from frame to frame after a pad has touched again, full scales, until its law
    /// has the drive that it wants. No setting of the host makes it larger.
    pub fn contact_slew(&self) -> f64 {
        let frac = i32::from(self.drive.frac).min(CONTACT_SLEW_FRAC);
        0.5f64.powi(frac)
    }

    /// The root of the largest target, √N, of which roots are fractions.
    pub fn root_full_scale(&self) -> f64 {
        2f64.powi(i32::from(self.target_shift()) / 2)
    }
}

/// The numbers that tune a controller, in the core's units.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuning {
    /// The curve D: drive words at s = 0, 1/cells, … 1.
    pub curve: Vec<f64>,
    /// 1/G: one over the haptic mean square, a frame's word, at full drive.
    pub full_drive: f64,
    /// K: drive per N (proportional) or per root (integral).
    pub proportional: f64,
    /// α (proportional); K_i, drive per root and frame (integral), or the trim's step per root (inverse).
    pub correction: f64,
    /// The largest drive word.
    pub rail: f64,
    /// The largest change of a drive word from frame to frame; it does not limit off, a fault or a lower rail.
    pub slew: f64,
    /// A force beyond it is a fault, N.
    pub force_cap: f64,
    /// The walls of split pads, where the profile has them.
    pub walls: Option<Walls>,
}

/// Virtual walls.
#[derive(Debug, Clone, PartialEq)]
pub struct Walls {
    /// Stiffness, N/mm.
    pub stiffness_n_per_mm: f64,
    /// The largest force, N.
    pub most_n: f64,
    /// What the direction u of a wall on the left reads without a push; that of a wall along y reads
    /// nothing.
    pub factory: f64,
    /// The walls are right of their surfaces.
    pub right: bool,
}

/// Where a wall begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Place along the wall's axis, mm.
    pub mm: f64,
    /// The wall is right of it, or above it.
    pub right: bool,
}

impl Walls {
    /// The format of a stiffness, N/mm.
    pub const STIFFNESS: Format = Format::unsigned(16, 12);
    /// The format of a direction u.
    pub const DIRECTION: Format = Format::signed(13, 13);
}

impl Tuning {
    /// A controller that does nothing but hold its drive within full scale.
    pub fn idle(control: &Control) -> Self {
        Tuning {
            curve: vec![0.0; control.cells as usize + 1],
            full_drive: 1.0,
            proportional: 0.0,
            correction: 0.0,
            rail: 1.0,
            slew: 1.0,
            force_cap: f64::INFINITY,
            walls: None,
        }
    }
}

/// Faults of a controller: each takes every drive to zero immediately, until it is cleared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Faults {
    /// The host was silent for too long.
    pub silence: bool,
    /// Estimates of a pad were invalid for too long.
    pub sensor: bool,
    /// A force was beyond its cap.
    pub force: bool,
}

impl Faults {
    /// Whether there is one.
    pub fn any(self) -> bool {
        self.silence | self.sensor | self.force
    }
}

/// What a controller gives after a slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// Pad number, from 0.
    pub pad: usize,
    /// Part of the drive's full scale.
    pub fraction: f64,
    /// The drive is at zero and should be less.
    pub low: bool,
    /// The drive is at its rail and should be more.
    pub high: bool,
    /// What keeps the drives at zero.
    pub faults: Faults,
    /// What the pad's wall made of it, where it has one.
    pub walled: Option<Walled>,
}

/// What a wall makes of a pad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walled {
    /// The force that the drive is for, N.
    pub target_n: f64,
    /// The user leaves the wall.
    pub free: bool,
}
