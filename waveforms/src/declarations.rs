// SPDX-License-Identifier: MIT OR Apache-2.0
//! The signals of a trace: their paths, how they read as numbers, and the scopes that hold them.

use std::collections::HashSet;

use hapticore_hdl::format::{BIT, Format, MAX_WIDTH};
use hapticore_hdl::probe::{Signals, Variable};

use crate::Error;
use crate::timebase::Timebase;

/// The scope of variables that a probe declares without one.
const TOP: &str = "top";

/// The scope of the physical truth.
const TRUTH: &str = "truth";

/// A physical quantity that the caller knows: shown beside the core's estimate of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TruthVariable {
    /// Its name within the scope `truth`.
    pub name: String,
    /// The unit that its values are in, for the viewer; may be empty.
    pub unit: String,
}

impl TruthVariable {
    /// A quantity `name` in `unit`.
    pub fn new(name: &str, unit: &str) -> Self {
        TruthVariable { name: name.into(), unit: unit.into() }
    }
}

/// How a signal's values are encoded.
#[derive(Debug, Clone, PartialEq)]
pub enum Encoding {
    /// Codes of a format.
    Code(Format),
    /// Codes that name states: `states[code]`.
    State(Format, &'static [&'static str]),
    /// Physical numbers in a unit.
    Real(String),
}

impl Encoding {
    /// Bits of a code; `None` for a real.
    pub fn width(&self) -> Option<u8> {
        match self {
            Encoding::Code(format) | Encoding::State(format, _) => Some(format.width),
            Encoding::Real(_) => None,
        }
    }
}

/// One signal of a trace.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal {
    /// The scopes from the top down.
    pub scope: Vec<String>,
    /// Its name within the innermost scope.
    pub name: String,
    /// How its values are encoded.
    pub encoding: Encoding,
}

impl Signal {
    /// The signal of one variable of a probe.
    pub fn of(variable: Variable) -> Self {
        let Variable { mut scope, name, format, states } = variable;
        if scope.is_empty() {
            scope.push(TOP.into());
        }
        let encoding = if states.is_empty() {
            Encoding::Code(format)
        } else {
            Encoding::State(format, states)
        };
        Signal { scope, name, encoding }
    }

    fn of_truth(truth: &TruthVariable) -> Self {
        Signal {
            scope: vec![TRUTH.into()],
            name: truth.name.clone(),
            encoding: Encoding::Real(truth.unit.clone()),
        }
    }

    /// The path, its parts joined by dots.
    pub fn path(&self) -> String {
        format!("{}.{}", self.scope.join("."), self.name)
    }
}

/// One step of a walk over the hierarchy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Enter the scope of this name.
    Enter(String),
    /// Declare the signal of this index.
    Declare(usize),
    /// Leave the innermost scope.
    Leave,
}

/// Everything that a waveform file says before its first value.
#[derive(Debug, Clone, PartialEq)]
pub struct Declarations {
    timebase: Timebase,
    signals: Vec<Signal>,
}

impl Declarations {
    /// The declarations of a probe's registers and ports, then of the truth, then of the clock if
    /// asked for: that of the probe, or a wire `clock` in the first scope.
    ///
    /// # Errors
    /// A name, a width or a repeated path that a viewer would misread.
    pub fn new(
        of_probe: Signals,
        truth: &[TruthVariable],
        clock_wire: bool,
        timebase: Timebase,
    ) -> Result<Self, Error> {
        let Signals { registers, ports, clock } = of_probe;
        let shown = registers.into_iter().chain(ports).flatten();
        let mut signals: Vec<_> = shown.map(Signal::of).collect();
        let top = signals.first().map_or(TOP, |first| &first.scope[0]).to_string();
        signals.extend(truth.iter().map(Signal::of_truth));
        if clock_wire {
            let (scope, name) = clock.unwrap_or((vec![top], "clock"));
            signals.push(Signal { scope, name: name.into(), encoding: Encoding::Code(BIT) });
        }
        check(&signals)?;
        Ok(Declarations { timebase, signals })
    }

    /// The tick of the trace's time axis.
    pub fn timebase(&self) -> Timebase {
        self.timebase
    }

    /// The signals, in the order of their indices.
    pub fn signals(&self) -> &[Signal] {
        &self.signals
    }

    /// A walk over the hierarchy that enters every scope once: own signals first, then the scopes
    /// within.
    pub fn walk(&self) -> Vec<Step> {
        let mut steps = Vec::new();
        self.descend(0, (0..self.signals.len()).collect(), &mut steps);
        steps
    }

    fn descend(&self, depth: usize, within: Vec<usize>, steps: &mut Vec<Step>) {
        let (own, mut deeper): (Vec<_>, Vec<_>) =
            within.into_iter().partition(|&i| self.signals[i].scope.len() == depth);
        steps.extend(own.into_iter().map(Step::Declare));
        while let Some(&first) = deeper.first() {
            let name = &self.signals[first].scope[depth];
            let (inside, rest) =
                deeper.into_iter().partition(|&i| &self.signals[i].scope[depth] == name);
            steps.push(Step::Enter(name.clone()));
            self.descend(depth + 1, inside, steps);
            steps.push(Step::Leave);
            deeper = rest;
        }
    }
}

fn check(signals: &[Signal]) -> Result<(), Error> {
    let mut seen = HashSet::new();
    for signal in signals {
        let path = signal.path();
        if let Some(name) = signal.scope.iter().chain([&signal.name]).find(|name| !is_name(name)) {
            return Err(Error::Name { path, name: name.clone() });
        }
        if let Some(width) =
            signal.encoding.width().filter(|width| !(1..=MAX_WIDTH).contains(width))
        {
            return Err(Error::Width { path, width });
        }
        if !seen.insert(path) {
            return Err(Error::Duplicate(signal.path()));
        }
    }
    Ok(())
}

/// Whether viewers take this for one plain name: dots, brackets and spaces have meanings of their
/// own.
fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variable(path: &[&str], width: u8) -> Variable {
        let (name, scope) = path.split_last().unwrap();
        let scope = scope.iter().map(ToString::to_string).collect();
        Variable { scope, name: name.to_string(), format: Format::unsigned(width, 0), states: &[] }
    }

    fn declare(variables: &[Variable], truth: &[TruthVariable]) -> Result<Declarations, Error> {
        let registers = variables.iter().cloned().map(Some).collect();
        let of_probe = Signals { registers, ports: Vec::new(), clock: None };
        Declarations::new(of_probe, truth, true, Timebase::of_clock(1000)?)
    }

    #[test]
    fn every_scope_is_entered_once_however_the_probe_orders_them() {
        let paths = [["a", "b", "x"].as_slice(), &["a", "y"], &["c"], &["a", "b", "z"]];
        let declarations =
            declare(&paths.map(|path| variable(path, 1)), &[TruthVariable::new("force", "N")])
                .unwrap();
        let text: Vec<_> = declarations
            .walk()
            .iter()
            .map(|step| match step {
                Step::Enter(name) => format!("{name}("),
                Step::Declare(index) => format!("{} ", declarations.signals()[*index].name),
                Step::Leave => ")".into(),
            })
            .collect();
        assert_eq!(text.concat(), "a(y clock b(x z ))top(c )truth(force )");
    }

    #[test]
    fn names_and_widths_that_viewers_misread_are_errors() {
        for bad in ["", "a b", "a.b", "i[0]", "0x", "é"] {
            let error = declare(&[variable(&["core", bad], 1)], &[]).unwrap_err();
            assert!(matches!(error, Error::Name { .. }), "{bad}: {error}");
        }
        assert!(matches!(
            declare(&[variable(&["core", "x"], 64)], &[]),
            Err(Error::Width { width: 64, .. })
        ));
        assert!(
            matches!(declare(&[variable(&["core", "clock"], 1)], &[]), Err(Error::Duplicate(path)) if path == "core.clock")
        );
    }
}
