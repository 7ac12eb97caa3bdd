// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[temperature]`: the sheet's film and the pads' rubber are warmer than they were when the device
//! was calibrated: the film resists more, or less, and the rubber is stiffer, or softer.
//!
//!   R_s(x, y) = R_s·[1 + α·(ΔT + g_x·x/width + g_y·y/height)]      (x and y from the sheet's middle)
//!   κ = κ·(1 + β·ΔT)
//!
//! Either α or β is there, or both; an effect that is not named is not there.
//!
//! Split, R_p, shunt and coupling follow, and so does the truth; calibrations and what the host
//! knows are of the film without the rise. Resistances in series with the terminals stay as they
//! are. Without any an even rise moves no position. With 500 Ω at each terminal, 20 K of 400 ppm/K
//! move positions by 3.9 mm rms, with 1670 Ω by 5.2 mm. A gradient of 20 K from left to right moves
//! positions by 4.0 mm rms (`minimal-sheet`).
//!
//! α is a property of the film that somebody has to measure, so it has no default: films differ
//! even in its sign. ITO that was sputtered with a dc magnetron has +123 to +868 ppm/K between 150
//! K and 250 K, less the more oxygen there was (I. Prasaja, thesis, Universitas Indonesia, 1999);
//! thermometers of ITO on alumina have −2313 ppm/K from room temperature to 400 °C (Wang, Zhang and
//! Ding, IEEE INEC 2016).
//!
//! β has no default either. An ideal rubber's is 0.34 %/K at 20 °C, since its stiffness goes with the
//! absolute temperature (Treloar, The Physics of Rubber Elasticity, 1975); filled ones soften as they
//! warm. The gap follows ΔT itself, not its steps, and pads are as warm as the sheet's middle.
//!
//! A step of ΔT is a step of α·`step_k` in R_s, 20 ppm at 400 ppm/K: the film deviates by at most
//! half of that. With a gradient the film is not uniform, so that `[sheet]` needs a level of a
//! mesh, and no `[shunt]`. Every step builds the sheet's table anew.

use super::effect::{Effect, PadEffect};
use super::pad::{FilmChange, Pad};
use super::spec::Spec;
use crate::device::Device;
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};
use crate::stimulus::{Moment, Stimulus};

keys! { KEYS:
    /// Temperature coefficient α of the film's resistance.
    TEMPCO_PPM_PER_K: Option<f64> = Key::number("tempco_ppm_per_k", Limits::within(-1e5, 1e5));
    /// How much warmer than at the calibration the sheet's middle is.
    RISE_K: Option<Stimulus> = Key::over_time("rise_k", Limits::within(-1e3, 1e3)).usually("0");
    /// Difference of temperature from the left edge to the right one and from the bottom to the top; with
    /// `tempco_ppm_per_k`.
    GRADIENT_K: [f64; 2] = Key::pair("gradient_k", Limits::within(-1e3, 1e3)).or(&[0.0; 2]);
    /// Temperature coefficient β of the springs in `[gap]`.
    SPRING_PERCENT_PER_K: Option<f64> = Key::number("spring_percent_per_k", Limits::within(-100.0, 100.0));
    /// Step of `rise_k`, where it moves, at which what is computed from the sheet is renewed.
    STEP_K: f64 = Key::number("step_k", Limits::within(1e-6, 100.0)).or(0.05);
}

/// The most that a film may change, as a share of its resistance: what is left is positive.
const MOST_CHANGE: f64 = 0.9;

/// Reads what becomes of the rubber.
pub(super) fn read_spring(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(spring) = Spring::read(root)? else { return Ok(None) };
    let label = format!("{} %/K", 100.0 * spring.per_k);
    Ok(Spec::new("temperature.spring", label, move |_| Effect::Pad(Box::new(spring.clone()))))
}

/// How stiff the rubber gets, by how stiff it is at the calibration; none where its temperature does
/// nothing.
pub(super) fn stiffest(root: &Table) -> Result<Option<f64>, SceneError> {
    let stiffness = |spring: Spring| spring.stiffness().into_iter().fold(1.0, f64::max);
    Ok(Spring::read(root)?.map(stiffness))
}

/// Reads what becomes of the film.
pub(super) fn read(root: &Table, _: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("temperature")? else { return Ok(None) };
    let of_rubber = table.has(&SPRING_PERCENT_PER_K);
    if of_rubber && !table.has(&TEMPCO_PPM_PER_K) {
        return Ok(None);
    }
    let Some(sheet) = root.table("sheet")? else {
        return Err(table
            .error("", "expected a [sheet] too, since its film is what the temperature changes"));
    };
    let temperature = Temperature::read(table)?;
    if temperature.gradient_k != [0.0; 2] {
        let meshed = sheet.text("rung")?.is_some_and(|level| level.starts_with("grid"));
        if !meshed || root.table("shunt")?.is_some() {
            let expected = "expected a mesh as sheet.rung, such as \"grid-5-mm\", and no [shunt]";
            return Err(table
                .error("gradient_k", format!("{expected}, since a gradient leaves no film even")));
        }
    }
    let label = temperature.label();
    Ok(Spec::new("temperature", label, move |_| Effect::Pad(Box::new(temperature.clone()))))
}

/// ΔT in the middle.
fn read_rise(table: &Table) -> Result<Stimulus, SceneError> {
    let rise_k = table.get(&RISE_K)?.unwrap_or(Stimulus::Constant(0.0));
    match rise_k.points() {
        1 => Ok(rise_k),
        _ => Err(table.error(
            "rise_k",
            "expected a temperature over time, not a sweep; a case can set another",
        )),
    }
}

/// The rubber's temperature above that of the calibration, and what it does.
#[derive(Clone, Debug)]
struct Spring {
    per_k: f64,
    rise_k: Stimulus,
}

impl Spring {
    fn read(root: &Table) -> Result<Option<Spring>, SceneError> {
        let Some(table) = root.table("temperature")? else { return Ok(None) };
        let percent = table.get(&SPRING_PERCENT_PER_K)?;
        let Some(percent) = percent else { return Ok(None) };
        if root.table("gap")?.is_none() {
            let message =
                "expected a [gap] too, since its springs are what the temperature changes";
            return Err(table.error("spring_percent_per_k", message));
        }
        let spring = Spring { per_k: 0.01 * percent, rise_k: read_rise(table)? };
        match spring.stiffness().into_iter().find(|stiffness| *stiffness < 1.0 - MOST_CHANGE) {
            None => Ok(Some(spring)),
            Some(stiffness) => {
                let expected =
                    format!("expected springs that lose at most {MOST_CHANGE} of themselves");
                let lost = 1.0 - stiffness;
                Err(table.error("spring_percent_per_k", format!("{expected}, got {lost}")))
            }
        }
    }

    /// Values between which the stiffness lies.
    fn stiffness(&self) -> Vec<f64> {
        self.rise_k.extremes().into_iter().map(|rise_k| 1.0 + self.per_k * rise_k).collect()
    }
}

impl PadEffect for Spring {
    fn act(&mut self, pad: &mut Pad) {
        pad.stiffness *= 1.0 + self.per_k * self.rise_k.at(0, Moment::at(pad.time_s));
    }

    /// A calibration is of the rubber as the scene describes it.
    fn settle(&mut self, _: &mut Pad) {}
}

/// The film's temperature above that of the calibration.
#[derive(Clone, Debug)]
struct Temperature {
    per_k: f64,
    rise_k: Stimulus,
    gradient_k: [f64; 2],
    step_k: f64,
}

impl Temperature {
    fn read(table: &Table) -> Result<Temperature, SceneError> {
        let tempco = table.get(&TEMPCO_PPM_PER_K.required("a number from -100000 to 100000"))?;
        let rise_k = read_rise(table)?;
        let temperature = Temperature {
            per_k: 1e-6 * tempco,
            gradient_k: table.get(&GRADIENT_K)?,
            step_k: table.get(&STEP_K)?,
            rise_k,
        };
        let change = temperature.largest_change();
        match change <= MOST_CHANGE {
            true => Ok(temperature),
            false => Err(table.error(
                "tempco_ppm_per_k",
                format!(
                    "expected a film that changes by at most {MOST_CHANGE} of itself, got {change}"
                ),
            )),
        }
    }

    /// The largest change of R_s anywhere, ever, as a fraction.
    fn largest_change(&self) -> f64 {
        let rise_k = self.rise_k.extremes().into_iter().map(f64::abs).fold(0.0, f64::max);
        let [x, y] = self.gradient_k.map(f64::abs);
        self.per_k.abs() * (rise_k + 0.5 * (x + y))
    }

    fn label(&self) -> String {
        let rise = match self.rise_k.moves() {
            true => format!("steps of {} K", self.step_k),
            false => format!("{} K", self.rise_k.at(0, Moment::at(0.0))),
        };
        match self.gradient_k {
            [0.0, 0.0] => rise,
            [x, y] => format!("{rise}, {x} K across, {y} K up"),
        }
    }

    /// ΔT, in steps where it moves.
    fn rise_k(&self, time_s: f64) -> f64 {
        let rise_k = self.rise_k.at(0, Moment::at(time_s));
        if self.rise_k.moves() { (rise_k / self.step_k).round() * self.step_k } else { rise_k }
    }
}

impl PadEffect for Temperature {
    fn act(&mut self, pad: &mut Pad) {
        pad.film = FilmChange {
            rise: pad.film.rise + self.per_k * self.rise_k(pad.time_s),
            slope: [0, 1].map(|axis| pad.film.slope[axis] + self.per_k * self.gradient_k[axis]),
        };
    }

    /// A calibration is of the film as the scene describes it.
    fn settle(&mut self, _: &mut Pad) {}
}
