// SPDX-License-Identifier: MIT OR Apache-2.0
//! `results.parquet`: the rows of `results.csv`, with types. Names, fronts and errors are texts.
//! Seeds are whole numbers, which a double cannot always represent. Any other column has doubles
//! where all its cells are finite numbers or empty, else texts. An empty cell is null.

use std::str::FromStr;
use std::sync::Arc;

use anyhow::Result;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};

/// The cells of a column.
enum Column {
    Whole(Vec<Option<i64>>),
    Numbers(Vec<Option<f64>>),
    Texts(Vec<Option<String>>),
}

/// Columns that are texts whatever they hold.
const TEXTS: [&str; 3] = ["key", "front", "error"];
/// The column of whole numbers.
const WHOLE: &str = "seed";

/// The cells as numbers, none where one is empty; none at all where one is no number.
fn parsed<T: FromStr>(cells: &[String], holds: fn(&T) -> bool) -> Option<Vec<Option<T>>> {
    let number = |cell: &String| match cell.as_str() {
        "" => Some(None),
        text => text.parse().ok().filter(holds).map(Some),
    };
    cells.iter().map(number).collect()
}

impl Column {
    fn of(name: &str, cells: Vec<String>) -> Self {
        let numbers = match name {
            WHOLE => parsed(&cells, |_| true).map(Column::Whole),
            _ if TEXTS.contains(&name) => None,
            _ => parsed(&cells, |number: &f64| number.is_finite()).map(Column::Numbers),
        };
        let some = |cell: String| Some(cell).filter(|cell| !cell.is_empty());
        numbers.unwrap_or_else(|| Column::Texts(cells.into_iter().map(some).collect()))
    }

    fn field(&self, name: &str) -> Result<TypePtr> {
        let (physical, logical) = match self {
            Column::Whole(_) => (Physical::INT64, None),
            Column::Numbers(_) => (Physical::DOUBLE, None),
            Column::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical).with_logical_type(logical);
        Ok(Arc::new(field.with_repetition(Repetition::OPTIONAL).build()?))
    }

    fn write(&self, to: &mut ColumnWriter) -> Result<()> {
        match (self, to) {
            (Column::Whole(cells), ColumnWriter::Int64ColumnWriter(to)) => {
                let some: Vec<i64> = cells.iter().flatten().copied().collect();
                to.write_batch(&some, Some(&levels(cells)), None)?;
            }
            (Column::Numbers(cells), ColumnWriter::DoubleColumnWriter(to)) => {
                let some: Vec<f64> = cells.iter().flatten().copied().collect();
                to.write_batch(&some, Some(&levels(cells)), None)?;
            }
            (Column::Texts(cells), ColumnWriter::ByteArrayColumnWriter(to)) => {
                let some: Vec<_> =
                    cells.iter().flatten().map(|text| ByteArray::from(text.as_str())).collect();
                to.write_batch(&some, Some(&levels(cells)), None)?;
            }
            _ => unreachable!("a column's writer is of its field's type"),
        }
        Ok(())
    }
}

/// Which cells are there: 1, and 0 of null.
fn levels<T>(cells: &[Option<T>]) -> Vec<i16> {
    cells.iter().map(|cell| i16::from(cell.is_some())).collect()
}

/// A table of named columns as a Parquet file: the same bytes for the same cells.
///
/// # Errors
/// A table that is none: two columns of one name.
pub fn file(head: &[String], rows: &[Vec<String>]) -> Result<Vec<u8>> {
    let cells = |n: usize| rows.iter().map(|row| row[n].clone()).collect();
    let column = |(n, name): (usize, &String)| Column::of(name, cells(n));
    let columns: Vec<Column> = head.iter().enumerate().map(column).collect();
    let fields = head.iter().zip(&columns).map(|(name, column)| column.field(name));
    let fields = fields.collect::<Result<Vec<_>>>()?;
    let schema = Type::group_type_builder("results").with_fields(fields).build()?;
    let properties = WriterProperties::builder().set_created_by("hapticore".into()).build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in &columns {
        let mut to = group.next_column()?.expect("a writer per column");
        column.write(to.untyped())?;
        to.close()?;
    }
    group.close()?;
    Ok(writer.into_inner()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::{Field, Row};
    use std::io::Write;

    #[test]
    fn cells_are_read_again_with_their_types() {
        let text = |cells: [&str; 5]| cells.map(String::from).to_vec();
        let head = ["key", "seed", "profile.adc", "scene.mode", "error"].map(String::from);
        let rows = [
            ["12e4", "9223372036854775807", "16", "inf", ""],
            ["7b", "1", "-2.5e-7", "2", "no core"],
            ["", "", "", "", ""],
        ]
        .map(text);
        let bytes = file(&head, &rows).expect("a table");
        assert_eq!(bytes, file(&head, &rows).expect("a table"), "the same bytes");
        let mut kept = tempfile::tempfile().expect("a file");
        kept.write_all(&bytes).expect("written");
        let reader = SerializedFileReader::new(kept).expect("a table");
        let cells = |row: Row| row.into_columns().into_iter().map(|(_, cell)| cell).collect();
        let rows = reader.get_row_iter(None).expect("rows").map(|row| cells(row.expect("a row")));
        let of = |text: &str| Field::Str(text.into());
        let expected = [
            vec![of("12e4"), Field::Long(i64::MAX), Field::Double(16.0), of("inf"), Field::Null],
            vec![of("7b"), Field::Long(1), Field::Double(-2.5e-7), of("2"), of("no core")],
            vec![Field::Null; 5],
        ];
        assert_eq!(rows.collect::<Vec<Vec<Field>>>(), expected);
    }
}
