// SPDX-License-Identifier: MIT OR Apache-2.0
//! The bundled scenes, after the figures of the paper.

/// Name and text of each scene.
const SCENES: &[(&str, &str)] = &[
    ("fig3", include_str!("../gallery/fig3.toml")),
    ("fig4", include_str!("../gallery/fig4.toml")),
    ("fig6", include_str!("../gallery/fig6.toml")),
    ("hockey", include_str!("../gallery/hockey.toml")),
];

/// All bundled scenes: name and TOML text.
pub fn all() -> &'static [(&'static str, &'static str)] {
    SCENES
}

/// The text of the scene of this name.
pub fn find(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
