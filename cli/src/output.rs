// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder that a run writes: everything is written aside and gets its name when all of it is whole.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use tempfile::TempDir;

use crate::record::{Quantities, Record, Row};

/// The columns of `frames.csv`.
pub const COLUMNS: [&str; 12] = [
    "time_s",
    "pad",
    "r_x",
    "r_y",
    "x_mm",
    "y_mm",
    "capacitance_pf",
    "sheet_ohm",
    "haptic_v_rms",
    "force_n",
    "direction",
    "flags",
];

/// How many of the columns, from `r_x` on, have a truth.
const QUANTITIES: usize = 9;

/// A folder in the making. Dropped before [`Output::keep`], it leaves nothing behind.
pub struct Output {
    folder: PathBuf,
    aside: Option<TempDir>,
    created: Vec<PathBuf>,
}

impl Output {
    /// Makes the folder where it is not there.
    ///
    /// # Errors
    /// It cannot be made or written to.
    pub fn new(folder: &Path) -> Result<Self> {
        let missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let created = folder.ancestors().take_while(missing).map(Path::to_owned).collect();
        let mut output = Output { folder: folder.to_owned(), aside: None, created };
        let within = || format!("--out {}", folder.display());
        fs::create_dir_all(folder).with_context(within)?;
        output.aside = Some(tempfile::Builder::new().prefix(".partial-").tempdir_in(folder).with_context(within)?);
        Ok(output)
    }

    /// Where files grow.
    pub fn aside(&self) -> &Path {
        self.aside.as_ref().expect("there until kept").path()
    }

    /// Writes a whole file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, name: &str, text: &str) -> Result<()> {
        fs::write(self.aside().join(name), text).with_context(|| self.folder.join(name).display().to_string())
    }

    /// Writes a file that can be run.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write_script(&self, name: &str, text: &str) -> Result<()> {
        self.write(name, text)?;
        #[cfg(unix)]
        fs::set_permissions(self.aside().join(name), std::os::unix::fs::PermissionsExt::from_mode(0o755))?;
        Ok(())
    }

    /// Gives all files their names, in place of older ones; their paths.
    ///
    /// # Errors
    /// A file cannot be renamed.
    pub fn keep(mut self) -> Result<Vec<PathBuf>> {
        let aside = self.aside.take().expect("kept once");
        let entries = fs::read_dir(aside.path())?.collect::<Result<Vec<_>, _>>()?;
        let mut names: Vec<_> = entries.into_iter().map(|entry| entry.file_name()).collect();
        names.sort();
        let mut paths = Vec::new();
        for name in names {
            let path = self.folder.join(&name);
            fs::rename(aside.path().join(&name), &path).with_context(|| path.display().to_string())?;
            paths.push(path);
        }
        self.created.clear();
        Ok(paths)
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        drop(self.aside.take());
        for folder in &self.created {
            // Somebody else may have written there meanwhile: only empty folders go.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// `frames.csv`, row by row.
pub struct Frames {
    file: BufWriter<File>,
    truth: bool,
}

impl Frames {
    /// Creates the file, with columns for the truth where there is one.
    ///
    /// # Errors
    /// It cannot be written, as below.
    pub fn create(path: &Path, truth: bool) -> Result<Self> {
        let mut file = BufWriter::new(File::create(path)?);
        write!(file, "{}", COLUMNS.join(","))?;
        if truth {
            COLUMNS[2..2 + QUANTITIES].iter().try_for_each(|name| write!(file, ",true_{name}"))?;
        }
        writeln!(file)?;
        Ok(Frames { file, truth })
    }

    /// Writes a row.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn row(&mut self, row: &Row) -> Result<()> {
        write!(self.file, "{},{}", row.time_s, row.pad)?;
        numbers(&row.measured).iter().try_for_each(|number| write!(self.file, ",{number}"))?;
        write!(self.file, ",{}", row.flags)?;
        if let Some(truth) = row.truth.filter(|_| self.truth) {
            numbers(&truth.quantities).iter().try_for_each(|number| write!(self.file, ",{number}"))?;
        }
        Ok(writeln!(self.file)?)
    }

    /// Completes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<()> {
        Ok(self.file.flush()?)
    }
}

/// The quantities in the order of the columns.
fn numbers(quantities: &Quantities) -> [f64; QUANTITIES] {
    let Quantities { r_x, r_y, x_mm, y_mm, capacitance_pf, sheet_ohm, haptic_v_rms, force_n, direction } = *quantities;
    [r_x, r_y, x_mm, y_mm, capacitance_pf, sheet_ohm, haptic_v_rms, force_n, direction]
}

/// The text of `summary.json`.
pub fn summary(record: &Record) -> String {
    serde_json::to_string_pretty(record).expect("a record is plain data") + "\n"
}
