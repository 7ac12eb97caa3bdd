// SPDX-License-Identifier: MIT OR Apache-2.0

use proptest::prelude::*;

use super::*;

const FRAME_S: f64 = 2e-3;

fn rules() -> Rules {
    Rules {
        half_mm: [200.0, 120.0],
        goal_half_mm: 40.0,
        mallet_radius_mm: 15.0,
        puck_radius_mm: 10.0,
        puck_kg: 0.02,
        deceleration_mm_s2: 200.0,
        serve: Puck::default(),
        restitution_wall: 0.9,
        restitution_mallet: 0.8,
        impact_s: 0.03,
        most_n: 1.0,
    }
}

fn frictionless(place_mm: [f64; 2], velocity_mm_s: [f64; 2]) -> Rules {
    Rules { deceleration_mm_s2: 0.0, serve: Puck { place_mm, velocity_mm_s }, ..rules() }
}

/// Frames of mallets at places over time, each mallet half a frame after the one before.
fn play(game: &mut Game, frames: usize, place_mm: impl Fn(usize, f64) -> Option<[f64; 2]>) {
    let mallets = game.mallets.len();
    for n in 0..frames * mallets {
        let time_s = FRAME_S / mallets as f64 * n as f64;
        game.frame(n % mallets, time_s, place_mm(n % mallets, time_s));
    }
}

fn assert_near(got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance, "{got}, expected {expected} ± {tolerance}");
}

#[test]
fn a_wall_reverses_the_speed_across_it_at_the_time_of_contact() {
    // From 0 to the reach of 110 mm in 0.11 s, then 0.05 s back at 900 mm/s.
    let mut game = Game::new(frictionless([0.0; 2], [30.0, 1000.0]), &[true]);
    play(&mut game, 81, |_, _| Some([-150.0, 0.0]));
    let Puck { place_mm, velocity_mm_s } = game.puck();
    assert_near(place_mm[1], 110.0 - 0.05 * 900.0, 1e-9);
    assert_near(place_mm[0], 0.16 * 30.0, 1e-9);
    assert_eq!(velocity_mm_s, [30.0, -900.0]);
}

#[test]
fn friction_stops_the_puck_after_v_squared_by_two_mu_g() {
    let rules =
        Rules { serve: Puck { place_mm: [-100.0, 0.0], velocity_mm_s: [100.0, 0.0] }, ..rules() };
    let mut game = Game::new(rules, &[true]);
    play(&mut game, 400, |_, _| Some([-150.0, 80.0]));
    assert_eq!(game.puck().speed_mm_s(), 0.0);
    assert_near(game.puck().place_mm[0], -100.0 + 100.0 * 100.0 / (2.0 * 200.0), 1e-3);
}

#[test]
fn an_oblique_impact_changes_only_the_speed_along_the_normal() {
    // At contact the centres lie 25 mm apart, 15 along y: the normal is (0.8, 0.6).
    let mut game = Game::new(frictionless([-50.0, 15.0], [-500.0, 0.0]), &[true]);
    play(&mut game, 60, |_, _| Some([-100.0, 0.0]));
    let change = 1.8 * 0.8 * 500.0;
    let Puck { velocity_mm_s, .. } = game.puck();
    assert_near(velocity_mm_s[0], -500.0 + change * 0.8, 1e-6);
    assert_near(velocity_mm_s[1], change * 0.6, 1e-6);
}

#[test]
fn a_strike_gives_the_puck_its_speed_and_the_pad_its_impulse() {
    let mut game = Game::new(frictionless([-100.0, 0.0], [0.0; 2]), &[true]);
    let strike = |_, time_s: f64| Some([-150.0 + 300.0 * time_s, 0.0]);
    let (mut impulse_n_s, mut most_n) = (0.0, 0.0f64);
    for n in 0..100 {
        let time_s = FRAME_S * f64::from(n);
        game.frame(0, time_s, strike(0, time_s));
        impulse_n_s += FRAME_S * game.target_n(0);
        most_n = most_n.max(game.target_n(0));
    }
    assert_near(game.puck().velocity_mm_s[0], 1.8 * 300.0, 1e-6);
    let expected_n_s = 1e-3 * 0.02 * 1.8 * 300.0;
    assert_near(impulse_n_s, expected_n_s, 1e-9);
    assert_near(most_n, expected_n_s / 0.03, 1e-9);
    assert_eq!(game.target_n(0), 0.0, "the pulse is over");
}

#[test]
fn an_impact_gives_no_more_than_the_largest_force() {
    let mut game = Game::new(frictionless([-100.0, 0.0], [0.0; 2]), &[true]);
    let mut most_n = 0.0f64;
    for n in 0..30 {
        let time_s = FRAME_S * f64::from(n);
        game.frame(0, time_s, Some([-150.0 + 3000.0 * time_s, 0.0]));
        most_n = most_n.max(game.target_n(0));
    }
    assert_eq!(most_n, 1.0);
}

#[test]
fn a_puck_in_a_goal_scores_and_starts_at_the_centre() {
    for (velocity, score) in [(1000.0, [1, 0]), (-1000.0, [0, 1])] {
        let mut game = Game::new(frictionless([0.0, 20.0], [velocity, 0.0]), &[true, false]);
        play(&mut game, 120, |mallet, _| Some([if mallet == 0 { -150.0 } else { 150.0 }, -80.0]));
        assert_eq!((game.score(), game.puck()), (score, Puck::default()));
        game.serve();
        assert_eq!((game.score(), game.puck().place_mm), (score, [0.0, 20.0]));
    }
}

#[test]
fn a_puck_beside_the_goal_bounces() {
    let mut game = Game::new(frictionless([0.0, 31.0], [1000.0, 0.0]), &[true]);
    play(&mut game, 120, |_, _| Some([-150.0, -80.0]));
    assert_eq!((game.score(), game.puck().velocity_mm_s), ([0, 0], [-900.0, 0.0]));
}

#[test]
fn a_lifted_mallet_meets_no_puck_and_feels_nothing() {
    let mut game = Game::new(frictionless([-50.0, 0.0], [-500.0, 0.0]), &[true]);
    play(&mut game, 100, |_, _| None);
    assert_eq!(game.puck().velocity_mm_s, [-500.0, 0.0]);
    // Struck, then lifted within the pulse.
    let mut game = Game::new(frictionless([-50.0, 0.0], [-500.0, 0.0]), &[true]);
    let mut frame = 0;
    while game.target_n(0) == 0.0 {
        game.frame(0, FRAME_S * f64::from(frame), Some([-100.0, 0.0]));
        frame += 1;
        assert!(frame < 100, "no impact");
    }
    game.frame(0, FRAME_S * f64::from(frame), None);
    assert_eq!(game.target_n(0), 0.0);
    let not_a_number = Some([f64::NAN, 0.0]);
    game.frame(0, FRAME_S * f64::from(frame + 1), not_a_number);
    assert!(game.puck().place_mm.iter().all(|mm| mm.is_finite()));
}

#[test]
fn a_mallet_has_the_nearer_walls_of_its_half() {
    let mut game = Game::new(rules(), &[true, false]);
    let mut walls = |mallet: usize, place_mm| {
        game.frame(mallet, 0.0, Some(place_mm));
        game.surfaces(mallet).map(|surface| (surface.mm, surface.right))
    };
    assert_eq!(walls(0, [-180.0, 50.0]), [(-185.0, false), (105.0, true)]);
    assert_eq!(walls(0, [-20.0, -50.0]), [(-15.0, true), (-105.0, false)]);
    // The middle of the half is at −100 mm; within 8.5 mm of it the side stays.
    assert_eq!(walls(0, [-108.0, -50.0])[0], (-15.0, true));
    assert_eq!(walls(0, [-109.0, -50.0])[0], (-185.0, false));
    assert_eq!(walls(0, [-92.0, -50.0])[0], (-185.0, false));
    assert_eq!(walls(0, [-91.0, -50.0])[0], (-15.0, true));
    assert_eq!(walls(1, [20.0, 10.0]), [(15.0, false), (105.0, true)]);
    assert_eq!(walls(1, [180.0, 9.0])[0], (185.0, true));
}

/// Noise of 0.05 mm at rest hits a puck that lies 0.5 mm away with nothing.
#[test]
fn noise_of_the_place_moves_no_puck_nearby() {
    let mut game = Game::new(frictionless([-74.5, 0.0], [0.0; 2]), &[true]);
    let mut seed = 1u64;
    for n in 0..5000 {
        let mut noise = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            0.17 * ((seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
        };
        let place_mm = [-100.0 + noise(), noise()];
        game.frame(0, FRAME_S * f64::from(n), Some(place_mm));
    }
    assert_eq!(game.puck().place_mm, [-74.5, 0.0]);
}

#[test]
fn missing_frames_stop_neither_puck_nor_host() {
    let mut game = Game::new(frictionless([0.0; 2], [30.0, 100.0]), &[true, false]);
    play(&mut game, 10, |mallet, _| Some([if mallet == 0 { -150.0 } else { 150.0 }, 0.0]));
    let before = game.puck();
    // The left one is silent from now on; time jumps by hours once.
    for n in 0..200 {
        game.frame(1, 1e4 + FRAME_S * f64::from(n), Some([150.0, 0.0]));
    }
    let moved_mm = game.puck().place_mm[1] - before.place_mm[1];
    assert!((30.0..45.0).contains(&moved_mm), "{moved_mm} mm in 0.4 s at 100 mm/s");
}

/// Pushed straight out of the mallet it would lie beyond the wall, and moved back from there on the mallet again.
#[test]
fn a_puck_that_a_mallet_pins_to_a_wall_lies_beside_both() {
    for (x_mm, y_mm) in [(173.6, 24.5), (188.0, 20.0), (170.7, -3.0)] {
        let rules = frictionless([x_mm, y_mm], [0.0; 2]);
        let reach_mm = rules.puck_reach_mm();
        let mut game = Game::new(rules, &[true, false]);
        let mallets = [[-120.0, 0.0], [170.6, 20.0]];
        play(&mut game, 4, |mallet, _| Some(mallets[mallet]));
        let [x_mm, y_mm] = game.puck().place_mm;
        assert!((x_mm - mallets[1][0]).hypot(y_mm - mallets[1][1]) > 25.0 - 1e-9, "{x_mm}, {y_mm}");
        assert!(x_mm.abs() <= reach_mm[0] && y_mm.abs() <= reach_mm[1], "{x_mm}, {y_mm}");
    }
}

fn energy(puck: Puck) -> f64 {
    puck.speed_mm_s().powi(2)
}

/// A mallet that goes to and fro on a line within its half.
fn line(at_mm: [f64; 2], by_mm: [f64; 2], hz: f64, time_s: f64) -> [f64; 2] {
    let share = (std::f64::consts::TAU * hz * time_s).sin();
    [0, 1].map(|axis| at_mm[axis] + share * by_mm[axis])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// With mallets at rest energy only falls, the puck stays on the table and beside the mallets, at any speed.
    #[test]
    fn energy_never_rises_with_mallets_at_rest(
        x in -180.0..180.0f64, y in -105.0..105.0f64, u in -3e3..3e3f64, v in -3e3..3e3f64,
        left_y in -100.0..100.0f64, right_x in 30.0..180.0f64,
        restitution in 0.0..=1.0f64, deceleration_mm_s2 in 0.0..2e3f64,
    ) {
        let serve = Puck { place_mm: [x, y], velocity_mm_s: [u, v] };
        let rules = Rules {
            serve, deceleration_mm_s2, restitution_wall: restitution, restitution_mallet: restitution, ..rules()
        };
        let mallets = [[-120.0, left_y], [right_x, 20.0]];
        let mut game = Game::new(rules.clone(), &[true, false]);
        let reach_mm = rules.puck_reach_mm();
        let apart = |puck: Puck| mallets.iter().all(|mallet| {
            (puck.place_mm[0] - mallet[0]).hypot(puck.place_mm[1] - mallet[1]) > 25.0 - 1e-6
        });
        let mut before = energy(serve);
        for n in 0..600 {
            game.frame(n % 2, 1e-3 * n as f64, Some(mallets[n % 2]));
            let puck = game.puck();
            prop_assert!(energy(puck) <= before * (1.0 + 1e-12), "{puck:?}");
            prop_assert!(puck.place_mm.iter().zip(reach_mm).all(|(mm, reach)| mm.abs() <= reach + 1e-9), "{puck:?}");
            // A mallet is on the table from its second frame on.
            prop_assert!(n < 4 || apart(puck), "frame {n}: {puck:?}");
            before = energy(puck);
        }
    }

    /// A puck that comes straight at a mallet, which may go towards it or away, stays on its side: nothing tunnels, at any
    /// speed.
    #[test]
    fn a_fast_puck_passes_no_mallet(speed in 100.0..3e3f64, mallet_speed in -3e3..3e3f64) {
        let mut game = Game::new(frictionless([100.0, 0.0], [-speed, 0.0]), &[true]);
        for n in 0..100 {
            let time_s = FRAME_S * f64::from(n);
            let x_mm = (mallet_speed * time_s).clamp(-100.0, 60.0);
            game.frame(0, time_s, Some([x_mm, 0.0]));
            if game.score() != [0, 0] {
                return Ok(()); // It came back from the mallet, into the goal opposite.
            }
            let path_mm = game.mallets[0].moving(time_s).map_or(0.0, |mallet| mallet.place_mm[0]);
            let apart_mm = game.puck().place_mm[0] - path_mm;
            prop_assert!(apart_mm > 25.0 - 1e-6, "{apart_mm} mm from centre to centre");
        }
    }

    /// Whatever the mallets do, everything stays finite and on the table, and the same frames give the same bits.
    #[test]
    fn wild_mallets_leave_a_finite_game_that_replays(
        seed in 0..u64::MAX, hz in 0.5..8.0f64, by in 5.0..90.0f64, u in -3e3..3e3f64, v in -3e3..3e3f64,
    ) {
        let rules = Rules { serve: Puck { place_mm: [0.0; 2], velocity_mm_s: [u, v] }, ..rules() };
        let run = || {
            let mut game = Game::new(rules.clone(), &[true, false]);
            let mut states = Vec::new();
            for n in 0..1000 {
                let time_s = 1e-3 * n as f64;
                let left = n % 2 == 0;
                let at_mm = [if left { -100.0 } else { 100.0 }, 0.0];
                let lifted = seed >> (n % 61) & 15 == 0;
                let place_mm = (!lifted).then(|| line(at_mm, [by, by * 0.7], hz, time_s));
                game.frame(n % 2, time_s, place_mm);
                states.push((game.puck(), game.score(), [game.target_n(0), game.target_n(1)]));
            }
            states
        };
        let states = run();
        for (puck, _, targets_n) in &states {
            prop_assert!(puck.place_mm[0].abs() <= 190.0 && puck.place_mm[1].abs() <= 110.0, "{puck:?}");
            prop_assert!(puck.speed_mm_s() <= 1e4 + 1e-6, "{puck:?}");
            prop_assert!(targets_n.iter().all(|target_n| (0.0..=1.0).contains(target_n)), "{targets_n:?}");
        }
        prop_assert_eq!(states, run());
    }
}
