// SPDX-License-Identifier: MIT OR Apache-2.0
//! Criteria: what a scene claims; the program that runs the scene measures them.

use crate::error::SceneError;
use crate::format::{Key, Limits, Table, Word, keys};
use crate::quantity::Quantity;

keys! { KEYS:
    /// What the criterion says, for people.
    NAME: String = Key::text("name").required("text");
    /// What is measured over the slots that the criterion covers.
    MEASURE: Measure = Key::words("measure").required("what is measured");
    /// The quantity that is measured.
    OF: Quantity = Key::words("of").required("a quantity");
    /// The measure must be at most this.
    LIMIT: f64 = Key::number("limit", Limits::ANY).required("a number");
    /// What it should be, with `max_off`, `mean_off`, `jump_off` and `departure_off`: a value, a time or a haptic voltage.
    EXPECTED: Option<f64> = Key::number("expected", Limits::ANY);
    /// With `departure_off`, how much more than by its law is a departure.
    DEPARTURE: f64 = Key::number("departure_percent", Limits::above(0.0, 1e4)).or(25.0);
    /// The other quantity of `increases_with` and `nonlinearity_percent`.
    WITH: Option<Quantity> = Key::words("with");
    /// The case that the criterion covers.
    CASE: Option<String> = Key::text("case").usually("all cases");
    /// The cases that the criterion covers, in place of `case`.
    CASES: Option<Vec<String>> = Key::texts("cases").usually("all cases");
    /// Over what the measure is taken before the worst counts: each case, or each group of a sweep.
    PER: Per = Key::words("per").or_word("case");
    /// Ranges that the truth of quantities must lie in for a slot to count: `{ haptic_v_rms = [50, 300] }`.
    WHERE: () = Key::ranges("where");
    /// Unit of the limit and of what is measured.
    UNIT: Option<String> = Key::text("unit").usually("that of the measure");
}

/// Declares the measures, each by its name in a scene.
macro_rules! measures {
    ($($(#[doc = $doc:literal])+ $measure:ident: $name:literal;)+) => {
        /// What a criterion measures over the slots that it covers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Measure {
            $($(#[doc = $doc])+ $measure,)+
        }

        impl Word for Measure {
            const WORDS: &[(&str, Measure)] = &[$(($name, Measure::$measure),)+];
        }

        impl Measure {
            /// What it is, in a sentence.
            pub fn says(self) -> &'static str {
                match self {
                    $(Measure::$measure => concat!($($doc),+).trim_ascii(),)+
                }
            }
        }
    };
}

measures! {
    /// Largest |estimate − truth|; for a position the distance.
    MaxAbsError: "max_abs_error";
    /// Root mean square of estimate − truth; for a position of the distance.
    RmsError: "rms_error";
    /// Mean of estimate − truth, by magnitude.
    MeanError: "mean_error";
    /// Largest |estimate − truth| in percent of the truth.
    MaxPercentError: "max_percent_error";
    /// (max − min)/mean of the estimate, percent.
    SpreadPercent: "spread_percent";
    /// Smallest step, negated, between group means ordered by the truth of `with`, all else equal,
    /// in percent of the mean: below the limit (usually 0) where the estimate rises throughout.
    IncreasesWith: "increases_with";
    /// Largest departure of the estimate from the best straight line over the truth of `with`, all else equal, in percent
    /// of the line's span.
    NonlinearityPercent: "nonlinearity_percent";
    /// Largest sample of the ADC channels, percent of full scale.
    MaxPercentOfFullScale: "max_percent_of_full_scale";
    /// Percent of finished slots whose result is flagged invalid.
    InvalidPercent: "invalid_percent";
    /// Largest |estimate − expected|; of what the plant alone knows, |truth − expected|.
    MaxOff: "max_off";
    /// |mean of the estimate − expected|; of what the plant alone knows, of the truth.
    MeanOff: "mean_off";
    /// Root mean square of truth − target, of the force of a pad with a controller.
    RmsOffTarget: "rms_off_target";
    /// Largest truth − target, of the force of a pad with a controller: how far it overshoots.
    MaxAboveTarget: "max_above_target";
    /// Largest target − truth, of the force of a pad with a controller.
    MaxBelowTarget: "max_below_target";
    /// How far from the expected time the estimate jumps: where the mean of a pad's next seven slots
    /// rises most above that of the seven before, by five times its mean change at least.
    JumpOff: "jump_off";
    /// How far from the expected haptic voltage the estimate leaves its law at low voltages: where
    /// it first is `departure_percent` more than up to 100 V. A force goes with the square of the voltage, so
    /// that is per volt squared; any other quantity does not depend on it.
    DepartureOff: "departure_off";
}

impl Measure {
    /// Every measure.
    pub fn all() -> impl Iterator<Item = Measure> {
        Measure::WORDS.iter().map(|(_, measure)| *measure)
    }

    /// The measure's name in a scene: `spread_percent`.
    pub fn name(self) -> &'static str {
        self.word()
    }

    fn is_of_target(self) -> bool {
        matches!(self, Measure::RmsOffTarget | Measure::MaxAboveTarget | Measure::MaxBelowTarget)
    }

    /// Unit of the measured value.
    ///
    /// ```
    /// use hapticore_scene::{Measure, Quantity};
    ///
    /// assert_eq!(Measure::RmsError.unit(Quantity::ForceN), "N");
    /// assert_eq!(Measure::SpreadPercent.unit(Quantity::ForceN), "%");
    /// assert_eq!(Measure::JumpOff.unit(Quantity::ForceN), "s");
    /// ```
    pub fn unit(self, of: Quantity) -> &'static str {
        match self {
            Measure::MaxAbsError
            | Measure::RmsError
            | Measure::MeanError
            | Measure::MaxOff
            | Measure::MeanOff
            | Measure::RmsOffTarget
            | Measure::MaxAboveTarget
            | Measure::MaxBelowTarget => of.unit(),
            Measure::JumpOff => Quantity::TimeS.unit(),
            Measure::DepartureOff => Quantity::HapticVRms.unit(),
            _ => "%",
        }
    }
}

/// Over what a measure is taken before the worst counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Per {
    /// Over all slots of each case.
    #[default]
    Case,
    /// Over the slots of each group of a sweep: equal load, voltage and capacitance.
    Group,
}

impl Word for Per {
    const WORDS: &[(&str, Per)] = &[("case", Per::Case), ("group", Per::Group)];
}

/// A range that the truth of a quantity must lie in for a slot to count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Where {
    /// The quantity; a position is not one.
    pub of: Quantity,
    /// Least value, included.
    pub low: f64,
    /// Greatest value, included.
    pub high: f64,
}

/// One claim of a scene: the measure, over the slots it covers, is at most the limit.
///
/// ```
/// use hapticore_scene::{Measure, Quantity, Scene};
///
/// let text = r#"
///     title = "t"
///     [[pad]]
///     position_mm = [0, 0]
///     [[criterion]]
///     name = "position"
///     measure = "rms_error"
///     of = "position_mm"
///     limit = 1.0
///     where = { haptic_v_rms = [50, 300] }
/// "#;
/// let criterion = &Scene::parse(text, "t.toml", &[])?.criteria[0];
/// assert_eq!((criterion.measure, criterion.of, criterion.unit.as_str()), (Measure::RmsError, Quantity::PositionMm, "mm"));
/// assert_eq!((criterion.filters[0].of, criterion.filters[0].high), (Quantity::HapticVRms, 300.0));
/// assert!(criterion.covers("main"));
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Criterion {
    /// What it says, for people.
    pub name: String,
    /// How the quantity is measured over the slots.
    pub measure: Measure,
    /// The quantity that the measure applies to.
    pub of: Quantity,
    /// For [`Measure::IncreasesWith`] and [`Measure::NonlinearityPercent`]: with which.
    pub with: Option<Quantity>,
    /// For [`Measure::MaxOff`], [`Measure::MeanOff`], [`Measure::JumpOff`] and [`Measure::DepartureOff`]: the value, the
    /// time, s, or the haptic voltage, V rms, that is expected.
    pub expected: Option<f64>,
    /// For [`Measure::DepartureOff`]: how much more than by its law is a departure, percent.
    pub departure_percent: f64,
    /// Names of the cases it covers; all where empty.
    pub cases: Vec<String>,
    /// Over what the measure is taken.
    pub per: Per,
    /// All must hold for a slot to count.
    pub filters: Vec<Where>,
    /// Greatest value that passes.
    pub limit: f64,
    /// Unit of the limit and of the measured value.
    pub unit: String,
}

impl Criterion {
    pub(crate) fn read(table: &Table, cases: &[String]) -> Result<Criterion, SceneError> {
        let measure = table.get(&MEASURE)?;
        let of = table.get(&OF)?;
        let with = table.get(&WITH)?;
        let lines = matches!(measure, Measure::IncreasesWith | Measure::NonlinearityPercent);
        if with.is_some() != lines {
            let measures = "\"increases_with\" or \"nonlinearity_percent\"";
            let expected = format!("expected with measure = {measures}, and only there");
            return Err(table.error("with", expected));
        }
        if measure.is_of_target() && of != Quantity::ForceN {
            let message = format!("expected \"force_n\" with measure = {:?}", measure.name());
            return Err(table.error("of", message));
        }
        let departs = measure == Measure::DepartureOff;
        if !departs && table.has(&DEPARTURE) {
            let message = "expected with measure = \"departure_off\", and only there";
            return Err(table.error("departure_percent", message));
        }
        Ok(Criterion {
            departure_percent: table.get(&DEPARTURE)?,
            name: table.get(&NAME)?,
            measure,
            of,
            with,
            expected: read_expected(table, measure)?,
            cases: read_cases(table, cases)?,
            per: table.get(&PER)?,
            filters: read_filters(table)?,
            limit: table.get(&LIMIT)?,
            unit: table.get(&UNIT)?.unwrap_or_else(|| measure.unit(of).to_string()),
        })
    }

    /// Whether the criterion covers the case of this name.
    pub fn covers(&self, case: &str) -> bool {
        self.cases.is_empty() || self.cases.iter().any(|name| name == case)
    }
}

fn read_expected(table: &Table, measure: Measure) -> Result<Option<f64>, SceneError> {
    let expected = table.get(&EXPECTED)?;
    if expected.is_some()
        == matches!(
            measure,
            Measure::MaxOff | Measure::MeanOff | Measure::JumpOff | Measure::DepartureOff
        )
    {
        return Ok(expected);
    }
    let with = "\"max_off\", \"mean_off\", \"jump_off\" or \"departure_off\"";
    Err(table.error("expected", format!("expected with measure = {with}, and only there")))
}

fn read_cases(table: &Table, known: &[String]) -> Result<Vec<String>, SceneError> {
    let (key, names) = match table.get(&CASE)? {
        Some(name) => ("case", vec![name]),
        None => ("cases", table.get(&CASES)?.unwrap_or_default()),
    };
    match names.iter().find(|name| !known.contains(name)) {
        Some(name) => Err(table
            .error(key, format!("expected the name of a case, one of {known:?}, got {name:?}"))),
        None => Ok(names),
    }
}

fn read_filters(table: &Table) -> Result<Vec<Where>, SceneError> {
    let Some(ranges) = table.table(WHERE.about.name)? else { return Ok(Vec::new()) };
    let read = |of: Quantity| -> Result<Option<Where>, SceneError> {
        let range = ranges.pair(of.name(), Limits::ANY)?;
        Ok(range.map(|[low, high]| Where { of, low, high }))
    };
    Quantity::all().filter(|of| of.is_scalar()).filter_map(|of| read(of).transpose()).collect()
}
