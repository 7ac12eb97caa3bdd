// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where errors come from: instances, inputs, constants; and what a recording forgets.

use super::*;

mod rounder {
    use super::*;

    crate::block! {
        /// Drops a bit.
        pub struct Rounder("rounder") {}
        submodules {}
        inputs(block) { word: FORMAT }
        outputs(block) { word: Format::signed(12, 3) }
        registers(block) {}
    }

    impl Block for Rounder {
        fn clock<V: Interpretation>(&self, _state: &mut State<Self, V>, i: In<V>) -> Out<V> {
            Outputs { word: i.word.quantize(Format::signed(12, 3), HalfEven, Saturate) }
        }
    }
}

crate::block! {
    /// A rounder behind another.
    pub struct Chain("chain") {}
    submodules { a: rounder::Rounder, b: rounder::Rounder }
    inputs(block) { word: FORMAT }
    outputs(block) { word: Format::signed(12, 3) }
    registers(block) {}
}

impl Block for Chain {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let a = crate::call!(self.a, state, rounder::Inputs { word: i.word });
        let again = crate::call!(self.a, state, rounder::Inputs { word: a.word.scaled(-1) });
        let b = crate::call!(self.b, state, rounder::Inputs { word: again.word.scaled(-1) });
        Outputs { word: b.word }
    }
}

/// By the path of the instance that rounds, each once, and by inputs.
#[test]
fn errors_are_told_by_their_sources() {
    let recording = Recording::begin();
    let chain = Chain { a: rounder::Rounder {}, b: rounder::Rounder {} };
    let mut state = chain.reset::<Noise>();
    let x = input(&recording, 3.0);
    let at_once = recording.mark();
    let half = Moments::of_rounding(HalfEven, 1, 0.125);
    let mut run = || Noise::instance(&chain, "chain", &mut state, Inputs { word: x }).word;
    let expected = [
        ("input".to_string(), moments(0.5, 1.0, 2.0).times(0.25)),
        ("chain.a".to_string(), half.times(0.25).plus(half.times(0.5))),
        ("chain.b".to_string(), half),
    ];
    let first = recording.errors(run().value);
    assert_eq!(first.by_source, expected);
    assert_eq!(first.total, expected.iter().fold(Moments::default(), |sum, (_, of)| sum.plus(*of)));
    recording.rewind(at_once);
    assert_eq!(recording.errors(run().value), first, "what was rewound leaves nothing");
    let constant = constant::<Noise>(0.3, FORMAT);
    let names: Vec<String> = recording
        .errors((x + constant).value)
        .by_source
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    assert_eq!(names, ["calibration", "input"]);
}

#[test]
fn a_recording_leaves_what_was_rounded_before_a_floor() {
    let recording = Recording::begin();
    let x = input(&recording, 3.3125);
    let mark = recording.mark();
    let _ = x.quantize(Format::signed(8, 0), Floor, Proved);
    recording.rewind(mark);
    assert!(with(|tape| tape.floored.is_none()), "the entry's number is free again");
}

#[test]
fn zeros_that_moving_up_leaves_are_dropped_without_an_error() {
    let recording = Recording::begin();
    let up = input(&recording, 3.0).scaled(2).resize(Format::signed(14, 4), Proved);
    let of = |frac: i8, case: &str, more: Moments| {
        let back = up.quantize(Format::signed(12, frac), HalfEven, Proved);
        check(&recording, back, moments(0.5, 1.0, 2.0).times(4.0).plus(more), case);
    };
    of(2, "two zeros", Moments::default());
    of(1, "two zeros and a bit", Moments::of_rounding(HalfEven, 1, 0.5));
}
