// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes with something to try: bundled scenes with keys set, and what to do with them.

use crate::protocol::{Opening, Preset};

/// Right of the wall, after a stir from which the core learns what the direction reads in free air.
const STIRRED: &str = "{ timeline = { x_mm = [[0, 8], [0.1, 11], [0.2, 5], [0.3, 11], [0.4, 8]], y_mm = [[0, PLACE]] } }";

/// All presets.
pub fn all() -> Vec<Preset> {
    vec![wall(), corner(), hold(), pull_in(), coupled(), rules(), air_hockey()]
}

fn preset(
    (name, label, hint): (&'static str, &'static str, &'static str),
    scene: &str,
    set: &[(&str, String)],
    case: Option<&str>,
) -> Preset {
    let set = set.iter().map(|(key, value)| (key.to_string(), value.clone())).collect();
    let case = case.map(String::from);
    Preset {
        name,
        label,
        hint,
        opening: Opening { scene: scene.into(), set, case, ..Opening::default() },
    }
}

fn wall() -> Preset {
    let stirred = |y_mm: &str| STIRRED.replace("PLACE", y_mm);
    let set = [
        ("wall.surface_mm", "0".into()),
        ("pad.0.position_mm", stirred("150")),
        ("pad.1.position_mm", stirred("50")),
        ("pad.2.position_mm", stirred("-50")),
        ("pad.3.position_mm", stirred("-150")),
    ];
    let hint = "Drag a pad to the left, past the surface at 0 mm: from there on the wall brakes it, 0.4 N for each millimetre. \
                Draw back, and it lets go. Stir in free air first: the wall learns there what no push reads.";
    preset(("wall", "Push into a wall", hint), "peg", &set, None)
}

fn corner() -> Preset {
    let place = "{ timeline = { x_mm = [[0, 14], [0.2, 8], [0.4, 14], [0.6, 10]], \
                 y_mm = [[0, 14], [0.2, 8], [0.4, 14], [0.6, 10]] } }";
    let hint = "Drag the pad into the wall on the left, into the one below, and into their corner: it brakes with the larger force.";
    preset(
        ("corner", "Corner of two walls", hint),
        "wall-2d",
        &[("pad.0.position_mm", place.into())],
        None,
    )
}

fn hold() -> Preset {
    let set = [("pad.0.target_n", "0.3".to_string())];
    let hint = "The controller holds 0.3 N. Change the load: voltage and capacitance change, the force stays. Compare case \
                \"square 0.3 N, open loop\".";
    preset(
        ("hold", "Hold 0.3 N while the load changes", hint),
        "fig9",
        &set,
        Some("square 0.3 N, closed loop"),
    )
}

fn pull_in() -> Preset {
    let set = [("pad.0.haptic_v_rms", "0".to_string())];
    let hint = "Raise the haptic voltage towards 350 V: the air gap closes patch by patch, and the capacitance jumps. Lower it \
                again: the patches let go later than they closed.";
    preset(("pull-in", "Pull-in at 350 V", hint), "minimal-gap", &set, None)
}

fn coupled() -> Preset {
    let set = [("pad.0.position_mm", "[-405, 0]".to_string())];
    let hint = "Each pad draws current from the others through the sheet: drag one to an edge and see its position error. Case \
                \"cancelled\" takes the crosstalk out.";
    preset(("coupled", "Four coupled pads", hint), "four-pads", &set, Some("raw"))
}

fn air_hockey() -> Preset {
    let stirred = |x_mm: f64| {
        let points = [(0.0, 0.0), (0.1, 6.0), (0.2, -6.0), (0.3, 6.0), (0.4, 0.0)];
        let along = |of: f64| {
            let points = points.map(|(time_s, by_mm)| format!("[{time_s}, {}]", of + by_mm));
            format!("[{}]", points.join(", "))
        };
        format!("{{ timeline = {{ x_mm = {}, y_mm = {} }} }}", along(x_mm), along(0.0))
    };
    let set = [
        ("pad.0.position_mm", stirred(-150.0)),
        ("pad.1.position_mm", stirred(150.0)),
        ("arena.puck_mm", "[0, 0]".into()),
    ];
    let hint = "Strike the puck with either mallet, two fingers for both: each impact brakes the mallet for 30 ms, and so do the \
                walls of its half. Key n serves a new puck.";
    preset(("air-hockey", "Air hockey", hint), "air-hockey", &set, None)
}

fn rules() -> Preset {
    let place = "{ timeline = { x_mm = [[0, 12], [0.2, 6], [0.3, 9]] } }";
    let hint = "By eq. 11 the voltage grows with the depth alone: drag the pad to the left into the wall, then back, and it sticks. \
                Case \"rule A, split drive\" reads the direction of the push and lets go.";
    preset(
        ("rules", "Eq. 11 against rule A", hint),
        "fig15",
        &[("pad.0.position_mm", place.into())],
        Some("eq. 11"),
    )
}
