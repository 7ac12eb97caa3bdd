// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a calibration measures of the device: with effects of its own, so that the run stays as it
//! was.

use super::Plant;
use crate::effects::split_electrode::sides_f;
use crate::effects::{Effects, Pad};
use crate::pad::resting;
use crate::threads::in_parts;
use crate::trajectory::raster;
use crate::truth::{ForcePoint, MapPoint, PadMeasurement};

/// Places that are worth a thread.
const LEAST: usize = 2000;

impl Plant {
    /// A raster of places with what the nominal device reads there: no noise, no mismatch, one
    /// resting pad alone.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let scene = Scene::parse("title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[sheet]\n", "t.toml", &[])?;
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// # let plant = Plant::new(&scene, 0, &timing)?;
    /// let map = plant.calibration_map(3, 3, 15.0); // row by row from the bottom left
    /// assert_eq!((map[0].x_mm, map[0].y_mm, map[4].x_mm), (-415.0, -235.0, 0.0));
    /// assert!(map[0].r_x < -0.5 && map[4].r_x.abs() < 1e-9);
    /// assert!((map[4].shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn calibration_map(&self, nx: usize, ny: usize, margin_mm: f64) -> Vec<MapPoint> {
        let places = raster(nx, ny, margin_mm, &self.device);
        let (device, ratios) = (&self.device, &self.ratios);
        let point = |pad: &Pad| {
            let amplitudes = pad.amplitudes();
            let [r_x, r_y] = ratios.of_amplitudes(&amplitudes);
            let shares = ratios.shares(&amplitudes).collect();
            MapPoint {
                x_mm: pad.x_mm,
                y_mm: pad.y_mm,
                r_x,
                r_y,
                shares,
                sheet_ohm: pad.sheet_ohm.re,
            }
        };
        let (specs, setting) = (&self.case.effects, self.setting());
        in_parts(places.len(), LEAST, |part| {
            let mut effects = Effects::build(specs, &setting);
            let settle = |place: &[f64; 2]| {
                let mut pad = resting(*place, 0.0, 0.0, device);
                effects.on_resting_pad(&mut pad);
                point(&pad)
            };
            places[part].iter().map(settle).collect()
        })
    }

    /// What the terminals of the nominal device measure of an isolated resting pad at each of these
    /// positions, mm.
    pub fn measurements(&self, places_mm: &[[f64; 2]]) -> Vec<PadMeasurement> {
        let still = places_mm.iter().map(|place| resting(*place, 0.0, 0.0, &self.device));
        let measurement = |pad: Pad| PadMeasurement {
            siemens: pad.transfer(&self.device).iter().copied().collect(),
            sheet_ohm: pad.sheet_ohm.re,
        };
        self.settle(still).map(measurement).collect()
    }

    /// A friction calibration, as for the paper's Fig. 6: one pad alone in the middle of the sheet,
    /// under each load at each voltage, V rms at the pad. Eq. 8's k is fitted to it; without `[gap]` every point has
    /// `force_k` itself.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let scene = Scene::parse("title = \"t\"\n[[pad]]\nposition_mm = [0, 0]\n[gap]\n", "t.toml", &[])?;
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// # let plant = Plant::new(&scene, 0, &timing)?;
    /// let points = plant.friction_calibration(&[20.0, 100.0], &[0.0, 300.0]);
    /// assert_eq!((points[0].load_g, points[3].load_g, points[0].force_n), (20.0, 100.0, 0.0));
    /// assert!((points[0].capacitance_pf - 299.1).abs() < 0.1); // at rest under 20 g
    /// assert!(points[3].force_n > points[1].force_n); // a load closes the gap
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn friction_calibration(&self, loads_g: &[f64], haptic_v_rms: &[f64]) -> Vec<ForcePoint> {
        let settings =
            loads_g.iter().flat_map(|load| haptic_v_rms.iter().map(move |volt| (*load, *volt)));
        // The part that brakes: the last, where parts have slots of their own.
        let part = (self.parts() > 1).then(|| self.parts() - 1);
        let still = settings
            .map(|(load, volt)| Pad { part, ..resting([0.0, 0.0], load, volt, &self.device) });
        let supply = self.settle(std::iter::once(resting([0.0, 0.0], 0.0, 0.0, &self.device)));
        let supply = supply.last().and_then(|pad| pad.supply);
        let share = |pad: &Pad| supply.map_or(1.0, |supply| supply.share(pad.capacitance_f));
        let point = |pad: Pad| ForcePoint {
            load_g: pad.load_g,
            haptic_v_rms: pad.haptic_v_rms,
            source_v_rms: pad.haptic_v_rms / share(&pad),
            capacitance_pf: pad.capacitance_f * 1e12,
            force_n: pad.haptic_force_n(&self.device),
        };
        settled(self.effects_but("supply"), still).map(point).collect()
    }

    /// The least capacitance that any pad, or any part of a split one, has while it touches the sheet without a haptic
    /// voltage, pF. With `[gap]` it is that of a resting pad under a load, g. Of a scene without one the largest
    /// capacitance that each pad is ever set to counts, too.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let of = |text: &str| {
    ///     let head = "title = \"t\"\nduration_s = 2\n[[pad]]\nposition_mm = [0, 0]";
    ///     let scene = Scene::parse(&format!("{head}\n{text}"), "t.toml", &[])?;
    ///     Ok::<_, hapticore_scene::SceneError>(Plant::new(&scene, 0, &timing)?.least_rest_capacitance_pf(20.0).round())
    /// };
    /// assert_eq!((of("[gap]\n")?, of("")?), (299.0, 318.0));
    /// assert_eq!(of("capacitance_pf = { timeline = [[0, 90], [1, 2], [2, 2]] }\n")?, 90.0);
    /// # Ok::<(), hapticore_scene::SceneError>(())
    /// ```
    pub fn least_rest_capacitance_pf(&self, load_g: f64) -> f64 {
        let parts = 0..self.parts();
        let part = |part: usize| Pad {
            part: (self.parts() > 1).then_some(part),
            ..resting([0.0, 0.0], load_g, 0.0, &self.device)
        };
        let at_rest = self.settle(parts.map(part)).map(|pad| 1e12 * pad.capacitance_f);
        at_rest
            .chain(self.case.pads.iter().filter_map(|pad| pad.set_capacitance_pf()))
            .fold(f64::INFINITY, f64::min)
    }

    /// What the parts on the left and on the right of a resting split pad read under a load, pF: the
    /// direction that a device has when it leaves the factory. None of a pad that is whole.
    pub fn parts_at_rest_pf(&self, load_g: f64) -> Option<[f64; 2]> {
        let still = [resting([0.0, 0.0], load_g, 0.0, &self.device)];
        let quadrants = self.parts() == 4;
        let of = |pad: Pad| {
            let right = pad.electrodes_f.iter().rposition(|farad| *farad > 0.0)?;
            let sides_f = sides_f(&pad.electrodes_f, quadrants, right + 1);
            (right > 0).then(|| sides_f.map(|farad| 1e12 * farad))
        };
        self.settle(still.into_iter()).find_map(of)
    }

    /// Lets effects of their own act on each pad, so that a calibration leaves the run as it was.
    fn settle(&self, pads: impl Iterator<Item = Pad>) -> impl Iterator<Item = Pad> {
        settled(self.fresh_effects(), pads)
    }
}

/// Pads on which effects have acted.
fn settled(mut effects: Effects, pads: impl Iterator<Item = Pad>) -> impl Iterator<Item = Pad> {
    pads.map(move |mut pad| {
        effects.on_resting_pad(&mut pad);
        pad
    })
}
