// SPDX-License-Identifier: MIT OR Apache-2.0
//! FST: GTKWave's compressed format.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType,
    FstVarDirection, FstVarType,
};
use hapticore_files::AtomicFile;

use crate::Error;
use crate::bits::digits;
use crate::declarations::{Declarations, Signal, Step};
use crate::wave::Wave;

/// How many bytes of changes are held before they are compressed and written. More compresses
/// better.
const SECTION_BYTES: usize = 32 << 20;

/// An FST file being written.
pub struct FstFile {
    body: Option<FstBodyWriter<BufWriter<File>>>,
    variables: Vec<Variable>,
    section_bytes: usize,
    /// None once it has its name.
    partial: Option<AtomicFile>,
    path: PathBuf,
}

#[derive(Clone, Copy)]
struct Variable {
    id: FstSignalId,
    width: u8,
}

impl FstFile {
    /// A file that will be called `path`.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let partial = Some(AtomicFile::create(path).map_err(Error::io(path))?);
        Ok(FstFile {
            body: None,
            variables: Vec::new(),
            section_bytes: SECTION_BYTES,
            partial,
            path: path.to_owned(),
        })
    }

    /// Writes sections of about `bytes` bytes of changes.
    pub fn with_section_bytes(self, bytes: usize) -> Self {
        FstFile { section_bytes: bytes, ..self }
    }

    fn header(&mut self, declarations: &Declarations) -> fst_writer::Result<()> {
        let mut header = fst_writer::open_fst(
            self.partial.as_ref().expect(BEGUN).partial_path(),
            &info(declarations),
        )?;
        let mut variables = vec![None; declarations.signals().len()];
        for step in declarations.walk() {
            match step {
                Step::Enter(name) => header.scope(name, "", FstScopeType::Module)?,
                Step::Declare(index) => {
                    variables[index] = Some(declare(&mut header, &declarations.signals()[index])?)
                }
                Step::Leave => header.up_scope()?,
            }
        }
        self.variables = variables.into_iter().flatten().collect();
        self.body = Some(header.finish()?);
        Ok(())
    }

    fn change(&mut self, signal: usize, value: &[u8]) -> Result<(), Error> {
        let id = self.variables[signal].id;
        body(&mut self.body).signal_change(id, value).map_err(Error::fst(&self.path))
    }
}

impl Wave for FstFile {
    fn begin(&mut self, declarations: &Declarations) -> Result<(), Error> {
        self.header(declarations).map_err(Error::fst(&self.path))
    }

    fn time(&mut self, ticks: u64) -> Result<(), Error> {
        let body = body(&mut self.body);
        // The encoder can only end a section between two times.
        let flushed = if body.size() > self.section_bytes { body.flush() } else { Ok(()) };
        flushed.and_then(|()| body.time_change(ticks)).map_err(Error::fst(&self.path))
    }

    fn bits(&mut self, signal: usize, bits: u64) -> Result<(), Error> {
        let width = usize::from(self.variables[signal].width);
        self.change(signal, &digits(bits)[64 - width..])
    }

    fn real(&mut self, signal: usize, value: f64) -> Result<(), Error> {
        self.change(signal, &value.to_le_bytes())
    }

    fn finish(&mut self) -> Result<(), Error> {
        let body = self.body.take().expect(BEGUN);
        let mut file = body.finish().map_err(Error::fst(&self.path))?;
        file.flush().map_err(Error::io(&self.path))?;
        drop(file);
        self.partial.take().map_or(Ok(()), AtomicFile::persist).map_err(Error::io(&self.path))
    }
}

const BEGUN: &str = "`begin` comes first, `finish` last and once";

fn body(body: &mut Option<FstBodyWriter<BufWriter<File>>>) -> &mut FstBodyWriter<BufWriter<File>> {
    body.as_mut().expect(BEGUN)
}

fn info(declarations: &Declarations) -> FstInfo {
    FstInfo {
        start_time: 0,
        timescale_exponent: declarations.timebase().exponent(),
        version: "hapticore".into(),
        // No date: the same run gives the same bytes.
        date: String::new(),
        file_type: FstFileType::Verilog,
    }
}

fn declare(
    header: &mut FstHeaderWriter<BufWriter<File>>,
    signal: &Signal,
) -> fst_writer::Result<Variable> {
    let width = signal.encoding.width();
    let (encoding, kind) = match width {
        Some(width) => (FstSignalType::bit_vec(width.into()), FstVarType::Wire),
        None => (FstSignalType::real(), FstVarType::Real),
    };
    let id = header.var(&signal.name, encoding, kind, FstVarDirection::Implicit, None)?;
    Ok(Variable { id, width: width.unwrap_or(0) })
}
