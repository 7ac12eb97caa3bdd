// SPDX-License-Identifier: MIT OR Apache-2.0
//! `bode.csv`: force loops as they were measured.

use std::fmt::Write as _;

use hapticore_run::record::Bode;

/// The measured loops, a row for each frequency.
pub fn csv(loops: &[Bode]) -> String {
    let mut text = String::from(
        "case,frequency_hz,gain_db,phase_deg,predicted_gain_db,predicted_phase_deg,target_to_force_db\n",
    );
    for (of, point) in loops.iter().flat_map(|of| of.points.iter().map(move |point| (of, point))) {
        let [[gain, phase], [predicted_gain, predicted_phase]] = [point.open, point.predicted];
        let case = of.case.replace('"', "\"\"");
        let (hz, closed) = (point.hz, point.closed_db);
        let _ = writeln!(
            text,
            "\"{case}\",{hz},{gain},{phase},{predicted_gain},{predicted_phase},{closed}"
        );
    }
    text
}
