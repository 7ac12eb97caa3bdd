// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damage on the serial line: whatever becomes of bytes or of the wire, the board and the host are
//! right again with the first packet behind an END. And packets that take the same time whatever
//! they contain.

use crate::bench::Bench;
use crate::device::calibration;
use crate::pins::Host;
use crate::random::Random;
use crate::session::{Session, parameters, samples, simulated, small};
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::format::Format;
use hapticore_host::startup::start;
use hapticore_host::{Command, WordFormats};
use hapticore_model::blocks::core::Core;
use hapticore_protocol::framing::{command_bytes, packet_bytes};
use hapticore_rtl::board::framing::END;
use hapticore_rtl::board::registers::{self, CommandRegisters};
use hapticore_rtl::board::stream::{self, Stream};
use hapticore_rtl::board::uart::receiver::{self, Receiver};

const SEED: u64 = 29;
const DIVISOR: u64 = 12;

/// A board's end of the line, and which words of the position table were written.
struct Port {
    receiver: Bench<Receiver>,
    registers: Bench<CommandRegisters>,
    written: Vec<Command>,
    word: Format,
}

impl Port {
    fn new(profile: &Profile) -> Self {
        let calibration = Core::new(profile).inputs().calibration;
        Port {
            receiver: Bench::new(Receiver::new(DIVISOR)),
            registers: Bench::new(CommandRegisters::new(calibration, 100, None)),
            written: Vec::new(),
            word: calibration.table.word,
        }
    }

    /// A clock with a level of the line.
    fn level(&mut self, rx: i64) {
        let receiver::Outputs { valid, octet } = self.receiver.clock(receiver::Inputs { rx });
        self.registers(valid, octet);
    }

    /// A clock with a byte, and one without.
    fn byte(&mut self, byte: u8) {
        self.registers(1, byte.into());
        self.registers(0, 0);
    }

    fn registers(&mut self, valid: i64, octet: i64) {
        let inputs = registers::Inputs { valid, octet, shift: 0, answer: 0 };
        let table = self.registers.clock(inputs).table;
        let command = Command::Table { address: table.address as u16, code: table.word };
        self.written.extend((table.write != 0).then_some(command));
    }

    /// Any command that writes a word.
    fn command(&self, random: &mut Random) -> Command {
        Command::Table { address: random.below(100) as u16, code: random.word(self.word) }
    }
}

/// Loses, doubles, flips or reorders bytes from a place on; whether END is among those.
fn damage(bytes: &mut Vec<u8>, at: usize, random: &mut Random) -> bool {
    let touched = at..(at + 1 + random.below(4) as usize).min(bytes.len());
    let with_end = bytes[touched.clone()].contains(&END);
    match random.below(4) {
        0 => drop(bytes.drain(touched)),
        1 => drop(bytes.splice(at..at, bytes[touched].to_vec())),
        2 => bytes[at] ^= 1 << random.below(8),
        _ => bytes[touched].reverse(),
    }
    with_end
}

#[test]
fn lost_doubled_flipped_and_reordered_bytes_of_a_command_write_nothing_and_the_next_is_taken() {
    let profile = small();
    let (mut port, mut random) = (Port::new(&profile), Random::new(SEED));
    let mut refused = 0;
    for round in 0..20_000 {
        let sent: [Command; 4] = std::array::from_fn(|_| port.command(&mut random));
        let mut bytes = sent.map(|command| command.encode(&profile));
        let at = random.below(bytes[1].len() as u64) as usize;
        let with_end = damage(&mut bytes[1], at, &mut random);
        port.written.clear();
        bytes.concat().into_iter().for_each(|byte| port.byte(byte));
        // Bytes may be lost or come twice that say nothing, or change places with their like.
        let without =
            if with_end { vec![sent[0], sent[3]] } else { vec![sent[0], sent[2], sent[3]] };
        let heard = &port.written;
        assert!(heard.starts_with(&sent[..1]) && heard.ends_with(&sent[3..]), "{round}: {heard:?}");
        assert!(
            heard.iter().all(|command| sent.contains(command)),
            "{round}: {heard:?} of {sent:?}"
        );
        assert!(
            without.iter().all(|command| heard.contains(command)),
            "{round}: {heard:?} of {sent:?}"
        );
        refused += usize::from(!heard.contains(&sent[1]));
    }
    println!("{refused} of 20000 damaged commands were refused");
    assert!(refused > 15_000);
}

/// A host sends commands without a pause while the wire is pulled out and put back, at any bit.
#[test]
fn a_wire_unplugged_in_mid_command_costs_no_command_behind_the_next_end() {
    let profile = small();
    let length = 10 * DIVISOR * command_bytes(&WordFormats::new(&profile));
    let (mut random, mut lost) = (Random::new(SEED), 0);
    for round in 0..300 {
        let mut port = Port::new(&profile);
        let sent: Vec<_> = (0..12).map(|_| port.command(&mut random)).collect();
        let mut host = Host::new(DIVISOR);
        host.send(sent.iter().flat_map(|command| command.encode(&profile)));
        let from = random.below(4 * length);
        let (to, level) = (from + 1 + random.below(3 * length), random.below(2) as i64);
        for clock in 0..13 * length {
            port.level(if (from..to).contains(&clock) { level } else { host.line() });
            host.clock(1);
        }
        // Those that were over before, and those behind an END that began after.
        let before = from.saturating_sub(DIVISOR) / length;
        let after = (to + 10 * DIVISOR).div_ceil(length);
        let (before, after) = (&sent[..before as usize], &sent[after as usize..]);
        let heard = &port.written;
        assert!(heard.starts_with(before), "{round}: {from} to {to}: {heard:?} of {sent:?}");
        assert!(heard.ends_with(after), "{round}: {from} to {to}: {heard:?} of {sent:?}");
        assert!(heard.iter().all(|command| sent.contains(command)), "{round}: {heard:?}");
        lost += sent.len() - heard.len();
    }
    println!("{lost} commands lost in 300 interruptions of up to three commands");
    assert!(lost > 300);
}

/// The wire to the host is pulled out at any time and put back, mostly in the middle of a frame.
#[test]
fn a_wire_unplugged_in_mid_frame_costs_no_frame_but_those_meanwhile_and_one() {
    const ROUNDS: u64 = 24;
    const DIVISOR: u64 = 4;
    let profile = small();
    let (slot, packet) = (profile.slot_clocks(), packet_bytes(&profile) * (10 * DIVISOR + 1));
    let (calibration, samples) = (calibration(&profile), samples(&profile, 8 * ROUNDS as usize));
    let expected = simulated(&profile, &calibration, &samples);
    let mut session = Session::new(&profile, parameters(&profile, DIVISOR, 0), &samples);
    session.send(&start(&profile, &calibration));
    let (mut random, mut damaged) = (Random::new(SEED), 0);
    for round in 0..ROUNDS {
        // Frames end a slot apart.
        session.next_packet();
        let out = random.below(slot);
        let back = (2 + random.below(2)) * slot - random.below(packet + packet / 8);
        session.run(out);
        session.unplugged = Some(random.below(2) as i64);
        session.run(back - out);
        session.unplugged = None;
        let heard = session.packets.len();
        // The frame in progress is damaged, and may be heard as several; of three one is lost.
        session.run(3 * slot);
        let after = &session.packets[heard..];
        let wrong = after.iter().filter(|packet| packet.is_err()).count();
        damaged += u64::from(wrong > 0);
        assert!(after.len() >= wrong + 2, "{round}: {after:?}");
        assert!(after[wrong..].iter().all(|packet| packet.is_ok()), "{round}: {after:?}");
    }
    println!("a frame damaged by {damaged} of {ROUNDS} interruptions");
    assert!(damaged > ROUNDS / 2, "{damaged}");
    for packet in session.packets.iter().filter_map(|packet| packet.ok()) {
        assert_eq!(packet.frame, expected[usize::from(packet.status.sequence) - 1]);
    }
}

#[test]
fn a_packet_takes_the_same_clocks_whatever_it_contains_and_whatever_is_written_meanwhile() {
    for profile in Profile::all() {
        let data = CommandRegisters::new(Core::new(&profile).inputs().calibration, 100, None)
            .outputs()
            .data;
        for divisor in [4, DIVISOR] {
            let stream = Stream::new(&profile, divisor, data, None);
            let (packet, of) = (stream.packet_clocks(divisor), stream.inputs());
            let quiet = stream::Inputs { enable: 1, ..stream::Inputs::map(of, |_| 0) };
            let (mut bench, mut random) = (Bench::new(stream), Random::new(SEED));
            for _ in 0..40 {
                for index in 0..8 {
                    let any = random.word(of.frames.frame);
                    let frame = if random.below(2) == 0 { any & 0x7f00 } else { any };
                    let mut inputs = quiet;
                    (inputs.frames.valid, inputs.frames.index) = (1, index);
                    (inputs.frames.frame, inputs.frames.done) = (frame, (index == 7).into());
                    bench.clock(inputs);
                }
                let mut clocks = 0;
                // Until END has been taken by the transmitter, whose byte then takes ten bits.
                while bench.registers().busy != 0 {
                    let keep = (random.below(5) == 0).into();
                    bench.clock(stream::Inputs { keep, data: random.word(data), ..quiet });
                    clocks += 1;
                }
                assert_eq!(clocks + 10 * divisor, packet, "{}", profile.name);
                for _ in 0..10 * divisor {
                    bench.clock(quiet);
                }
            }
        }
    }
}
