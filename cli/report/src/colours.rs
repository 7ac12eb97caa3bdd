// SPDX-License-Identifier: MIT OR Apache-2.0
//! The colours of the style sheet, by name.

use std::collections::BTreeMap;

/// Colours and the classes that draw with them.
pub const STYLE: &str = include_str!("colours.css");

/// Colours by name, six hexadecimal digits.
pub type Colours = BTreeMap<&'static str, &'static str>;

/// The colours of the light and of the dark mode.
pub fn modes() -> [Colours; 2] {
    let (light, dark) =
        STYLE.split_once("@media (prefers-color-scheme: dark)").expect("a dark mode");
    let dark = dark.split_once(".k0 {").expect("classes after the colours").0;
    [light, dark].map(|text| {
        let pairs = text.split("--").filter_map(|part| part.split_once(": #"));
        pairs.map(|(name, rest)| (name, &rest[..6])).collect()
    })
}
