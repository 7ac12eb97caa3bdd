// SPDX-License-Identifier: MIT OR Apache-2.0
//! The device as its builder knows it: what a calibration may use.

use std::f64::consts::{PI, TAU};

use crate::error::{Place, SceneError};
use crate::format::{Key, Limits, Table, keys};
use crate::terminals::{VOLTAGES, terminals_mm};
use crate::timing::Timing;
use crate::wave::{self, HapticWave};

/// Permittivity of free space, F/m.
pub const EPSILON_0: f64 = 8.854_187_812_8e-12;

/// Standard gravity (docs/physics.md §3).
const GRAVITY_M_S2: f64 = 9.80665;

keys! { KEYS:
    /// Size of the sheet along x, larger than a pad.
    WIDTH_MM: f64 = Key::number("width_mm", Limits::above(0.1, 1e4)).or(860.0);
    /// Size of the sheet along y, larger than a pad.
    HEIGHT_MM: f64 = Key::number("height_mm", Limits::above(0.1, 1e4)).or(500.0);
    /// Diameter of a pad.
    PAD_DIAMETER_MM: f64 = Key::number("pad_diameter_mm", Limits::within(0.1, 1e4)).or(30.0);
    /// Coefficient of friction μ of pad and sheet.
    MU: f64 = Key::number("mu", Limits::within(1e-4, 10.0)).or(0.12);
    /// Weight of a load by its mass.
    GRAVITY: f64 = Key::number("gravity_m_s2", Limits::within(1e-3, 1e3)).or(GRAVITY_M_S2);
}

keys! { CARRIER_KEYS:
    /// Frequency of the sensing carrier.
    FREQUENCY_HZ: f64 = Key::number("frequency_hz", Limits::within(1.0, 1e9)).or(100e3);
    /// Amplitude of the sensing carrier, peak.
    AMPLITUDE_V: f64 = Key::number("amplitude_v", Limits::within(1e-6, 1e5)).or(5.0);
    /// Frequency of the haptic voltage, where it is a sine.
    HAPTIC_HZ: f64 = Key::number("haptic_hz", Limits::within(1e-3, 1e8)).or(1000.0);
}

keys! { FULL_SCALE_KEYS:
    /// Current at the end of a terminal's ADC range, peak.
    CURRENT_FULL_SCALE_MA: f64 = Key::number("current_full_scale_ma", Limits::within(1e-6, 1e6)).or(4.0);
    /// Sensing voltage at the end of its ADC range, peak.
    SENSE_FULL_SCALE_V: f64 = Key::number("sense_full_scale_v", Limits::within(1e-6, 1e6)).or(8.0);
    /// Haptic voltage at the end of its ADC range, peak.
    HAPTIC_FULL_SCALE_V: f64 = Key::number("haptic_full_scale_v", Limits::within(1e-3, 1e6)).or(600.0);
}

/// Sizes, full scales, frequencies and the nominal force law of the display.
///
/// ```
/// use hapticore_scene::Scene;
///
/// let scene = Scene::parse("title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\nterminals = 4\n", "t.toml", &[])?;
/// let device = &scene.cases[0].device;
/// assert_eq!((device.terminals(), device.channels(), device.haptic()), (4, 6, 5));
/// assert_eq!(device.reach_mm(), [415.0, 235.0]); // 860 × 500 mm, a pad of 30 mm
/// // Eq. 8: 318 pF at 300 V rms.
/// assert!((device.force_k * (318e-12 * 300f64).powi(2) - 0.0873).abs() < 1e-4);
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Device {
    /// Where the current sensors are, mm from the sheet's centre, in the order of their channels: 3
    /// to 16 of them.
    pub terminals_mm: Vec<[f64; 2]>,
    /// Current at the end of a terminal's ADC range, A (peak).
    pub current_full_scale_a: f64,
    /// Sensing voltage at the end of its ADC range, V (peak).
    pub sense_full_scale_v: f64,
    /// Haptic voltage at the end of its ADC range, V (peak).
    pub haptic_full_scale_v: f64,
    /// Amplitude of the sensing carrier, V (peak).
    pub carrier_v: f64,
    /// Frequency of the sensing carrier, Hz: the scene's, until a plant is built for a core.
    pub carrier_hz: f64,
    /// The same in rad/s.
    pub carrier_rad_s: f64,
    /// Frequency of the haptic voltage, Hz.
    pub haptic_hz: f64,
    /// How the haptic voltage goes on in time.
    pub haptic_wave: HapticWave,
    /// Time constant with which the supply recharges a pad in work, s; 0 without a supply.
    pub(crate) recharge_s: f64,
    /// ADC sample rate, Hz: the scene's carrier times the profile's samples per period, rounded.
    pub sample_rate_hz: f64,
    /// Size of the sheet along x, mm.
    pub width_mm: f64,
    /// Size of the sheet along y, mm.
    pub height_mm: f64,
    /// Diameter of a pad, mm.
    pub pad_diameter_mm: f64,
    /// Area S of a pad, m².
    pub pad_area_m2: f64,
    /// Coefficient of friction μ.
    pub mu: f64,
    /// Weight of a load by its mass, m/s².
    pub gravity_m_s2: f64,
    /// k of eq. 8 for an even gap, μ/(2ε₀S), in N/(F·V)²: F_h = k·(C·V_h)².
    pub force_k: f64,
}

impl Device {
    /// The largest haptic voltage that the core can read, V rms.
    pub(crate) fn readable_v(&self) -> f64 {
        self.haptic_full_scale_v / self.haptic_wave.crest()
    }

    /// The device under a core. The sample rate is the whole multiple of the scene's carrier that is
    /// nearest to its oscillator's samples per period. The carrier is what the oscillator makes of
    /// it: 101 kHz for 100 kHz at 9.9 samples.
    pub(crate) fn sampled(self, timing: &Timing) -> Self {
        let samples_per_period = timing.samples_per_period;
        let sample_rate_hz = self.carrier_hz * samples_per_period.round();
        let carrier_hz = sample_rate_hz / samples_per_period;
        let slot_s = timing.slot_samples as f64 / sample_rate_hz;
        let haptic_wave = self.haptic_wave.in_slots_of(slot_s, self.recharge_s);
        let carrier_rad_s = TAU * carrier_hz;
        Device { sample_rate_hz, carrier_hz, carrier_rad_s, haptic_wave, ..self }
    }

    /// Reads `[device]`, `[carrier]`'s voltages, frequencies and wave and `[sensor]`'s full scales; all
    /// have defaults.
    pub(crate) fn read(root: &Table) -> Result<Device, SceneError> {
        let number = |table: &'static str, key: Key<f64>| match root.table(table)? {
            Some(table) => table.get(&key),
            None => Table::new("", Place::File).get(&key),
        };
        let pad_diameter_mm = number("device", PAD_DIAMETER_MM)?;
        let smallest = Limits::above(pad_diameter_mm, 1e4);
        let mu = number("device", MU)?;
        let carrier_hz = number("carrier", FREQUENCY_HZ)?;
        let pad_area_m2 = PI / 4.0 * (pad_diameter_mm * 1e-3).powi(2);
        let mut device = Device {
            terminals_mm: Vec::new(),
            current_full_scale_a: 1e-3 * number("sensor", CURRENT_FULL_SCALE_MA)?,
            sense_full_scale_v: number("sensor", SENSE_FULL_SCALE_V)?,
            haptic_full_scale_v: number("sensor", HAPTIC_FULL_SCALE_V)?,
            carrier_v: number("carrier", AMPLITUDE_V)?,
            carrier_hz,
            carrier_rad_s: TAU * carrier_hz,
            haptic_hz: number("carrier", HAPTIC_HZ)?,
            haptic_wave: HapticWave::read(root)?,
            recharge_s: wave::recharge_s(root, pad_area_m2)?,
            sample_rate_hz: f64::NAN, // the profile's, known when a plant is built
            width_mm: number("device", WIDTH_MM.within(smallest))?,
            height_mm: number("device", HEIGHT_MM.within(smallest))?,
            pad_diameter_mm,
            pad_area_m2,
            mu,
            gravity_m_s2: number("device", GRAVITY)?,
            force_k: mu / (2.0 * EPSILON_0 * pad_area_m2),
        };
        device.terminals_mm = terminals_mm(root, [device.width_mm, device.height_mm])?;
        Ok(device)
    }

    /// Number of current sensors, channels `0 .. terminals`.
    pub fn terminals(&self) -> usize {
        self.terminals_mm.len()
    }

    /// Number of ADC channels: the terminals' currents, the sensing voltage, the haptic voltage.
    pub fn channels(&self) -> usize {
        self.terminals() + VOLTAGES
    }

    /// The channel of the sensing voltage.
    pub fn sense(&self) -> usize {
        self.terminals()
    }

    /// The channel of the haptic voltage.
    pub fn haptic(&self) -> usize {
        self.terminals() + 1
    }

    /// What presses a pad under a load, N.
    pub(crate) fn weight_n(&self, load_g: f64) -> f64 {
        1e-3 * load_g * self.gravity_m_s2
    }

    /// How far the centre of either electrode of a split pad is off the pad's, mm.
    pub(crate) fn electrode_offset_mm(&self) -> f64 {
        0.25 * self.pad_diameter_mm
    }

    /// How far from the sheet's centre a pad's centre may be, so that the pad lies wholly on the
    /// sheet.
    pub fn reach_mm(&self) -> [f64; 2] {
        [self.width_mm, self.height_mm].map(|size| (size - self.pad_diameter_mm) / 2.0)
    }
}
