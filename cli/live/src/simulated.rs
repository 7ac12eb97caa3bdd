// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case of a scene that is simulated slot by slot, and its log of inputs.

use anyhow::Result;
use hapticore_run::engine::Fidelity;
use hapticore_run::stepper::{Input, Stepper};

use crate::describe;
use crate::pads::{Pads, Surface};
use crate::protocol::{
    Command, Frames, Game, Hello, Opening, Recorded, Recording, Setting, SlotCodes,
};
use crate::record::Log;
use crate::source::{Source, Step};

/// After which time a finger that is led arrives, s: less than from one picture of a page to the next.
pub const GLIDE_S: f64 = 0.012;

/// A simulated display.
pub struct Simulated {
    stepper: Stepper,
    hello: Hello,
    pads: Pads,
    /// The walls, along x first.
    walls: Vec<Surface>,
    log: Log,
    /// What pushes each pad besides its finger, N.
    pushes_n: Vec<[f64; 2]>,
    /// Rows that have been finished.
    rows: usize,
    /// Goals of the left player and of the right one.
    score: [u32; 2],
}

impl Simulated {
    /// A case before its first slot.
    ///
    /// # Errors
    /// A case that is no scene of its own.
    pub fn new(opening: Opening, fidelity: Fidelity, stepper: Stepper) -> Result<Simulated> {
        let hello = describe::hello(&opening, fidelity, &stepper)?;
        let wall = stepper.case().plan().and_then(|plan| plan.wall.as_ref());
        let along_y = wall.and_then(|wall| wall.along_y.as_ref()).map(|along_y| along_y.above);
        let sides = [wall.map(|wall| wall.right), along_y];
        let walls = sides
            .iter()
            .enumerate()
            .filter_map(|(axis, above)| Some(Surface { axis, mm: None, above: (*above)? }));
        let pads = hello.pads.len();
        let case = stepper.case();
        let document = &case.scene.cases[case.index].document;
        let log = Log::new(opening, document, (case.index, case.clock));
        Ok(Simulated {
            pads: Pads::new(pads, stepper.plant().parts_mm(), hello.hand),
            walls: walls.collect(),
            log,
            pushes_n: vec![[0.0; 2]; pads],
            rows: 0,
            score: [0; 2],
            hello,
            stepper,
        })
    }

    /// The stepper, for tests that compare.
    pub fn stepper(&self) -> &Stepper {
        &self.stepper
    }

    /// What a command is as an input.
    fn input(&self, command: &Command) -> Option<Input> {
        let push = |pad: usize, axis: usize, newtons: f64| {
            let mut push_n = self.pushes_n.get(pad).copied().unwrap_or_default();
            push_n[axis] = newtons;
            Input::Push { pad, newtons: push_n }
        };
        Some(match *command {
            Command::Lead { pad, mm, within_s } => {
                Input::Lead { pad, to_mm: mm, within_s: within_s.unwrap_or(GLIDE_S) }
            }
            Command::Release { pad } => Input::Release { pad },
            Command::Set { pad, setting } => match setting {
                Setting::LoadG(load_g) => Input::Press { pad, load_g },
                Setting::PushXN(newtons) => push(pad, 0, newtons),
                Setting::PushYN(newtons) => push(pad, 1, newtons),
                Setting::HapticVRms(v_rms) => Input::Voltage { pad, v_rms },
                Setting::TargetN(newtons) => Input::Target { pad, newtons },
            },
            Command::Target { pad, n } => Input::Target { pad, newtons: n },
            Command::Wall { x_mm, y_mm, off } => Input::Wall { x_mm, y_mm, off },
            Command::Serve => Input::Serve,
            _ => return None,
        })
    }

    fn set_walls(&mut self) {
        if let Some(own) = self.arena_walls() {
            self.walls.iter_mut().zip(own).for_each(|(wall, own)| *wall = own);
            return;
        }
        let mm = self.stepper.walls_mm();
        self.walls.iter_mut().for_each(|wall| wall.mm = mm[wall.axis]);
    }

    /// The walls of the pad of the next slot, where each has its own.
    fn arena_walls(&self) -> Option<[Surface; 2]> {
        let plant = self.stepper.plant();
        let pad = self.stepper.slot() % plant.served() / plant.parts();
        let own = self.stepper.arena_walls(pad)?;
        Some([0, 1].map(|axis| Surface { axis, mm: Some(own[axis].mm), above: own[axis].right }))
    }

    /// A goal since the last slot, in words.
    fn goal(&mut self) -> Option<String> {
        let score = self.stepper.game()?.score();
        let before = std::mem::replace(&mut self.score, score);
        let [left, right] = score;
        let scorer = if score[0] > before[0] { "left" } else { "right" };
        (score != before).then(|| format!("Goal of the {scorer} player: {left} to {right}"))
    }
}

impl Source for Simulated {
    fn hello(&self) -> Hello {
        self.hello.clone()
    }

    fn slot(&self) -> usize {
        self.stepper.slot()
    }

    fn slot_s(&self) -> f64 {
        self.stepper.case().clock.seconds(1)
    }

    fn inputs(&self) -> usize {
        self.log.len()
    }

    fn apply(&mut self, command: &Command) -> Result<(), String> {
        let input = self.input(command).ok_or("expected an input of the scene")?;
        self.stepper.apply(&input).map_err(|error| error.to_string())?;
        if let Input::Push { pad, newtons } = input {
            self.pushes_n[pad] = newtons;
        }
        self.log.add(self.stepper.slot(), input);
        Ok(())
    }

    fn advance(&mut self) -> Result<Step, String> {
        self.set_walls();
        let Some(row) = self.stepper.step().map_err(|error| format!("{error:#}"))? else {
            return Ok(Step::default());
        };
        let event = self.pads.add(&row, &self.walls);
        self.rows += 1;
        Ok(Step { row: Some((self.rows - 1, row)), event, note: self.goal(), ..Step::default() })
    }

    fn frames(&self) -> Frames {
        let time_s = self.stepper.time_s();
        let mm = self.stepper.walls_mm();
        let (mut terminals, voltages) = (self.stepper.amplitudes(), 2);
        let voltages = terminals.split_off(terminals.len().saturating_sub(voltages));
        Frames {
            slot: self.stepper.slot(),
            time_s,
            pads: self.pads.rows(time_s),
            terminals,
            voltages,
            walls: self.hello.walls.iter().zip(mm).map(|(_, mm)| mm).collect(),
            game: self.stepper.game().map(|game| Game {
                puck_mm: game.puck().place_mm,
                puck_mm_s: game.puck().velocity_mm_s,
                score: game.score(),
            }),
        }
    }

    fn codes(&self) -> SlotCodes {
        describe::codes(&self.stepper)
    }

    fn record(&self, to: Recording) -> Result<Recorded, String> {
        let slots = self.stepper.slot();
        match to {
            Recording::Log => self.log.text(slots),
            _ => self.log.scene(slots, &self.stepper),
        }
    }
}
