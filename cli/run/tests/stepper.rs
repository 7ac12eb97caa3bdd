// SPDX-License-Identifier: MIT OR Apache-2.0
//! A case that is stepped is a case that is run, to the bit, and takes inputs between its slots.

use std::sync::Arc;

use hapticore_contract::control::Surface;
use hapticore_contract::profile::Profile;
use hapticore_run::case::{Case, Settings};
use hapticore_run::engine::{Fidelity, Signals, Slot};
use hapticore_run::inputs;
use hapticore_run::maker::Maker;
use hapticore_run::record::Row;
use hapticore_run::session::Session;
use hapticore_run::stepper::{Input, InputError, Options, Stepper};
use hapticore_scene::{Scene, Timing, gallery};

const FIXED: Options = Options { fidelity: Fidelity::Fixed, errors: false, reference: false };

fn load(name: &str, set: &[(&str, &str)]) -> (Arc<Scene>, Profile) {
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let scene = inputs::scene(name, &set).unwrap_or_else(|error| panic!("{error:#}"));
    let profile = inputs::windowed(inputs::profile(&scene.profile).unwrap(), &scene).unwrap();
    let timing = Timing { signs: None, ..inputs::timing(&profile) };
    (Arc::new(scene.within_budget(&timing).unwrap()), profile)
}

fn stepper(name: &str, set: &[(&str, &str)], options: Options) -> Stepper {
    let (scene, profile) = load(name, set);
    Stepper::new(scene, 0, &profile, options).unwrap_or_else(|error| panic!("{name}: {error:#}"))
}

/// Rows to the bit: `Debug` prints a float so that it can be read back.
fn text_of(rows: &[Row]) -> Vec<String> {
    rows.iter().map(|row| format!("{row:?}")).collect()
}

fn step(stepper: &mut Stepper, slots: usize) -> Vec<Row> {
    (0..slots).filter_map(|_| stepper.step().expect("a slot")).collect()
}

/// Rows of the first slots of a case, run and stepped.
fn check(
    scene: &Arc<Scene>,
    index: usize,
    profile: &Profile,
    (fidelity, slots): (Fidelity, usize),
) {
    let mut case = Case::new(scene, index, profile, &[]).unwrap();
    case.slots = case.slots.min(slots);
    let errors = fidelity == Fidelity::Fixed && index == 0;
    let outcome = case.run(&Settings { fidelity, errors }, None, &|| ()).unwrap();
    let options = Options { fidelity, errors, reference: true };
    let mut stepper = Stepper::new(scene.clone(), index, profile, options).unwrap();
    let mut rows = step(&mut stepper, case.slots);
    rows.extend(stepper.finish().unwrap());
    let of = format!("{}, case {}, {}", scene.name, case.name(), fidelity.name());
    assert_eq!(rows.len(), case.slots, "{of}");
    for (stepped, run) in text_of(&rows).iter().zip(text_of(&outcome.rows)) {
        assert_eq!(*stepped, run, "{of}");
    }
    assert_eq!(format!("{:?}", stepper.errors()), format!("{:?}", outcome.errors), "{of}");
}

#[test]
fn stepping_every_bundled_case_gives_the_rows_of_its_run() {
    for (name, _) in gallery::all() {
        let (scene, profile) = load(name, &[]);
        let slots = match *name {
            "peg" | "wall-2d" | "air-hockey" => 400,
            "hockey" | "fig9" | "fig15" => 200,
            _ => 24,
        };
        for index in 0..scene.cases.len() {
            check(&scene, index, &profile, (Fidelity::Fixed, slots));
        }
    }
}

#[test]
fn stepping_at_other_fidelities_gives_the_rows_of_the_run() {
    for (name, slots) in
        [("hockey", 9), ("fig9", 9), ("peg", 17), ("wall-2d", 9), ("air-hockey", 17)]
    {
        let (scene, profile) = load(name, &[]);
        for fidelity in [Fidelity::Float, Fidelity::Clock] {
            check(&scene, 0, &profile, (fidelity, slots));
        }
    }
}

#[test]
fn stepping_goes_on_after_the_case_as_a_longer_case_does() {
    for (name, [short, long]) in [("hockey", ["0.05", "0.2"]), ("peg", ["0.02", "0.06"])] {
        let mut short = stepper(name, &[("duration_s", short)], FIXED);
        let mut long = stepper(name, &[("duration_s", long)], FIXED);
        let slots = long.case().slots;
        assert!(slots > 2 * short.case().slots);
        assert_eq!(text_of(&step(&mut short, slots)), text_of(&step(&mut long, slots)), "{name}");
        assert_eq!((short.slot(), short.time_s()), (slots, long.time_s()));
        assert!(short.time_s() > 2.0 * short.case().seconds());
    }
}

#[test]
fn a_sweep_begins_again_after_its_end() {
    let mut stepper = stepper("minimal-sheet", &[], FIXED);
    let slots = stepper.case().slots;
    let rows = step(&mut stepper, 2 * slots);
    let set = |row: &Row| row.truth.expect("a plant").set;
    assert!(rows[..slots].iter().map(set).eq(rows[slots..].iter().map(set)));
}

#[test]
fn the_reference_runs_on_demand_and_changes_no_measurement() {
    for name in ["hockey", "peg"] {
        let with = step(&mut stepper(name, &[], Options { reference: true, ..FIXED }), 100);
        let without = step(&mut stepper(name, &[], FIXED), 100);
        assert!(with.iter().all(|row| row.reference.is_some()));
        assert!(without.iter().all(|row| row.reference.is_none()));
        let of: Vec<_> = with.into_iter().map(|row| Row { reference: None, ..row }).collect();
        assert_eq!(text_of(&of), text_of(&without), "{name}");
    }
}

/// Random numbers that a seed decides.
struct Draw(u64);

impl Draw {
    /// From 0 up to 1.
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, end: usize) -> usize {
        (self.share() * end as f64) as usize
    }
}

/// Lines that begin at slots and end before the next one does.
#[test]
fn a_led_finger_gives_the_rows_of_the_scenes_timeline() {
    let text = gallery::find("peg").expect("bundled");
    let at = text.find("position_mm").expect("a pad");
    let end = at + text[at..].find('\n').expect("a line");
    let scene = |position: &str| {
        let text = format!("{}position_mm = {position}{}", &text[..at], &text[end..]);
        Scene::parse(&text, "peg.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let profile = inputs::profile("fast").unwrap();
    let step = |position: &str, log: &[(usize, Input)]| {
        let mut stepper = Stepper::new(scene(position).into(), 0, &profile, FIXED).unwrap();
        let mut rows = Vec::new();
        for slot in 0..1400 {
            for (_, input) in log.iter().filter(|(at, _)| *at == slot) {
                stepper.apply(input).unwrap();
            }
            rows.extend(stepper.step().unwrap());
        }
        text_of(&rows)
    };
    let clock = stepper("peg", &[], FIXED).case().clock;
    let lines = [(30, 3.0, 0.05), (300, -12.0, 0.08), (700, -12.0, 0.01), (900, 1.5, 0.1)];
    let (mut points, mut log) = (vec![[0.0, 0.5]], Vec::new());
    for (slot, x_mm, within_s) in lines {
        let from_s = clock.seconds(slot);
        points.extend([[from_s, points[points.len() - 1][1]], [from_s + within_s, x_mm]]);
        log.push((slot, Input::Lead { pad: 0, to_mm: [x_mm, 150.0], within_s }));
    }
    let timeline = format!("{{ timeline = {{ x_mm = {points:?}, y_mm = [[0, 150]] }} }}");
    let (led, scripted) = (step("[0.5, 150]", &log), step(&timeline, &[]));
    assert!(led == scripted);
    assert!(led != step("[0.5, 150]", &[]), "no effect");
}

/// An input that some case takes, and some no case does.
fn draw(random: &mut Draw) -> Input {
    let mut within = |low: f64, high: f64| low + (high - low) * random.share();
    let near = [within(-25.0, 15.0), within(-25.0, 15.0)];
    let value = within(0.0, 1.0);
    let within_s = within(0.002, 0.03);
    let pad = random.below(5);
    match random.below(10) {
        0..3 => Input::Lead { pad, to_mm: near, within_s },
        3 => Input::Release { pad },
        4 => Input::Press { pad, load_g: 200.0 * value - 5.0 },
        5 => Input::Push { pad, newtons: [value, -0.5 * value] },
        6 => Input::Target { pad, newtons: value },
        7 => match random.below(4) {
            0 => Input::Wall { x_mm: None, y_mm: None, off: true },
            1 => Input::Wall { x_mm: None, y_mm: Some(near[1]), off: false },
            _ => Input::Wall { x_mm: Some(near[0]), y_mm: None, off: false },
        },
        8 => Input::Serve,
        _ => Input::Voltage { pad, v_rms: 400.0 * value - 10.0 },
    }
}

#[test]
fn a_log_of_random_inputs_replays_to_the_bit() {
    let names = ["peg", "wall-2d", "hockey", "fig9", "four-pads", "air-hockey"];
    for (seed, name) in names.into_iter().enumerate() {
        let mut random = Draw(seed as u64);
        let mut live = stepper(name, &[], FIXED);
        let (mut rows, mut log, mut refused) = (Vec::new(), Vec::new(), 0);
        for _ in 0..1000 {
            while random.share() < 0.12 {
                let input = draw(&mut random);
                match live.apply(&input) {
                    Ok(()) => log.push((live.slot(), input)),
                    Err(_) => refused += 1,
                }
            }
            rows.extend(live.step().unwrap());
        }
        assert!(log.len() > 10 && refused > 10, "{name}: {} taken, {refused} not", log.len());
        // As a file keeps it.
        let kept = serde_json::to_string(&log).unwrap();
        let log: Vec<(usize, Input)> = serde_json::from_str(&kept).unwrap();
        let mut again = stepper(name, &[], FIXED);
        let mut left = log.iter().peekable();
        let mut replayed = Vec::new();
        for slot in 0..1000 {
            while let Some((_, input)) = left.next_if(|(at, _)| *at == slot) {
                again.apply(input).unwrap();
            }
            replayed.extend(again.step().unwrap());
        }
        let (rows, replayed) = (text_of(&rows), text_of(&replayed));
        assert!(rows == replayed, "{name}");
        assert_ne!(rows, text_of(&step(&mut stepper(name, &[], FIXED), 1000)), "{name}: no effect");
    }
}

fn wrong() -> Vec<Input> {
    let (nan, pad) = (f64::NAN, 0);
    let wall = |x_mm, y_mm, off| Input::Wall { x_mm, y_mm, off };
    vec![
        Input::Lead { pad: 99, to_mm: [0.0; 2], within_s: 0.012 },
        Input::Lead { pad, to_mm: [nan, 0.0], within_s: 0.012 },
        Input::Lead { pad, to_mm: [1e9, 0.0], within_s: 0.012 },
        Input::Lead { pad, to_mm: [0.0; 2], within_s: 0.0 },
        Input::Lead { pad, to_mm: [0.0; 2], within_s: nan },
        Input::Release { pad: 4 },
        Input::Press { pad, load_g: -1.0 },
        Input::Press { pad, load_g: f64::INFINITY },
        Input::Press { pad: usize::MAX, load_g: 10.0 },
        Input::Push { pad, newtons: [0.0, nan] },
        Input::Target { pad, newtons: nan },
        Input::Target { pad, newtons: 1e6 },
        Input::Target { pad: 4, newtons: 0.1 },
        Input::Voltage { pad, v_rms: nan },
        Input::Voltage { pad, v_rms: -1.0 },
        Input::Voltage { pad: usize::MAX, v_rms: 100.0 },
        wall(None, None, false),
        wall(Some(1.0), None, true),
        wall(Some(nan), None, false),
        wall(Some(1.0), Some(1e9), false),
        wall(Some(1e9), None, false),
    ]
}

#[test]
fn wrong_inputs_are_refused_and_change_nothing() {
    for name in ["peg", "wall-2d", "hockey", "fig9"] {
        let mut stepper = stepper(name, &[], FIXED);
        let mut rows = Vec::new();
        for _ in 0..150 {
            for input in wrong() {
                assert!(stepper.apply(&input).is_err(), "{name}: {input:?}");
            }
            rows.extend(stepper.step().unwrap());
        }
        assert_eq!(
            text_of(&rows),
            text_of(&step(&mut self::stepper(name, &[], FIXED), 150)),
            "{name}"
        );
    }
}

#[test]
fn refusals_name_the_value_and_what_is_expected() {
    let [mut peg, mut hockey] = ["peg", "hockey"].map(|name| stepper(name, &[], FIXED));
    let refused = |of: &mut Stepper, input: Input| of.apply(&input).unwrap_err().to_string();
    let wrong = Input::Press { pad: 99, load_g: 1.0 };
    assert_eq!(refused(&mut peg, wrong), "pad: expected below 4, got 99");
    let wrong = Input::Press { pad: 1, load_g: -3.0 };
    assert_eq!(refused(&mut peg, wrong), "load_g: expected a load of 0 to 100000 g, got -3");
    let wrong = Input::Lead { pad: 0, to_mm: [0.0; 2], within_s: -1.0 };
    assert_eq!(refused(&mut peg, wrong), "within_s: expected 0.0001 to 3600, got -1");
    let wrong = Input::Wall { x_mm: Some(500.0), y_mm: None, off: false };
    assert_eq!(refused(&mut peg, wrong), "x_mm: expected -430 to 430, got 500");
    let wrong = Input::Wall { x_mm: None, y_mm: Some(5.0), off: false };
    assert_eq!(refused(&mut peg, wrong), "wall: expected no y_mm: the case has no wall along y");
    let voltage = Input::Voltage { pad: 0, v_rms: 100.0 };
    assert!(matches!(peg.apply(&voltage), Err(InputError::Absent { key: "voltage", .. })));
    let target = Input::Target { pad: 0, newtons: 0.1 };
    assert_eq!(refused(&mut hockey, target), "target: expected a case with [control]");
    let wall = Input::Wall { x_mm: None, y_mm: None, off: true };
    assert_eq!(refused(&mut hockey, wall), "wall: expected a case with [wall]");
}

/// Steps until a time; the last row of the whole pad 0.
fn last_of_pad_0(stepper: &mut Stepper, until_s: f64) -> Row {
    let parts = stepper.plant().parts();
    let mut last = None;
    while stepper.time_s() < until_s {
        last = stepper.step().unwrap().filter(|row| row.pad == parts - 1).or(last);
    }
    last.expect("a row of the pad")
}

#[test]
fn a_led_finger_meets_the_wall_where_it_was_put_and_none_when_it_is_off() {
    let mut stepper = stepper("peg", &[], FIXED);
    let apply = |stepper: &mut Stepper, input: Input| stepper.apply(&input).unwrap();
    let lead = |x_mm: f64, within_s: f64| Input::Lead { pad: 0, to_mm: [x_mm, 150.0], within_s };
    let wall = |x_mm| Input::Wall { x_mm: Some(x_mm), y_mm: None, off: false };
    let target_n = |row: &Row| row.driven.expect("a controller").target_n;
    // The scene stirs the pad, from which the core learns what its direction reads in free air.
    apply(&mut stepper, wall(-5.0));
    assert_eq!(stepper.walls_mm(), [Some(-5.0), None]);
    let free = last_of_pad_0(&mut stepper, 0.45);
    assert_eq!(target_n(&free), 0.0, "{free:?}");
    apply(&mut stepper, lead(-8.0, 0.3));
    let within = last_of_pad_0(&mut stepper, 0.8);
    assert!(target_n(&within) > 0.3, "{within:?}");
    assert!(within.truth.unwrap().quantities.force_n > 0.2, "{within:?}");
    apply(&mut stepper, Input::Wall { x_mm: None, y_mm: None, off: true });
    let off = last_of_pad_0(&mut stepper, 0.85);
    assert_eq!((target_n(&off), stepper.walls_mm()), (0.0, [None, None]), "{off:?}");
    apply(&mut stepper, lead(0.0, 0.1));
    let off = last_of_pad_0(&mut stepper, 1.1);
    assert!(off.driven.unwrap().drive_v_rms < 1.0, "no target, no voltage: {off:?}");
    apply(&mut stepper, wall(-5.0));
    apply(&mut stepper, lead(-8.0, 0.3));
    let again = last_of_pad_0(&mut stepper, 1.45);
    assert!(target_n(&again) > 0.3, "{again:?}");
}

/// The scene's hand rests 1.2 mm deep in either wall, and 1.5 mm in their corner.
#[test]
fn depths_are_of_the_wall_that_the_part_is_known_by() {
    let rows = step(&mut stepper("wall-2d", &[], FIXED), 12_800);
    let deepest = |part: usize| {
        let of_part = rows.iter().filter(|row| row.truth.is_some_and(|truth| truth.part == part));
        let depths = of_part.filter_map(|row| Some(row.driven?.wall?.depth_mm));
        depths.reduce(f64::max)
    };
    assert_eq!([deepest(0), deepest(1)], [None, None], "no wall is known by these");
    for depth_mm in [deepest(2), deepest(3)].map(|depth| depth.expect("a wall")) {
        assert!((1.4..2.5).contains(&depth_mm), "{depth_mm} mm");
    }
}

#[test]
fn a_target_is_followed_by_its_pad_alone_until_the_next() {
    let (scene, profile) = load("fig9", &[]);
    let closed = scene.cases.iter().position(|case| case.name == "square 0.3 N, closed loop");
    let mut stepper = Stepper::new(scene, closed.expect("a case"), &profile, FIXED).unwrap();
    stepper.apply(&Input::Target { pad: 0, newtons: 0.21 }).unwrap();
    let row = last_of_pad_0(&mut stepper, 0.3);
    let (driven, truth) = (row.driven.unwrap(), row.truth.unwrap());
    assert!((driven.target_n, truth.set.target_n) == (0.21, 0.21), "{row:?}");
    assert!((truth.quantities.force_n - 0.21).abs() < 0.03, "{row:?}");
    stepper.apply(&Input::Target { pad: 0, newtons: 0.0 }).unwrap();
    let row = last_of_pad_0(&mut stepper, 0.5);
    assert!(row.driven.unwrap().target_n == 0.0 && row.driven.unwrap().drive_v_rms < 1.0);
}

#[test]
fn a_voltage_is_given_to_its_pad_where_nothing_controls() {
    let mut stepper = stepper("hockey", &[], FIXED);
    stepper.apply(&Input::Voltage { pad: 1, v_rms: 123.0 }).unwrap();
    for row in step(&mut stepper, 40) {
        let volt = row.truth.unwrap().set.haptic_v_rms;
        assert_eq!(volt == 123.0, row.pad == 1, "{row:?}");
    }
}

#[test]
fn codes_are_those_of_the_last_slots_window() {
    let [mut fixed, mut clock] = [Fidelity::Fixed, Fidelity::Clock]
        .map(|fidelity| stepper("hockey", &[], Options { fidelity, ..FIXED }));
    assert!(fixed.codes().is_none(), "no slot yet");
    let profile = fixed.case().profile.clone();
    let (window, channels) = (profile.slot.integrate as usize, profile.channels());
    let mut before = Vec::new();
    for _ in 0..5 {
        fixed.step().unwrap();
        clock.step().unwrap();
        let codes = fixed.codes().expect("samples");
        assert_eq!((codes.len(), codes), (window * channels, clock.codes().unwrap()));
        assert!(fixed.peak() > 0.0 && fixed.peak() <= 1.0 && codes != before);
        before = codes.to_vec();
    }
    let mut phasors = stepper("hockey", &[("carrier.rung", "phasor")], FIXED);
    phasors.step().unwrap();
    assert!(phasors.codes().is_none());
}

#[test]
fn a_slot_that_the_core_cannot_take_is_refused_and_changes_nothing() {
    for (name, fidelity) in [
        ("hockey", Fidelity::Float),
        ("hockey", Fidelity::Fixed),
        ("hockey", Fidelity::Clock),
        ("peg", Fidelity::Fixed),
        ("peg", Fidelity::Clock),
    ] {
        let (scene, profile) = load(name, &[]);
        let case = Case::new(&scene, 0, &profile, &[]).unwrap();
        let tuning = case.tuning(&case.plant().unwrap()).unwrap();
        let session = || {
            let device = (&**case.device, case.calibration().unwrap());
            let options = (Options { fidelity, ..FIXED }, tuning.as_ref());
            Session::new(&case.profile, device, options, (0, case.clock)).unwrap()
        };
        let whole = fidelity == Fidelity::Clock;
        let mut maker = Maker::new(case.plant().unwrap(), &case.profile, true, whole);
        let (mut refusing, mut same) = (session(), session());
        let pads = case.profile.pads as usize;
        for number in 0..12 {
            let (signals, _) = maker.signals(number);
            let (codes, blanking) = match &signals {
                Signals::Samples { codes, blanking } => (codes.clone(), *blanking),
                Signals::Phasors { .. } => unreachable!("samples"),
            };
            let short = Signals::Samples { codes: codes[1..].to_vec(), blanking };
            let beyond = |code: i128| {
                let mut codes = codes.clone();
                *codes.last_mut().expect("a code") = i32::try_from(code).expect("a code");
                Signals::Samples { codes, blanking }
            };
            let adc = case.profile.formats.adc;
            let pad = number % pads;
            for wrong in [
                Slot { pad, signals: beyond(adc.max_code() + 1) },
                Slot { pad, signals: beyond(adc.min_code() - 1) },
                Slot { pad, signals: beyond(i32::MIN.into()) },
                Slot { pad: pads, signals: signals.clone() },
                Slot { pad: 99, signals: signals.clone() },
                Slot { pad, signals: short },
                Slot { pad, signals: Signals::Samples { codes: Vec::new(), blanking: 8 } },
                Slot {
                    pad,
                    signals: Signals::Phasors { amplitudes: Vec::new(), mean_square: 0.0 },
                },
            ] {
                assert!(refusing.slot(&wrong, None).is_err(), "{name}, {wrong:?}");
            }
            assert!(refusing.set_target(pads, 0.1).is_err());
            assert!(refusing.set_surface(99, Surface { mm: 0.0, right: true }).is_err());
            let slot = Slot { pad, signals };
            let rows = [&mut refusing, &mut same].map(|of| of.slot(&slot, None).unwrap());
            assert_eq!(format!("{:?}", rows[0]), format!("{:?}", rows[1]), "{name}");
            let drives = [&mut refusing, &mut same].map(Session::take_drive);
            assert_eq!(format!("{:?}", drives[0]), format!("{:?}", drives[1]), "{name}");
        }
    }
}

#[test]
fn a_core_of_a_device_has_the_pads_that_are_asked_for() {
    let profile = inputs::profile("small").unwrap();
    let device = hapticore_run::calibrate::nominal(&profile).unwrap();
    let pads = |pads| Session::of_device(&profile, &device, pads, FIXED);
    assert_eq!(pads(Some(3)).unwrap().1.pads, 3);
    assert_eq!(pads(None).unwrap().1.pads, device.pads);
    for wrong in [0, 257, u64::MAX] {
        let message = pads(Some(wrong)).err().expect("an error").to_string();
        assert!(message.contains("expected 1 to 256"), "{message}");
    }
}

#[test]
fn the_core_of_a_case_gives_the_rows_of_the_case_on_its_codes() {
    for name in ["hockey", "wall-2d"] {
        let mut stepper = stepper(name, &[], FIXED);
        let mut core = stepper.case().core(FIXED).unwrap();
        for _ in 0..24 {
            let row = stepper.step().unwrap().expect("a row");
            let codes = stepper.codes().expect("samples").to_vec();
            let signals = Signals::Samples { codes, blanking: 0 };
            let alone = core.slot(&Slot { pad: row.pad, signals }, None).unwrap().expect("a row");
            assert_eq!((row.measured, row.flags), (alone.measured, alone.flags), "{name}");
        }
    }
}

/// A core of clocks takes the pads in turn: whatever is not is an error, no panic.
#[test]
fn pads_out_of_turn_are_refused_where_the_core_counts_them() {
    let (scene, profile) = load("hockey", &[]);
    let case = Case::new(&scene, 0, &profile, &[]).unwrap();
    let device = (&**case.device, case.calibration().unwrap());
    let options = (Options { fidelity: Fidelity::Clock, ..FIXED }, None);
    let mut session = Session::new(&case.profile, device, options, (0, case.clock)).unwrap();
    let mut maker = Maker::new(case.plant().unwrap(), &case.profile, true, true);
    let mut slot = |number, pad| Slot { pad, signals: maker.signals(number).0 };
    let taken: Vec<_> = [0, 2, 1].map(|pad| session.slot(&slot(pad, pad), None)).into();
    assert!(taken.iter().any(Result::is_err), "{taken:?}");
}

#[test]
fn a_stepper_that_is_restarted_gives_its_first_rows_without_its_inputs() {
    for (name, fidelity) in [("peg", Fidelity::Fixed), ("hockey", Fidelity::Clock)] {
        let mut first = stepper(name, &[], Options { fidelity, ..FIXED });
        let rows = step(&mut first, 40);
        first.apply(&Input::Lead { pad: 0, to_mm: [5.0, 5.0], within_s: 0.01 }).unwrap();
        step(&mut first, 40);
        let mut again = first.restart().unwrap();
        assert_eq!(again.slot(), 0);
        assert_eq!(text_of(&step(&mut again, 40)), text_of(&rows), "{name}");
    }
}

#[test]
fn a_case_that_cannot_be_stepped_is_refused() {
    let (scene, profile) = load("hockey", &[("carrier.rung", "phasor")]);
    let clock = Options { fidelity: Fidelity::Clock, ..FIXED };
    let refused = |scene: &Arc<Scene>, index, options| {
        Stepper::new(scene.clone(), index, &profile, options).err().expect("an error").to_string()
    };
    assert!(refused(&scene, 0, clock).contains("carrier.rung"), "phasors have no clocks");
    assert_eq!(refused(&scene, 99, FIXED), "hockey: case: expected below 1, got 99");
}
