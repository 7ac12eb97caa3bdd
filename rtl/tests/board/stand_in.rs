// SPDX-License-Identifier: MIT OR Apache-2.0
//! What programs that stand in for a board send, byte for byte against the gateware: heartbeats with the words that
//! commands have written, frames with those of the core.

use crate::device::calibration;
use crate::device::short_profiles;
use crate::session::{Session, parameters, samples, simulated};
use hapticore_contract::profile::Profile;
use hapticore_host::ad7606c::Part;
use hapticore_host::startup::{AdcSetup, prepare};
use hapticore_host::{Command, END, Heartbeat, Message, Packet, Register, Status, WordFormats};

/// The heartbeat that a stand-in sends after these commands.
fn stand_in(profile: &Profile, commands: &[Command], status: Status) -> Heartbeat {
    let mut part = Part::new(0x31);
    let mut heartbeat = Heartbeat::new(status, profile, None);
    for command in commands {
        let Command::Register(register, code) = *command else { continue };
        heartbeat = match register {
            Register::Control => heartbeat,
            Register::Adc => {
                let answer = part.answer();
                let bits: Vec<_> = (0..16).rev().map(|bit| code >> bit & 1).collect();
                part.word(&bits).expect("the start-up's words are the part's");
                heartbeat.with_adc_answer(answer, code as u16, profile)
            }
            Register::Constant(_) => {
                let format = register.format(&WordFormats::new(profile));
                assert!(format.code(format.real(code)).is_some(), "{register}");
                heartbeat.calibrated |= register == Register::LAST_CONSTANT;
                heartbeat.with_word(register.number(), code as u64, profile)
            }
        };
    }
    heartbeat
}

#[test]
fn a_stand_in_sends_the_bytes_of_the_gateware() {
    for profile in short_profiles() {
        let (calibration, samples) = (calibration(&profile), samples(&profile, 5));
        let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples);
        let commands = prepare(&profile, &calibration, &AdcSetup::default());
        session.send(&commands);
        // The one that is under way may have begun before.
        for _ in 0..2 {
            let before = session.heartbeats.len();
            while session.heartbeats.len() == before {
                session.clock();
            }
        }
        let told = *session.heartbeats.last().expect("two have come");
        let own = stand_in(&profile, &commands, told.status);
        assert_eq!(told, own, "{}", profile.name);
        let own = Message::Heartbeat(own).encode(&profile);
        assert!(session.bytes.ends_with(&own), "{}: {told:?}", profile.name);

        session.send(&[Command::ENABLE]);
        session.packets(5);
        let frames = simulated(&profile, &calibration, &samples);
        for (frame, packet) in frames.into_iter().zip(&session.packets) {
            let status = packet.expect("a clean line").status;
            let own = Message::Frame(Packet { status, frame }).encode(&profile);
            let with_end = [&[END][..], &own].concat();
            let is_there = session.bytes.windows(with_end.len()).any(|sent| sent == with_end);
            assert!(is_there, "{}: frame {}", profile.name, status.sequence);
        }
    }
}
