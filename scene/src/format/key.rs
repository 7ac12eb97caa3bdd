// SPDX-License-Identifier: MIT OR Apache-2.0
//! Keys of a scene, each declared once: name, what its value may be, what is read where it is absent, and the sentence
//! that the reference prints.

use super::kind::{Kind, Otherwise};
use super::limits::Limits;
use super::table::Result;
use super::tree::Table;

/// A key as it is declared.
#[derive(Clone, Copy, Debug)]
pub struct KeyInfo {
    /// Its name, which ends with its unit.
    pub name: &'static str,
    /// What its value may be.
    pub kind: Kind,
    /// What is read where it is absent.
    pub otherwise: Otherwise,
    says: &'static str,
}

impl KeyInfo {
    const fn new(name: &'static str, kind: Kind) -> Self {
        KeyInfo { name, kind, otherwise: Otherwise::Nothing, says: "" }
    }

    /// What it means, in a sentence.
    pub fn says(&self) -> &'static str {
        self.says.trim()
    }

    /// The range of its numbers; any where it has none.
    pub const fn limits(&self) -> Limits {
        match self.kind {
            Kind::Number(limits)
            | Kind::Numbers(limits)
            | Kind::OneOrSeveral(limits)
            | Kind::Pair(limits)
            | Kind::Stimulus(limits)
            | Kind::OverTime(limits) => limits,
            _ => Limits::ANY,
        }
    }

    /// The words that it takes; none where it takes no words.
    pub fn words(&self) -> Vec<&'static str> {
        if let Kind::Words(words) = self.kind { words() } else { Vec::new() }
    }
}

/// What can be read from a key.
pub(crate) trait Read: Sized {
    /// The value, where the table has the key.
    fn read(table: &Table, key: &KeyInfo) -> Result<Option<Self>>;

    /// What is read where the table does not have it.
    fn absent(_: Otherwise) -> Option<Self> {
        None
    }
}

/// A key, and the type of what is read.
pub(crate) struct Key<T> {
    pub about: KeyInfo,
    read: fn(&Table, &KeyInfo) -> Result<T>,
}

impl<T: Read> Key<Option<T>> {
    pub const fn new(name: &'static str, kind: Kind) -> Self {
        Key { about: KeyInfo::new(name, kind), read: T::read }
    }

    /// An error where it is absent, which says that `expected` was.
    pub const fn required(self, expected: &'static str) -> Key<T> {
        let about = KeyInfo { otherwise: Otherwise::Required(expected), ..self.about };
        let read = |table: &Table, key: &KeyInfo| {
            let Otherwise::Required(expected) = key.otherwise else { unreachable!("as above") };
            table.require(key.name, expected, T::read(table, key)?)
        };
        Key { about, read }
    }

    /// Says in words what is taken where it is absent, since it follows from other keys.
    pub const fn usually(self, what: &'static str) -> Self {
        let about = KeyInfo { otherwise: Otherwise::Follows(what), ..self.about };
        Key { about, ..self }
    }

    pub const fn otherwise(self, otherwise: Otherwise) -> Key<T> {
        let about = KeyInfo { otherwise, ..self.about };
        let read = |table: &Table, key: &KeyInfo| {
            let absent = || T::absent(key.otherwise).expect("a default of the key's type");
            Ok(T::read(table, key)?.unwrap_or_else(absent))
        };
        Key { about, read }
    }
}

impl<T> Key<T> {
    /// The same in a range that follows from other keys.
    pub fn within(self, limits: Limits) -> Self {
        let kind = match self.about.kind {
            Kind::Number(_) => Kind::Number(limits),
            Kind::Numbers(_) => Kind::Numbers(limits),
            Kind::Stimulus(_) => Kind::Stimulus(limits),
            other => other,
        };
        Key { about: KeyInfo { kind, ..self.about }, ..self }
    }

    /// The same with its meaning.
    pub const fn saying(self, says: &'static str) -> Self {
        Key { about: KeyInfo { says, ..self.about }, ..self }
    }
}

impl Key<bool> {
    pub const fn flag(name: &'static str) -> Self {
        let about =
            KeyInfo { otherwise: Otherwise::Follows("false"), ..KeyInfo::new(name, Kind::Flag) };
        Key { about, read: |table, key| table.flag(key.name) }
    }
}

/// Keys of tables whose own keys are free.
impl Key<()> {
    pub const fn keys(name: &'static str) -> Self {
        Key::bare(name, Kind::Keys)
    }

    pub const fn ranges(name: &'static str) -> Self {
        Key::bare(name, Kind::Ranges)
    }

    const fn bare(name: &'static str, kind: Kind) -> Self {
        Key { about: KeyInfo::new(name, kind), read: |_, _| Ok(()) }
    }
}

impl Table {
    /// The value of a key.
    pub fn get<T>(&self, key: &Key<T>) -> Result<T> {
        (key.read)(self, &key.about)
    }

    /// Whether the key is there.
    pub fn has<T>(&self, key: &Key<T>) -> bool {
        self.node(key.about.name).is_some()
    }
}

/// Declares keys, `NAME: type = key;` each, under the sentence that says what it means, and lists them under a name.
macro_rules! keys {
    ($list:ident: $($(#[doc = $doc:literal])+ $key:ident: $type:ty = $declared:expr;)+) => {
        $($(#[doc = $doc])+
        pub(crate) const $key: $crate::format::Key<$type> = $declared.saying(concat!($($doc),+));)+

        /// What is declared here.
        pub(crate) const $list: &[&$crate::format::KeyInfo] = &[$(&$key.about),+];
    };
}

pub(crate) use keys;
