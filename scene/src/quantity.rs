// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quantities of a slot: what a frame estimates of a pad, and what the plant alone knows. This is
//! the one list of them; names in scenes, columns of tables, units and truths all come from it.

use crate::format::Word;
use crate::truth::Truth;

/// Who knows a quantity.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The clock: it is the same for estimate and truth.
    Clock,
    /// A frame estimates it, and the plant knows it.
    Frame,
    /// The plant alone.
    Plant,
    /// The scene, which sets it.
    Scene,
    /// Two others, taken as a vector.
    Pair,
    /// The host's game, where the scene has an arena: it is the same for estimate and truth.
    Game,
}

/// Name, unit, source and truth of a quantity.
struct Entry {
    quantity: Quantity,
    name: &'static str,
    unit: &'static str,
    says: &'static str,
    source: Source,
    truth: fn(&Truth) -> f64,
}

/// Declares the quantities, in the order of the columns of a table of frames.
macro_rules! quantities {
    ($($(#[doc = $doc:literal])+ $variant:ident: $name:literal, $unit:literal, $source:ident, $truth:expr;)+) => {
        /// A quantity that a frame estimates, or that the plant alone knows.
        ///
        /// ```
        /// use hapticore_scene::Quantity;
        ///
        /// assert_eq!((Quantity::ForceN.name(), Quantity::ForceN.unit()), ("force_n", "N"));
        /// assert_eq!(Quantity::named("sheet_ohm"), Some(Quantity::SheetOhm));
        /// let columns: Vec<_> = Quantity::measured().map(Quantity::name).collect();
        /// assert_eq!(columns[..4], ["r_x", "r_y", "x_mm", "y_mm"]);
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Quantity {
            $($(#[doc = $doc])+ $variant,)+
        }

        /// One entry per quantity, in the order of the variants.
        const ENTRIES: &[Entry] = &[$(Entry {
            quantity: Quantity::$variant,
            name: $name,
            unit: $unit,
            says: concat!($($doc),+),
            source: Source::$source,
            truth: $truth,
        },)+];

        impl Word for Quantity {
            const WORDS: &[(&str, Quantity)] = &[$(($name, Quantity::$variant),)+];
        }
    };
}

quantities! {
    /// Time since the start of the case, s.
    TimeS: "time_s", "s", Clock, |truth| truth.time_s;
    /// Ratio of the currents along x, eq. 2.
    RX: "r_x", "1", Frame, |truth| truth.r_x;
    /// Ratio of the currents along y, eq. 3.
    RY: "r_y", "1", Frame, |truth| truth.r_y;
    /// Position along x, mm right of the sheet's centre.
    XMm: "x_mm", "mm", Frame, |truth| truth.x_mm;
    /// Position along y, mm above the sheet's centre.
    YMm: "y_mm", "mm", Frame, |truth| truth.y_mm;
    /// Position along x and y as a vector: it has no column and no single value.
    PositionMm: "position_mm", "mm", Pair, |_| f64::NAN;
    /// Capacitance between pad and sheet, pF.
    CapacitancePf: "capacitance_pf", "pF", Frame, |truth| truth.capacitance_pf;
    /// Resistance R_p of the sheet at the pad, Ω.
    SheetOhm: "sheet_ohm", "Ω", Frame, |truth| truth.sheet_ohm;
    /// Haptic voltage at the pad, V rms.
    HapticVRms: "haptic_v_rms", "V", Frame, |truth| truth.haptic_v_rms;
    /// Haptic force, N.
    ForceN: "force_n", "N", Frame, |truth| truth.force_n;
    /// Direction of the push, eq. 10.
    Direction: "direction", "1", Frame, |truth| truth.direction;
    /// Load on the pad, g; known to the plant alone.
    LoadG: "load_g", "g", Plant, |truth| truth.load_g;
    /// Friction that acts on the pad, N; known to the plant alone.
    FrictionN: "friction_n", "N", Plant, |truth| truth.friction_n;
    /// What of the friction that acts is the haptic force's, N; known to the plant alone.
    HapticFrictionN: "haptic_friction_n", "N", Plant, |truth| truth.haptic_friction_n;
    /// Force of the hand along x, N; known to the plant alone.
    HandXN: "hand_x_n", "N", Plant, |truth| truth.hand_n[0];
    /// Eccentricity of the push, mm.
    EccentricityMm: "eccentricity_mm", "mm", Scene, |truth| truth.set.eccentricity_mm;
    /// The part of a split pad that the slot serves, from 0.
    Part: "part", "1", Scene, |truth| truth.part as f64;
    /// Where the puck of an arena is, mm right of the sheet's centre.
    PuckXMm: "puck_x_mm", "mm", Game, |_| f64::NAN;
    /// The same above the sheet's centre, mm.
    PuckYMm: "puck_y_mm", "mm", Game, |_| f64::NAN;
    /// Speed of the puck, mm/s.
    PuckMmS: "puck_mm_s", "mm/s", Game, |_| f64::NAN;
    /// Force of impacts on the slot's pad, N.
    ImpactN: "impact_n", "N", Game, |_| f64::NAN;
    /// Goals of the left player.
    ScoreLeft: "score_left", "1", Game, |_| f64::NAN;
    /// Goals of the right player.
    ScoreRight: "score_right", "1", Game, |_| f64::NAN;
}

impl Quantity {
    /// Every quantity, those of a frame in the order of its columns.
    pub fn all() -> impl Iterator<Item = Quantity> {
        ENTRIES.iter().map(|entry| entry.quantity)
    }

    /// The quantities that a frame estimates, in the order of its columns.
    pub fn measured() -> impl Iterator<Item = Quantity> {
        Quantity::all().filter(|quantity| quantity.is_measured())
    }

    /// The quantity of this name.
    pub fn named(name: &str) -> Option<Quantity> {
        Quantity::all().find(|quantity| quantity.name() == name)
    }

    /// The quantity's name, which is its key in a scene and its column in a table of frames:
    /// `force_n`.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Its unit: `N`; `1` for a ratio.
    pub fn unit(self) -> &'static str {
        self.entry().unit
    }

    /// What it is, in a sentence.
    pub fn says(self) -> &'static str {
        self.entry().says.trim()
    }

    /// Who knows it: `frame` what a frame estimates and the plant knows, `plant` what the plant alone knows, `scene` what
    /// the scene sets, `game` what the host's game knows, `clock` the time.
    pub fn source(self) -> &'static str {
        match self.entry().source {
            Source::Clock => "clock",
            Source::Frame | Source::Pair => "frame",
            Source::Plant => "plant",
            Source::Scene => "scene",
            Source::Game => "game",
        }
    }

    /// Whether a frame estimates it.
    pub fn is_measured(self) -> bool {
        self.entry().source == Source::Frame
    }

    /// Whether it is a single number: a position is two.
    pub fn is_scalar(self) -> bool {
        self.entry().source != Source::Pair
    }

    /// The column of its truth in a table of frames, `true_force_n`; none where the truth is no
    /// column of its own.
    pub fn true_column(self) -> Option<String> {
        let has_column = matches!(self.entry().source, Source::Frame | Source::Plant);
        has_column.then(|| format!("true_{}", self.name()))
    }

    /// Its value in a slot, in its unit; not a number for a position.
    pub fn true_value(self, truth: &Truth) -> f64 {
        (self.entry().truth)(truth)
    }

    fn entry(self) -> &'static Entry {
        &ENTRIES[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_stands_once_and_finds_its_quantity() {
        for quantity in Quantity::all() {
            assert_eq!(Quantity::named(quantity.name()), Some(quantity));
        }
        assert_eq!(Quantity::named("force"), None);
    }

    /// A name ends with its unit, but for those without one: a column says what it is in.
    #[test]
    fn names_end_with_their_units() {
        let spelt = [
            ("Ω", "_ohm"),
            ("V", "_v_rms"),
            ("pF", "_pf"),
            ("N", "_n"),
            ("mm", "_mm"),
            ("g", "_g"),
            ("mm/s", "_mm_s"),
            ("s", "_s"),
        ];
        for quantity in Quantity::all().filter(|quantity| quantity.unit() != "1") {
            let (_, ending) =
                spelt.iter().find(|(unit, _)| *unit == quantity.unit()).expect("a known unit");
            assert!(quantity.name().ends_with(ending), "{quantity:?}");
        }
    }

    #[test]
    fn only_a_position_is_no_number() {
        let vectors: Vec<_> = Quantity::all().filter(|quantity| !quantity.is_scalar()).collect();
        assert_eq!(vectors, [Quantity::PositionMm]);
        assert_eq!(Quantity::PositionMm.true_column(), None);
        assert_eq!(Quantity::LoadG.true_column().as_deref(), Some("true_load_g"));
    }
}
