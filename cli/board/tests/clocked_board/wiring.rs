// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check of the wiring on a board of gateware: it finds what it finds on the virtual board.

use std::thread;

use hapticore_board::bench::DeviceTime;
use hapticore_board::check::{Finding, Report, check};
use hapticore_board::faults::Wrong;
use hapticore_host::startup::LineFault;

use crate::clocked::ClockedBoard;
use crate::{small, two_pads, virtual_board};

/// Reports of the check of both boards with a fault: the virtual one's, the gateware's.
fn checked(fault: Wrong) -> [Report; 2] {
    let mut board = virtual_board(two_pads(), 0, &small());
    let device = (**board.case().device).clone();
    let mut clocked = ClockedBoard::of(&board).expect("a board of a bundled profile");
    board.faults.wrong.push(fault);
    clocked.break_with(fault);
    let mut clocked = DeviceTime::new(clocked);
    let reports = [
        check(&mut DeviceTime::new(board), &device).expect("the virtual board starts up"),
        check(&mut clocked, &device).expect("the gateware starts up"),
    ];
    assert_eq!(clocked.board.adc.wrong, Vec::<&str>::new(), "{fault:?}: what the ADC forbids");
    reports
}

fn agree(fault: Wrong, is_expected: impl Fn(&[Finding]) -> bool) {
    let [of_virtual, of_gateware] = checked(fault);
    assert_eq!(of_gateware.findings, of_virtual.findings, "{fault:?}");
    assert!(is_expected(&of_gateware.findings), "{fault:?}: {:?}", of_gateware.findings);
    assert_eq!(of_gateware.compared.len(), of_virtual.compared.len(), "{fault:?}");
}

#[test]
fn faults_of_data_lines_are_found_at_the_pins_of_the_gateware_as_on_the_virtual_board() {
    let of_line = |of: usize, is: fn(LineFault) -> bool| move |found: &[Finding]| matches!(found, [Finding::DataLine { line, fault }] if *line == of && is(*fault));
    agree(Wrong::LineLow(0), of_line(0, |fault| fault == LineFault::Silent));
    agree(Wrong::LineHigh(6), of_line(6, |fault| fault == LineFault::Ones));
    let is_shorted = |fault| matches!(fault, LineFault::Shorted { other: 2, .. });
    agree(Wrong::LineShorted(5, 2), of_line(5, is_shorted));
}

#[test]
fn faults_of_wires_and_pads_are_found_on_the_gateware_as_on_the_virtual_board() {
    let faults = [
        (Wrong::Open(2), Finding::Open { terminal: 2 }),
        (Wrong::Swapped(1, 4), Finding::Swapped { terminals: [1, 4] }),
        (Wrong::Reversed(0), Finding::Reversed { terminal: 0 }),
        (Wrong::PadMissing(1), Finding::PadMissing { pad: 1 }),
    ];
    thread::scope(|scope| {
        for (fault, finding) in faults {
            scope.spawn(move || agree(fault, |found| found == [finding]));
        }
    });
}
