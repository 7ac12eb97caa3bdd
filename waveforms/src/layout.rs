// SPDX-License-Identifier: MIT OR Apache-2.0
//! A view applied to a trace: which signal goes where, and how it is shown.

use std::collections::HashSet;

use crate::declarations::{Declarations, Encoding, Signal};
use crate::pattern::fits;
use crate::view::{Color, Entry, Group, Style, View, ViewError};

/// The height of an analog trace, where the view does not say.
const HEIGHT: u8 = 3;

/// Rows under one heading.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Section {
    pub(crate) heading: String,
    pub(crate) closed: bool,
    pub(crate) rows: Vec<Row>,
}

/// One signal as shown.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) signal: usize,
    pub(crate) style: Style,
    pub(crate) color: Option<Color>,
    /// The name to show in place of the path.
    pub(crate) alias: Option<String>,
    /// Lines of an analog trace, its own included.
    pub(crate) height: u8,
}

/// Finds the signals of every entry of `view`.
///
/// # Errors
/// An entry that no signal fits, or an alias for several.
pub(crate) fn lay_out(view: &View, declarations: &Declarations) -> Result<Vec<Section>, ViewError> {
    let paths: Vec<_> = declarations.signals().iter().map(Signal::path).collect();
    let mut layout = Layout { view, declarations, paths, shown: HashSet::new() };
    let mut sections = Vec::new();
    for group in &view.groups {
        let rows = layout.rows(group)?;
        match &group.name {
            Some(name) => {
                sections.push(Section { heading: name.clone(), closed: group.closed, rows })
            }
            None => layout.by_scope(group.closed, rows, &mut sections),
        }
    }
    sections.retain(|section| !section.rows.is_empty());
    Ok(sections)
}

struct Layout<'a> {
    view: &'a View,
    declarations: &'a Declarations,
    paths: Vec<String>,
    shown: HashSet<usize>,
}

impl Layout<'_> {
    fn rows(&mut self, group: &Group) -> Result<Vec<Row>, ViewError> {
        let mut rows = Vec::new();
        for entry in &group.signals {
            let signals = self.signals(entry, group.optional)?;
            rows.extend(signals.iter().map(|&signal| self.row(signal, entry)));
            self.shown.extend(signals);
        }
        Ok(rows)
    }

    fn signals(&self, entry: &Entry, optional: bool) -> Result<Vec<usize>, ViewError> {
        let pattern = entry.show.get_ref();
        let fitting: Vec<_> =
            (0..self.paths.len()).filter(|&signal| fits(pattern, &self.paths[signal])).collect();
        match fitting.len() {
            0 if !optional => Err(self.view.misfit(entry, "expected a signal of the trace")),
            2.. if entry.alias.is_some() => {
                Err(self.view.misfit(entry, "expected one signal for an alias"))
            }
            1 if !pattern.contains('*') => Ok(fitting),
            _ => Ok(fitting.into_iter().filter(|signal| !self.shown.contains(signal)).collect()),
        }
    }

    fn row(&self, signal: usize, entry: &Entry) -> Row {
        let declared = &self.declarations.signals()[signal];
        let usual = if matches!(declared.encoding, Encoding::Real(_)) {
            Style::Step
        } else {
            Style::Number
        };
        Row {
            signal,
            style: entry.style.unwrap_or(usual),
            color: entry.color,
            alias: entry.alias.clone(),
            height: entry.height.unwrap_or(HEIGHT),
        }
    }

    /// Appends a section for each scope, in the order of their first rows.
    fn by_scope(&self, closed: bool, rows: Vec<Row>, sections: &mut Vec<Section>) {
        let first = sections.len();
        for row in rows {
            let signal = &self.declarations.signals()[row.signal];
            let heading = signal.scope.join(".");
            match sections[first..].iter_mut().find(|section| section.heading == heading) {
                Some(section) => section.rows.push(row),
                None => sections.push(Section { heading, closed, rows: vec![row] }),
            }
        }
    }
}
