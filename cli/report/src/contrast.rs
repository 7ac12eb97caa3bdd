// SPDX-License-Identifier: MIT OR Apache-2.0
//! The style sheet's colours against its page, in both modes.

use super::colours::{STYLE, modes};

/// Relative luminance, as the accessibility guidelines define it.
fn luminance(colour: &str) -> f64 {
    let channel = |at: usize| {
        f64::from(u8::from_str_radix(&colour[at..at + 2], 16).expect("hexadecimal")) / 255.0
    };
    let linear = |v: f64| {
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * linear(channel(0)) + 0.7152 * linear(channel(2)) + 0.0722 * linear(channel(4))
}

fn contrast(a: &str, b: &str) -> f64 {
    let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
    a.max(b) / a.min(b)
}

fn check(names: &[String], least: f64) {
    for mode in modes() {
        for name in names {
            let contrast = contrast(mode[name.as_str()], mode["page"]);
            assert!(contrast >= least, "{name}: {contrast:.2} on {}", mode["page"]);
        }
    }
}

#[test]
fn text_reaches_4_5() {
    check(&["k0", "k1", "pass", "fail"].map(String::from), 4.5);
}

#[test]
fn lines_and_dots_reach_3() {
    let series = (10..16).chain(60..66).chain([3]);
    check(&series.map(|n| format!("k{n}")).collect::<Vec<_>>(), 3.0);
}

#[test]
fn every_class_has_a_colour_in_both_modes() {
    let indices = (0..4).chain(10..16).chain(30..41).chain(50..56).chain(60..66);
    for n in indices {
        assert!(modes().iter().all(|mode| mode.contains_key(format!("k{n}").as_str())), "{n}");
        assert!(STYLE.contains(&format!(".k{n} {{ --k: var(--k{n}) }}")), "{n}");
    }
}
