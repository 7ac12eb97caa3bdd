// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a pad in a word; when each holds, `state.rs` says.

use schemars::JsonSchema;
use serde::Serialize;

/// A state that a client sees, from the best to the worst.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
pub enum State {
    /// Nothing acts on the pad but its load and its drive.
    #[default]
    #[serde(rename = "free")]
    Free,
    /// The wall brakes it.
    #[serde(rename = "in wall")]
    InWall,
    /// Its force swings.
    #[serde(rename = "noisy")]
    Noisy,
    /// Its force is short of its target.
    #[serde(rename = "limited")]
    Limited,
    /// The wall holds it although the hand pulls out.
    #[serde(rename = "sticking")]
    Sticking,
    /// It does not touch.
    #[serde(rename = "lifted")]
    Lifted,
    /// Its drive is off after a fault.
    #[serde(rename = "fault")]
    Fault,
    /// Its measurements mean nothing.
    #[serde(rename = "invalid")]
    Invalid,
    /// A terminal or the link is lost.
    #[serde(rename = "lost")]
    Lost,
}

impl State {
    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            State::Free => "free",
            State::InWall => "in wall",
            State::Noisy => "noisy",
            State::Limited => "limited",
            State::Sticking => "sticking",
            State::Lifted => "lifted",
            State::Fault => "fault",
            State::Invalid => "invalid",
            State::Lost => "lost",
        }
    }
}
