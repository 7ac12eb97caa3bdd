// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a check and a calibration need of a board: its start-up, pads at places, frames.
//!
//! Frames carry no currents, only ratios and the sum of currents per sensing voltage. So both begin with a
//! calibration with which they are valid anywhere.

mod device_time;
mod real_time;
mod stepped;

use anyhow::{Result, ensure};
use hapticore_contract::calibration::{Calibration, Point, PositionTable};
use hapticore_contract::profile::Profile;
use hapticore_host::startup::{AdcSetup, LineFault};
use hapticore_host::{DeviceCalibration, Packet};

pub use device_time::DeviceTime;
pub use real_time::RealTime;
pub use stepped::SteppedBoard;

/// Frames in which each pad has come, some seconds of them.
const MOST_FRAMES: usize = 1 << 16;
/// The first frames after pads were moved are of the motion.
pub(crate) const MOVING: usize = 4;
/// How long pads take to a place, s.
pub(super) const MOVES_S: f64 = 0.2;
/// How long pads that hang on a finger swing, s.
pub(super) const SWINGS_S: f64 = 0.3;

/// A place, mm from the sheet's centre.
pub type Place = [f64; 2];

/// A board, and pads that can be put somewhere.
pub trait Bench {
    /// The profile of the board.
    fn profile(&self) -> &Profile;

    /// Where the parts of a pad lie, mm from its centre.
    fn parts_mm(&self) -> &[Place];

    /// Brings the board up with a calibration, its drive off, after a test of its data lines where `lines`. It is enabled,
    /// unless a data line has failed.
    ///
    /// # Errors
    /// A board that does not start up for another reason.
    fn bring_up(
        &mut self,
        calibration: &Calibration,
        adc: &AdcSetup,
        lines: bool,
    ) -> Result<Vec<(u8, LineFault)>>;

    /// Puts each pad at a place.
    ///
    /// # Errors
    /// A place off the sheet; a user who has gone.
    fn put(&mut self, places: &[Place]) -> Result<()>;

    /// The next frames, one at least.
    ///
    /// # Errors
    /// A board that sends none any more.
    fn next_frames(&mut self) -> Result<Vec<Packet>>;

    /// Frames from now on, this many of each pad at least.
    ///
    /// # Errors
    /// A board that sends none any more, or none of a pad.
    fn frames(&mut self, of_each: usize) -> Result<Vec<Packet>> {
        let mut counts = vec![0; self.profile().pads as usize];
        let mut packets: Vec<Packet> = Vec::new();
        while counts.iter().any(|count| *count < of_each) {
            let new = self.next_frames()?;
            new.iter().for_each(|packet| counts[packet.frame.pad] += 1);
            packets.extend(new);
            ensure!(packets.len() < MOST_FRAMES, "expected frames of all pads");
        }
        Ok(packets)
    }

    /// Says what is done.
    fn tell(&mut self, text: &str);
}

/// A calibration with which every pair of ratios is a valid measurement, and none is lifted or lost.
pub(crate) fn for_any_ratios(profile: &Profile, device: &DeviceCalibration) -> Result<Calibration> {
    const SIDE: i32 = 9;
    let ratio = |k: i32| 2.2 * f64::from(k) / f64::from(SIDE - 1) - 1.1;
    let points = (0..SIDE * SIDE).map(|k| {
        let [r_x, r_y] = [ratio(k % SIDE), ratio(k / SIDE)];
        Point { x: 100.0 * r_x, y: 100.0 * r_y, r_x, r_y, sheet: 0.0 }
    });
    let own = device.for_profile(profile)?;
    let position = PositionTable::fit(profile, &points.collect::<Vec<_>>())?;
    Ok(Calibration { position: position.with_open_share(0.0), contact_capacitance: 0.0, ..own })
}

/// Means of both ratios and of the capacitance, pF, of a pad's frames, without those of the motion before; none where half
/// of them are invalid.
pub(crate) fn mean_of(packets: &[Packet], pad: usize, profile: &Profile) -> Option<[f64; 3]> {
    let of_pad = packets.iter().filter(|packet| packet.frame.pad == pad).skip(MOVING);
    let of_pad: Vec<_> = of_pad.collect();
    let valid = of_pad.iter().filter(|packet| !packet.frame.flags.invalid);
    let readings = valid.map(|packet| packet.frame.measurement(profile));
    let readings: Vec<_> = readings.map(|of| [of.r_x, of.r_y, of.capacitance_pf]).collect();
    let mean = |k: usize| readings.iter().map(|of| of[k]).sum::<f64>() / readings.len() as f64;
    (2 * readings.len() > of_pad.len()).then(|| [0, 1, 2].map(mean))
}
