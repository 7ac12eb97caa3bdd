// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ratios of a device's terminals.

pub(crate) use hapticore_sheet::Ratios;
pub use hapticore_sheet::ratios::signs_by_place;

use crate::device::Device;

/// The ratios with these signs for each terminal, or by its place.
pub(crate) fn of_device(device: &Device, signs: Option<&[Vec<i8>; 2]>) -> Result<Ratios, String> {
    let by_place = || signs_by_place(&device.terminals_mm, [device.width_mm, device.height_mm]);
    let signs = signs.cloned().unwrap_or_else(by_place);
    match signs.iter().find(|signs| signs.len() != device.terminals()) {
        None => Ok(Ratios::new(signs)),
        Some(signs) => Err(format!(
            "expected {} signs, as the device has terminals, got {}",
            device.terminals(),
            signs.len()
        )),
    }
}
