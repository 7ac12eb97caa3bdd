// SPDX-License-Identifier: MIT OR Apache-2.0
//! A board that a thread polls: its rows, and a drive that ends with the program that armed it.

use std::time::{Duration, Instant};

use hapticore_board::background::{ALIVE, Background, Seen};
use hapticore_board::source::Board;
use hapticore_board::target::{Asked, Target, target};
use hapticore_board::virtual_line::Running;
use hapticore_host::link::Phase;
use hapticore_live::protocol::Command;
use hapticore_live::source::Source;

/// A virtual board, its thread, and what it is connected by.
struct Bench {
    background: Background,
    board: Running,
    again: Target,
}

impl Bench {
    fn new(port: &str) -> Bench {
        let found = target(&Asked { port: port.into(), ..Asked::default() }).expect("bundled");
        let again = found.again().expect("a name");
        let board = found.running.clone().expect("a virtual one");
        Bench { background: Background::start(found, port).expect("a thread"), board, again }
    }

    /// Waits until something is so; machines that run tests are busy.
    fn until(&self, what: &str, is_so: impl Fn(&Seen) -> bool) {
        let is_so = self.background.wait(Duration::from_secs(60), is_so);
        assert!(is_so, "{what}: {:?}", self.background.seen().notes);
    }

    fn measuring(port: &str) -> Bench {
        let bench = Bench::new(port);
        bench.until("measuring", |seen| seen.phase == Some(Phase::Measuring));
        bench
    }

    fn act(&self, act: impl FnOnce(&mut Board) -> Result<(), String> + Send + 'static) {
        let done = self.background.act(act).recv_timeout(Duration::from_secs(60));
        let _ = done.expect("the thread answers");
    }

    fn drive_v(&self) -> f64 {
        self.board.with(|board| board.drive_v())
    }

    /// Arms, and calls until a pad is driven: a machine that is too busy for signs of life finds a fault.
    fn armed() -> Bench {
        let bench = Bench::measuring("virtual:fig9");
        let begun = Instant::now();
        while bench.drive_v() <= 1.0 {
            assert!(begun.elapsed() < Duration::from_secs(60), "driven");
            bench.act(|board| board.apply(&Command::Arm { on: true }));
            bench.act(|board| board.set_target(0, 0.2));
            std::thread::sleep(Duration::from_millis(20));
        }
        bench
    }

    fn until_off(&self, begun: Instant) {
        while self.drive_v() > 0.0 {
            assert!(begun.elapsed() < Duration::from_secs(60), "off");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}

#[test]
fn rows_wait_until_they_are_taken() {
    let bench = Bench::measuring("virtual");
    bench.until("rows", |seen| seen.unread() >= 40);
    assert!(bench.background.take_exactly(1 << 40).is_none(), "fewer are there");
    let first = bench.background.take_exactly(15).expect("so many");
    let rest = bench.background.take_rows();
    assert_eq!(first.len(), 15);
    let times: Vec<_> = first.iter().chain(&rest).map(|row| row.time_s).collect();
    assert!(times.is_sorted() && times.len() >= 40);
    let seen = bench.background.seen();
    assert!(seen.identity.as_ref().is_some_and(|of| of.contains("protocol 3")), "{seen:?}");
    assert_eq!((seen.dropped_rows, seen.refusal.as_deref()), (0, None));
}

#[test]
fn a_program_that_makes_no_call_loses_the_drive() {
    let bench = Bench::armed();
    let begun = Instant::now();
    bench.until_off(begun);
    let took = begun.elapsed();
    // A machine that is too busy for signs of life loses it earlier, by the board itself.
    assert!(took < ALIVE + Duration::from_secs(20), "{took:?}");
    bench.until("disarmed", |seen| seen.phase == Some(Phase::Measuring));
    let seen = bench.background.seen();
    let whys = ["made no call for 1 s", "was silent for too long"];
    assert!(seen.notes.iter().any(|note| whys.iter().any(|why| note.contains(why))), "{seen:?}");
}

#[test]
fn a_board_that_is_closed_drives_nothing_and_is_disabled() {
    let bench = Bench::armed();
    bench.background.close();
    assert_eq!(bench.drive_v(), 0.0);
    assert!(!bench.board.with(|board| board.is_enabled()));
    assert!(bench.background.seen().has_ended);
    assert!(bench.background.act(|_| Ok(())).recv().is_err(), "nobody answers");
    bench.background.close();
}

#[test]
fn a_board_is_released_for_another_connection_and_comes_back() {
    let bench = Bench::armed();
    bench.background.release().recv().expect("released");
    assert!(!bench.board.with(|board| board.is_enabled()));
    assert_eq!(bench.drive_v(), 0.0);
    let refused = bench.background.act(|_| Ok(())).recv().expect("an answer").unwrap_err();
    assert!(refused.contains("being checked"), "{refused}");
    let again = bench.again.again().expect("a name");
    bench.background.resume(again);
    bench.until("measuring", |seen| seen.phase == Some(Phase::Measuring));
    let _ = bench.background.take_rows();
    bench.until("rows", |seen| seen.unread() >= 40);
    assert_eq!(bench.drive_v(), 0.0);
}

#[test]
fn a_line_that_does_not_open_is_noted() {
    let device = target(&Asked { port: "virtual".into(), ..Asked::default() }).expect("bundled");
    let line = hapticore_host::link::line("tcp:127.0.0.1:1", 1_000_000).expect("a name");
    let found = Target { line, running: None, ..device };
    let background = Background::start(found, "tcp:127.0.0.1:1").expect("a thread");
    assert!(background.wait(Duration::from_secs(60), |seen| !seen.notes.is_empty()));
    let seen = background.seen();
    assert_eq!(seen.phase, Some(Phase::Disconnected));
    assert!(seen.notes[0].starts_with("tcp:127.0.0.1:1: "), "{seen:?}");
}
