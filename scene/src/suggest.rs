// SPDX-License-Identifier: MIT OR Apache-2.0
//! What was meant by a word that is not known.

/// The known word that is most like the given one, as the end of a message; empty where none is near.
///
/// ```
/// use hapticore_scene::did_you_mean;
///
/// assert_eq!(did_you_mean("quantization_bits", ["seed", "quantisation_bits"]), "; did you mean \"quantisation_bits\"?");
/// assert_eq!(did_you_mean("center_mm", ["size_mm", "centre_mm"]), "; did you mean \"centre_mm\"?");
/// assert_eq!(did_you_mean("cricket", ["hockey"]), "");
/// ```
pub fn did_you_mean<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let given: String = given.to_lowercase().chars().take(LONGEST).collect();
    let off = |word: &&str| strsim::damerau_levenshtein(&given, word);
    let nearest = known.into_iter().min_by_key(off).filter(|word| off(word) <= word.len() / 3);
    nearest.map_or_else(String::new, |word| format!("; did you mean \"{word}\"?"))
}

/// Longer than any word that is known, characters: distances take the square of it.
const LONGEST: usize = 80;
