// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a bench in device time needs of a board: bytes in and out, time that passes, and the simulated device at its pins.

use anyhow::Result;
use hapticore_contract::profile::Profile;
use hapticore_host::Output;
use hapticore_scene::Plant;

use crate::virtual_board::VirtualBoard;

/// A board whose time passes as its program says.
pub trait SteppedBoard {
    /// The profile that it was printed for.
    fn profile(&self) -> &Profile;

    /// What it drives its pads with, where it has a drive.
    fn output(&self) -> Option<Output>;

    /// Its device time, s.
    fn now_s(&self) -> f64;

    /// The device at its pins.
    fn plant(&mut self) -> &mut Plant;

    /// Holds the pads still from now on, with the scene's mean load, without a push and without a drive.
    fn hold_still(&mut self);

    /// Takes bytes of the host; time may pass until it has them all.
    ///
    /// # Errors
    /// As [`SteppedBoard::advance`].
    fn receive(&mut self, bytes: &[u8]) -> Result<()>;

    /// Lets time pass up to a device time, s.
    ///
    /// # Errors
    /// A drive that the device does not take.
    fn advance(&mut self, until_s: f64) -> Result<()>;

    /// The same while it is disabled: a board whose clock costs time may leave it out.
    ///
    /// # Errors
    /// As [`SteppedBoard::advance`].
    fn rest(&mut self, until_s: f64) -> Result<()> {
        self.advance(until_s)
    }

    /// The bytes that it has sent since they were taken last.
    fn take_bytes(&mut self) -> Vec<u8>;
}

impl SteppedBoard for VirtualBoard {
    fn profile(&self) -> &Profile {
        VirtualBoard::profile(self)
    }

    fn output(&self) -> Option<Output> {
        self.made().output
    }

    fn now_s(&self) -> f64 {
        VirtualBoard::now_s(self)
    }

    fn plant(&mut self) -> &mut Plant {
        VirtualBoard::plant(self)
    }

    fn hold_still(&mut self) {
        VirtualBoard::hold_still(self);
    }

    fn receive(&mut self, bytes: &[u8]) -> Result<()> {
        VirtualBoard::receive(self, bytes);
        Ok(())
    }

    fn advance(&mut self, until_s: f64) -> Result<()> {
        VirtualBoard::advance(self, until_s)
    }

    fn take_bytes(&mut self) -> Vec<u8> {
        VirtualBoard::take_bytes(self)
    }
}
