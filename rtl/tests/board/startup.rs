// SPDX-License-Identifier: MIT OR Apache-2.0
//! From a reset to frames, and from one enabling to the next.

use crate::device::{Sight, calibration, codes, short_profiles};
use crate::random::Random;
use crate::session::{Session, parameters, samples, simulated, small};
use hapticore_contract::control::{Control, Law};
use hapticore_contract::profile::Profile;
use hapticore_host::Constant;
use hapticore_host::ad7606c::Part;
use hapticore_host::bringup::{BringUp, Step};
use hapticore_host::startup::{AdcSetup, LineFault, Range, StartupError, check, prepare, start};
use hapticore_host::{Command, Heartbeat};
use hapticore_host::{Dac, Output, Wave};
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::Parameters;
use hapticore_rtl::board::drive_output::Converter;
use hapticore_rtl::board::framing::{self, Register, digest};
use hapticore_rtl::board::parameters::Drive;

const SEED: u64 = 43;
const ROUNDS: usize = 200;

/// A board that has been sent what makes a sensor of it, and is not enabled.
fn prepared(profile: &Profile, id: u8, setup: &AdcSetup) -> (Session, Vec<Command>) {
    let commands = prepare(profile, &calibration(profile), setup);
    let mut session = Session::new(profile, parameters(profile, 4, 0), &samples(profile, 9));
    session.adc.part = Part::new(id);
    session.send(&commands);
    (session, commands)
}

/// What the board tells next that has begun after now.
fn heartbeat(session: &mut Session) -> Heartbeat {
    let before = session.heartbeats.len();
    while session.heartbeats.len() < before + 2 {
        session.clock();
    }
    *session.heartbeats.last().expect("two have come")
}

#[test]
fn a_prepared_board_tells_what_it_is_and_has_set_up_its_adc() {
    let profile = small();
    let setup = AdcSetup {
        ranges: [
            Range::V5,
            Range::V5,
            Range::V5,
            Range::V5,
            Range::V5,
            Range::V5,
            Range::V10,
            Range::V2_5,
        ],
    };
    let (mut session, commands) = prepared(&profile, 0x31, &setup);
    let told = heartbeat(&mut session);
    assert_eq!(check(&told, &profile, None, &calibration(&profile), (0, commands.len())), Ok(()));
    assert_eq!(
        (told.version, told.digest(), told.adc_answer()),
        (framing::VERSION, digest(&profile), 0x31)
    );
    assert_eq!(session.adc.wrong, Vec::<&str>::new());
    assert_eq!(
        session.adc.part.inputs(),
        ([0x11, 0x11, 0x11, 0x03], 0xff),
        "ranges, and 220 kHz everywhere"
    );
    assert_eq!((session.adc.part.lines(), session.adc.part.register_mode()), (8, false));
    assert_eq!(session.adc.part.commands.len(), setup.words().len());
    assert_eq!(session.adc.conversions, 0);
}

#[test]
fn a_board_that_is_not_as_it_should_be_is_not_enabled() {
    let profile = small();
    let calibration = calibration(&profile);
    for id in [0x14, 0x00, 0xff] {
        let (mut session, commands) = prepared(&profile, id, &AdcSetup::default());
        let told = heartbeat(&mut session);
        assert_eq!(
            check(&told, &profile, None, &calibration, (0, commands.len())),
            Err(StartupError::Adc(id))
        );
    }
    let (mut session, mut commands) = prepared(&profile, 0x22, &AdcSetup::default());
    let told = heartbeat(&mut session);
    assert_eq!(
        check(&told, &profile, None, &calibration, (0, commands.len())),
        Ok(()),
        "as users of the AD7606C-16 report it"
    );
    let other = Profile { pads: 3, ..profile.clone() };
    let error =
        check(&told, &other, None, &calibration, (0, commands.len())).expect_err("another profile");
    assert!(matches!(error, StartupError::Made { .. }), "{error}");
    let error = check(&told, &profile, None, &calibration, (0, commands.len() - 1))
        .expect_err("a command more");
    assert!(matches!(error, StartupError::Commands { .. }), "{error}");
    let wrong = Command::Register(Register::Constant(Constant::ForceGain), 5);
    session.send(&[wrong]);
    commands.push(wrong);
    let error = check(&heartbeat(&mut session), &profile, None, &calibration, (0, commands.len()))
        .expect_err("another scale");
    assert!(
        matches!(
            error,
            StartupError::Register {
                register: Register::Constant(Constant::ForceGain),
                got: 5,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn the_adc_takes_no_command_while_the_board_is_enabled() {
    let profile = small();
    let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples(&profile, 4));
    let commands = start(&profile, &calibration(&profile));
    session.send(&commands);
    session.packets(1);
    session.send(&[Command::Register(Register::Adc, 0x6f00)]);
    let told = session.packets(3);
    assert!(told.iter().any(|packet| packet.status.refused), "it is refused");
    assert_eq!(told[2].status.commands, commands.len() as u8 % 16, "and not counted");
    assert_eq!(session.adc.part.commands.len(), AdcSetup::default().words().len());
}

/// Slots of a pad, one after the other.
fn tones(profile: &Profile, slots: usize) -> Vec<Vec<i32>> {
    let mut random = Random::new(SEED);
    let slot = |_| codes(profile, Sight::Tones, &mut random);
    let codes: Vec<i32> = (0..slots).flat_map(slot).collect();
    codes.chunks(profile.channels()).map(<[i32]>::to_vec).collect()
}

#[test]
fn whenever_a_board_is_disabled_and_enabled_again_its_first_frame_is_whole() {
    let profile = small();
    let (calibration, samples) = (calibration(&profile), tones(&profile, 1_200));
    let (slot, latency) = (profile.slot_clocks(), Core::new(&profile).latency());
    let mut session = Session::new(&profile, parameters(&profile, 4, 0), &samples);
    session.send(&start(&profile, &calibration));
    let (mut random, mut commanded) = (Random::new(SEED), session.adc.part.commands.len());
    for round in 0..ROUNDS {
        session.run(random.below(2 * slot));
        session.send(&[Command::DISABLE]);
        if random.below(2) == 0 {
            let words = AdcSetup::default().words();
            let set_up: Vec<_> =
                words.iter().map(|&word| Command::Register(Register::Adc, word)).collect();
            session.send(&set_up);
            commanded += words.len();
        }
        session.run(latency + 2_000 + random.below(slot));
        let (from, heard) = (session.adc.conversions, session.packets.len());
        session.send(&[Command::ENABLE]);
        let packet = session.packets(heard + 1)[heard];
        let of_slot = &samples[from..from + profile.slot.samples() as usize];
        assert_eq!(
            packet.frame,
            simulated(&profile, &calibration, of_slot)[0],
            "round {round}, from sample {from}"
        );
        assert!(
            !(packet.status.late || packet.status.refused || packet.status.overrun),
            "round {round}: {packet:?}"
        );
        assert_eq!(
            session.adc.part.commands.len(),
            commanded,
            "round {round}: nothing else was commanded"
        );
    }
    assert_eq!(session.adc.wrong, Vec::<&str>::new());
}

/// What a host does until the board is ready, or refused: each step's commands, then a heartbeat that begins behind them.
fn bring_up(session: &mut Session, profile: &Profile) -> Result<(), StartupError> {
    let calibration = calibration(profile);
    let mut bring_up = BringUp::new(profile, &calibration, None);
    let mut commands = bring_up.begin(&AdcSetup::default(), 0);
    loop {
        session.send(&commands);
        commands = loop {
            let told = heartbeat(session);
            match bring_up.heartbeat(&told)? {
                Step::Wait => (),
                Step::Send(commands) => break commands,
                Step::Ready(enable) => {
                    assert_eq!(enable, Command::ENABLE);
                    return Ok(());
                }
            }
        };
    }
}

/// Both widths of codes.
fn boards() -> Vec<(Profile, Session)> {
    let profiles = short_profiles().into_iter().take(2);
    let of = |mut profile: Profile| {
        // As few words to be sent as a map may have.
        (profile.position.columns, profile.position.rows) = (17, 11);
        let samples = samples(&profile, 9);
        (profile.clone(), Session::new(&profile, parameters(&profile, 4, 0), &samples))
    };
    profiles.map(of).collect()
}

#[test]
fn a_board_whose_lines_bring_their_codes_is_enabled_and_measures() {
    for (profile, mut session) in boards() {
        assert_eq!(bring_up(&mut session, &profile), Ok(()), "{}", profile.name);
        assert_eq!(session.adc.wrong, Vec::<&str>::new(), "{}", profile.name);
        assert!(!session.adc.part.register_mode() && session.adc.part.lines() == 8);
        let tested = session.adc.conversions;
        assert!(tested >= profile.channels() * 64, "{}: {tested} codes", profile.name);
        session.send(&[Command::ENABLE]);
        let packets = session.packets(2);
        assert!(!packets[1].status.late, "{}", profile.name);
        assert!(session.adc.part.fixed_codes(18).is_none(), "samples again");
    }
}

#[test]
fn a_board_with_a_broken_line_is_refused_and_the_line_is_named() {
    let channels = small().channels();
    for (line, level) in (0..channels).flat_map(|line| [(line, 0), (line, 1)]) {
        let (profile, mut session) = boards().swap_remove(line % 2);
        session.adc.broken = Some((line, level));
        let error = bring_up(&mut session, &profile).expect_err("a broken line");
        let fault = if level == 0 { LineFault::Silent } else { LineFault::Ones };
        // The ADC answers commands on its first line.
        let expected = match line {
            0 => StartupError::Adc(if level == 0 { 0 } else { 0xff }),
            line => StartupError::Line { line: line as u8, fault },
        };
        assert_eq!(error, expected, "{}", profile.name);
        assert!(error.to_string().contains(&format!("dout[{line}] (DOUT")), "{error}");
    }
    let (profile, mut session) = boards().swap_remove(0);
    session.adc.shorted = Some([2, 5]);
    let error = bring_up(&mut session, &profile).expect_err("two lines at one wire");
    assert!(
        error.to_string().contains("dout[5]") && error.to_string().contains("dout[2]"),
        "{error}"
    );
}

#[test]
fn a_board_that_was_printed_for_another_output_is_refused_with_both_named() {
    let mut profile = short_profiles().swap_remove(1);
    profile.control = Some(Control::of(&profile, Law::Open));
    profile.slot.settle += 400;
    let drive = |full_scale_v: u16| Drive {
        wave: Wave::Square { turn_slots: 10 },
        converter: Converter::from(Dac::Ad5664r),
        full_scale_v,
    };
    let parameters = Parameters { drive: Some(drive(500)), ..parameters(&profile, 4, 0) };
    let clock_hz = parameters.clock_hz;
    let mut session = Session::new(&profile, parameters, &samples(&profile, 3));
    let told = heartbeat(&mut session);
    let made = |output: Option<Output>| {
        let calibration = calibration(&profile);
        let checked = check(&told, &profile, output.as_ref(), &calibration, (0, 0));
        checked.expect_err("nothing was sent yet")
    };
    let own = drive(500).output(clock_hz);
    assert!(matches!(made(Some(own)), StartupError::Commands { .. }), "its own is not refused");
    let others = [
        Output { dac: Dac::Ad5668, ..own },
        Output { wave: Wave::Dc, ..own },
        Output { wave: Wave::Square { turn_slots: 11 }, ..own },
        Output { full_scale_v: 300, ..own },
        Output { clock_hz: clock_hz / 2, ..own },
    ];
    for other in others {
        let error = made(Some(other)).to_string();
        assert!(error.contains(&own.to_string()) && error.contains(&other.to_string()), "{error}");
    }
    assert!(made(None).to_string().contains("expected no drive"));
}
