// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several clients, one source: who sees what, who stops whom, and what presets do.

use hapticore_live::presets;
use hapticore_live::setup::simulated;
use serde_json::Value;
use tungstenite::Message;

use crate::client::{Client, Live, opening};

#[test]
fn what_one_client_does_all_see() {
    let live = Live::of("hockey");
    let (mut one, mut other) = (live.client(), live.client());
    other.next("hello");
    one.done("\"type\":\"lead\",\"pad\":3,\"mm\":[-300,100]");
    let at = |frames: &Value| frames["pads"]["true_x_mm"][3].as_f64();
    other.until(|value| value["type"] == "frames" && at(value) == Some(-300.0));
    let status = other.until(|value| value["type"] == "status" && value["clients"] == 2);
    assert_eq!(status["inputs"], 1);
}

#[test]
fn an_input_that_is_wrong_is_refused_with_its_range() {
    let live = Live::of("hockey");
    let mut client = live.client();
    let cases = [
        ("\"type\":\"lead\",\"pad\":99,\"mm\":[0,0]", "pad: expected below 4, got 99"),
        ("\"type\":\"lead\",\"pad\":0,\"mm\":[1e9,0]", "lead: expected"),
        (
            "\"type\":\"lead\",\"pad\":0,\"mm\":[0,0],\"within_s\":-1",
            "within_s: expected 0.0001 to 3600, got -1",
        ),
        ("\"type\":\"set\",\"pad\":0,\"load_g\":-1", "load_g: expected"),
        ("\"type\":\"set\",\"pad\":0,\"push_x_n\":1", "push: expected"),
        ("\"type\":\"target\",\"pad\":0,\"n\":0.3", "target: expected a case with [control]"),
        ("\"type\":\"wall\",\"mm\":0", "wall: expected a case with [wall]"),
        (
            "\"type\":\"subscribe\",\"columns\":[\"x\"],\"every\":\"slot\"",
            "columns: expected names among slot, time_s",
        ),
    ];
    for (command, expected) in cases {
        let message = client.refused(command);
        assert!(message.starts_with(expected), "{command}: {message}");
    }
    assert_eq!(client.next("status")["inputs"], 0);
}

#[test]
fn a_scene_is_replaced_for_all_and_a_broken_one_for_none() {
    let live = Live::of("hockey");
    let (mut one, mut other) = (live.client(), live.client());
    other.next("hello");
    let broken = [
        ("\"scene\":\"cricket\"", "scene: expected one of fig3"),
        ("\"scene\":\"/etc/passwd\"", "scene: expected one of fig3"),
        ("\"scene\":\"peg\",\"profile\":\"/etc/passwd\"", "profile: expected small"),
        ("\"scene\":\"peg\",\"set\":{\"profile\":\"'../x.toml'\"}", "profile: expected small"),
        ("\"scene\":\"peg\",\"set\":{\"pad.0.load\":5}", "peg.toml: --set pad.0.load"),
        ("\"scene\":\"peg\",\"set\":{\"gap\":false}", "peg"),
        (
            "\"scene\":\"peg\",\"case\":7",
            "case: expected a number below 1 or one of main, got \"7\"",
        ),
        (
            "\"scene\":\"peg\",\"core\":\"quick\"",
            "core: expected float, fixed or clock, got \"quick\"",
        ),
    ];
    for (what, expected) in broken {
        let message = one.refused(&format!("\"type\":\"open\",{what}"));
        assert!(message.starts_with(expected), "{what}: {message}");
    }
    let before = other.next("frames")["slot"].as_u64();
    let after = other.until(|value| value["type"] == "frames" && value["slot"].as_u64() > before);
    assert_eq!(after["pads"]["pad"].as_array().unwrap().len(), 4, "the old scene runs on");
    one.done(
        "\"type\":\"open\",\"scene\":\"minimal-gap\",\"case\":1,\"set\":{\"pad.0.load_g\":33}",
    );
    let hello = other.next("hello");
    assert_eq!((&hello["scene"], &hello["case"]), (&"minimal-gap".into(), &"even gap".into()));
    assert_eq!(
        (&hello["inputs"][0]["value"], &hello["set"]["pad.0.load_g"]),
        (&33.0.into(), &"33".into())
    );
    assert_eq!(
        hello["command"],
        "hapticore simulate minimal-gap --set pad.0.load_g=33 --case 'even gap'"
    );
}

#[test]
fn steps_are_exact_and_time_stands_until_the_client_leaves() {
    let live = Live::of("hockey");
    let (mut script, mut other) = (live.client(), live.client());
    let first = script.done("\"type\":\"step\",\"slots\":1");
    let columns = ["slot", "time_s", "pad", "x_mm", "force_n", "true_force_n"];
    let list = serde_json::to_string(&columns).unwrap();
    script.done(&format!(
        "\"type\":\"subscribe\",\"columns\":{list},\"every\":\"slot\",\"format\":\"binary\""
    ));
    assert_eq!(script.done("\"type\":\"lead\",\"pad\":2,\"mm\":[0,0]"), first, "time stands");
    script.send("{\"id\":999,\"type\":\"step\",\"slots\":300}");
    let bytes = loop {
        if let Message::Binary(bytes) = script.read() {
            break bytes;
        }
    };
    assert_eq!(
        (&bytes[..4], bytes[4], bytes[6] as usize + 256 * bytes[7] as usize),
        (&b"HPL1"[..], 6, 300)
    );
    let value = |column: usize, row: usize| {
        let at = 8 + 8 * (column * 300 + row);
        f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
    };
    // The same, without a server.
    let mut own = simulated(&opening("hockey", &[])).unwrap();
    let lead = hapticore_live::protocol::Command::Lead { pad: 2, mm: [0.0; 2], within_s: None };
    for slot in 0..first as usize + 300 {
        use hapticore_live::source::Source;
        if slot == first as usize {
            own.apply(&lead).unwrap();
        }
        let (number, row) = own.advance().unwrap().row.expect("a row");
        let Some(at) = slot.checked_sub(first as usize) else { continue };
        let truth = row.truth.unwrap();
        let expected = [
            number as f64,
            row.time_s,
            row.pad as f64,
            row.measured.x_mm,
            row.measured.force_n,
            truth.quantities.force_n,
        ];
        let got: Vec<f64> = (0..6).map(|column| value(column, at)).collect();
        assert_eq!(got, expected, "slot {slot}");
    }
    let stood = other.until(|value| value["type"] == "status" && value["stepped"] == true);
    assert_eq!(stood["asked_speed"], 1.0);
    let slot = script.done("\"type\":\"pace\",\"speed\":0");
    assert_eq!(slot, first + 300);
    script.done("\"type\":\"step\",\"slots\":1");
    script.done("\"type\":\"pace\",\"speed\":1");
    script.done("\"type\":\"step\",\"slots\":1");
    drop(script);
    let runs = other.until(|value| value["type"] == "status" && value["stepped"] == false);
    assert_eq!(runs["clients"], 1);
    let before = other.next("frames")["slot"].as_u64();
    other.until(|value| value["type"] == "frames" && value["slot"].as_u64() > before);
}

#[test]
fn a_pause_and_its_end_are_honest() {
    let live = Live::of("hockey");
    let mut client = live.client();
    client.done("\"type\":\"pace\",\"speed\":0");
    client.next("status");
    let status = client.next("status");
    assert_eq!((&status["speed"], &status["asked_speed"]), (&0.0.into(), &0.0.into()));
    let one = client.done("\"type\":\"set\",\"pad\":0,\"load_g\":50");
    assert_eq!(client.done("\"type\":\"set\",\"pad\":0,\"load_g\":60"), one);
    client.done("\"type\":\"pace\",\"speed\":0.5");
    client.until(|value| value["type"] == "frames" && value["slot"].as_u64() > Some(one + 50));
}

#[test]
fn nobody_watching_time_stands() {
    let live = Live::of("hockey");
    let mut client = live.client();
    client.done("\"type\":\"pace\",\"speed\":0");
    let slot = client.done("\"type\":\"slot\"");
    client.done("\"type\":\"pace\",\"speed\":10");
    drop(client);
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let now = live.client().next("frames")["slot"].as_u64().unwrap();
    assert!(now - slot < 4000, "{} slots of some 8800", now - slot);
}

/// Steps until the state of a pad is this one; the frames then.
fn step_until(client: &mut Client, pad: usize, state: &str) -> Value {
    let mut frames = Value::Null;
    for _ in 0..60 {
        frames = step(client, 100);
        if frames["pads"]["state"][pad] == state {
            return frames;
        }
    }
    panic!("pad {pad} is never {state}: {frames}");
}

fn step(client: &mut Client, slots: usize) -> Value {
    client.send(&format!("{{\"type\":\"step\",\"slots\":{slots},\"id\":5}}"));
    let mut last = Value::Null;
    client.until(|value| {
        if value["type"] == "frames" {
            last = value.clone();
        }
        value["type"] == "done" && value["id"] == 5
    });
    last
}

fn preset(name: &str) -> (Live, Client) {
    let all = presets::all();
    let preset = all.iter().find(|preset| preset.name == name).expect("a preset");
    let live = Live::new(preset.opening.clone());
    let mut client = live.client();
    client.next("hello");
    (live, client)
}

fn of_pad(frames: &Value, column: &str, pad: usize) -> f64 {
    frames["pads"][column][pad].as_f64().expect("a number")
}

/// Leads a pad there in a quarter of a second.
fn lead(client: &mut Client, pad: usize, [x_mm, y_mm]: [f64; 2]) {
    client
        .done(&format!("\"type\":\"lead\",\"pad\":{pad},\"mm\":[{x_mm},{y_mm}],\"within_s\":0.25"));
}

#[test]
fn preset_wall_brakes_and_lets_go() {
    let (_live, mut client) = preset("wall");
    let stirred = step(&mut client, 2000);
    assert_eq!(stirred["pads"]["state"][0], "free");
    lead(&mut client, 0, [-3.0, 150.0]);
    let pushed = step(&mut client, 1200);
    assert!(of_pad(&pushed, "force_n", 0) > 0.3, "{pushed}");
    assert!((of_pad(&pushed, "depth_mm", 0) + of_pad(&pushed, "x_mm", 0)).abs() < 1e-3);
    assert_eq!(pushed["pads"]["state"][0], "in wall");
    lead(&mut client, 0, [8.0, 150.0]);
    assert!(of_pad(&step_until(&mut client, 0, "free"), "target_n", 0) == 0.0);
    // Out of the way, the wall is felt nowhere.
    client.done("\"type\":\"wall\",\"off\":true");
    lead(&mut client, 0, [-3.0, 150.0]);
    let off = step(&mut client, 1200);
    assert_eq!((&off["walls"][0], of_pad(&off, "target_n", 0)), (&Value::Null, 0.0));
}

#[test]
fn preset_corner_brakes_along_both_axes() {
    let (_live, mut client) = preset("corner");
    step(&mut client, 2600);
    lead(&mut client, 0, [-3.0, 10.0]);
    assert!(of_pad(&step(&mut client, 1200), "force_n", 0) > 0.3);
    lead(&mut client, 0, [10.0, 10.0]);
    step_until(&mut client, 0, "free");
    lead(&mut client, 0, [10.0, -3.0]);
    assert!(of_pad(&step(&mut client, 1200), "force_n", 0) > 0.3);
}

#[test]
fn preset_hold_keeps_the_force_under_any_load() {
    let (_live, mut client) = preset("hold");
    let mut drives = Vec::new();
    for load_g in [30, 50, 100] {
        client.done(&format!("\"type\":\"set\",\"pad\":0,\"load_g\":{load_g}"));
        let frames = step(&mut client, 200);
        let force_n = of_pad(&frames, "true_force_n", 0);
        assert!((force_n - 0.3).abs() < 0.03, "{load_g} g: {force_n} N");
        drives.push(of_pad(&frames, "drive_v_rms", 0));
    }
    // By little: what bears the load does not pull in, and under the lighter loads the drive is at its limit. By how much
    // depends on how long the rubber has crept.
    assert!((drives[0] - drives[2]).abs() > 2.0, "the drive follows the load: {drives:?}");
}

#[test]
fn preset_pull_in_closes_the_gap() {
    let (_live, mut client) = preset("pull-in");
    let mut capacitance_pf = Vec::new();
    for volts in [0, 350, 0] {
        client.done(&format!("\"type\":\"set\",\"pad\":0,\"haptic_v_rms\":{volts}"));
        capacitance_pf.push(of_pad(&step(&mut client, 200), "capacitance_pf", 0));
    }
    assert!(capacitance_pf[1] > 1.4 * capacitance_pf[0], "{capacitance_pf:?}");
    assert!(capacitance_pf[2] < 1.1 * capacitance_pf[0], "{capacitance_pf:?}");
}

#[test]
fn preset_coupled_errs_until_crosstalk_is_cancelled() {
    let (_live, mut client) = preset("coupled");
    let off_mm = |frames: &Value| {
        let of = |axis: &str| of_pad(frames, axis, 0) - of_pad(frames, &format!("true_{axis}"), 0);
        of("x_mm").hypot(of("y_mm"))
    };
    let raw_mm = off_mm(&step(&mut client, 60));
    let opening = serde_json::to_value(&presets::all()[4]).unwrap();
    client.done(&format!(
        "\"type\":\"open\",\"scene\":\"four-pads\",\"case\":1,\"set\":{}",
        opening["set"]
    ));
    let cancelled_mm = off_mm(&step(&mut client, 60));
    assert!(raw_mm > 2.0 && cancelled_mm < 1.0, "{raw_mm} mm, {cancelled_mm} mm");
}

#[test]
fn preset_rules_sticks_by_eq_11_and_lets_go_by_rule_a() {
    let (_live, mut client) = preset("rules");
    let push_and_draw = |client: &mut Client| {
        step(client, 1600);
        lead(client, 0, [-4.0, 0.0]);
        step(client, 1600);
        client.done("\"type\":\"lead\",\"pad\":0,\"mm\":[8,0],\"within_s\":0.4");
        (0..20).any(|_| step(client, 100)["pads"]["state"][0] == "sticking")
    };
    assert!(push_and_draw(&mut client), "eq. 11 sticks");
    let opening = serde_json::to_value(&presets::all()[5]).unwrap();
    client.done(&format!(
        "\"type\":\"open\",\"scene\":\"fig15\",\"case\":0,\"set\":{}",
        opening["set"]
    ));
    assert!(!push_and_draw(&mut client), "rule A lets go");
}
