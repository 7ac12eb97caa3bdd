// SPDX-License-Identifier: MIT OR Apache-2.0
//! Requests as they come from a client: anything at all, so that each field is asked for by name and every message says
//! what was expected.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::{Command, LONGEST, MOST_SLOTS, Opening, SPEEDS, Setting};

/// A command, and the number that its answer repeats.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Request {
    /// Chosen by the client; without one only errors are answered.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub id: Option<u64>,
    /// What is asked for.
    #[serde(flatten)]
    pub command: Command,
}

/// A message that is no request.
#[derive(Debug, Clone, PartialEq)]
pub struct BadRequest {
    /// Its number, as far as it has one.
    pub id: Option<u64>,
    /// What was expected, and what was found.
    pub message: String,
}

/// The types of commands.
const TYPES: [&str; 16] = [
    "lead",
    "release",
    "set",
    "target",
    "wall",
    "serve",
    "arm",
    "alive",
    "disable",
    "enable",
    "pace",
    "step",
    "slot",
    "record",
    "open",
    "subscribe",
];

/// How much of a client's text a message repeats, characters.
const CITED: usize = 60;

impl Request {
    /// The request that a text is.
    ///
    /// ```
    /// use hapticore_live::protocol::{Command, Request};
    ///
    /// let request = Request::parse(r#"{"type":"pace","id":3,"speed":0.1}"#).unwrap();
    /// assert_eq!((request.id, request.command), (Some(3), Command::Pace { speed: 0.1 }));
    /// let error = Request::parse(r#"{"type":"pace","id":3,"speed":"fast"}"#).unwrap_err();
    /// assert_eq!((error.id, error.message.as_str()), (Some(3), r#"speed: expected a number, got "fast""#));
    /// ```
    ///
    /// # Errors
    /// A text that is too long, no JSON, of no known type, or a field that is missing, of another kind or out of range.
    pub fn parse(text: &str) -> Result<Request, BadRequest> {
        let bad = |id, message| BadRequest { id, message };
        if text.len() > LONGEST {
            let message = format!("message: expected at most {LONGEST} bytes, got {}", text.len());
            return Err(bad(None, message));
        }
        let value: Value = serde_json::from_str(text)
            .map_err(|error| bad(None, format!("message: expected JSON: {error}")))?;
        let Value::Object(map) = value else {
            return Err(bad(None, format!("message: expected an object, got {}", cited(&value))));
        };
        let fields = Fields(&map);
        let id = fields.id().map_err(|message| bad(None, message))?;
        let command = fields.command().map_err(|message| bad(id, message))?;
        Ok(Request { id, command })
    }
}

/// The fields of a message.
struct Fields<'a>(&'a Map<String, Value>);

type Read<T> = Result<T, String>;

impl Fields<'_> {
    fn id(&self) -> Read<Option<u64>> {
        self.optional("id", "a whole number", Value::as_u64)
    }

    fn command(&self) -> Read<Command> {
        let kind = self.required("type", "a word", |value| value.as_str().map(String::from))?;
        Ok(match kind.as_str() {
            "lead" => Command::Lead {
                pad: self.pad()?,
                mm: self.required("mm", "two numbers", pair)?,
                within_s: self.number_or_none("within_s")?,
            },
            "release" => Command::Release { pad: self.pad()? },
            "set" => Command::Set { pad: self.pad()?, setting: self.setting()? },
            "target" => Command::Target { pad: self.pad()?, n: self.number("n")? },
            "wall" => self.wall()?,
            "serve" => Command::Serve,
            "arm" => Command::Arm { on: self.required("on", "true or false", Value::as_bool)? },
            "alive" => Command::Alive,
            "disable" => Command::Disable,
            "enable" => Command::Enable,
            "pace" => Command::Pace { speed: self.speed()? },
            "step" => Command::Step { slots: self.slots()? },
            "slot" => Command::Slot,
            "record" => Command::Record { to: self.word("to", "\"start\", \"scene\" or \"log\"")? },
            "open" => Command::Open(self.opening()?),
            "subscribe" => Command::Subscribe(self.subscription()?),
            other => {
                let known = TYPES.join(", ");
                return Err(format!("type: expected one of {known}, got {}", cited(&other.into())));
            }
        })
    }

    fn required<T>(&self, key: &str, what: &str, read: impl Fn(&Value) -> Option<T>) -> Read<T> {
        let value = self.0.get(key).ok_or_else(|| format!("{key}: expected {what}, got none"))?;
        read(value).ok_or_else(|| format!("{key}: expected {what}, got {}", cited(value)))
    }

    fn optional<T>(
        &self,
        key: &str,
        what: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Read<Option<T>> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(_) => self.required(key, what, read).map(Some),
        }
    }

    fn pad(&self) -> Read<usize> {
        let whole = |value: &Value| value.as_u64().and_then(|pad| usize::try_from(pad).ok());
        self.required("pad", "the number of a pad", whole)
    }

    fn number(&self, key: &str) -> Read<f64> {
        self.required(key, "a number", Value::as_f64)
    }

    fn number_or_none(&self, key: &str) -> Read<Option<f64>> {
        self.optional(key, "a number", Value::as_f64)
    }

    fn word<T: DeserializeOwned>(&self, key: &str, what: &str) -> Read<T> {
        self.required(key, what, |value| serde_json::from_value(value.clone()).ok())
    }

    fn setting(&self) -> Read<Setting> {
        type Make = fn(f64) -> Setting;
        const SETTINGS: [(&str, Make); 5] = [
            ("load_g", Setting::LoadG),
            ("push_x_n", Setting::PushXN),
            ("push_y_n", Setting::PushYN),
            ("haptic_v_rms", Setting::HapticVRms),
            ("target_n", Setting::TargetN),
        ];
        let mut given = SETTINGS.iter().filter(|(key, _)| self.0.contains_key(*key));
        match (given.next(), given.next()) {
            (Some((key, make)), None) => Ok(make(self.number(key)?)),
            _ => Err(format!(
                "set: expected exactly one of {}",
                SETTINGS.map(|(key, _)| key).join(", ")
            )),
        }
    }

    fn wall(&self) -> Read<Command> {
        let x_mm = match self.number_or_none("x_mm")? {
            None => self.number_or_none("mm")?,
            some => some,
        };
        let y_mm = self.number_or_none("y_mm")?;
        let off = self.optional("off", "true or false", Value::as_bool)?.unwrap_or(false);
        if x_mm.is_none() && y_mm.is_none() && !off {
            return Err("wall: expected one of mm, x_mm, y_mm, or \"off\": true".into());
        }
        Ok(Command::Wall { x_mm, y_mm, off })
    }

    fn speed(&self) -> Read<f64> {
        let (speed, [least, most]) = (self.number("speed")?, SPEEDS);
        match speed == 0.0 || (least..=most).contains(&speed) {
            true => Ok(speed),
            false => Err(format!("speed: expected 0, or {least} to {most}, got {speed}")),
        }
    }

    fn slots(&self) -> Read<usize> {
        let within = |value: &Value| {
            let slots = usize::try_from(value.as_u64()?).ok()?;
            (1..=MOST_SLOTS).contains(&slots).then_some(slots)
        };
        self.required("slots", &format!("1 to {MOST_SLOTS}"), within)
    }

    fn opening(&self) -> Read<Opening> {
        let text = |value: &Value| value.as_str().map(String::from);
        let plain = |value: &Value| match value {
            Value::String(text) => Some(text.clone()),
            Value::Number(_) | Value::Bool(_) | Value::Array(_) => Some(value.to_string()),
            _ => None,
        };
        let set = |value: &Value| {
            let keys = value.as_object()?.iter();
            keys.map(|(key, value)| Some((key.clone(), plain(value)?))).collect::<Option<_>>()
        };
        let case = |value: &Value| match value {
            Value::Number(number) => number.as_u64().map(|number| number.to_string()),
            other => text(other),
        };
        Ok(Opening {
            scene: self.required("scene", "the name of a bundled scene", text)?,
            set: self
                .optional("set", "keys with texts, numbers or lists", set)?
                .unwrap_or_default(),
            case: self.optional("case", "the number or name of a case", case)?,
            profile: self.optional("profile", "the name of a profile", text)?,
            core: self.optional("core", "\"float\", \"fixed\" or \"clock\"", text)?,
        })
    }

    fn subscription(&self) -> Read<super::Subscription> {
        let names = |value: &Value| {
            let names = value.as_array()?.iter();
            names.map(|name| name.as_str().map(String::from)).collect::<Option<Vec<_>>>()
        };
        let format = |value: &Value| serde_json::from_value(value.clone()).ok();
        Ok(super::Subscription {
            columns: self.optional("columns", "a list of names", names)?.unwrap_or_default(),
            every: self.word("every", "\"slot\" or \"frame\"")?,
            format: self.optional("format", "\"json\" or \"binary\"", format)?.unwrap_or_default(),
        })
    }
}

fn pair(value: &Value) -> Option<[f64; 2]> {
    let list = value.as_array().filter(|list| list.len() == 2)?;
    Some([list[0].as_f64()?, list[1].as_f64()?])
}

/// A value as messages repeat it: not much of it.
fn cited(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(CITED) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
