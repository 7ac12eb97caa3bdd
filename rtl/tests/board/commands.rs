// SPDX-License-Identifier: MIT OR Apache-2.0
//! Commands at random times: none reaches the ADC that was not meant for it, and no frame suffers.

use crate::device::calibration;
use crate::random::Random;
use crate::session::{Session, parameters, samples, simulated, small};
use hapticore_contract::profile::Profile;
use hapticore_host::Constant;
use hapticore_host::startup::start;
use hapticore_host::{Command, encode};
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::framing::Register;

const SEED: u64 = 41;
const COMMANDS: usize = 10_000;

/// A command that leaves the calibration as it is, and the bytes that damage has made of some of
/// them.
fn harmless(profile: &Profile, core: &Core, commands: &[Command], random: &mut Random) -> Vec<u8> {
    let formats = core.inputs().calibration;
    // Words that the map's address could name but that it does not have; bits above the address are
    // ignored.
    let (words, most) = (core.estimator().table().words as u64, 1 << formats.table.address.width);
    let beyond = words + random.below(most - words) + most * random.below(0x8000 / most);
    let any = random.word(formats.force_gain);
    let command = match random.below(5) {
        0 => commands[random.below(commands.len() as u64) as usize],
        1 => Command::Table { address: beyond as u16, code: random.bits() as i64 },
        2 => Command::Register(Register::Adc, random.below(1 << 16) as i64),
        3 => Command::ENABLE,
        _ => {
            let mut bytes =
                encode(&[Command::Register(Register::Constant(Constant::ForceGain), any)], profile);
            let at = 1 + random.below(bytes.len() as u64 - 2) as usize;
            bytes[at] ^= 1 << random.below(8);
            return bytes;
        }
    };
    encode(&[command], profile)
}

/// Those commands of a start that only repeat what is there.
fn calibrating(profile: &Profile) -> Vec<Command> {
    let commands = start(profile, &calibration(profile));
    let register = |command: &Command| {
        matches!(command, Command::Register(Register::Adc | Register::Control, _))
    };
    commands.into_iter().filter(|command| !register(command)).collect()
}

#[test]
fn ten_thousand_commands_while_enabled_reach_no_register_of_the_adc_and_harm_no_frame() {
    let profile = small();
    let (calibration, core) = (calibration(&profile), Core::new(&profile));
    let samples = samples(&profile, 2_600);
    let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples);
    session.send(&start(&profile, &calibration));
    let commanded = session.adc.part.commands.len();
    session.adc.sdi_changes = 0;
    let (mut random, repeated) = (Random::new(SEED), calibrating(&profile));
    for _ in 0..COMMANDS {
        session.host.send(harmless(&profile, &core, &repeated, &mut random));
        while !session.host.can_skip() {
            session.clock();
        }
        session.run(random.below(600));
    }
    let packets: Vec<_> =
        session.packets.iter().map(|packet| packet.expect("the line is clean")).collect();
    let expected = simulated(&profile, &calibration, &samples);
    let wrong = packets
        .iter()
        .zip(&expected)
        .filter(|(packet, expected)| packet.frame != **expected)
        .count();
    let unintended = session.adc.part.commands.len() - commanded;
    println!("{} frames, {wrong} wrong; {unintended} unintended commands", packets.len());
    assert!(packets.len() > 1_000 && packets.len() < expected.len());
    assert!(
        !packets.iter().any(|packet| packet.status.late || packet.status.overrun),
        "and none is flagged"
    );
    assert_eq!((unintended, wrong, session.adc.sdi_changes), (0, 0, 0));
    assert_eq!(session.adc.wrong, Vec::<&str>::new());
}
