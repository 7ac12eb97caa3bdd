// SPDX-License-Identifier: MIT OR Apache-2.0
//! The server: a thread for each connection, another to write to a WebSocket, and the loop ([`Hub`]) on the caller's.

mod bind;
mod talk;

use std::io::Write;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use anyhow::{Result, anyhow};

use crate::files;
use crate::http::{self, Guard, Head, PATIENCE};
use crate::hub::{Hub, Message};
use crate::protocol::Opening;
use crate::setup::Setup;
use crate::source::Source;
use bind::listeners;
use talk::talk;

/// The most connections at a time.
const CONNECTIONS: usize = 64;

/// What a server is made of.
#[derive(Debug, Clone)]
pub struct Config {
    /// The scene.
    pub opening: Opening,
    /// The port; 0 takes a free one.
    pub port: u16,
    /// An address at which other machines reach it, with the token they need.
    pub listen: Option<(IpAddr, String)>,
    /// Device time by wall time.
    pub speed: f64,
}

/// A server that is bound to its port.
pub struct Server {
    listeners: Vec<TcpListener>,
    shared: Arc<Shared>,
    hub: Hub,
}

/// What all threads know.
struct Shared {
    guard: Guard,
    hub: SyncSender<Message>,
    ends: AtomicBool,
    connections: AtomicUsize,
    next_client: AtomicU64,
}

impl Server {
    /// Sets up the scene and binds the port, on this machine alone where no other address is given.
    ///
    /// # Errors
    /// A scene that cannot be run, a port in use.
    pub fn bind(config: Config) -> Result<Server> {
        let Config { opening, port, listen, speed } = config;
        let address = listen.as_ref().map(|(address, _)| *address);
        let listeners = listeners(port, address, "--port")?;
        let port = listeners[0].local_addr()?.port();
        let setup = Setup::new(&opening);
        let source = setup.source(&opening).map_err(|message| anyhow!(message))?;
        let hub = Hub::new(setup, opening, source, speed);
        let token = listen.map(|(_, token)| token);
        Ok(Server::with(listeners, hub, Guard { port, listen: address, token }))
    }

    /// Binds the port for a source that no client replaces, a board. A token is always needed: it may be high voltage.
    ///
    /// # Errors
    /// A port in use.
    pub fn of_board(
        source: Box<dyn Source>,
        port: u16,
        listen: Option<IpAddr>,
        token: String,
    ) -> Result<Server> {
        let listeners = listeners(port, listen, "--page-port")?;
        let port = listeners[0].local_addr()?.port();
        let hub = Hub::new(Setup::fixed(), Opening::default(), source, 1.0);
        Ok(Server::with(listeners, hub, Guard { port, listen, token: Some(token) }))
    }

    fn with(listeners: Vec<TcpListener>, hub: Hub, guard: Guard) -> Server {
        let shared = Shared {
            guard,
            hub: hub.sender(),
            ends: AtomicBool::new(false),
            connections: AtomicUsize::new(0),
            next_client: AtomicU64::new(0),
        };
        Server { listeners, shared: Arc::new(shared), hub }
    }

    /// The address for a browser.
    pub fn url(&self) -> String {
        let Guard { port, listen, token } = &self.shared.guard;
        let address = match listen {
            Some(address) if !address.is_unspecified() => SocketAddr::new(*address, *port),
            _ => SocketAddr::new(Ipv4Addr::LOCALHOST.into(), *port),
        };
        match token {
            Some(token) => format!("http://{address}/?token={token}"),
            None => format!("http://{address}/"),
        }
    }

    /// The port.
    pub fn port(&self) -> u16 {
        self.shared.guard.port
    }

    /// Serves until told to stop, asked every tenth of a second.
    ///
    /// # Errors
    /// A thread that cannot be started.
    pub fn run(mut self, stop: &dyn Fn() -> bool) -> Result<()> {
        let mut acceptors = Vec::new();
        for listener in &self.listeners {
            let (listener, shared) = (listener.try_clone()?, self.shared.clone());
            let acceptor = thread::Builder::new().name("accept".into());
            acceptors.push(acceptor.spawn(move || accept(&listener, &shared))?);
        }
        self.hub.run(stop);
        self.shared.ends.store(true, Ordering::Relaxed);
        // An acceptor waits for a connection: this one ends it.
        self.listeners.iter().filter_map(|of| of.local_addr().ok()).for_each(wake);
        acceptors.into_iter().for_each(|acceptor| drop(acceptor.join()));
        Ok(())
    }
}

fn wake(address: SocketAddr) {
    let reachable: IpAddr = match address.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    let address = SocketAddr::new(reachable, address.port());
    let _ = TcpStream::connect_timeout(&address, Duration::from_secs(1));
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    while !shared.ends.load(Ordering::Relaxed) {
        match listener.accept() {
            Ok((stream, _)) => connect(stream, shared),
            // Out of file descriptors: connections end, and then there are some.
            Err(_) => thread::sleep(Duration::from_millis(50)),
        }
    }
}

/// Counts a connection as long as it lives.
struct Connection(Arc<Shared>);

impl Drop for Connection {
    fn drop(&mut self) {
        self.0.connections.fetch_sub(1, Ordering::Relaxed);
    }
}

fn connect(mut stream: TcpStream, shared: &Arc<Shared>) {
    let connection = Connection(shared.clone());
    let before = shared.connections.fetch_add(1, Ordering::Relaxed);
    let timeouts = stream
        .set_read_timeout(Some(PATIENCE))
        .and_then(|()| stream.set_write_timeout(Some(PATIENCE)))
        .and_then(|()| stream.set_nodelay(true));
    if timeouts.is_err() {
        return;
    }
    if before >= CONNECTIONS {
        let message = format!("expected at most {CONNECTIONS} connections");
        let _ = http::refuse(&mut stream, &("503 Service Unavailable", message));
        return;
    }
    let thread = thread::Builder::new().name("client".into());
    // A client that goes away is no error of the server.
    let _ = thread.spawn(move || drop(serve(stream, &connection.0)));
}

fn serve(mut stream: TcpStream, shared: &Arc<Shared>) -> Result<()> {
    let head = match Head::read(&mut stream)? {
        Ok(head) => head,
        Err(refusal) => return Ok(http::refuse(&mut stream, &refusal)?),
    };
    if let Err(refusal) = shared.guard.check(&head) {
        return Ok(http::refuse(&mut stream, &refusal)?);
    }
    if head.path == "/ws" {
        return match head.switch() {
            Ok(answer) => {
                stream.write_all(answer.as_bytes())?;
                talk(stream, head.rest, shared)
            }
            Err(refusal) => Ok(http::refuse(&mut stream, &refusal)?),
        };
    }
    if head.method != "GET" {
        let refusal = ("405 Method Not Allowed", "expected GET".to_string());
        return Ok(http::refuse(&mut stream, &refusal)?);
    }
    match files::find(&head.path) {
        Some(file) => Ok(http::respond(&mut stream, "200 OK", file.kind, file.text.as_bytes())?),
        None => Ok(http::refuse(&mut stream, &("404 Not Found", "no such file".into()))?),
    }
}
