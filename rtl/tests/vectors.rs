// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vectors that users of the Verilog have (`rtl/verilog/vectors/`) notice faults of hardware: missing resets and
//! clears, sticky flags, bits held for a cycle, stale operands. The faults are made in the netlist of the core of
//! `small`, which is clocked as it stands. What `rtl/verilog/cocotb/bench.v` compares is compared here.
//!
//! `cargo test --profile checked -p hapticore-rtl --test vectors -- --ignored --nocapture` judges what does not obey `clear`,
//! with `MUTANTS=all` every mutant, with `MUTANTS=200` so many at random.

#[path = "../../model/tests/equality/random.rs"]
#[allow(dead_code, reason = "places are drawn at random, no words")]
mod random;

use hapticore_contract::profile::Profile;
use hapticore_hdl::interpretations::netlist::mutants::Mutant;
use hapticore_hdl::interpretations::netlist::simulation::Simulation;
use hapticore_hdl::interpretations::netlist::{Named, Netlist};
use hapticore_model::blocks::core::Core;
use random::Random;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;

/// Clocks after the last sample, as in the bench: the last slot's estimate.
const REST: usize = 10_000;

/// The files, each a row of numbers; `what` of the calibration apart.
struct Vectors {
    samples: Vec<Vec<i64>>,
    frames: Vec<Vec<i64>>,
    pins: Vec<Vec<i64>>,
    /// Row of the samples before which it is, what, code.
    calibration: Vec<(usize, String, i64)>,
}

fn lines(name: &str) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("verilog/vectors").join(name);
    let text = std::fs::read_to_string(path).expect("a committed file");
    let cells = |line: &str| line.split(',').map(str::to_string).collect();
    text.lines().skip(1).map(cells).collect()
}

fn number(cell: &str) -> i64 {
    cell.parse().expect("an integer")
}

impl Vectors {
    fn read() -> Self {
        let numbers = |name| {
            lines(name).iter().map(|row| row.iter().map(|cell| number(cell)).collect()).collect()
        };
        let [samples, frames, pins] = ["samples.csv", "frames.csv", "pins.csv"].map(numbers);
        let calibration = lines("calibration.csv").into_iter();
        let calibration = calibration
            .map(|row| (number(&row[0]) as usize, row[1].clone(), number(&row[2])))
            .collect();
        Vectors { samples, frames, pins, calibration }
    }
}

/// The ports of a core by name.
struct Ports<'a> {
    inputs: &'a [Named],
    outputs: &'a [Named],
}

impl Ports<'_> {
    fn input(&self, name: &str) -> usize {
        self.inputs.iter().position(|port| port.name == name).expect("a port of the core")
    }

    fn outputs<const N: usize>(&self, names: [&str; N]) -> [usize; N] {
        let of = |name| self.outputs.iter().position(|port| port.name == name);
        names.map(|name| of(name).expect("a port of the core"))
    }
}

/// A core, and how far the vectors are.
struct Bench<'a> {
    vectors: &'a Vectors,
    ports: &'a Ports<'a>,
    core: Simulation,
    inputs: Vec<i64>,
    outputs: [usize; 5],
    frame: [usize; 8],
    valid_and_channel: [usize; 2],
    channel: usize,
    clock: i64,
    pins: usize,
    frames: usize,
}

/// The core does not do what the vectors say.
struct Noticed;

impl<'a> Bench<'a> {
    fn new(vectors: &'a Vectors, ports: &'a Ports<'a>, core: Simulation) -> Self {
        Bench {
            vectors,
            ports,
            core,
            inputs: vec![0; ports.inputs.len()],
            outputs: ports.outputs(["serve", "closed", "carrier", "done", "overrun"]),
            frame: ports.outputs([
                "pad",
                "index",
                "frame",
                "clipped",
                "saturated",
                "invalid",
                "lost",
                "lifted",
            ]),
            valid_and_channel: ports.outputs(["valid", "channel"]),
            channel: 0,
            clock: 0,
            pins: 0,
            frames: 0,
        }
    }

    fn set(&mut self, name: &str, code: i64) {
        let port = self.ports.input(name);
        self.inputs[port] = code;
    }

    /// One clock: pins are those of their row, a word of a frame that of the next.
    fn tick(&mut self) -> Result<(), Noticed> {
        let outputs = self.core.clock(&self.inputs);
        let pins = &self.vectors.pins;
        while pins.get(self.pins + 1).is_some_and(|next| next[0] <= self.clock) {
            self.pins += 1;
        }
        self.clock += 1;
        let same = |places: &[usize], row: &[i64]| {
            places.iter().zip(row).all(|(&place, &code)| outputs[place] == code)
        };
        if !same(&self.outputs, &pins[self.pins][1..]) {
            return Err(Noticed);
        }
        let [valid, channel] = self.valid_and_channel.map(|place| outputs[place]);
        self.channel = channel as usize;
        if valid != 0 {
            let row = self.vectors.frames.get(self.frames).ok_or(Noticed)?;
            self.frames += 1;
            return if same(&self.frame, row) { Ok(()) } else { Err(Noticed) };
        }
        Ok(())
    }

    /// What the calibration says before a row of samples; the clocks per sample.
    fn calibrate(&mut self, next: &mut usize, row: usize, period: &mut i64) -> Result<(), Noticed> {
        while let Some((_, what, code)) =
            self.vectors.calibration.get(*next).filter(|(at, ..)| *at == row)
        {
            *next += 1;
            match what.as_str() {
                "clocks" => *period = *code,
                "clear" => self.pulse("clear")?,
                "capacitance_gain" | "force_gain" | "contact_capacitance" => self.set(what, *code),
                address => {
                    self.set("address", number(address));
                    self.set("word", *code);
                    self.pulse("write")?;
                }
            }
        }
        Ok(())
    }

    fn pulse(&mut self, name: &str) -> Result<(), Noticed> {
        self.set(name, 1);
        self.tick()?;
        self.set(name, 0);
        Ok(())
    }

    /// All vectors.
    fn run(mut self, period: i64) -> Result<(), Noticed> {
        let (mut next, mut period) = (0, period);
        for (row, codes) in self.vectors.samples.iter().enumerate() {
            self.calibrate(&mut next, row, &mut period)?;
            for step in 0..period {
                self.set("strobe", i64::from(step == 0));
                self.set("code", codes.get(self.channel).copied().unwrap_or(0));
                self.tick()?;
            }
        }
        (0..REST).try_for_each(|_| self.tick())?;
        if self.frames == self.vectors.frames.len() { Ok(()) } else { Err(Noticed) }
    }
}

/// Mutants that are proved to be equivalent (`docs/mutation.md`).
const EQUIVALENT: [&str; 2] = ["equivalent.txt", "equivalent_in_cores.txt"];

/// Whether a proof shows that a mutant changes no output of a core.
fn is_equivalent(netlist: &Netlist, mutant: &Mutant) -> bool {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../model/src/blocks");
    let text = |list| std::fs::read_to_string(folder.join(list)).expect("a list of mutants");
    let name = mutant.to_string();
    let of = |index: usize| Netlist { modules: netlist.modules[..=index].to_vec() };
    let mut blocks = (0..netlist.modules.len())
        .filter(|&index| netlist.modules[index].name == mutant.module)
        .map(of)
        .filter(|block| Mutant::all(block, block.top()).contains(mutant));
    EQUIVALENT.map(text).iter().any(|list| list.lines().any(|line| line == name))
        || blocks.all(|block| mutant.is_equivalent(&block))
}

/// Which mutants are judged: those of `clear`; with `MUTANTS=all` each; with `MUTANTS=200` so many at random.
fn chosen(netlist: &Netlist) -> Vec<Mutant> {
    let mut all: Vec<Mutant> =
        netlist.modules.iter().flat_map(|module| Mutant::all(netlist, module)).collect();
    match std::env::var("MUTANTS").map(|of| of.parse::<u64>()) {
        Err(_) => all.retain(|mutant| mutant.place.ends_with(" of clear")),
        Ok(Err(_)) => (),
        Ok(Ok(count)) => {
            let mut random = Random::new(1);
            let mut draw = || all.swap_remove(random.below(all.len() as u64) as usize);
            return (0..count).map(|_| draw()).collect();
        }
    }
    all
}

/// What became of the mutants of a class: all, noticed, missed though not proved to be equivalent.
type Count = [usize; 3];

#[test]
#[ignore = "takes minutes; of a clear that is missing in the multiplexer the vectors see too little"]
fn mutants_of_the_netlist_are_noticed_by_the_vectors() {
    let profile = Profile::bundled("small").expect("bundled");
    let (netlist, vectors) = (Netlist::of(&Core::new(&profile)), Vectors::read());
    let top = netlist.top();
    let ports = Ports { inputs: &top.inputs, outputs: &top.outputs };
    let passes =
        |core| Bench::new(&vectors, &ports, core).run(profile.clocks_per_sample as i64).is_ok();
    assert!(passes(Simulation::new(netlist.clone())), "without a fault");
    let open = Mutex::new(chosen(&netlist).into_iter());
    let counts = Mutex::new(BTreeMap::<_, Count>::new());
    let work = || {
        loop {
            let next = open.lock().expect("no panic").next();
            let Some(mutant) = next else { return };
            let name = mutant.to_string();
            let noticed = !passes(Mutant::simulation(&netlist, &name).expect("a mutant of it"));
            let missed = !noticed && !is_equivalent(&netlist, &mutant);
            let mut counts = counts.lock().expect("no panic");
            let count = counts.entry((mutant.module, mutant.class)).or_default();
            *count = sum(*count, [1, usize::from(noticed), usize::from(missed)]);
            if missed {
                println!("missed: {name}");
            }
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    let counts = counts.into_inner().expect("no panic");
    let mut classes = BTreeMap::<&str, Count>::new();
    for ((module, class), count) in &counts {
        println!("{module}, {class}: {}", shown(*count));
        let of = classes.entry(class).or_default();
        *of = sum(*of, *count);
    }
    classes.iter().for_each(|(class, count)| println!("{class}: {}", shown(*count)));
    let all = counts.values().fold([0; 3], |all, count| sum(all, *count));
    println!("all: {}", shown(all));
    let [_, noticed, missed] = all;
    assert!(noticed >= 19 * missed, "at least 95 %: {}", shown(all));
}

fn sum(a: Count, b: Count) -> Count {
    std::array::from_fn(|k| a[k] + b[k])
}

fn shown([all, noticed, missed]: Count) -> String {
    let equivalent = all - noticed - missed;
    format!("{noticed} of {all} noticed, {equivalent} proved equivalent, {missed} missed")
}
