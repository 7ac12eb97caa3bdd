// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core that receives slots of ADC codes.

use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use anyhow::{Result, ensure};
use hapticore_contract::profile::Profile;
use hapticore_host::DeviceCalibration;
use hapticore_run::calibrate;
use hapticore_run::case::Case;
use hapticore_run::columns::Columns;
use hapticore_run::engine::{Fidelity, Signals, Slot};
use hapticore_run::record;
use hapticore_run::session::{Options, Session};
use hapticore_run::simulation;
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::apart::{apart, held};
use crate::failure::{self, error, exception, fidelity};
use crate::rows::Rows;
use crate::trace;

/// A core with the calibration of a device.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Slots {
    session: Mutex<Session>,
    columns: Arc<Columns>,
    profile: Arc<Profile>,
    device: DeviceCalibration,
}

impl Slots {
    fn of(session: Session, profile: Arc<Profile>, device: DeviceCalibration) -> Slots {
        let columns = Arc::new(Columns::new(None));
        Slots { session: Mutex::new(session), columns, profile, device }
    }

    fn of_scene(
        scene: &str,
        set: &[(String, String)],
        profile: Option<&str>,
        options: Options,
    ) -> Result<Slots> {
        let (found, profile) = simulation::prepare(failure::scene(scene, set)?, profile)?;
        let case = Case::new(&found, 0, &profile, &[])?;
        Ok(Slots::of(case.core(options)?, case.profile.clone(), (**case.device).clone()))
    }

    fn of_device(
        profile: &str,
        calibration: Option<PathBuf>,
        pads: Option<u64>,
        options: Options,
    ) -> Result<Slots> {
        let profile = failure::profile(profile)?;
        let device = match calibration {
            Some(path) => DeviceCalibration::read(&path)?,
            None => calibrate::nominal(&profile)?,
        };
        let (session, profile) = Session::of_device(&profile, &device, pads, options)?;
        Ok(Slots::of(session, profile, device))
    }

    /// Samples of a window and channels.
    fn lengths(&self) -> [usize; 2] {
        [self.profile.slot.integrate as usize, self.profile.channels()]
    }
}

#[pymethods]
impl Slots {
    #[new]
    #[pyo3(signature = (scene, *, set, profile, calibration, pads, core))]
    fn new(
        py: Python<'_>,
        scene: Option<String>,
        set: Vec<(String, String)>,
        profile: Option<String>,
        calibration: Option<PathBuf>,
        pads: Option<u64>,
        core: String,
    ) -> PyResult<Slots> {
        apart(py, || {
            let fidelity = fidelity(&core)?;
            ensure!(fidelity != Fidelity::Clock, "core: expected float or fixed, got \"clock\"");
            let options = Options { fidelity, errors: false, reference: false };
            match scene {
                Some(scene) => Slots::of_scene(&scene, &set, profile.as_deref(), options),
                None => {
                    let profile = profile.as_deref().unwrap_or("standard");
                    Slots::of_device(profile, calibration, pads, options)
                }
            }
        })
    }

    /// (samples of a window, channels)
    #[getter]
    fn shape(&self) -> (usize, usize) {
        let [window, channels] = self.lengths();
        (window, channels)
    }

    /// Pads that the core serves.
    #[getter]
    fn pads(&self) -> usize {
        self.profile.pads as usize
    }

    /// The least and the largest code of the ADC.
    #[getter]
    fn codes(&self) -> (i64, i64) {
        let adc = self.profile.formats.adc;
        (adc.min_code() as i64, adc.max_code() as i64)
    }

    /// The length of a slot, s.
    #[getter]
    fn slot_s(&self) -> f64 {
        self.profile.slot.samples() as f64 / self.device.device.sample_rate_hz
    }

    /// Names of all signals of the core.
    fn signals(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        apart(py, || Ok(trace::names(&self.profile, &self.device.for_profile(&self.profile)?)))
    }

    /// Signals of a core after a reset through a slot of pad 0, after each clock: codes of shape (window, channels).
    fn trace<'py>(
        &self,
        py: Python<'py>,
        codes: PyReadonlyArray2<'py, i32>,
        signals: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let codes: Vec<i32> = codes.as_array().iter().copied().collect();
        let slot = Slot { pad: 0, signals: Signals::Samples { codes, blanking: 0 } };
        let traced = apart(py, || {
            held(&self.session).check(&slot)?;
            let calibration = self.device.for_profile(&self.profile)?;
            trace::trace((&self.profile, &calibration), slot.window(), &signals)
        })?;
        let arrays = PyDict::new(py);
        for (name, values) in traced {
            arrays.set_item(name, values.into_pyarray(py))?;
        }
        Ok(arrays)
    }

    /// Takes slots: pads of shape (n,), codes of shape (n, window, channels).
    fn take(
        &self,
        py: Python<'_>,
        pads: PyReadonlyArray1<'_, i64>,
        codes: PyReadonlyArray3<'_, i32>,
    ) -> PyResult<Rows> {
        let [window, channels] = self.lengths();
        let expected = (pads.as_array().len(), window, channels);
        let shape = codes.as_array().dim();
        if shape != expected {
            return Err(error(format!("codes: expected shape {expected:?}, got {shape:?}")));
        }
        let (Ok(pads), Ok(codes)) = (pads.as_slice(), codes.as_slice()) else {
            return Err(error("pads, codes: expected arrays that are contiguous"));
        };
        // Copied, since other threads may write to the arrays while the core computes.
        let slot = |(pad, codes): (&i64, &[i32])| Slot {
            pad: usize::try_from(*pad).unwrap_or(usize::MAX),
            signals: Signals::Samples { codes: codes.to_vec(), blanking: 0 },
        };
        let slots: Vec<_> =
            pads.iter().zip(codes.chunks_exact(window * channels)).map(slot).collect();
        let rows = py.detach(|| self.run(&slots)).map_err(exception)?;
        Ok(Rows::new(self.columns.clone(), record::Rows::of_cases([rows])))
    }
}

impl Slots {
    /// Runs slots, of which all are checked first: an error leaves the core as it was.
    fn run(&self, slots: &[Slot]) -> Result<Vec<record::Row>> {
        let mut session = held(&self.session);
        slots.iter().try_for_each(|slot| session.check(slot))?;
        slots.iter().filter_map(|slot| session.slot(slot, None).transpose()).collect()
    }
}
