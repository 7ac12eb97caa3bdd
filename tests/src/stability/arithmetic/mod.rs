// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operands at the ends of their range: rounding, division, square root, tables, whole slots.

mod operators;
mod slots;

use super::{Case, Group};

/// The group on the page.
pub const GROUP: Group = Group {
    name: "arithmetic",
    title: "Arithmetic",
    about: "Operands at the ends of their range. Every comparison is with exact integers of 128 bits.",
    cases: &[
        Case {
            name: "rounding_ties",
            stimulus: "every code of 12 bits, either sign, narrowed by 1 to 8 bits, so that every tie occurs",
            must: "round half to even; no mean error",
            run: operators::rounding_ties,
        },
        Case {
            name: "operand_patterns",
            stimulus: "products, quotients and square roots of few ones, few zeros, runs of ones, powers of two ± 1 (the patterns of Berkeley TestFloat)",
            must: "the exact result, correctly rounded",
            run: operators::operand_patterns,
        },
        Case {
            name: "quotient_overflow",
            stimulus: "quotients above the largest code, and denominators of zero",
            must: "saturate with the flag; no wrap",
            run: operators::quotient_overflow,
        },
        Case {
            name: "square_root_of_zero_and_of_the_largest",
            stimulus: "0, 1, the largest radicand, squares and their neighbours, of every word that a profile takes a square root of",
            must: "the exact result, correctly rounded",
            run: operators::square_roots,
        },
        Case {
            name: "most_negative_code",
            stimulus: "all channels, then each alone, at the most negative code for a whole slot",
            must: "no word overflows; flag *clipped*",
            run: slots::most_negative_code,
        },
        Case {
            name: "full_scale_square_wave",
            stimulus: "rectangular waves of the carrier's frequency between the rails, at 16 phases, in every channel: largest p and q of either sign",
            must: "no word overflows; flag *clipped*",
            run: slots::full_scale_square_wave,
        },
        Case {
            name: "zero_and_negative_denominators",
            stimulus: "no sensing voltage; no current; more voltage lost in the sheet than there is (a negative radicand)",
            must: "flag *invalid*, last valid results held; no current may be a capacitance of nothing (below 0.1 pF)",
            run: slots::zero_and_negative_denominators,
        },
        Case {
            name: "table_edges_and_corners",
            stimulus: "ratios up to the rails of either sign: currents of one terminal alone, of two, and 60 random sets",
            must: "a place of the table or flag *invalid*; never a place off the sheet",
            run: slots::table_edges_and_corners,
        },
        Case {
            name: "phase_wrap",
            stimulus: "the same codes in 300 slots, one after the other: the oscillator's counter wraps twice per slot",
            must: "the same frame in every slot",
            run: slots::phase_wrap,
        },
        Case {
            name: "negative_zero",
            stimulus: "a pad in the middle of the sheet, equal currents, no haptic voltage",
            must: "results of zero are written `0`, not `-0`",
            run: slots::negative_zero,
        },
        Case {
            name: "rounding_seen_as_phase",
            stimulus: "tones of 512 steps of the ADC at 64 phases: rounding with a bias would move p and q by a constant, and the amplitude with the phase",
            must: "no change with the phase beyond rounding",
            run: slots::rounding_seen_as_phase,
        },
    ],
};
