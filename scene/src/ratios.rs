// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ratios of the terminals' currents, from which a position is read:
//!
//!   r_x = Σ s_x,i·|I_i| / Σ |I_i|,   r_y likewise        (eqs. 2 and 3 where only the corners have signs)
//!
//! The sums run over the terminals that have a sign in either ratio.

use crate::device::Device;

/// A band on either side of an axis in which a terminal has no sign along it, by the sheet's size.
const BAND: f64 = 1.0 / 6.0;

/// Signs of both ratios.
#[derive(Clone, Debug)]
pub(crate) struct Ratios {
    signs: [Vec<i8>; 2],
}

impl Ratios {
    /// With these signs for each terminal, or by its place.
    pub fn new(device: &Device, signs: Option<&[Vec<i8>; 2]>) -> Result<Ratios, String> {
        let by_place = || signs_by_place(&device.terminals_mm, [device.width_mm, device.height_mm]);
        let signs = signs.cloned().unwrap_or_else(by_place);
        match signs.iter().find(|signs| signs.len() != device.terminals()) {
            None => Ok(Ratios { signs }),
            Some(signs) => {
                Err(format!("expected {} signs, as the device has terminals, got {}", device.terminals(), signs.len()))
            }
        }
    }

    /// r_x and r_y of amplitudes.
    pub fn of(&self, amplitudes: &[f64]) -> [f64; 2] {
        let [x, y] = &self.signs;
        let counts = amplitudes.iter().zip(x.iter().zip(y)).filter(|(_, (x, y))| (**x, **y) != (0, 0));
        let sum: f64 = counts.map(|(amplitude, _)| amplitude).sum();
        self.signs.each_ref().map(|signs| {
            let of = |sign: i8| {
                amplitudes.iter().zip(signs).filter(move |(_, s)| **s == sign).map(|(amplitude, _)| amplitude)
            };
            of(-1).fold(of(1).sum::<f64>(), |sum, amplitude| sum - amplitude) / sum
        })
    }
}

/// Signs of the ratios r_x and r_y for terminals at these places, mm from the middle of a sheet of this size: the side of the
/// sheet that a terminal is on, none for those within a sixth of the size from the middle. The six terminals of the paper
/// have x = [−1, −1, 1, 1, 0, 0], y = [1, −1, −1, 1, −1, 1].
pub fn signs_by_place(terminals_mm: &[[f64; 2]], size_mm: [f64; 2]) -> [Vec<i8>; 2] {
    [0, 1].map(|axis| terminals_mm.iter().map(|place| side(place[axis], BAND * size_mm[axis])).collect())
}

fn side(mm: f64, band_mm: f64) -> i8 {
    i8::from(mm > band_mm) - i8::from(mm < -band_mm)
}
