// SPDX-License-Identifier: MIT OR Apache-2.0
//! An input made of two: values that different inputs have come to are brought together.

use fastrand::Rng;
use toml::Value;

use super::Mutator;

/// Puts into `out` the first input with some values of the second; how long it is. The same arguments
/// give the same. What cannot be parsed gives a beginning of the first and an end of the second.
pub fn cross(target: &str, first: &[u8], second: &[u8], out: &mut [u8], seed: u32) -> usize {
    let mut mutator = Mutator { rng: Rng::with_seed(seed.into()), bytes: |_, size, _| size };
    let made = mutator.crossed(target, first, second).map(String::into_bytes);
    let made = made.unwrap_or_else(|| mutator.spliced(first, second));
    let size = made.len().min(out.len());
    out[..size].copy_from_slice(&made[..size]);
    size
}

impl Mutator {
    fn crossed(&mut self, target: &str, first: &[u8], second: &[u8]) -> Option<String> {
        let [first, second] = [str::from_utf8(first).ok()?, str::from_utf8(second).ok()?];
        match target {
            "csv" => Some(self.cross_tables(first, second)),
            "lab" => {
                let files = first.split('\0').zip(second.split('\0')).enumerate();
                let crossed = files.map(|(number, (first, second))| match number {
                    0 => self.cross_documents(first, second),
                    _ => Some(self.cross_tables(first, second)),
                });
                Some(crossed.collect::<Option<Vec<_>>>()?.join("\0"))
            }
            _ => self.cross_documents(first, second),
        }
    }

    fn cross_documents(&mut self, first: &str, second: &str) -> Option<String> {
        let mut document = Value::Table(first.parse().ok()?);
        let of = self.one_of(&[2, 4, 16]);
        self.merge(&mut document, &Value::Table(second.parse().ok()?), of);
        toml::to_string(document.as_table()?).ok()
    }

    /// One value in `of` becomes the other's of the same name.
    fn merge(&mut self, value: &mut Value, other: &Value, of: u8) {
        match (value, other) {
            (Value::Table(table), Value::Table(other)) => {
                other.iter().for_each(|(key, other)| match table.get_mut(key) {
                    Some(value) => self.merge(value, other, of),
                    None if self.rng.u8(..8) == 0 => drop(table.insert(key.clone(), other.clone())),
                    None => {}
                })
            }
            (Value::Array(array), Value::Array(other)) if array.iter().all(Value::is_table) => {
                array.iter_mut().zip(other).for_each(|(value, other)| self.merge(value, other, of));
            }
            (value, other) if self.rng.u8(..of) == 0 => *value = other.clone(),
            _ => {}
        }
    }

    /// Of each row that of one of both, where both have it.
    fn cross_tables(&mut self, first: &str, second: &str) -> String {
        let mut others = second.lines();
        let mut text = String::new();
        for row in first.lines() {
            let other = others.next().filter(|_| self.rng.u8(..4) == 0);
            text.push_str(other.unwrap_or(row));
            text.push('\n');
        }
        text
    }

    fn spliced(&mut self, first: &[u8], second: &[u8]) -> Vec<u8> {
        let [begin, end] = [first, second].map(|data| self.rng.usize(..=data.len()));
        [&first[..begin], &second[end..]].concat()
    }
}
