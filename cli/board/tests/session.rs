// SPDX-License-Identifier: MIT OR Apache-2.0
//! A host's session with virtual boards: start-up, faults of the line, and a drive that is off until it is armed.

use std::sync::mpsc;
use std::time::{Duration, Instant};

use hapticore_board::faults::{Noise, Wrong};
use hapticore_board::target::{Asked, target};
use hapticore_board::virtual_line::Running;
use hapticore_host::Packet;
use hapticore_host::link::{Line, Phase, Refusal, Session, SessionEvent};
use hapticore_host::startup::StartupError;

/// A session, its board, and what it has reported.
struct Bench {
    session: Session,
    board: Running,
    notes: Vec<String>,
    frames: Vec<Packet>,
}

impl Bench {
    fn new(port: &str) -> Bench {
        let found = target(&Asked { port: port.into(), ..Asked::default() }).expect("bundled");
        let board = found.running.expect("a virtual one");
        let session = Session::new(found.line, found.plan);
        Bench { session, board, notes: Vec::new(), frames: Vec::new() }
    }

    fn poll(&mut self) {
        let (notes, frames) = (&mut self.notes, &mut self.frames);
        self.session.poll(|event| match event {
            SessionEvent::Note(note) => notes.push(note),
            SessionEvent::Frame(packet) => frames.push(packet),
            SessionEvent::Phase(_) => (),
        });
        std::thread::sleep(Duration::from_millis(2));
    }

    /// Polls until something holds; machines that run tests are busy.
    fn until(&mut self, what: &str, holds: impl Fn(&Bench) -> bool) {
        let begun = Instant::now();
        while !holds(self) {
            assert!(begun.elapsed() < Duration::from_secs(60), "{what}: {:?}", self.notes);
            self.poll();
        }
    }

    fn measuring(port: &str) -> Bench {
        let mut bench = Bench::new(port);
        bench.until("measuring", |bench| bench.session.phase() == Phase::Measuring);
        bench.until("frames", |bench| bench.frames.len() > 8);
        bench
    }

    fn has_note(&self, words: &str) -> bool {
        self.notes.iter().any(|note| note.contains(words))
    }

    fn drive_v(&self) -> f64 {
        self.board.with(|board| board.drive_v())
    }

    /// Arms, and waits until a pad is driven.
    fn armed() -> Bench {
        let mut bench = Bench::measuring("virtual:fig9");
        // A machine that is too busy for signs of life finds a fault, and the drive off.
        while bench.drive_v() <= 1.0 {
            bench.until("driven, or off", |bench| {
                bench.drive_v() > 1.0 || bench.session.phase() == Phase::Measuring
            });
            let _ = bench.session.arm();
            let _ = bench.session.set_target(0, 0.2);
        }
        bench
    }
}

#[test]
fn a_sound_board_is_identified_tested_and_measures() {
    let bench = Bench::measuring("virtual");
    assert!(bench.has_note("protocol 3, digest"), "{:?}", bench.notes);
    assert!(bench.has_note("8 data lines tested"), "{:?}", bench.notes);
    let counts = bench.session.statistics();
    assert_eq!((counts.lost, counts.damaged, counts.dropped, counts.refused), (0, 0, 0, 0));
    assert!(bench.frames.iter().all(|packet| !packet.frame.flags.lost));
}

#[test]
fn frames_are_those_of_a_simulated_core() {
    let bench = Bench::measuring("virtual");
    let (profile, device) =
        bench.board.with(|board| (board.profile().clone(), (**board.case().device).clone()));
    let mut readout = hapticore_host::Readout::new(&profile, &device);
    for Packet { frame, .. } in &bench.frames {
        let (measured, flags) = readout.convert(&frame.measurement(&profile));
        assert!(measured.capacitance_pf > 50.0 && flags.is_empty(), "{measured:?} {flags}");
    }
}

#[test]
fn a_broken_data_line_is_named_and_the_board_never_enabled() {
    let mut bench = Bench::new("virtual");
    bench.board.break_with(|faults| faults.wrong.push(Wrong::LineLow(3)));
    bench.until("refused", |bench| bench.session.phase() == Phase::Refused);
    assert!(matches!(bench.session.refusal(), Some(StartupError::Line { line: 3, .. })));
    assert!(bench.has_note("dout[3] (DOUTD of the ADC)"), "{:?}", bench.notes);
    assert!(!bench.board.with(|board| board.is_enabled()) && bench.frames.is_empty());
    bench.board.break_with(|faults| faults.wrong.clear());
    bench.until("mended", |bench| bench.session.phase() == Phase::Measuring);
}

#[test]
fn a_noisy_line_loses_packets_and_says_how_many() {
    let mut bench = Bench::measuring("virtual");
    bench.board.break_with(|faults| faults.noise = Noise { lost: 2e-4, flipped: 2e-4 });
    bench.until("damage", |bench| bench.session.statistics().damaged > 3);
    bench.board.break_with(|faults| faults.noise = Noise::default());
    let counts = bench.session.statistics();
    assert!(counts.lost > 0 && counts.lost <= 3 * counts.damaged, "{counts:?}");
    assert_eq!(bench.session.phase(), Phase::Measuring, "and goes on");
}

#[test]
fn a_clock_that_is_off_is_no_loss() {
    let mut bench = Bench::measuring("virtual");
    for speed in [0.97, 1.03] {
        bench.board.set_speed(speed);
        let before = bench.frames.len();
        bench.until("frames", |bench| bench.frames.len() > before + 200);
    }
    let counts = bench.session.statistics();
    assert_eq!((counts.lost, counts.dropped, counts.damaged), (0, 0, 0));
}

#[test]
fn no_drive_until_it_is_armed_and_none_after_a_disarm() {
    let mut bench = Bench::measuring("virtual:fig9");
    let refused = bench.session.set_target(0, 0.2).expect_err("the drive is off").to_string();
    assert!(refused.starts_with("target: expected an armed drive"), "{refused}");
    let frames = bench.frames.len();
    bench.until("frames", |bench| bench.frames.len() > frames + 100);
    assert!(bench.frames.iter().all(|of| of.status.driven.is_some_and(|of| of.word == 0)));
    bench.session.arm().expect("it measures");
    assert_eq!(bench.session.target_n(0), 0.0);
    bench.session.set_target(0, 0.2).expect("within the cap");
    bench.until("driven", |bench| bench.drive_v() > 1.0);
    bench.session.disarm();
    bench.until("off", |bench| bench.drive_v() == 0.0);
    assert_eq!(bench.session.phase(), Phase::Measuring);
}

#[test]
fn after_an_unplugged_line_the_drive_stays_off() {
    let mut bench = Bench::armed();
    bench.board.unplug(true);
    bench.until("noticed", |bench| bench.session.phase() == Phase::Disconnected);
    assert!(bench.has_note("stays off until it is armed again"), "{:?}", bench.notes);
    bench.board.unplug(false);
    bench.until("back", |bench| bench.session.phase() == Phase::Measuring);
    let frames = bench.frames.len();
    bench.until("frames", |bench| bench.frames.len() > frames + 50);
    assert_eq!(bench.drive_v(), 0.0);
}

#[test]
fn after_a_reset_of_the_board_the_drive_stays_off() {
    let mut bench = Bench::armed();
    bench.board.reboot();
    bench.until("noticed", |bench| bench.has_note("the board has restarted"));
    bench.until("back", |bench| bench.session.phase() == Phase::Measuring);
    let frames = bench.frames.len();
    bench.until("frames", |bench| bench.frames.len() > frames + 50);
    assert_eq!(bench.drive_v(), 0.0);
}

#[test]
fn a_host_that_ends_leaves_the_board_disabled() {
    let bench = Bench::armed();
    let board = bench.board.clone();
    drop(bench);
    assert!(!board.with(|board| board.is_enabled()));
    assert_eq!(board.with(|board| board.drive_v()), 0.0);
}

#[test]
fn an_open_terminal_takes_the_drive_to_zero_until_it_is_mended() {
    let mut bench = Bench::armed();
    bench.board.break_with(|faults| faults.wrong.push(Wrong::Open(2)));
    bench.until("0 V", |bench| bench.drive_v() == 0.0);
    // Frames of before are on their way still.
    let is_lost = |bench: &Bench| bench.frames.last().is_some_and(|of| of.frame.flags.lost);
    bench.until("a frame that says why", is_lost);
    let frames = bench.frames.len();
    bench.until("frames", |bench| bench.frames.len() > frames + 50);
    let later = &bench.frames[frames..];
    assert!(later.iter().all(|of| of.frame.flags.lost), "an open terminal");
    assert!(later.iter().all(|of| of.status.driven.is_some_and(|of| of.word == 0)));
    bench.board.break_with(|faults| faults.wrong.clear());
    // The drive may have been lost meanwhile to a machine that is too busy.
    bench.until("driven again, or off", |bench| {
        bench.drive_v() > 1.0 || bench.session.phase() == Phase::Measuring
    });
}

#[test]
fn a_host_that_hangs_is_missed_by_the_board() {
    let mut bench = Bench::armed();
    // A reader that is at work keeps the board running, no sign of life is sent.
    std::thread::sleep(Duration::from_millis(600));
    assert_eq!(bench.drive_v(), 0.0);
    bench.until("told", |bench| bench.has_note("this host was silent for too long"));
    assert_eq!(bench.session.phase(), Phase::Measuring);
}

#[test]
fn what_cannot_be_driven_is_refused_in_words() {
    let mut bench = Bench::measuring("virtual:fig9");
    let words = |refused: Result<(), Refusal>| refused.unwrap_err().to_string();
    assert!(words(bench.session.set_target(99, 0.1)).starts_with("pad: expected below"));
    assert!(words(bench.session.set_target(0, 1e6)).starts_with("target: expected 0 to"));
    assert!(words(bench.session.set_target(0, f64::NAN)).starts_with("target: expected 0 to"));
    bench.session.disable();
    assert!(words(bench.session.arm()).contains("it is off"));
    let mut sensor = Bench::measuring("virtual");
    assert!(words(sensor.session.arm()).contains("this board has no drive"));
}

#[test]
fn a_writer_never_waits_for_a_board_that_is_behind() {
    let mut board = Bench::new("virtual").board;
    let mut writer = board.open().expect("plugged in").writer;
    let (done, is_done) = mpsc::channel();
    board.with(|_| {
        std::thread::spawn(move || done.send(writer.write_all(&[0]).is_ok()));
        assert_eq!(is_done.recv_timeout(Duration::from_secs(20)), Ok(true), "the board is at work");
    });
}
