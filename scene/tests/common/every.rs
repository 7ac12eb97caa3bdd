// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every effect that a scene can name: what it adds to the scene, what takes it away, and which
//! other one it needs.

use std::fmt::Write;

/// An effect in a scene.
pub struct Part {
    /// What a run calls it.
    pub name: &'static str,
    /// The key of its table, or its key in `[sensor]`, and its value.
    key: &'static str,
    value: &'static str,
    needs: Option<&'static str>,
}

const fn part(
    name: &'static str,
    key: &'static str,
    value: &'static str,
    needs: Option<&'static str>,
) -> Part {
    Part { name, key, value, needs }
}

/// In the order in which they act.
pub const PARTS: [Part; 24] = [
    part("supply", "supply", "", None),
    part("gap", "gap", "rung = \"tr-bdf2\"", None),
    part("halves", "halves", "mismatch_percent = 3", Some("gap")),
    part("hand", "hand", "", Some("friction")),
    part("friction", "friction", "rung = \"lugre\"", None),
    part("temperature", "temperature", "tempco_ppm_per_k = 400\nrise_k = 15", Some("sheet")),
    part("sheet", "sheet", "", None),
    part("shunt", "shunt", "nanofarad_per_m2 = 9", Some("sheet")),
    part("sensor.inductance", "series_inductance_mh", "0.1", None),
    part("coupling", "coupling", "", Some("sheet")),
    part("sensor.others", "haptic_leakage_of_others", "true", Some("sensor.leakage")),
    part("carrier", "carrier", "rung = \"samples\"", None),
    part("switching", "switching", "", Some("sheet")),
    part("sensor.leakage", "haptic_leakage", "true", None),
    part("sensor.bandwidth", "bandwidth_khz", "900", None),
    part("sensor.jitter", "jitter_ns_rms", "0.1", None),
    part("sensor.crosstalk", "crosstalk_percent", "0.1", None),
    part("sensor.scale", "gain_error_percent", "1", None),
    part("sensor.gain", "gain_mismatch_percent", "1", None),
    part("sensor.noise_density", "noise_density_na_per_rthz", "1", None),
    part("sensor.offset", "offset_percent", "0.01", None),
    part("sensor.noise", "noise_ppm_rms", "18", None),
    part("sensor.dither", "dither_lsb_rms", "0.5", Some("sensor.quantisation")),
    part("sensor.quantisation", "quantisation_bits", "16", None),
];

/// The carrier is how the device measures: it is there without its table, too.
pub fn optional() -> impl Iterator<Item = &'static Part> {
    PARTS.iter().filter(|part| part.name != "carrier")
}

impl Part {
    /// Whether it goes when `other` does.
    pub fn goes_with(&self, other: &str) -> bool {
        self.name == other || self.needs == Some(other)
    }

    /// Whether `other` is what it needs.
    pub fn needs(&self, other: &str) -> bool {
        self.needs == Some(other)
    }

    /// The override that takes it away.
    pub fn off(&self) -> (String, String) {
        let under = if self.name.starts_with("sensor.") { "sensor." } else { "" };
        (format!("{under}{}", self.key), "false".to_string())
    }
}

/// Two pads, one of them dragged, and these effects.
pub fn scene_of(parts: &[&Part]) -> String {
    const PADS: &str = "duration_s = 0.1\n[[pad]]\nload_g = 50\nhaptic_v_rms = 150\n\
        position_mm = { line = { from_mm = [-100, -60], to_mm = [120, -60], period_s = 1 } }\n\
        [[pad]]\nposition_mm = [-200, 90]\nhaptic_v_rms = 300\n";
    let mut text = PADS.to_string();
    for part in parts.iter().filter(|part| !part.name.starts_with("sensor.")) {
        writeln!(text, "[{}]\n{}", part.key, part.value).unwrap();
    }
    text.push_str("[sensor]\n");
    for part in parts.iter().filter(|part| part.name.starts_with("sensor.")) {
        writeln!(text, "{} = {}", part.key, part.value).unwrap();
    }
    text
}
