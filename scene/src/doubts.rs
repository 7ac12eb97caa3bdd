// SPDX-License-Identifier: MIT OR Apache-2.0
//! What of a scene can be run, but makes results that mean less than they seem to.

use crate::control::{ControlLaw, ControlPlan};
use crate::device::Device;
use crate::effects::Spec;
use crate::error::SceneError;
use crate::format::Table;
use crate::pad::PadPlan;
use crate::wave::{HapticWave, LEAST_TAUS};

/// Levels of `[gap]` that follow a drive immediately.
const AT_REST: [&str; 2] = ["static", "hysteresis"];

/// Time constant of a supply beyond which a loop's frames, a millisecond or less, cannot do without it, s.
const SLOW_S: f64 = 5e-4;

/// The doubts about a scene, a sentence each, which begins with the key that is their cause.
pub(crate) fn of_scene(
    root: &Table,
    (device, effects): (&Device, &[Spec]),
    control: Option<&ControlPlan>,
    pads: &[PadPlan],
) -> Result<Vec<String>, SceneError> {
    let turns = turns_too_often(device);
    let Some(control) = control else { return Ok(turns.into_iter().collect()) };
    let all = [
        turns,
        slow_supply(device),
        gap_at_rest(effects),
        no_friction(effects),
        open_law(control),
        rail_that_clips(device, control),
        unreadable_direction(root, control, pads)?,
    ];
    Ok(all.into_iter().flatten().collect())
}

/// A square wave whose turns the supply has no time for.
fn turns_too_often(device: &Device) -> Option<String> {
    let HapticWave::Square { turn_s: Some(turn_s) } = device.haptic_wave else { return None };
    let least_s = LEAST_TAUS * device.recharge_s;
    (turn_s < least_s).then(|| {
        format!(
            "carrier.haptic_turn_s = {turn_s}: behind [supply] a pad is recharged with a time constant of {:.0} µs, so that \
             turns take much of its force; take {least_s:.4} at least, or leave it out",
            1e6 * device.recharge_s
        )
    })
}

/// A supply that takes longer than a loop's frames: its level sets the voltage at the pad at once.
fn slow_supply(device: &Device) -> Option<String> {
    (device.recharge_s > SLOW_S).then(|| {
        format!(
            "supply.limiting_kohm with [control]: a pad is recharged with a time constant of {:.1} ms, but simulated without it, \
             so that forces of a loop come later than they seem; lower it",
            1e3 * device.recharge_s
        )
    })
}

fn has(effects: &[Spec], name: &str) -> bool {
    effects.iter().any(|effect| effect.name == name)
}

fn gap_at_rest(effects: &[Spec]) -> Option<String> {
    let gap = effects.iter().find(|effect| effect.name == "gap")?;
    let word = AT_REST.into_iter().find(|word| gap.is_at(word))?;
    Some(format!(
        "gap.rung = \"{word}\" with [control]: the gap follows the drive at once, so that a loop swings or settles as no \
         pad would; leave gap.rung out, or take \"moving\""
    ))
}

fn no_friction(effects: &[Spec]) -> Option<String> {
    (has(effects, "gap") && !has(effects, "friction")).then(|| {
        "friction: absent, so that no friction acts on the pads of [control], and their forces are of the nominal \
         device.mu; add [friction]"
            .to_string()
    })
}

/// A closed law whose gains the scene sets to zero.
fn open_law(control: &ControlPlan) -> Option<String> {
    let zero = |gain: Option<f64>| gain == Some(0.0);
    let (key, is_open) = match control.law {
        ControlLaw::Proportional => ("proportional_v", zero(control.proportional_v)),
        ControlLaw::Integral => {
            let given = control.proportional_v.is_some() || control.integral_v.is_some();
            ("integral_v", given && control.integral_v.unwrap_or_default() == 0.0)
        }
        ControlLaw::Open | ControlLaw::Inverse => return None,
    };
    is_open.then(|| {
        let law = control.law.name();
        format!(
            "control.{key} = 0 with law = \"{law}\": nothing takes an error of the force away; leave the gains out, and \
             they follow from the device"
        )
    })
}

/// A drive that the haptic channel cannot read: then estimates are invalid, and the drive stays off.
fn rail_that_clips(device: &Device, control: &ControlPlan) -> Option<String> {
    let (rail_v, readable_v) = (control.rail_v, device.readable_v());
    (rail_v > readable_v).then(|| {
        format!(
            "control.rail_v = {rail_v}: the haptic channel clips above {readable_v:.0} V rms, and a pad driven higher is \
             switched off; lower it, or raise sensor.haptic_full_scale_v"
        )
    })
}

/// Walls that let go by a direction that no push changes.
fn unreadable_direction(
    root: &Table,
    control: &ControlPlan,
    pads: &[PadPlan],
) -> Result<Option<String>, SceneError> {
    if control.wall.is_none() || pads.iter().any(PadPlan::is_pushed_off_centre) {
        return Ok(None);
    }
    let at_sheet = match root.table("halves")? {
        Some(halves) => {
            halves.node("push_height_mm").and_then(|node| node.value.number()) == Some(0.0)
        }
        None => true,
    };
    let (key, cause) = match (root.table("hand")?.is_some(), at_sheet) {
        (false, _) => ("hand", "absent, so that nothing pushes the pads of [wall]"),
        (true, true) => ("halves.push_height_mm", "0, so that no push tilts the pads of [wall]"),
        (true, false) => return Ok(None),
    };
    Ok(Some(format!(
        "{key}: {cause}: the direction of the push cannot be read, and a wall may never let go"
    )))
}
