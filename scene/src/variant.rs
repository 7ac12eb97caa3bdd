// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[[case]]`: the variants of a scene before they are read, each a name and the keys that it sets.

use crate::error::SceneError;
use crate::format::{Node, Table};

/// Keys that belong to the scene as a whole, so that a case cannot set them.
const WHOLE: [&str; 9] = [
    "title",
    "summary",
    "profile",
    "window_samples",
    "seed",
    "figure",
    "record",
    "case",
    "criterion",
];

/// Whether a dotted key belongs to the scene as a whole.
pub(crate) fn is_whole(key: &str) -> bool {
    WHOLE.contains(&key.split('.').next().unwrap_or_default())
}

/// A case before it is read: its name and what it sets.
pub(crate) struct Variant {
    pub name: String,
    pub set: Vec<(String, Node)>,
}

/// All variants; one named `main` that sets nothing where there is no `[[case]]`.
pub(crate) fn variants(root: &Table) -> Result<Vec<Variant>, SceneError> {
    let mut variants: Vec<Variant> = Vec::new();
    for table in root.tables("case")? {
        let variant = Variant::read(table)?;
        if variants.iter().any(|other| other.name == variant.name) {
            return Err(table.error(
                "name",
                format!("expected a name of its own, got {:?} again", variant.name),
            ));
        }
        variants.push(variant);
    }
    if variants.is_empty() {
        variants.push(Variant { name: "main".to_string(), set: Vec::new() });
    }
    Ok(variants)
}

impl Variant {
    fn read(table: &Table) -> Result<Variant, SceneError> {
        let name = table.require("name", "text", table.text("name")?)?;
        let mut set = Vec::new();
        for (key, node) in table.table("set")?.into_iter().flat_map(Table::all) {
            if is_whole(key) {
                return Err(table.error(
                    "set",
                    format!("{key} belongs to the whole scene, a case cannot set it"),
                ));
            }
            set.push((key.to_string(), node.moved_to(key)));
        }
        Ok(Variant { name, set })
    }
}
