// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the plant reports of itself: its state in a slot, and the map that a calibration starts
//! from.

use num_complex::Complex64;

use crate::terminals::PerTerminal;

/// The plant in one slot, at the middle of its integration window.
///
/// ```
/// use hapticore_scene::{Plant, Quantity, Scene, Timing};
///
/// let text = "title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\nhaptic_v_rms = { sweep = [0, 300] }\n";
/// let scene = Scene::parse(text, "t.toml", &[])?;
/// # let timing = Timing {
/// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
/// # };
/// let mut plant = Plant::new(&scene, 0, &timing)?;
/// let (off, on) = (plant.truth(0), plant.truth(1));
/// assert_eq!((off.force_n, on.set.haptic_v_rms), (0.0, 300.0));
/// assert_eq!(Quantity::ForceN.true_value(&on), on.force_n);
/// assert!((on.time_s - off.time_s - 1.7e-3).abs() < 1e-12); // slots of 1.7 ms
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Time since the start of the case, s.
    pub time_s: f64,
    /// The pad that the slot serves, or the part of one, counted over all pads.
    pub pad: usize,
    /// The part of its pad that is served; 0 of a pad that is served as a whole.
    pub part: usize,
    /// Point of the sweep, 0 where nothing is swept.
    pub point: usize,
    /// Points that differ in position alone share a group.
    pub group: usize,
    /// Ratio of the true currents along x: eq. 2, with the signs of [`Timing`](crate::Timing).
    pub r_x: f64,
    /// The same along y, eq. 3.
    pub r_y: f64,
    /// Position, mm right of the sheet's centre.
    pub x_mm: f64,
    /// Position, mm above the sheet's centre.
    pub y_mm: f64,
    /// Capacitance between pad and sheet, pF.
    pub capacitance_pf: f64,
    /// Resistance R_p of the sheet at the pad, Ω.
    pub sheet_ohm: f64,
    /// Haptic voltage at the pad, V rms.
    pub haptic_v_rms: f64,
    /// Haptic force, N.
    pub force_n: f64,
    /// Friction that acts on the pad, N; 0 where `[friction]` has no law of motion.
    pub friction_n: f64,
    /// What of it is the haptic force's: what is beyond μ times the load, N.
    pub haptic_friction_n: f64,
    /// Force of finger and push on the pad along x and y, N; 0 without `[hand]`.
    pub hand_n: [f64; 2],
    /// Capacitances of the electrodes of a split pad from left to right, two or four, pF; 0 without
    /// `[halves]`.
    pub electrodes_pf: [f64; 4],
    /// Direction of the push, eq. 10; 0 without `[halves]`.
    pub direction: f64,
    /// Load on the pad, g.
    pub load_g: f64,
    /// What the scene sets the pad to, before any effect.
    pub set: Setpoint,
    /// The pad reaches over the edge; what the plant says is for a pad at the edge.
    pub over_edge: bool,
    /// The pad lies on another one; what the plant says is for pads that touch. Known only where
    /// pads are coupled.
    pub touching: bool,
}

/// What a scene sets a pad to in a slot: what may be swept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Position, mm right of the sheet's centre.
    pub x_mm: f64,
    /// Position, mm above the sheet's centre.
    pub y_mm: f64,
    /// Load on the pad, g.
    pub load_g: f64,
    /// Haptic voltage of the source, V rms.
    pub haptic_v_rms: f64,
    /// Capacitance where no gap decides it, pF.
    pub capacitance_pf: f64,
    /// Eccentricity of the push, mm.
    pub eccentricity_mm: f64,
    /// Force that a controller shall give, N; 0 without one.
    pub target_n: f64,
}

/// Takes a value of a setpoint.
type Taken = fn(&Setpoint) -> f64;

impl Setpoint {
    /// Where the pad's finger is, mm from the sheet's centre: where the pad should be, or what pulls it
    /// there with `[hand]`.
    pub fn finger_mm(&self) -> [f64; 2] {
        [self.x_mm, self.y_mm]
    }

    /// Keys and values, in the order in which a sweep varies them, the fastest first.
    const KEYS: [(&str, Taken); 7] = [
        ("x_mm", |set| set.x_mm),
        ("y_mm", |set| set.y_mm),
        ("load_g", |set| set.load_g),
        ("haptic_v_rms", |set| set.haptic_v_rms),
        ("capacitance_pf", |set| set.capacitance_pf),
        ("eccentricity_mm", |set| set.eccentricity_mm),
        ("target_n", |set| set.target_n),
    ];

    /// The value of a key: `load_g`; not a number for another key.
    ///
    /// ```
    /// use hapticore_scene::Setpoint;
    ///
    /// let set = Setpoint { load_g: 50.0, ..Setpoint::default() };
    /// assert_eq!(set.get("load_g"), 50.0);
    /// assert!(set.get("load").is_nan());
    /// ```
    pub fn get(&self, key: &str) -> f64 {
        Setpoint::KEYS.iter().find(|(known, _)| *known == key).map_or(f64::NAN, |(_, of)| of(self))
    }
}

/// A place of the calibration map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Position, mm right of the sheet's centre.
    pub x_mm: f64,
    /// Position, mm above the sheet's centre.
    pub y_mm: f64,
    /// Ratio of the currents along x.
    pub r_x: f64,
    /// Ratio of the currents along y.
    pub r_y: f64,
    /// Each terminal's current, as a share of the ratios' denominator.
    pub shares: PerTerminal<f64>,
    /// Resistance R_p of the sheet there, Ω.
    pub sheet_ohm: f64,
}

/// What the terminals measure of a resting pad.
#[derive(Clone, Debug, PartialEq)]
pub struct PadMeasurement {
    /// Current into each terminal per volt of sensing, S.
    pub siemens: Vec<Complex64>,
    /// Resistance R_p of the sheet there, Ω.
    pub sheet_ohm: f64,
}

/// A point of a friction calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForcePoint {
    /// Load on the pad, g.
    pub load_g: f64,
    /// Haptic voltage at the pad, V rms.
    pub haptic_v_rms: f64,
    /// That of the source that gives it, V rms: more, where `[supply]` lies between.
    pub source_v_rms: f64,
    /// Capacitance between pad and sheet, pF.
    pub capacitance_pf: f64,
    /// Haptic force, N.
    pub force_n: f64,
}
