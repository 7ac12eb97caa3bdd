// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes: after the figures of the paper, of what a device may have besides, and a
//! minimal one per effect.

/// Name and text of each scene.
const SCENES: &[(&str, &str)] = &[
    ("fig3", include_str!("../gallery/fig3.toml")),
    ("fig4", include_str!("../gallery/fig4.toml")),
    ("fig6", include_str!("../gallery/fig6.toml")),
    ("fig7", include_str!("../gallery/fig7.toml")),
    ("fig9", include_str!("../gallery/fig9.toml")),
    ("fig13", include_str!("../gallery/fig13.toml")),
    ("fig15", include_str!("../gallery/fig15.toml")),
    ("wall-2d", include_str!("../gallery/wall-2d.toml")),
    ("air-hockey", include_str!("../gallery/air-hockey.toml")),
    ("peg", include_str!("../gallery/peg.toml")),
    ("hockey", include_str!("../gallery/hockey.toml")),
    ("terminals-500-ohm", include_str!("../gallery/terminals-500-ohm.toml")),
    ("shunt-panel", include_str!("../gallery/shunt-panel.toml")),
    ("non-uniform-sheet", include_str!("../gallery/non-uniform-sheet.toml")),
    ("four-pads", include_str!("../gallery/four-pads.toml")),
    ("minimal-sheet", include_str!("../gallery/minimal-sheet.toml")),
    ("minimal-shunt", include_str!("../gallery/minimal-shunt.toml")),
    ("minimal-coupling", include_str!("../gallery/minimal-coupling.toml")),
    ("minimal-switching", include_str!("../gallery/minimal-switching.toml")),
    ("minimal-sensor", include_str!("../gallery/minimal-sensor.toml")),
    ("minimal-friction", include_str!("../gallery/minimal-friction.toml")),
    ("minimal-gap", include_str!("../gallery/minimal-gap.toml")),
    ("minimal-halves", include_str!("../gallery/minimal-halves.toml")),
    ("minimal-supply", include_str!("../gallery/minimal-supply.toml")),
    ("minimal-charge", include_str!("../gallery/minimal-charge.toml")),
];

/// All bundled scenes: name and TOML text.
pub fn all() -> &'static [(&'static str, &'static str)] {
    SCENES
}

/// The text of the scene of this name.
///
/// ```
/// use hapticore_scene::{Scene, gallery};
///
/// let scene = Scene::parse(gallery::find("hockey").unwrap(), "hockey.toml", &[])?;
/// assert_eq!(scene.cases[0].pad_names().len(), 4);
/// assert!(gallery::find("cricket").is_none());
/// # Ok::<(), hapticore_scene::SceneError>(())
/// ```
pub fn find(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
