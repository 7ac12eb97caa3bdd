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
    /// For each field what its declaration says of it.
    const DOCS: &'static [&'static str];

    /// The struct with `f` of each field.
    fn map<T: Copy, U: Copy>(bundle: Self::Of<T>, f: impl FnMut(T) -> U) -> Self::Of<U>;

    /// The struct of pairs.
    fn zip<T: Copy, U: Copy>(a: Self::Of<T>, b: Self::Of<U>) -> Self::Of<(T, U)>;

    /// The signals of `a` where the bit is set, else those of `b`: a multiplexer for each field.
    #[inline(always)]
    fn select<V: Value>(bit: Signal<V>, a: Self::Of<Signal<V>>, b: Self::Of<Signal<V>>) -> Self::Of<Signal<V>> {
        match V::known(bit.value) {
            Some(true) => a,
            Some(false) => b,
            None => Self::map(Self::zip(a, b), |(a, b)| bit.select(a, b)),
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
    const DOCS: &'static [&'static str] = &[];

    fn map<T: Copy, U: Copy>(_bundle: Nothing<T>, _f: impl FnMut(T) -> U) -> Nothing<U> {
        Nothing::default()
    }

    fn zip<T: Copy, U: Copy>(_a: Nothing<T>, _b: Nothing<U>) -> Nothing<(T, U)> {
        Nothing::default()
    }
}

/// `when!(V, Registers, bit => a, …, else b)`: the bundle of the first bit that is set, or the last; `when!(V, Registers, bit, a, b)`
/// is short for one bit. Where every bit is known, one alternative is evaluated; elsewhere all are, and multiplexers choose.
///
/// It is a macro, not a function of closures, because those are not inlined and the registers then travel through memory
/// (measured: half the clocks a second). Each alternative is written out twice, whatever their number: nested in one another,
/// they would be written out three times a level.
#[macro_export]
macro_rules! when {
    (@select $bundle:ident, $set:ident, else $b:expr) => { $b };
    (@select $bundle:ident, $set:ident, $bit:expr => $a:expr, $($others:tt)+) => {{
        #[allow(unused_variables)]
        let rest = &$set[1..];
        let others = $crate::when!(@select $bundle, rest, $($others)+);
        <$bundle as $crate::bundle::Bundle>::select($set[0], $a, others)
    }};
    ($reading:ident, $bundle:ident, $($bit:expr => $a:expr,)+ else $b:expr $(,)?) => {
        if $reading::DECIDES {
            $(if $crate::signal::is_set($bit) { $a } else)+ { $b }
        } else {
            let bits = [$($bit),+];
            if bits.iter().all(|bit| $reading::known(bit.value).is_some()) {
                let mut bits = bits.into_iter();
                let mut set = || $crate::signal::is_set(bits.next().expect("a bit for each alternative"));
                $(if $crate::when!(@first $bit, set) { $a } else)+ { $b }
            } else {
                let set = &bits[..];
                $crate::when!(@select $bundle, set, $($bit => $a,)+ else $b)
            }
        }
    };
    (@first $bit:expr, $set:ident) => { $set() };
    ($reading:ident, $bundle:ident, $bit:expr, $a:expr, $b:expr $(,)?) => {
        $crate::when!($reading, $bundle, $bit => $a, else $b)
    };
}

/// `next!(V, Registers, block, cell, bit => a, …, else b)`: the registers of a cell take the bundle of the first bit that is
/// set, or the last. Readings that know every bit store within the branch, where the compiler sees which registers keep what
/// they hold.
#[macro_export]
macro_rules! next {
    ($reading:ident, $bundle:ident, $block:expr, $cell:expr, $($bit:expr => $a:expr,)+ else $b:expr $(,)?) => {
        if $reading::DECIDES {
            $(if $crate::signal::is_set($bit) { $cell.store($block, $a) } else)+ { $cell.store($block, $b) }
        } else {
            let next = $crate::when!($reading, $bundle, $($bit => $a,)+ else $b);
            $cell.store($block, next);
        }
    };
}

/// `choose!(V, bit, a, b)`: the signal `a` where the bit is set, else `b`, as [`when!`](crate::when!) does for bundles. For
/// alternatives that cost something; for others `bit.select(a, b)` does.
#[macro_export]
macro_rules! choose {
    ($reading:ident, $bit:expr, $a:expr, $b:expr $(,)?) => {
        if $reading::DECIDES {
            if $crate::signal::is_set($bit) { $a } else { $b }
        } else {
            match $reading::known($bit.value) {
                Some(true) => $a,
                Some(false) => $b,
                None => $bit.select($a, $b),
            }
        }
    };
}

/// Declares a [`Bundle`]. A field that is a state lists the names of its codes: `step: ["idle", "run"]`.
#[macro_export]
macro_rules! bundle {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[doc = $doc:literal])* $field:ident $(: [$($state:literal),* $(,)?])?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $vis struct $name<T = ()> {
            $($(#[doc = $doc])* #[allow(missing_docs)] pub $field: T,)*
        }

        impl $crate::bundle::Bundle for $name<()> {
            type Of<T: Copy> = $name<T>;
            const NAMES: &'static [&'static str] = &[$(stringify!($field)),*];
            const STATES: &'static [&'static [&'static str]] = &[$(&[$($($state),*)?]),*];
            const DOCS: &'static [&'static str] = &[$(concat!($($doc),*)),*];

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
