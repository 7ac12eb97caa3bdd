// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ports: of this machine alone, or of an address that others reach.

use std::io::{self, ErrorKind};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener};

use anyhow::{Result, anyhow};

/// How often a free port is tried, which must be free at both addresses.
const TRIALS: usize = 16;

/// Binds a port at the addresses of this machine alone, or at one that others reach. `option` names the port's on the
/// command line.
pub(super) fn listeners(
    port: u16,
    address: Option<IpAddr>,
    option: &str,
) -> Result<Vec<TcpListener>> {
    let found = match address {
        Some(address) => {
            TcpListener::bind(SocketAddr::new(address, port)).map(|listener| vec![listener])
        }
        None => {
            let trials = if port == 0 { TRIALS } else { 1 };
            let found = (0..trials).map(|_| both(port)).find(|found| found.is_ok());
            found.unwrap_or_else(|| both(port))
        }
    };
    found.map_err(|error| match error.kind() {
        ErrorKind::AddrInUse => anyhow!("port {port} is in use; {option} 0 takes a free one"),
        _ => anyhow::Error::from(error).context(format!("port {port}")),
    })
}

/// Binds a port at 127.0.0.1 and, where the machine has it, ::1: a browser may take localhost for either, and another
/// program must not answer.
fn both(port: u16) -> io::Result<Vec<TcpListener>> {
    let first = TcpListener::bind(SocketAddr::new(Ipv4Addr::LOCALHOST.into(), port))?;
    let port = first.local_addr()?.port();
    match TcpListener::bind(SocketAddr::new(Ipv6Addr::LOCALHOST.into(), port)) {
        Ok(second) => Ok(vec![first, second]),
        Err(error) if error.kind() == ErrorKind::AddrInUse => Err(error),
        Err(_) => Ok(vec![first]),
    }
}
