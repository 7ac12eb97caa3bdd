// SPDX-License-Identifier: MIT OR Apache-2.0
//! The wall's block, clock by clock, as a rule of the bench: what its words cost.

use hapticore_contract::profile::{self, Profile};
use hapticore_hdl::block::{Block, State};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::code;
use hapticore_model::blocks::wall::{Inputs, Wall};
use hapticore_reference::wall::{Direction, Frame, Rule, Stiffness, Target};

/// The block of a profile, on its first pad.
pub struct Clocked {
    block: Wall,
    state: State<Wall, i64>,
    formats: Inputs<Format>,
    stiffness: Stiffness,
    factory: f64,
}

impl Clocked {
    /// The block of a bundled profile with a rule.
    ///
    /// # Panics
    /// Where there is no such profile.
    pub fn new(profile: &str, rule: profile::Wall, stiffness: Stiffness, factory: f64) -> Self {
        let bundled = Profile::bundled(profile).expect("bundled");
        let block = Wall::try_new(&Profile { wall: Some(rule), ..bundled }).expect("it fits");
        let (state, formats) = (block.reset(), block.inputs());
        Clocked { block, state, formats, stiffness, factory }
    }
}

impl Rule for Clocked {
    fn frame(&mut self, frame: &Frame) -> (Target, Direction) {
        let f = self.formats;
        let held = Inputs {
            start: 0,
            pad: 0,
            restart: 0,
            c_left: f.c_left.code_saturating(frame.left),
            c_right: f.c_right.code_saturating(frame.right),
            x: f.x.code_saturating(frame.x_mm),
            along: f.along.code_saturating(frame.along_mm),
            other_free: 0,
            at_zero: frame.at_zero.into(),
            stiffness: f.stiffness.code_saturating(self.stiffness.n_per_mm),
            most: f.most.code_saturating(self.stiffness.most_n),
            factory: f.factory.code_saturating(self.factory),
        };
        let mut inputs = Inputs { start: 1, ..held };
        loop {
            let signals =
                <Inputs as Bundle>::map(<Inputs as Bundle>::zip(inputs, f), |(word, format)| {
                    code(word, format)
                });
            let out = self.block.clock(&mut self.state, signals);
            if out.done.value == 1 {
                let force_n = f.most.real(out.target.value);
                let direction = if out.free.value == 1 { Direction::Free } else { Direction::Push };
                return (Target::Force(force_n), direction);
            }
            inputs = held;
        }
    }
}
