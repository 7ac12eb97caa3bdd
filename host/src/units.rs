// SPDX-License-Identifier: MIT OR Apache-2.0
//! Units: the core's numbers in volts, ohms, picofarads, millimetres and newtons.

use crate::device::Scales;
use hapticore_contract::frame::{Flags, Measurement};
use hapticore_contract::profile::Profile;

/// From a core's numbers to physical units.
///
/// ```
/// use hapticore_host::{DeviceCalibration, Flags, Frame, Profile, Units};
///
/// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
/// let profile = Profile::bundled("standard")?;
/// let units = Units::new(&profile, &device.device);
/// let frame = Frame { pad: 0, codes: [0, 0, 128, -64, 512, 256, 65_536, 0], flags: Flags::default() };
/// let measured = units.quantities(&frame.measurement(&profile));
/// assert_eq!((measured.x_mm, measured.y_mm, measured.haptic_v_rms), (1.0, -0.5, 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Units {
    ohm: f64,
    haptic_v: f64,
    square_gain: f64,
}

impl Units {
    /// The units of a core of the profile on a device.
    pub fn new(profile: &Profile, scales: &Scales) -> Self {
        Units {
            ohm: scales.ohm(),
            haptic_v: scales.haptic_full_scale_v,
            square_gain: profile.square_gain(),
        }
    }

    pub(crate) fn sheet_ohm(&self, measurement: &Measurement) -> f64 {
        measurement.sheet * self.ohm
    }

    pub(crate) fn haptic_v_rms(&self, measurement: &Measurement) -> f64 {
        self.haptic_v * (measurement.mean_square / self.square_gain).sqrt()
    }
}

/// The names of a frame's flags that are set.
///
/// ```
/// use hapticore_host::{Flags, flag_names};
///
/// let flags = Flags { clipped: true, invalid: true, ..Flags::default() };
/// assert_eq!(flag_names(flags).collect::<Vec<_>>(), ["clipped", "invalid"]);
/// ```
pub fn flag_names(flags: Flags) -> impl Iterator<Item = &'static str> {
    let named = [
        (flags.clipped, "clipped"),
        (flags.saturated, "saturated"),
        (flags.invalid, "invalid"),
        (flags.lost, "lost"),
        (flags.lifted, "lifted"),
    ];
    named.into_iter().filter(|(set, _)| *set).map(|(_, name)| name)
}

/// When slots are.
///
/// ```
/// use hapticore_host::{Profile, SlotClock};
///
/// let profile = Profile::bundled("standard")?;
/// let mut clock = SlotClock::new(&profile, 1e6, 0.0);
/// let period = clock.seconds(1);
/// assert!((clock.tick() - period).abs() < period / 2.0, "the middle of the first slot's window");
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct SlotClock {
    start_s: f64,
    slot_samples: f64,
    middle: f64,
    sample_rate_hz: f64,
    slots: u64,
}

impl SlotClock {
    /// Slots of the profile from `start_s` on.
    pub fn new(profile: &Profile, sample_rate_hz: f64, start_s: f64) -> Self {
        let middle = profile.slot.blanking() as f64 + profile.slot.integrate as f64 / 2.0;
        SlotClock {
            start_s,
            slot_samples: profile.slot.samples() as f64,
            middle,
            sample_rate_hz,
            slots: 0,
        }
    }

    /// The middle of the next slot's window, s.
    pub fn tick(&mut self) -> f64 {
        let samples = self.slots as f64 * self.slot_samples + self.middle;
        self.slots += 1;
        self.start_s + samples / self.sample_rate_hz
    }

    /// The middle of the window of the frame with this sequence number, s: as [`SlotClock::tick`],
    /// but for slots whose frames are lost, up to 65,535 at a time.
    ///
    /// ```
    /// # use hapticore_host::{Profile, SlotClock};
    /// # let profile = Profile::bundled("standard")?;
    /// let mut clock = SlotClock::new(&profile, 1e6, 0.0);
    /// let (first, fourth) = (clock.time_of(1), clock.time_of(4));
    /// assert!((fourth - first - clock.seconds(3)).abs() < 1e-12);
    /// # Ok::<(), hapticore_host::ProfileError>(())
    /// ```
    pub fn time_of(&mut self, sequence: u16) -> f64 {
        let lost = sequence.wrapping_sub(self.slots as u16).wrapping_sub(1);
        self.slots += u64::from(lost);
        self.tick()
    }

    /// When the first slot begins, s.
    pub fn start_s(&self) -> f64 {
        self.start_s
    }

    /// Samples of the ADC a second.
    pub fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// How long `slots` take, s.
    pub fn seconds(&self, slots: usize) -> f64 {
        slots as f64 * self.slot_samples / self.sample_rate_hz
    }
}
