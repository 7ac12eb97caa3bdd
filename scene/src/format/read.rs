// SPDX-License-Identifier: MIT OR Apache-2.0
//! How values of each type are read from a key, and how keys of the type are declared.

use super::key::{Key, KeyInfo, Read};
use super::kind::{Kind, Otherwise};
use super::limits::Limits;
use super::table::Result;
use super::tree::Table;

/// What some words stand for.
pub(crate) trait Word: Copy + 'static {
    /// Each word, and its meaning.
    const WORDS: &'static [(&'static str, Self)];

    /// The words.
    fn names() -> Vec<&'static str> {
        Self::WORDS.iter().map(|(name, _)| *name).collect()
    }

    /// The meaning of a word.
    fn named(name: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(word, _)| *word == name).map(|(_, meaning)| *meaning)
    }

    /// The word of a meaning.
    fn word(self) -> &'static str
    where
        Self: PartialEq,
    {
        Self::WORDS.iter().find(|(_, meaning)| *meaning == self).map_or("", |(word, _)| word)
    }
}

/// How the values of a type are read, what stands for one that is absent, and how its keys are declared.
macro_rules! reads {
    ($($type:ty {
        |$table:ident, $key:ident| $read:expr;
        $(=> $usual:ty = $otherwise:ident($given:ident), $value:expr;)?
        $($name:ident($($arg:ident: $of:ty),*) = $kind:expr;)+
    })+) => {$(
        impl Read for $type {
            fn read($table: &Table, $key: &KeyInfo) -> Result<Option<Self>> {
                $read
            }

            $(fn absent(otherwise: Otherwise) -> Option<Self> {
                if let Otherwise::$otherwise($given) = otherwise { $value } else { None }
            })?
        }

        impl Key<Option<$type>> {
            $(pub const fn $name(name: &'static str $(, $arg: $of)*) -> Self {
                Key::new(name, $kind)
            })+

            $(/// What is read where it is absent.
            pub const fn or(self, usual: $usual) -> Key<$type> {
                self.otherwise(Otherwise::$otherwise(usual))
            })?
        }
    )+};
}

reads! {
    String {
        |table, key| table.text(key.name);
        => &'static str = Word(text), Some(text.to_string());
        text() = Kind::Text;
    }
    f64 {
        |table, key| table.number(key.name, key.limits());
        => f64 = Number(number), Some(number);
        number(limits: Limits) = Kind::Number(limits);
    }
    u64 {
        |table, key| table.whole(key.name, key.kind);
        => u64 = Whole(whole), Some(whole);
        whole(least: u64, greatest: u64) = Kind::Whole(least, greatest);
    }
    &'static str {
        |table, key| table.choice(key.name, &key.words());
        => &'static str = Word(word), Some(word);
        choice(words: fn() -> Vec<&'static str>) = Kind::Words(words);
    }
    Vec<String> {
        |table, key| table.texts(key.name);
        texts() = Kind::Texts;
    }
    Vec<f64> {
        |table, key| match key.kind {
            Kind::OneOrSeveral(limits) => table.one_or_several(key.name, limits),
            _ => table.numbers(key.name, key.limits()),
        };
        => &'static [f64] = Numbers(numbers), Some(numbers.to_vec());
        numbers(limits: Limits) = Kind::Numbers(limits);
        one_or_several(limits: Limits) = Kind::OneOrSeveral(limits);
    }
    [f64; 2] {
        |table, key| table.pair(key.name, key.limits());
        => &'static [f64; 2] = Numbers(pair), pair.try_into().ok();
        pair(limits: Limits) = Kind::Pair(limits);
        position() = Kind::Position;
    }
    Vec<[f64; 2]> {
        |table, key| table.pairs(key.name);
        pairs() = Kind::Pairs;
    }
}

impl<W: Word> Key<Option<W>> {
    pub const fn words(name: &'static str) -> Self {
        Key::new(name, Kind::Words(W::names))
    }

    pub const fn or_word(self, usual: &'static str) -> Key<W> {
        self.otherwise(Otherwise::Word(usual))
    }
}

impl<W: Word> Read for W {
    fn read(table: &Table, key: &KeyInfo) -> Result<Option<W>> {
        Ok(table.choice(key.name, &W::names())?.and_then(W::named))
    }

    fn absent(otherwise: Otherwise) -> Option<W> {
        if let Otherwise::Word(word) = otherwise { W::named(word) } else { None }
    }
}
