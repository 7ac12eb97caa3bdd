// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a page watches and leads.

use hapticore_run::record::Row;

use crate::protocol::{Command, Event, Frames, Hello, LineStatus, Recorded, Recording, SlotCodes};

/// A display that advances slot by slot.
pub trait Source: Send {
    /// All that does not change.
    fn hello(&self) -> Hello;

    /// Number of the next slot.
    fn slot(&self) -> usize;

    /// Length of a slot, s.
    fn slot_s(&self) -> f64;

    /// How many inputs have been applied.
    fn inputs(&self) -> usize;

    /// Applies an input before the next slot.
    ///
    /// # Errors
    /// What was expected; nothing has changed then.
    fn apply(&mut self, command: &Command) -> Result<(), String>;

    /// Runs the next slot.
    ///
    /// # Errors
    /// Why no slot can be run any more.
    fn advance(&mut self) -> Result<Step, String>;

    /// The latest frame of each pad.
    fn frames(&self) -> Frames;

    /// The ADC codes of the last slot.
    fn codes(&self) -> SlotCodes;

    /// All inputs since the first slot.
    ///
    /// # Errors
    /// Why they cannot be written so.
    fn record(&self, to: Recording) -> Result<Recorded, String>;

    /// Its time is that of the world: it runs on without clients, and no client stops, steps or replaces it.
    fn is_real(&self) -> bool {
        false
    }

    /// The line to a board, where it has one.
    fn line(&self) -> Option<LineStatus> {
        None
    }
}

/// What a slot has led to.
#[derive(Debug, Default)]
pub struct Step {
    /// A row that is finished, and the number of its slot.
    pub row: Option<(usize, Row)>,
    /// A pad has changed its state.
    pub event: Option<Event>,
    /// Something that all clients should read.
    pub note: Option<String>,
    /// More has happened already: the next step takes no time.
    pub more: bool,
}
