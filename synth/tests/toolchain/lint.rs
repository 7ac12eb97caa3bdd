// SPDX-License-Identifier: MIT OR Apache-2.0
//! What `hapticore hdl` prints passes the linters at the flags that users start with: laws, pads, waves, converters and boards.
//!
//! Two versions of Verilator, slang and Yosys read every design; a warning is a failure, and nothing is waived. A set in which each
//! value of each choice stands is tried always, all combinations with `LINT=all`.

use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_hdl::verilog::{Design, File};
use hapticore_rtl::board::Target;
use hapticore_rtl::board::drive_output::{Converter, Wave};
use hapticore_rtl::header;
use hapticore_synth::certificates::Subject;
use hapticore_synth::tools::{Tools, root};
use std::fs;
use std::path::Path;
use std::sync::Mutex;

const WAVES: [&str; 4] = ["dc", "square:1", "square:10", "sine:125000"];
const CONVERTERS: [&str; 5] = ["pulses", "ad5664", "ad5664r", "ad5668", "parallel"];
const PROFILES: [&str; 4] = ["small", "standard", "fine", "fast"];

/// The clock of a drive on its own.
const CLOCK_HZ: u64 = 25_000_000;

/// Output cells of the boards, which their vendors' libraries hold.
const CELLS: &str = "(* blackbox *) module ODDRX1F (input D0, input D1, input SCLK, input RST, output Q);\nendmodule\n\
    (* blackbox *) module SB_IO #(parameter PIN_TYPE = 0) (output PACKAGE_PIN, input OUTPUT_CLK, input D_OUT_0, input D_OUT_1);\n\
    endmodule\n";

/// A printed design.
struct Printed {
    name: String,
    top: String,
    files: Vec<File>,
    /// `-Wall` passes, too.
    strict: bool,
}

impl Printed {
    fn of(name: String, design: Design) -> Printed {
        Printed { name, top: design.top().to_owned(), files: design.modules, strict: true }
    }
}

fn profile(name: &str, pads: u64, terminals: usize, law: Option<Law>) -> Profile {
    let mut profile = Profile::bundled(name).expect("bundled");
    profile.pads = pads;
    profile.terminals.x.truncate(terminals);
    profile.terminals.y.truncate(terminals);
    profile.control = law.map(|law| Control::of(&profile, law));
    profile
}

/// A force loop.
fn of_loop(name: &str, pads: u64, law: Law) -> Printed {
    let profile = profile(name, pads, 6, Some(law));
    Printed::of(format!("loop {name}, {pads} pads, {law:?}"), header::design(&profile))
}

/// The pins of a drive.
fn of_pins(pads: u64, wave: &str, converter: &str) -> Printed {
    let profile = profile("standard", pads, 6, Some(Law::Inverse));
    let (parsed, dac) = drive(wave, converter);
    let design = header::drive_output(&profile, parsed, dac, CLOCK_HZ, "").expect("a drive output");
    Printed::of(format!("drive output {converter}, {wave}, {pads} pads"), design)
}

fn drive(wave: &str, converter: &str) -> (Wave, Converter) {
    (wave.parse().expect("a wave"), converter.parse().expect("a converter"))
}

/// A board, with a drive where there is a law.
fn of_board(target: Target, counts: (u64, usize), driven: Option<(Law, &str, &str)>) -> Printed {
    let (pads, terminals) = counts;
    let law = driven.map(|(law, ..)| law);
    let profile = profile(target.profile_name(), pads, terminals, law);
    let drive = driven.map(|(_, wave, converter)| drive(wave, converter));
    let text = target.printed(&profile, drive.map(Into::into)).expect("a board").verilog;
    let files = [("top", text), ("cells", CELLS.to_owned())];
    Printed {
        name: format!("{} with {pads} pads, {terminals} terminals, {driven:?}", target.name()),
        top: "top".into(),
        files: files.map(|(name, text)| File { name: name.into(), text }).into(),
        strict: false,
    }
}

/// Each profile, law, number of pads, wave, converter and board at least once.
fn covering() -> Vec<Printed> {
    let ulx3s = |counts, driven| of_board(Target::Ulx3s, counts, driven);
    vec![
        of_loop("fast", 1, Law::Open),
        of_loop("standard", 4, Law::Proportional),
        of_loop("fine", 2, Law::Integral),
        of_loop("small", 3, Law::Inverse),
        with_walls(),
        of_pins(1, WAVES[0], CONVERTERS[0]),
        of_pins(4, WAVES[1], CONVERTERS[1]),
        of_pins(4, WAVES[2], CONVERTERS[2]),
        of_pins(3, WAVES[3], CONVERTERS[4]),
        ulx3s((3, 5), None),
        ulx3s((4, 6), Some((Law::Inverse, WAVES[3], CONVERTERS[1]))),
        ulx3s((1, 3), Some((Law::Open, WAVES[0], CONVERTERS[2]))),
        ulx3s((2, 4), Some((Law::Integral, WAVES[1], CONVERTERS[3]))),
        of_board(Target::Icebreaker, (4, 6), None),
    ]
}

/// The committed loop, whose pads are split and have walls.
fn with_walls() -> Printed {
    let text = fs::read_to_string(root().join("rtl/verilog/loop.toml")).expect("a profile");
    let profile = Profile::parse(&text).expect("a profile");
    Printed::of("loop with walls".into(), header::design(&profile))
}

fn all() -> Vec<Printed> {
    let mut all = covering();
    for law in Law::ALL {
        for name in PROFILES {
            all.extend([1, 2, 3, 4].map(|pads| of_loop(name, pads, law)));
        }
        for (wave, converter) in WAVES
            .iter()
            .flat_map(|wave| [(wave, CONVERTERS[1]), (wave, CONVERTERS[2]), (wave, CONVERTERS[3])])
        {
            let driven = Some((law, *wave, converter));
            all.extend([1, 4].map(|pads| of_board(Target::Ulx3s, (pads, 6), driven)));
        }
    }
    for (wave, converter) in
        WAVES.iter().flat_map(|wave| CONVERTERS.map(|converter| (wave, converter)))
    {
        all.extend([1, 2, 3, 4].map(|pads| of_pins(pads, wave, converter)));
    }
    for (pads, terminals) in
        (1..=4).flat_map(|pads| (3..=6).map(move |terminals| (pads, terminals)))
    {
        all.extend(Target::ALL.map(|target| of_board(target, (pads, terminals), None)));
    }
    all
}

/// What a linter says of a design in a folder: nothing, where it passes.
fn complaints(tools: &Tools, design: &Printed, folder: &Path) -> Vec<String> {
    let files: Vec<_> = design.files.iter().map(|file| format!("{}.v", file.name)).collect();
    for file in &design.files {
        fs::write(folder.join(format!("{}.v", file.name)), &file.text).expect("a file");
    }
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let mut verilator = vec!["--lint-only", "--top-module", &design.top];
    verilator.extend(design.strict.then_some("-Wall"));
    verilator.extend(&files);
    let slang = [&[design.top.as_str()][..], &files].concat();
    let runs = [("verilator", &verilator), ("verilator-current", &verilator), ("slang", &slang)];
    let complaint = |(tool, arguments): (&str, &Vec<&str>)| match tools.run(tool, arguments, folder)
    {
        Ok(log) if !log.contains("arning") => None,
        Ok(log) => Some(format!("{}: {tool}: {log}", design.name)),
        Err(error) => Some(format!("{}: {error}", design.name)),
    };
    runs.into_iter().filter_map(complaint).collect()
}

/// Yosys reads all designs, one after the other: it takes seconds to start.
fn yosys(tools: &Tools, designs: &[Printed], folder: &Path) -> Option<String> {
    let read = |(number, design): (usize, &Printed)| {
        let name = |file: &File| format!("{number}/{}.v", file.name);
        let files: Vec<_> = design.files.iter().map(name).collect();
        format!(
            "read_verilog {}\nhierarchy -check -top {}\nproc\ncheck -assert\ndesign -reset\n",
            files.join(" "),
            design.top
        )
    };
    let script: String = designs.iter().enumerate().map(read).collect();
    fs::write(folder.join("lint.ys"), script).expect("a script");
    match tools.run("yosys", &["-q", "lint.ys"], folder) {
        Ok(log) if !log.contains("arning") => None,
        Ok(log) => Some(log),
        Err(error) => Some(error.to_string()),
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn printed_designs_pass_all_linters() {
    let everything = std::env::var("LINT").is_ok_and(|value| value == "all");
    let designs = if everything { all() } else { covering() };
    let files = designs.iter().flat_map(|design| &design.files);
    let subject =
        files.fold(Subject::new(), |subject, file| subject.and(&file.name).and(&file.text));
    subject
        .and_files(&["synth/tests/toolchain/lint.rs", "synth/scripts/slang.py"])
        .holds(&format!("lint: {} designs", designs.len()), || all_pass(&designs));
}

fn all_pass(designs: &[Printed]) {
    let tools = Tools::find().expect("what synth/tools fetches");
    let folder = tempfile::tempdir().expect("a folder");
    let folders = (0..designs.len()).map(|number| folder.path().join(number.to_string()));
    let folders: Vec<_> = folders.inspect(|path| fs::create_dir(path).expect("a folder")).collect();
    let left = Mutex::new(designs.iter().zip(&folders));
    let found = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let next = left.lock().expect("no other has panicked").next();
                    let Some((design, folder)) = next else { break };
                    let complaints = complaints(&tools, design, folder);
                    found.lock().expect("no other has panicked").extend(complaints);
                }
            });
        }
    });
    let mut found = found.into_inner().expect("all have ended");
    found.extend(yosys(&tools, designs, folder.path()));
    assert!(
        found.is_empty(),
        "{} of {} designs:\n{}",
        found.len(),
        designs.len(),
        found.join("\n")
    );
}
