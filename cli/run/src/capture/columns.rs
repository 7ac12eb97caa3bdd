// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which column of a file is which channel.

use anyhow::{Result, bail, ensure};

use super::csv::time;
use super::stream::Adc;

/// The name of a column that is left out.
const LEFT_OUT: &str = "_";

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// This channel of the ADC.
    Channel(usize),
    /// The selected pad.
    Pad,
    /// When the sample was taken.
    Time,
    /// Nothing that is used.
    LeftOut,
}

/// The columns of a file, in its order.
#[derive(Debug, Clone)]
pub struct Columns {
    /// What each column holds, in the file's order.
    pub columns: Vec<Column>,
    /// Names that a header may use, for messages.
    pub names: Vec<String>,
    /// Channels of the ADC.
    pub channels: usize,
}

impl Columns {
    /// Columns of these names; all channels must be among them, once.
    ///
    /// # Errors
    /// A name that is unknown, comes twice or is missing.
    pub fn named(names: &[String], adc: Adc) -> Result<Self> {
        let channels = adc.channels();
        let mut columns = Vec::new();
        for name in names {
            let known = channels.iter().position(|channel| channel == name).map(Column::Channel);
            let column = match name.as_str() {
                "pad" => Column::Pad,
                _ if time::named(name).is_some() => Column::Time,
                LEFT_OUT => Column::LeftOut,
                _ => match known {
                    Some(known) => known,
                    None => bail!("expected {}, got \"{name}\"", wanted(adc)),
                },
            };
            ensure!(
                column == Column::LeftOut || !columns.contains(&column),
                "column {name} comes twice"
            );
            columns.push(column);
        }
        match (0..channels.len()).find(|channel| !columns.contains(&Column::Channel(*channel))) {
            Some(missing) => {
                bail!("column {} is missing: expected {}", channels[missing], wanted(adc))
            }
            None => Ok(Columns { columns, names: names.to_vec(), channels: channels.len() }),
        }
    }

    /// Columns of a file without names: as described, else the channels in order and perhaps the
    /// pad.
    ///
    /// # Errors
    /// There are more or fewer than these.
    pub fn counted(count: usize, described: Option<&[String]>, adc: Adc) -> Result<Self> {
        let mut names = adc.channels();
        if let Some(described) = described {
            ensure!(
                count == described.len(),
                "expected {} channels, as --channels names, got {count}",
                described.len()
            );
            return Columns::named(described, adc).map_err(|error| error.context("--channels"));
        }
        ensure!(
            count == names.len() || count == names.len() + 1,
            "expected {} channels ({}, and perhaps pad), got {count}; --channels names others",
            names.len(),
            names.join(", ")
        );
        names.push("pad".into());
        Columns::named(&names[..count], adc)
    }
}

/// What a message says that is wanted.
pub fn wanted(adc: Adc) -> String {
    format!("columns {} (and perhaps pad)", adc.channels().join(", "))
}

/// The pad that a number names.
pub fn pad(value: f64) -> Option<usize> {
    ((0.0..=255.0).contains(&value) && value.fract() == 0.0).then_some(value as usize)
}
