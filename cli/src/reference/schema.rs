// SPDX-License-Identifier: MIT OR Apache-2.0
//! JSON Schema of scenes, draft 2020-12, for editors: completion, meanings and ranges.

use hapticore_scene::Quantity;
use hapticore_scene::reference::{self, KeyInfo, Kind, Limits, Otherwise, SECTIONS, Section};
use serde_json::{Map, Value, json};

/// The schema.
pub fn of_scenes() -> Value {
    let stimulus = reference::section("stimulus").expect("a stimulus has keys");
    let mut schema = of_table(&SECTIONS[0]);
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Scene of hapticore");
    schema["$defs"] = json!({ "stimulus": of_table(stimulus) });
    schema
}

fn of_table(table: &Section) -> Value {
    let mut properties = Map::new();
    for key in table.keys() {
        properties.insert(key.name.into(), of_key(key));
    }
    for inside in table.tables() {
        let inner = match inside.is_list {
            true => json!({ "type": "array", "items": of_table(inside) }),
            false => of_table(inside),
        };
        let value = match properties.remove(inside.name()) {
            Some(value) => json!({ "anyOf": [value, inner] }),
            None => inner,
        };
        properties.insert(inside.name().into(), value);
    }
    let is_required = |key: &&KeyInfo| matches!(key.otherwise, Otherwise::Required(_));
    let required: Vec<_> = table.keys().filter(is_required).map(|key| key.name).collect();
    json!({
        "type": "object",
        "description": table.says,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn of_key(key: &KeyInfo) -> Value {
    let mut value = of_kind(&key.kind);
    value["description"] = key.says().into();
    match key.otherwise {
        Otherwise::Number(number) => value["default"] = number.into(),
        Otherwise::Whole(whole) => value["default"] = whole.into(),
        Otherwise::Word(word) => value["default"] = word.into(),
        Otherwise::Numbers(numbers) => value["default"] = numbers.into(),
        Otherwise::Nothing | Otherwise::Required(_) | Otherwise::Follows(_) => {}
    }
    value
}

fn of_kind(kind: &Kind) -> Value {
    match *kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Number(limits) => number(limits),
        Kind::Whole(least, most) => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Kind::Words(words) => json!({ "enum": words() }),
        Kind::Texts => list(json!({ "type": "string" }), 0),
        Kind::Numbers(limits) => list(number(limits), 1),
        Kind::OneOrSeveral(limits) => json!({ "anyOf": [number(limits), list(number(limits), 1)] }),
        Kind::Pair(limits) => pair(limits),
        Kind::Pairs => list(pair(Limits::ANY), 1),
        Kind::Stimulus(limits) | Kind::OverTime(limits) => {
            json!({ "anyOf": [number(limits), { "$ref": "#/$defs/stimulus" }] })
        }
        Kind::Position => pair(Limits::ANY),
        Kind::Keys => json!({ "type": "object" }),
        Kind::Ranges => {
            let names: Vec<_> = Quantity::all().map(Quantity::name).collect();
            json!({
                "type": "object",
                "propertyNames": { "enum": names },
                "additionalProperties": pair(Limits::ANY),
            })
        }
    }
}

fn number(limits: Limits) -> Value {
    let mut value = json!({ "type": "number" });
    let least = if limits.open { "exclusiveMinimum" } else { "minimum" };
    for (word, bound) in [(least, limits.low), ("maximum", limits.high)] {
        if bound.is_finite() {
            value[word] = bound.into();
        }
    }
    value
}

fn list(items: Value, least: usize) -> Value {
    json!({ "type": "array", "items": items, "minItems": least })
}

fn pair(limits: Limits) -> Value {
    let mut value = list(number(limits), 2);
    value["maxItems"] = 2.into();
    value
}
