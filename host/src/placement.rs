// SPDX-License-Identifier: MIT OR Apache-2.0
//! Flags of the host's own: pads at the sheet's edge and pads that touch. The core knows neither
//! the sheet's size nor the pads'.
//!
//! | flag | is set where |
//! | --- | --- |
//! | `at_edge` | a position is at the end of the calibrated places, to within [`NEAR_MM`]; a pad that reaches over the edge reads so, too |
//! | `touching` | another pad's last position is nearer than a pad is wide, and no part of the same: both change each other's capacitance and position |
//!
//! A pad whose frame is invalid has no position: it is at no edge and touches none.

use crate::device::DeviceCalibration;

/// A position this near to the end of the calibrated places is at the edge.
pub const NEAR_MM: f64 = 1.0;

/// Where the pads are, as far as they have been read.
#[derive(Debug, Clone)]
pub struct Placement {
    /// The ends of the calibrated places along x and y.
    ends_mm: [[f64; 2]; 2],
    pad_diameter_mm: Option<f64>,
    pads: Vec<Option<[f64; 2]>>,
    /// This many of them in a row are parts of one pad.
    parts: usize,
}

impl Placement {
    /// Pads of a device, none read yet.
    pub fn new(device: &DeviceCalibration) -> Self {
        let end = |axis: usize, of: fn(f64, f64) -> f64| {
            device.map.places.iter().map(|place| place[axis]).reduce(of)
        };
        let ends = |axis| {
            [end(axis, f64::min).unwrap_or(f64::NAN), end(axis, f64::max).unwrap_or(f64::NAN)]
        };
        Placement {
            ends_mm: [ends(0), ends(1)],
            pad_diameter_mm: device.device.pad_diameter_mm,
            pads: vec![None; device.pads as usize],
            parts: device.parts.max(1) as usize,
        }
    }

    /// The flags of a pad that was read at a place, or at none. A core may serve more pads than the
    /// device was calibrated with.
    pub fn flags(
        &mut self,
        pad: usize,
        at_mm: Option<[f64; 2]>,
    ) -> impl Iterator<Item = &'static str> {
        if pad >= self.pads.len() {
            self.pads.resize(pad + 1, None);
        }
        self.pads[pad] = at_mm;
        let set =
            at_mm.map_or([false; 2], |at_mm| [self.at_edge(at_mm), self.touching(pad, at_mm)]);
        set.into_iter().zip(["at_edge", "touching"]).filter(|(set, _)| *set).map(|(_, name)| name)
    }

    fn at_edge(&self, at_mm: [f64; 2]) -> bool {
        let beyond = |(at, [low, high]): (f64, [f64; 2])| at < low + NEAR_MM || at > high - NEAR_MM;
        at_mm.into_iter().zip(self.ends_mm).any(beyond)
    }

    fn touching(&self, pad: usize, at_mm: [f64; 2]) -> bool {
        let Some(diameter_mm) = self.pad_diameter_mm else { return false };
        let others = self
            .pads
            .iter()
            .enumerate()
            .filter(|(other, _)| other / self.parts != pad / self.parts)
            .filter_map(|(_, place)| *place);
        others
            .into_iter()
            .any(|other| (other[0] - at_mm[0]).hypot(other[1] - at_mm[1]) < diameter_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placement(pad_diameter_mm: Option<f64>) -> Placement {
        Placement {
            ends_mm: [[-415.0, 415.0], [-235.0, 235.0]],
            pad_diameter_mm,
            pads: vec![None; 3],
            parts: 1,
        }
    }

    fn flags(placement: &mut Placement, pad: usize, at_mm: Option<[f64; 2]>) -> String {
        placement.flags(pad, at_mm).collect::<Vec<_>>().join("+")
    }

    #[test]
    fn pads_at_the_end_of_the_calibrated_places_are_at_the_edge() {
        let mut placement = placement(None);
        for (at_mm, expected) in [
            ([0.0, 0.0], ""),
            ([413.9, 0.0], ""),
            ([414.1, 0.0], "at_edge"),
            ([-500.0, 0.0], "at_edge"),
            ([0.0, 234.5], "at_edge"),
            ([0.0, -234.5], "at_edge"),
        ] {
            assert_eq!(flags(&mut placement, 0, Some(at_mm)), expected, "{at_mm:?}");
        }
        assert_eq!(flags(&mut placement, 0, None), "");
    }

    #[test]
    fn pads_nearer_than_they_are_wide_touch_until_one_of_them_is_lost() {
        let mut placement = placement(Some(30.0));
        assert_eq!(flags(&mut placement, 0, Some([0.0, 0.0])), "");
        assert_eq!(flags(&mut placement, 1, Some([21.0, 21.0])), "touching");
        assert_eq!(flags(&mut placement, 0, Some([0.0, 0.0])), "touching");
        assert_eq!(flags(&mut placement, 0, Some([-1.0, 0.0])), "");
        assert_eq!(flags(&mut placement, 2, Some([-1.0, 0.0])), "touching");
        assert_eq!(flags(&mut placement, 2, None), "");
        assert_eq!(flags(&mut placement, 0, Some([-1.0, 0.0])), "");
    }

    #[test]
    fn a_pad_beyond_those_of_the_calibration_has_flags_too() {
        let mut placement = placement(Some(30.0));
        assert_eq!(flags(&mut placement, 7, Some([0.0, 0.0])), "");
        assert_eq!(flags(&mut placement, 1, Some([0.0, 1.0])), "touching");
    }

    #[test]
    fn without_a_diameter_nothing_touches() {
        let mut placement = placement(None);
        flags(&mut placement, 0, Some([0.0, 0.0]));
        assert_eq!(flags(&mut placement, 1, Some([0.0, 0.0])), "");
    }
}
