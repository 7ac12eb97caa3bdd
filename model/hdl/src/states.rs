// SPDX-License-Identifier: MIT OR Apache-2.0
//! States of a state machine: an `enum` whose names reach the Verilog's legend and the waveform
//! viewer.
//!
//! ```
//! use hapticore_hdl::states::States;
//!
//! hapticore_hdl::states! {
//!     /// The steps of a division.
//!     pub enum Step {
//!         Idle,
//!         Divide,
//!         RoundUp,
//!     }
//! }
//! assert_eq!(Step::NAMES, ["idle", "divide", "round_up"]);
//! assert_eq!(Step::FORMAT.to_string(), "u2.0");
//! assert_eq!(Step::RoundUp.code(), 2);
//! ```

use crate::format::Format;
use crate::signal::{Signal, Value, int};

/// The states of a state machine, numbered from zero, which is the state at reset. Made by
/// [`states!`](crate::states!).
pub trait States: Copy + 'static {
    /// The states in the order of their codes.
    const ALL: &'static [Self];
    /// Their names in lower case, as the Verilog's legend and waveforms have them.
    const NAMES: &'static [&'static str];
    /// The format of a register that holds them.
    const FORMAT: Format = Format::counter(Self::NAMES.len() as u64 - 1);

    /// The number of the state.
    fn code(self) -> u64;

    /// The state as a constant signal.
    #[inline(always)]
    fn signal<V: Value>(self) -> Signal<V> {
        int(self.code())
    }
}

impl<V: Value> Signal<V> {
    /// Whether this register of a state machine holds a state.
    #[inline(always)]
    pub fn at(self, state: impl States) -> Self {
        self.is(state.code())
    }
}

/// Declares an `enum` with [`States`].
#[macro_export]
macro_rules! states {
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($(#[doc = $doc:literal])* $state:ident),* $(,)? }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $vis enum $name { $($(#[doc = $doc])* #[allow(missing_docs)] $state),* }

        impl $crate::states::States for $name {
            const ALL: &'static [Self] = &[$($name::$state),*];
            const NAMES: &'static [&'static str] = &[$({
                const NAME: &str = stringify!($state);
                const BYTES: [u8; $crate::states::snake_length(NAME)] = $crate::states::snake(NAME);
                $crate::states::text(&BYTES)
            }),*];

            #[inline(always)]
            fn code(self) -> u64 {
                self as u64
            }
        }
    };
}

/// Bytes of a name in `snake_case`. Used by [`states!`](crate::states!), as the two functions
/// below.
pub const fn snake_length(name: &str) -> usize {
    let (mut index, mut length) = (1, name.len());
    while index < name.len() {
        length += name.as_bytes()[index].is_ascii_uppercase() as usize;
        index += 1;
    }
    length
}

/// A name in `snake_case`, from `CamelCase`.
pub const fn snake<const N: usize>(name: &str) -> [u8; N] {
    let (mut snake, mut index, mut length) = ([b'_'; N], 0, 0);
    while index < name.len() {
        let byte = name.as_bytes()[index];
        length += (index > 0 && byte.is_ascii_uppercase()) as usize;
        snake[length] = byte.to_ascii_lowercase();
        (index, length) = (index + 1, length + 1);
    }
    snake
}

/// The text of ASCII bytes.
///
/// # Panics
/// Where they are no text.
pub const fn text(bytes: &'static [u8]) -> &'static str {
    match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => panic!("a name of a state is ASCII"),
    }
}
