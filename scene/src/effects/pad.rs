// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state that a slot's effects work on: one pad, and what it is driven by and hangs on.

use num_complex::Complex64;

use crate::device::Device;
use crate::terminals::PerTerminal;
use crate::wave::HapticWave;

/// A pad in one slot, as far as the effects have got.
#[derive(Clone, Debug)]
pub(crate) struct Pad {
    /// Which pad it is: effects with a state keep one for each.
    pub index: usize,
    /// The part that the slot serves, where each part of a split pad has a slot of its own.
    pub part: Option<usize>,
    /// Middle of the slot's window, since the start of the case.
    pub time_s: f64,
    pub x_mm: f64,
    pub y_mm: f64,
    pub load_g: f64,
    /// Haptic voltage at the source.
    pub source_v_rms: f64,
    /// What lies between source and pad, where an effect says it.
    pub supply: Option<Supply>,
    /// Haptic voltage at the pad.
    pub haptic_v_rms: f64,
    pub capacitance_f: f64,
    /// Electrostatic attraction summed over the pad, N; where no effect says otherwise that of an
    /// even gap, eq. 7.
    pub attraction_n: f64,
    /// A gap effect has summed the attraction over patches, so that eq. 7, and with it eq. 8, is no longer its law.
    pub uneven: bool,
    /// Haptic force, N, where an effect says it; else μ times the attraction of a gap's patches, or eq. 8 with the
    /// true capacitance and voltage, which is the same for an even gap.
    pub force_n: Option<f64>,
    /// Polarity of the haptic voltage: 1, −1, or 0 for a sine.
    pub polarity: f64,
    /// What charge in the insulators does to the attraction, where an effect says it.
    pub charge: Option<Charge>,
    /// How stiff the rubber is, by how stiff it was when the device was calibrated.
    pub stiffness: f64,
    /// How far along x the push is off the pad's centre.
    pub eccentricity_mm: f64,
    /// Eq. 10, where an effect says it.
    pub direction: f64,
    /// Capacitances of the electrodes from left to right, where an effect splits the pad.
    pub electrodes_f: [f64; 4],
    /// Force of finger and push on the pad, N: as last kept, until the effect that moves the pad
    /// says it for the pad's time.
    pub hand_n: [f64; 2],
    /// What pushes the pad besides its finger, N.
    pub push_n: [f64; 2],
    /// What the pad hangs on, where an effect says it; else it goes where its trajectory says.
    pub finger: Option<Finger>,
    /// Friction that acts on the pad, N, where an effect says it.
    pub friction_n: f64,
    /// What has become of the sheet's film since the device was calibrated.
    pub film: FilmChange,
    /// Share of the current through each terminal; real where the sheet is all there is.
    pub split: PerTerminal<Complex64>,
    /// What the pad sees of the sheet, Ω: the combined resistance R_p, or an impedance where an
    /// effect makes it one.
    pub sheet_ohm: Complex64,
    /// Current into each terminal per volt of sensing, S, where an effect says it; else each one's
    /// share of jωC/(1 + jωC·R_p).
    pub transfer: Option<PerTerminal<Complex64>>,
    /// What the haptic voltages of the other pads drive into each terminal, A (peak, in phase with
    /// the haptic voltage's sine), where an effect says it.
    pub leakage_of_others_a: Option<PerTerminal<Complex64>>,
    /// The pad reaches over the sheet's edge: it is taken as lying at the edge.
    pub over_edge: bool,
    /// The pad lies on another one: both are taken as touching.
    pub touching: bool,
}

/// What has become of a film: R_s(x, y)·(1 + rise + slope_x·x/width + slope_y·y/height), x and y
/// from the sheet's middle. What several effects do to it adds up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilmChange {
    /// In the middle, as a fraction.
    pub rise: f64,
    /// From the left edge to the right one, and from the bottom to the top.
    pub slope: [f64; 2],
}

impl FilmChange {
    /// The film that the scene describes.
    pub const NONE: FilmChange = FilmChange { rise: 0.0, slope: [0.0; 2] };
}

impl Pad {
    /// The haptic voltage at the pad, were its capacitance this.
    pub fn haptic_v_at(&self, capacitance_f: f64) -> f64 {
        self.supply
            .map_or(self.source_v_rms, |supply| self.source_v_rms * supply.share(capacitance_f))
    }

    /// What pulls the pad under a haptic voltage: the voltage itself, or what charge leaves of it.
    #[inline]
    pub fn pulling_v(&self, haptic_v_rms: f64) -> f64 {
        self.charge.map_or(haptic_v_rms, |charge| charge.square_under(haptic_v_rms).sqrt())
    }

    /// The haptic force as an effect says, or else of the nominal coefficient: what a gap's patches do, whether
    /// friction is simulated or not.
    pub fn haptic_force_n(&self, device: &Device) -> f64 {
        if self.uneven {
            return self.force_n.unwrap_or(device.mu * self.attraction_n);
        }
        let volt = self.pulling_v(self.haptic_v_rms);
        self.force_n.unwrap_or(device.force_k * (self.capacitance_f * volt).powi(2))
    }

    /// jωC/(1 + jωC·R_p): the pad's capacitance in series with the sheet, S.
    pub fn admittance(&self, rad_s: f64) -> Complex64 {
        hapticore_sheet::coupling::admittance(rad_s, self.capacitance_f, self.sheet_ohm)
    }

    /// Amplitudes of the terminals' currents, up to a common factor.
    pub fn amplitudes(&self) -> PerTerminal<f64> {
        self.transfer.unwrap_or(self.split).map(Complex64::norm)
    }

    /// Current into each terminal per volt of sensing, S: eqs. 1 and 4, or as an effect says.
    pub fn transfer(&self, device: &Device) -> PerTerminal<Complex64> {
        self.transfer.unwrap_or_else(|| {
            let total = self.admittance(device.carrier_rad_s);
            self.split.map(|share| total * share)
        })
    }

    /// Amplitudes of the terminals' channels, as fractions of full scale.
    pub fn terminal_amplitudes(&self, device: &Device) -> PerTerminal<Complex64> {
        let scale = device.carrier_v / device.current_full_scale_a;
        match &self.transfer {
            Some(transfer) => transfer.map(|siemens| siemens * scale),
            None => {
                let total = self.admittance(device.carrier_rad_s);
                self.split.map(|share| total * share * scale)
            }
        }
    }
}

/// A voltage V_c that charge in the insulators holds against the haptic voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Charge {
    pub volt: f64,
    /// How it has been rising up to now, V/s.
    pub volt_per_s: f64,
    /// Polarity of the haptic voltage, as a pad has it.
    pub polarity: f64,
}

impl Charge {
    /// (V − V_c)²; of a sine its mean, V² + V_c².
    pub fn square_under(self, haptic_v_rms: f64) -> f64 {
        let Charge { volt, polarity, .. } = self;
        match polarity {
            0.0 => haptic_v_rms.powi(2) + volt.powi(2),
            polarity => (polarity * haptic_v_rms - volt).powi(2),
        }
    }

    /// What it was a short time ago, since when nothing has stepped.
    pub fn ago(self, ago_s: f64) -> Charge {
        Charge { volt: self.volt - ago_s * self.volt_per_s, ..self }
    }
}

/// The impedance between source and pad at the haptic frequency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Supply {
    pub limiting_ohm: f64,
    pub transformer_h: f64,
    pub parasitic_f: f64,
    pub rad_s: f64,
    pub wave: HapticWave,
}

impl Supply {
    /// V_h/V_source.
    pub fn share(&self, capacitance_f: f64) -> f64 {
        match self.wave {
            HapticWave::Sine => self.share_of_sine(capacitance_f),
            HapticWave::Dc => 1.0,
            HapticWave::Square { turn_s } => {
                let tau_s = self.limiting_ohm * (capacitance_f + self.parasitic_f);
                let lost = tau_s / turn_s.unwrap_or(f64::INFINITY);
                (1.0 - 2.0 * lost * (0.5 / lost).tanh()).sqrt()
            }
        }
    }

    fn share_of_sine(&self, capacitance_f: f64) -> f64 {
        let impedance = Complex64::new(self.limiting_ohm, self.rad_s * self.transformer_h);
        let admittance = Complex64::new(0.0, self.rad_s * (capacitance_f + self.parasitic_f));
        1.0 / (1.0 + impedance * admittance).norm()
    }
}

/// Spring, damper and mass between the finger and the pad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finger {
    pub stiffness_n_per_m: f64,
    pub damping_n_s_per_m: f64,
    pub mass_kg: f64,
}
