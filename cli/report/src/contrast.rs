// SPDX-License-Identifier: MIT OR Apache-2.0
//! The style sheet's colours against its page, in both modes.

use super::colours::{STYLE, modes};

/// A channel of a colour as light, 0 to 1; `at` is its first digit.
fn linear(colour: &str, at: usize) -> f64 {
    let code = u8::from_str_radix(&colour[at..at + 2], 16).expect("hexadecimal");
    let v = f64::from(code) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Relative luminance, as the accessibility guidelines define it.
fn luminance(colour: &str) -> f64 {
    0.2126 * linear(colour, 0) + 0.7152 * linear(colour, 2) + 0.0722 * linear(colour, 4)
}

/// A colour in Oklab, <https://bottosson.github.io/posts/oklab/>, in which distances are those that people see.
fn oklab(colour: &str) -> [f64; 3] {
    let [r, g, b] = [0, 2, 4].map(|at| linear(colour, at));
    let cone = |of: [f64; 3]| (of[0] * r + of[1] * g + of[2] * b).cbrt();
    let [l, m, s] = [
        [0.412_221, 0.536_333, 0.051_446],
        [0.211_903, 0.680_700, 0.107_397],
        [0.088_302, 0.281_719, 0.629_979],
    ]
    .map(cone);
    [
        0.210_454 * l + 0.793_618 * m - 0.004_072 * s,
        1.977_998 * l - 2.428_592 * m + 0.450_594 * s,
        0.025_904 * l + 0.782_772 * m - 0.808_676 * s,
    ]
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
    let series = (10..18).chain(60..66).chain([3]);
    check(&series.map(|n| format!("k{n}")).collect::<Vec<_>>(), 3.0);
}

#[test]
fn eight_pads_have_colours_that_are_told_apart() {
    for mode in modes() {
        let colours: Vec<_> = (10..18).map(|n| oklab(mode[format!("k{n}").as_str()])).collect();
        for (n, a) in colours.iter().enumerate() {
            for b in &colours[..n] {
                let apart = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                assert!(apart > 0.15, "series {n} and another: {apart:.3}");
            }
        }
    }
}

#[test]
fn every_class_has_a_colour_in_both_modes() {
    let indices = (0..4).chain(10..18).chain(30..41).chain(50..56).chain(60..66);
    for n in indices {
        assert!(modes().iter().all(|mode| mode.contains_key(format!("k{n}").as_str())), "{n}");
        assert!(STYLE.contains(&format!(".k{n} {{ --k: var(--k{n}) }}")), "{n}");
    }
}
