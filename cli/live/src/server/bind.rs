// SPDX-License-Identifier: MIT OR Apache-2.0
//! Ports: of this machine alone, or of an address that others reach.

use std::io::ErrorKind;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener};

use anyhow::{Result, anyhow};

/// How often a free port is tried, which must be free at both addresses.
const TRIALS: usize = 16;

/// Binds a port at the addresses of this machine alone, or at one that others reach.
pub(super) fn listeners(port: u16, address: Option<IpAddr>) -> Result<Vec<TcpListener>> {
    if let Some(address) = address {
        return Ok(vec![bind(SocketAddr::new(address, port))?]);
    }
    let trials = if port == 0 { TRIALS } else { 1 };
    let found = (0..trials).map(|_| both(port)).find(|found| found.is_ok());
    found.unwrap_or_else(|| both(port))
}

/// Binds a port at 127.0.0.1 and, where the machine has it, ::1: a browser may take localhost for either, and another
/// program must not answer.
fn both(port: u16) -> Result<Vec<TcpListener>> {
    let first = bind(SocketAddr::new(Ipv4Addr::LOCALHOST.into(), port))?;
    let port = first.local_addr()?.port();
    match TcpListener::bind((Ipv6Addr::LOCALHOST, port)) {
        Ok(second) => Ok(vec![first, second]),
        Err(error) if error.kind() == ErrorKind::AddrInUse => Err(in_use(port)),
        Err(_) => Ok(vec![first]),
    }
}

fn bind(address: SocketAddr) -> Result<TcpListener> {
    TcpListener::bind(address).map_err(|error| match error.kind() {
        ErrorKind::AddrInUse => in_use(address.port()),
        _ => anyhow::Error::from(error).context(format!("address {address}")),
    })
}

fn in_use(port: u16) -> anyhow::Error {
    anyhow!("port {port} is in use; --port 0 takes a free one")
}
