// SPDX-License-Identifier: MIT OR Apache-2.0
//! Keys of scenes, as their reader names them: it refuses a key that it does not know with those that it does, and a
//! value with what it expects. So a new key is found by being read.

use std::collections::BTreeMap;

use hapticore_scene::{Scene, gallery};
use rayon::prelude::*;
use toml::Value;

/// No key and no word of a scene.
const UNKNOWN: &str = "zz";

/// How deep tables lie in one another.
const DEPTH: usize = 5;

/// A key that a scene takes.
#[derive(Debug, Clone)]
pub struct Key {
    /// Dotted, as in `--set`.
    pub name: String,
    /// What its reader expects, in the words of its message.
    pub expected: String,
    /// What the scene has there, as TOML.
    pub own: Option<String>,
}

/// The keys that each bundled scene takes, by the scene's name.
pub fn of_gallery() -> BTreeMap<String, Vec<Key>> {
    let keys = |(name, text): &(&str, &str)| (name.to_string(), Reader::new(text).keys());
    gallery::all().par_iter().map(keys).collect()
}

struct Reader<'a> {
    text: &'a str,
    document: Value,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Self {
        Reader { text, document: toml::from_str(text).expect("a bundled scene is TOML") }
    }

    fn keys(&self) -> Vec<Key> {
        let mut keys = Vec::new();
        self.below("", DEPTH, &mut keys);
        keys
    }

    /// Adds the keys of a table and of all below it.
    fn below(&self, table: &str, depth: usize, keys: &mut Vec<Key>) {
        for key in self.known(table) {
            let name = if table.is_empty() { key } else { format!("{table}.{key}") };
            let Some(expected) = self.expected(&name) else { continue };
            let own = self.own(&name);
            keys.push(Key { name: name.clone(), expected, own });
            if depth > 0 {
                self.below(&name, depth - 1, keys);
                self.below(&format!("{name}.0"), depth - 1, keys);
            }
        }
    }

    /// The message with which the scene is refused.
    fn refusal(&self, key: &str, value: &str) -> Option<String> {
        let set = [(key.to_string(), value.to_string())];
        Some(Scene::parse(self.text, "scene.toml", &set).err()?.to_string())
    }

    /// The keys of a table, as the message about an unknown one lists them.
    fn known(&self, table: &str) -> Vec<String> {
        let key = if table.is_empty() { UNKNOWN.into() } else { format!("{table}.{UNKNOWN}") };
        let message = self.refusal(&key, "1").unwrap_or_default();
        let about = format!("{key}: unknown key, expected one of ");
        let list = message.split_once(&about).map_or("", |(_, list)| list);
        words(list)
    }

    /// What is expected of a value; nothing where any text is taken.
    fn expected(&self, key: &str) -> Option<String> {
        let message = self.refusal(key, &format!("\"{UNKNOWN}\""))?;
        let (_, expected) = message.split_once("expected ")?;
        Some(expected.rsplit_once(", got ").map_or(expected, |(expected, _)| expected).to_string())
    }

    /// What the scene has there, unless it is a table.
    fn own(&self, key: &str) -> Option<String> {
        let enter = |value: &Value, part: &str| match value {
            Value::Array(list) => list.get(part.parse::<usize>().ok()?).cloned(),
            other => other.get(part).cloned(),
        };
        let found = key.split('.').try_fold(self.document.clone(), |here, part| enter(&here, part));
        found.filter(|value| !value.is_table()).map(|value| value.to_string())
    }
}

/// The quoted words of a message.
pub fn words(message: &str) -> Vec<String> {
    message.split('"').skip(1).step_by(2).map(String::from).collect()
}
