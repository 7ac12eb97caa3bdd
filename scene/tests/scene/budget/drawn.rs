// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes drawn by a seed: pads, places, loads, voltages over time, effects.

use std::fmt::Write;

use hapticore_scene::Scene;

/// The effects that have levels, and the finest level of each.
const FINEST: [(&str, &str); 6] = [
    ("sheet", "analytic"),
    ("shunt", "series"),
    ("coupling", "full"),
    ("switching", "settling"),
    ("gap", "tr-bdf2"),
    ("carrier", "samples"),
];

/// The finest level of a film that is not uniform.
const FINEST_GRID: &str = "grid-1.25-mm";

/// Numbers drawn by a seed (splitmix64).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.next() as usize % list.len()]
    }
}

/// A scene without its levels.
pub struct Drawn {
    /// Seed, for messages.
    pub seed: u64,
    pub budget_percent: f64,
    head: String,
    /// Name and keys of each effect's table.
    tables: Vec<(&'static str, String)>,
    /// Effects whose level the scene names, and the level.
    named: Vec<(&'static str, &'static str)>,
}

impl Drawn {
    pub fn new(seed: u64) -> Drawn {
        let mut draw = Draw(seed);
        let budget_percent = 0.01 * 500f64.powf(draw.unit());
        let pads = draw.of(&[1, 1, 2, 3, 4]);
        let tables = tables(&mut draw, pads);
        let has = |name| tables.iter().any(|(table, _)| *table == name);
        let moves = draw.chance(0.8);
        let mut head = match moves {
            true => format!("duration_s = {:.3}\n", draw.within(0.15, 0.6)),
            false => format!("dwell_slots = {}\n", draw.of(&[1, 2, 4])),
        };
        (0..pads).for_each(|_| head += &pad(&mut draw, moves, has("gap")));
        let mut named = Vec::new();
        if draw.chance(0.7) {
            named.push(("carrier", "phasor"));
        }
        if has("friction") && draw.chance(0.5) {
            named.push(("friction", "lugre"));
        }
        if has("gap") && draw.chance(0.3) {
            named.push(("gap", "static"));
        }
        Drawn { seed, budget_percent, head, tables, named }
    }

    pub fn effects(&self) -> impl Iterator<Item = &'static str> {
        self.tables.iter().map(|(name, _)| *name)
    }

    fn keys(&self, name: &str) -> &str {
        self.tables.iter().find(|(table, _)| *table == name).map_or("", |(_, keys)| keys)
    }

    /// The levels of an effect here that approximate its finest one, coarsest first.
    pub fn levels(&self, effect: &str) -> &'static [&'static str] {
        match effect {
            "sheet" if self.is_uneven() => &["grid-20-mm", "grid-10-mm", "grid-5-mm"],
            "sheet" => &["distance", "bilinear", "bicubic", "bicubic-fine"],
            "shunt" => &["table"],
            "coupling" => &["once"],
            "switching" => &["rc-1", "rc-4", "rc-8"],
            "gap" => &["quasi-static", "semi-implicit", "implicit-euler", "trapezoid"],
            "carrier" => &["phasor"],
            _ => &[],
        }
    }

    fn is_uneven(&self) -> bool {
        self.keys("sheet").contains("slope")
    }

    fn finest_level(&self, effect: &str) -> Option<&'static str> {
        if effect == "sheet" && self.is_uneven() {
            return Some(FINEST_GRID);
        }
        FINEST.iter().find(|(name, _)| *name == effect).map(|(_, level)| *level)
    }

    /// With its budget, levels open but for those it names.
    pub fn within_budget(&self) -> Scene {
        self.scene(&format!("error_budget_percent = {}\n", self.budget_percent), |_| None)
    }

    /// Every level that is open at its finest.
    pub fn finest(&self) -> Scene {
        self.scene("", |effect| self.finest_level(effect))
    }

    /// An effect at a level, all others as they are without a budget.
    pub fn at(&self, effect: &str, level: &'static str) -> Scene {
        self.scene("", |name| (name == effect).then_some(level))
    }

    /// An effect at its finest level, all others as they are without a budget.
    pub fn finest_of(&self, effect: &str) -> Scene {
        self.scene("", |name| (name == effect).then(|| self.finest_level(name)).flatten())
    }

    fn scene(&self, head: &str, level: impl Fn(&str) -> Option<&'static str>) -> Scene {
        let text = self.text(head, level);
        Scene::parse(&text, "drawn.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    fn text(&self, head: &str, level: impl Fn(&str) -> Option<&'static str>) -> String {
        let mut text = format!("title = \"t\"\n{head}{}", self.head);
        for (name, keys) in &self.tables {
            let named = self.named.iter().find(|(known, _)| known == name).map(|(_, word)| *word);
            let rung = level(name).filter(|_| head.is_empty() && named.is_none()).or(named);
            // An open gap is the moving one.
            let rung = rung.or((*name == "gap").then_some("moving"));
            let rung = rung.map_or(String::new(), |word| format!("rung = {word:?}\n"));
            write!(text, "[{name}]\n{rung}{keys}").expect("a String takes everything");
        }
        text
    }

    /// Whether the scene names the effect's level itself.
    pub fn names(&self, effect: &str) -> bool {
        self.named.iter().any(|(name, _)| *name == effect)
    }
}

/// The tables of the effects, `[sheet]` first and `[carrier]` last.
fn tables(draw: &mut Draw, pads: usize) -> Vec<(&'static str, String)> {
    let uneven = draw.chance(0.08);
    let mut sheet = format!("terminals = {}\n", draw.of(&[4, 6, 6]));
    if draw.chance(0.3) {
        sheet += &format!("terminal_ohm = {:.0}\n", draw.within(50.0, 1500.0));
    }
    if uneven {
        sheet += &format!(
            "slope_percent = [{:.1}, {:.1}]\n",
            draw.within(-15.0, 15.0),
            draw.within(-15.0, 15.0)
        );
    }
    let gap = draw.chance(0.6);
    let mut tables = vec![("sheet", sheet)];
    let mut add = |present: bool, name, keys: String| {
        if present {
            tables.push((name, keys));
        }
    };
    add(
        draw.chance(0.15) && !uneven,
        "shunt",
        format!("nanofarad_per_m2 = {:.1}\n", draw.within(2.0, 22.0)),
    );
    add(draw.chance(0.6) && pads > 1, "coupling", String::new());
    add(draw.chance(0.3), "switching", String::new());
    add(draw.chance(0.4), "supply", format!("limiting_kohm = {:.0}\n", draw.within(50.0, 400.0)));
    add(gap, "gap", String::new());
    let friction = gap && draw.chance(0.5);
    add(friction, "friction", String::new());
    add(friction && draw.chance(0.3), "hand", String::new());
    let rise_k = draw.within(-20.0, 20.0);
    add(
        draw.chance(0.1) && !uneven,
        "temperature",
        format!("tempco_ppm_per_k = 400\nrise_k = {rise_k:.1}\n"),
    );
    let gain = draw.within(0.1, 2.0);
    add(draw.chance(0.3), "sensor", format!("gain_mismatch_percent = {gain:.2}\n"));
    add(true, "carrier", String::new());
    tables
}

fn pad(draw: &mut Draw, moves: bool, gap: bool) -> String {
    let place = match moves {
        true => path(draw),
        false => format!(
            "{{ raster = {{ nx = {}, ny = {}, margin_mm = {:.0} }} }}",
            draw.of(&[5, 9, 13]),
            draw.of(&[4, 5, 7]),
            draw.within(15.0, 60.0)
        ),
    };
    let capacitance = match gap {
        true => String::new(),
        false => format!("capacitance_pf = {:.0}\n", draw.within(250.0, 760.0)),
    };
    let volt = if moves { voltage(draw) } else { format!("{:.0}", draw.within(50.0, 350.0)) };
    let load = draw.within(20.0, 100.0);
    format!(
        "[[pad]]\nposition_mm = {place}\nload_g = {load:.1}\nhaptic_v_rms = {volt}\n{capacitance}"
    )
}

fn path(draw: &mut Draw) -> String {
    let mut place = || [draw.within(-410.0, 410.0), draw.within(-230.0, 230.0)];
    let [[ax, ay], [bx, by]] = [place(), place()];
    let period_s = draw.within(0.3, 2.0);
    match draw.of(&[0, 1, 1, 2]) {
        0 => format!("[{ax:.1}, {ay:.1}]"),
        1 => format!(
            "{{ line = {{ from_mm = [{ax:.1}, {ay:.1}], to_mm = [{bx:.1}, {by:.1}], period_s = {period_s:.3} }} }}"
        ),
        _ => format!(
            "{{ lissajous = {{ centre_mm = [{:.1}, {:.1}], amplitude_mm = [{:.1}, {:.1}], frequency_hz = [{:.3}, {:.3}] }} }}",
            0.3 * ax,
            0.3 * ay,
            draw.within(10.0, 285.0),
            draw.within(10.0, 155.0),
            1.0 / period_s,
            draw.within(0.5, 4.0)
        ),
    }
}

/// A haptic voltage: steady, swinging, or in steps and ramps.
fn voltage(draw: &mut Draw) -> String {
    let high = draw.within(100.0, 350.0);
    match draw.of(&[0, 1, 2, 2]) {
        0 => format!("{high:.0}"),
        1 => format!(
            "{{ sine = {{ mean = {:.0}, amplitude = {:.0}, frequency_hz = {:.2} }} }}",
            0.5 * high,
            0.45 * high,
            draw.within(1.0, 10.0)
        ),
        _ => {
            let [a, b, c] = [draw.within(0.0, 0.1), draw.within(0.12, 0.2), draw.within(0.22, 0.3)];
            format!(
                "{{ timeline = [[0, 0], [{a:.4}, 0], [{a:.4}, {high:.0}], [{b:.4}, {high:.0}], [{c:.4}, 0]] }}"
            )
        }
    }
}
