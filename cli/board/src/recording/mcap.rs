// SPDX-License-Identifier: MIT OR Apache-2.0
//! MCAP: rows and notes as JSON messages with their times, for Foxglove, PlotJuggler and the `mcap` libraries.
//!
//! | topic | message |
//! | --- | --- |
//! | `/pad/N` | a row of pad N: the columns of `frames.csv`; a number that is none is `null` |
//! | `/notes` | `{"text": …}`: what the session reports |
//!
//! Records follow each other without chunks, so that a recording which is cut off is read up to its last whole
//! record. Source: the format's specification, <https://mcap.dev/spec>.

use std::io::{self, Write};

use hapticore_run::columns::{Column, Columns, Value};
use hapticore_run::record::Row;
use serde_json::{Map, Value as Json, json};

use super::Recorder;

const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Opcodes of records.
mod op {
    pub const HEADER: u8 = 0x01;
    pub const FOOTER: u8 = 0x02;
    pub const SCHEMA: u8 = 0x03;
    pub const CHANNEL: u8 = 0x04;
    pub const MESSAGE: u8 = 0x05;
    pub const DATA_END: u8 = 0x0f;
}

/// The channel of notes; that of a pad is its number plus one.
const NOTES: u16 = 0;
/// Schemas of notes and of rows; 0 stands for none.
const SCHEMAS: [u16; 2] = [1, 2];

/// A recording as MCAP. It ends where it is dropped.
pub struct Mcap<W: Write> {
    columns: Columns,
    to: W,
    /// Messages of each channel.
    sequences: Vec<u32>,
}

impl<W: Write> Mcap<W> {
    /// Writes the head and a channel for each pad.
    ///
    /// # Errors
    /// A file that takes nothing.
    pub fn new(columns: Columns, pads: usize, mut to: W) -> io::Result<Self> {
        to.write_all(MAGIC)?;
        let library = concat!("hapticore ", env!("CARGO_PKG_VERSION"));
        record(&mut to, op::HEADER, &[text(""), text(library)])?;
        let note = json!({"type": "object", "properties": {"text": {"type": "string"}}});
        schema(&mut to, SCHEMAS[0], "hapticore.Note", &note)?;
        schema(&mut to, SCHEMAS[1], "hapticore.Row", &schema_of(&columns))?;
        channel(&mut to, NOTES, SCHEMAS[0], "/notes")?;
        for pad in 0..pads {
            channel(&mut to, channel_of(pad), SCHEMAS[1], &format!("/pad/{pad}"))?;
        }
        Ok(Mcap { columns, to, sequences: vec![0; pads + 1] })
    }

    fn message(&mut self, channel: u16, time_s: f64, message: &Json) -> io::Result<()> {
        let sequence = &mut self.sequences[usize::from(channel)];
        let time_ns = (1e9 * time_s).round() as u64;
        let head = [
            channel.to_le_bytes().to_vec(),
            sequence.to_le_bytes().to_vec(),
            // Logged and published: the board's time of both.
            time_ns.to_le_bytes().repeat(2),
        ];
        *sequence += 1;
        let [channel, sequence, times] = head;
        record(&mut self.to, op::MESSAGE, &[channel, sequence, times, serde_json::to_vec(message)?])
    }

    fn end(&mut self) -> io::Result<()> {
        // Check sums and the places of a summary are left out: 0.
        record(&mut self.to, op::DATA_END, &[vec![0; 4]])?;
        record(&mut self.to, op::FOOTER, &[vec![0; 20]])?;
        self.to.write_all(MAGIC)?;
        self.to.flush()
    }
}

impl<W: Write + Send> Recorder for Mcap<W> {
    fn row(&mut self, row: &Row) -> io::Result<()> {
        let of = |column: &Column| (column.name.clone(), json_of(self.columns.value(column, row)));
        let message: Map<_, _> = self.columns.iter().map(of).collect();
        self.message(channel_of(row.pad), row.time_s, &Json::Object(message))
    }

    fn note(&mut self, time_s: f64, text: &str) -> io::Result<()> {
        self.message(NOTES, time_s, &json!({"text": text}))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

impl<W: Write> Drop for Mcap<W> {
    fn drop(&mut self) {
        // Where it cannot be written, the rows before have been reported already.
        let _ = self.end();
    }
}

fn channel_of(pad: usize) -> u16 {
    pad as u16 + NOTES + 1
}

fn json_of(value: Value) -> Json {
    match value {
        Value::Number(number) => json!(number),
        Value::Index(index) => json!(index),
        Value::Flag(flag) => json!(flag),
        Value::Text(text) => json!(text),
    }
}

/// The JSON Schema of rows.
fn schema_of(columns: &Columns) -> Json {
    let kind = |column: &Column| match columns.kind(column) {
        Value::Number(_) => json!(["number", "null"]),
        Value::Index(_) => json!("integer"),
        Value::Flag(_) => json!("boolean"),
        Value::Text(_) => json!("string"),
    };
    let of = |column: &Column| (column.name.clone(), json!({"type": kind(column)}));
    let properties: Map<_, _> = columns.iter().map(of).collect();
    json!({"type": "object", "properties": properties})
}

fn schema(to: &mut impl Write, id: u16, name: &str, schema: &Json) -> io::Result<()> {
    let fields =
        [id.to_le_bytes().to_vec(), text(name), text("jsonschema"), text(&schema.to_string())];
    record(to, op::SCHEMA, &fields)
}

fn channel(to: &mut impl Write, id: u16, schema: u16, topic: &str) -> io::Result<()> {
    let metadata = vec![0; 4];
    let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
    record(to, op::CHANNEL, &[ids, text(topic), text("json"), metadata])
}

/// A text after its length.
fn text(text: &str) -> Vec<u8> {
    let length = text.len() as u32;
    [&length.to_le_bytes(), text.as_bytes()].concat()
}

/// A record: its opcode, its length, its fields.
fn record(to: &mut impl Write, opcode: u8, fields: &[Vec<u8>]) -> io::Result<()> {
    let content = fields.concat();
    to.write_all(&[opcode])?;
    to.write_all(&(content.len() as u64).to_le_bytes())?;
    to.write_all(&content)
}
