// SPDX-License-Identifier: MIT OR Apache-2.0
//! Columns of a run's rows: the one list of them, for `frames.csv` and for arrays.
//!
//! | rows of | have |
//! | --- | --- |
//! | a capture | time, pad, quantities as measured, flags |
//! | a board | besides, where it drives, target and drive; where it has walls, whether the user leaves the wall |
//! | a scene | besides, quantities as they are (`true_…`), case, point of the sweep, load, friction, swept settings |
//! | a scene with a controller | besides, target and drive |
//! | a scene with walls | besides, whether the user leaves the wall, force of the hand, friction of the haptic force |
//! | a scene with an arena | besides, the puck, the force of impacts, the score |

use std::io::{self, Write};

use hapticore_host::{COLUMNS, QUANTITIES};

use crate::record::{Driven, GameRow, Record, Row, Truth};

/// A column of rows.
#[derive(Debug, Clone)]
pub struct Column {
    /// Its name, as in the head of `frames.csv`.
    pub name: String,
    of: Of,
}

/// What a row has in a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    /// A number with a unit, which the column's name ends with.
    Number(f64),
    /// The number of a pad or a point.
    Index(usize),
    /// Whether something is so.
    Flag(bool),
    /// A name or names.
    Text(&'a str),
}

/// What only the rows of a scene have.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OfScene {
    /// The names of the cases.
    pub cases: Vec<String>,
    /// The keys of the pads that are swept.
    pub swept: Vec<&'static str>,
    /// Whether a controller drives the pads.
    pub driven: bool,
    /// Whether they meet walls.
    pub walled: bool,
    /// Whether they play air hockey.
    pub plays: bool,
}

impl OfScene {
    /// Those of a record.
    pub fn of(record: &Record) -> OfScene {
        let walled = |row: &Row| row.driven.is_some_and(|driven| driven.free.is_some());
        OfScene {
            cases: record.cases.clone(),
            swept: record.swept.clone(),
            driven: record.rows.iter().any(|row| row.driven.is_some()),
            walled: record.rows.iter().any(walled),
            plays: record.rows.iter().any(|row| row.game.is_some()),
        }
    }
}

#[derive(Debug, Clone, Copy)]
enum Of {
    Time,
    Pad,
    Measured(usize),
    Flags,
    True(usize),
    Case,
    Point,
    Truth(fn(&Truth) -> f64),
    Set(&'static str),
    TrueFlag(fn(&Truth) -> bool),
    Driven(fn(&Driven) -> f64),
    DrivenFlag(fn(&Driven) -> bool),
    Game(fn(&GameRow) -> f64),
}

/// Columns of rows, in the order of `frames.csv`.
#[derive(Debug, Clone)]
pub struct Columns {
    cases: Vec<String>,
    columns: Vec<Column>,
}

impl Columns {
    /// Those of a capture's rows, or of a scene's.
    pub fn new(scene: Option<OfScene>) -> Columns {
        let mut columns = Columns { cases: Vec::new(), columns: Vec::new() };
        columns.measured();
        if let Some(scene) = scene {
            columns.truth(&scene.swept);
            columns.driven(scene.driven);
            columns.walled(scene.walled);
            columns.game(scene.plays);
            columns.cases = scene.cases;
        }
        columns
    }

    /// Those of a board's rows: as measured, and what drives them.
    pub fn of_board(driven: bool, walled: bool) -> Columns {
        let mut columns = Columns::new(None);
        columns.driven(driven);
        columns.released(walled);
        columns
    }

    /// The columns.
    pub fn iter(&self) -> std::slice::Iter<'_, Column> {
        self.columns.iter()
    }

    /// What a row has in a column.
    pub fn value<'a>(&'a self, column: &Column, row: &'a Row) -> Value<'a> {
        let truth = row.truth.as_ref();
        let driven = || row.driven.unwrap_or_default();
        match column.of {
            Of::Time => Value::Number(row.time_s),
            Of::Pad => Value::Index(row.pad),
            Of::Measured(index) => Value::Number(QUANTITIES[index].value_in(&row.measured)),
            Of::Flags => Value::Text(&row.flags),
            Of::True(index) => Value::Number(
                truth.map_or(f64::NAN, |truth| QUANTITIES[index].value_in(&truth.quantities)),
            ),
            Of::Case => Value::Text(self.cases.get(row.case).map_or("", String::as_str)),
            Of::Point => Value::Index(truth.map_or(0, |truth| truth.point)),
            Of::Truth(of) => Value::Number(truth.map_or(f64::NAN, of)),
            Of::Set(key) => Value::Number(truth.map_or(f64::NAN, |truth| truth.set.get(key))),
            Of::TrueFlag(of) => Value::Flag(truth.is_some_and(of)),
            Of::Driven(of) => Value::Number(of(&driven())),
            Of::DrivenFlag(of) => Value::Flag(of(&driven())),
            Of::Game(of) => Value::Number(row.game.as_ref().map_or(f64::NAN, of)),
        }
    }

    /// What kind of value a column has: one without a meaning.
    pub fn kind(&self, column: &Column) -> Value<'static> {
        match column.of {
            Of::Pad | Of::Point => Value::Index(0),
            Of::Flags | Of::Case => Value::Text(""),
            Of::TrueFlag(_) | Of::DrivenFlag(_) => Value::Flag(false),
            Of::Time
            | Of::Measured(_)
            | Of::True(_)
            | Of::Truth(_)
            | Of::Set(_)
            | Of::Driven(_)
            | Of::Game(_) => Value::Number(0.0),
        }
    }

    /// Writes the names as a line of CSV.
    ///
    /// # Errors
    /// A file or a pipe that takes no more.
    pub fn write_head(&self, to: &mut impl Write) -> io::Result<()> {
        let names: Vec<_> = self.columns.iter().map(|column| column.name.as_str()).collect();
        writeln!(to, "{}", names.join(","))
    }

    /// Writes a row as a line of CSV.
    ///
    /// # Errors
    /// A file or a pipe that takes no more.
    pub fn write_row(&self, row: &Row, to: &mut impl Write) -> io::Result<()> {
        for (index, column) in self.columns.iter().enumerate() {
            if index > 0 {
                write!(to, ",")?;
            }
            match self.value(column, row) {
                Value::Number(number) => write!(to, "{number}")?,
                Value::Index(index) => write!(to, "{index}")?,
                Value::Flag(flag) => write!(to, "{}", u8::from(flag))?,
                Value::Text(text) => write!(to, "{}", field(text))?,
            }
        }
        writeln!(to)
    }

    fn add(&mut self, name: impl Into<String>, of: Of) {
        self.columns.push(Column { name: name.into(), of });
    }

    fn measured(&mut self) {
        let [time, pad, .., flags] = COLUMNS;
        self.add(time, Of::Time);
        self.add(pad, Of::Pad);
        for (index, quantity) in QUANTITIES.iter().enumerate() {
            self.add(quantity.name, Of::Measured(index));
        }
        self.add(flags, Of::Flags);
    }

    fn truth(&mut self, swept: &[&'static str]) {
        for (index, quantity) in QUANTITIES.iter().enumerate() {
            self.add(format!("true_{}", quantity.name), Of::True(index));
        }
        self.add("case", Of::Case);
        self.add("point", Of::Point);
        self.add("true_load_g", Of::Truth(|truth| truth.load_g));
        self.add("true_friction_n", Of::Truth(|truth| truth.friction_n));
        swept.iter().for_each(|key| self.add(format!("set_{key}"), Of::Set(key)));
        self.add("true_over_edge", Of::TrueFlag(|truth| truth.over_edge));
        self.add("true_touching", Of::TrueFlag(|truth| truth.touching));
    }

    fn driven(&mut self, driven: bool) {
        if driven {
            self.add("target_n", Of::Driven(|driven| driven.target_n));
            self.add("drive_v_rms", Of::Driven(|driven| driven.drive_v_rms));
            self.add("drive_limited", Of::DrivenFlag(|driven| driven.limited));
            self.add("drive_fault", Of::DrivenFlag(|driven| driven.fault));
        }
    }

    fn released(&mut self, walled: bool) {
        if walled {
            self.add("released", Of::DrivenFlag(|driven| driven.free.unwrap_or_default()));
        }
    }

    fn walled(&mut self, walled: bool) {
        self.released(walled);
        if walled {
            self.add("true_hand_x_n", Of::Truth(|truth| truth.hand_x_n));
            self.add("true_haptic_friction_n", Of::Truth(|truth| truth.haptic_friction_n));
        }
    }

    fn game(&mut self, plays: bool) {
        if plays {
            self.add("puck_x_mm", Of::Game(|game| game.puck_mm[0]));
            self.add("puck_y_mm", Of::Game(|game| game.puck_mm[1]));
            self.add("puck_mm_s", Of::Game(|game| game.puck_mm_s));
            self.add("impact_n", Of::Game(|game| game.impact_n));
            self.add("score_left", Of::Game(|game| f64::from(game.score[0])));
            self.add("score_right", Of::Game(|game| f64::from(game.score[1])));
        }
    }
}

/// A text as a field of CSV.
fn field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(columns: &Columns) -> Vec<&str> {
        columns.iter().map(|column| column.name.as_str()).collect()
    }

    #[test]
    fn rows_of_a_capture_have_the_columns_of_a_frame() {
        assert_eq!(names(&Columns::new(None)), COLUMNS);
    }

    #[test]
    fn rows_of_a_board_have_no_truth() {
        let columns = Columns::of_board(true, true);
        let names = names(&columns);
        assert_eq!(names[..COLUMNS.len()], COLUMNS);
        let driven = ["target_n", "drive_v_rms", "drive_limited", "drive_fault", "released"];
        assert_eq!(names[COLUMNS.len()..], driven);
    }

    #[test]
    fn walls_add_the_last_columns() {
        let scene =
            OfScene { swept: vec!["load_g"], driven: true, walled: true, ..OfScene::default() };
        let columns = Columns::new(Some(scene));
        assert_eq!(names(&columns).last(), Some(&"true_haptic_friction_n"));
        assert!(names(&columns).contains(&"set_load_g"));
    }

    #[test]
    fn a_game_adds_columns_behind_those_of_walls() {
        let scene = OfScene { driven: true, walled: true, plays: true, ..OfScene::default() };
        let columns = Columns::new(Some(scene));
        let names = names(&columns);
        let at = names.iter().position(|name| *name == "true_haptic_friction_n").expect("a wall's");
        let of_game =
            ["puck_x_mm", "puck_y_mm", "puck_mm_s", "impact_n", "score_left", "score_right"];
        assert_eq!(names[at + 1..], of_game);
    }

    #[test]
    fn a_row_without_a_truth_has_no_number_there() {
        let columns = Columns::new(Some(OfScene::default()));
        let row = Row {
            case: 0,
            time_s: 0.5,
            pad: 3,
            measured: Default::default(),
            flags: "invalid".into(),
            laws: None,
            truth: None,
            driven: None,
            game: None,
            reference: None,
        };
        let value = |name| {
            let column = columns.iter().find(|column| column.name == name).expect("a column");
            columns.value(column, &row)
        };
        assert_eq!(value("pad"), Value::Index(3));
        assert_eq!(value("flags"), Value::Text("invalid"));
        assert!(matches!(value("true_x_mm"), Value::Number(number) if number.is_nan()));
        assert_eq!(value("true_touching"), Value::Flag(false));
    }
}
