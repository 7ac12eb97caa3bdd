// SPDX-License-Identifier: MIT OR Apache-2.0
//! Messages: every example parses, what is written is read again, and what a page needs is there.

use hapticore_live::protocol::{
    COLUMNS, Command, Every, Format, Opening, Recording, Request, Setting, Subscription,
};
use hapticore_live::rows;
use hapticore_live::setup;
use hapticore_live::source::Source;

use crate::client::{Live, opening};

fn commands() -> Vec<Command> {
    let setting = |setting| Command::Set { pad: 1, setting };
    vec![
        Command::Lead { pad: 3, mm: [3.2, -150.0], within_s: None },
        Command::Lead { pad: 0, mm: [0.1, 1e-9], within_s: Some(0.5) },
        Command::Release { pad: 0 },
        setting(Setting::LoadG(60.5)),
        setting(Setting::PushXN(-0.25)),
        setting(Setting::PushYN(1.0)),
        setting(Setting::HapticVRms(350.0)),
        setting(Setting::TargetN(0.3)),
        Command::Target { pad: 0, n: 0.3 },
        Command::Wall { x_mm: Some(-1.5), y_mm: None, off: false },
        Command::Wall { x_mm: Some(-1.5), y_mm: Some(2.0), off: false },
        Command::Wall { x_mm: None, y_mm: None, off: true },
        Command::Serve,
        Command::Pace { speed: 0.1 },
        Command::Pace { speed: 0.0 },
        Command::Step { slots: 8 },
        Command::Slot,
        Command::Record { to: Recording::Start },
        Command::Record { to: Recording::Scene },
        Command::Record { to: Recording::Log },
        Command::Open(Opening { case: Some("raw".into()), ..opening("hockey", &[("seed", "3")]) }),
        Command::Subscribe(Subscription {
            columns: vec!["time_s".into()],
            every: Every::Slot,
            format: Format::Binary,
        }),
    ]
}

#[test]
fn what_a_client_writes_is_what_a_server_reads() {
    for (n, command) in commands().into_iter().enumerate() {
        let request = Request { id: (n % 2 == 0).then_some(n as u64), command };
        let text = serde_json::to_string(&request).unwrap();
        assert_eq!(Request::parse(&text), Ok(request), "{text}");
    }
}

#[test]
fn the_examples_of_the_protocol_parse() {
    let examples = include_str!("../../src/protocol.rs").lines().filter_map(|line| {
        line.strip_prefix("//! | `{")?.split_once("` |").map(|(example, _)| format!("{{{example}"))
    });
    let examples: Vec<String> = examples.collect();
    assert!(examples.len() >= 12, "{}", examples.len());
    for example in examples {
        assert!(Request::parse(&example).is_ok(), "{example}: {:?}", Request::parse(&example));
    }
    let wall = Request::parse(r#"{"type":"wall","mm":-1.5}"#).unwrap().command;
    assert_eq!(wall, Command::Wall { x_mm: Some(-1.5), y_mm: None, off: false });
}

#[test]
fn a_bad_field_is_named_with_what_was_expected() {
    let cases = [
        ("nonsense", "message: expected JSON"),
        ("[1]", "message: expected an object, got [1]"),
        ("{}", "type: expected a word, got none"),
        (r#"{"type":"fly"}"#, "type: expected one of lead, release"),
        (r#"{"type":"pace"}"#, "speed: expected a number, got none"),
        (r#"{"type":"pace","speed":-1}"#, "speed: expected 0, or 0.001 to 10, got -1"),
        (r#"{"type":"pace","speed":1e999}"#, "message: expected JSON"),
        (r#"{"type":"pace","speed":NaN}"#, "message: expected JSON"),
        (r#"{"type":"lead","pad":-1,"mm":[0,0]}"#, "pad: expected the number of a pad, got -1"),
        (r#"{"type":"lead","pad":0,"mm":[0]}"#, "mm: expected two numbers, got [0]"),
        (r#"{"type":"set","pad":0}"#, "set: expected exactly one of load_g"),
        (r#"{"type":"set","pad":0,"load_g":1,"target_n":2}"#, "set: expected exactly one of"),
        (r#"{"type":"step","slots":0}"#, "slots: expected 1 to 10000, got 0"),
        (r#"{"type":"step","slots":10001}"#, "slots: expected 1 to 10000, got 10001"),
        (r#"{"type":"wall"}"#, "wall: expected one of mm, x_mm, y_mm"),
        (r#"{"type":"record","to":"tape"}"#, "to: expected \"start\", \"scene\" or \"log\""),
        (r#"{"type":"open","scene":"peg","set":{"a":{}}}"#, "set: expected keys with texts"),
        (r#"{"type":"slot","id":"seven"}"#, "id: expected a whole number, got \"seven\""),
    ];
    for (text, expected) in cases {
        let message = Request::parse(text).unwrap_err().message;
        assert!(message.starts_with(expected), "{text}: {message}");
    }
    let long = format!("{{\"type\":\"{}\"}}", "a".repeat(100));
    let message = Request::parse(&long).unwrap_err().message;
    assert!(message.len() < 300 && message.ends_with('…'), "{message}");
}

#[test]
fn a_hello_says_what_a_page_needs() {
    let live = Live::of("peg");
    let hello = live.client().next("hello");
    assert_eq!(hello["protocol"], 1);
    assert_eq!((&hello["scene"], &hello["profile"]), (&"peg".into(), &"fast".into()));
    assert_eq!(hello["pads"][3]["name"], "fourth");
    assert_eq!(hello["pads"][0]["parts_mm"], serde_json::json!([[-7.5, 0.0], [7.5, 0.0]]));
    assert_eq!(hello["walls"][0]["axis"], "x");
    assert_eq!(hello["walls"][0]["inside"], "below");
    assert_eq!(hello["limits"]["rail_v"], 500.0);
    assert_eq!(hello["command"], "hapticore simulate peg");
    assert_eq!(hello["inputs"][0]["name"], "pad.load_g");
    assert_eq!(hello["inputs"][0]["value"], 60.0);
    assert!(hello["scenes"].as_array().unwrap().contains(&"hockey".into()));
    assert_eq!(hello["presets"].as_array().unwrap().len(), 7);
    assert!(hello.get("arena").is_none());
}

#[test]
fn frames_have_a_column_of_each_kind_and_a_value_for_each_pad() {
    let live = Live::of("peg");
    let mut client = live.client();
    client.send(r#"{"type":"step","slots":64}"#);
    let frames =
        client.until(|value| value["type"] == "frames" && value["slot"].as_u64() >= Some(64));
    for column in COLUMNS.iter().map(|column| column.name).chain(["pad", "state", "flags"]) {
        assert_eq!(frames["pads"][column].as_array().map(Vec::len), Some(4), "{column}");
    }
    let place = |name: &str| frames["pads"][name][1].as_f64().expect("a number");
    assert!((place("x_mm") - place("true_x_mm")).abs() < 1.0);
    assert!((place("y_mm") - 50.0).abs() < 1.0, "the second pad: {}", place("y_mm"));
    assert_eq!(frames["pads"]["state"][0], "free");
    assert_eq!(
        (frames["terminals"].as_array().unwrap().len(), &frames["walls"][0]),
        (6, &(-10.0).into())
    );
}

#[test]
fn a_game_is_in_hello_and_frames_and_a_goal_is_told() {
    // Straight into the right goal, past the mallet.
    let served =
        [("arena.puck_mm", "[200, 40]"), ("arena.puck_mm_s", "[4000, 0]"), ("arena.puck_mu", "0")];
    let live = Live::new(opening("air-hockey", &served));
    let mut client = live.client();
    let hello = client.next("hello");
    assert_eq!(hello["arena"]["half_mm"], serde_json::json!([300.0, 180.0]));
    let reach =
        serde_json::json!([[[-285.0, -15.0], [-165.0, 165.0]], [[15.0, 285.0], [-165.0, 165.0]]]);
    assert_eq!(hello["arena"]["reach_mm"], reach);
    assert_eq!(
        (&hello["walls"], &hello["presets"][6]["name"]),
        (&serde_json::json!([]), &"air-hockey".into())
    );
    client.send(r#"{"type":"step","slots":160}"#);
    let note = client.next("note");
    assert_eq!(note["text"], "Goal of the left player: 1 to 0");
    let frames = client.until(|value| value["type"] == "frames" && value["game"]["score"][0] == 1);
    assert_eq!(frames["game"]["puck_mm"], serde_json::json!([0.0, 0.0]));
    client.done("\"type\":\"serve\"");
    client.send(r#"{"type":"step","slots":1}"#);
    let again =
        client.until(|value| value["type"] == "frames" && value["game"]["puck_mm"][0] != 0.0);
    assert_eq!(
        (&again["game"]["score"][0], &again["game"]["puck_mm"][1]),
        (&1.into(), &40.0.into())
    );
}

#[test]
fn a_scene_without_a_game_refuses_a_serve() {
    let live = Live::of("peg");
    let mut client = live.client();
    client.send(r#"{"type":"serve","id":5}"#);
    let error = client.next("error");
    assert_eq!(error["message"], "serve: expected a case with [arena]");
}

#[test]
fn a_slot_has_the_codes_of_its_window() {
    let live = Live::of("peg");
    let mut client = live.client();
    // Device time may have run before the first step.
    let last = client.done("\"type\":\"step\",\"slots\":9") - 1;
    client.send(r#"{"type":"slot"}"#);
    let slot = client.next("slot");
    let mut own = setup::simulated(&opening("peg", &[])).unwrap();
    let profile = own.stepper().case().profile.clone();
    (0..=last).for_each(|_| drop(own.advance().unwrap()));
    let expected = own.codes();
    assert_eq!((&slot["slot"], &slot["pad"]), (&last.into(), &expected.pad.into()));
    assert_eq!(slot["codes"], serde_json::to_value(&expected.codes).unwrap());
    assert_eq!(slot["channels"].as_array().unwrap().len(), profile.channels());
    assert_eq!(slot["channels"][7], "V_h");
    let codes = slot["codes"][6].as_array().unwrap();
    assert_eq!(codes.len(), profile.slot.integrate as usize);
    let full_scale = slot["full_scale"].as_i64().unwrap();
    assert!(
        codes.iter().any(|code| code.as_i64().unwrap() > full_scale / 4),
        "the sensing voltage"
    );
}

#[test]
fn every_column_of_rows_can_be_subscribed_to() {
    let names = rows::names();
    let subscription =
        Subscription { columns: names.clone(), every: Every::Slot, format: Format::Json };
    assert!(rows::Subscriber::new(&subscription).unwrap().is_some());
    let mut once = names.clone();
    once.sort();
    once.dedup();
    assert_eq!(once.len(), names.len(), "each name once");
}

#[test]
fn the_document_has_the_messages_of_the_protocol() {
    let document = include_str!("../../../../docs/live.md");
    let rows =
        include_str!("../../src/protocol.rs").lines().filter_map(|line| line.strip_prefix("//! |"));
    let missing: Vec<&str> = rows.filter(|row| !document.contains(*row)).collect();
    assert!(missing.is_empty(), "{missing:#?}");
}
