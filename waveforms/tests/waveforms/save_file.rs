// SPDX-License-Identifier: MIT OR Apache-2.0
//! Save files: what is in them is in the trace, shown as the view says.

use std::fs;

use crate::common::{STATES, folder, settings, trace};
use hapticore_waveforms::gtkwave::{self, SaveFile};
use hapticore_waveforms::kind::Kind;
use hapticore_waveforms::tracer::Trace;
use hapticore_waveforms::view::View;

fn traced() -> Trace {
    trace(folder().path(), Kind::Vcd, &settings(), 300).1
}

fn save_file(view: &str) -> Result<SaveFile, String> {
    let view = View::parse("mine.toml", view).map_err(|error| error.to_string())?;
    SaveFile::new(&view, &traced(), "waves.vcd", &(0..100)).map_err(|error| error.to_string())
}

/// The part of a save file after its head.
fn body(view: &str) -> String {
    let text = save_file(view).unwrap().text;
    text[text.find('@').unwrap()..].to_string()
}

/// The paths of the traces in a save file: flags, attributes, headings and height lines left out.
fn traces(text: &str) -> Vec<&str> {
    let is_trace = |line: &&str| !line.starts_with(['@', '[', '^', '-', '*']);
    let path = |line: &'_ str| line.rfind(' ').map_or(0, |space| space + 1);
    text.lines().filter(is_trace).map(|line| &line[path(line)..]).collect()
}

#[test]
fn every_trace_is_in_the_file_with_its_width() {
    let folder = folder();
    let (path, trace) = trace(folder.path(), Kind::Vcd, &settings(), 300);
    let waveform = wellen::simple::read(&path).unwrap();
    let hierarchy = waveform.hierarchy();
    let bundled = View::names().map(|name| View::bundled(name).unwrap());
    for view in bundled.chain([View::everything()]) {
        let file = SaveFile::new(&view, &trace, "waves.vcd", &trace.ticks).unwrap();
        let shown = traces(&file.text);
        assert_eq!(shown.len(), hierarchy.all_vars().count(), "every view shows everything");
        for shown in shown {
            let (path, range) = shown.split_once('[').unwrap_or((shown, "0:0]"));
            let names: Vec<_> = path.split('.').collect();
            let var = &hierarchy
                [hierarchy.lookup_var(&names[..names.len() - 1], names[names.len() - 1]).unwrap()];
            let width = if var.is_real(hierarchy) { 1 } else { var.length(hierarchy).unwrap() };
            assert_eq!(range, format!("{}:0]", width - 1), "{shown}");
        }
    }
}

#[test]
fn numbers_states_curves_and_truth() {
    let body = body(
        r#"
        [[group]]
        name = "All kinds"
        signals = [
            { show = "core.multiplexer.state", color = "indigo" },
            { show = "core.demodulator.valid" },
            { show = "core.position.x", alias = "across" },
            { show = "core.capacitance.c" },
            { show = "core.capacitance.gain" },
            { show = "core.force.coarse" },
            { show = "core.oscillator.sin", as = "step" },
            { show = "core.oscillator.sin", as = "hex" },
            { show = "truth.x", as = "line", height = 2 },
        ]"#,
    );
    let expected = "@800200
-All kinds
@2024
^1 /hapticore/waves.core.multiplexer.state.txt
[color] 6
+{core/multiplexer/state} core.multiplexer.state[1:0]
@24
+{core/demodulator/valid} core.demodulator.valid
@40000424
[fpshift_count] 8
+{across} core.position.x[15:0]
@40000024
[fpshift_count] 12
+{core/capacitance/c} core.capacitance.c[19:0]
@24
+{core/capacitance/gain (2^-38)} core.capacitance.gain[17:0]
@424
+{core/force/coarse (2^3)} core.force.coarse[7:0]
@40008424
[fpshift_count] 17
+{core/oscillator/sin} core.oscillator.sin[17:0]
@20000
-
@20000
-
@22
+{core/oscillator/sin} core.oscillator.sin[17:0]
@50020
+{truth/x (mm)} truth.x
@20000
-
@1000200
-All kinds
";
    assert_eq!(body, expected);
}

#[test]
fn a_group_without_a_name_is_one_for_each_scope_of_what_is_left() {
    let body = body(
        r#"
        [[group]]
        name = "First"
        signals = [{ show = "**.valid" }]
        [[group]]
        closed = true
        signals = [{ show = "core.demodulator.*" }, { show = "core.position.*" }]"#,
    );
    let headings: Vec<_> = body.lines().filter(|line| line.starts_with("-")).collect();
    assert_eq!(
        headings,
        [
            "-First",
            "-First",
            "-core.demodulator",
            "-core.demodulator",
            "-core.position",
            "-core.position"
        ]
    );
    assert_eq!(traces(&body).iter().filter(|path| path.ends_with("valid")).count(), 1);
    assert!(body.contains("@c00200\n-core.position") && body.contains("@1400200\n-core.position"));
}

#[test]
fn what_does_not_fit_the_trace_is_named_with_view_and_line() {
    let unknown = "[[group]]\nname = \"a\"\nsignals = [\n  { show = \"core.*.i\" },\n  { show = \"core.nothing\" },\n]";
    assert_eq!(
        save_file(unknown).unwrap_err(),
        "mine.toml:5: expected a signal of the trace, got \"core.nothing\""
    );
    let alias = "[[group]]\nsignals = [{ show = \"core.position.*\", alias = \"x\" }]";
    assert_eq!(
        save_file(alias).unwrap_err(),
        "mine.toml:2: expected one signal for an alias, got \"core.position.*\""
    );
}

#[test]
fn an_optional_group_goes_without_what_is_not_there() {
    let view = "[[group]]\nname = \"a\"\noptional = true\nsignals = [{ show = \"core.nothing\" }]";
    assert_eq!(traces(&save_file(view).unwrap().text), [""; 0]);
}

#[test]
fn states_are_translated_from_a_file_beside() {
    let folder = folder();
    let path = folder.path().join("waves.gtkw");
    gtkwave::save(&View::everything(), &traced(), "waves.fst", &(0..100), &path).unwrap();
    let translation =
        fs::read_to_string(folder.path().join("waves.core.multiplexer.state.txt")).unwrap();
    assert_eq!(
        translation,
        format!("0 {}\n1 {}\n2 {}\n3 {}\n", STATES[0], STATES[1], STATES[2], STATES[3])
    );
    assert!(fs::read_to_string(path).unwrap().contains("[dumpfile] \"/hapticore/waves.fst\""));
}
