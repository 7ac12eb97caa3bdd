// SPDX-License-Identifier: MIT OR Apache-2.0
//! Inputs of a plant while it runs: voltages, and what a hand does. Each takes the place of what the
//! scene says, from a time on that the plant has not been evaluated at yet.

use super::Plant;
use crate::input_limits::{DriveError, LOAD, PUSH, VOLTAGE};
use crate::pad_inputs::PadInputs;
use crate::stimulus::Moment;
use crate::trajectory::is_within;

impl Plant {
    /// Sets a pad's haptic voltage at its source: from `time_s` on it is this, until it is set
    /// again, whatever the scene says. A controller or a recording drives the plant so, slot by
    /// slot. Parts of a pad have one source: any of their
    /// numbers sets it.
    ///
    /// Times of a pad do not fall, and none is before the middle of the window of a slot that has
    /// been asked for. Several may be set ahead.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let text = "title = \"t\"\nduration_s = 0.5\n[[pad]]\nposition_mm = [0, 0]\nload_g = 50\n\
    /// #     [gap]\nrung = \"tr-bdf2\"\n[friction]\n";
    /// # let scene = Scene::parse(text, "t.toml", &[])?;
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let mut plant = Plant::new(&scene, 0, &timing)?;
    /// let (slot_s, target_n, mut volt) = (1.7e-3, 0.3, 0.0);
    /// let mut force_n = 0.0;
    /// for slot in 0..plant.slots() {
    ///     force_n = plant.truth(slot).force_n; // or what a core makes of the slot's samples
    ///     volt = (volt + 30.0 * (target_n - force_n)).max(0.0);
    ///     plant.set_drive(0, (slot + 1) as f64 * slot_s, volt)?; // at the end of the slot
    /// }
    /// assert!((force_n - target_n).abs() < 0.02, "{force_n}");
    /// assert!(plant.set_drive(0, 0.1, volt).is_err()); // what has happened cannot be changed
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// No such pad, a time that is past, a voltage outside 0 to 100 kV.
    pub fn set_drive(
        &mut self,
        pad: usize,
        time_s: f64,
        haptic_v_rms: f64,
    ) -> Result<(), DriveError> {
        let pads = self.served();
        if pad >= pads {
            return Err(DriveError::NoPad { pad, pads });
        }
        let (pad, now_s) = (pad / self.parts(), self.latest_s);
        self.inputs_of(pad)?.voltage_v_rms.check(time_s, now_s)?;
        if !VOLTAGE.holds(haptic_v_rms) {
            return Err(DriveError::Voltage(haptic_v_rms));
        }
        self.inputs_of(pad)?.voltage_v_rms.set(time_s, haptic_v_rms);
        Ok(())
    }

    /// Leads the finger of a pad, or the pad itself where it hangs on none: on a line from where it is
    /// at `from_s` to a place, mm from the sheet's centre, where it is at `at_s` and stays. A new line
    /// may begin before the last one has ended. `pad` is a pad of the scene, whatever its parts.
    ///
    /// ```
    /// # use hapticore_scene::{Plant, Scene, Timing};
    /// # let text = "title = \"t\"\nduration_s = 0.1\n[[pad]]\nposition_mm = [10, 0]\n";
    /// # let scene = Scene::parse(text, "t.toml", &[])?;
    /// # let timing = Timing {
    /// #     pads: 4, slot_samples: 1700, window_start: 700, window_samples: 1000, samples_per_period: 10.0, signs: None,
    /// # };
    /// let mut plant = Plant::new(&scene, 0, &timing)?;
    /// plant.lead(0, [30.0, -5.0], 0.01, 0.03)?;
    /// assert_eq!(plant.truth(5).x_mm, 10.0);
    /// let half = plant.truth(11); // in the middle of its window, 0.0199 s
    /// assert!((half.x_mm - 19.9).abs() < 1e-9 && (half.y_mm + 2.475).abs() < 1e-9);
    /// assert_eq!(plant.truth(40).set.finger_mm(), [30.0, -5.0]);
    /// assert!(plant.lead(0, [900.0, 0.0], 0.2, 0.3).is_err()); // off the sheet
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// No such pad, a place at which a scene could not have it, a time that is past, an arrival that is
    /// not later. An error changes nothing.
    pub fn lead(
        &mut self,
        pad: usize,
        to_mm: [f64; 2],
        from_s: f64,
        at_s: f64,
    ) -> Result<(), DriveError> {
        let now_s = self.latest_s;
        self.inputs_of(pad)?.finger.check(from_s, at_s, now_s)?;
        let reach_mm = self.case.pads[pad].reach_mm;
        if !is_within(to_mm, reach_mm) {
            return Err(DriveError::Place { place_mm: to_mm, reach_mm });
        }
        let from_mm = self.finger_mm(pad, from_s);
        self.inputs_of(pad)?.finger.go([from_s, at_s], from_mm, to_mm, true);
        Ok(())
    }

    /// Gives the finger of a pad back to the scene: on a line from where it is at `from_s` to where the
    /// scene has it at `at_s`, and as the scene says from then on.
    ///
    /// # Errors
    /// No such pad, a time that is past, an arrival that is not later. An error changes nothing.
    pub fn release(&mut self, pad: usize, from_s: f64, at_s: f64) -> Result<(), DriveError> {
        let now_s = self.latest_s;
        self.inputs_of(pad)?.finger.check(from_s, at_s, now_s)?;
        let from_mm = self.finger_mm(pad, from_s);
        let to_mm = self.drive(pad).scripted_mm(Moment::at(at_s));
        self.inputs_of(pad)?.finger.go([from_s, at_s], from_mm, to_mm, false);
        Ok(())
    }

    /// Presses a pad of the scene with a load from `from_s` on, g.
    ///
    /// # Errors
    /// No such pad, a load outside 0 to 100 kg, a time that is past. An error changes nothing.
    pub fn press(&mut self, pad: usize, load_g: f64, from_s: f64) -> Result<(), DriveError> {
        let now_s = self.latest_s;
        self.inputs_of(pad)?.load_g.check(from_s, now_s)?;
        if !LOAD.holds(load_g) {
            return Err(DriveError::Load(load_g));
        }
        self.inputs_of(pad)?.load_g.set(from_s, load_g);
        Ok(())
    }

    /// Pushes a pad of the scene along x and y from `from_s` on, N, besides its finger.
    ///
    /// # Errors
    /// No such pad, one that no `[hand]` moves, a push beyond ±10 kN, a time that is past. An error
    /// changes nothing.
    pub fn push(&mut self, pad: usize, newtons: [f64; 2], from_s: f64) -> Result<(), DriveError> {
        let now_s = self.latest_s;
        self.inputs_of(pad)?.push_n.check(from_s, now_s)?;
        if !self.case.pads[pad].has_finger {
            return Err(DriveError::NoHand);
        }
        if let Some(push_n) = newtons.into_iter().find(|push_n| !PUSH.holds(*push_n)) {
            return Err(DriveError::Push(push_n));
        }
        self.inputs_of(pad)?.push_n.set(from_s, newtons);
        Ok(())
    }

    /// Where the finger of a pad is at a time, mm.
    fn finger_mm(&self, pad: usize, time_s: f64) -> [f64; 2] {
        let set = self.drive(pad).set(Moment::at(time_s));
        [set.x_mm, set.y_mm]
    }

    /// What has been set at a pad of the scene.
    fn inputs_of(&mut self, pad: usize) -> Result<&mut PadInputs, DriveError> {
        let pads = self.case.pads.len();
        self.inputs.resize_with(pads, PadInputs::default);
        self.inputs.get_mut(pad).ok_or(DriveError::NoPad { pad, pads })
    }
}
