// SPDX-License-Identifier: MIT OR Apache-2.0
//! All mutants of a file in one text, each enabled by its number.
//!
//! An expression with mutants becomes a `match` on the number of the enabled one. Its first arm is the
//! expression as it was, with the mutants within it; every other arm is one mutant, and as no two are
//! enabled at once, its operands stand there as they were. So a mutant is to the compiler what
//! cargo-mutants would make of it, and the text grows with the depth of expressions, no faster.
//!
//! ```text
//! a + f(b)        (match ::hapticore_hdl::woven(7, 8) { 0 => a + f(b), /*<7*/ 7 => a - f(b) , /*>7*/ /*<8*/ _ => a * f(b) /*>8*/ })
//! fn f() { … }    fn f() { match ::hapticore_hdl::woven(3, 3) { 0 => {} /*<3*/ _ => return 1 /*>3*/ } … }
//! A => b          A if ::hapticore_hdl::woven(5, 5) == 0 => b
//! ```
//!
//! Comments mark what belongs to which mutants, for errors of the compiler ([`crate::errors`]).

mod places;

use crate::edits::{Edit, apply};
use crate::mutant::{Genre, Mutant};
use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::Visit;

/// A mutant by its index in the list.
pub type Index = usize;

/// The numbers under which mutants are enabled: the mutant of number n is at n − 1.
#[derive(Default)]
pub struct Numbers(pub Vec<Index>);

impl Numbers {
    /// Numbers for the mutants of one place, which follow each other: the first and the last.
    fn give(&mut self, mutants: &[Index]) -> (usize, usize) {
        let first = self.0.len() + 1;
        self.0.extend(mutants);
        (first, self.0.len())
    }

    /// The mutant of a number.
    pub fn mutant(&self, number: usize) -> Index {
        self.0[number - 1]
    }
}

/// Why a mutant cannot be woven.
pub type Reason = &'static str;

/// The text of a file with mutants of it, and those that could not be woven. A `const fn` becomes an
/// ordinary one, so that it can ask which mutant is enabled, unless `constant` has its name.
pub fn weave(
    source: &str,
    mutants: &[(Index, &Mutant)],
    constant: &BTreeSet<String>,
    numbers: &mut Numbers,
) -> Result<(String, Vec<(Index, Reason)>)> {
    let file = syn::parse_file(source).context("a file that is Rust")?;
    let mut at = BTreeMap::<_, Vec<_>>::new();
    for &(index, mutant) in mutants {
        let key = (mutant.genre, mutant.span.start.byte(source));
        at.entry(key).or_default().push((index, mutant.replacement.clone()));
    }
    let (edits, unwoven) = (Vec::new(), Vec::new());
    let mut weaver = Weaver { at, numbers, constant, edits, unwoven, barrier: None };
    weaver.visit_file(&file);
    let left =
        weaver.at.into_values().flatten().map(|(index, _)| (index, "its place is not found"));
    weaver.unwoven.extend(left);
    Ok((apply(source, &weaver.edits), weaver.unwoven))
}

/// Mutants of one place, with what they put there.
type Found = Vec<(Index, String)>;

struct Weaver<'a> {
    /// What is still to be woven, by the byte where the replaced text begins.
    at: BTreeMap<(Genre, usize), Found>,
    numbers: &'a mut Numbers,
    /// Functions that constants call.
    constant: &'a BTreeSet<String>,
    edits: Vec<Edit>,
    unwoven: Vec<(Index, Reason)>,
    /// Why nothing can be woven here.
    barrier: Option<Reason>,
}

impl Weaver<'_> {
    /// The mutants of a place, unless it cannot have any woven in.
    fn take(&mut self, genre: Genre, byte: usize) -> Option<Found> {
        let found = self.at.remove(&(genre, byte))?;
        match self.barrier {
            Some(reason) => {
                self.unwoven.extend(found.into_iter().map(|(index, _)| (index, reason)));
                None
            }
            None => Some(found),
        }
    }

    /// Goes on within a place where nothing can be woven.
    fn behind(&mut self, barrier: Option<Reason>, go_on: impl FnOnce(&mut Self)) {
        let before = self.barrier;
        self.barrier = before.or(barrier);
        go_on(self);
        self.barrier = before;
    }

    /// Numbers for mutants, and the text before and behind what stays: a `match` with an arm for
    /// each.
    fn arms(&mut self, mutants: &[(Index, String)]) -> (String, String) {
        let indices: Vec<_> = mutants.iter().map(|(index, _)| *index).collect();
        let (first, last) = self.numbers.give(&indices);
        let arm = |(number, (_, code)): (usize, &(Index, String))| {
            let pattern = if number == last { "_".to_string() } else { number.to_string() };
            format!(" /*<{number}*/ {pattern} => {code} /*>{number}*/,")
        };
        let arms: String = (first..).zip(mutants).map(arm).collect();
        let before = format!("/*{{{first},{last}*/match {} {{ 0 => ", call(first, last));
        (before, format!(",{arms} }}/*}}{first}*/"))
    }
}

/// The number of the enabled mutant where it is one of these, else 0.
fn call(first: usize, last: usize) -> String {
    format!("::hapticore_hdl::woven({first}, {last})")
}

#[cfg(test)]
mod tests;
