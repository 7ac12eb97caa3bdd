// SPDX-License-Identifier: MIT OR Apache-2.0
//! Hard cases stay numerically stable: every case of [`hapticore_tests::stability`] under its own
//! name, and its row of `docs/stability.md`.
//!
//! `STABILITY=write cargo test --profile checked -p hapticore-tests --test stability` makes the page
//! anew.

use std::process::ExitCode;

use hapticore_tests::stability::{Case, GROUPS, Group, document};
use libtest_mimic::{Arguments, Failed, Trial, run};

fn main() -> ExitCode {
    if std::env::var("STABILITY").as_deref() == Ok("write") {
        return match document::write() {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{error}");
                ExitCode::FAILURE
            }
        };
    }
    let cases = GROUPS.iter().flat_map(|group| group.cases.iter().map(move |case| (group, case)));
    let mut trials: Vec<_> = cases
        .map(|(group, case)| {
            Trial::test(format!("{}::{}", group.name, case.name), move || check(group, case))
        })
        .collect();
    trials.push(Trial::test("the_page_lists_every_case", || Ok(document::is_complete()?)));
    run(&Arguments::from_args(), trials).exit_code()
}

fn check(group: &Group, case: &Case) -> Result<(), Failed> {
    let row = document::row(group, case)?;
    println!("{row}");
    Ok(document::has(&row)?)
}
