// SPDX-License-Identifier: MIT OR Apache-2.0
//! Bundles: named groups of registers or ports, generic over what a field holds.
//!
//! The same struct holds formats, stored values or signals, and [`Bundle::map`] and [`Bundle::zip`]
//! go between them. Names in Verilog, in waveforms and in equality checks all come from the one
//! declaration. A bundle may contain another: its fields are then listed in the place of that
//! field, under their own names, and a parent hands the whole group on.
//!
//! ```
//! use hapticore_hdl::bundle::Bundle;
//! use hapticore_hdl::format::{BIT, Format};
//!
//! hapticore_hdl::bundle! {
//!     /// A write port.
//!     pub struct Write { enable, address, word }
//! }
//! hapticore_hdl::bundle! {
//!     pub struct Inputs {
//!         /// Begins a slot.
//!         start,
//!         write as Write,
//!     }
//! }
//! let names: Vec<_> = Inputs::FIELDS.iter().map(|field| field.name).collect();
//! assert_eq!(names, ["start", "enable", "address", "word"]);
//!
//! let word = Format::signed(16, 15);
//! let formats = Inputs { start: BIT, write: Write { enable: BIT, address: Format::unsigned(8, 0), word } };
//! assert_eq!(Inputs::map(formats, |format| format.width).write.address, 8);
//! ```

use crate::signal::{Signal, Value, operate};

/// What the declaration says of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// The name: of the Verilog port or register and of the waveform.
    pub name: &'static str,
    /// The names of its codes, for the state of a state machine; else empty.
    pub states: &'static [&'static str],
    /// Its documentation, which the printed Verilog repeats.
    pub doc: &'static str,
}

/// A family of structs with the same named fields, each field of one type. Made by
/// [`bundle!`](crate::bundle!).
pub trait Bundle: 'static {
    /// The struct whose fields hold a `T`.
    type Of<T: Copy>: Copy;

    /// The fields, in order, those of bundles within in their place.
    const FIELDS: &'static [Field];

    /// The struct with `f` of each field, called in the order of [`Bundle::FIELDS`].
    fn map<T: Copy, U: Copy>(bundle: Self::Of<T>, f: impl FnMut(T) -> U) -> Self::Of<U>;

    /// The struct of pairs.
    fn zip<T: Copy, U: Copy>(a: Self::Of<T>, b: Self::Of<U>) -> Self::Of<(T, U)>;

    /// Calls `f` with the declaration and the content of each field.
    fn each<T: Copy>(bundle: Self::Of<T>, mut f: impl FnMut(&'static Field, T)) {
        let mut fields = Self::FIELDS.iter();
        Self::map(bundle, |content| {
            f(fields.next().expect("as many declarations as fields"), content)
        });
    }
}

/// What a field of a bundle is: a [`Leaf`], or a bundle within.
pub trait Member {
    /// What it holds where the bundle holds a `T`.
    type Of<T>;
}

/// A field with one content.
pub struct Leaf;

impl Member for Leaf {
    type Of<T> = T;
}

/// The type of a field in a bundle of `T`.
pub type Held<T, M = Leaf> = <M as Member>::Of<T>;

/// What a multiplexer can choose between: a signal, or a bundle of signals of the same declaration.
pub trait Choice<V: Value>: Copy {
    /// `self` where the bit is set, else `other`: a multiplexer for each field.
    fn choose(bit: Signal<V>, set: Self, clear: Self) -> Self;
}

impl<V: Value> Choice<V> for Signal<V> {
    #[inline(always)]
    fn choose(bit: Signal<V>, set: Self, clear: Self) -> Self {
        operate!(
            V,
            match V::known_bit(bit.value) {
                Some(true) => set,
                Some(false) => clear,
                None => bit.select(set, clear),
            }
        )
    }
}

/// The bundle without a field: the registers of a block that has none of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Nothing<T = ()>(std::marker::PhantomData<T>);

impl<T> Default for Nothing<T> {
    fn default() -> Self {
        Nothing(std::marker::PhantomData)
    }
}

impl Bundle for Nothing<()> {
    type Of<T: Copy> = Nothing<T>;
    const FIELDS: &'static [Field] = &[];

    fn map<T: Copy, U: Copy>(_bundle: Nothing<T>, _f: impl FnMut(T) -> U) -> Nothing<U> {
        Nothing::default()
    }

    fn zip<T: Copy, U: Copy>(_a: Nothing<T>, _b: Nothing<U>) -> Nothing<(T, U)> {
        Nothing::default()
    }
}

/// The declarations of several groups one after the other. Used by [`bundle!`](crate::bundle!).
pub const fn join<const N: usize>(groups: &[&[Field]]) -> [Field; N] {
    let mut all = [Field { name: "", states: &[], doc: "" }; N];
    let (mut group, mut count) = (0, 0);
    while group < groups.len() {
        let mut index = 0;
        while index < groups[group].len() {
            all[count] = groups[group][index];
            (index, count) = (index + 1, count + 1);
        }
        group += 1;
    }
    all
}

/// Declares a [`Bundle`]. A field is
///
/// | written | is |
/// | --- | --- |
/// | `name` | a signal |
/// | `name in Step` | the state of a state machine, `Step` declared by [`states!`](crate::states!) |
/// | `name as Group` | a bundle within: its fields take this place |
#[macro_export]
macro_rules! bundle {
    ($(#[$meta:meta])* $vis:vis struct $name:ident { $(,)? }) => {
        $(#[$meta])*
        $vis type $name<T = ()> = $crate::bundle::Nothing<T>;
    };
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[doc = $doc:literal])* $field:ident $(in $states:ident)? $(as $group:ident)?),* $(,)?
    }) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        $vis struct $name<T = ()> {
            $($(#[doc = $doc])* #[allow(missing_docs)] pub $field: $crate::bundle::Held<T $(, $group)?>,)*
        }

        impl<T: Copy> $name<T> {
            /// The same in every field.
            #[allow(dead_code)]
            #[inline(always)]
            pub fn of(all: T) -> Self {
                $name { $($field: $crate::bundle!(@of all $(, $group)?)),* }
            }
        }

        impl $crate::bundle::Member for $name<()> {
            type Of<T> = $name<T>;
        }

        impl $crate::bundle::Bundle for $name<()> {
            type Of<T: Copy> = $name<T>;
            const FIELDS: &'static [$crate::bundle::Field] = {
                const GROUPS: &[&[$crate::bundle::Field]] =
                    &[$($crate::bundle!(@fields $field, concat!($($doc),*) $(, in $states)? $(, as $group)?)),*];
                const COUNT: usize = 0 $(+ $crate::bundle!(@fields $field, "" $(, as $group)?).len())*;
                &$crate::bundle::join::<COUNT>(GROUPS)
            };

            #[inline(always)]
            fn map<T: Copy, U: Copy>(bundle: $name<T>, mut f: impl FnMut(T) -> U) -> $name<U> {
                $name { $($field: $crate::bundle!(@map bundle.$field, f $(, $group)?)),* }
            }

            #[inline(always)]
            fn zip<T: Copy, U: Copy>(a: $name<T>, b: $name<U>) -> $name<(T, U)> {
                $name { $($field: $crate::bundle!(@zip a.$field, b.$field $(, $group)?)),* }
            }
        }

        impl<V: $crate::signal::Value> $crate::bundle::Choice<V> for $name<$crate::signal::Signal<V>> {
            #[inline(always)]
            fn choose(bit: $crate::signal::Signal<V>, set: Self, clear: Self) -> Self {
                match V::known_bit(bit.value) {
                    Some(true) => set,
                    Some(false) => clear,
                    None => $name { $($field: $crate::bundle::Choice::choose(bit, set.$field, clear.$field)),* },
                }
            }
        }
    };
    (@fields $field:ident, $doc:expr) => { [$crate::bundle::Field { name: stringify!($field), states: &[], doc: $doc }].as_slice() };
    (@fields $field:ident, $doc:expr, in $states:ident) => {
        [$crate::bundle::Field {
            name: stringify!($field), states: <$states as $crate::states::States>::NAMES, doc: $doc,
        }].as_slice()
    };
    (@fields $field:ident, $doc:expr, as $group:ident) => { <$group as $crate::bundle::Bundle>::FIELDS };
    (@of $all:ident) => { $all };
    (@of $all:ident, $group:ident) => { $group::of($all) };
    (@map $value:expr, $f:ident) => { $f($value) };
    (@map $value:expr, $f:ident, $group:ident) => { <$group as $crate::bundle::Bundle>::map($value, &mut $f) };
    (@zip $a:expr, $b:expr) => { ($a, $b) };
    (@zip $a:expr, $b:expr, $group:ident) => { <$group as $crate::bundle::Bundle>::zip($a, $b) };
}

/// `when!(bit => a, …, else b)`: the signal or bundle of the first bit that is set, or the last.
/// Where every bit is known, one alternative is evaluated; elsewhere all are, and multiplexers
/// choose. For alternatives that cost nothing to evaluate, `bit.select(a, b)` does.
///
/// It is a macro, not a function of closures, because those are not inlined and the registers then
/// travel through memory (measured: half the clocks per second). Each alternative is written out
/// twice, whatever their number: nested in one another, they would be written out three times a
/// level.
#[macro_export]
macro_rules! when {
    ($first:expr => $a:expr, $($bit:expr => $other:expr,)* else $b:expr $(,)?) => {{
        let first = $first;
        if $crate::signal::decides(&first) {
            if $crate::signal::is_set(first) { $a } $(else if $crate::signal::is_set($bit) { $other })* else { $b }
        } else {
            let bits = [first $(, $bit)*];
            if bits.iter().all($crate::signal::is_known) {
                let mut bits = bits.into_iter();
                let mut set = || $crate::signal::is_set(bits.next().expect("a bit for each alternative"));
                if set() { $a } $(else if $crate::when!(@next set, $bit) { $other })* else { $b }
            } else {
                let set = &bits[..];
                $crate::when!(@select set, $first => $a, $($bit => $other,)* else $b)
            }
        }
    }};
    (@next $set:ident, $bit:expr) => { $set() };
    (@select $set:ident, else $b:expr) => { $b };
    (@select $set:ident, $bit:expr => $a:expr, $($others:tt)+) => {{
        #[allow(unused_variables)]
        let rest = &$set[1..];
        let others = $crate::when!(@select rest, $($others)+);
        $crate::bundle::Choice::choose($set[0], $a, others)
    }};
}

/// `next!(block, state, bit => a, …, else b)`: the registers of a block's state take the bundle of
/// the first bit that is set, or the last. Interpretations that know every bit store within the
/// branch, where the compiler sees which registers keep what they hold.
#[macro_export]
macro_rules! next {
    ($block:expr, $state:expr, $first:expr => $a:expr, $($bit:expr => $other:expr,)* else $b:expr $(,)?) => {{
        let first = $first;
        if $crate::signal::decides(&first) {
            if $crate::signal::is_set(first) { $state.store($block, $a) }
            $(else if $crate::signal::is_set($bit) { $state.store($block, $other) })*
            else { $state.store($block, $b) }
        } else {
            let next = $crate::when!(first => $a, $($bit => $other,)* else $b);
            $state.store($block, next);
        }
    }};
}

#[cfg(test)]
mod tests;
