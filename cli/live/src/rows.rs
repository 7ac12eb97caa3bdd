// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every slot for programs: the columns that a client has subscribed to.

use hapticore_host::QUANTITIES;
use hapticore_run::record::{Driven, GameRow, Row, Truth};
use hapticore_scene::did_you_mean;

use crate::client::{Bytes, binary_frame, text_frame};
use crate::protocol::{Answer, Every, Format, Subscription};

/// What a binary message begins with.
const MAGIC: &[u8; 4] = b"HPL1";

/// The most rows of a message: their number has 16 bits.
const MOST_ROWS: usize = 4096;

/// The most columns of a subscription.
const MOST_COLUMNS: usize = 64;

/// Takes a value of the row of a slot; not a number where the row has none.
type Get = Box<dyn Fn(usize, &Row) -> f64 + Send>;

/// All columns that there are.
pub fn names() -> Vec<String> {
    let own = OWN.iter().map(|(name, _)| name.to_string());
    let flags = FLAGS.iter().map(|name| name.to_string());
    let quantities = QUANTITIES.iter().map(|quantity| quantity.name);
    own.chain(flags)
        .chain(quantities.clone().map(String::from))
        .chain(quantities.map(|name| format!("true_{name}")))
        .chain(GAME.iter().map(|(name, _)| name.to_string()))
        .collect()
}

const FLAGS: [&str; 5] = ["clipped", "saturated", "invalid", "lost", "lifted"];

/// A column, and how its value is taken of a slot's number and row.
type Own = (&'static str, fn(usize, &Row) -> f64);

const OWN: [Own; 15] = [
    ("slot", |slot, _| slot as f64),
    ("time_s", |_, row| row.time_s),
    ("pad", |_, row| row.pad as f64),
    ("true_load_g", |_, row| truth(row, |truth| truth.load_g)),
    ("true_friction_n", |_, row| truth(row, |truth| truth.friction_n)),
    ("true_haptic_friction_n", |_, row| truth(row, |truth| truth.haptic_friction_n)),
    ("true_hand_x_n", |_, row| truth(row, |truth| truth.hand_x_n)),
    ("true_hand_y_n", |_, row| truth(row, |truth| truth.hand_y_n)),
    ("finger_x_mm", |_, row| truth(row, |truth| truth.set.x_mm)),
    ("finger_y_mm", |_, row| truth(row, |truth| truth.set.y_mm)),
    ("target_n", |_, row| driven(row, |driven| driven.target_n)),
    ("drive_v_rms", |_, row| driven(row, |driven| driven.drive_v_rms)),
    ("drive_limited", |_, row| driven(row, |driven| f64::from(driven.limited))),
    ("drive_fault", |_, row| driven(row, |driven| f64::from(driven.fault))),
    ("released", |_, row| driven(row, |driven| driven.free.map_or(f64::NAN, f64::from))),
];

/// Of scenes with an arena; behind all others.
const GAME: [Own; 6] = [
    ("puck_x_mm", |_, row| game(row, |game| game.puck_mm[0])),
    ("puck_y_mm", |_, row| game(row, |game| game.puck_mm[1])),
    ("puck_mm_s", |_, row| game(row, |game| game.puck_mm_s)),
    ("impact_n", |_, row| game(row, |game| game.impact_n)),
    ("score_left", |_, row| game(row, |game| f64::from(game.score[0]))),
    ("score_right", |_, row| game(row, |game| f64::from(game.score[1]))),
];

fn truth(row: &Row, of: fn(&Truth) -> f64) -> f64 {
    row.truth.as_ref().map_or(f64::NAN, of)
}

fn driven(row: &Row, of: fn(&Driven) -> f64) -> f64 {
    row.driven.as_ref().map_or(f64::NAN, of)
}

fn game(row: &Row, of: fn(&GameRow) -> f64) -> f64 {
    row.game.as_ref().map_or(f64::NAN, of)
}

/// How the value of a column is taken; none where there is no such column.
fn getter(name: &str) -> Option<Get> {
    if let Some((_, get)) = OWN.iter().chain(&GAME).find(|(own, _)| *own == name) {
        return Some(Box::new(get));
    }
    if let Some(flag) = FLAGS.into_iter().find(|flag| *flag == name) {
        return Some(Box::new(move |_, row| f64::from(row.flags.split('+').any(|of| of == flag))));
    }
    let of = |name: &str| QUANTITIES.iter().find(|quantity| quantity.name == name);
    if let Some(quantity) = of(name) {
        return Some(Box::new(|_, row| quantity.value_in(&row.measured)));
    }
    let quantity = of(name.strip_prefix("true_")?)?;
    Some(Box::new(|_, row| {
        row.truth.map_or(f64::NAN, |truth| quantity.value_in(&truth.quantities))
    }))
}

/// The rows that a client has subscribed to and not yet been sent.
pub struct Subscriber {
    columns: Vec<String>,
    getters: Vec<Get>,
    format: Format,
    /// Values, row after row.
    values: Vec<f64>,
}

impl Subscriber {
    /// What a client asks for; none where it asks for no rows.
    ///
    /// # Errors
    /// No column, too many, or one that there is not.
    pub fn new(asked: &Subscription) -> Result<Option<Subscriber>, String> {
        if asked.every == Every::Frame {
            return Ok(None);
        }
        if !(1..=MOST_COLUMNS).contains(&asked.columns.len()) {
            return Err(format!(
                "columns: expected 1 to {MOST_COLUMNS}, got {}",
                asked.columns.len()
            ));
        }
        let getters = asked.columns.iter().map(|name| {
            let unknown = || {
                let name: String = name.chars().take(40).collect();
                let known = names();
                let near = did_you_mean(&name, known.iter().map(String::as_str));
                let known = known.join(", ");
                format!("columns: expected names among {known}, got {name:?}{near}")
            };
            getter(name).ok_or_else(unknown)
        });
        Ok(Some(Subscriber {
            getters: getters.collect::<Result<_, _>>()?,
            columns: asked.columns.clone(),
            format: asked.format,
            values: Vec::new(),
        }))
    }

    /// Takes the row of a slot; a message where it is the last that one holds.
    pub fn add(&mut self, slot: usize, row: &Row) -> Option<Bytes> {
        self.values.extend(self.getters.iter().map(|get| get(slot, row)));
        (self.rows() == MOST_ROWS).then(|| self.take()).flatten()
    }

    /// The rows that have come since the last message; none without any.
    pub fn take(&mut self) -> Option<Bytes> {
        if self.values.is_empty() {
            return None;
        }
        let bytes = match self.format {
            Format::Json => text_frame(&self.json()),
            Format::Binary => binary_frame(self.binary()),
        };
        self.values.clear();
        Some(bytes)
    }

    fn rows(&self) -> usize {
        self.values.len() / self.columns.len()
    }

    fn json(&self) -> String {
        let finite = |value: &f64| value.is_finite().then_some(*value);
        let rows = self.values.chunks(self.columns.len());
        let rows = rows.map(|row| row.iter().map(finite).collect()).collect();
        Answer::Rows { columns: self.columns.clone(), rows }.text()
    }

    fn binary(&self) -> Vec<u8> {
        let (columns, rows) = (self.columns.len(), self.rows());
        let mut bytes = MAGIC.to_vec();
        bytes.extend((columns as u16).to_le_bytes());
        bytes.extend((rows as u16).to_le_bytes());
        for column in 0..columns {
            let values = self.values.iter().skip(column).step_by(columns);
            values.for_each(|value| bytes.extend(value.to_le_bytes()));
        }
        bytes
    }
}
