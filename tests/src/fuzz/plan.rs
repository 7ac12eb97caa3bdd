// SPDX-License-Identifier: MIT OR Apache-2.0
//! Plans of sweeps: TOML in, points and their names out.

use hapticore_sweep::plan::Plan;

use super::{TOML, refused};

pub(super) fn check(data: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(data) else { return false };
    // A plan names files: what they are is no concern of its reader.
    if text.contains(['/', '\\']) {
        return false;
    }
    match Plan::parse(text, TOML) {
        Err(error) => refused(error, TOML),
        Ok(plan) => {
            let written = serde_json::to_string(&plan).expect("plain data");
            let again: Plan = serde_json::from_str(&written).expect("the same data");
            assert_eq!(again, plan);
            assert_eq!(again.name(), plan.name());
            check_points(&plan);
            true
        }
    }
}

fn check_points(plan: &Plan) {
    let Some(last) = plan.len().checked_sub(1) else { return };
    let names = plan.names();
    let [first, last] = [0, last].map(|index| plan.point(index));
    let same =
        (&first.profile, &first.scene, first.seed) == (&last.profile, &last.scene, last.seed);
    assert_eq!(names.of(&first) == names.of(&last), same, "{first:?}, {last:?}");
}
