// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers, booleans and strings in place of others.

use std::sync::LazyLock;

use toml::Value;

use super::Mutator;

/// The words of libFuzzer's `-dict`.
static WORDS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let quoted = |line: &'static str| line.strip_prefix('"')?.strip_suffix('"');
    include_str!("../../../../fuzz/words.dict").lines().filter_map(quoted).collect()
});

const FLOATS: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    f64::EPSILON,
    1e-300,
    1e300,
];

impl Mutator {
    /// Another value of the same type.
    pub(super) fn scalar(&mut self, value: &Value, document: &Value) -> Value {
        let mut others = Vec::new();
        collect_scalars(document, &mut others);
        match value {
            Value::Boolean(boolean) => Value::Boolean(!boolean),
            Value::Integer(integer) => {
                let others: Vec<_> = others.iter().filter_map(|other| other.as_integer()).collect();
                Value::Integer(self.integer(*integer, &others))
            }
            Value::Float(float) => {
                let others: Vec<_> = others.iter().filter_map(|other| number(other)).collect();
                Value::Float(self.float(*float, &others))
            }
            Value::String(string) => {
                let others: Vec<_> = others.iter().filter_map(|other| other.as_str()).collect();
                Value::String(self.string(string, &others))
            }
            other => other.clone(),
        }
    }

    /// A neighbour, a multiple, a small number, one beside a power of two, a limit, another of the
    /// document, or one that the program has compared with.
    pub(super) fn integer(&mut self, integer: i64, others: &[i64]) -> i64 {
        match self.rng.u8(..10) {
            0 => integer.wrapping_add(self.one_of(&[-1, 1])),
            1 => {
                [integer.wrapping_mul(2), integer / 2, integer.wrapping_neg()][self.rng.usize(..3)]
            }
            2 | 3 => {
                let end = self.one_of(&[4, 10, 16]);
                self.rng.i64(-1..end)
            }
            4 | 5 => {
                let power = 1_i64 << (self.rng.u8(..63) / self.one_of(&[1, 2, 4]));
                self.one_of(&[power, -power]) + self.one_of(&[-1, 0, 0, 1])
            }
            6 => self.one_of(&[i64::MIN, i64::MAX]),
            7 => i64::from_le_bytes(self.observed(integer.to_le_bytes())),
            _ if others.is_empty() => 0,
            _ => self.one_of(others),
        }
    }

    /// As [`Mutator::integer`], with what only numbers with a point have.
    pub(super) fn float(&mut self, float: f64, others: &[f64]) -> f64 {
        match self.rng.u8(..10) {
            0 => float + self.one_of(&[-1.0, 1.0]),
            1 => float * self.one_of(&[2.0, 0.5, -1.0, 10.0, 0.1]),
            2 => self.one_of(&[float.next_up(), float.next_down(), float.round()]),
            3 | 4 => self.integer(float as i64, &[]) as f64,
            5 => float * 2.0 * self.rng.f64(),
            6 => self.one_of(&FLOATS),
            7 => f64::from_le_bytes(self.observed(float.to_le_bytes())),
            _ if others.is_empty() => 0.0,
            _ => self.one_of(others),
        }
    }

    /// A word, another string of the document, one with another number in it, or other bytes.
    pub(super) fn string(&mut self, string: &str, others: &[&str]) -> String {
        match self.rng.u8(..6) {
            0 => self.word(),
            1 => self.neighbour(string),
            2 | 3 => self.with_other_number(string),
            4 if !others.is_empty() => self.one_of(others).to_string(),
            _ => {
                let mut data = string.as_bytes().to_vec();
                data.resize(string.len() + 16, 0);
                let size = (self.bytes)(&mut data, string.len(), string.len() + 16);
                String::from_utf8_lossy(&data[..size]).into_owned()
            }
        }
    }

    /// A word of the dictionary.
    pub(super) fn word(&mut self) -> String {
        self.one_of(&WORDS).to_string()
    }

    /// The word before or after in the dictionary, where alternatives stand together; any, where the string is none.
    fn neighbour(&mut self, string: &str) -> String {
        let Some(at) = WORDS.iter().position(|word| *word == string) else { return self.word() };
        let neighbours = [at.checked_sub(1), Some(at + 1)].map(|at| WORDS.get(at?).copied());
        self.one_of(&neighbours).unwrap_or(string).to_string()
    }

    /// Of the numbers in a string one is another.
    fn with_other_number(&mut self, string: &str) -> String {
        let digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
        let bytes = string.as_bytes();
        let begins = |at: &usize| {
            digit(bytes.get(*at)) && !at.checked_sub(1).is_some_and(|left| digit(bytes.get(left)))
        };
        let numbers: Vec<usize> = (0..bytes.len()).filter(begins).collect();
        if numbers.is_empty() {
            return self.word();
        }
        let at = self.one_of(&numbers);
        let digits = bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let (number, rest) = string[at..].split_at(digits);
        let number = self.integer(number.parse().unwrap_or(i64::MAX), &[]);
        format!("{}{number}{rest}", &string[..at])
    }

    /// The bytes of a number as the fuzzer mutates them: with what the program has compared with.
    fn observed(&mut self, mut number: [u8; 8]) -> [u8; 8] {
        (self.bytes)(&mut number, 8, 8);
        number
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
}

/// What is neither table nor array.
fn collect_scalars<'a>(value: &'a Value, scalars: &mut Vec<&'a Value>) {
    match value {
        Value::Table(table) => table.values().for_each(|value| collect_scalars(value, scalars)),
        Value::Array(array) => array.iter().for_each(|value| collect_scalars(value, scalars)),
        scalar => scalars.push(scalar),
    }
}
