// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every effect that a scene can name: what it adds to the scene, what takes it away, and which
//! other one it needs.

use std::fmt::Write;

/// An effect in a scene.
pub struct Part {
    /// What a run calls it.
    pub name: &'static str,
    /// Its table, or its key in another's.
    key: &'static str,
    /// What the table holds of it, or the key's line and what belongs to it.
    lines: &'static [&'static str],
    needs: Option<&'static str>,
}

const fn part(
    name: &'static str,
    key: &'static str,
    lines: &'static [&'static str],
    needs: Option<&'static str>,
) -> Part {
    Part { name, key, lines, needs }
}

/// In the order in which they act.
pub const PARTS: [Part; 28] = [
    part("supply", "supply", &[], None),
    part("charge", "charge", &["share = 0.3", "time_constant_s = 0.05", "start_v = 40"], None),
    part(
        "temperature.spring",
        "temperature.spring_percent_per_k",
        &["spring_percent_per_k = 0.34", "rise_k = 15"],
        Some("gap"),
    ),
    part("gap", "gap", &["rung = \"tr-bdf2\""], None),
    part("halves", "halves", &["mismatch_percent = 3"], Some("gap")),
    part("hand", "hand", &[], Some("friction")),
    part("release", "release", &[], Some("friction")),
    part("friction", "friction", &["rung = \"lugre\""], None),
    part(
        "temperature",
        "temperature.tempco_ppm_per_k",
        &["tempco_ppm_per_k = 400", "rise_k = 15"],
        Some("sheet"),
    ),
    part("sheet", "sheet", &[], None),
    part("shunt", "shunt", &["nanofarad_per_m2 = 9"], Some("sheet")),
    part("sensor.inductance", "sensor.series_inductance_mh", &["series_inductance_mh = 0.1"], None),
    part("coupling", "coupling", &[], Some("sheet")),
    part(
        "sensor.others",
        "sensor.haptic_leakage_of_others",
        &["haptic_leakage_of_others = true"],
        Some("sensor.leakage"),
    ),
    part("carrier", "carrier", &["rung = \"samples\""], None),
    part("switching", "switching", &[], Some("sheet")),
    part("sensor.leakage", "sensor.haptic_leakage", &["haptic_leakage = true"], None),
    part("shunt.panel_noise", "shunt.panel_noise_mv", &["panel_noise_mv = 10"], Some("shunt")),
    part("sensor.bandwidth", "sensor.bandwidth_khz", &["bandwidth_khz = 900"], None),
    part("sensor.jitter", "sensor.jitter_ns_rms", &["jitter_ns_rms = 0.1"], None),
    part("sensor.crosstalk", "sensor.crosstalk_percent", &["crosstalk_percent = 0.1"], None),
    part("sensor.scale", "sensor.gain_error_percent", &["gain_error_percent = 1"], None),
    part("sensor.gain", "sensor.gain_mismatch_percent", &["gain_mismatch_percent = 1"], None),
    part(
        "sensor.noise_density",
        "sensor.noise_density_na_per_rthz",
        &["noise_density_na_per_rthz = 1"],
        None,
    ),
    part("sensor.offset", "sensor.offset_percent", &["offset_percent = 0.01"], None),
    part("sensor.noise", "sensor.noise_ppm_rms", &["noise_ppm_rms = 18"], None),
    part(
        "sensor.dither",
        "sensor.dither_lsb_rms",
        &["dither_lsb_rms = 0.5"],
        Some("sensor.quantisation"),
    ),
    part("sensor.quantisation", "sensor.quantisation_bits", &["quantisation_bits = 16"], None),
];

/// The carrier is how the device measures: it is there without its table, too.
pub fn optional() -> impl Iterator<Item = &'static Part> {
    PARTS.iter().filter(|part| part.name != "carrier")
}

impl Part {
    /// Whether it goes when `other` does.
    pub fn goes_with(&self, other: &str) -> bool {
        self.name == other || self.needs(other)
    }

    /// Whether `other` is what it needs, or what that needs.
    pub fn needs(&self, other: &str) -> bool {
        let needed = self.needs.and_then(|needed| PARTS.iter().find(|part| part.name == needed));
        needed.is_some_and(|needed| needed.goes_with(other))
    }

    /// The override that takes it away.
    pub fn off(&self) -> (String, String) {
        (self.key.to_string(), "false".to_string())
    }

    /// Its table.
    fn table(&self) -> &'static str {
        self.key.split('.').next().unwrap_or(self.key)
    }
}

/// Two pads, one of them dragged, and these effects.
pub fn scene_of(parts: &[&Part]) -> String {
    const PADS: &str = "duration_s = 0.1\n[[pad]]\nload_g = 50\n\
        haptic_v_rms = { timeline = [[0, 150], [0.0003, 150], [0.0003, 100]] }\n\
        position_mm = { line = { from_mm = [-100, -60], to_mm = [120, -60], period_s = 1 } }\n\
        [[pad]]\nposition_mm = [-200, 90]\nhaptic_v_rms = 300\n";
    let mut text = PADS.to_string();
    for (n, part) in parts.iter().enumerate() {
        let table = part.table();
        if parts[..n].iter().any(|other| other.table() == table) {
            continue;
        }
        writeln!(text, "[{table}]").unwrap();
        let mut lines: Vec<&str> = Vec::new();
        for line in parts.iter().filter(|part| part.table() == table).flat_map(|part| part.lines) {
            if !lines.contains(line) {
                lines.push(line);
            }
        }
        lines.iter().for_each(|line| writeln!(text, "{line}").unwrap());
    }
    if !parts.iter().any(|part| part.table() == "sensor") {
        text.push_str("[sensor]\n");
    }
    text
}
