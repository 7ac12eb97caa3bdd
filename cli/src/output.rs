// SPDX-License-Identifier: MIT OR Apache-2.0
//! The folder that a run writes, atomically: all of its files appear together, or none.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use hapticore_files::AtomicFolder;
use hapticore_host::{COLUMNS, QUANTITIES};
use rayon::prelude::*;

use crate::words::{is_left, is_of_words};
use hapticore_run::record::{Driven, Record, Row, Truth};

/// What a scene adds behind the truth: the case's name, the point of its sweep, and what no frame
/// has.
const OF_SCENE: [&str; 4] = ["case", "point", "true_load_g", "true_friction_n"];

/// The last columns of a scene: one or zero.
const TRUE_FLAGS: [&str; 2] = ["true_over_edge", "true_touching"];

/// The last columns of a scene with walls.
const WALLED: [&str; 3] = ["released", "true_hand_x_n", "true_haptic_friction_n"];

/// The last columns of a scene with a controller.
const DRIVEN: [&str; 4] = ["target_n", "drive_v_rms", "drive_limited", "drive_fault"];

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
    let of_states = ["waves.core.", "waves.force_loop."];
    let texts = of_states.iter().any(|of| name.starts_with(of)) && name.ends_with(".txt");
    texts || ["waves.vcd", "waves.fst", "waves.gtkw"].contains(&name)
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
    /// Whether a controller drives the pads.
    pub driven: bool,
    /// Whether they meet walls.
    pub walled: bool,
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
        let mut frames = Frames { file: BufWriter::new(file), path, scene };
        frames.header().with_context(|| frames.path.display().to_string())?;
        Ok(frames)
    }

    fn header(&mut self) -> io::Result<()> {
        write!(self.file, "{}", COLUMNS.join(","))?;
        if let Some(scene) = &self.scene {
            QUANTITIES
                .iter()
                .try_for_each(|quantity| write!(self.file, ",true_{}", quantity.name))?;
            write!(self.file, ",{}", OF_SCENE.join(","))?;
            scene.swept.iter().try_for_each(|name| write!(self.file, ",set_{name}"))?;
            write!(self.file, ",{}", TRUE_FLAGS.join(","))?;
            if scene.driven {
                write!(self.file, ",{}", DRIVEN.join(","))?;
            }
            if scene.walled {
                write!(self.file, ",{}", WALLED.join(","))?;
            }
        }
        writeln!(self.file)
    }

    /// Writes a row.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn row(&mut self, row: &Row) -> Result<()> {
        write_row(&mut self.file, row, self.scene.as_ref())
            .with_context(|| self.path.display().to_string())
    }

    /// Writes rows, whose text all threads make.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn rows(&mut self, rows: &[Row]) -> Result<()> {
        let scene = self.scene.as_ref();
        let text = |rows: &[Row]| {
            let mut text = Vec::new();
            rows.iter().try_for_each(|row| write_row(&mut text, row, scene)).map(|()| text)
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

impl OfScene {
    fn write(&self, file: &mut impl Write, case: usize, truth: &Truth) -> io::Result<()> {
        truth.quantities.values().iter().try_for_each(|number| write!(file, ",{number}"))?;
        let case = self.cases.get(case).map_or("", String::as_str);
        write!(file, ",{},{},{},{}", field(case), truth.point, truth.load_g, truth.friction_n)?;
        self.swept.iter().try_for_each(|name| write!(file, ",{}", truth.set.get(name)))?;
        write!(file, ",{},{}", u8::from(truth.over_edge), u8::from(truth.touching))
    }
}

fn write_row(file: &mut impl Write, row: &Row, scene: Option<&OfScene>) -> io::Result<()> {
    write!(file, "{},{}", row.time_s, row.pad)?;
    row.measured.values().iter().try_for_each(|number| write!(file, ",{number}"))?;
    write!(file, ",{}", row.flags)?;
    if let (Some(scene), Some(truth)) = (scene, &row.truth) {
        scene.write(file, row.case, truth)?;
        if scene.driven {
            write_driven(file, &row.driven.unwrap_or_default())?;
        }
        if scene.walled {
            let free = row.driven.and_then(|driven| driven.free).unwrap_or_default();
            let Truth { hand_x_n, haptic_friction_n, .. } = truth;
            write!(file, ",{},{hand_x_n},{haptic_friction_n}", u8::from(free))?;
        }
    }
    writeln!(file)
}

fn write_driven(file: &mut impl Write, driven: &Driven) -> io::Result<()> {
    let Driven { target_n, drive_v_rms, limited, fault, .. } = driven;
    write!(file, ",{target_n},{drive_v_rms},{},{}", u8::from(*limited), u8::from(*fault))
}

/// A text as a field of CSV.
fn field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into(),
    }
}

/// The text of `summary.json`.
pub fn summary(record: &Record) -> String {
    serde_json::to_string_pretty(record).expect("a record is plain data") + "\n"
}
