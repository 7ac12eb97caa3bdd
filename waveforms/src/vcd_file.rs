// SPDX-License-Identifier: MIT OR Apache-2.0
//! VCD: a value change dump (IEEE 1364-2005, clause 18).
//!
//! A comment before the variables names the format of each code: `core.oscillator.cosine s18.17`. The values of the first
//! time stand in `$dumpvars`.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use hapticore_files::AtomicFile;
use vcd::{IdCode, SimulationCommand, TimescaleUnit, VarType, Writer};

use crate::Error;
use crate::bits::digits;
use crate::declarations::{Declarations, Encoding, Signal, Step};
use crate::wave::{BUFFER_BYTES, Wave};

/// The longest change line: `b`, 63 digits, a space, an id, a newline.
const LINE_BYTES: usize = 80;

/// A VCD file being written.
///
/// Changes are put together here, a line at a time: the `vcd` crate writes a vector digit by digit
/// through the formatter, which takes eight times as long.
pub struct VcdFile {
    writer: Writer<BufWriter<File>>,
    values: Values,
    variables: Vec<Variable>,
    /// None once it has its name.
    partial: Option<AtomicFile>,
    path: PathBuf,
}

/// Which values come.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Values {
    None,
    /// Those of the first time.
    First,
    Changes,
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
        let (values, variables) = (Values::None, Vec::new());
        let (partial, path) = (Some(partial), path.to_owned());
        Ok(VcdFile { writer, values, variables, partial, path })
    }

    fn header(&mut self, declarations: &Declarations) -> std::io::Result<()> {
        self.writer.version("hapticore")?;
        self.writer.timescale(1, unit(declarations.timebase().exponent()))?;
        self.writer.comment(&formats(declarations))?;
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

    /// A time, and the ends of `$dumpvars` around the first.
    fn stamp(&mut self, ticks: u64) -> std::io::Result<()> {
        if self.values == Values::First {
            self.writer.end()?;
        }
        self.writer.timestamp(ticks)?;
        self.values = match self.values {
            Values::None => {
                self.writer.begin(SimulationCommand::Dumpvars)?;
                Values::First
            }
            _ => Values::Changes,
        };
        Ok(())
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
        self.stamp(ticks).map_err(Error::io(&self.path))
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

/// The paths of codes and their formats, a line each.
fn formats(declarations: &Declarations) -> String {
    let mut lines = String::from(
        "formats, two's complement: sWIDTH.FRACTION with a sign, uWIDTH.FRACTION without\n",
    );
    for signal in declarations.signals() {
        if let Encoding::Code(format) | Encoding::State(format, _) = &signal.encoding {
            lines += &format!("{} {format}\n", signal.path());
        }
    }
    lines
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
