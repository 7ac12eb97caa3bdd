// SPDX-License-Identifier: MIT OR Apache-2.0
//! What of a profile is varied: word lengths bit by bit, block-floating words, and the window.
//!
//! A word that gets shorter loses its last bits; its range stays. Words that are one choice move
//! together: those of a channel and of the total, those of the position table and of the positions.
//! The words of a force controller are turned where the profile has one.
//! Block-floating words are another way to have small currents keep their bits: with them the words may
//! stay short.

use hapticore_contract::control::Control;
use hapticore_contract::profile::{Method, Profile};
use hapticore_hdl::format::Format;

/// One thing that is varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Knob {
    /// Bits of the ADC.
    Adc,
    /// Bits of the oscillator's and of the window's words.
    Oscillator,
    /// Bits of the in-phase and quadrature words, and of their total.
    Words,
    /// Bits of the ratios.
    Ratio,
    /// Bits of the position table's words, and of the positions.
    Table,
    /// Bits of the admittance.
    Admittance,
    /// Bits of the capacitance.
    Capacitance,
    /// Bits of the haptic voltage's mean square.
    MeanSquare,
    /// Bits of the squares that lead to the force.
    Square,
    /// Bits of the force.
    Force,
    /// Bits of a controller's drive words, and of its roots of forces.
    Drive,
    /// Bits of a controller's target forces.
    Target,
    /// Bits of a controller's gains.
    Gain,
    /// Bits by which the in-phase and quadrature words may be moved up together; none: they all have
    /// one point.
    BlockShift,
    /// Samples of the window.
    Window,
}

impl Knob {
    /// All of them.
    pub const ALL: [Knob; 15] = [
        Knob::Adc,
        Knob::Oscillator,
        Knob::Words,
        Knob::Ratio,
        Knob::Table,
        Knob::Admittance,
        Knob::Capacitance,
        Knob::MeanSquare,
        Knob::Square,
        Knob::Force,
        Knob::Drive,
        Knob::Target,
        Knob::Gain,
        Knob::BlockShift,
        Knob::Window,
    ];

    /// The words of a core, which are counted in bits.
    pub fn words() -> impl Iterator<Item = Knob> {
        let others = [Knob::BlockShift, Knob::Window];
        Knob::ALL.into_iter().filter(move |knob| !others.contains(knob) && !knob.is_of_controller())
    }

    /// The words of a force controller, which not every profile has.
    pub fn is_of_controller(self) -> bool {
        matches!(self, Knob::Drive | Knob::Target | Knob::Gain)
    }

    /// The words that a search may change. Not the oscillator's: what they reject, disturbances and
    /// leakage (docs/lock-in.md), does not show in errors on clean slots.
    pub fn searched() -> impl Iterator<Item = Knob> {
        Knob::words().filter(|knob| *knob != Knob::Oscillator)
    }

    /// Its key in a profile.
    pub fn key(self) -> &'static str {
        match self {
            Knob::Adc => "adc",
            Knob::Oscillator => "oscillator",
            Knob::Words => "iq",
            Knob::Ratio => "ratio",
            Knob::Table => "table",
            Knob::Admittance => "admittance",
            Knob::Capacitance => "capacitance",
            Knob::MeanSquare => "mean_square",
            Knob::Square => "square",
            Knob::Force => "force",
            Knob::Drive => "drive",
            Knob::Target => "target",
            Knob::Gain => "gain",
            Knob::BlockShift => "block_shift",
            Knob::Window => "slot.integrate",
        }
    }

    /// Where it stands: bits, or samples; zero, where the profile has no controller.
    pub fn value(self, profile: &Profile) -> u64 {
        let f = &profile.formats;
        let controls = |word: fn(&Control) -> Format| {
            profile.control.as_ref().map_or(0, |of| word(of).width.into())
        };
        let format = match self {
            Knob::Adc => f.adc,
            Knob::Oscillator => f.oscillator,
            Knob::Words => f.iq,
            Knob::Ratio => f.ratio,
            Knob::Table => f.table,
            Knob::Admittance => f.admittance,
            Knob::Capacitance => f.capacitance,
            Knob::MeanSquare => f.mean_square,
            Knob::Square => f.square,
            Knob::Force => f.force,
            Knob::Drive => return controls(|of| of.drive),
            Knob::Target => return controls(|of| of.target),
            Knob::Gain => return controls(|of| of.gain),
            Knob::BlockShift => return f.block_shift.into(),
            Knob::Window => return profile.slot.integrate,
        };
        format.width.into()
    }

    /// The profile with this knob at a value; none where no core can be built of it.
    pub fn set(self, profile: &Profile, value: u64) -> Option<Profile> {
        let turned = self.turn(profile, value)?;
        hapticore_model::check(&turned).is_ok().then_some(turned)
    }

    /// The profile with this knob at a value, whether or not a core can be built of it; none where a
    /// word would be too short or too long to be written.
    pub fn turn(self, profile: &Profile, value: u64) -> Option<Profile> {
        let by = i64::try_from(value).ok()? - i64::try_from(self.value(profile)).ok()?;
        let mut turned = match self {
            Knob::Window => {
                let least = if profile.carrier.method == Method::Polyphase { 5 } else { 1 };
                profile.clone().with_window(value / least * least)
            }
            _ => profile.clone(),
        };
        match self {
            Knob::Window => (),
            Knob::BlockShift => move_block(&mut turned, u8::try_from(value).ok()?),
            _ => self.lengthen(&mut turned, i8::try_from(by).ok()?)?,
        }
        Some(turned)
    }

    /// Profiles with other block-floating words, of which cores can be built.
    pub fn other_blocks(profile: &Profile) -> impl Iterator<Item = Profile> {
        let others = BLOCKS.into_iter().filter(|&shift| shift != Knob::BlockShift.value(profile));
        others.filter_map(|shift| Knob::BlockShift.set(profile, shift))
    }

    fn lengthen(self, profile: &mut Profile, by: i8) -> Option<()> {
        let (f, control) = (&mut profile.formats, profile.control.as_mut());
        let formats: Vec<&mut Format> = match self {
            Knob::Adc => vec![&mut f.adc],
            Knob::Oscillator => vec![&mut f.oscillator],
            Knob::Words => vec![&mut f.iq, &mut f.total],
            Knob::Ratio => vec![&mut f.ratio],
            Knob::Table => vec![&mut f.table, &mut f.position],
            Knob::Admittance => vec![&mut f.admittance],
            Knob::Capacitance => vec![&mut f.capacitance],
            Knob::MeanSquare => vec![&mut f.mean_square],
            Knob::Square => vec![&mut f.square],
            Knob::Force => vec![&mut f.force],
            Knob::Drive => vec![&mut control?.drive],
            Knob::Target => vec![&mut control?.target],
            Knob::Gain => vec![&mut control?.gain],
            Knob::BlockShift | Knob::Window => vec![],
        };
        for format in formats {
            format.width = format.width.checked_add_signed(by).filter(|width| *width > 2)?;
            format.frac = format.frac.checked_add(by)?;
        }
        if self == Knob::Oscillator {
            // The code that stands for one keeps its share of the words' range.
            let amplitude = profile.carrier.amplitude as f64 * 2f64.powi(by.into());
            profile.carrier.amplitude = amplitude.round() as u64;
        }
        Some(())
    }
}

/// Shifts of block-floating words that are tried.
const BLOCKS: [u64; 4] = [0, 4, 8, 12];
/// By how many bits a total is wider than a terminal's word with the same point.
const TOTAL_BITS: u8 = 2;

/// Sets by how many bits words may be moved up. Words that may not be moved have the total's point.
fn move_block(profile: &mut Profile, shift: u8) {
    let f = &mut profile.formats;
    f.block_shift = shift;
    if shift == 0 && f.total.frac != f.iq.frac {
        f.total = Format { width: f.iq.width + TOTAL_BITS, ..f.iq };
    }
}
