// SPDX-License-Identifier: MIT OR Apache-2.0
//! Drive: what commands write on a board that drives its pads, and what its packets say of it.
//!
//! | place (hex) | word |
//! | --- | --- |
//! | 4000 + n | [`Setting`] n |
//! | 5000 + n | word n of the controller's curve |
//! | 6000 + n | target force of pad n |
//! | 7000 + n | surface of pad n's wall, its inside left of it; 7800 + n: right of it |
//!
//! Whichever is written, the controller takes it as a sign of life of the host. A split pad bears the number of its last part.
//! A packet of such a board has two words more behind those of its frame: the last drive word, and [`status`].

use hapticore_contract::control::{Control, Walls};
use hapticore_contract::profile::Profile;
use hapticore_hdl::format::{BIT, Format};

/// Settings as an enumeration, by number, and what is said of each.
macro_rules! settings {
    ($($(#[doc = $about:literal])+ $name:ident;)*) => {
        /// Settings of controller and walls, by number.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Setting {
            $($(#[doc = $about])+ $name,)*
        }

        impl Setting {
            /// All settings, in the order of their numbers.
            pub const ALL: [Setting; [$(stringify!($name)),*].len()] = [$(Setting::$name),*];

            /// What it is, for readers of a table.
            pub const fn about(self) -> &'static str {
                match self {
                    $(Setting::$name => concat!($($about),+),)*
                }
            }
        }
    };
}

/// The format of a place within those of the drive.
pub const PLACE: Format = Format::unsigned(14, 0);

/// Words of a packet behind those of a frame: the drive word, and what is said of it.
pub const PACKET_WORDS: u64 = 2;

/// Set in the place of a drive's word that is no register: then it is none of the position table either.
const SELECT: u16 = 0x4000;

/// Bits of a place that say which of [`Kind`] it is.
const KIND: u8 = 12;
/// The bit of a surface's place that says that the inside is right of it.
pub const RIGHT: u8 = 11;

/// Kinds of words, as their places number them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A setting.
    Setting,
    /// A word of the curve.
    Curve,
    /// A pad's target.
    Target,
    /// The surface of a pad's wall.
    Surface,
}

/// Bits of a packet's last word.
pub mod status {
    crate::bits! {
        /// The host was silent for too long.
        SILENCE = 0;
        /// Estimates of a pad were invalid for too long.
        SENSOR = 1;
        /// A force was beyond its cap.
        FORCE = 2;
        /// The drive is at zero and should be less.
        LOW = 3;
        /// The drive is at its rail and should be more.
        HIGH = 4;
        /// The user leaves the pad's wall.
        FREE = 5;
        /// Every channel of the converter has been set to zero since reset.
        LIVE = 6;
        /// The first of four bits: the pad of the drive word.
        PAD = 8;
    }
    /// Bits in all.
    pub const BITS: u8 = 12;
}

settings! {
    /// One: drives follow their targets. Zero, as after a reset: they go to zero.
    Enable;
    /// One over the haptic mean square at full drive.
    FullDrive;
    /// Gain of the error.
    Proportional;
    /// Filter or integral gain.
    Correction;
    /// Largest drive word.
    Rail;
    /// Largest change of a drive word from frame to frame.
    Slew;
    /// A larger force is a fault, N.
    ForceCap;
    /// Stiffness of the walls, N/mm.
    Stiffness;
    /// Largest force of a wall, N.
    Most;
    /// What the direction of a wall on the left reads without a push.
    Factory;
    /// The bits of [`Request`], which act once: clear faults, restart walls.
    Request;
}

/// The bits of [`Setting::Request`].
#[derive(Debug, Clone, Copy)]
pub struct Request;

impl Request {
    /// Clears the controller's faults.
    pub const CLEAR_FAULTS: u8 = 0;
    /// Walls start anew, as when pads are put on.
    pub const RESTART_WALLS: u8 = 1;
    /// The format of the word.
    pub const FORMAT: Format = Format::unsigned(2, 0);
}

impl Setting {
    /// Its format on a board of the profile; none without a controller.
    pub fn format(self, profile: &Profile) -> Option<Format> {
        let Control { drive, gain, .. } = *profile.control.as_ref()?;
        Some(match self {
            Setting::Enable => BIT,
            Setting::FullDrive | Setting::Proportional | Setting::Correction => gain,
            Setting::Rail | Setting::Slew => drive,
            Setting::ForceCap | Setting::Most => profile.formats.force,
            Setting::Stiffness => Walls::STIFFNESS,
            Setting::Factory => Walls::DIRECTION,
            Setting::Request => Request::FORMAT,
        })
    }
}

/// A word that commands write on a board that drives its pads.
///
/// ```
/// # use hapticore_protocol::drive::{DriveWord, Setting};
/// assert_eq!(DriveWord::Setting(Setting::Rail).place(), 0x4004);
/// assert_eq!(DriveWord::Surface { pad: 3, right: true }.place(), 0x7803);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DriveWord {
    /// A setting.
    Setting(Setting),
    /// A word of the curve, a drive word, by number.
    Curve(u16),
    /// The target force of a pad, N.
    Target(u8),
    /// The surface of a pad's wall, mm.
    Surface {
        /// Pad; of a split one the last part.
        pad: u8,
        /// Its inside is right of it.
        right: bool,
    },
}

impl DriveWord {
    /// The place that commands name.
    pub const fn place(self) -> u16 {
        let (kind, number) = match self {
            DriveWord::Setting(setting) => (Kind::Setting, setting as u16),
            DriveWord::Curve(number) => (Kind::Curve, number),
            DriveWord::Target(pad) => (Kind::Target, pad as u16),
            DriveWord::Surface { pad, right } => {
                (Kind::Surface, pad as u16 | (right as u16) << RIGHT)
            }
        };
        SELECT | kind.bits() << KIND | number
    }

    /// The word at a place; none where there is no word, or where the place is another's than the drive's.
    ///
    /// ```
    /// # use hapticore_protocol::drive::{DriveWord, Setting};
    /// assert_eq!(DriveWord::of_place(0x4004), Some(DriveWord::Setting(Setting::Rail)));
    /// assert_eq!(DriveWord::of_place(0x7803), Some(DriveWord::Surface { pad: 3, right: true }));
    /// assert_eq!(DriveWord::of_place(0x0004), None, "a word of the position table");
    /// ```
    pub fn of_place(place: u16) -> Option<Self> {
        let number = place & ((1 << KIND) - 1);
        let pad = u8::try_from(number & !(1 << RIGHT)).ok();
        match place >> KIND {
            0b100 => Setting::ALL.get(usize::from(number)).copied().map(DriveWord::Setting),
            0b101 => Some(DriveWord::Curve(number)),
            0b110 => u8::try_from(number).ok().map(DriveWord::Target),
            0b111 => Some(DriveWord::Surface { pad: pad?, right: number >> RIGHT != 0 }),
            _ => None,
        }
    }

    /// Its format on a board of the profile; none without a controller.
    pub fn format(self, profile: &Profile) -> Option<Format> {
        let control = profile.control.as_ref()?;
        match self {
            DriveWord::Setting(setting) => setting.format(profile),
            DriveWord::Curve(_) => Some(control.drive),
            DriveWord::Target(_) => Some(control.target),
            DriveWord::Surface { .. } => Some(profile.formats.position),
        }
    }
}

impl Kind {
    /// The two bits of a place that say it.
    pub const fn bits(self) -> u16 {
        self as u16
    }

    /// The lowest of these bits.
    pub const AT: u8 = KIND;
}

/// Bits of the widest word that commands write on a board of the profile, beside its registers.
pub fn widest(profile: &Profile) -> u8 {
    let settings = Setting::ALL.into_iter().map(DriveWord::Setting);
    let words =
        [DriveWord::Curve(0), DriveWord::Target(0), DriveWord::Surface { pad: 0, right: false }];
    let formats = settings.chain(words).filter_map(|word| word.format(profile));
    formats.map(|format| format.width).max().unwrap_or(0)
}
