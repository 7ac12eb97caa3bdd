// SPDX-License-Identifier: MIT OR Apache-2.0
//! What is computed from the sheet, kept up with it: the one way by which effects get at the sheet.
//!
//! The sheet is the scene's until an effect changes its film ([`FilmChange`] in the pad's state).
//! Split, R_p, shunt and coupling each look up something that takes milliseconds to build. For the
//! scene's own sheet it is built once and shared by all plants of the case, for a changed one when
//! the change is first met. An effect that asks for it by the pad's film follows the sheet,
//! whatever changed it; without such an effect this costs a comparison.

use std::sync::{Arc, OnceLock};

use super::geometry::Sheet;
use crate::effects::pad::FilmChange;

/// How something is built from a sheet.
type Build<T> = dyn Fn(&Sheet) -> T + Send + Sync;

/// What is computed from the sheet of a case.
pub(in super::super) struct OfSheet<T> {
    sheet: Sheet,
    build: Box<Build<T>>,
    /// For the sheet as the scene describes it.
    own: OnceLock<Arc<T>>,
}

impl<T> OfSheet<T> {
    /// Built by `build` when it is first needed.
    pub fn new(sheet: Sheet, build: impl Fn(&Sheet) -> T + Send + Sync + 'static) -> Arc<Self> {
        Arc::new(OfSheet { sheet, build: Box::new(build), own: OnceLock::new() })
    }

    fn own(&self) -> Arc<T> {
        self.own.get_or_init(|| Arc::new((self.build)(&self.sheet))).clone()
    }
}

/// The same in a plant, as the sheet is there.
pub(in super::super) struct Following<T> {
    of: Arc<OfSheet<T>>,
    own: Arc<T>,
    /// For the change that was met last.
    changed: Option<(FilmChange, T)>,
}

impl<T> Following<T> {
    /// For the scene's own sheet, until a film is met that has changed.
    pub fn new(of: &Arc<OfSheet<T>>) -> Self {
        Following { of: of.clone(), own: of.own(), changed: None }
    }

    /// For a film that has changed so.
    pub fn at(&mut self, film: FilmChange) -> &T {
        if film == FilmChange::NONE {
            return &self.own;
        }
        let kept = self.changed.take().filter(|(of, _)| *of == film);
        let now = kept.unwrap_or_else(|| (film, (self.of.build)(&self.of.sheet.changed(film))));
        &self.changed.insert(now).1
    }
}
