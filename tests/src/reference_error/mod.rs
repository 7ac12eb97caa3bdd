// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reference's own error: its `f64` against the same equations in double-double, on every
//! quantity of a scene's slots, and a bound that is derived for each slot (`bound.rs`).
//!
//! Double-double is `xprec`'s `Df64`, of 104 bits or more in every operation that the reference
//! uses; a test asks it. `twofloat` 0.8.4 is too coarse: 53 bits in quotients, 66 in sines. Both
//! take codes, phasors and the calibration's numbers as they are, so that the difference is the
//! rounding of the evaluation alone.

mod bound;

use std::sync::Arc;

use bound::bounds;
use hapticore_contract::calibration::Calibration;
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use hapticore_host::Scales;
use hapticore_reference::{Real, Reference};
use hapticore_run::case::Case;
use hapticore_run::engine::{Signals, Slot};
use hapticore_run::inputs;
use hapticore_run::maker::Maker;
use hapticore_scene::Timing;
use xprec::Df64;

/// What the reference gives of a slot: name and unit, in the order of [`Errors`].
pub const QUANTITIES: [(&str, &str); 9] = [
    ("r_x", "1"),
    ("r_y", "1"),
    ("x", "mm"),
    ("y", "mm"),
    ("capacitance", "pF"),
    ("capacitance by eq. 6", "pF"),
    ("sheet_ohm", "ohm"),
    ("haptic_v_rms", "V"),
    ("force", "N"),
];

/// The errors of one quantity over a scene's slots.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors {
    /// The largest value, in the quantity's unit.
    pub value: f64,
    /// The largest error of `f64`.
    pub error: f64,
    /// The bound of the slot in which the error is the largest share of it.
    pub bound: f64,
    /// That share: at most one.
    pub share: f64,
    /// The largest error of `f32`, by the bound of `f64`.
    pub single_share: f64,
}

/// What was measured of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// The errors, in the order of [`QUANTITIES`].
    pub errors: [Errors; QUANTITIES.len()],
    /// Slots that were compared.
    pub slots: usize,
    /// Slots without a valid place or capacitance, which were left out.
    pub left_out: usize,
    /// Slots of which `f64` and double-double do not say the same flags.
    pub contradictions: usize,
}

// Where some of them stand.
const EQ6: usize = 5;
const SHEET: usize = 6;
const HAPTIC: usize = 7;

/// A slot as a core of one precision says it.
struct Read {
    /// Rounded to `f64`, of which flags are taken.
    measurement: Measurement,
    quantities: [Df64; QUANTITIES.len()],
}

/// One core in three precisions.
struct Cores {
    single: Reference<f32>,
    double: Reference<f64>,
    exact: Reference<Df64>,
}

impl Cores {
    fn new(profile: &Profile, calibration: &Calibration) -> Self {
        Cores {
            single: Reference::with_precision(profile, calibration),
            double: Reference::with_precision(profile, calibration),
            exact: Reference::with_precision(profile, calibration),
        }
    }

    fn read(&mut self, units: &Units, slot: &Slot) -> [Read; 3] {
        [
            read(&mut self.single, |x| f64::from(x).into(), units, slot),
            read(&mut self.double, Into::into, units, slot),
            read(&mut self.exact, |x| x, units, slot),
        ]
    }
}

fn read<T: Real>(
    reference: &mut Reference<T>,
    widened: fn(T) -> Df64,
    units: &Units,
    slot: &Slot,
) -> Read {
    let measurement = match &slot.signals {
        Signals::Samples { .. } => reference.slot(slot.pad, slot.window()),
        Signals::Phasors { amplitudes, mean_square } => {
            reference.phasors(slot.pad, amplitudes, *mean_square)
        }
    };
    let measurement = measurement.map(widened);
    Read {
        measurement: measurement.map(f64::from),
        quantities: units.quantities(&measurement, widened(reference.capacitance_eq6())),
    }
}

/// Physical units; the conversion is none of the reference's, and has double-double's rounding
/// alone.
struct Units {
    ohm: f64,
    haptic_v: f64,
    square_gain: f64,
}

impl Units {
    fn new(profile: &Profile, scales: &Scales) -> Self {
        Units {
            ohm: scales.ohm(),
            haptic_v: scales.haptic_full_scale_v,
            square_gain: profile.square_gain(),
        }
    }

    fn quantities(&self, r: &Measurement<Df64>, eq6: Df64) -> [Df64; QUANTITIES.len()] {
        let haptic_v = (r.mean_square / self.square_gain).sqrt() * self.haptic_v;
        [
            r.r_x,
            r.r_y,
            r.x_mm,
            r.y_mm,
            r.capacitance_pf,
            eq6,
            r.sheet * self.ohm,
            haptic_v,
            r.force_n,
        ]
    }

    fn of_bounds(&self, mut bounds: [f64; QUANTITIES.len()]) -> [f64; QUANTITIES.len()] {
        bounds[SHEET] *= self.ohm;
        bounds
    }
}

/// The errors over at most about `slots` slots of a bundled scene, evenly spread over its cases,
/// with the scene's own profile.
///
/// # Panics
/// Where there is no such scene.
pub fn measure(scene: &str, slots: usize) -> Measured {
    let scene = inputs::scene(scene, &[]).expect("a bundled scene");
    let profile = inputs::profile(&scene.profile).expect("a bundled profile");
    let profile = inputs::windowed(profile, &scene).expect("a window");
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    let scene = Arc::new(scene.within_budget(&timing).expect("levels within the budget"));
    let mut measured = Measured::default();
    let cases = scene.cases.len();
    let of_each = slots.div_ceil(cases);
    for index in (0..cases).step_by(cases.div_ceil(slots)) {
        let case = Case::new(&scene, index, &profile, &[]).expect("a case");
        measured.case(&case, scene.cases[index].sampled(), of_each);
    }
    measured
}

impl Measured {
    fn case(&mut self, case: &Case, sampled: bool, slots: usize) {
        let calibration = case.calibration().expect("a calibration").clone();
        let mut cores = Cores::new(&case.profile, &calibration);
        let units = Units::new(&case.profile, &case.device.device);
        let mut maker = Maker::new(case.plant().expect("a plant"), &case.profile, sampled, false);
        for slot in (0..case.slots).step_by(case.slots.div_ceil(slots)) {
            let pad = maker.plant().truth(slot).pad;
            let slot = Slot { pad, signals: maker.signals(slot).0 };
            let [single, double, exact] = cores.read(&units, &slot);
            self.contradictions += usize::from(double.measurement.flags != exact.measurement.flags);
            let own = [double.quantities[EQ6], double.quantities[HAPTIC]].map(f64::from);
            let bounds =
                bounds(&case.profile, &calibration, &slot.signals, own, &double.measurement);
            match bounds.filter(|_| !double.measurement.flags.invalid) {
                Some(bounds) => self.add(
                    [single, double, exact].map(|read| read.quantities),
                    units.of_bounds(bounds),
                ),
                None => self.left_out += 1,
            }
        }
    }

    fn add(
        &mut self,
        [single, double, exact]: [[Df64; QUANTITIES.len()]; 3],
        bounds: [f64; QUANTITIES.len()],
    ) {
        self.slots += 1;
        for (k, errors) in self.errors.iter_mut().enumerate() {
            let error = |got: Df64| f64::from((got - exact[k]).abs());
            errors.add(f64::from(exact[k]), [error(double[k]), error(single[k])], bounds[k]);
        }
    }
}

impl Errors {
    fn add(&mut self, value: f64, [double, single]: [f64; 2], bound: f64) {
        // A quantity that is zero, such as the force without a haptic voltage, has no error and a
        // bound of zero.
        let share = |error: f64| if error == 0.0 { 0.0 } else { error / bound };
        self.value = self.value.max(value.abs());
        self.error = self.error.max(double);
        if share(double) >= self.share {
            (self.share, self.bound) = (share(double), bound);
        }
        self.single_share = self.single_share.max(share(single));
    }
}

/// A scene's errors as rows of a table in Markdown.
pub fn table(scene: &str, measured: &Measured) -> String {
    let rows = QUANTITIES.iter().zip(&measured.errors).map(|((name, unit), e)| {
        format!(
            "| {scene} | {name} | {unit} | {:.3e} | {:.1e} | {:.1e} | {:.3} | {:.1e} |\n",
            e.value, e.error, e.bound, e.share, e.single_share
        )
    });
    rows.collect()
}

/// The head of [`table`].
pub const HEAD: &str = "| scene | quantity | unit | largest value | largest error of f64 | its bound where nearest to it | error / bound | f32: error / bound of f64 |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
