// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same bytes of a host for both boards, at the same device times: each sends the same packets, byte for byte.
//!
//! | compared | left out |
//! | --- | --- |
//! | every packet of a frame, in order | when they come: the gateware's begin by its core's latency later |
//! | the last heartbeat before each message of the host | the number of the last frame's pad in it, which means nothing; heartbeats that are cut, or begin while commands come: the virtual board takes commands without the time that their bytes need; how many there are |

use hapticore_board::bench::SteppedBoard;
use hapticore_board::virtual_board::VirtualBoard;
use hapticore_contract::profile::Profile;
use hapticore_host::bringup::{BringUp, Step};
use hapticore_host::startup::{AdcSetup, prepare};
use hapticore_host::{
    Command, Constant, Decoder, Driven, END, Heartbeat, Message, Register, drive, encode,
};
use hapticore_run::inputs;
use hapticore_scene::Scene;

use crate::clocked::ClockedBoard;
use crate::{BIT_CLOCKS, virtual_board};

/// Heartbeats of both boards come within it, and the test of a line, s.
const SETTLES_S: f64 = 4e-3;

/// A packet as it was on the line, and what it says.
struct Sent {
    bytes: Vec<u8>,
    message: Message,
}

/// Both boards, and what they have sent.
struct Pair {
    profile: Profile,
    gateware: ClockedBoard,
    virtual_board: VirtualBoard,
    bytes: [Vec<u8>; 2],
}

impl Pair {
    fn new(virtual_board: VirtualBoard) -> Pair {
        let gateware = ClockedBoard::of(&virtual_board).expect("a board of a bundled profile");
        let profile = virtual_board.profile().clone();
        Pair { profile, gateware, virtual_board, bytes: [Vec::new(), Vec::new()] }
    }

    /// Lets time pass on both boards.
    fn advance(&mut self, until_s: f64) {
        self.gateware.advance(until_s).expect("a drive that the plant takes");
        self.virtual_board.advance(self.gateware.now_s()).expect("a drive that the plant takes");
        self.take();
    }

    /// Bytes whose command acts at a device time.
    fn send(&mut self, bytes: &[u8], at_s: f64) {
        self.advance(at_s - self.gateware.lead_s(bytes.len(), BIT_CLOCKS));
        self.gateware.receive(bytes).expect("a drive that the plant takes");
        self.virtual_board.advance(at_s).expect("a drive that the plant takes");
        self.virtual_board.receive(bytes);
        self.take();
    }

    /// Commands, as soon as they can be sent.
    fn command(&mut self, commands: &[Command]) {
        let bytes = encode(commands, &self.profile);
        self.send(&bytes, self.gateware.now_s() + self.gateware.lead_s(bytes.len(), BIT_CLOCKS));
    }

    fn take(&mut self) {
        self.bytes[0].extend(self.gateware.take_bytes());
        self.bytes[1].extend(self.virtual_board.take_bytes());
    }

    /// The whole packets of each board so far, whose bytes are then taken.
    fn packets(&mut self) -> [Vec<Sent>; 2] {
        let profile = &self.profile;
        self.bytes.each_mut().map(|bytes| {
            let end = bytes.iter().rposition(|byte| *byte == END).map_or(0, |at| at + 1);
            let left = bytes.split_off(end);
            let whole = std::mem::replace(bytes, left);
            whole.split_inclusive(|byte| *byte == END).filter_map(|of| sent(of, profile)).collect()
        })
    }

    /// The heartbeat that both send once what the host has sent is done.
    fn heartbeat(&mut self, what: &str) -> Heartbeat {
        self.packets();
        self.advance(self.gateware.now_s() + SETTLES_S);
        let [gateware, of_virtual] = self.packets().map(|mut packets| packets.pop());
        let gateware = gateware.expect("the gateware sends heartbeats");
        let of_virtual = of_virtual.expect("the virtual board sends heartbeats");
        // The virtual board's have pad 0, as those of a board that was not enabled yet.
        let is_first = gateware.message.heartbeat().is_some_and(|of| of.status.sequence == 0);
        let expected = match is_first {
            true => gateware.bytes,
            false => gateware.message.encode(&self.profile),
        };
        assert_eq!(
            of_virtual.bytes, expected,
            "{what}: {:?}, the gateware {:?}",
            of_virtual.message, gateware.message
        );
        gateware.message.heartbeat().expect("a heartbeat")
    }

    /// The start-up with tests of all lines; heartbeats are compared at each step.
    fn bring_up(&mut self) -> Command {
        let calibration = self.virtual_board.case().calibration().expect("bundled").clone();
        let mut bring_up = BringUp::new(&self.profile, &calibration, None).with_all_lines();
        let mut commands = bring_up.begin(&AdcSetup::default(), 0);
        loop {
            self.command(&commands);
            let heartbeat = self.heartbeat(&format!("after {} commands", commands.len()));
            commands = match bring_up.heartbeat(&heartbeat).expect("a sound board") {
                Step::Wait => Vec::new(),
                Step::Send(commands) => commands,
                Step::Ready(enable) => return enable,
            };
        }
    }

    /// Enables both as a round of all pads begins, and disables them in the middle of a slot, `slots` slots later; meanwhile
    /// bytes of the host, by the slot in whose middle their last one comes. The frames of the gateware, compared with the
    /// virtual board's.
    fn run(&mut self, slots: usize, meanwhile: &[(usize, Vec<u8>)]) -> Vec<Sent> {
        let (slot_s, pads) = (self.virtual_board.case().clock.seconds(1), self.profile.pads as f64);
        let round_s = pads * slot_s;
        let begin_s = round_s * (self.gateware.now_s() / round_s + 0.5).ceil();
        self.send(&encode(&[Command::ENABLE], &self.profile), begin_s - 1e-6);
        for (slot, bytes) in meanwhile {
            self.send(bytes, begin_s + (*slot as f64 + 0.8) * slot_s);
        }
        let disable = encode(&[Command::DISABLE], &self.profile);
        self.send(&disable, begin_s + (slots as f64 + 0.8) * slot_s);
        self.advance(self.gateware.now_s() + SETTLES_S);
        let [gateware, of_virtual] = self.packets().map(|packets| {
            packets.into_iter().filter(|sent| sent.message.frame().is_some()).collect::<Vec<_>>()
        });
        for (number, (of_virtual, gateware)) in of_virtual.iter().zip(&gateware).enumerate() {
            assert_eq!(
                of_virtual.bytes, gateware.bytes,
                "frame {number}: {:?}, the gateware's {:?}",
                of_virtual.message, gateware.message
            );
        }
        assert_eq!((of_virtual.len(), gateware.len()), (slots, slots), "frames");
        gateware
    }
}

/// A packet by its bytes; none where it was cut.
fn sent(bytes: &[u8], profile: &Profile) -> Option<Sent> {
    let mut decoder = Decoder::new(profile);
    let message = decoder.decode(bytes.iter().copied()).next()?.ok()?;
    Some(Sent { bytes: bytes.to_vec(), message })
}

fn scene(name: &str) -> Scene {
    inputs::scene(name, &[]).expect("bundled")
}

fn bundled(name: &str) -> Profile {
    Profile::bundled(name).expect("bundled")
}

/// A command with a bit that is another.
fn damaged(command: Command, profile: &Profile) -> Vec<u8> {
    let mut bytes = command.encode(profile);
    bytes[3] ^= 0x10;
    bytes
}

#[test]
fn a_virtual_board_sends_the_bytes_of_the_gateware() {
    let mut pair = Pair::new(virtual_board(scene("hockey"), 0, &bundled("small")));
    let first = pair.heartbeat("just configured");
    assert!(!first.calibrated && first.status.commands == 0);
    let enable = pair.bring_up();
    assert_eq!(enable, Command::ENABLE);
    let profile = pair.profile.clone();
    let refused = Command::Register(Register::Adc, 0x6f00);
    let constant = Command::Register(Register::Constant(Constant::ForceGain), 5);
    let meanwhile = [
        (9, encode(&[refused], &profile)),
        (13, damaged(constant, &profile)),
        (17, encode(&[constant], &profile)),
    ];
    let frames = pair.run(28, &meanwhile);
    let frames: Vec<_> = frames.iter().filter_map(|sent| sent.message.frame()).collect();
    let refusals = frames.iter().filter(|packet| packet.status.refused).count();
    assert_eq!(refusals, 2, "the ADC's word and the damaged command");
    for pad in 0..profile.pads as usize {
        let of_pad = frames.iter().filter(|packet| packet.frame.pad == pad);
        let valid = of_pad.filter(|packet| !packet.frame.flags.invalid).count();
        assert_eq!(valid, 7, "pad {pad} is measured");
    }
    let disabled = pair.heartbeat("disabled");
    assert_eq!(disabled.status.sequence, 28);
    assert_eq!(pair.run(8, &[]).len(), 8, "and again");
    assert_eq!(pair.gateware.adc.wrong, Vec::<&str>::new());
}

#[test]
fn a_virtual_board_with_a_drive_sends_the_frames_and_drive_words_of_the_gateware() {
    let mut standard = bundled("standard");
    // As few words to be sent as a map may have.
    (standard.position.columns, standard.position.rows) = (17, 11);
    let mut pair = Pair::new(virtual_board(scene("fig9"), 1, &standard));
    let (profile, case) = (pair.profile.clone(), pair.virtual_board.case().clone());
    let calibration = case.calibration().expect("a calibration that the profile can represent");
    let plant = case.plant().expect("bundled");
    let tuning = case.tuning(&plant).expect("bundled").expect("a case with a controller");
    let target = |newtons: f64| drive::target(&profile, 0, newtons).expect("a controller");
    pair.command(&prepare(&profile, calibration, &AdcSetup::default()));
    pair.command(&[drive::clear_faults()]);
    let untuned = driven(&pair.run(6, &[]));
    assert!(untuned.iter().all(|of| of.word == 0 && !of.faults.any()), "{untuned:?}");
    pair.command(&drive::tune(&profile, &tuning).expect("a controller"));
    let meanwhile = [(3, 0.3), (9, 0.1), (15, 0.0)];
    let meanwhile = meanwhile.map(|(slot, newtons)| (slot, encode(&[target(newtons)], &profile)));
    let words: Vec<i64> = driven(&pair.run(24, &meanwhile)).iter().map(|of| of.word).collect();
    assert!(words[2] == 0 && words[6] > 0 && words[23] == 0, "{words:?}");
}

/// What frames say of the drive.
fn driven(frames: &[Sent]) -> Vec<Driven> {
    frames.iter().filter_map(|sent| sent.message.frame()?.status.driven).collect()
}
