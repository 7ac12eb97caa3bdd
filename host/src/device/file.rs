// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file of a device's calibration: read, checked and written.

use super::{DeviceCalibration, Force, MOST_CONTACT_PF, Raster, Scales, Shares};
use crate::text::{ReadError, read, with_key};
use std::fmt::Write;
use std::path::Path;

/// A file that is no calibration.
#[derive(Debug, thiserror::Error)]
pub enum DeviceError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It is none; the message names file, line and key.
    #[error("{0}")]
    Invalid(String),
}

impl DeviceCalibration {
    /// Reads a calibration file.
    ///
    /// # Errors
    /// It is not there or no calibration; the message names file, line and key.
    pub fn read(path: &Path) -> Result<Self, DeviceError> {
        DeviceCalibration::parse(&read(path)?, &path.display().to_string())
    }

    /// The calibration that a text is, called `file` in messages.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str, file: &str) -> Result<Self, DeviceError> {
        let read: DeviceCalibration = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
            DeviceError::Invalid(format!(
                "{file}:{}",
                with_key(text, &format!("{line}: {}", error.message()))
            ))
        })?;
        read.check().map_err(|message| DeviceError::Invalid(format!("{file}: {message}")))?;
        Ok(read)
    }

    fn check(&self) -> Result<(), String> {
        let parts = self.parts;
        if parts == 0 || !self.pads.is_multiple_of(parts) {
            let pads = self.pads;
            return Err(format!("parts: expected a divisor of pads, {pads}, got {parts}"));
        }
        match self.pads {
            1..=256 => {
                self.device.check()?;
                self.force.as_ref().map_or(Ok(()), Force::check)?;
                let terminals = self.terminals.x.len();
                self.shares.as_ref().map_or(Ok(()), |shares| shares.check(terminals))?;
                self.map.check()
            }
            pads => Err(format!("pads: expected 1 to 256, got {pads}")),
        }
    }

    /// The text of a calibration file, one place a line.
    pub fn text(&self) -> String {
        let device = &self.device;
        let mut text = format!(
            "# A device's calibration for `hapticore replay`.\npads = {}\n{}\n[terminals]\nx = {:?}\ny = {:?}\n\n[device]\n\
             sample_rate_hz = {:?}\ncarrier_hz = {:?}\ncurrent_full_scale_a = {:?}\nsense_full_scale_v = {:?}\n\
             haptic_full_scale_v = {:?}\nforce_k = {:?}\n{}{}{}\n[map]\ncolumns = {}\nopen_share = {:?}\n\
             places = [ # x_mm, y_mm, r_x, r_y, sheet_ohm\n",
            self.pads,
            if self.parts > 1 { format!("parts = {}\n", self.parts) } else { String::new() },
            self.terminals.x,
            self.terminals.y,
            device.sample_rate_hz,
            device.carrier_hz,
            device.current_full_scale_a,
            device.sense_full_scale_v,
            device.haptic_full_scale_v,
            device.force_k,
            device
                .pad_diameter_mm
                .map(|mm| format!("pad_diameter_mm = {mm:?}\n"))
                .unwrap_or_default(),
            device.contact_pf.map(|pf| format!("contact_pf = {pf:?}\n")).unwrap_or_default(),
            self.force.as_ref().map(Force::text).unwrap_or_default(),
            self.map.columns,
            self.map.open_share
        );
        for place in &self.map.places {
            writeln!(text, "{place:?},").expect("a string takes all");
        }
        text.push_str("]\n");
        text.extend(self.shares.as_ref().map(Shares::text));
        text
    }
}

impl Scales {
    fn check(&self) -> Result<(), String> {
        let values = [
            ("sample_rate_hz", self.sample_rate_hz),
            ("carrier_hz", self.carrier_hz),
            ("current_full_scale_a", self.current_full_scale_a),
            ("sense_full_scale_v", self.sense_full_scale_v),
            ("haptic_full_scale_v", self.haptic_full_scale_v),
            ("force_k", self.force_k),
            ("pad_diameter_mm", self.pad_diameter_mm.unwrap_or(1.0)),
        ];
        let bad = values.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0));
        if let Some((key, value)) = bad {
            return Err(format!("device.{key}: expected a number above 0, got {value}"));
        }
        match self.contact_pf {
            Some(pf) if !(0.0..=MOST_CONTACT_PF).contains(&pf) => {
                Err(format!("device.contact_pf: expected 0 to {MOST_CONTACT_PF} pF, got {pf}"))
            }
            _ => Ok(()),
        }
    }
}

impl Raster {
    fn check(&self) -> Result<(), String> {
        if !(0.0..1.0).contains(&self.open_share) {
            return Err(format!("map.open_share: expected 0 to 1, got {}", self.open_share));
        }
        let places = self.places.len();
        if self.columns < 2 || !places.is_multiple_of(self.columns) || places / self.columns < 2 {
            let expected = "expected two whole rows or more of two columns or more";
            return Err(format!(
                "map.columns: {expected}, got {places} places in rows of {}",
                self.columns
            ));
        }
        match self.places.iter().position(|place| place.iter().any(|number| !number.is_finite())) {
            Some(index) => {
                Err(format!("map.places: expected finite numbers, got {:?}", self.places[index]))
            }
            None => Ok(()),
        }
    }
}
