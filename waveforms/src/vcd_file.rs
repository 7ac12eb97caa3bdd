// SPDX-License-Identifier: MIT OR Apache-2.0
//! VCD: a value change dump (IEEE 1364-2005, clause 18).

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use hapticore_files::AtomicFile;
use vcd::{IdCode, TimescaleUnit, VarType, Writer};

use crate::Error;
use crate::bits::digits;
use crate::declarations::{Declarations, Signal, Step};
use crate::wave::{BUFFER_BYTES, Wave};

/// The longest change line: `b`, 63 digits, a space, an id, a newline.
const LINE_BYTES: usize = 80;

/// A VCD file being written.
///
/// Changes are put together here, a line at a time: the `vcd` crate writes a vector digit by digit
/// through the formatter, which takes eight times as long.
pub struct VcdFile {
    writer: Writer<BufWriter<File>>,
    variables: Vec<Variable>,
    /// None once it has its name.
    partial: Option<AtomicFile>,
    path: PathBuf,
}

struct Variable {
    id: IdCode,
    /// What ends a line of this variable: for vectors a space, then the id and a newline.
    tail: Box<[u8]>,
    scalar: bool,
}

impl VcdFile {
    /// Starts a file that will be called `path`.
    ///
    /// # Errors
    /// The folder cannot be written to.
    pub fn create(path: &Path) -> Result<Self, Error> {
        let partial = AtomicFile::create(path).map_err(Error::io(path))?;
        let file = partial.reopen().map_err(Error::io(path))?;
        let writer = Writer::new(BufWriter::with_capacity(BUFFER_BYTES, file));
        Ok(VcdFile { writer, variables: Vec::new(), partial: Some(partial), path: path.to_owned() })
    }

    fn header(&mut self, declarations: &Declarations) -> std::io::Result<()> {
        self.writer.version("hapticore")?;
        self.writer.timescale(1, unit(declarations.timebase().exponent()))?;
        self.variables = declarations
            .signals()
            .iter()
            .zip(0..)
            .map(|(signal, id)| Variable::new(signal, id))
            .collect();
        for step in declarations.walk() {
            match step {
                Step::Enter(name) => self.writer.add_module(&name)?,
                Step::Declare(index) => self.declare(index, &declarations.signals()[index])?,
                Step::Leave => self.writer.upscope()?,
            }
        }
        self.writer.enddefinitions()
    }

    fn declare(&mut self, index: usize, signal: &Signal) -> std::io::Result<()> {
        let id = self.variables[index].id;
        match signal.encoding.width() {
            Some(width) => self.writer.var_def(VarType::Wire, width.into(), id, &signal.name, None),
            None => self.writer.var_def(VarType::Real, 64, id, &signal.name, None),
        }
    }
}

impl Wave for VcdFile {
    fn begin(&mut self, declarations: &Declarations) -> Result<(), Error> {
        self.header(declarations).map_err(Error::io(&self.path))
    }

    fn time(&mut self, ticks: u64) -> Result<(), Error> {
        self.writer.timestamp(ticks).map_err(Error::io(&self.path))
    }

    fn bits(&mut self, signal: usize, bits: u64) -> Result<(), Error> {
        let mut line = [0; LINE_BYTES];
        let length = self.variables[signal].line(bits, &mut line);
        self.writer.writer().write_all(&line[..length]).map_err(Error::io(&self.path))
    }

    fn real(&mut self, signal: usize, value: f64) -> Result<(), Error> {
        self.writer.change_real(self.variables[signal].id, value).map_err(Error::io(&self.path))
    }

    fn finish(&mut self) -> Result<(), Error> {
        self.writer.flush().map_err(Error::io(&self.path))?;
        self.partial.take().map_or(Ok(()), AtomicFile::persist).map_err(Error::io(&self.path))
    }
}

impl Variable {
    fn new(signal: &Signal, id: u32) -> Self {
        let (id, scalar) = (IdCode::from(id), signal.encoding.width() == Some(1));
        let tail = if scalar { format!("{id}\n") } else { format!(" {id}\n") };
        Variable { id, tail: tail.into_bytes().into(), scalar }
    }

    /// Puts the line of one change into `line` and gives its length. Leading zeros are left out:
    /// readers extend a vector on the left with zeros.
    fn line(&self, bits: u64, line: &mut [u8; LINE_BYTES]) -> usize {
        let text = digits(bits);
        let digits = &text[bits.leading_zeros().min(63) as usize..];
        let mark = usize::from(!self.scalar);
        line[0] = b'b';
        line[mark..mark + digits.len()].copy_from_slice(digits);
        let length = mark + digits.len();
        line[length..length + self.tail.len()].copy_from_slice(&self.tail);
        length + self.tail.len()
    }
}

fn unit(exponent: i8) -> TimescaleUnit {
    match exponent {
        0 => TimescaleUnit::S,
        -3 => TimescaleUnit::MS,
        -6 => TimescaleUnit::US,
        -9 => TimescaleUnit::NS,
        _ => TimescaleUnit::PS,
    }
}
