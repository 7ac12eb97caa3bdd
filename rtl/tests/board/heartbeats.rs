// SPDX-License-Identifier: MIT OR Apache-2.0
//! Heartbeats, while registers are written.

use crate::bench::Bench;
use crate::pins::Host;
use crate::random::Random;
use hapticore_contract::profile::Profile;
use hapticore_hdl::bundle::Bundle;
use hapticore_host::Constant;
use hapticore_host::{Decoder, Message};
use hapticore_model::blocks::core::Core;
use hapticore_rtl::board::framing::{END, Register};
use hapticore_rtl::board::registers::CommandRegisters;
use hapticore_rtl::board::stream::{self, Stream};

const DIVISOR: u64 = 4;
/// Clocks from one command to the next at the same rate: ten bytes at least.
const COMMAND: u64 = 100 * DIVISOR;

#[test]
fn a_heartbeat_tells_words_that_were_written_or_ends_early() {
    for profile in Profile::all() {
        let mut random = Random::new(11);
        let data = CommandRegisters::new(Core::new(&profile).inputs().calibration, 100, None)
            .outputs()
            .data;
        let stream = Stream::new(&profile, DIVISOR, data, None);
        let quiet = stream::Inputs::map(stream.inputs(), |_| 0);
        let (mut bench, mut host) = (Bench::new(stream), Host::new(DIVISOR));
        let (mut written, mut place, mut word, mut wait) =
            (Constant::ALL.map(|_| vec![0]), 0, 0, 0u64);
        for _ in 0..3_000_000 {
            let keep = wait == 0;
            if keep {
                (place, word, wait) = (
                    random.below(written.len() as u64),
                    random.word(data),
                    COMMAND + random.below(10 * COMMAND),
                );
                written[place as usize].push(word as u64);
            }
            wait -= 1;
            let inputs =
                stream::Inputs { keep: keep.into(), place: place as i64, data: word, ..quiet };
            host.clock(bench.clock(inputs).tx);
        }
        let ends = host.heard.iter().filter(|byte| **byte == END).count();
        let mut whole = 0;
        for told in Decoder::new(&profile).decode(host.heard) {
            let Ok(Message::Heartbeat(heartbeat)) = told else {
                panic!("{}: {told:?}", profile.name)
            };
            whole += 1;
            for (constant, written) in Constant::ALL.into_iter().zip(&written) {
                let register = Register::Constant(constant);
                let (told, bits) = heartbeat.register(register).expect("heartbeats tell it");
                let known = written.iter().any(|word| word & ((1 << bits) - 1) == told);
                assert!(known, "{}: {register:?} {told:x} was never written", profile.name);
            }
        }
        println!("{}: {whole} of {ends} are whole", profile.name);
        assert!(whole > 10 && ends > whole + 10, "{}: {whole} of {ends} are whole", profile.name);
    }
}
