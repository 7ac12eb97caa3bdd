// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a design holds, at reset and later.

use super::terms::Terms;
use hapticore_hdl::interpretations::netlist::mutants::Start;
use hapticore_hdl::interpretations::netlist::{Named, Netlist, Node, Ram};
use std::ops::Range;

/// An instance of a module: where what it holds lies, with all that the instances within it hold.
#[derive(Debug, Clone)]
pub(super) struct Unit {
    /// The same for the instance of every design.
    pub(super) number: usize,
    pub(super) module: usize,
    pub(super) registers: Range<usize>,
    pub(super) memories: Range<usize>,
    /// Where its registers begin in the sound design: a mutant may have more of them.
    pub(super) in_sound: usize,
    pub(super) instances: Vec<Unit>,
    /// Inputs and outputs of the clock before, if nothing that it holds has changed in it.
    pub(super) quiet: Option<(Vec<Node>, Vec<Node>)>,
    /// It has no mutant.
    pub(super) sound: bool,
    /// It holds what the sound design's holds.
    pub(super) equal: bool,
}

/// What registers, read registers of memories, and memories hold.
#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    pub(super) registers: Vec<Node>,
    pub(super) data: Vec<Node>,
    pub(super) words: Vec<Vec<Node>>,
}

/// A design, and what it holds.
#[derive(Debug, Clone)]
pub(super) struct Design {
    pub(super) netlist: Netlist,
    pub(super) top: Unit,
    pub(super) held: Held,
}

impl Design {
    /// A design at reset, with registers that start with other codes than zero; `sound` is the design of which it is a mutant.
    pub(super) fn new(
        terms: &mut Terms,
        netlist: Netlist,
        starts: &[Start],
        sound: Option<&Design>,
    ) -> Self {
        let mut held = Held::default();
        let mut reset = Reset { terms, netlist: &netlist, starts, sound, units: 0, in_sound: 0 };
        let top = reset.unit(netlist.modules.len() - 1, &mut held);
        Design { netlist, top, held }
    }

    /// All registers, those of instances among them, in the order in which they are held.
    pub(super) fn registers(&self) -> impl Iterator<Item = Register<'_>> {
        let mut all = Vec::new();
        self.top.registers(&self.netlist, &mut all);
        all.sort_by_key(|register| register.place);
        all.into_iter()
    }
}

/// A register of a design.
pub(super) struct Register<'a> {
    /// Where it is held, and where the sound design holds it, if that has it.
    pub(super) place: usize,
    pub(super) in_sound: usize,
    /// Its module, and which of its registers it is.
    pub(super) module: usize,
    pub(super) own: usize,
    pub(super) named: &'a Named,
}

impl Unit {
    /// Where the registers lie in the sound design.
    fn of_sound(&self) -> Range<usize> {
        self.in_sound..self.in_sound + self.registers.len()
    }

    /// The outputs, where nothing has changed in the clock before and the inputs do not, either. The sound design may go on.
    pub(super) fn as_before(&mut self, inputs: &[Node]) -> Option<Vec<Node>> {
        let (_, outputs) = self.quiet.as_ref().filter(|(before, _)| before == inputs)?;
        let outputs = outputs.clone();
        self.part();
        Some(outputs)
    }

    /// Nothing is known of the clock before.
    pub(super) fn renew(&mut self) {
        self.wake();
        self.part();
    }

    fn registers<'a>(&self, netlist: &'a Netlist, all: &mut Vec<Register<'a>>) {
        let module = self.module;
        let named = netlist.modules[module].registers.iter().enumerate();
        all.extend(named.map(|(own, named)| Register {
            place: self.registers.start + own,
            in_sound: self.in_sound + own,
            module,
            own,
            named,
        }));
        self.instances.iter().for_each(|unit| unit.registers(netlist, all));
    }

    fn part(&mut self) {
        self.equal = false;
        self.instances.iter_mut().for_each(Unit::part);
    }

    pub(super) fn wake(&mut self) {
        self.quiet = None;
        self.instances.iter_mut().for_each(Unit::wake);
    }
}

impl Held {
    /// Takes what the sound design's instance holds.
    pub(super) fn copy(&mut self, unit: &Unit, sound: &Held) {
        let (own, memories) = (unit.registers.clone(), unit.memories.clone());
        self.registers[own].copy_from_slice(&sound.registers[unit.of_sound()]);
        self.data[memories.clone()].copy_from_slice(&sound.data[memories.clone()]);
        self.words[memories.clone()].clone_from_slice(&sound.words[memories]);
    }

    /// Whether the sound design's instance holds the same.
    pub(super) fn equals(&self, unit: &Unit, sound: &Held) -> bool {
        let memories = || unit.memories.clone();
        self.registers[unit.registers.clone()] == sound.registers[unit.of_sound()]
            && self.data[memories()] == sound.data[memories()]
            && self.words[memories()] == sound.words[memories()]
    }

    pub(super) fn each_mut(&mut self) -> impl Iterator<Item = &mut Node> {
        let words = self.words.iter_mut().flatten();
        self.registers.iter_mut().chain(&mut self.data).chain(words)
    }
}

/// Makes what a design holds at reset.
struct Reset<'a> {
    terms: &'a mut Terms,
    netlist: &'a Netlist,
    starts: &'a [Start],
    sound: Option<&'a Design>,
    units: usize,
    /// Registers of the sound design so far.
    in_sound: usize,
}

impl Reset<'_> {
    fn unit(&mut self, module: usize, held: &mut Held) -> Unit {
        let of = &self.netlist.modules[module];
        let (registers, memories) = (held.registers.len(), held.data.len());
        let (number, in_sound) = (self.units, self.in_sound);
        let like = self.sound.map_or(of, |sound| &sound.netlist.modules[module]);
        self.units += 1;
        self.in_sound += like.registers.len();
        for (register, named) in of.registers.iter().enumerate() {
            let starts = self.starts.iter();
            let mut start = starts.filter(|own| (own.module, own.register) == (module, register));
            held.registers.push(match start.next() {
                Some(start) => self.terms.constant(start.code, named.format),
                None if of.resets => self.terms.constant(0, named.format),
                None => self.terms.unknown(named.format),
            });
        }
        for ram in &of.memories {
            held.data.push(self.terms.unknown(ram.format));
            let words = match self.sound {
                _ if ram.write.is_none() => self.table(ram),
                Some(sound) => sound.held.words[held.words.len()].clone(),
                None => ram.initial.iter().map(|_| self.terms.unknown(ram.format)).collect(),
            };
            held.words.push(words);
        }
        let instances: Vec<Unit> =
            of.instances.iter().map(|own| self.unit(own.module, held)).collect();
        Unit {
            number,
            module,
            registers: registers..held.registers.len(),
            memories: memories..held.data.len(),
            in_sound,
            sound: like == of && instances.iter().all(|unit| unit.sound),
            instances,
            quiet: None,
            equal: false,
        }
    }

    fn table(&mut self, ram: &Ram) -> Vec<Node> {
        ram.initial.iter().map(|&code| self.terms.constant(code, ram.format)).collect()
    }
}
