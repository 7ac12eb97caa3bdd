// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every law on the same targets.

use super::laws::Gains;
use super::trial::{Kind, Target, Trial, rms_n, settled_s};

/// Rail at which targets can be reached, and at which 0.6 N cannot, V rms.
const RAILS_V: [f64; 2] = [500.0, 300.0];

/// All laws; the gains of other projects' are those that follow 0.2 and 0.7 N best.
pub const KINDS: [Kind; 7] = [
    Kind::Ours("open", [0.0, 0.0]),
    Kind::Ours("proportional", [1000.0, 0.35]),
    Kind::Ours("integral", [64.0, 740_000.0]),
    Kind::Ours("inverse", [0.0, 0.0]),
    Kind::Idsp(Gains { proportional: 32.0, integral: 512.0 }),
    Kind::PyRpl(Gains { proportional: 8.0, integral: 512.0 }),
    Kind::Linien(Gains { proportional: 32.0, integral: 512.0 }),
];

/// What a law reaches.
#[derive(Clone, Debug)]
pub struct Row {
    /// The law.
    pub kind: Kind,
    /// Root mean square of true force − target, N: squares of 0.3 and 0.6 N, sines of 0.3 and 0.6 N.
    pub rms_n: [f64; 4],
    /// After 0.2 s at a rail that 0.6 N is beyond: until within 20 mN of 0.1 N for good, s.
    pub recovery_s: Option<f64>,
}

impl Row {
    /// The table's head.
    pub const HEAD: &str = "| law | square 0.3 N, mN | square 0.6 N, mN | sine 0.3 N, mN | sine 0.6 N, mN | back from the rail, ms |\n\
                            | --- | --- | --- | --- | --- | --- |";

    /// A law's.
    pub fn of(kind: Kind) -> Row {
        let of = |target| rms_n(&Trial::new(kind, target, RAILS_V[0]).run());
        let rail = Trial::new(kind, Target::Step(0.6, 0.1), RAILS_V[1]).run();
        Row {
            kind,
            rms_n: [Target::Square(0.3), Target::Square(0.6), Target::Sine(0.3), Target::Sine(0.6)]
                .map(of),
            recovery_s: settled_s(&rail, 0.25, 0.02),
        }
    }

    /// A row in Markdown.
    pub fn text(&self) -> String {
        let name = match self.kind {
            Kind::Ours(law, _) => law.to_string(),
            Kind::Idsp(_) => "idsp, PI".into(),
            Kind::PyRpl(_) => "PyRPL, PI".into(),
            Kind::Linien(_) => "Linien, PI".into(),
        };
        let numbers: Vec<String> = self.rms_n.map(|n| format!("{:.0}", 1e3 * n)).into();
        let recovery =
            self.recovery_s.map_or("never".into(), |seconds| format!("{:.0}", 1e3 * seconds));
        format!("| {name} | {} | {recovery} |", numbers.join(" | "))
    }
}
