// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tables of what serde structures declare: profiles, calibrations, messages. Names, types, defaults, ranges and meanings come
//! from the structures themselves, by their JSON Schema.

use hapticore_contract::profile::Profile;
use hapticore_host::DeviceCalibration;
use hapticore_live::protocol::{Answer, Command};
use hapticore_run::lab::setup::Setup;
use hapticore_scene::reference::unit;
use schemars::schema_for;
use serde_json::Value;

use super::Part;

/// The JSON Schemas of a topic, each with the name of its whole; none for other topics.
pub fn schemas(topic: &str) -> Vec<(&'static str, Value)> {
    let schemas = match topic {
        "profile" => vec![("profile", schema_for!(Profile))],
        "calibration" => vec![
            ("calibration of a device", schema_for!(DeviceCalibration)),
            ("set-up for hapticore calibrate", schema_for!(Setup)),
        ],
        "messages" => {
            vec![("from a client", schema_for!(Command)), ("from the server", schema_for!(Answer))]
        }
        _ => Vec::new(),
    };
    schemas.into_iter().map(|(name, schema)| (name, plain(schema.into()))).collect()
}

/// The tables of a topic.
pub fn parts(topic: &str) -> Vec<Part> {
    schemas(topic).iter().flat_map(|(name, schema)| Walk { root: schema }.whole(name)).collect()
}

/// Descriptions by their first paragraph, without links to Rust items.
fn plain(mut schema: Value) -> Value {
    match &mut schema {
        Value::Object(map) => {
            if let Some(Value::String(text)) = map.get_mut("description") {
                let first = text.split("\n\n").next().unwrap_or_default().replace('\n', " ");
                *text = first.replace("[`", "`").replace("`]", "`");
            }
            map.values_mut().for_each(|value| *value = plain(value.take()));
        }
        Value::Array(list) => list.iter_mut().for_each(|value| *value = plain(value.take())),
        _ => {}
    }
    schema
}

/// A schema, and the definitions that its parts refer to.
#[derive(Clone, Copy)]
struct Walk<'a> {
    root: &'a Value,
}

impl<'a> Walk<'a> {
    fn whole(self, name: &str) -> Vec<Part> {
        match self.root["oneOf"].as_array() {
            Some(messages) => {
                messages.iter().flat_map(|message| self.message(message, name)).collect()
            }
            None => self.tables(self.root, "", name),
        }
    }

    /// A message, and the objects in it.
    fn message(self, schema: &'a Value, from: &str) -> Vec<Part> {
        let kind = schema["properties"]["type"]["const"].as_str().unwrap_or_default();
        let mut parts = self.tables(schema, kind, kind);
        parts[0].heading = format!("`{kind}` {from}");
        parts
    }

    /// The table at a path, then those in it.
    fn tables(self, schema: &'a Value, path: &str, heading: &str) -> Vec<Part> {
        let body = self.resolved(schema);
        let (mut rows, mut inside) = (Vec::new(), Vec::new());
        for (name, property, form) in self.properties(schema, body) {
            let path = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
            let (of_item, is_list) = self.item(property);
            let is_required = requires(body, name);
            if of_item["properties"].is_object() {
                let heading = if is_list { format!("[[{path}]]") } else { format!("[{path}]") };
                let mut tables = self.tables(of_item, &path, &heading);
                let optional = if is_required { "" } else { " The table may be left out." };
                tables[0].says = said(property, of_item) + optional;
                inside.extend(tables);
            } else if property["const"].is_null() {
                rows.push(self.row(name, property, form, is_required));
            }
        }
        let says = said(schema, body);
        let head = &["key", "unit", "default", "values", "meaning"];
        let mut parts = vec![Part { heading: heading.into(), says, head, rows }];
        parts.extend(inside);
        parts
    }

    /// Properties of an object, of what it is tagged with, and of what it takes one of; each with what declares it.
    fn properties(
        self,
        schema: &'a Value,
        body: &'a Value,
    ) -> Vec<(&'a str, &'a Value, &'a Value)> {
        let mut found: Vec<(&str, &Value, &Value)> = Vec::new();
        let forms = [schema, body].into_iter().flat_map(|of| of["oneOf"].as_array());
        for of in [schema, body].into_iter().chain(forms.flatten()) {
            for (name, property) in of["properties"].as_object().into_iter().flatten() {
                if !found.iter().any(|(other, ..)| other == name) {
                    found.push((name, property, of));
                }
            }
        }
        found
    }

    /// What a property is or is a list of, and whether it is a list.
    fn item(self, property: &'a Value) -> (&'a Value, bool) {
        let of = self.resolved(property);
        let item = self.resolved(&of["items"]);
        if item["properties"].is_object() { (item, true) } else { (of, false) }
    }

    /// What a schema refers to, and of what may be `null` the other form.
    fn resolved(self, schema: &'a Value) -> &'a Value {
        if let Some(path) = schema["$ref"].as_str() {
            let name = path.rsplit('/').next().unwrap_or_default();
            return self.resolved(&self.root["$defs"][name]);
        }
        let forms = schema["anyOf"].as_array().into_iter().flatten();
        forms
            .into_iter()
            .find(|form| form["type"] != "null")
            .map_or(schema, |form| self.resolved(form))
    }

    fn row(self, name: &str, property: &'a Value, form: &Value, is_required: bool) -> Vec<String> {
        let kind = self.resolved(property);
        let default = match &property["default"] {
            Value::Null if is_required => "required".to_string(),
            Value::Null => "none".to_string(),
            Value::String(word) => word.clone(),
            value => value.to_string(),
        };
        let unit = unit(name).unwrap_or_default().to_string();
        vec![name.to_string(), unit, default, self.values(kind), meaning(property, kind, form)]
    }

    /// What a value may be, in few words.
    fn values(self, kind: &Value) -> String {
        if let Some(title) = kind["title"].as_str() {
            return title.to_string();
        }
        if let Some(words) = words(kind) {
            return words.map(|(word, _)| word).collect::<Vec<_>>().join(", ");
        }
        match kind["type"].as_str().or_else(|| kind["type"][0].as_str()) {
            Some("integer") => format!("integer, {}", range(kind)),
            Some("number") => range(kind),
            Some("boolean") => "true or false".into(),
            Some("string") => "text".into(),
            Some("array") => {
                let of = self.values(self.resolved(&kind["items"]));
                match kind["minItems"].as_u64() {
                    Some(count) if kind["maxItems"] == count => format!("{count} of: {of}"),
                    _ => format!("list of: {of}"),
                }
            }
            Some("object") => {
                let of = self.values(self.resolved(&kind["additionalProperties"]));
                format!("names, each with: {of}")
            }
            _ => String::new(),
        }
    }
}

/// The words of an enumeration with their meanings.
fn words(kind: &Value) -> Option<impl Iterator<Item = (&str, &str)>> {
    let forms = kind["oneOf"].as_array()?;
    let word = |form: &Value| form["const"].is_string();
    forms
        .iter()
        .all(word)
        .then(|| forms.iter().map(|form| (form["const"].as_str().unwrap_or_default(), text(form))))
}

fn requires(table: &Value, name: &str) -> bool {
    table["required"].as_array().is_some_and(|names| names.contains(&name.into()))
}

fn text(schema: &Value) -> &str {
    schema["description"].as_str().unwrap_or_default()
}

/// What is said of a property, or else of its type.
fn said(property: &Value, kind: &Value) -> String {
    let own = text(property);
    if own.is_empty() { text(kind).to_string() } else { own.to_string() }
}

/// What is said of a key, and of each word that it may be. A key that is a form of its own has the form's description.
fn meaning(property: &Value, kind: &Value, form: &Value) -> String {
    let words = words(kind).into_iter().flatten();
    let own = said(property, kind);
    let own = if own.is_empty() { text(form).to_string() } else { own };
    let words = words.map(|(word, says)| format!(" `{word}`: {says}"));
    words.fold(own, |text, word| text + &word)
}

fn range(kind: &Value) -> String {
    let bound = |name: &str| kind[name].as_f64();
    match (bound("minimum"), bound("exclusiveMinimum"), bound("maximum")) {
        (Some(low), _, Some(high)) => format!("{low} to {high}"),
        (Some(low), ..) => format!("{low} or more"),
        (_, Some(low), _) => format!("above {low}"),
        _ => "any number".into(),
    }
}
