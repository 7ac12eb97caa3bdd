// SPDX-License-Identifier: MIT OR Apache-2.0
//! A file that grows beside the one it will be.

use crate::partial;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file in the making. Dropped before [`AtomicFile::persist`], it leaves nothing behind.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("samples.csv");
/// use std::io::Write;
///
/// let partial = hapticore_files::AtomicFile::create(&path)?;
/// let mut file = std::io::BufWriter::new(partial.reopen()?);
/// writeln!(file, "i1,i2")?;
/// file.flush()?;
/// assert!(!path.exists());
/// partial.persist()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "i1,i2\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct AtomicFile {
    temporary: NamedTempFile,
    path: PathBuf,
}

impl AtomicFile {
    /// A file that will be called `path`; clears what killed writers left in its folder.
    ///
    /// # Errors
    /// The folder cannot be written to, or there is a folder of this name.
    pub fn create(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::Error::other(
                "expected a file to write, there is a folder of this name",
            ));
        }
        let folder =
            path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        partial::clear(folder);
        let temporary = tempfile::Builder::new().prefix(partial::PREFIX).tempfile_in(folder)?;
        partial::lock_file(temporary.as_file());
        Ok(AtomicFile { temporary, path: path.to_owned() })
    }

    /// What to write into.
    ///
    /// # Errors
    /// The file is gone.
    pub fn reopen(&self) -> io::Result<File> {
        self.temporary.reopen()
    }

    /// Where it grows, for those who open files by name.
    pub fn partial_path(&self) -> &Path {
        self.temporary.path()
    }

    /// The name that it will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the finished file its name, in place of any older one, readable as any other.
    ///
    /// # Errors
    /// It cannot be renamed.
    pub fn persist(self) -> io::Result<()> {
        self.make_readable()?;
        self.temporary.persist(&self.path).map(drop).map_err(|error| error.error)
    }

    /// Gives the finished file its name unless a file of that name exists; returns whether it did.
    /// Of several concurrent writers one succeeds.
    ///
    /// # Errors
    /// It cannot be renamed for another reason.
    pub fn persist_new(self) -> io::Result<bool> {
        self.make_readable()?;
        match self.temporary.persist_noclobber(&self.path) {
            Ok(_) => Ok(true),
            Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
            Err(error) => Err(error.error),
        }
    }

    fn make_readable(&self) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            self.temporary.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
        }
        Ok(())
    }
}

/// Writes a whole file.
///
/// # Errors
/// It cannot be written; then an older one stays as it was.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    write_bytes(path, text.as_bytes())
}

/// Writes a whole file of any bytes.
///
/// # Errors
/// As [`write()`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let partial = AtomicFile::create(path)?;
    partial.reopen()?.write_all(bytes)?;
    partial.persist()
}

/// Writes a whole file unless there is one of that name; whether it was written.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("reference.json");
/// assert!(hapticore_files::write_new(&path, "first")?);
/// assert!(!hapticore_files::write_new(&path, "second")?);
/// assert_eq!(std::fs::read_to_string(&path)?, "first");
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// It cannot be written.
pub fn write_new(path: &Path, text: &str) -> io::Result<bool> {
    let partial = AtomicFile::create(path)?;
    partial.reopen()?.write_all(text.as_bytes())?;
    partial.persist_new()
}
