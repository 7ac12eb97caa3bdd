// SPDX-License-Identifier: MIT OR Apache-2.0
//! Synthesis, placement and packing of one design, in a folder of its own.

use crate::cells::Cells;
use crate::report::{ModuleCells, Timing, Used};
use crate::sources::{File, hash};
use crate::target::Family;
use crate::tools::Tools;
use anyhow::{Context, Result, ensure};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Seeds that run in parallel.
const AT_ONCE: usize = 2;

/// A design on its way to a bitstream.
#[derive(Debug)]
pub struct Flow<'a> {
    tools: &'a Tools,
    family: Family,
    top: &'a str,
    folder: PathBuf,
    verilog: String,
    constraints: Option<String>,
    shares: bool,
}

/// A placed and routed design.
#[derive(Debug, Clone)]
pub struct Placed {
    /// Achieved clock frequency.
    pub timing: Timing,
    /// What of the part it takes.
    pub used: Used,
}

impl<'a> Flow<'a> {
    /// Puts the files of a design into a folder.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn new(
        tools: &'a Tools,
        family: Family,
        top: &'a str,
        files: &[File],
        folder: &Path,
    ) -> Result<Flow<'a>> {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        for file in files {
            hapticore_files::write(&folder.join(&file.name), &file.text)?;
        }
        // In one order: Yosys's names, and so its results, follow the order in which it reads.
        let mut names: Vec<_> = files.iter().map(|file| file.name.clone()).collect();
        names.sort();
        let ending = |name: &String, ending: &str| name.ends_with(&format!(".{ending}"));
        let constraints = names.iter().find(|name| ending(name, family.constraints())).cloned();
        let verilog =
            names.into_iter().filter(|name| ending(name, "v")).collect::<Vec<_>>().join(" ");
        let folder = folder.into();
        Ok(Flow { tools, family, top, folder, verilog, constraints, shares: true })
    }

    /// The same, with no operator shared by synthesis.
    pub fn unshared(self) -> Self {
        Flow { shares: false, ..self }
    }

    fn yosys(&self, commands: &str) -> Result<()> {
        let commands = format!("read_verilog {}; {commands}", self.verilog);
        self.tools.run("yosys", &["-q", "-p", &commands], &self.folder).map(drop)
    }

    fn json(&self, name: &str) -> Result<Value> {
        let text = fs::read_to_string(self.folder.join(name)).with_context(|| name.to_string())?;
        serde_json::from_str(&text).with_context(|| name.to_string())
    }

    /// Makes the netlist, and counts its cells.
    ///
    /// # Errors
    /// Yosys refuses.
    pub fn synthesise(&self) -> Result<Cells> {
        let synthesis = match self.shares {
            true => self.family.synthesis(self.top),
            false => self.family.synthesis_unshared(self.top),
        };
        let outputs = "write_json netlist.json; tee -q -o cells.json stat -json";
        self.yosys(&format!("{synthesis}; {outputs}"))?;
        let stat = self.json("cells.json")?;
        let modules = stat["modules"].as_object().context("Yosys's statistics")?;
        let top = modules.get(&format!("\\{}", self.top)).context("the top module's statistics")?;
        Ok(cells(self.family, top))
    }

    /// Counts the cells of each module, without those of modules within.
    ///
    /// # Errors
    /// Yosys refuses.
    pub fn modules(&self) -> Result<Vec<ModuleCells>> {
        let synthesis = self.family.synthesis_by_module(self.top);
        self.yosys(&format!("{synthesis}; tee -q -o modules.json stat -json"))?;
        let stat = self.json("modules.json")?;
        let modules = stat["modules"].as_object().context("Yosys's statistics")?;
        let of = |(name, module): (&String, &Value)| ModuleCells {
            module: name.trim_start_matches('\\').into(),
            cells: cells(self.family, module),
        };
        let mut all: Vec<_> = modules.iter().map(of).collect();
        all.sort_by(|a, b| a.module.cmp(&b.module));
        Ok(all)
    }

    /// What the netlist takes of the part, which may be more than it has: packed, not placed.
    ///
    /// # Errors
    /// nextpnr refuses, or does not say.
    pub fn packed(&self) -> Result<Used> {
        let (program, part) = self.family.place();
        let unconstrained = self.family.unconstrained();
        let mut arguments = part.to_vec();
        arguments.extend(["--json", "netlist.json", "--pack-only", unconstrained]);
        utilisation(self.family, &self.tools.run(program, &arguments, &self.folder)?)
    }

    /// Places and routes the netlist with a seed.
    ///
    /// # Errors
    /// The design does not fit, or nextpnr refuses.
    pub fn place(&self, seed: u64) -> Result<Placed> {
        let (program, part) = self.family.place();
        let [constraints, routed] = self.family.options();
        let (name, report, seeded) =
            (self.routed(seed), format!("placed-{seed}.json"), seed.to_string());
        // Whether the clock is fast enough is for the report to say.
        let mut arguments = part.to_vec();
        arguments.extend([
            "-q",
            "--timing-allow-fail",
            "--seed",
            &seeded,
            "--json",
            "netlist.json",
            "--report",
            &report,
            routed,
            &name,
        ]);
        match &self.constraints {
            Some(file) => arguments.extend([constraints, file]),
            // The order of a harness's pins is no one's concern.
            None => arguments.push(self.family.unconstrained()),
        }
        self.tools.run(program, &arguments, &self.folder)?;
        let report = self.json(&report)?;
        Ok(Placed {
            timing: Timing { seed, mhz: fmax(&report)? },
            used: used(self.family, &report)?,
        })
    }

    /// Places and routes with each of the seeds.
    ///
    /// # Errors
    /// As [`Flow::place`].
    pub fn place_all(&self, seeds: u64) -> Result<Vec<Placed>> {
        let (next, done) = (Mutex::new(1..=seeds), Mutex::new(BTreeMap::new()));
        let work = || {
            loop {
                let Some(seed) = next.lock().expect("no worker panics").next() else { return };
                let placed = self.place(seed);
                done.lock().expect("no worker panics").insert(seed, placed);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..AT_ONCE {
                scope.spawn(work);
            }
        });
        done.into_inner().expect("no worker panics").into_values().collect()
    }

    fn routed(&self, seed: u64) -> String {
        format!("routed-{seed}.txt")
    }

    /// Makes the bitstream of a seed, and gives its path and hash.
    ///
    /// # Errors
    /// It cannot be packed.
    pub fn pack(&self, seed: u64) -> Result<(PathBuf, String)> {
        let (program, options, ending) = self.family.pack();
        let (routed, name) = (self.routed(seed), format!("{}.{ending}", self.top));
        let arguments: Vec<_> =
            options.iter().copied().chain([routed.as_str(), name.as_str()]).collect();
        self.tools.run(program, &arguments, &self.folder)?;
        let path = self.folder.join(name);
        let bytes = fs::read(&path)?;
        ensure!(!bytes.is_empty(), "{} is empty", path.display());
        Ok((path, hash(bytes)))
    }
}

fn cells(family: Family, module: &Value) -> Cells {
    let mut cells = Cells::default();
    for (kind, number) in module["num_cells_by_type"].as_object().into_iter().flatten() {
        family.count(&mut cells, kind, number.as_u64().unwrap_or(0));
    }
    cells
}

/// The clock's Fmax after routing. nextpnr calls paths between two iCE40 multipliers a clock of
/// their own; they are not.
fn fmax(report: &Value) -> Result<f64> {
    let clocks = report["fmax"].as_object().context("nextpnr's fmax")?;
    let real = clocks.iter().filter(|(name, _)| !name.contains("$PACKER_GND"));
    let achieved: Vec<_> = real.filter_map(|(_, clock)| clock["achieved"].as_f64()).collect();
    ensure!(!achieved.is_empty(), "nextpnr found no clock");
    let least = achieved.into_iter().fold(f64::INFINITY, f64::min);
    Ok((least * 100.0).round() / 100.0)
}

fn used(family: Family, report: &Value) -> Result<Used> {
    let of = |resource: &str| {
        let entry = &report["utilization"][resource];
        let number =
            |field: &str| entry[field].as_u64().with_context(|| format!("nextpnr's {resource}"));
        Ok::<_, anyhow::Error>([number("used")?, number("available")?])
    };
    let [logic, multipliers, block_rams] = family.resources();
    Ok(Used { logic: of(logic)?, multipliers: of(multipliers)?, block_rams: of(block_rams)? })
}

/// Used and available cells, as nextpnr's log has them: `ICESTORM_LC:    5900/   5280   111%`.
fn utilisation(family: Family, log: &str) -> Result<Used> {
    let of = |resource: &str| {
        let line = log.lines().find_map(|line| line.split_once(&format!(" {resource}:")));
        let numbers = line.and_then(|(_, numbers)| numbers.split_once('/'));
        let (used, rest) = numbers.with_context(|| format!("nextpnr's {resource}"))?;
        let available = rest.split_whitespace().next().unwrap_or_default();
        Ok::<_, anyhow::Error>([used.trim().parse()?, available.parse()?])
    };
    let [logic, multipliers, block_rams] = family.resources();
    Ok(Used { logic: of(logic)?, multipliers: of(multipliers)?, block_rams: of(block_rams)? })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_clock_is_the_slowest_that_is_one() {
        let report = json!({"fmax": {"clock$glb": {"achieved": 19.546}, "$PACKER_GND_NET$glb": {"achieved": 9.0}}});
        assert_eq!(fmax(&report).unwrap(), 19.55);
        assert!(fmax(&json!({"fmax": {}})).is_err());
    }

    #[test]
    fn a_log_says_what_is_used() {
        let log = "Info: Device utilisation:\nInfo: \t         ICESTORM_LC:  5900/ 5280   111%\n\
                   Info: \t        ICESTORM_RAM:    26/   30    86%\nInfo: \t        ICESTORM_DSP:     7/    8    87%\n";
        let used = utilisation(Family::Ice40, &log.replace("\t", " ")).unwrap();
        assert_eq!((used.logic, used.multipliers), ([5900, 5280], [7, 8]));
        assert!(utilisation(Family::Ecp5, log).is_err());
    }

    #[test]
    fn cells_are_counted_by_what_they_are() {
        let module =
            json!({"num_cells_by_type": {"SB_DFFESR": 3, "SB_DFF": 1, "SB_LUT4": 5, "divider": 2}});
        let expected = Cells { luts: 5, registers: 4, ..Cells::default() };
        assert_eq!(cells(Family::Ice40, &module), expected);
    }
}
