// SPDX-License-Identifier: MIT OR Apache-2.0
//! What became of mutants of netlists, by block and class, and the table of it in `docs/mutation.md`.

use std::collections::{BTreeMap, BTreeSet};

/// What became of a mutant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// A test failed.
    Noticed,
    /// No test failed.
    Survived,
    /// No test failed within the time.
    TimedOut,
}

/// Classes of mutants, in the order of the table.
const CLASSES: [&str; 5] =
    ["missing reset", "missing clear", "sticky flag", "held one clock", "stale operand"];

/// How many mutants: all, noticed, proved to be equivalent, missed.
type Count = [usize; 4];

/// How many mutants of each block and class there are, and how many are noticed.
#[derive(Debug, Default)]
pub struct Table {
    counts: BTreeMap<(String, String), Count>,
    /// Those that are missed.
    missed: Vec<(String, Verdict)>,
}

impl Table {
    /// Counts a mutant.
    pub fn enter(&mut self, mutant: &str, verdict: Verdict, proved: bool) {
        let (place, class) = mutant.rsplit_once(": ").expect("place: class");
        let (block, _) = place.split_once('.').expect("module.place");
        let count = self.counts.entry((block.into(), class.into())).or_default();
        let of = match verdict {
            Verdict::Noticed => 1,
            _ if proved => 2,
            _ => 3,
        };
        count[0] += 1;
        count[of] += 1;
        if of == 3 {
            self.missed.push((mutant.into(), verdict));
        }
    }

    /// Holds that every mutant is noticed, proved to be equivalent, or one of the list, a line each: those that are known to
    /// be missed. Prints the rows of the table and what is missed.
    ///
    /// # Panics
    /// Where another one is missed, or none was judged.
    pub fn check(&self, known: &str) {
        self.blocks().iter().for_each(|block| println!("{}", self.row(block)));
        for (mutant, verdict) in &self.missed {
            println!("{verdict:?}: {mutant}");
        }
        let [all, noticed, proved, missed] = sum(self.counts.values());
        println!("{noticed} of {all} noticed, {proved} proved equivalent, {missed} missed");
        assert!(noticed > 0, "no mutant was judged");
        let known: BTreeSet<&str> = known.lines().filter(|line| !line.starts_with('#')).collect();
        let missed = self.missed.iter().map(|(mutant, _)| mutant.as_str());
        let new: Vec<_> = missed.filter(|mutant| !known.contains(mutant)).collect();
        assert!(new.is_empty(), "missed: {new:#?}");
    }

    fn blocks(&self) -> BTreeSet<&str> {
        self.counts.keys().map(|(block, _)| block.as_str()).collect()
    }

    /// A block's row of the table.
    fn row(&self, block: &str) -> String {
        let of_class = |class: &str| self.counts.get(&(block.into(), class.into()));
        let mut cells = vec![block.to_string()];
        cells.extend(CLASSES.map(|class| of_class(class).map_or("–".into(), cell)));
        let whole = sum(CLASSES.iter().filter_map(|class| of_class(class)));
        cells.extend([cell(&whole), whole[3].to_string()]);
        format!("| {} |", cells.join(" | "))
    }

    /// Puts the rows of the blocks that were judged into the table below a heading of a page.
    ///
    /// # Panics
    /// Where there is no such page, heading or table.
    pub fn write(&self, page: &str, heading: &str) {
        let text = std::fs::read_to_string(page).expect("a page");
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        let begin = lines.iter().position(|line| line == heading).expect("the heading");
        let rule = lines[begin..].iter().position(|line| line.starts_with("| ---"));
        let first = begin + rule.expect("a table") + 1;
        let rows = lines[first..].iter().take_while(|line| line.starts_with('|')).count();
        for block in self.blocks() {
            let begins = format!("| {block} |");
            let mut place = first..first + rows;
            match place.find(|&line| lines[line].starts_with(&begins)) {
                Some(line) => lines[line] = self.row(block),
                None => lines.insert(first + rows, self.row(block)),
            }
        }
        std::fs::write(page, lines.join("\n") + "\n").expect("the page is written");
    }
}

fn sum<'a>(counts: impl Iterator<Item = &'a Count>) -> Count {
    counts.fold([0; 4], |sum, count| std::array::from_fn(|of| sum[of] + count[of]))
}

/// Noticed of all; in brackets those proved to be equivalent.
fn cell([all, noticed, proved, _]: &Count) -> String {
    let proved = if *proved > 0 { format!(" ({proved})") } else { String::new() };
    format!("{noticed} of {all}{proved}")
}
