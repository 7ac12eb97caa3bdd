// SPDX-License-Identifier: MIT OR Apache-2.0
//! Axes of a plan: a key of the profile or of the scene, and the values that it takes.
//!
//! | in a plan | values |
//! | --- | --- |
//! | `adc = [14, 16, 18]` | these |
//! | `adc = { from = 14, to = 18, step = 2 }` | 14, 16, 18 |
//! | `adc = { from = 14, to = 18 }` | of `[random]` alone: any in between, integers where both ends are |

use std::collections::{BTreeMap, HashSet};

use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};

use crate::canonical;

/// What keys are set to, by key.
pub type Settings = BTreeMap<String, Value>;

/// Whose key an axis is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The core's: a knob of `hapticore tradeoff`, or a key of a profile.
    Profile,
    /// The plant's: a key of a scene, as `simulate --set` takes it.
    Scene,
}

/// A key and its values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Whose key it is.
    pub side: Side,
    /// The key, dotted.
    pub key: String,
    /// What it may be.
    pub values: Values,
}

/// What a key may be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Values {
    /// These, in this order.
    List(Vec<Value>),
    /// Any number from the first to the second.
    Between(Number, Number),
}

/// What is varied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Points {
    /// Every combination of the axes' values, the last axis fastest.
    Grid(Vec<Axis>),
    /// This many draws, each of all axes.
    Random {
        /// How many.
        count: u64,
        /// Of the draws.
        seed: u64,
        /// What is drawn.
        axes: Vec<Axis>,
    },
}

/// The most values of an axis, and of all axes together: all of them are held in memory.
pub(crate) const MOST: f64 = 1e6;

impl Values {
    /// Reads what a plan gives for a key; none where it is a table of further keys.
    ///
    /// # Errors
    /// Neither list nor range, a range without numbers or with too many; the message says what was
    /// expected.
    pub fn read(value: &toml::Value) -> Result<Option<Values>, String> {
        match value {
            toml::Value::Array(list) if list.is_empty() => {
                Err("expected at least one value".into())
            }
            toml::Value::Array(list) => {
                let values = list.iter().map(plain).collect::<Result<Vec<_>, _>>()?;
                let mut known = HashSet::new();
                // Points are named by the canonical text of what they set: 1 and 1.0 are the same.
                match values.iter().position(|value| !known.insert(canonical::text(value))) {
                    Some(again) => {
                        Err(format!("expected each value once, got {} again", list[again]))
                    }
                    None => Ok(Some(Values::List(values))),
                }
            }
            toml::Value::Table(table) if table.contains_key("from") => range(table).map(Some),
            toml::Value::Table(_) => Ok(None),
            other => Err(format!("expected a list or {{ from, to, step }}, got {other}")),
        }
    }

    /// The values; none of a range without steps.
    pub fn list(&self) -> Option<&[Value]> {
        match self {
            Values::List(list) => Some(list),
            Values::Between(..) => None,
        }
    }

    /// The value at a place of an even draw.
    pub fn drawn(&self, random: u64) -> Value {
        // Widening products spread a draw evenly over what there is.
        let below = |count: u128| ((u128::from(random) * count) >> 64) as i128;
        match self {
            Values::List(list) => list[below(list.len() as u128) as usize].clone(),
            Values::Between(from, to) => match (from.as_i64(), to.as_i64()) {
                (Some(from), Some(to)) => {
                    let [from, to] = [from, to].map(i128::from);
                    ((from + below((to - from) as u128 + 1)) as i64).into()
                }
                _ => {
                    let [from, to] = [from, to].map(|end| end.as_f64().unwrap_or_default());
                    let share = (random >> 11) as f64 / (1u64 << 53) as f64;
                    (from + share * (to - from)).into()
                }
            },
        }
    }

    /// Values that stand for all when a plan is checked: of a range its ends.
    pub fn examples(&self) -> Vec<Value> {
        match self {
            Values::List(list) => list.clone(),
            Values::Between(from, to) => [from, to].map(|end| Value::Number(end.clone())).to_vec(),
        }
    }
}

/// A value of TOML as one of JSON.
fn plain(value: &toml::Value) -> Result<Value, String> {
    let finite = |value: &Value| !value.is_null();
    serde_json::to_value(value)
        .ok()
        .filter(finite)
        .ok_or_else(|| format!("expected a finite number, a text, a flag or a list, got {value}"))
}

fn range(table: &toml::Table) -> Result<Values, String> {
    const EXPECTED: &str = "expected { from, to, step } with from below to and a step above 0";
    let wrong = || format!("{EXPECTED}, got {}", toml::Value::from(table.clone()));
    if table.keys().any(|key| !["from", "to", "step"].contains(&key.as_str())) {
        return Err(wrong());
    }
    let number = |key: &str| match table.get(key) {
        Some(toml::Value::Integer(whole)) => Some(Number::from(*whole)),
        Some(toml::Value::Float(real)) => Number::from_f64(*real),
        _ => None,
    };
    let (Some(from), Some(to)) = (number("from"), number("to")) else { return Err(wrong()) };
    let real = |number: &Number| number.as_f64().unwrap_or(f64::NAN);
    if real(&from) >= real(&to) || !(real(&to) - real(&from)).is_finite() {
        return Err(wrong());
    }
    if !table.contains_key("step") {
        return Ok(Values::Between(from, to));
    }
    let step = number("step").filter(|step| real(step) > 0.0).ok_or_else(wrong)?;
    // A step that does not quite divide the range, as 0.1 does not, still reaches its end.
    let last = ((real(&to) - real(&from)) / real(&step) * (1.0 + 1e-12)).floor();
    if last >= MOST {
        return Err(format!("expected at most {MOST} values, got {}", last + 1.0));
    }
    let value = |n: u64| match (from.as_i64(), step.as_i64()) {
        (Some(from), Some(step)) => {
            // The end, a rounded number, may be passed by one step at the end of all integers.
            let value = i128::from(from) + i128::from(step) * i128::from(n);
            Value::from(i64::try_from(value).unwrap_or(i64::MAX))
        }
        _ => Value::from(real(&from) + real(&step) * n as f64),
    };
    let values: Vec<_> = (0..=last as u64).map(value).collect();
    match values.windows(2).any(|pair| pair[0].as_f64() == pair[1].as_f64()) {
        true => {
            Err(format!("expected a step that changes each number from {from} to {to}, got {step}"))
        }
        false => Ok(Values::List(values)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(text: &str) -> Result<Option<Values>, String> {
        let table: toml::Table = format!("key = {text}").parse().expect("TOML");
        Values::read(&table["key"])
    }

    #[test]
    fn lists_and_ranges_are_read() {
        let list = |text: &str| read(text).unwrap().unwrap().list().unwrap().to_vec();
        assert_eq!(list("[14, \"a\", false]"), [json!(14), json!("a"), json!(false)]);
        assert_eq!(
            list("{ from = 500, to = 1100, step = 250 }"),
            [500, 750, 1000].map(|n| json!(n))
        );
        assert_eq!(list("{ from = 0, to = 0.3, step = 0.1 }").len(), 4);
        assert_eq!(read("{ more = [1] }"), Ok(None), "a table of further keys");
    }

    #[test]
    fn what_is_no_axis_is_told() {
        for (text, words) in [
            ("[]", "at least one"),
            ("[1, 2, 1]", "got 1 again"),
            ("14", "a list or { from, to, step }, got 14"),
            ("[nan]", "a finite number"),
            ("{ from = 2, to = 1, step = 1 }", "from below to"),
            ("{ from = 1, to = 2, step = 0 }", "a step above 0"),
            ("{ from = 1, to = 2, by = 1 }", "expected { from, to, step }"),
            ("{ from = 0, to = 1, step = 1e-9 }", "at most 1000000 values"),
            ("[16, 16.0]", "got 16.0 again"),
            ("{ from = -1.7e308, to = 1.7e308 }", "from below to"),
            (
                "{ from = 1.0, to = 1.00000000000001, step = 1e-17 }",
                "a step that changes each number",
            ),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(words), "{text}: {message}");
        }
    }

    #[test]
    fn draws_are_within_their_range_and_reach_its_ends() {
        let bits = read("{ from = 10, to = 12 }").unwrap().unwrap();
        let drawn: Vec<_> = (0..6).map(|n| bits.drawn(n * (u64::MAX / 5))).collect();
        assert_eq!((drawn[0].clone(), drawn[5].clone()), (json!(10), json!(12)));
        let all = format!("{{ from = {}, to = {} }}", i64::MIN, i64::MAX);
        let all = read(&all).unwrap().unwrap();
        assert_eq!([0, u64::MAX].map(|n| all.drawn(n)), [json!(i64::MIN), json!(i64::MAX)]);
        let share = read("{ from = 0.5, to = 1 }").unwrap().unwrap();
        for random in [0, 1 << 63, u64::MAX] {
            let value = share.drawn(random).as_f64().unwrap();
            assert!((0.5..=1.0).contains(&value), "{value}");
        }
    }
}
