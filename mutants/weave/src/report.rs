// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of what became of all mutants, and the survivors that nobody has argued about.

use crate::area::{Area, PRINTED, row};
use crate::mutant::Mutant;
use crate::verdict::{Fate, Verdict, Verdicts};
use anyhow::Result;
use std::collections::BTreeMap;
use std::fs;

const ARGUED: &str = "mutants/survivors.txt";

/// A line of the table.
#[derive(Default)]
struct Count {
    own: usize,
    others: usize,
    printed: usize,
    survive: usize,
    timeouts: usize,
    uncompiled: usize,
    unwoven: usize,
    unjudged: usize,
}

impl Count {
    fn add(&mut self, verdict: Option<&Verdict>) {
        let Some(verdict) = verdict else {
            self.unjudged += 1;
            return;
        };
        self.unwoven += usize::from(verdict.unwoven.is_some());
        *match verdict.fate {
            Fate::Killed { stage: 0, .. } => &mut self.own,
            Fate::Killed { stage: PRINTED, .. } => &mut self.printed,
            Fate::Killed { .. } => &mut self.others,
            Fate::Survived { .. } => &mut self.survive,
            Fate::TimedOut => &mut self.timeouts,
            Fate::Uncompiled => &mut self.uncompiled,
        } += 1;
    }

    fn print(&self, name: &str) {
        let Count { own, others, printed, survive, timeouts, uncompiled, unwoven, unjudged } = self;
        let killed = own + others + printed;
        let compile = killed + survive + timeouts;
        let share = 100.0 * killed as f64 / compile.max(1) as f64;
        println!(
            "| {name} | {compile} | {killed} | {share:.1} % | {others} | {printed} | {survive} | {timeouts} | {uncompiled} | {unwoven} | {unjudged} |",
        );
    }
}

/// Prints the table; whether a mutant survives that is not argued about.
pub fn report(mutants: &[Mutant], verdicts: &Verdicts) -> Result<bool> {
    println!(
        "| mutants of | compile | killed | of 100 | by others' tests | by the printed text alone | survive | timeouts | do not compile | not woven | not judged |"
    );
    println!("|{}", " --- |".repeat(11));
    for area in ["language", "printer", "blocks"] {
        let mut rows = BTreeMap::<String, Count>::new();
        let mut all = Count::default();
        for mutant in mutants.iter().filter(|mutant| name(&Area::of(&mutant.file)) == area) {
            let verdict = verdicts.known.get(&mutant.name);
            rows.entry(row(mutant)).or_default().add(verdict);
            all.add(verdict);
        }
        rows.iter().for_each(|(name, count)| count.print(name));
        if !rows.is_empty() {
            all.print(&format!("**{area}**"));
        }
    }
    for verdict in verdicts.known.values().filter(|verdict| verdict.fate == Fate::TimedOut) {
        println!("timeout: {}", verdict.name);
    }
    let new = unargued(mutants, verdicts)?;
    for (mutant, verdict) in &new {
        let unreached = verdict.fate == Fate::Survived { reached: false };
        println!(
            "not argued about: {}{}",
            mutant.name,
            if unreached { " (no test meets it)" } else { "" }
        );
    }
    Ok(!new.is_empty())
}

fn name(area: &Area) -> &str {
    match area {
        Area::Language => "language",
        Area::Printer => "printer",
        Area::Block(_) => "blocks",
    }
}

/// The survivors that are not listed, or more often than they are.
fn unargued<'a>(
    mutants: &'a [Mutant],
    verdicts: &'a Verdicts,
) -> Result<Vec<(&'a Mutant, &'a Verdict)>> {
    let mut argued = BTreeMap::<String, usize>::new();
    for line in fs::read_to_string(ARGUED)?
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
    {
        *argued.entry(line.to_string()).or_default() += 1;
    }
    let survivors =
        mutants.iter().filter_map(|mutant| Some((mutant, verdicts.known.get(&mutant.name)?)));
    let survivors = survivors.filter(|(_, verdict)| matches!(verdict.fate, Fate::Survived { .. }));
    Ok(survivors
        .filter(|(mutant, _)| match argued.get_mut(&mutant.short_name()) {
            Some(left @ 1..) => {
                *left -= 1;
                false
            }
            _ => true,
        })
        .collect())
}
