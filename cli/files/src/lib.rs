// SPDX-License-Identifier: MIT OR Apache-2.0
//! Atomic writing: a file, or all files of a run, appear whole or not at all.
//!
//! What is not finished has a name that begins with [`PREFIX`], in the same folder, so that one
//! rename finishes it, and is locked as long as its writer lives. A writer that is stopped takes it
//! away; what a killed one leaves, the next one in the folder finds unlocked and clears.
//!
//! ```
//! # let folder = tempfile::tempdir()?;
//! let path = folder.path().join("mine.txt");
//! hapticore_files::write(&path, "whole")?;
//! assert_eq!(std::fs::read_to_string(&path)?, "whole");
//!
//! let unfinished = hapticore_files::AtomicFile::create(&path)?;
//! drop(unfinished); // without `persist`
//! assert_eq!(std::fs::read_dir(&folder)?.count(), 1, "nothing is left, and the older file stays");
//! # Ok::<(), std::io::Error>(())
//! ```

mod file;
mod folder;
mod partial;

pub use file::{AtomicFile, write, write_bytes, write_new};
pub use folder::AtomicFolder;
pub use partial::{PREFIX, clear};
