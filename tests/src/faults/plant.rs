// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes faults into a design, each asleep until its number is called.

use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use hapticore_hdl::verilog::{Design, File};
use regex::Regex;

use super::kinds::{Variant, variants};
use super::statements::{Statement, statements, unused};
use super::word::Word;
use super::{Fault, Kind};

/// A design with faults, number 1 the first.
#[derive(Debug, Clone)]
pub struct Planted {
    /// Verilog with all mutants, enabled by number.
    pub verilog: String,
    /// The mutants, in the order of their numbers.
    pub faults: Vec<Fault>,
}

impl Planted {
    /// Every fault of every module.
    pub fn new(design: &Design) -> Planted {
        Planted::with(design, &|_| true)
    }

    /// As [`Planted::new`], with the same numbers, but only these are written: so it compiles and
    /// runs in a fraction of the time.
    pub fn with(design: &Design, written: &dyn Fn(usize) -> bool) -> Planted {
        let mut faults = Vec::new();
        let plant = |file: &File| Module::new(file, &mut faults, written).planted(&file.text);
        Planted { verilog: design.modules.iter().map(plant).collect(), faults }
    }

    /// The Verilog of one module with those within it, as `alone`: Verilator takes no port with the
    /// name of the top module.
    ///
    /// # Panics
    /// Where there is no such module.
    pub fn alone(&self, module: &str) -> String {
        let (before, rest) =
            self.verilog.split_once(&format!("module {module} (")).expect("a module");
        let (within, _) = rest.split_once("endmodule").expect("a module's end");
        format!("{before}module alone ({within}endmodule\n")
    }
}

/// A module while it is written.
struct Module<'a> {
    name: &'a str,
    ranges: HashMap<String, String>,
    unused: HashSet<String>,
    /// Wires between blocks.
    driven: HashSet<String>,
    /// The instance that is being written.
    instance: String,
    faults: &'a mut Vec<Fault>,
    /// Which are written.
    written: &'a dyn Fn(usize) -> bool,
}

/// What wakes a fault.
const HEAD: &str =
    "\n    integer fault;\n    initial if (!$value$plusargs(\"fault=%d\", fault)) fault = 0;\n";

impl<'a> Module<'a> {
    fn new(file: &'a File, faults: &'a mut Vec<Fault>, written: &'a dyn Fn(usize) -> bool) -> Self {
        let port =
            Regex::new(r"output wire ((?:signed )?(?:\[\d+:0\] )?)(\w+)").expect("an expression");
        let ranges = port.captures_iter(&file.text).map(|c| (c[2].into(), c[1].into())).collect();
        Module {
            name: &file.name,
            ranges,
            unused: unused(&file.text),
            driven: HashSet::new(),
            instance: String::new(),
            faults,
            written,
        }
    }

    fn planted(&mut self, text: &str) -> String {
        let (head, body) = text.split_once("\n);\n").expect("a head");
        let head =
            head.lines().filter(|line| !line.starts_with("//")).collect::<Vec<_>>().join("\n");
        let mut text = format!("{head}\n);\n{HEAD}");
        for statement in statements(body) {
            text += &self.statement(statement);
            text.push('\n');
        }
        text
    }

    fn statement(&mut self, statement: Statement) -> String {
        match statement {
            Statement::Wire { range, name, value } => {
                self.wire(&range, &name, &value) + &format!("wire {range}{name} = {name}_given;\n")
            }
            Statement::Output { name, value } => {
                let range = self.ranges[&name].clone();
                self.wire(&range, &name, &value) + &format!("assign {name} = {name}_given;\n")
            }
            Statement::Driven { range, name } => self.driven(&range, &name),
            Statement::Register { name, value } => self.register(&name, &value),
            Statement::Condition { value, rest } => self.condition(&value, &rest),
            Statement::Other(code) => self.other(code),
        }
    }

    /// A number for a fault, where it is written.
    fn number(&mut self, name: &str, kind: Kind, printed: &str, instead: &str) -> Option<usize> {
        let [module, name, printed, instead] =
            [self.name, name, printed, instead].map(str::to_owned);
        self.faults.push(Fault { module, name, kind, printed, instead });
        let number = self.faults.len();
        (self.written)(number).then_some(number)
    }

    fn numbered(&mut self, name: &str, variants: Vec<Variant>) -> Vec<(usize, String)> {
        let mut number =
            |v: Variant| Some((self.number(name, v.kind, &v.printed, &v.instead)?, v.text));
        variants.into_iter().filter_map(&mut number).collect()
    }

    /// `NAME_given`: what was printed, or one of its faults.
    fn wire(&mut self, range: &str, name: &str, value: &str) -> String {
        let mut text = format!("wire {range}{name}_true = {value};\n");
        let mut given = String::new();
        let word = Word::new(range, name, value, &self.unused);
        let (variants, narrow) = (word.variants(), word.narrow());
        for (number, value) in self.numbered(name, variants) {
            let _ = writeln!(text, "wire {range}{name}_{number} = {value};");
            let _ = write!(given, "fault == {number} ? {name}_{number} : ");
        }
        for narrow in narrow {
            let Some(number) = self.number(name, Kind::Width, name, &narrow) else { continue };
            let _ = writeln!(text, "wire {range}{name}_{number} = {narrow};");
            let _ = write!(given, "fault == {number} ? {name}_{number} : ");
        }
        let (late, value) = self.late(range, name);
        text + &late + &format!("wire {range}{name}_given = {given}{value};\n")
    }

    /// A register for the value of the clock before, and the value with that fault.
    fn late(&mut self, range: &str, name: &str) -> (String, String) {
        let Some(number) = self.number(name, Kind::Latency, name, "the same of the clock before")
        else {
            return (String::new(), format!("{name}_true"));
        };
        let register = format!(
            "reg {range}{name}_late;\nalways @(posedge clock) {name}_late <= {name}_true;\n"
        );
        (register, format!("fault == {number} ? {name}_late : {name}_true"))
    }

    /// A wire between blocks.
    fn driven(&mut self, range: &str, name: &str) -> String {
        self.driven.insert(name.to_owned());
        let (late, value) = self.late(range, name);
        format!("wire {range}{name}_true;\n{late}wire {range}{name} = {value};")
    }

    fn register(&mut self, name: &str, value: &str) -> String {
        let numbered = self.numbered(name, variants(value));
        let faulty = numbered
            .into_iter()
            .map(|(number, value)| format!("if (fault == {number}) {name} <= {value}; else "));
        faulty.collect::<String>() + &format!("{name} <= {value};")
    }

    fn condition(&mut self, value: &str, rest: &str) -> String {
        let numbered = self.numbered(&format!("if ({value})"), variants(value));
        let faulty: String = numbered
            .into_iter()
            .map(|(number, value)| format!("fault == {number} ? ({value}) : "))
            .collect();
        let (before, behind) = rest.split_once('\n').expect("two sides");
        format!("{before} ({faulty}({value})) {behind}")
    }

    /// The outputs of an instance go to the wires that may be late.
    fn other(&mut self, code: String) -> String {
        if let Some((_, name)) = code.strip_suffix(" (").and_then(|head| head.split_once(" u_")) {
            self.instance = name.to_owned();
        }
        // A port that has an input's name has `_out` behind it, its wire has not.
        let driven = |(port, wire): &(&str, &str)| {
            let name = wire.strip_prefix(&self.instance).and_then(|rest| rest.strip_prefix('_'));
            let output =
                name.is_some_and(|name| *port == name || port.strip_suffix("_out") == Some(name));
            output && self.driven.contains(*wire)
        };
        let port = code.strip_prefix('.').and_then(|rest| rest.split_once('('));
        let port = port
            .map(|(port, wire)| (port, wire.trim_end_matches(',').trim_end_matches(')')))
            .filter(driven);
        if port.is_some() { code.replace(')', "_true)") } else { code }
    }
}
