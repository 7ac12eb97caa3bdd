// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder that a run writes: everything is written aside and gets its name when all of it is whole.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use tempfile::TempDir;

use crate::partial;
use crate::record::{Quantities, Record, Row, Truth};

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

/// What a scene adds behind the truth: the case's name, the point of its sweep, and what no frame has.
const OF_SCENE: [&str; 4] = ["case", "point", "true_load_g", "true_friction_n"];

/// The last columns of a scene: one or zero.
const TRUE_FLAGS: [&str; 2] = ["true_over_edge", "true_touching"];

/// The file by which a folder is known for one of a run.
const SUMMARY: &str = "summary.json";

/// A folder in the making. Dropped before [`Output::keep`], it leaves nothing behind.
pub struct Output {
    folder: PathBuf,
    aside: Option<TempDir>,
    lock: Option<File>,
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
        let mut output = Output { folder: folder.to_owned(), aside: None, lock: None, created };
        let within = || format!("--out {}", folder.display());
        fs::create_dir_all(folder).with_context(within)?;
        partial::clear(folder);
        output.aside = Some(tempfile::Builder::new().prefix(partial::PREFIX).tempdir_in(folder).with_context(within)?);
        output.lock = Some(partial::hold(output.aside()).with_context(within)?);
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
        names.retain(|name| name != partial::LOCK);
        names.sort();
        self.clear_waves()?;
        let mut paths = Vec::new();
        for name in names {
            let path = self.folder.join(&name);
            fs::rename(aside.path().join(&name), &path).with_context(|| path.display().to_string())?;
            paths.push(path);
        }
        self.created.clear();
        Ok(paths)
    }

    /// Removes the waveforms of an earlier run in the folder: they are not of the run that is kept.
    fn clear_waves(&self) -> Result<()> {
        if !self.folder.join(SUMMARY).exists() {
            return Ok(());
        }
        for entry in fs::read_dir(&self.folder)?.flatten() {
            if is_of_waves(&entry.file_name().to_string_lossy()) {
                fs::remove_file(entry.path()).with_context(|| entry.path().display().to_string())?;
            }
        }
        Ok(())
    }
}

/// Whether a run writes a file of this name.
pub fn is_of_a_run(name: &str) -> bool {
    ["frames.csv", SUMMARY, "report.html"].contains(&name) || is_of_waves(name)
}

fn is_of_waves(name: &str) -> bool {
    let texts = name.starts_with("waves.core.") && name.ends_with(".txt");
    texts || ["waves.vcd", "waves.fst", "waves.gtkw"].contains(&name)
}

impl Drop for Output {
    fn drop(&mut self) {
        drop(self.aside.take());
        drop(self.lock.take());
        for folder in &self.created {
            // Somebody else may have written there meanwhile: only empty folders go.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// `frames.csv`, row by row.
pub struct Frames {
    file: BufWriter<File>,
    path: PathBuf,
    scene: Option<OfScene>,
}

/// What only the frames of a scene have.
#[derive(Debug, Clone, Default)]
pub struct OfScene {
    /// The names of the cases.
    pub cases: Vec<String>,
    /// The keys of the pads that are swept.
    pub swept: Vec<&'static str>,
}

impl Frames {
    /// Creates the file, with columns for the truth and the settings where a scene is run.
    ///
    /// # Errors
    /// It cannot be written, as below.
    pub fn create(output: &Output, scene: Option<OfScene>) -> Result<Self> {
        let path = output.folder.join("frames.csv");
        let file = File::create(output.aside().join("frames.csv")).with_context(|| path.display().to_string())?;
        let mut frames = Frames { file: BufWriter::new(file), path, scene };
        frames.header().with_context(|| frames.path.display().to_string())?;
        Ok(frames)
    }

    fn header(&mut self) -> io::Result<()> {
        write!(self.file, "{}", COLUMNS.join(","))?;
        if let Some(scene) = &self.scene {
            COLUMNS[2..2 + QUANTITIES].iter().try_for_each(|name| write!(self.file, ",true_{name}"))?;
            write!(self.file, ",{}", OF_SCENE.join(","))?;
            scene.swept.iter().try_for_each(|name| write!(self.file, ",set_{name}"))?;
            write!(self.file, ",{}", TRUE_FLAGS.join(","))?;
        }
        writeln!(self.file)
    }

    /// Writes a row.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn row(&mut self, row: &Row) -> Result<()> {
        self.write(row).with_context(|| self.path.display().to_string())
    }

    fn write(&mut self, row: &Row) -> io::Result<()> {
        write!(self.file, "{},{}", row.time_s, row.pad)?;
        numbers(&row.measured).iter().try_for_each(|number| write!(self.file, ",{number}"))?;
        write!(self.file, ",{}", row.flags)?;
        if let (Some(scene), Some(truth)) = (&self.scene, &row.truth) {
            scene.write(&mut self.file, row.case, truth)?;
        }
        writeln!(self.file)
    }

    /// Completes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self) -> Result<()> {
        self.file.flush().with_context(|| self.path.display().to_string())
    }
}

impl OfScene {
    fn write(&self, file: &mut impl Write, case: usize, truth: &Truth) -> io::Result<()> {
        numbers(&truth.quantities).iter().try_for_each(|number| write!(file, ",{number}"))?;
        let case = self.cases.get(case).map_or("", String::as_str);
        write!(file, ",{},{},{},{}", field(case), truth.point, truth.load_g, truth.friction_n)?;
        self.swept.iter().try_for_each(|name| write!(file, ",{}", truth.set.get(name)))?;
        write!(file, ",{},{}", u8::from(truth.over_edge), u8::from(truth.touching))
    }
}

/// A text as a field of CSV.
fn field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
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
