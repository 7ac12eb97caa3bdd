// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hands at a virtual wall: the simulated device in a loop with a wall's rule, frame by frame, and
//! what the hand feels of it.
//!
//! | module | does |
//! | --- | --- |
//! | [`hand`] | hands drawn at random, and what each does at the wall |
//! | [`device`] | the pad that it moves, and the drive that makes a force of a target |
//! | [`clocked`] | the wall's block as a rule |
//! | [`core`] | the same hands at a wall in the core, through its sensor chain |
//! | [`trial`] | one hand, one rule: the loop |
//! | [`measures`] | sticking force, release time, flips, bursts of them, vanished walls |
//! | [`latency`] | how soon the wall is felt and releases, and how much it stands out |
//! | [`slide`] | what a hand feels that slides along the surface |
//! | [`stiffness`] | how stiff the wall is to a hand that presses |
//!
//! The wall's surface is at x = 0 of the sheet, its inside at x < 0. A frame is one slot of one pad:
//! the plant is measured in its middle, and the drive that follows from it holds from 30 µs behind
//! its end. The plant and the measures share
//! no code with the rules (`hapticore_reference::wall`) and the wall's block.

pub mod clocked;
pub mod core;
pub mod device;
pub mod hand;
pub mod latency;
pub mod measures;
pub mod slide;
pub mod stiffness;
pub mod trial;
