// SPDX-License-Identifier: MIT OR Apache-2.0
//! How views and tests name signals: a path in which `*` stands for any characters of one name and
//! `**` for any scopes.
//!
//! `core.demodulator.i` is one signal; `core.*.busy` the busy flags of the blocks of the core;
//! `**.busy` all busy flags; `core.position.**` everything within a block.

/// Whether `path` fits `pattern`.
pub fn fits(pattern: &str, path: &str) -> bool {
    let (pattern, path): (Vec<_>, Vec<_>) =
        (pattern.split('.').collect(), path.split('.').collect());
    names_fit(&pattern, &path)
}

fn names_fit(pattern: &[&str], path: &[&str]) -> bool {
    match pattern {
        [] => path.is_empty(),
        ["**", rest @ ..] => (0..=path.len()).any(|skipped| names_fit(rest, &path[skipped..])),
        [first, rest @ ..] => path
            .split_first()
            .is_some_and(|(name, path)| name_fits(first, name) && names_fit(rest, path)),
    }
}

fn name_fits(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((start, rest)) => name.strip_prefix(start).is_some_and(|name| ends_fit(rest, name)),
    }
}

/// Whether some end of `name` fits.
fn ends_fit(pattern: &str, name: &str) -> bool {
    name.char_indices().map(|(at, _)| &name[at..]).chain([""]).any(|end| name_fits(pattern, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stars_stand_for_names_and_scopes() {
        let yes = [
            ("core.demodulator.i", "core.demodulator.i"),
            ("core.*.busy", "core.force.busy"),
            ("**.busy", "core.a.b.busy"),
            ("**.busy", "busy"),
            ("core.**", "core.a.b"),
            ("core.i_*", "core.i_3"),
            ("*.*_valid*", "core.i_valid"),
        ];
        let no = [
            ("core.*", "core.a.b"),
            ("core.*.busy", "core.busy"),
            ("core.i", "core.i2"),
            ("core.*a*b", "core.xbxa"),
            ("i", "core.i"),
            ("", "core"),
        ];
        yes.iter().for_each(|(pattern, path)| assert!(fits(pattern, path), "{pattern} {path}"));
        no.iter().for_each(|(pattern, path)| assert!(!fits(pattern, path), "{pattern} {path}"));
    }
}
