// SPDX-License-Identifier: MIT OR Apache-2.0
//! The serial line between a board and its host, as both sides must know it.
//!
//! The gateware (`hapticore-rtl`) and the host library (`hapticore-host`) take every number of the
//! line from here: what is written down once cannot differ between them. How either side encodes
//! and decodes is its own, so that neither checks itself.
//!
//! | module | holds |
//! | --- | --- |
//! | [`framing`] | bytes: packets in the stream, flags, version, the digest of a profile |
//! | [`register`] | what commands may write, and where |
//! | [`drive`] | the same for a board that drives its pads |
//! | [`output`] | what such a board was printed for: converter, wave, full scale, clock |
//! | [`calibration`] | the words that make a calibrated sensor of a core: the one list of them |

/// Numbers of bits as constants, and a list of them: name, number, what is said of it.
macro_rules! bits {
    ($($(#[doc = $about:literal])+ $name:ident = $bit:literal;)*) => {
        $($(#[doc = $about])+ pub const $name: u8 = $bit;)*
        /// All of them: name, number, what it says.
        pub const ALL: &[(&str, u8, &str)] = &[$((stringify!($name), $bit, concat!($($about),+))),*];
    };
}
pub(crate) use bits;

pub mod calibration;
pub mod drive;
pub mod framing;
pub mod output;
pub mod register;

pub use calibration::{CalibrationWords, Constant, ConstantWord, WordFormats};
pub use drive::{DriveWord, Request, Setting};
pub use output::Output;
pub use register::{Control, Register};
