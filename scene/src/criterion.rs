// SPDX-License-Identifier: MIT OR Apache-2.0
//! Criteria: what a scene claims; the program that runs the scene measures them.
//!
//! ```toml
//! [[criterion]]
//! name = "force spread over the sheet"
//! measure = "spread_percent"      # see `Measure`
//! of = "force_n"                  # see `Quantity`
//! limit = 0.1                     # the measure must be at most this
//! expected = 343                  # with max_off, mean_off, jump_off and departure_off: what it should be
//! departure_percent = 15          # with departure_off: how much more than by its law is a departure; 25
//! with = "load_g"                 # with increases_with and nonlinearity_percent
//! case = "rest"                   # or cases = ["a", "b"]; all cases where absent
//! per = "group"                   # case | group: taken over each, the worst counts
//! where = { haptic_v_rms = [50, 300], time_s = [0.5, 10] }   # only slots whose truth lies within
//! ```

use crate::error::SceneError;
use crate::format::{Limits, Table};
use crate::quantity::Quantity;

/// How much more than by its law a quantity must be, percent, where the scene does not say it.
const DEPARTURE_PERCENT: f64 = 25.0;

/// What a criterion measures over the slots that it covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Largest |estimate − truth|; for a position the distance.
    MaxAbsError,
    /// Root mean square of estimate − truth; for a position of the distance.
    RmsError,
    /// Mean of estimate − truth, by magnitude.
    MeanError,
    /// Largest |estimate − truth| in percent of the truth.
    MaxPercentError,
    /// (max − min)/mean of the estimate, percent.
    SpreadPercent,
    /// Smallest step, negated, between group means ordered by the truth of `with`, all else equal,
    /// in percent of the mean: below the limit (usually 0) where the estimate rises throughout.
    IncreasesWith,
    /// Largest departure of the estimate from the straight line that fits it best over the truth of
    /// `with`, all else equal, in percent of what the line spans.
    NonlinearityPercent,
    /// Largest sample of the ADC channels, percent of full scale.
    MaxPercentOfFullScale,
    /// Percent of finished slots whose result is flagged invalid.
    InvalidPercent,
    /// Largest |estimate − expected|; of what the plant alone knows, |truth − expected|.
    MaxOff,
    /// |mean of the estimate − expected|; of what the plant alone knows, of the truth.
    MeanOff,
    /// Root mean square of truth − target, of the force of a pad with a controller.
    RmsOffTarget,
    /// Largest truth − target, of the force of a pad with a controller: how far it overshoots.
    MaxAboveTarget,
    /// Largest target − truth, of the force of a pad with a controller.
    MaxBelowTarget,
    /// How far from the expected time the estimate jumps: where the mean of a pad's next seven slots
    /// rises most above that of the seven before, by five times its mean change at least.
    JumpOff,
    /// How far from the expected haptic voltage the estimate leaves its law at low voltages: where
    /// it first is `departure_percent` more than up to 100 V. A force goes with the square of the voltage, so
    /// that is per volt squared; any other quantity does not depend on it.
    DepartureOff,
}

const MEASURES: [(&str, Measure); 16] = [
    ("max_abs_error", Measure::MaxAbsError),
    ("rms_error", Measure::RmsError),
    ("mean_error", Measure::MeanError),
    ("max_percent_error", Measure::MaxPercentError),
    ("spread_percent", Measure::SpreadPercent),
    ("increases_with", Measure::IncreasesWith),
    ("nonlinearity_percent", Measure::NonlinearityPercent),
    ("max_percent_of_full_scale", Measure::MaxPercentOfFullScale),
    ("invalid_percent", Measure::InvalidPercent),
    ("max_off", Measure::MaxOff),
    ("mean_off", Measure::MeanOff),
    ("rms_off_target", Measure::RmsOffTarget),
    ("max_above_target", Measure::MaxAboveTarget),
    ("max_below_target", Measure::MaxBelowTarget),
    ("jump_off", Measure::JumpOff),
    ("departure_off", Measure::DepartureOff),
];

impl Measure {
    /// The measure's name in a scene: `spread_percent`.
    pub fn name(self) -> &'static str {
        name_of(&MEASURES, self)
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
        let measure = table.word("measure", &MEASURES)?;
        let measure = table.require("measure", "what is measured", measure)?;
        let of = table.require("of", "a quantity", quantity(table, "of")?)?;
        let with = quantity(table, "with")?;
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
        if !departs && table.get("departure_percent").is_some() {
            let message = "expected with measure = \"departure_off\", and only there";
            return Err(table.error("departure_percent", message));
        }
        let percents = Limits::above(0.0, 1e4);
        Ok(Criterion {
            departure_percent: table.number_or("departure_percent", percents, DEPARTURE_PERCENT)?,
            name: table.require("name", "text", table.text("name")?)?,
            measure,
            of,
            with,
            expected: read_expected(table, measure)?,
            cases: read_cases(table, cases)?,
            per: table
                .word("per", &[("case", Per::Case), ("group", Per::Group)])?
                .unwrap_or_default(),
            filters: read_filters(table)?,
            limit: table.require("limit", "a number", table.number("limit", Limits::ANY)?)?,
            unit: table.text("unit")?.unwrap_or_else(|| measure.unit(of).to_string()),
        })
    }

    /// Whether the criterion covers the case of this name.
    pub fn covers(&self, case: &str) -> bool {
        self.cases.is_empty() || self.cases.iter().any(|name| name == case)
    }
}

fn read_expected(table: &Table, measure: Measure) -> Result<Option<f64>, SceneError> {
    let expected = table.number("expected", Limits::ANY)?;
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
    let (key, names) = match table.text("case")? {
        Some(name) => ("case", vec![name]),
        None => ("cases", table.texts("cases")?.unwrap_or_default()),
    };
    match names.iter().find(|name| !known.contains(name)) {
        Some(name) => Err(table
            .error(key, format!("expected the name of a case, one of {known:?}, got {name:?}"))),
        None => Ok(names),
    }
}

fn read_filters(table: &Table) -> Result<Vec<Where>, SceneError> {
    let Some(ranges) = table.table("where")? else { return Ok(Vec::new()) };
    let read = |of: Quantity| -> Result<Option<Where>, SceneError> {
        let range = ranges.pair(of.name(), Limits::ANY)?;
        Ok(range.map(|[low, high]| Where { of, low, high }))
    };
    Quantity::all().filter(|of| of.is_scalar()).filter_map(|of| read(of).transpose()).collect()
}

/// The quantity that `key` names.
fn quantity(table: &Table, key: &'static str) -> Result<Option<Quantity>, SceneError> {
    let names: Vec<_> = Quantity::all().map(Quantity::name).collect();
    Ok(table.choice(key, &names)?.and_then(Quantity::named))
}

fn name_of<T: Copy + PartialEq>(words: &[(&'static str, T)], value: T) -> &'static str {
    words.iter().find(|(_, word)| *word == value).map_or("", |(name, _)| name)
}
