// SPDX-License-Identifier: MIT OR Apache-2.0
//! Readout: a board's frames as rows of `frames.csv`.

use crate::crosstalk::CrosstalkCanceller;
use crate::device::DeviceCalibration;
use crate::placement::Placement;
use crate::quantities::{QUANTITIES, Quantities};
use crate::units::{Units, flag_names};
use hapticore_contract::frame::Measurement;
use hapticore_contract::profile::Profile;
use std::array;

/// The columns of `frames.csv`: time and pad, the [`QUANTITIES`], the flags.
pub const COLUMNS: [&str; QUANTITIES.len() + 3] = {
    let mut columns = ["time_s"; QUANTITIES.len() + 3];
    columns[1] = "pad";
    let mut index = 0;
    while index < QUANTITIES.len() {
        columns[index + 2] = QUANTITIES[index].name;
        index += 1;
    }
    columns[QUANTITIES.len() + 2] = "flags";
    columns
};

/// From the core's measurements to physical units and flags, pad after pad: what `simulate` and
/// `replay` do, too.
///
/// ```
/// use hapticore_host::{DeviceCalibration, Flags, Frame, Profile, Readout};
///
/// let device = DeviceCalibration::read("recordings/hockey.calibration.toml".as_ref())?;
/// let profile = device.profile(&Profile::bundled("small")?)?;
/// let mut readout = Readout::new(&profile, &device);
/// let frame = Frame { pad: 1, codes: [0; 8], flags: Flags { clipped: true, ..Flags::default() } };
/// let (measured, flags) = readout.convert(&frame.measurement(&profile));
/// assert_eq!((measured.x_mm, measured.force_n, flags.as_str()), (0.0, 0.0, "clipped"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Readout {
    units: Units,
    canceller: Option<CrosstalkCanceller>,
    placement: Placement,
}

/// Threads may share it.
const _: fn() = || {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Readout>();
};

impl Readout {
    /// Of a core of the profile on a device, before its first frame.
    pub fn new(profile: &Profile, device: &DeviceCalibration) -> Self {
        Readout {
            units: Units::new(profile, &device.device),
            canceller: None,
            placement: Placement::new(device),
        }
    }

    /// The same, which takes out what other pads did to a pad's measurements.
    pub fn with_canceller(self, canceller: Option<CrosstalkCanceller>) -> Self {
        Readout { canceller, ..self }
    }

    /// A measurement in physical units, and the names of its flags, joined by `+`.
    pub fn convert(&mut self, measurement: &Measurement) -> (Quantities, String) {
        let mut measured = self.units.quantities(measurement);
        if let Some(canceller) = self.canceller.as_mut().filter(|_| !measurement.flags.invalid) {
            canceller.apply(measurement.pad, &mut measured);
        }
        let at_mm = (!measurement.flags.invalid).then_some([measured.x_mm, measured.y_mm]);
        let flags: Vec<_> = flag_names(measurement.flags)
            .chain(self.placement.flags(measurement.pad, at_mm))
            .collect();
        (measured, flags.join("+"))
    }

    /// A measurement as a row of `frames.csv`, in the order of [`COLUMNS`].
    pub fn row(&mut self, time_s: f64, measurement: &Measurement) -> [String; COLUMNS.len()] {
        let (measured, flags) = self.convert(measurement);
        let numbers = measured.values().map(|number| number.to_string());
        let mut words = [time_s.to_string(), measurement.pad.to_string()]
            .into_iter()
            .chain(numbers)
            .chain([flags]);
        array::from_fn(|_| words.next().expect("a word for each column"))
    }
}
