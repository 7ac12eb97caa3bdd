// SPDX-License-Identifier: MIT OR Apache-2.0
//! No signal of a peripheral can overflow, whatever comes in.

use hapticore_contract::profile::Profile;
use hapticore_hdl::block::Block;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_hdl::interpretations::range::{Range, take_assumptions, take_violations, whole};
use hapticore_hdl::probe::sample;
use hapticore_hdl::signal::Signal;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::adc_reader::AdcReader;
use hapticore_rtl::board::drive_output::serial::Frame;
use hapticore_rtl::board::drive_output::{Converter, DriveOutput, Wave};
use hapticore_rtl::board::pads::Pads;
use hapticore_rtl::board::registers::CommandRegisters;
use hapticore_rtl::board::sigma_delta::SigmaDelta;
use hapticore_rtl::board::stream::Stream;
use hapticore_rtl::board::uart::receiver::Receiver;
use hapticore_rtl::board::uart::transmitter::Transmitter;
use hapticore_rtl::board::{Board, Parameters};
use hapticore_rtl::netlist;

/// Clocks after which a register that still grows is widened to its whole format: a counter of many
/// bits would take as many clocks.
const WIDENED: usize = 20_000;

/// Clocks the block with any inputs, from reset, until its registers can be nothing new.
fn prove<B: Block>(block: &B) {
    let inputs =
        B::Inputs::map(block.inputs(), |format: Format| Signal { value: whole(format), format });
    let mut state = block.reset::<Range>();
    let mut seen: Vec<Range> = Vec::new();
    take_violations();
    take_assumptions();
    for clock in 0.. {
        assert!(clock < 50_000, "{} does not close", B::NAME);
        let before = state.registers;
        block.clock(&mut state, inputs);
        if clock == WIDENED {
            let registers = B::Registers::zip(before, state.registers);
            let registers = B::Registers::zip(registers, block.registers());
            state.registers =
                B::Registers::map(
                    registers,
                    |((before, now), format)| {
                        if before == now { now } else { whole(format) }
                    },
                );
        }
        let mut now = Vec::new();
        sample(block, &state, &mut now);
        let joined: Vec<_> = match seen.is_empty() {
            true => now.clone(),
            false => seen.iter().zip(&now).map(|(a, b)| a.join(*b)).collect(),
        };
        if joined == seen && clock > 300 {
            break;
        }
        seen = joined;
    }
    assert_eq!(take_violations(), [], "{}", B::NAME);
    assert_eq!(take_assumptions(), Vec::<&str>::new(), "{}", B::NAME);
}

#[test]
fn no_signal_of_a_peripheral_can_overflow() {
    for profile in Profile::of_distinct_words() {
        let clock_hz = if profile.name == "small" { 12_000_000 } else { 25_000_000 };
        let parameters = Parameters { clock_hz, baud: 1_000_000, sclk_latency: 2, drive: None };
        let core = Core::new(&profile);
        prove(&AdcReader::new(&profile, &parameters));
        prove(&SigmaDelta::new(core.outputs().carrier));
        prove(&Pads::new(profile.pads, parameters.dead()));
        prove(&Receiver::new(parameters.bits()));
        prove(&Transmitter::new(parameters.bits()));
        let registers = CommandRegisters::new(
            core.inputs().calibration,
            core.estimator().table().words as u64,
            None,
        );
        prove(&Stream::new(
            &profile,
            parameters.bits(),
            registers.outputs().data,
            parameters.output().as_ref(),
        ));
        prove(&registers);
        let board = Board::new(&profile, &parameters).expect("bundled profiles fit");
        assert_eq!(netlist::of_board(&board).top().name, "board");
    }
}

#[test]
fn no_signal_of_a_drive_output_can_overflow() {
    let waves = [
        Wave::Dc,
        Wave::Square { turn_slots: 1 },
        Wave::Square { turn_slots: 5 },
        Wave::Sine { points: 16, point_clocks: 20 },
    ];
    let converters = [
        Converter::Pulses,
        Converter::Serial(Frame::AD5664),
        Converter::Serial(Frame { half_clocks: 3, ..Frame::AD5668 }),
        Converter::Parallel { bits: 12 },
    ];
    for shape in [[1, 1], [4, 1], [6, 3], [16, 1]] {
        for converter in converters.into_iter().filter(|it| fits(*it, shape)) {
            for wave in waves {
                let drive = Format::unsigned(16, 16);
                prove(&DriveOutput::new(shape, drive, 100, wave, converter));
            }
        }
    }
}

/// Whether the converter has a channel for each pad.
fn fits(converter: Converter, [pads, parts]: [u64; 2]) -> bool {
    pads / parts <= converter.most_channels()
}
