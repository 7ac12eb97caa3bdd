// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a run leaves for `hdl` and `codes`: the profile of the core that it ran, and its controller's tuning.

use std::path::Path;

use anyhow::Result;
use hapticore_run::case::Case;
use hapticore_run::tuning_file::{self, TuningFile};

/// The name under which a run writes the profile of its core.
const PROFILE: &str = "profile.toml";

/// What its first line begins with.
const MARK: &str = "# Profile of the core that hapticore simulate ran";

/// Whether a run writes a file of this name for `hdl` or `codes`.
pub fn is_of_words(name: &str) -> bool {
    [PROFILE, tuning_file::NAME].into_iter().any(|of| {
        let (stem, end) = of.split_once('.').expect("a name with an ending");
        name == of || (name.starts_with(&format!("{stem}.")) && name.ends_with(&format!(".{end}")))
    })
}

/// Whether a file was written by an earlier run for `hdl` or `codes`: by its name and its first line.
pub fn is_left(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let text = || std::fs::read_to_string(path).unwrap_or_default();
    is_of_words(&name) && [MARK, tuning_file::MARK].iter().any(|mark| text().starts_with(mark))
}

/// A file of a run: its name and its text.
pub type NamedText = (String, String);

/// Profile and tuning of the cases that were run: one file for all of them where they are the same, else one per case, with its
/// name.
///
/// # Errors
/// A profile or a tuning that is no TOML.
pub fn of_cases(cases: &[Case]) -> Result<Vec<NamedText>> {
    let profile = |case: &Case| -> Result<Option<String>> {
        let of = format!("{MARK}: {}.\n", of(case));
        Ok(Some(of + &toml::to_string(&*case.profile)?))
    };
    let tuning = |case: &Case| {
        case.ran_with().map(|tuning| TuningFile::of(tuning).text(&of(case))).transpose()
    };
    Ok([each(cases, PROFILE, profile)?, each(cases, tuning_file::NAME, tuning)?].concat())
}

/// Scene and case in words.
fn of(case: &Case) -> String {
    format!("scene {}, case {}", case.scene.name, case.name()).replace(char::is_control, " ")
}

fn each(
    cases: &[Case],
    name: &str,
    text: impl Fn(&Case) -> Result<Option<String>>,
) -> Result<Vec<NamedText>> {
    let texts = cases.iter().map(text).collect::<Result<Vec<_>>>()?;
    // The first line is a comment that names the case.
    let body = |text: &Option<String>| {
        text.as_ref().map(|text| text.split_once('\n').map_or("", |(_, body)| body).to_owned())
    };
    if texts.windows(2).all(|pair| body(&pair[0]) == body(&pair[1])) {
        let one = texts.into_iter().next().flatten();
        return Ok(one.into_iter().map(|text| (name.to_owned(), text)).collect());
    }
    let named = cases.iter().zip(texts).filter_map(|(case, text)| {
        let text = text?;
        Some((of_case(name, case.name()), text))
    });
    Ok(named.collect())
}

/// The name of a file for a case: letters, digits and points of the case's name, all else as one dash.
fn of_case(name: &str, case: &str) -> String {
    let (stem, end) = name.split_once('.').expect("a name with an ending");
    let words: Vec<_> = case
        .split(|letter: char| !letter.is_alphanumeric() && letter != '.')
        .filter(|word| !word.is_empty())
        .collect();
    format!("{stem}.{}.{end}", words.join("-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_a_case_bears_its_name() {
        let name = of_case(PROFILE, "square 0.3 N, closed loop");
        assert_eq!(name, "profile.square-0.3-N-closed-loop.toml");
        assert!(is_of_words(&name) && is_of_words("tuning.toml") && !is_of_words("profiles.toml"));
    }
}
