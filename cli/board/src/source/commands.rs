// SPDX-License-Identifier: MIT OR Apache-2.0
//! What clients set at a board.

use super::Board;

/// After which time a finger that is led arrives, s: as on a simulated display.
const GLIDE_S: f64 = 0.012;
/// Beyond every sheet, mm: where a wall is that is off.
const FAR_MM: f64 = 1e4;

impl Board {
    /// Whether a pad takes a target, N.
    ///
    /// # Errors
    /// No such pad, a force beyond the cap.
    pub fn check_target(&self, pad: usize, newtons: f64) -> Result<(), String> {
        let pads = self.hello.pads.len();
        if pad >= pads {
            return Err(format!("pad: expected below {pads}, got {pad}"));
        }
        let checked = self.session.check_target(pad * self.parts_mm.len(), newtons);
        checked.map_err(|error| error.to_string())
    }

    /// Sets the target of a pad, N: of each of its parts.
    ///
    /// # Errors
    /// As [`Board::check_target`], a drive that is off.
    pub fn set_target(&mut self, pad: usize, newtons: f64) -> Result<(), String> {
        self.check_target(pad, newtons)?;
        let parts = self.parts_mm.len();
        for part in pad * parts..(pad + 1) * parts {
            self.session.set_target(part, newtons).map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Moves the wall along x: it is known by the number of each pad's last part.
    pub(super) fn set_wall(
        &mut self,
        x_mm: Option<f64>,
        y_mm: Option<f64>,
        off: bool,
    ) -> Result<(), String> {
        let Some(wall) = self.walls.first().copied() else {
            return Err("wall: expected a board whose profile has walls".into());
        };
        if y_mm.is_some() {
            return Err("wall: expected x_mm: walls along y are not set from here".into());
        }
        let mm = if off { if wall.above { FAR_MM } else { -FAR_MM } } else { x_mm.unwrap_or(0.0) };
        let (parts, last_mm) = (self.parts_mm.len(), self.parts_mm.last().map_or(0.0, |of| of[0]));
        for pad in 0..self.hello.pads.len() {
            let number = pad * parts + parts - 1;
            let set = self.session.set_surface(number, mm + last_mm, wall.above);
            set.map_err(|error| error.to_string())?;
        }
        self.walls[0].mm = (!off).then_some(mm);
        Ok(())
    }

    pub(super) fn lead(
        &mut self,
        pad: usize,
        mm: [f64; 2],
        within_s: Option<f64>,
    ) -> Result<(), String> {
        let Some(running) = &self.running else {
            return Err(
                "lead: expected a virtual board: the pads of this one are led by hand".into()
            );
        };
        let within_s = within_s.unwrap_or(GLIDE_S);
        running.lead(pad, mm, within_s).map_err(|error| format!("{error:#}"))
    }
}
