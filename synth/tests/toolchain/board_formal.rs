// SPDX-License-Identifier: MIT OR Apache-2.0
//! Proofs of a board's blocks, at the parameters of the boards that one can buy; that what they
//! speak of can happen; and that they can fail.

use hapticore_contract::frame::Field;
use hapticore_contract::profile::Profile;
use hapticore_hdl::interpretations::netlist::{Module, Named, Netlist};
use hapticore_hdl::verilog::Design;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::adc_reader::AdcReader;
use hapticore_rtl::board::framing::{
    Constant, Register, STATUS_BYTES, VERSION, data_bytes, word_bytes,
};
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::board::registers::CommandRegisters;
use hapticore_rtl::board::stream::Stream;
use hapticore_rtl::board::uart::transmitter::Transmitter;
use hapticore_rtl::board::{Board, Parameters, Target};
use hapticore_rtl::codes::word_formats;
use hapticore_rtl::netlist;
use hapticore_synth::formal::{Claim, Mode, Verdict, print};
use hapticore_synth::tools::Tools;

fn verdict(
    tools: &Tools,
    verilog: &str,
    checker: &'static str,
    parameters: &[(&'static str, u64)],
    mode: Mode,
) -> Verdict {
    let folder = tempfile::tempdir().expect("a folder");
    let claim = Claim { verilog, checker, parameters: parameters.to_vec(), defines: Vec::new() };
    claim.check(tools, mode, folder.path()).unwrap_or_else(|error| panic!("{checker}: {error}"))
}

/// The ADC reader of a board: as printed, and its checker's parameters.
fn reader(profile: &Profile, parameters: &Parameters) -> (String, Vec<(&'static str, u64)>) {
    let module: Module = Netlist::of(&AdcReader::new(profile, parameters)).top().clone();
    let bits = u64::from(profile.formats.adc.width);
    let of = vec![
        ("PERIOD", profile.clocks_per_sample),
        ("CONVERSION", parameters.conversion()),
        ("BITS", bits),
        ("LATENCY", parameters.sclk_latency),
        ("CHANNELS", profile.channels() as u64),
    ];
    (print(&module), of)
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn the_adc_s_pins_keep_to_their_schedule_whatever_is_enabled_when() {
    let tools = Tools::find().expect("what synth/tools fetches");
    for target in Target::ALL {
        let (verilog, parameters) = reader(&target.profile(), &target.parameters());
        let found = verdict(&tools, &verilog, "adc_reader", &parameters, Mode::Prove(10));
        assert_eq!(found, Verdict::Holds, "{target:?} with {parameters:?}");
        let found = verdict(&tools, &verilog, "adc_reader", &parameters, Mode::Cover(60));
        assert_eq!(found, Verdict::Holds, "{target:?}: sets and words happen");
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_changed_schedule_is_noticed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    let target = Target::Icebreaker;
    let (verilog, parameters) = reader(&target.profile(), &target.parameters());
    // What stood there before, or could: each changed in one place of the text.
    for (printed, instead) in [
        ("assign shift = selected & configuring;", "assign shift = configuring;"),
        ("assign shift = selected & configuring;", "assign shift = selected & write;"),
        ("assign cs_n = ~selected;", "assign cs_n = ~(selected & enable);"),
        ("assign sclk_run = run;", "assign sclk_run = run & enable;"),
        ("(((enable | active) | selected) | unload)", "((enable | active) | unload)"),
        ("index == 3'd7", "index == 3'd6"),
    ] {
        let changed = verilog.replacen(printed, instead, 1);
        assert_ne!(changed, verilog, "{printed} is printed");
        let found = verdict(&tools, &changed, "adc_reader", &parameters, Mode::Bounded(40));
        assert_eq!(found, Verdict::Broken, "{instead}");
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn no_two_pads_of_a_board_are_closed() {
    let tools = Tools::find().expect("what synth/tools fetches");
    for target in Target::ALL {
        let (pads, dead) = (target.profile().pads, target.parameters().dead());
        let verilog = print(Netlist::of(&Pads::new(pads, dead)).top());
        let parameters = [("PADS", pads), ("DEAD", dead)];
        assert_eq!(
            verdict(&tools, &verilog, "pads", &parameters, Mode::Prove(4)),
            Verdict::Holds,
            "{target:?}"
        );
    }
}

/// What a checker is to know.
type Known = Vec<(&'static str, u64)>;

/// The registers of a board.
fn registers(target: Target) -> (String, Known) {
    let core = Core::new(&target.profile());
    let words = core.estimator().table().words as u64;
    let address = u64::from(core.inputs().calibration.table.address.width);
    let verilog =
        print(Netlist::of(&CommandRegisters::new(core.inputs().calibration, words, None)).top());
    let numbers = [
        ("CAPACITANCE", Register::Constant(Constant::CapacitanceGain)),
        ("FORCE", Register::Constant(Constant::ForceGain)),
        ("CONTACT", Register::Constant(Constant::ContactCapacitance)),
        ("CONTROL", Register::Control),
        ("ADC", Register::Adc),
    ];
    let mut known: Known = numbers.map(|(name, register)| (name, register.number() as u64)).into();
    known.extend([
        ("DATA", data_bytes(&word_formats(&core.inputs().calibration))),
        ("WORDS", words),
        ("ADDRESS", address),
        ("REGISTERS", Register::ALL.len() as u64),
    ]);
    (verilog, known)
}

/// The stream of a board with its transmitter, and what goes into that, as `line`.
fn stream(target: Target) -> (String, Known) {
    let (profile, core) = (target.profile(), Core::new(&target.profile()));
    let data = CommandRegisters::new(core.inputs().calibration, 1, None).outputs().data;
    let text = Design::of(
        &Stream::new(&profile, target.parameters().bits(), data, None),
        "a formal check",
    )
    .text();
    let line = text
        .split_once(".octet(")
        .and_then(|(_, rest)| rest.split_once("),\n"))
        .expect("a transmitter")
        .0;
    let line = format!("    wire [7:0] line = {line};\nendmodule");
    let (module, rest) = text.rsplit_once("endmodule").expect("a module");
    let width = Field::word(&profile).width;
    (
        format!("{module}{line}{rest}"),
        vec![
            ("BYTES", word_bytes(&profile)),
            ("WIDTH", width.into()),
            ("STATUS", STATUS_BYTES),
            ("VERSION", VERSION.into()),
        ],
    )
}

fn transmitter(target: Target) -> (String, Known) {
    let divisor = target.parameters().bits().least();
    (print(Netlist::of(&Transmitter::new(divisor)).top()), vec![("DIVISOR", divisor)])
}

/// The board, the blocks within it free to do anything: only their ports are left of them.
fn board(target: Target) -> (String, Known) {
    let board = Board::new(&target.profile(), &target.parameters()).expect("a board");
    let within = netlist::of_board(&board);
    let design = Design::print(&within, "a formal check");
    let (top, _) = design.modules.split_last().expect("modules");
    let names = design.modules.iter().map(|file| file.name.as_str());
    let blocks = names
        .zip(&within.modules)
        .filter(|(name, _)| top.text.contains(&format!("\n    {name} u_")));
    let hollow = |(name, module): (&str, &Module)| {
        let of = |ports: &[Named], with: &dyn Fn(u8, &str) -> String| -> String {
            ports.iter().map(|port| with(port.format.width - 1, port.name)).collect()
        };
        let inputs = of(&module.inputs, &|high, name| format!(", input wire [{high}:0] {name}"));
        let outputs = of(&module.outputs, &|high, name| format!(", output wire [{high}:0] {name}"));
        let any = |high, name: &str| {
            format!(
                "    (* anyseq *) wire [{high}:0] any_{name};\n    assign {name} = any_{name};\n"
            )
        };
        let anything = of(&module.outputs, &any);
        format!(
            "module {name} (input wire clock, input wire reset{inputs}{outputs});\n{anything}endmodule\n"
        )
    };
    (blocks.map(hollow).collect::<String>() + &top.text, Known::new())
}

/// The claims of a block of every board hold for ever, and what they speak of happens within so
/// many clocks.
fn proves(name: &'static str, block: fn(Target) -> (String, Known), cover: u64) {
    let tools = Tools::find().expect("what synth/tools fetches");
    for target in Target::ALL {
        let (verilog, known) = block(target);
        assert_eq!(
            verdict(&tools, &verilog, name, &known, Mode::Prove(4)),
            Verdict::Holds,
            "{target:?}, {known:?}"
        );
    }
    let (verilog, known) = block(Target::Icebreaker);
    assert_eq!(
        verdict(&tools, &verilog, name, &known, Mode::Cover(cover)),
        Verdict::Holds,
        "{name}: it happens"
    );
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_command_writes_what_it_names_and_a_damaged_one_nothing() {
    proves("registers", registers, 15);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn packets_are_whole_with_end_at_their_ends_only() {
    proves("stream", stream, 13);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn a_byte_that_is_taken_is_on_the_line() {
    proves("transmitter", transmitter, 16);
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn sdi_rests_while_the_adc_is_read() {
    proves("board", board, 4);
}

/// Holds that the checker notices each change of a printed text, within the clocks of `mode`.
fn broken(
    name: &'static str,
    (verilog, known): (String, Known),
    mode: Mode,
    changes: &[(&str, &str)],
) {
    let tools = Tools::find().expect("what synth/tools fetches");
    for (printed, instead) in changes {
        let changed = verilog.replace(printed, instead);
        assert_ne!(changed, verilog, "{printed} is printed");
        assert_ne!(
            verdict(&tools, &changed, name, &known, mode),
            Verdict::Holds,
            "{name}: {instead}"
        );
    }
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn changed_blocks_are_noticed() {
    let ice = Target::Icebreaker;
    let changes = [
        ("crc == 32'd3736805603", "crc[31:1] == 31'd1868402801"),
        ("place_q[2:0] == 3'd1", "place_q[1:0] == 2'd1"),
        ("octet[7:4] == 4'd0", "octet[7:5] == 3'd0"),
        ("left_is_0 ? 8'd0 : octet", "(left == 4'd1) ? 8'd0 : octet"),
    ];
    broken("registers", registers(ice), Mode::Prove(4), &changes);
    let changes = [
        ("plain_is_0 ? {3'd0, distance}", "plain_is_0 ? {3'd0, distance ^ 5'd1}"),
        ("~transmitter_ending", "1'd1"),
        ("number[15:8]", "number[7:0]"),
        ("next_taking = (valid", "next_taking = valid | (valid"),
        ("& heartbeat) & (~group[3])", "& heartbeat) & group[3]"),
    ];
    broken("stream", stream(ice), Mode::Prove(4), &changes);
    broken(
        "transmitter",
        transmitter(ice),
        Mode::Prove(4),
        &[("position == 4'd9", "position == 4'd8")],
    );
    broken(
        "board",
        board(ice),
        Mode::Prove(4),
        &[("registers_sdi & adc_reader_shift", "registers_sdi & shift")],
    );
}

#[test]
#[cfg_attr(not(tool = "synth/tools"), ignore = "needs synth/tools: ./test fetches what is missing")]
fn assumptions_that_contradict_each_other_are_noticed() {
    let contradiction =
        "    always @(*) assume (octet == 8'd1 && octet == 8'd2);\n    assign enable =";
    broken(
        "registers",
        registers(Target::Icebreaker),
        Mode::Cover(15),
        &[("    assign enable =", contradiction)],
    );
}
