// SPDX-License-Identifier: MIT OR Apache-2.0
//! Lines to a board: what opens one, and what is read and written then.

use std::fs::OpenOptions;
use std::io::{self, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// Both ends of a line that is open.
///
/// The reader returns [`io::ErrorKind::WouldBlock`] or [`io::ErrorKind::TimedOut`] within 50 ms where nothing has come,
/// and no bytes once the line has ended. The writer returns within a second.
pub struct Ends {
    /// What the board sends.
    pub reader: Box<dyn Read + Send>,
    /// What the board receives.
    pub writer: Box<dyn Write + Send>,
}

/// A line that can be opened, and again after it was unplugged.
pub trait Line: Send {
    /// Its name in messages.
    fn name(&self) -> String;

    /// Opens it.
    ///
    /// # Errors
    /// Why it cannot be opened: what to check.
    fn open(&mut self) -> io::Result<Ends>;
}

/// How long a connection over TCP may take.
const CONNECT: Duration = Duration::from_secs(2);
/// How long a read waits.
const READ: Duration = Duration::from_millis(20);
/// How long a write waits.
const WRITE: Duration = Duration::from_secs(1);

/// The line of a name: `tcp:ADDRESS:PORT`, or the path of a serial port, which is set to `baud` bits a second.
///
/// # Errors
/// A name that is none.
///
/// ```
/// use hapticore_host::link::line;
///
/// assert_eq!(line("tcp:127.0.0.1:4000", 1_000_000)?.name(), "tcp:127.0.0.1:4000");
/// assert_eq!(line("/dev/ttyUSB1", 1_000_000)?.name(), "/dev/ttyUSB1");
/// assert!(line("tcp:nowhere", 1_000_000).is_err(), "no port");
/// assert!(line("ttyUSB1", 1_000_000).is_err(), "no path");
/// # Ok::<(), String>(())
/// ```
pub fn line(name: &str, baud: u32) -> Result<Box<dyn Line>, String> {
    let Some(address) = name.strip_prefix("tcp:") else {
        let is_path = name.contains(['/', '\\']) || name.starts_with("COM");
        return match is_path {
            true => Ok(Box::new(SerialPort { path: name.into(), baud })),
            false => Err(format!(
                "port: expected the path of a serial port, tcp:ADDRESS:PORT, virtual or virtual:SCENE, got {name:?}; \
                 hapticore host list lists them"
            )),
        };
    };
    let port = address.rsplit_once(':').and_then(|(_, port)| port.parse::<u16>().ok());
    match port {
        Some(_) => Ok(Box::new(Tcp { address: address.into() })),
        None => Err(format!("port: expected tcp:ADDRESS:PORT, got {name:?}")),
    }
}

/// A line over TCP, as `ser2net` and a virtual board offer it.
#[derive(Debug, Clone)]
pub struct Tcp {
    /// Address and port.
    pub address: String,
}

impl Line for Tcp {
    fn name(&self) -> String {
        format!("tcp:{}", self.address)
    }

    fn open(&mut self) -> io::Result<Ends> {
        let mut last = io::Error::other("no such address");
        for address in self.address.to_socket_addrs()? {
            match TcpStream::connect_timeout(&address, CONNECT) {
                Ok(stream) => return ends_of_tcp(stream),
                Err(error) => last = error,
            }
        }
        Err(match last.kind() {
            io::ErrorKind::ConnectionRefused => {
                let cure = "nothing listens there: start ser2net, or serve a virtual board, first";
                io::Error::new(last.kind(), cure)
            }
            _ => last,
        })
    }
}

/// The ends of a connection.
///
/// # Errors
/// A connection that is gone.
pub fn ends_of_tcp(stream: TcpStream) -> io::Result<Ends> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(READ))?;
    stream.set_write_timeout(Some(WRITE))?;
    Ok(Ends { reader: Box::new(stream.try_clone()?), writer: Box::new(stream) })
}

/// A serial port, or a terminal that stands in for one, by its path. `stty` sets it up; so no library is needed.
#[derive(Debug, Clone)]
pub struct SerialPort {
    /// Path of the device file.
    pub path: PathBuf,
    /// Bits a second.
    pub baud: u32,
}

impl Line for SerialPort {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn open(&mut self) -> io::Result<Ends> {
        let file = open_path(&self.path).map_err(cure)?;
        // All bytes as they come, eight bits, no modem lines.
        let setup = ["raw", "-echo", "cs8", "-parenb", "-cstopb", "clocal", "-crtscts", "-ixon"];
        let output = Command::new("stty")
            .arg(self.baud.to_string())
            .args(setup)
            .stdin(Stdio::from(file.try_clone()?))
            .output()
            .map_err(|error| io::Error::new(error.kind(), format!("stty: {error}")))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(io::Error::other(format!(
                "expected a serial port that takes {} baud; {}",
                self.baud,
                said.trim()
            )));
        }
        Ok(Ends { reader: Box::new(file.try_clone()?), writer: Box::new(Patient(file)) })
    }
}

/// What to do about a port that cannot be opened.
fn cure(error: io::Error) -> io::Error {
    let cure = match error.kind() {
        io::ErrorKind::NotFound => {
            "no such port, is it plugged in? hapticore host list lists those that are"
        }
        io::ErrorKind::PermissionDenied => {
            "permission denied: on Linux, add yourself to the port's group, such as dialout"
        }
        io::ErrorKind::ResourceBusy => "another program has it open",
        _ => return error,
    };
    io::Error::new(error.kind(), cure)
}

/// Opens a device file that neither waits for a modem nor becomes this process's terminal.
#[cfg(unix)]
fn open_path(path: &Path) -> io::Result<std::fs::File> {
    use std::os::unix::fs::OpenOptionsExt;
    // O_NONBLOCK and O_NOCTTY.
    let flags = if cfg!(target_os = "linux") { 0o4000 | 0o400 } else { 0x4 | 0x2_0000 };
    OpenOptions::new().read(true).write(true).custom_flags(flags).open(path)
}

#[cfg(not(unix))]
fn open_path(path: &Path) -> io::Result<std::fs::File> {
    let _ = OpenOptions::new();
    Err(io::Error::other(format!(
        "{}: expected tcp:ADDRESS:PORT: serial ports are opened on Linux and macOS only; offer the port over TCP, for \
         example with com2tcp or ser2net",
        path.display()
    )))
}

/// Writes to a file that refuses bytes while its buffer is full.
struct Patient<W>(W);

impl<W: Write> Write for Patient<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        const PAUSE: Duration = Duration::from_millis(1);
        for _ in 0..WRITE.as_millis() {
            match self.0.write(bytes) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                    std::thread::sleep(PAUSE);
                }
                other => return other,
            }
        }
        Err(io::ErrorKind::TimedOut.into())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    #[test]
    fn bytes_go_both_ways_over_tcp_and_its_end_is_seen() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let mut ends = line(&format!("tcp:{address}"), 0).unwrap().open().unwrap();
        let (mut board, _) = listener.accept().unwrap();
        let mut buffer = [0; 8];
        let nothing = ends.reader.read(&mut buffer).unwrap_err().kind();
        assert!([io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&nothing));
        board.write_all(&[1, 0, 2]).unwrap();
        while ends.reader.read(&mut buffer).is_err() {}
        assert_eq!(buffer[..3], [1, 0, 2]);
        ends.writer.write_all(&[7, 0]).unwrap();
        board.read_exact(&mut buffer[..2]).unwrap();
        assert_eq!(buffer[..2], [7, 0]);
        drop(board);
        let mut read = ends.reader.read(&mut buffer);
        while read.is_err() {
            read = ends.reader.read(&mut buffer);
        }
        assert_eq!(read.unwrap(), 0);
    }

    #[test]
    fn a_path_that_is_no_serial_port_is_refused_in_words() {
        let refusal = |path: &str| line(path, 1_000_000).unwrap().open().err().map(|of| of.kind());
        assert_eq!(refusal("/no/such/port"), Some(io::ErrorKind::NotFound));
        let mut none = line("/dev/null", 1_000_000).unwrap();
        let message = none.open().err().expect("no serial port").to_string();
        assert!(message.starts_with("expected a serial port"), "{message}");
    }
}
