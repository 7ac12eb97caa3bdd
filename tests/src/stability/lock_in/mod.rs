// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tones, noise and disturbances at the ADC.

pub mod amplitude;
mod disturbances;
mod faults;
mod noise;
mod purity;

use super::{Case, Group};

/// The group on the page.
pub const GROUP: Group = Group {
    name: "lock_in",
    title: "Lock-in",
    about: "Tones, noise and disturbances at the ADC, on a device whose ratios bend towards the edges. Errors are those of the whole chain from codes to the \
            frame's capacitance or force, against the ideal estimator and the tones themselves unless a row says otherwise. Rival: idsp 0.23's lock-in with a second-order \
            low-pass that settles within the window, and the estimator in floating point behind it.",
    cases: &[
        Case {
            name: "offset_of_half_scale",
            stimulus: "half of full scale added to every channel but the haptic one",
            must: "no change: the window passes no constant",
            run: disturbances::offset_of_half_scale,
        },
        Case {
            name: "leakage_above_the_carrier",
            stimulus: "haptic leakage at 1 kHz in every terminal, 11 dB and 40 dB above the carrier's current",
            must: "rejected as in floating point",
            run: disturbances::leakage_above_the_carrier,
        },
        Case {
            name: "dynamic_reserve",
            stimulus: "an interferer of 0.9 of full scale at 50 Hz, 200 Hz, 1, 3 and 20 kHz, of the worst of eight phases",
            must: "within 4 dB of floating point; reserve is how far above the carrier it may be for 1 % of force",
            run: disturbances::dynamic_reserve,
        },
        Case {
            name: "amplitude_with_dither",
            stimulus: "currents from full scale to 1 LSB at the largest terminal, noise of ½ LSB rms, 16 slots each",
            must: "no more than 1.5 times the error of floating point on the same codes and of the rounding of the words",
            run: amplitude::with_dither,
        },
        Case {
            name: "amplitude_without_dither",
            stimulus: "the same without noise, 16 phases",
            must: "the same: what rounding by the ADC leaves, no more",
            run: amplitude::without_dither,
        },
        Case {
            name: "zero_input",
            stimulus: "200 slots of zeros after a slot at full scale",
            must: "nothing is left in the sums; flag *invalid*, the same frame for ever: no limit cycle",
            run: faults::zero_input,
        },
        Case {
            name: "full_scale_steps",
            stimulus: "slots at full scale and quiet ones in turn",
            must: "a quiet slot's frame does not depend on the slot before it",
            run: faults::full_scale_steps,
        },
        Case {
            name: "carrier_detuned",
            stimulus: "a carrier 100 ppm and 1 % off the oscillator's",
            must: "ratios cancel what both lose",
            run: disturbances::carrier_detuned,
        },
        Case {
            name: "missing_and_repeated_samples",
            stimulus: "in mid-window a set of codes left out, or given twice",
            must: "bounded error in this frame; the next one is right to the bit",
            run: faults::missing_and_repeated_samples,
        },
        Case {
            name: "clipping_in_one_channel",
            stimulus: "one terminal's current at 1.04 of full scale",
            must: "flag *clipped*; otherwise as floating point on the same codes, within 1 % (the clipped tone may saturate its word)",
            run: faults::clipping_in_one_channel,
        },
        Case {
            name: "line_faults",
            stimulus: "one terminal's line: all ones, all zeros, unplugged (noise of 1 LSB); all of them at once",
            must: "flag *lost* (open terminal); all at once: *invalid*, or a capacitance of nothing (below 0.1 pF)",
            run: faults::line_faults,
        },
        Case {
            name: "stuck_bit",
            stimulus: "each bit of one terminal's codes stuck at 0 and at 1",
            must: "as floating point sees it: no worse, and right again in the next slot",
            run: faults::stuck_bit,
        },
        Case {
            name: "cramer_rao_bound",
            stimulus: "white noise of 2 % of full scale rms at every terminal, 600 slots",
            must: "variance of the total current at most 1.76 dB (Hann window) above the Cramér–Rao bound, but for chance (0.5 dB)",
            run: noise::cramer_rao_bound,
        },
        Case {
            name: "sinad_of_the_force",
            stimulus: "haptic voltage such that the force is a sine over 512 slots between 2.5 and 97.5 % of the largest; noise of ½ LSB rms in every channel",
            must: "signal to noise and distortion within 3 dB of floating point's with the rounding of the frame's words",
            run: purity::sinad_of_the_force,
        },
        Case {
            name: "integral_nonlinearity",
            stimulus: "currents whose amplitude is a sine over 4,096 slots: the capacitance's departure from a straight line, and by the histogram of IEEE 1057",
            must: "a straight line within 3 LSB of the capacitance's word",
            run: purity::integral_nonlinearity,
        },
    ],
};
