// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong while waves are declared or written.

use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Why a waveform or save file could not be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The file system refused.
    #[error("{}: {source}", path.display())]
    Io {
        /// Path of the file.
        path: PathBuf,
        /// The file system's error.
        source: io::Error,
    },
    /// The FST encoder refused.
    #[error("{}: {source}", path.display())]
    Fst {
        /// Path of the file.
        path: PathBuf,
        /// The encoder's error.
        source: fst_writer::FstWriteError,
    },
    /// A scope or variable name that waveform viewers would misread.
    #[error(
        "signal \"{path}\": expected a name of letters, digits and '_' that starts with no digit, got \"{name}\""
    )]
    Name {
        /// Full path of the signal.
        path: String,
        /// The part of it that is no name.
        name: String,
    },
    /// Two variables of one path.
    #[error("signal \"{0}\" is declared twice")]
    Duplicate(String),
    /// A width that an `i64` code cannot have.
    #[error("signal \"{path}\": expected a width of 1 to {most} bits, got {width}", most = hapticore_hdl::format::MAX_WIDTH)]
    Width {
        /// Full path of the signal.
        path: String,
        /// Declared width, bits.
        width: u8,
    },
    /// A clock outside the range that ticks of a picosecond can show.
    #[error("clock frequency: expected 1 Hz to 100 GHz, got {0} Hz")]
    ClockFrequency(u64),
    /// `finish` after an earlier error: the file would have a hole.
    #[error("waves not kept: an earlier write failed")]
    Incomplete,
    /// The run never entered the window: viewers take a file without values for a broken one.
    #[error("waves not kept: expected clocks in the window {} to {}, got {clocks} clocks", window.start, window.end)]
    Empty {
        /// The clocks that were to be traced.
        window: Range<u64>,
        /// The clocks that the run had.
        clocks: u64,
    },
    /// A view that cannot be read, or that does not fit the trace.
    #[error(transparent)]
    View(#[from] crate::view::ViewError),
}

impl Error {
    /// Names the file in an error of the file system.
    pub(crate) fn io(path: &Path) -> impl Fn(io::Error) -> Error + '_ {
        move |source| Error::Io { path: path.to_owned(), source }
    }

    /// Names the file in an error of the FST encoder.
    pub(crate) fn fst(path: &Path) -> impl Fn(fst_writer::FstWriteError) -> Error + '_ {
        move |source| Error::Fst { path: path.to_owned(), source }
    }
}
