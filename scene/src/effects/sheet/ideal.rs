// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sheet of a device without `[sheet]`.

use num_complex::Complex64;

use crate::device::Device;
use crate::few::Few;
use crate::terminals::PerTerminal;

/// The split of an ideal sheet: corner currents bilinear in the position, so that r_x and r_y are
/// proportional to x and y. Only a device without `[sheet]` has it, and so the corners as its first
/// terminals; where there is one, it says the split.
pub(crate) fn ideal_split(x_mm: f64, y_mm: f64, device: &Device) -> PerTerminal<Complex64> {
    let (u, v) = (x_mm / device.width_mm + 0.5, y_mm / device.height_mm + 0.5);
    let corners = [(1.0 - u) * v, (1.0 - u) * (1.0 - v), u * (1.0 - v), u * v];
    Few::of(device.terminals(), |shares| {
        shares
            .iter_mut()
            .zip(corners)
            .take(device.terminals())
            .for_each(|(share, corner)| *share = corner.into());
    })
}
