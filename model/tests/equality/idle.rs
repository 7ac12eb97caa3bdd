// SPDX-License-Identifier: MIT OR Apache-2.0
//! A block that skips its idle clocks, in lock-step with one that never does.

use crate::device::{self, Sight, calibration, short_profiles, short_table_profiles};
use crate::harness::{Bench, show};
use crate::never_skips::NeverSkips;
use crate::random::Random;
use hapticore_contract::profile::Profile;
use hapticore_hdl::block::{Block, Inputs, Outputs};
use hapticore_hdl::bundle::Bundle;
use hapticore_hdl::probe::sample;
use hapticore_model::blocks::core::{self, Core};
use hapticore_model::blocks::position::TablePort;

/// Slots of each profile.
const SLOTS: u64 = if cfg!(optimised) { 60 } else { 8 };

#[test]
fn skipping_changes_no_bit_on_any_clock() {
    for profile in short_profiles().into_iter().chain(short_table_profiles()) {
        let (mut skips, mut never) =
            (Bench::new(Core::new(&profile)), Bench::<_, NeverSkips>::read(Core::new(&profile)));
        let (mut registers, mut of_never_skipping) = (Vec::new(), Vec::new());
        drive_core(&profile, SLOTS, |inputs| {
            let (got, expected) = (skips.clock(inputs), never.clock(inputs));
            assert_same_outputs::<Core>(skips.clock, inputs, got, expected);
            registers.clear();
            of_never_skipping.clear();
            sample(&skips.block, &skips.state, &mut registers);
            sample(&never.block, &never.state, &mut of_never_skipping);
            if !registers.iter().zip(&of_never_skipping).all(|(a, b)| *a == b.0) {
                let pairs = skips.registers().zip(never.registers());
                let differs = |((variable, a), (_, b)): &_| -> Option<String> {
                    let (a, b): (&i64, &NeverSkips) = (a, b);
                    let variable: &hapticore_hdl::probe::Variable = variable;
                    (*a != b.0).then(|| {
                        format!(
                            "{}.{}: {a} skipping, {} never",
                            variable.scope.join("."),
                            variable.name,
                            b.0
                        )
                    })
                };
                let list: Vec<String> = pairs.filter_map(|pair| differs(&pair)).collect();
                panic!(
                    "clock {}\n{}\n{}",
                    skips.clock,
                    show::<core::Inputs>(inputs),
                    list.join("\n")
                );
            }
            got
        });
    }
}

/// Outputs on one clock, of two that should be the same.
pub fn assert_same_outputs<B: Block>(
    clock: u64,
    inputs: Inputs<B, i64>,
    got: Outputs<B, i64>,
    expected: Outputs<B, i64>,
) {
    let mut same = true;
    B::Outputs::each(B::Outputs::zip(got, expected), |_, (a, b)| same &= a == b);
    let (got, expected) = (show::<B::Outputs>(got), show::<B::Outputs>(expected));
    let inputs = show::<B::Inputs>(inputs);
    assert!(
        same,
        "{}, clock {clock}\ninputs:    {inputs}\ngot:       {got}\nreference: {expected}",
        B::NAME
    );
}

/// Clocks a core through its calibration and some slots of everything that an ADC may see.
pub fn drive_core(
    profile: &Profile,
    slots: u64,
    mut clock: impl FnMut(core::Inputs<i64>) -> core::Outputs<i64>,
) {
    let core = Core::new(profile);
    let calibration = calibration(profile);
    let constants = core.idle_inputs(&calibration);
    for (address, word) in (0..).zip(calibration.words(profile)) {
        let word = profile.formats.table.code_saturating(word);
        clock(constants.with_table(TablePort { write: 1, address, word }));
    }
    let mut random = Random::new(slots);
    let mut channel = 0;
    for slot in 0..slots {
        let sight = Sight::ALL[slot as usize % Sight::ALL.len()];
        let codes = device::codes(profile, sight, &mut random);
        for codes in codes.chunks_exact(profile.channels()) {
            for at in 0..profile.clocks_per_sample {
                let (strobe, code) = (i64::from(at == 0), i64::from(codes[channel as usize]));
                channel = clock(core::Inputs { strobe, code, ..constants }).channel;
            }
        }
    }
}

/// Codes of ports in a row.
pub fn flat<S: Bundle>(bundle: S::Of<i64>) -> Vec<i64> {
    let mut codes = Vec::new();
    S::each(bundle, |_, code| codes.push(code));
    codes
}
