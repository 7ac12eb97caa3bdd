// SPDX-License-Identifier: MIT OR Apache-2.0
//! A display that is stepped slot by slot, with inputs between slots.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use anyhow::{Context, Result};
use hapticore_run::columns::{Columns, OfScene};
use hapticore_run::record;
use hapticore_run::session::Options;
use hapticore_run::stepper::{Input, Stepper};
use hapticore_scene::Scene;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

use crate::apart::{PATIENCE, apart, held, signals};
use crate::failure::{self, error, exception, fidelity};
use crate::rows::Rows;

/// The most slots of a call: a row of each is kept.
const MOST_SLOTS: usize = 1_000_000;

/// A case of a scene with its core, and controller where it has one.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Stepped {
    stepper: Mutex<Stepper>,
    columns: Arc<Columns>,
    channels: usize,
    slot_s: f64,
    parts_mm: Vec<[f64; 2]>,
    pads: Vec<String>,
    sheet_mm: [f64; 2],
}

/// The number of a case by its name; the first where none is named.
fn index(scene: &Scene, case: Option<&str>) -> Result<usize> {
    let Some(case) = case else { return Ok(0) };
    scene.cases.iter().position(|of| of.name == case).with_context(|| {
        let names: Vec<_> = scene.cases.iter().map(|case| case.name.as_str()).collect();
        format!("case: expected one of {}, got {case:?}", names.join(", "))
    })
}

impl Stepped {
    fn of(stepper: Stepper) -> Stepped {
        let case = stepper.case();
        let of = &case.scene.cases[case.index];
        let columns = Arc::new(Columns::new(Some(OfScene {
            cases: vec![case.name().to_string()],
            swept: of.swept(),
            driven: case.plan().is_some(),
            walled: case.plan().is_some_and(|plan| plan.wall.is_some()),
            plays: of.arena.is_some(),
        })));
        let device = stepper.plant().device();
        Stepped {
            columns,
            channels: case.profile.channels(),
            slot_s: case.clock.seconds(1),
            parts_mm: stepper.plant().parts_mm().to_vec(),
            pads: of.pad_names().into_iter().map(Into::into).collect(),
            sheet_mm: [device.width_mm, device.height_mm],
            stepper: Mutex::new(stepper),
        }
    }

    fn apply(&self, py: Python<'_>, input: &Input) -> PyResult<()> {
        py.detach(|| held(&self.stepper).apply(input)).map_err(|of| error(of.to_string()))
    }

    fn advance(&self, slots: usize) -> PyResult<Vec<record::Row>> {
        let (mut stepper, mut asked) = (held(&self.stepper), Instant::now());
        let mut rows = Vec::with_capacity(slots.min(1 << 16));
        for _ in 0..slots {
            rows.extend(stepper.step().map_err(exception)?);
            if asked.elapsed() > PATIENCE {
                signals()?;
                asked = Instant::now();
            }
        }
        Ok(rows)
    }
}

#[pymethods]
impl Stepped {
    #[new]
    #[pyo3(signature = (scene, *, set, core, case, profile))]
    fn new(
        py: Python<'_>,
        scene: String,
        set: Vec<(String, String)>,
        core: String,
        case: Option<String>,
        profile: Option<String>,
    ) -> PyResult<Stepped> {
        apart(py, || {
            let options = Options { fidelity: fidelity(&core)?, errors: false, reference: false };
            let found = failure::scene(&scene, &set)?;
            let name = profile.unwrap_or_else(|| found.profile.clone());
            let profile = failure::profile(&name)?;
            let index = index(&found, case.as_deref())?;
            Ok(Stepped::of(Stepper::new(found.into(), index, &profile, options)?))
        })
    }

    /// Begins the case anew, without inputs.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        apart(py, || {
            let mut stepper = held(&self.stepper);
            *stepper = stepper.restart()?;
            Ok(())
        })
    }

    /// Runs slots; the rows that they finish.
    fn step(&self, py: Python<'_>, slots: usize) -> PyResult<Rows> {
        if slots > MOST_SLOTS {
            return Err(error(format!("slots: expected at most {MOST_SLOTS}, got {slots}")));
        }
        let rows = py.detach(|| self.advance(slots))?;
        Ok(Rows::new(self.columns.clone(), record::Rows::of_cases([rows])))
    }

    /// The finger, or the pad itself, goes on a line to a place.
    fn lead(
        &self,
        py: Python<'_>,
        pad: usize,
        x_mm: f64,
        y_mm: f64,
        within_s: f64,
    ) -> PyResult<()> {
        self.apply(py, &Input::Lead { pad, to_mm: [x_mm, y_mm], within_s })
    }

    /// The finger follows the scene again.
    fn release(&self, py: Python<'_>, pad: usize) -> PyResult<()> {
        self.apply(py, &Input::Release { pad })
    }

    /// The load on a pad, g.
    fn press(&self, py: Python<'_>, pad: usize, load_g: f64) -> PyResult<()> {
        self.apply(py, &Input::Press { pad, load_g })
    }

    /// A push on a pad besides its finger, N.
    fn push(&self, py: Python<'_>, pad: usize, x_n: f64, y_n: f64) -> PyResult<()> {
        self.apply(py, &Input::Push { pad, newtons: [x_n, y_n] })
    }

    /// The force that the controller gives a pad, N.
    fn target(&self, py: Python<'_>, pad: usize, target_n: f64) -> PyResult<()> {
        self.apply(py, &Input::Target { pad, newtons: target_n })
    }

    /// Serves a new puck.
    fn serve(&self, py: Python<'_>) -> PyResult<()> {
        self.apply(py, &Input::Serve)
    }

    /// Where walls begin, mm.
    #[pyo3(signature = (x_mm, y_mm, off))]
    fn wall(
        &self,
        py: Python<'_>,
        x_mm: Option<f64>,
        y_mm: Option<f64>,
        off: bool,
    ) -> PyResult<()> {
        self.apply(py, &Input::Wall { x_mm, y_mm, off })
    }

    /// The haptic voltage, V rms.
    fn voltage(&self, py: Python<'_>, pad: usize, v_rms: f64) -> PyResult<()> {
        self.apply(py, &Input::Voltage { pad, v_rms })
    }

    /// ADC codes of the last slot's window, int32 of shape (window, channels); None without samples.
    fn codes<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<i32>>>> {
        let codes = py.detach(|| held(&self.stepper).codes().map(<[i32]>::to_vec));
        let Some(codes) = codes else { return Ok(None) };
        let shape = [codes.len() / self.channels, self.channels];
        codes.into_pyarray(py).reshape(shape).map(Some)
    }

    /// The number of the next slot.
    #[getter]
    fn slot(&self, py: Python<'_>) -> usize {
        py.detach(|| held(&self.stepper).slot())
    }

    /// When the next slot begins, s.
    #[getter]
    fn time_s(&self, py: Python<'_>) -> f64 {
        py.detach(|| held(&self.stepper).time_s())
    }

    /// Where the walls along x and y begin, mm.
    #[getter]
    fn walls_mm(&self, py: Python<'_>) -> (Option<f64>, Option<f64>) {
        let [x_mm, y_mm] = py.detach(|| held(&self.stepper).walls_mm());
        (x_mm, y_mm)
    }

    /// The length of a slot, s.
    #[getter]
    fn slot_s(&self) -> f64 {
        self.slot_s
    }

    /// Names of the pads.
    #[getter]
    fn pads(&self) -> Vec<String> {
        self.pads.clone()
    }

    /// Centres of a pad's parts relative to its own, mm.
    #[getter]
    fn parts_mm(&self) -> Vec<(f64, f64)> {
        self.parts_mm.iter().map(|[x_mm, y_mm]| (*x_mm, *y_mm)).collect()
    }

    /// Width and height of the sheet, mm.
    #[getter]
    fn sheet_mm(&self) -> (f64, f64) {
        self.sheet_mm.into()
    }
}
