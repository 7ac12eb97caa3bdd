// SPDX-License-Identifier: MIT OR Apache-2.0
//! Devices of three to sixteen terminals, from the scene to the ADC's channels.

use crate::common::{demodulate, hann, plant};
use hapticore_scene::{Complex, signs_by_place};

/// Every effect that acts on terminals, on a sheet of these; two pads, so that they are coupled.
fn all_on(sheet: &str) -> String {
    let pads = "[[pad]]\nposition_mm = [120, -60]\nhaptic_v_rms = 150\n[[pad]]\nposition_mm = [-200, 90]\n";
    format!(
        "{pads}[sheet]\n{sheet}\n[shunt]\nnanofarad_per_m2 = 9\n[coupling]\n[switching]\n[carrier]\nrung = \"samples\"\n\
         [sensor]\nbandwidth_khz = 3000\ncrosstalk_percent = 0.5\ngain_error_percent = 1\ngain_mismatch_percent = 1\n\
         offset_percent = 0.1\n"
    )
}

/// Terminals evenly along the edge of 860 × 500 mm, from the bottom left corner on.
fn around(count: usize) -> String {
    let place = |n: usize| match 2720.0 * n as f64 / count as f64 {
        at if at < 860.0 => [at - 430.0, -250.0],
        at if at < 1360.0 => [430.0, at - 1110.0],
        at if at < 2220.0 => [1790.0 - at, 250.0],
        at => [-430.0, 2470.0 - at],
    };
    let places: Vec<_> = (0..count).map(|n| format!("{:?}", place(n))).collect();
    format!("terminals_mm = [{}]", places.join(", "))
}

/// Channels are the terminals, the sensing and the haptic voltage, and samples carry the amplitudes
/// of phasors.
#[test]
fn every_effect_follows_the_number_of_terminals() {
    for (count, sheet) in [(4, "terminals = 4".to_string()), (6, String::new())]
        .into_iter()
        .chain([3, 5, 8, 16].map(|count| (count, around(count))))
    {
        let mut plant = plant(&all_on(&sheet));
        assert_eq!((plant.terminals().len(), plant.channels()), (count, count + 2));
        let mut phasors = vec![Complex::default(); count + 1];
        plant.phasors(0, &mut phasors);
        let sampled = demodulate(&mut plant, 0, hann);
        assert_eq!(sampled.len(), count + 1);
        assert!(
            sampled.iter().zip(&phasors).all(|(a, b)| (a - b).norm() < 1e-9 && b.norm() > 1e-4),
            "{count}"
        );
        let mut samples = Vec::new();
        plant.samples(0, 0..50, &mut samples);
        assert_eq!(samples.len(), 50 * (count + 2));
        let truth = plant.truth(0);
        assert!(truth.r_x.abs() < 1.0 && truth.r_y.abs() < 1.0 && truth.sheet_ohm > 0.0);
    }
}

#[test]
fn places_of_the_usual_terminals_are_those_of_their_numbers() {
    let listed = "terminals_mm = [[-430, 250], [-430, -250], [430, -250], [430, 250]]";
    let amplitudes = |sheet: &str| {
        let mut plant = plant(&all_on(sheet));
        let mut phasors = vec![Complex::default(); plant.channels() - 1];
        plant.phasors(0, &mut phasors);
        phasors
    };
    assert_eq!(amplitudes(listed), amplitudes("terminals = 4"));
    let six =
        "terminals_mm = [[-430, 250], [-430, -250], [430, -250], [430, 250], [0, -250], [0, 250]]";
    assert_eq!(amplitudes(six), amplitudes("terminals = 6"));
    assert_eq!(
        amplitudes("terminals = 4\nterminal_ohm = [7, 7, 7, 7]"),
        amplitudes("terminals = 4\nterminal_ohm = 7")
    );
    assert_ne!(
        amplitudes("terminals = 4\nterminal_ohm = [7, 8, 7, 7]"),
        amplitudes("terminals = 4\nterminal_ohm = 7")
    );
}

#[test]
fn signs_of_the_papers_six_terminals_are_the_sides_that_they_are_on() {
    let places = plant(&all_on("")).terminals().to_vec();
    assert_eq!(
        signs_by_place(&places, [860.0, 500.0]),
        [vec![-1, -1, 1, 1, 0, 0], vec![1, -1, -1, 1, -1, 1]]
    );
}

/// Where the third of the sheet on one side has no terminal, and where a half has none.
#[test]
fn signs_of_other_terminals_leave_no_axis_without_both() {
    let size_mm = [600.0, 300.0];
    let places = [[-300.0, 150.0], [-300.0, -150.0], [60.0, 150.0], [-20.0, -150.0]];
    assert_eq!(signs_by_place(&places, size_mm), [vec![-1, -1, 1, -1], vec![1, -1, 1, -1]]);
    let places = [[-300.0, 150.0], [-300.0, -150.0], [-100.0, 150.0]];
    assert_eq!(signs_by_place(&places, size_mm), [vec![-1, -1, 1], vec![1, -1, 1]]);
}
