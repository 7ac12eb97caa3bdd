// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pad's mechanics go on at all times: what happens between its slots agrees with an independent
//! integration, whichever pad is selected or evaluated.

use crate::common::ode::{Ode, REST_UM};
use crate::common::standard_timing as timing;
use hapticore_scene::{DriveError, Plant, Scene, Truth};

pub fn plant(text: &str) -> Plant {
    let text = format!("title = \"t\"\n{text}");
    let scene = Scene::parse(&text, "s.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    Plant::new(&scene, 0, &timing()).unwrap()
}

pub fn truths(text: &str) -> Vec<Truth> {
    let mut plant = plant(text);
    (0..plant.slots()).map(|slot| plant.truth(slot)).collect()
}

const GAP: &str = "rung = \"tr-bdf2\"\n";

/// The gap of docs/physics.md §3.
fn gap(more: &str) -> String {
    format!("[device]\ngravity_m_s2 = 9.80665\n[gap]\nrest_um = {REST_UM:?}\n{more}")
}

/// A pad under 50 g in the middle of the sheet, and `others` motionless ones.
fn pads(haptic_v_rms: &str, others: usize) -> String {
    let mut text =
        format!("[[pad]]\nposition_mm = [0, 0]\nload_g = 50\nhaptic_v_rms = {haptic_v_rms}\n");
    for place in [[-200, 90], [150, -120], [250, 100]].iter().take(others) {
        text.push_str(&format!("[[pad]]\nposition_mm = {place:?}\n"));
    }
    text
}

fn square(volt: f64, [on_s, off_s]: [f64; 2]) -> String {
    format!("{{ timeline = [[{on_s}, 0], [{on_s}, {volt}], [{off_s}, {volt}], [{off_s}, 0]] }}")
}

/// Capacitances of pad 0 by the ODE at these times, in pF; in equilibrium until `from_s`, behind a
/// supply that lets `share` of the voltage through.
fn exact_behind_pf(
    share: impl Fn(f64) -> f64,
    volt: f64,
    [on_s, off_s]: [f64; 2],
    from_s: f64,
    times_s: &[f64],
) -> Vec<f64> {
    let mut ode = Ode::at_rest(50.0, from_s);
    let drive = |time_s: f64, capacitance_pf: f64| {
        if (on_s..off_s).contains(&time_s) { volt * share(capacitance_pf) } else { 0.0 }
    };
    let at = |time_s: &f64| {
        for event_s in [on_s, off_s].into_iter().filter(|event_s| event_s < time_s) {
            ode.advance(event_s, drive);
        }
        ode.advance(*time_s, drive);
        ode.capacitance_pf()
    };
    times_s.iter().map(at).collect()
}

/// The same where nothing lies between source and pad.
fn exact_pf(volt: f64, pulse: [f64; 2], from_s: f64, times_s: &[f64]) -> Vec<f64> {
    exact_behind_pf(|_| 1.0, volt, pulse, from_s, times_s)
}

fn assert_within(truths: &[&Truth], exact_pf: &[f64], relative: f64) {
    for (truth, exact_pf) in truths.iter().zip(exact_pf) {
        let off = truth.capacitance_pf / exact_pf - 1.0;
        assert!(
            off.abs() < relative,
            "{} s: {} pF, by the ODE {exact_pf} pF",
            truth.time_s,
            truth.capacitance_pf
        );
    }
}

/// docs/physics.md §7: 350 V from 0.1034 s to 0.1098 s, between two slots of four pads.
#[test]
fn a_pulse_between_two_slots_is_seen_in_the_next() {
    let pulse = [0.1034, 0.1098];
    let coupled = "[sheet]\n[coupling]\n";
    let see = |more: &str| {
        let text =
            format!("duration_s = 0.2\n{}{}{more}", pads(&square(350.0, pulse), 3), gap(GAP));
        truths(&text).into_iter().filter(|truth| truth.pad == 0).collect::<Vec<_>>()
    };
    let (alone, coupled) = (see("[sheet]\n"), see(coupled));
    let after: Vec<_> = alone.iter().filter(|truth| truth.time_s > 0.1).take(12).collect();
    let times_s: Vec<_> = after.iter().map(|truth| truth.time_s).collect();
    let exact_pf = exact_pf(350.0, pulse, 0.1, &times_s);
    assert!((exact_pf[1] - 383.4).abs() < 0.1, "{} pF", exact_pf[1]);
    assert_within(&after, &exact_pf, 0.001);
    for (alone, coupled) in alone.iter().zip(&coupled) {
        assert_eq!(alone.capacitance_pf.to_bits(), coupled.capacitance_pf.to_bits());
    }
}

#[test]
fn the_first_slot_of_a_step_is_as_near_to_the_ode_as_all_others() {
    for (on_s, others) in [(0.1034, 0), (0.1021, 0), (0.1034, 3)] {
        let step = [on_s, 1.0];
        let text = format!("duration_s = 0.13\n{}{}", pads(&square(350.0, step), others), gap(GAP));
        let all = truths(&text);
        let after: Vec<_> =
            all.iter().filter(|truth| truth.pad == 0 && truth.time_s > on_s).collect();
        let times_s: Vec<_> = after.iter().map(|truth| truth.time_s).collect();
        assert_within(&after, &exact_pf(350.0, step, 0.1, &times_s), 0.001);
    }
}

/// docs/physics.md §3: V_h/V = 1/|1 + jωR(C + C_par)|, with the capacitance of the moment.
#[test]
fn behind_a_supply_the_voltage_falls_while_the_gap_closes() {
    for haptic_hz in [200.0, 1000.0] {
        let share = |capacitance_pf: f64| {
            let ratio =
                std::f64::consts::TAU * haptic_hz * 300e3 * 1e-12 * (capacitance_pf + 100.0);
            1.0 / (1.0 + ratio * ratio).sqrt()
        };
        let (volt, pulse) = (400.0, [0.0034, 0.0298]);
        let supply = format!("[supply]\n[carrier]\nhaptic_hz = {haptic_hz}\n");
        let text =
            format!("duration_s = 0.05\n{}{supply}{}", pads(&square(volt, pulse), 0), gap(GAP));
        let all = truths(&text);
        let all: Vec<_> = all.iter().collect();
        let times_s: Vec<_> = all.iter().map(|truth| truth.time_s).collect();
        let exact_pf = exact_behind_pf(share, volt, pulse, 0.0, &times_s);
        assert_within(&all, &exact_pf, 0.001);
    }
}

/// Neither is on the steps of 100 µs, nor within a slot's window.
#[test]
fn switching_on_and_off_is_met_at_any_time() {
    for on_s in [0.0001234567, 0.0015, 0.00173205] {
        let pulse = [on_s, 0.0567891234];
        let all =
            truths(&format!("duration_s = 0.08\n{}{}", pads(&square(400.0, pulse), 0), gap(GAP)));
        let all: Vec<_> = all.iter().collect();
        let times_s: Vec<_> = all.iter().map(|truth| truth.time_s).collect();
        assert_within(&all, &exact_pf(400.0, pulse, 0.0, &times_s), 0.001);
    }
}

/// Numbers that look random, 0 to 1.
pub struct Draw(pub u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }

    /// Times and voltages of steps that begin at 0, up to a time.
    fn steps(&mut self, until_s: f64) -> Vec<[f64; 2]> {
        let mut steps = vec![[0.0, self.within(0.0, 400.0)]];
        loop {
            let time_s = steps[steps.len() - 1][0] + self.within(1e-5, 8e-3);
            if time_s > until_s {
                return steps;
            }
            steps.push([time_s, self.within(0.0, 400.0)]);
        }
    }

    /// A pad that changes all the time, somewhere.
    fn pad(&mut self) -> String {
        let place = [self.within(-400.0, 400.0), self.within(-230.0, 230.0)];
        let load = [self.within(20.0, 100.0), self.within(0.0, 20.0), self.within(1.0, 200.0)];
        format!(
            "[[pad]]\nposition_mm = {place:?}\nhaptic_v_rms = {}\n\
             load_g = {{ sine = {{ mean = {}, amplitude = {}, frequency_hz = {} }} }}\n",
            timeline(&self.steps(0.1)),
            load[0],
            load[1],
            load[2]
        )
    }
}

/// The steps as a scene has them.
fn timeline(steps: &[[f64; 2]]) -> String {
    let mut points = vec![steps[0]];
    for pair in steps.windows(2) {
        points.extend([[pair[1][0], pair[0][1]], pair[1]]);
    }
    format!("{{ timeline = {points:?} }}")
}

/// Effects with a state, each at a level and a step of its own.
pub const STATES: [&str; 10] = [
    "[gap]\nrung = \"tr-bdf2\"\n",
    "[gap]\nrung = \"quasi-static\"\nstep_us = 700\n[supply]\n",
    "[gap]\nrung = \"trapezoid\"\nstep_us = 130\n[halves]\n",
    "[gap]\nrung = \"semi-implicit\"\n[friction]\nrung = \"stiction\"\n",
    "[gap]\nrung = \"tr-bdf2\"\nstep_us = 200\n[friction]\nrung = \"dahl\"\nstep_us = 30\n[hand]\n",
    "[supply]\n[gap]\nrung = \"implicit-euler\"\n[halves]\n[friction]\nstep_us = 170\n[hand]\n",
    "[charge]\nshare = 0.4\ntime_constant_s = 0.02\n[carrier]\nhaptic_wave = \"dc\"\n\
     [friction]\nrung = \"coulomb\"\ndrift = { timeline = [[0, 1], [0.06, 1.4]] }\n[release]\n",
    "[charge]\nshare = -0.3\ntime_constant_s = 0.05\n[carrier]\nhaptic_wave = \"dc\"\n[gap]\nrung = \"hysteresis\"\n",
    "[charge]\nshare = [0.3, -0.2]\ntime_constant_s = [0.01, 0.1]\nstart_v = [50, -20]\n[supply]\n\
     [gap]\nrung = \"tr-bdf2\"\n[friction]\nrung = \"dahl\"\n[hand]\n[release]\nstep_us = 70\n",
    "[charge]\nshare = 0.3\ntime_constant_s = 0.01\n[carrier]\nhaptic_wave = \"square\"\nhaptic_turn_s = 0.0031\n\
     [supply]\n[gap]\nrung = \"trapezoid\"\nstep_us = 130\n[halves]\n[friction]\n[hand]\n[release]\n\
     [temperature]\nspring_percent_per_k = -0.5\nrise_k = { timeline = [[0, 0], [0.1, 20]] }\n",
];

/// What a state is, to the bit.
pub fn bits(truth: &Truth) -> [u64; 8] {
    let Truth { time_s, x_mm, y_mm, capacitance_pf, force_n, friction_n, .. } = truth;
    [*time_s, *x_mm, *y_mm, *capacitance_pf, *force_n, *friction_n, truth.direction, truth.load_g]
        .map(f64::to_bits)
}

/// Pad 0 of a scene, to the bit, in each of its slots.
fn first_pad(text: &str) -> Vec<[u64; 8]> {
    truths(text).iter().filter(|truth| truth.pad == 0).map(bits).collect()
}

/// A dragged pad of random voltage and load, its push off the centre where that has a meaning.
fn dragged(draw: &mut Draw, effects: &str) -> String {
    let eccentric = if effects.contains("halves") { "eccentricity_mm = 1\n" } else { "" };
    let pad = draw.pad();
    let at = pad.find("haptic").unwrap();
    format!(
        "[[pad]]\nposition_mm = {{ line = {{ from_mm = [-100, 0], to_mm = [90, 40], period_s = 0.07 }} }}\n\
         {eccentric}{}",
        &pad[at..]
    )
}

#[test]
fn a_pad_has_the_same_bits_alone_and_beside_any_others_coupled_or_not() {
    let mut draw = Draw(1);
    for effects in STATES {
        let pad = dragged(&mut draw, effects);
        let alone = first_pad(&format!("duration_s = 0.15\n{pad}[sheet]\n{effects}"));
        for others in [1, 3, 6] {
            let others_pads: String = (0..others).map(|_| draw.pad()).collect();
            for coupling in ["", "[coupling]\n"] {
                let text =
                    format!("duration_s = 0.15\n{pad}{others_pads}[sheet]\n{coupling}{effects}");
                let beside = first_pad(&text);
                let its_slots = alone.iter().step_by(others + 1);
                assert!(beside.iter().zip(its_slots).all(|(a, b)| a == b), "{text}");
            }
        }
    }
}

#[test]
fn a_slot_that_nobody_asked_for_before_is_as_it_is_for_those_who_ask_for_all() {
    let mut draw = Draw(2);
    for effects in STATES {
        let text = format!("duration_s = 0.12\n{}{effects}", dragged(&mut draw, effects));
        let (all, mut some) = (truths(&text), plant(&text));
        for slot in (0..all.len()).filter(|slot| slot * slot % 7 == 2) {
            assert_eq!(bits(&some.truth(slot)), bits(&all[slot]), "{text}");
        }
    }
}

/// Set just before the slot that sees it, or all ahead, or twice.
#[test]
fn a_drive_that_is_set_has_the_bits_of_the_same_steps_in_the_scene() {
    let mut draw = Draw(3);
    for (n, effects) in STATES.into_iter().enumerate() {
        let steps = draw.steps(0.14);
        let carrier =
            if effects.contains("[carrier]") { "" } else { "[carrier]\nhaptic_hz = 200\n" };
        let text = |volt: &str| format!("duration_s = 0.15\n{}{carrier}{effects}", pads(volt, 1));
        let scenes = truths(&text(&timeline(&steps)));
        let mut plant = plant(&text("123"));
        let mut left = steps.iter().peekable();
        for (slot, scenes) in scenes.iter().enumerate() {
            let ahead_s = if n % 2 == 0 { 0.0 } else { 1.0 };
            while let Some([time_s, volt]) =
                left.next_if(|[time_s, _]| *time_s <= scenes.time_s + ahead_s)
            {
                plant.set_drive(0, *time_s, *volt).unwrap();
                if n % 3 == 0 {
                    let again_s = time_s + 1e-6;
                    plant.set_drive(0, again_s, *volt).unwrap();
                }
            }
            let driven = plant.truth(slot);
            assert_eq!(bits(&driven), bits(scenes), "{effects}");
            assert_eq!((driven.haptic_v_rms, driven.set), (scenes.haptic_v_rms, scenes.set));
        }
    }
}

#[test]
fn what_has_been_seen_cannot_be_driven_anew() {
    let mut plant = plant(&format!("duration_s = 0.1\n{}{}", pads("100", 1), gap(GAP)));
    plant.set_drive(1, 0.05, 200.0).unwrap();
    let seen_s = plant.truth(10).time_s;
    let refused = |result: Result<(), DriveError>| result.unwrap_err().to_string();
    assert_eq!(
        refused(plant.set_drive(0, seen_s - 1e-9, 1.0)),
        format!("expected a time of {seen_s} s or later, got {} s", seen_s - 1e-9)
    );
    assert_eq!(
        refused(plant.set_drive(1, 0.04, 1.0)),
        "expected a time of 0.05 s or later, got 0.04 s"
    );
    assert_eq!(refused(plant.set_drive(2, 0.06, 1.0)), "expected a pad below 2, got 2");
    for volt in [-1.0, f64::NAN, 2e5] {
        assert!(matches!(plant.set_drive(0, 0.06, volt), Err(DriveError::Voltage(_))));
    }
    assert!(plant.set_drive(0, f64::NAN, 1.0).is_err());
    assert_eq!(plant.truth(12).haptic_v_rms, 100.0, "the scene's, where nothing was set");
    plant.set_drive(0, 0.06, 50.0).unwrap();
    plant.set_drive(0, 0.06, 70.0).unwrap();
    assert_eq!(plant.truth(40).haptic_v_rms, 70.0, "the later of two at one time");
    assert_eq!(plant.truth(41).haptic_v_rms, 200.0);
}

/// A point of a sweep begins with its first slot, for all pads.
#[test]
fn a_sweep_steps_where_a_points_first_slot_begins() {
    let see = |volt: &str, length: &str| {
        let effects = "[supply]\n[friction]\nrung = \"lugre\"\n";
        let text = format!("{length}\n{}{}{effects}", pads(volt, 1), gap(GAP));
        truths(&text).iter().map(bits).collect::<Vec<_>>()
    };
    let steps = [[0.0, 100.0], [0.017, 350.0], [2.0 * 0.017, 0.0], [3.0 * 0.017, 250.0]];
    let swept = see("{ sweep = [100, 350, 0, 250] }", "dwell_slots = 5");
    assert_eq!(swept.len(), 40);
    assert!(swept == see(&timeline(&steps), "duration_s = 0.068"));
}

/// The pulse of 350 V above brakes a dragged pad by some tenths of a newton for 6.4 ms.
#[test]
fn friction_between_two_slots_is_as_with_a_step_of_a_microsecond() {
    let see = |volt: &str, friction_us: u32, gap_us: u32| {
        let drag = "{ line = { from_mm = [-100, 0], to_mm = [100, 0], period_s = 2 } }";
        let pads = pads(volt, 3).replacen("[0, 0]", drag, 1);
        let gap = gap(&format!("{GAP}step_us = {gap_us}\n"));
        truths(&format!(
            "duration_s = 0.14\n{pads}{gap}[hand]\n[friction]\nstep_us = {friction_us}\n"
        ))
    };
    let pulse = square(350.0, [0.1034, 0.1098]);
    let off_um = |a: &[Truth], b: &[Truth]| {
        let off_um = |(a, b): (&Truth, &Truth)| 1e3 * (a.x_mm - b.x_mm).abs();
        a.iter().zip(b).map(off_um).fold(0.0, f64::max)
    };
    let (exact, usual) = (see(&pulse, 1, 10), see(&pulse, 100, 100));
    let braked_um = off_um(&exact, &see("0", 1, 10));
    println!("braked by {braked_um} µm, off by {} µm", off_um(&exact, &usual));
    assert!(braked_um > 100.0 && off_um(&exact, &usual) < 16.0);
}

/// 1 N on 50 g that nothing holds, begun 50 µs later: it is slower by 1 mm/s from then on.
#[test]
fn a_push_begins_when_the_scene_says() {
    let far_mm = |on_s: f64| {
        let push = format!("{{ timeline = [[{on_s}, 0], [{on_s}, 1]] }}");
        let truths = truths(&format!(
            "duration_s = 0.1\n[[pad]]\nposition_mm = [0, 0]\nload_g = 0\npush_x_n = {push}\n\
             [hand]\nstiffness_n_per_m = 0\ndamping_n_s_per_m = 0\n[friction]\nrung = \"stiction\"\n"
        ));
        let last = truths.last().unwrap();
        (last.x_mm, last.time_s)
    };
    let ((early_mm, time_s), (late_mm, _)) = (far_mm(0.003), far_mm(0.00305));
    let expected_mm = 1.0 * (time_s - 0.003025);
    assert!(((early_mm - late_mm) / expected_mm - 1.0).abs() < 1e-3, "{early_mm} {late_mm}");
}
