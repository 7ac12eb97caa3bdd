// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bundles: named groups of registers or ports, generic over what a field holds.
//!
//! The same struct holds formats, stored values or signals, and [`Bundle::map`] and [`Bundle::zip`] go between them.
//! Names in Verilog, in waveforms and in equality checks all come from this one declaration.

use crate::signal::{Signal, Value};

/// A family of structs with the same named fields, each field of one type. Made by [`bundle!`](crate::bundle!).
pub trait Bundle: 'static {
    /// The struct whose fields hold a `T`.
    type Of<T: Copy>: Copy;

    /// The names of the fields.
    const NAMES: &'static [&'static str];
    /// For each field the names of its codes, where it is a state.
    const STATES: &'static [&'static [&'static str]];

    /// The struct with `f` of each field.
    fn map<T: Copy, U: Copy>(bundle: Self::Of<T>, f: impl FnMut(T) -> U) -> Self::Of<U>;

    /// The struct of pairs.
    fn zip<T: Copy, U: Copy>(a: Self::Of<T>, b: Self::Of<U>) -> Self::Of<(T, U)>;

    /// The signals of `then` where the bit is set, else those of `otherwise`: a multiplexer for each field. A reading that
    /// knows the bit evaluates one of the two.
    #[inline(always)]
    fn when<V: Value>(
        bit: Signal<V>,
        then: impl FnOnce() -> Self::Of<Signal<V>>,
        otherwise: impl FnOnce() -> Self::Of<Signal<V>>,
    ) -> Self::Of<Signal<V>> {
        match V::known(bit.value) {
            Some(true) => then(),
            Some(false) => otherwise(),
            None => Self::map(Self::zip(then(), otherwise()), |(a, b)| bit.select(a, b)),
        }
    }

    /// Calls `f` with the name and content of each field.
    fn each<T: Copy>(bundle: Self::Of<T>, mut f: impl FnMut(&'static str, T)) {
        let mut names = Self::NAMES.iter();
        Self::map(bundle, |field| f(names.next().expect("as many names as fields"), field));
    }
}

/// The bundle with no field: of a block that has no register of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Nothing<T = ()>(std::marker::PhantomData<T>);

impl<T> Default for Nothing<T> {
    fn default() -> Self {
        Nothing(std::marker::PhantomData)
    }
}

impl Bundle for Nothing<()> {
    type Of<T: Copy> = Nothing<T>;
    const NAMES: &'static [&'static str] = &[];
    const STATES: &'static [&'static [&'static str]] = &[];

    fn map<T: Copy, U: Copy>(_bundle: Nothing<T>, _f: impl FnMut(T) -> U) -> Nothing<U> {
        Nothing::default()
    }

    fn zip<T: Copy, U: Copy>(_a: Nothing<T>, _b: Nothing<U>) -> Nothing<(T, U)> {
        Nothing::default()
    }
}

/// Declares a [`Bundle`]. A field that is a state lists the names of its codes: `step: ["idle", "run"]`.
#[macro_export]
macro_rules! bundle {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$field_meta:meta])* $field:ident $(: [$($state:literal),* $(,)?])?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $vis struct $name<T = ()> {
            $($(#[$field_meta])* #[allow(missing_docs)] pub $field: T,)*
        }

        impl $crate::bundle::Bundle for $name<()> {
            type Of<T: Copy> = $name<T>;
            const NAMES: &'static [&'static str] = &[$(stringify!($field)),*];
            const STATES: &'static [&'static [&'static str]] = &[$(&[$($($state),*)?]),*];

            #[inline(always)]
            fn map<T: Copy, U: Copy>(bundle: $name<T>, mut f: impl FnMut(T) -> U) -> $name<U> {
                $name { $($field: f(bundle.$field)),* }
            }

            #[inline(always)]
            fn zip<T: Copy, U: Copy>(a: $name<T>, b: $name<U>) -> $name<(T, U)> {
                $name { $($field: (a.$field, b.$field)),* }
            }
        }
    };
}
