// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder that a run writes, atomically: all of its files appear together, or none.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use hapticore_files::AtomicFolder;
use rayon::prelude::*;

use crate::words::{is_left, is_of_words};
use hapticore_run::columns::{Columns, OfScene};
use hapticore_run::record::{Record, Row};

/// Rows whose text a thread makes at a time.
const AT_A_TIME: usize = 256;

/// The file by which a folder is known for one of a run.
const SUMMARY: &str = "summary.json";

/// A folder in the making. Dropped before [`Output::keep`], it leaves nothing behind.
pub struct Output {
    folder: AtomicFolder,
}

impl Output {
    /// Makes the folder where it is not there.
    ///
    /// # Errors
    /// It cannot be made or written to.
    pub fn new(folder: &Path) -> Result<Self> {
        let folder =
            AtomicFolder::create(folder).with_context(|| format!("--out {}", folder.display()))?;
        Ok(Output { folder })
    }

    /// The temporary folder in which files are written.
    pub fn partial_path(&self) -> &Path {
        self.folder.partial_path()
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<()> {
        fs::write(self.partial_path().join(name), content)
            .with_context(|| self.folder.path().join(name).display().to_string())
    }

    /// Writes a file that can be run.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_script(&self, name: &str, text: &str) -> Result<()> {
        self.write(name, text)?;
        #[cfg(unix)]
        fs::set_permissions(
            self.partial_path().join(name),
            std::os::unix::fs::PermissionsExt::from_mode(0o755),
        )?;
        Ok(())
    }

    /// Names of the files that are written, with those that every run writes.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn names(&self) -> Result<Vec<String>> {
        let mut names = vec!["frames.csv".to_string(), SUMMARY.into()];
        for entry in fs::read_dir(self.partial_path())? {
            names.push(entry?.file_name().to_string_lossy().into_owned());
        }
        names.retain(|name| !name.starts_with('.'));
        names.sort();
        names.dedup();
        Ok(names)
    }

    /// Gives all files their names, in place of older ones; their paths. Waveforms, profiles and tunings of an earlier run in
    /// the folder go: they are not of the run that is kept.
    ///
    /// # Errors
    /// A file cannot be renamed or removed.
    pub fn keep(self) -> Result<Vec<PathBuf>> {
        let is_of_runs = self.folder.path().join(SUMMARY).exists();
        self.keep_and_clear(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            is_of_runs && (is_of_waves(&name) || is_left(path))
        })
    }

    /// Gives all files their names; files of the folder that an earlier run has left, and this one does not write, go.
    ///
    /// # Errors
    /// A file cannot be renamed or removed.
    pub fn keep_and_clear(self, is_left: impl Fn(&Path) -> bool) -> Result<Vec<PathBuf>> {
        for entry in fs::read_dir(self.folder.path())?.flatten() {
            let (path, own) = (entry.path(), self.partial_path().join(entry.file_name()));
            if path.is_file() && !own.exists() && is_left(&path) {
                fs::remove_file(&path).with_context(|| path.display().to_string())?;
            }
        }
        Ok(self.folder.persist()?)
    }
}

/// Whether a run writes a file of this name.
pub fn is_of_a_run(name: &str) -> bool {
    let files = ["frames.csv", SUMMARY, "report.html", "bode.csv"];
    files.contains(&name) || is_of_waves(name) || is_of_words(name)
}

fn is_of_waves(name: &str) -> bool {
    // Names of states, with those of version 0.1.0.
    let of_states = ["waves.bench.", "waves.core.", "waves.force_loop."];
    let texts = of_states.iter().any(|of| name.starts_with(of)) && name.ends_with(".txt");
    texts || ["waves.vcd", "waves.fst", "waves.gtkw", "waves.results.gtkw"].contains(&name)
}

/// `frames.csv`, row by row.
pub struct Frames {
    file: BufWriter<File>,
    path: PathBuf,
    columns: Columns,
}

impl Frames {
    /// Creates the file, with columns for the truth and the settings where a scene is run.
    ///
    /// # Errors
    /// It cannot be written, as below.
    pub fn create(output: &Output, scene: Option<OfScene>) -> Result<Self> {
        let path = output.folder.path().join("frames.csv");
        let file = File::create(output.partial_path().join("frames.csv"))
            .with_context(|| path.display().to_string())?;
        let columns = Columns::new(scene);
        let mut frames = Frames { file: BufWriter::new(file), path, columns };
        frames
            .columns
            .write_head(&mut frames.file)
            .with_context(|| frames.path.display().to_string())?;
        Ok(frames)
    }

    /// Writes a row.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn row(&mut self, row: &Row) -> Result<()> {
        self.columns.write_row(row, &mut self.file).with_context(|| self.path.display().to_string())
    }

    /// Writes rows, whose text all threads make.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn rows(&mut self, rows: &[Row]) -> Result<()> {
        let columns = &self.columns;
        let text = |rows: &[Row]| {
            let mut text = Vec::new();
            rows.iter().try_for_each(|row| columns.write_row(row, &mut text)).map(|()| text)
        };
        for rows in rows.chunks(AT_A_TIME * rayon::current_num_threads()) {
            let texts: io::Result<Vec<_>> = rows.par_chunks(AT_A_TIME).map(text).collect();
            texts
                .and_then(|texts| texts.iter().try_for_each(|text| self.file.write_all(text)))
                .with_context(|| self.path.display().to_string())?;
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<()> {
        self.file.flush().with_context(|| self.path.display().to_string())
    }
}

/// The text of `summary.json`.
pub fn summary(record: &Record) -> String {
    serde_json::to_string_pretty(record).expect("a record is plain data") + "\n"
}

/// Names of files for JSON, which holds text only: what is none of a name is replaced.
pub fn names(files: &[PathBuf]) -> Vec<String> {
    files.iter().map(|file| file.display().to_string()).collect()
}
