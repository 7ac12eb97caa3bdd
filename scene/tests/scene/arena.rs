// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[arena]`: its keys, and what it needs of the other tables.

use hapticore_scene::{ArenaPlan, Scene, gallery};

fn read(set: &[(&str, &str)]) -> Result<ArenaPlan, String> {
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    let text = gallery::find("air-hockey").expect("bundled");
    let scene = Scene::parse(text, "air-hockey.toml", &set).map_err(|error| error.to_string())?;
    Ok(scene.cases[0].arena.clone().expect("an arena"))
}

#[test]
fn keys_that_are_left_out_have_defaults() {
    let text = "title = \"t\"\nduration_s = 1\n[gap]\n[halves]\nquadrants = true\nsenses = \"each\"\n[control]\n\
                [wall]\n[arena]\n[[pad]]\nposition_mm = [-150, 0]\n";
    let scene = Scene::parse(text, "t.toml", &[]).unwrap();
    let arena = scene.cases[0].arena.clone().expect("an arena");
    let expected = ArenaPlan {
        half_mm: [300.0, 180.0],
        goal_half_mm: 60.0,
        mallet_radius_mm: 15.0,
        puck_radius_mm: 12.0,
        puck_g: 20.0,
        puck_mu: 0.02,
        puck_mm: [0.0; 2],
        puck_mm_s: [0.0; 2],
        restitution_wall: 0.9,
        restitution_mallet: 0.8,
        impact_ms: 30.0,
        force_n: 1.0,
        serve_s: Vec::new(),
    };
    assert_eq!(arena, expected);
    assert_eq!(read(&[("arena.serve_s", "[1, 2.5]")]).unwrap().serve_s, [1.0, 2.5]);
}

#[test]
fn wrong_keys_and_combinations_are_refused_with_the_cure() {
    let cases: [(&[(&str, &str)], &str); 17] = [
        (&[("wall", "false")], "arena: expected [wall] too"),
        (&[("halves.quadrants", "false")], "arena: expected [halves] with quadrants = true too"),
        (&[("wall.surface_mm", "0")], "wall.surface_mm: expected none with [arena]"),
        (&[("wall.inside_y", "\"above\"")], "wall.inside_y: expected none with [arena]"),
        (&[("pad.1.target_n", "0.3")], "target_n: expected none with [arena]"),
        (&[("arena.half_mm", "[500, 100]")], "arena.half_mm: expected at most [430.0, 250.0]"),
        (&[("arena.half_mm", "[0, 100]")], "arena.half_mm: expected a list, each a number above 0"),
        (
            &[("arena.puck_mm", "[289, 0]")],
            "arena.puck_mm: expected a place within ±288 and ±168 mm",
        ),
        (
            &[("arena.puck_radius_mm", "46")],
            "arena.puck_radius_mm: expected a number above 0 and at most 45",
        ),
        (&[("arena.goal_half_mm", "11")], "arena.goal_half_mm: expected a number from 12 to 180"),
        (
            &[("arena.restitution_wall", "1.1")],
            "arena.restitution_wall: expected a number from 0 to 1",
        ),
        (
            &[("arena.restitution_mallet", "-0.1")],
            "arena.restitution_mallet: expected a number from 0 to 1",
        ),
        (&[("arena.puck_g", "0")], "arena.puck_g: expected a number from 0.1 to 1000"),
        (&[("arena.impact_ms", "0.5")], "arena.impact_ms: expected a number from 1 to 1000"),
        (&[("arena.serve_s", "[2, 1]")], "arena.serve_s: expected times that rise"),
        (&[("arena.impact", "3")], "arena.impact: expected impact_ms, since a key names its unit"),
        (&[("arena.ice", "3")], "arena.ice: unknown key"),
    ];
    for (set, expected) in cases {
        let message = read(set).expect_err(expected);
        assert!(message.contains(expected), "{set:?}: {message}");
    }
}
