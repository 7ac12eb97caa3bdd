// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[[case]]`: the variants of a scene before they are read, each a name and the keys that it sets;
//! and `[calibration]`, the keys that were different when the device was calibrated.

use crate::error::SceneError;
use crate::format::{self, Key, Node, Table, keys};
use crate::head::is_whole;

/// The most cases of a scene: each is a copy of the whole scene.
const MOST_CASES: usize = 256;

keys! { KEYS:
    /// The case's name.
    NAME: String = Key::text("name").required("text");
}

keys! { SET_KEYS:
    /// Dotted keys and the values that they get: `{ "sheet.terminal_ohm" = 500 }`; `false` takes a key away.
    SET: () = Key::keys("set");
}

/// A case before it is read: its name and what it sets.
pub(crate) struct Variant {
    pub name: String,
    pub set: Vec<(String, Node)>,
}

/// All variants; one named `main` that sets nothing where there is no `[[case]]`.
pub(crate) fn variants(root: &Table) -> Result<Vec<Variant>, SceneError> {
    let (mut variants, tables) = (Vec::<Variant>::new(), root.tables("case")?);
    if tables.len() > MOST_CASES {
        let got = tables.len();
        return Err(root.error(
            "case",
            format!("expected at most {MOST_CASES} tables headed [[case]], got {got}"),
        ));
    }
    for table in tables {
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
        let name = table.get(&NAME)?;
        Ok(Variant { name, set: read_set(table)? })
    }
}

/// The keys that `set` of a case or of `[calibration]` names, each with its value.
fn read_set(table: &Table) -> Result<Vec<(String, Node)>, SceneError> {
    let mut set = Vec::new();
    for (key, node) in table.table(SET.about.name)?.into_iter().flat_map(Table::all) {
        if is_whole(key) {
            let message = format!("{key} belongs to the whole scene, a case cannot set it");
            return Err(table.error("set", message));
        }
        set.push((key.to_string(), node.moved_to(key)));
    }
    Ok(set)
}

/// A case as it was when the device was calibrated; none where the scene has no `[calibration]`.
pub(crate) fn calibrated(case: &Table) -> Result<Option<Table>, SceneError> {
    let Some(calibration) = case.table("calibration")? else { return Ok(None) };
    let set = read_set(calibration)?;
    let mut then = case.clone();
    then.remove("calibration");
    set.into_iter().try_for_each(|(key, node)| format::apply(&mut then, &key, node))?;
    Ok(Some(then))
}
