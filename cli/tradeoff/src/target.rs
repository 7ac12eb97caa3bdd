// SPDX-License-Identifier: MIT OR Apache-2.0
//! Errors that a profile shall not exceed: `force=1mN,position=0.1mm,capacitance=0.01%`.

use super::errors::Quantity;
use anyhow::Result;
use serde::Serialize;
use std::str::FromStr;

/// Errors that a profile shall not exceed, RMS; none where nothing is asked.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Target(pub [Option<f64>; 3]);

impl FromStr for Target {
    type Err = anyhow::Error;

    /// Reads `force=1mN,position=0.1mm,capacitance=0.01%`.
    fn from_str(text: &str) -> Result<Self> {
        let mut target = Target::default();
        for part in text.split(',') {
            let (name, amount) = part.split_once('=').unwrap_or((part, ""));
            let quantity = Quantity::ALL.iter().position(|of| of.name() == name.trim());
            let (Some(quantity), Some(amount)) = (quantity, amount_of(amount.trim())) else {
                anyhow::bail!(
                    "expected force=1mN, capacitance=0.1% or position=0.1mm, got \"{part}\""
                );
            };
            let (value, unit) = amount;
            let units = [
                [("mN", 1.0), ("N", 1e3), ("uN", 1e-3)],
                [("%", 1.0); 3],
                [("um", 1.0), ("µm", 1.0), ("mm", 1e3)],
            ];
            let factor = units[quantity].iter().find(|(name, _)| *name == unit);
            let Some((_, factor)) = factor else {
                let names = units[quantity].map(|(name, _)| name);
                anyhow::bail!("{name}: expected a unit among {}, got \"{unit}\"", names.join(", "));
            };
            target.0[quantity] = Some(value * factor);
        }
        Ok(target)
    }
}

fn amount_of(text: &str) -> Option<(f64, &str)> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let value: f64 = text[..end].parse().ok()?;
    (value.is_finite() && value > 0.0).then_some((value, text[end..].trim()))
}
