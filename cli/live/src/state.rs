// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a pad in a word, and its changes as events.
//!
//! | word | when; the first that holds |
//! | --- | --- |
//! | `lost` | a terminal's current is missing, or the link is lost |
//! | `invalid` | a frame is invalid, clipped, saturated or not finite |
//! | `fault` | a fault of the controller keeps the drives at 0 V |
//! | `lifted` | the pad does not touch the sheet |
//! | `sticking` | the hand pulls outwards, and the wall has braked for 50 ms since |
//! | `limited` | the drive is at its rail, its curve or its slew, and the force short of its target |
//! | `noisy` | the force swings about its target |
//! | `in wall` | the wall brakes the pad |
//! | `free` | none of these |

use crate::protocol::{Event, PadRow, State};

/// What happens when a pad enters the state of its row from another.
fn sentence(before: State, row: &PadRow) -> String {
    let at = |value: Option<f64>, unit| {
        value.map_or(String::new(), |value| format!(" at {value:.0} {unit}"))
    };
    match (row.state, before) {
        (State::Free, State::InWall | State::Sticking) => "leaves the wall".into(),
        (State::Free, before) => format!("no longer {}", before.word()),
        (State::InWall, State::Free) => "enters the wall".into(),
        (State::InWall, before) => format!("in the wall, no longer {}", before.word()),
        (State::Noisy, _) => "the force swings".into(),
        (State::Limited, _) => format!("limited{}", at(row.drive_v_rms, "V")),
        (State::Sticking, _) => "sticks: the hand pulls out, the wall still brakes".into(),
        (State::Lifted, _) => "lifted: the pad does not touch the sheet".into(),
        (State::Fault, _) => "fault: drives off".into(),
        (State::Invalid, _) => "measurements are invalid".into(),
        (State::Lost, _) => "a terminal's current is missing".into(),
    }
}

/// What a pad's state follows from, besides the flags of its frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Signs {
    /// A measured value is not finite.
    pub not_finite: bool,
    /// A fault keeps the drives at zero.
    pub fault: bool,
    /// The wall brakes the pad.
    pub braked: bool,
    /// The drive is at its rail, and the force short of its target.
    pub limited: bool,
    /// Meanwhile the hand pulls it outwards.
    pub pulled_out: bool,
}

/// How long a wall may brake a pad that is pulled out, s of device time.
const STICKS_S: f64 = 0.05;
/// How long a state has lasted before it is an event, s of device time.
const LASTS_S: f64 = 0.02;

/// The state of one pad over time.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    pulled_since_s: Option<f64>,
    /// The state that was told last.
    told: State,
    /// Another state, and since when.
    candidate: Option<(State, f64)>,
}

impl Watch {
    /// The state at a device time.
    pub fn state(&mut self, time_s: f64, flags: &str, signs: &Signs) -> State {
        let has = |names: &[&str]| flags.split('+').any(|flag| names.contains(&flag));
        let pulled = signs.braked && signs.pulled_out;
        let since_s = *self.pulled_since_s.get_or_insert(time_s);
        if !pulled {
            self.pulled_since_s = None;
        }
        let sticks = pulled && time_s - since_s >= STICKS_S;
        let holds = [
            (has(&["lost"]), State::Lost),
            (signs.not_finite || has(&["invalid", "clipped", "saturated"]), State::Invalid),
            (signs.fault, State::Fault),
            (has(&["lifted"]), State::Lifted),
            (sticks, State::Sticking),
            (signs.limited || has(&["at_rail", "at_curve", "at_slew"]), State::Limited),
            (has(&["swings"]), State::Noisy),
            (signs.braked, State::InWall),
        ];
        holds.into_iter().find(|(holds, _)| *holds).map_or(State::Free, |(_, state)| state)
    }

    /// The event of a pad whose state has lasted for 20 ms and is another than the last event's.
    pub fn event(&mut self, time_s: f64, row: &PadRow) -> Option<Event> {
        if row.state == self.told {
            self.candidate = None;
            return None;
        }
        let since_s = match self.candidate {
            Some((state, since_s)) if state == row.state => since_s,
            _ => {
                self.candidate = Some((row.state, time_s));
                time_s
            }
        };
        if time_s - since_s < LASTS_S {
            return None;
        }
        self.candidate = None;
        let before = std::mem::replace(&mut self.told, row.state);
        let what = sentence(before, row);
        Some(Event { time_s: since_s, pad: row.pad, state: row.state, what })
    }
}
