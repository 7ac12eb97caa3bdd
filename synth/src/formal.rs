// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proofs with SymbiYosys: a printed module with a checker of `synth/formal/` before its
//! `endmodule`.
//!
//! The checker sees the module's registers by the names that the model gives them, and the widths
//! as parameters.

use crate::certificates::Subject;
use crate::tools::{Tools, root};
use anyhow::{Context, Result, bail};
use hapticore_hdl::interpretations::netlist::{Module, Netlist, Node, Op};
use hapticore_hdl::verilog::Design;
use std::collections::HashSet;
use std::fs;
use std::path::Path;

/// What SymbiYosys found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every assertion holds: for ever (`prove`), or for so many clocks after reset (`bmc`).
    Holds,
    /// Some input breaks an assertion.
    Broken,
    /// Neither proved nor refuted.
    Unknown,
}

/// How far to look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// By induction over so many clocks: for ever.
    Prove(u64),
    /// For so many clocks after reset.
    Bounded(u64),
    /// Whether each `cover` can happen within so many clocks after reset.
    Cover(u64),
}

/// A module and its checker.
#[derive(Debug, Clone)]
pub struct Claim<'a> {
    /// The printed module, behind those within it.
    pub verilog: &'a str,
    /// The checker: a file of `synth/formal/` without its ending.
    pub checker: &'a str,
    /// The checker's parameters.
    pub parameters: Vec<(&'static str, u64)>,
    /// What the checker is to know besides: `SMALL` where words are short enough for the solver to
    /// multiply.
    pub defines: Vec<&'static str>,
}

impl Claim<'_> {
    /// The module with the checker in it. A name that neither has is an error, not a wire of one bit.
    fn text(&self) -> Result<String> {
        let path = root().join("synth/formal").join(format!("{}.sv", self.checker));
        let checker = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let (module, rest) = self.verilog.rsplit_once("endmodule").context("a module ends")?;
        let parameter = |(name, value): &(&str, u64)| format!("    localparam {name} = {value};\n");
        let parameters: String = self.parameters.iter().map(parameter).collect();
        Ok(format!("`default_nettype none\n{module}\n{parameters}{checker}\nendmodule{rest}"))
    }

    /// Prints which assertions failed, with their lines of the module with its checker.
    fn report(&self, log: &str) -> Result<()> {
        let text = self.text()?;
        for line in log.lines().filter(|line| line.contains("Assert failed")) {
            let number = line
                .split("claim.sv:")
                .nth(1)
                .and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
            let source = number.and_then(|number| text.lines().nth(number - 1));
            eprintln!("{line}\n    {}", source.unwrap_or(""));
        }
        Ok(())
    }

    /// Asks SymbiYosys.
    ///
    /// # Errors
    /// The tools do not run, or do not understand the module.
    pub fn check(&self, tools: &Tools, mode: Mode, folder: &Path) -> Result<Verdict> {
        let (module, (mode, depth)) = (
            top(self.verilog).context("a module begins")?,
            match mode {
                Mode::Prove(depth) => ("prove", depth),
                Mode::Bounded(depth) => ("bmc", depth),
                Mode::Cover(depth) => ("cover", depth),
            },
        );
        let defines: String = self.defines.iter().map(|name| format!("-D{name} ")).collect();
        let text = self.text()?;
        let script = format!(
            "[options]\nmode {mode}\ndepth {depth}\nvcd off\n[engines]\nsmtbmc z3\n[script]\nread -formal {defines}claim.sv\n\
             prep -top {module}\n[files]\nclaim.sv\n"
        );
        let subject = Subject::new().and(&text).and(&script);
        let who = format!("formal: {} in {module}, {mode} {depth}", self.checker);
        let ask = || Ok(format!("{:?}", self.ask(tools, &text, &script, folder)?));
        match subject.try_verdict::<anyhow::Error>(&who, ask)?.as_str() {
            "Holds" => Ok(Verdict::Holds),
            "Broken" => Ok(Verdict::Broken),
            "Unknown" => Ok(Verdict::Unknown),
            other => bail!("{other} is no verdict"),
        }
    }

    fn ask(&self, tools: &Tools, text: &str, script: &str, folder: &Path) -> Result<Verdict> {
        hapticore_files::write(&folder.join("claim.sv"), text)?;
        hapticore_files::write(&folder.join("claim.sby"), script)?;
        let output = tools.command("sby").args(["-f", "claim.sby"]).current_dir(folder).output()?;
        let log = String::from_utf8_lossy(&output.stdout);
        match output.status.code() {
            Some(0) => Ok(Verdict::Holds),
            Some(2) => {
                self.report(&log)?;
                Ok(Verdict::Broken)
            }
            Some(4) => {
                self.report(&log)?;
                Ok(Verdict::Unknown)
            }
            status => bail!("sby: {status:?}\n{log}"),
        }
    }
}

/// Which of several claims some input breaks within so many clocks after reset. Their modules are read in one run of Yosys:
/// SymbiYosys would start it three times for each.
///
/// # Errors
/// The tools do not run, or do not understand a module.
pub fn broken(tools: &Tools, claims: &[Claim], clocks: u64, folder: &Path) -> Result<Vec<bool>> {
    let mut subject = Subject::new().and(clocks.to_string());
    for claim in claims {
        subject = subject.and(claim.text()?).and(claim.defines.join(" "));
    }
    let checker = claims.first().map_or("nothing", |claim| claim.checker);
    let ask = || {
        let broken = ask_for_broken(tools, claims, clocks, folder)?;
        Ok(broken.into_iter().map(|broken| if broken { 'B' } else { '-' }).collect())
    };
    let who = format!("formal: mutants of {checker}, B where broken");
    let verdict = subject.try_verdict::<anyhow::Error>(&who, ask)?;
    Ok(verdict.chars().map(|broken| broken == 'B').collect())
}

fn ask_for_broken(
    tools: &Tools,
    claims: &[Claim],
    clocks: u64,
    folder: &Path,
) -> Result<Vec<bool>> {
    let mut script = String::new();
    for (number, claim) in claims.iter().enumerate() {
        let module = top(claim.verilog).context("a module begins")?;
        let defines: String = claim.defines.iter().map(|name| format!("-D{name} ")).collect();
        hapticore_files::write(&folder.join(format!("{number}.sv")), &claim.text()?)?;
        script += &format!(
            "design -reset; read_verilog -formal -sv {defines}{number}.sv; prep -top {module}; async2sync; \
             chformal -assume -early; dffunmap; opt_clean; write_smt2 -wires {number}.smt2\n"
        );
    }
    hapticore_files::write(&folder.join("all.ys"), &script)?;
    tools.run("yosys", &["-q", "all.ys"], folder)?;
    let is_broken = |number: usize| {
        let (file, clocks) = (format!("{number}.smt2"), clocks.to_string());
        let mut command = tools.command("yosys-smtbmc");
        command.args(["-s", "z3", "--noinfo", "-t", &clocks, &file]).current_dir(folder);
        let log = String::from_utf8_lossy(&command.output()?.stdout).into_owned();
        match (log.contains("Status: PASSED"), log.contains("Status: FAILED")) {
            (true, false) => Ok(false),
            (false, true) => Ok(true),
            _ => bail!("yosys-smtbmc: {log}"),
        }
    };
    (0..claims.len()).map(is_broken).collect()
}

/// The name of the last module of a text, which all others are within.
pub fn top(verilog: &str) -> Option<&str> {
    verilog.lines().rev().find_map(|line| line.strip_prefix("module ")?.split([' ', '(']).next())
}

/// The wires that an output depends on, through registers too.
fn live(module: &Module) -> HashSet<Node> {
    let mut live = HashSet::new();
    let mut open: Vec<_> = module.outputs.iter().map(|output| output.node).collect();
    while let Some(node) = open.pop() {
        if !live.insert(node) {
            continue;
        }
        match module.wires[node.0 as usize].op {
            Op::Register(index) => open.push(module.registers[index].node),
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Concat(a, b) => open.extend([a, b]),
            Op::Less(a, b) | Op::Equal(a, b) | Op::And(a, b) | Op::Or(a, b) => open.extend([a, b]),
            Op::Abs(a) | Op::Fit(a, ..) | Op::Scale(a) | Op::Bits(a, _) | Op::Not(a) => {
                open.push(a)
            }
            Op::Select(bit, a, b) => open.extend([bit, a, b]),
            Op::Constant(_) | Op::Input(_) | Op::Data(_) | Op::Output(..) => (),
        }
    }
    live
}

/// A wire, or the one that it passes on whatever happens.
fn resolve(module: &Module, node: Node) -> Node {
    match module.wires[node.0 as usize].op {
        Op::Select(_, a, b) if resolve(module, a) == resolve(module, b) => resolve(module, a),
        _ => node,
    }
}

/// The module with one operator changed, for each operator that matters: a proof that passes for
/// any of them shows nothing.
pub fn mutants(module: &Module) -> Vec<(String, Module)> {
    let live = live(module);
    let change = |op: &Op| match *op {
        Op::Add(a, b) => Some(Op::Sub(a, b)),
        Op::Sub(a, b) => Some(Op::Add(a, b)),
        Op::Less(a, b) => Some(Op::Less(b, a)),
        Op::And(a, b) => Some(Op::Or(a, b)),
        Op::Or(a, b) => Some(Op::And(a, b)),
        Op::Select(bit, a, b) if resolve(module, a) != resolve(module, b) => {
            Some(Op::Select(bit, b, a))
        }
        _ => None,
    };
    let wires =
        module.wires.iter().enumerate().filter(|(index, _)| live.contains(&Node(*index as u32)));
    let mutant = |(index, op): (usize, Op)| {
        let mut mutant = module.clone();
        let name = format!("wire {index}, {:?}, as {op:?}", module.wires[index].op);
        mutant.wires[index].op = op;
        (name, mutant)
    };
    wires.filter_map(|(index, wire)| Some((index, change(&wire.op)?))).map(mutant).collect()
}

/// The text of a module that has no others within.
pub fn print(module: &Module) -> String {
    Design::print(&Netlist { modules: vec![module.clone()] }, "a formal check").text()
}
