// SPDX-License-Identifier: MIT OR Apache-2.0
//! The nominal sheet of a simulated device, at the levels of its scene: what a host of it knows.

use hapticore_sheet::model::{PadEstimate, SheetModel};
use num_complex::Complex64;

use crate::device::Device;
use crate::effects::{Effects, Pad};
use crate::pad::pad_of_frame;
use crate::ratios::Ratios;

/// The nominal sheet of a simulated device.
pub struct NominalSheet {
    /// Those that split a current among the terminals.
    pub(crate) effects: Effects,
    pub(crate) device: Device,
    pub(crate) ratios: Ratios,
}

impl NominalSheet {
    /// A pad that the sheet alone has acted on.
    fn on_sheet(&mut self, pad: &PadEstimate) -> Pad {
        let mut pad = pad_of_frame([pad.x_mm, pad.y_mm], pad.capacitance_pf, &self.device);
        self.effects.on_resting_pad(&mut pad);
        pad
    }
}

impl SheetModel for NominalSheet {
    fn isolated(&mut self, pad: &PadEstimate) -> ([f64; 2], f64) {
        let pad = self.on_sheet(pad);
        (self.ratios.of_amplitudes(&pad.amplitudes()), pad.sheet_ohm.re)
    }

    fn with_neighbours(&mut self, pad: &PadEstimate, others: &[PadEstimate]) -> ([f64; 2], f64) {
        let others: Vec<_> = others.iter().map(|pad| self.on_sheet(pad)).collect();
        let mut pad = self.on_sheet(pad);
        self.effects.on_pads(&mut pad, &others);
        (
            self.ratios.of_amplitudes(&pad.amplitudes()),
            pad.transfer(&self.device).iter().sum::<Complex64>().norm(),
        )
    }

    fn reach_mm(&self) -> [f64; 2] {
        self.device.reach_mm()
    }
}

#[cfg(test)]
mod tests;
