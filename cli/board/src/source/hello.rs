// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a page must know of a board.

use hapticore_contract::profile::Profile;
use hapticore_host::{DeviceCalibration, SlotClock};
use hapticore_live::protocol::{COLUMNS, Hello, InputInfo, Limits, Pad, VERSION, Wall};
use hapticore_run::record::Provenance;

use crate::target::Described;

/// What a page must know of a board.
pub(super) fn hello(
    profile: &Profile,
    device: &DeviceCalibration,
    described: &Described,
    (name, is_virtual): (&str, bool),
) -> Hello {
    let clock = SlotClock::new(profile, device.device.sample_rate_hz, 0.0);
    let provenance = Provenance::new();
    let pad = |name: &String| Pad { name: name.clone(), parts_mm: described.parts_mm.clone() };
    let target = profile.control.as_ref().map(|control| InputInfo {
        name: "pad.target_n",
        unit: "N",
        label: "Target force",
        least: 0.0,
        most: control.target.real(control.target.max_code() as i64).min(1.0),
        value: 0.0,
        per: "pad",
    });
    let wall = profile.wall.map(|_| Wall { axis: "x", mm: 0.0, inside: "below" });
    Hello {
        protocol: VERSION,
        version: provenance.version,
        commit: provenance.commit,
        source: "board",
        scene: name.to_string(),
        title: described.title.clone(),
        profile: profile.name.clone(),
        fidelity: if is_virtual { "virtual board’s" } else { "board’s" }.into(),
        command: format!("hapticore host {name} --page"),
        slot_us: 1e6 * clock.seconds(1),
        parts: described.parts_mm.len(),
        pads: described.pads.iter().map(pad).collect(),
        sheet_mm: described.sheet_mm,
        pad_diameter_mm: described.pad_diameter_mm,
        terminals_mm: described.terminals_mm.clone(),
        columns: COLUMNS.to_vec(),
        inputs: target.into_iter().collect(),
        controller: profile.control.is_some(),
        walls: wall.into_iter().collect(),
        limits: Limits { rail_v: described.rail_v, ..Limits::default() },
        leads: is_virtual,
        truth: false,
        speed: 1.0,
        ..Hello::default()
    }
}
