// SPDX-License-Identifier: MIT OR Apache-2.0
//! The server: a thread for each connection, another to write to a WebSocket, and the loop ([`Hub`]) on the caller's.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use anyhow::{Result, anyhow};
use tungstenite::protocol::{Role, WebSocket, WebSocketConfig};
use tungstenite::{Error, Message as Received};

use crate::client::{Outbox, text_frame};
use crate::files;
use crate::http::{self, Guard, Head, PATIENCE};
use crate::hub::{ClientId, Hub, Message};
use crate::protocol::{Answer, BadRequest, LONGEST, Opening, Request};
use crate::source::Setup;

/// The most connections at a time.
const CONNECTIONS: usize = 64;

/// A message of this size ends its connection, bytes; a shorter one that is too long gets an error.
const ENDS: usize = 1 << 20;

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
        let listeners = listeners(port, address)?;
        let port = listeners[0].local_addr()?.port();
        let setup = Setup::new(&opening);
        let source = setup.source(&opening).map_err(|message| anyhow!(message))?;
        let hub = Hub::new(setup, opening, source, speed);
        let token = listen.map(|(_, token)| token);
        let shared = Shared {
            guard: Guard { port, listen: address, token },
            hub: hub.sender(),
            ends: AtomicBool::new(false),
            connections: AtomicUsize::new(0),
            next_client: AtomicU64::new(0),
        };
        Ok(Server { listeners, shared: Arc::new(shared), hub })
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

/// How often a free port is tried, which must be free at both addresses.
const TRIALS: usize = 16;

/// Binds a port at the addresses of this machine alone, or at one that others reach.
fn listeners(port: u16, address: Option<IpAddr>) -> Result<Vec<TcpListener>> {
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

/// Takes a client's requests until it leaves; another thread writes what it is sent.
fn talk(stream: TcpStream, rest: Vec<u8>, shared: &Arc<Shared>) -> Result<()> {
    let client = shared.next_client.fetch_add(1, Ordering::Relaxed);
    let outbox = Arc::new(Outbox::default());
    stream.set_read_timeout(None)?;
    let (writing, to_write) = (stream.try_clone()?, outbox.clone());
    let writer = thread::Builder::new().name("write".into());
    let writer = writer.spawn(move || write(writing, &to_write))?;
    let hub = &shared.hub;
    if hub.send(Message::Join(client, outbox.clone())).is_ok() {
        let duplex = Duplex { stream, outbox: outbox.clone(), unsent: Vec::new() };
        listen(duplex, rest, (client, &outbox), hub);
        let _ = hub.send(Message::Leave(client));
    }
    outbox.close();
    writer.join().map_err(|_| anyhow!("the writer has panicked"))
}

fn write(mut stream: TcpStream, outbox: &Outbox) {
    while let Some(bytes) = outbox.next() {
        if stream.write_all(&bytes).is_err() {
            break;
        }
    }
    outbox.close();
    let _ = stream.shutdown(Shutdown::Both);
}

/// Takes requests until the connection ends.
fn listen(
    duplex: Duplex,
    rest: Vec<u8>,
    (client, outbox): (ClientId, &Outbox),
    hub: &SyncSender<Message>,
) {
    let config = WebSocketConfig::default()
        .read_buffer_size(8 << 10)
        .write_buffer_size(0)
        .max_message_size(Some(ENDS))
        .max_frame_size(Some(ENDS));
    let mut socket = WebSocket::from_partially_read(duplex, rest, Role::Server, Some(config));
    let complain = |id, message| outbox.answer(text_frame(&Answer::Error { id, message }.text()));
    loop {
        let text = match socket.read() {
            Ok(Received::Text(text)) => text,
            Ok(Received::Binary(_)) => {
                complain(None, "message: expected JSON text, got a binary message".into());
                continue;
            }
            Ok(_) => continue,
            Err(Error::Capacity(_)) => {
                let message =
                    format!("message: expected at most {LONGEST} bytes; connection closed");
                return complain(None, message);
            }
            Err(_) => return,
        };
        match Request::parse(&text) {
            Ok(request) => {
                if hub.send(Message::Request(client, request)).is_err() {
                    return;
                }
            }
            Err(BadRequest { id, message }) => complain(id, message),
        }
    }
}

/// Reads from a socket; what a WebSocket answers by itself, pongs and its close, is written by the thread that writes
/// all else.
struct Duplex {
    stream: TcpStream,
    outbox: Arc<Outbox>,
    unsent: Vec<u8>,
}

impl Read for Duplex {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.stream.read(buffer)
    }
}

impl Write for Duplex {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.unsent.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.unsent.is_empty() {
            self.outbox.answer(std::mem::take(&mut self.unsent).into());
        }
        Ok(())
    }
}
