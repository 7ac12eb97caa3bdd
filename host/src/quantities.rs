// SPDX-License-Identifier: MIT OR Apache-2.0
//! Quantities: what a slot measures, in physical units. The one list of them.
//!
//! Columns of `frames.csv`, the truth in waveforms, criteria and reports all follow [`QUANTITIES`].
//! To add a quantity: a line here, and what computes it: a field of the core's measurement, and of
//! the plant's truth where a scene knows it.

use crate::units::Units;
use hapticore_contract::frame::Measurement;

/// One of the [`QUANTITIES`].
///
/// ```
/// use hapticore_host::{QUANTITIES, Quantities, quantity};
///
/// let force = quantity("force_n").expect("a column");
/// assert_eq!((force.unit, force.label, force.axis), ("N", "Haptic force", "F (N)"));
/// assert_eq!(force.value_in(&Quantities { force_n: 0.3, ..Quantities::default() }), 0.3);
/// assert!(QUANTITIES.iter().any(|quantity| quantity.name == "capacitance_pf"));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Its field in [`Quantities`] and its column in `frames.csv`.
    pub name: &'static str,
    /// Its unit, as in a table's head; empty where it has none.
    pub unit: &'static str,
    /// What it is called, over a figure of it.
    pub label: &'static str,
    /// Its axis in a figure; empty where reports draw none of it.
    pub axis: &'static str,
    /// Takes it from the others.
    pub get: fn(&Quantities) -> f64,
}

impl Quantity {
    /// The quantity's value among these.
    pub fn value_in(&self, quantities: &Quantities) -> f64 {
        (self.get)(quantities)
    }
}

impl Units {
    /// A slot's measurement in physical units.
    pub fn quantities(&self, measurement: &Measurement) -> Quantities {
        Quantities::measured(self, measurement)
    }
}

/// The quantity of a column.
pub fn quantity(name: &str) -> Option<&'static Quantity> {
    QUANTITIES.iter().find(|quantity| quantity.name == name)
}

macro_rules! table {
    ($($(#[$doc:meta])* $name:ident, $unit:literal, $label:literal, $axis:literal, $of:expr;)*) => {
        /// The quantities of a slot, in physical units.
        ///
        /// ```
        /// use hapticore_host::Quantities;
        ///
        /// let measured = Quantities { x_mm: 3.0, y_mm: -4.0, ..Quantities::default() };
        /// assert_eq!(measured.values()[2..4], [3.0, -4.0]);
        /// ```
        #[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
        pub struct Quantities {
            $($(#[$doc])* pub $name: f64,)*
        }

        /// All quantities, in the order of their columns.
        pub const QUANTITIES: [Quantity; [$($label),*].len()] = [$(Quantity {
            name: stringify!($name),
            unit: $unit,
            label: $label,
            axis: $axis,
            get: |quantities| quantities.$name,
        }),*];

        impl Quantities {
            /// The quantities of a measurement of the core.
            pub(crate) fn measured(units: &Units, measurement: &Measurement) -> Self {
                $(let $name: fn(&Units, &Measurement) -> f64 = $of;)*
                Quantities { $($name: $name(units, measurement)),* }
            }

            /// Their values, in the order of [`QUANTITIES`].
            pub fn values(&self) -> [f64; QUANTITIES.len()] {
                [$(self.$name),*]
            }
        }

        /// The [`Quantities`] whose values are the fields of another struct, of the same names:
        /// those of the plant's truth.
        #[macro_export]
        macro_rules! quantities_of {
            ($from:expr) => { $crate::Quantities { $($name: $from.$name),* } };
        }
    };
}

table! {
    /// Eq. 2.
    r_x, "", "Ratio r_x", "", |_, measurement| measurement.r_x;
    /// Eq. 3.
    r_y, "", "Ratio r_y", "", |_, measurement| measurement.r_y;
    /// Millimetres from the sheet's middle, along the long edges.
    x_mm, "mm", "Position along x", "x (mm)", |_, measurement| measurement.x_mm;
    /// Millimetres from the sheet's middle, along the short edges.
    y_mm, "mm", "Position along y", "y (mm)", |_, measurement| measurement.y_mm;
    /// The pad's capacitance, pF.
    capacitance_pf, "pF", "Capacitance", "C (pF)", |_, measurement| measurement.capacitance_pf;
    /// The sheet's resistance at the pad, Ω.
    sheet_ohm, "Ω", "Resistance of the sheet", "", |units, measurement| units.sheet_ohm(measurement);
    /// The haptic voltage, V rms.
    haptic_v_rms, "V", "Haptic voltage", "V RMS (V)", |units, measurement| units.haptic_v_rms(measurement);
    /// The haptic force, N.
    force_n, "N", "Haptic force", "F (N)", |_, measurement| measurement.force_n;
    /// The direction of the user's push; zero where nothing measures it.
    direction, "", "Direction of the push", "direction", |_, _| 0.0;
}
