// SPDX-License-Identifier: MIT OR Apache-2.0
//! The HTTP side: heads of requests, who may ask, and the page's files.
//!
//! A page of another site must reach neither source nor board, although its browser runs on this machine. So `Host` and
//! `Origin` must be this server's own. A request without an origin comes from no browser and is allowed.

use std::io::{self, Read, Write};
use std::net::IpAddr;
use std::time::{Duration, Instant};

use tungstenite::handshake::derive_accept_key;

/// The longest head of a request, bytes.
const LONGEST: usize = 8 << 10;

/// How long a client may take to send it.
pub const PATIENCE: Duration = Duration::from_secs(5);

/// A request, without its body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Head {
    /// `GET`.
    pub method: String,
    /// Without the query.
    pub path: String,
    /// What follows `?`.
    pub query: String,
    host: Option<String>,
    origin: Option<String>,
    upgrade: bool,
    key: Option<String>,
    version: Option<String>,
    /// What came after the head.
    pub rest: Vec<u8>,
}

/// A status and a sentence.
pub type Refusal = (&'static str, String);

impl Head {
    /// Reads a head.
    ///
    /// # Errors
    /// A client that is gone or too slow; a head that is too long or none: that has a refusal.
    pub fn read(stream: &mut impl Read) -> io::Result<Result<Head, Refusal>> {
        let (mut bytes, mut chunk, begun) = (Vec::new(), [0; 2048], Instant::now());
        loop {
            let read = stream.read(&mut chunk)?;
            if read == 0 || begun.elapsed() > PATIENCE {
                return Err(io::ErrorKind::TimedOut.into());
            }
            bytes.extend_from_slice(&chunk[..read]);
            match Head::parse(&bytes) {
                Ok(None) if bytes.len() > LONGEST => {
                    let message = format!("expected a head of at most {LONGEST} bytes");
                    return Ok(Err(("431 Request Header Fields Too Large", message)));
                }
                Ok(None) => (),
                Ok(Some(head)) => return Ok(Ok(head)),
                Err(error) => return Ok(Err(("400 Bad Request", error.to_string()))),
            }
        }
    }

    /// The head that these bytes begin with; none where it is not complete.
    fn parse(bytes: &[u8]) -> Result<Option<Head>, httparse::Error> {
        let mut headers = [httparse::EMPTY_HEADER; 64];
        let mut request = httparse::Request::new(&mut headers);
        let httparse::Status::Complete(length) = request.parse(bytes)? else { return Ok(None) };
        let target = request.path.unwrap_or_default();
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let value = |name: &str| {
            let mut found = request.headers.iter().filter(|of| of.name.eq_ignore_ascii_case(name));
            let first = found.next()?;
            // Of two there is no telling which one a proxy or a browser meant.
            let value =
                if found.next().is_some() { "" } else { str::from_utf8(first.value).unwrap_or("") };
            Some(value.trim().to_string())
        };
        let upgrade = value("upgrade").is_some_and(|of| of.eq_ignore_ascii_case("websocket"));
        Ok(Some(Head {
            method: request.method.unwrap_or_default().to_string(),
            path: path.to_string(),
            query: query.to_string(),
            host: value("host"),
            origin: value("origin"),
            upgrade,
            key: value("sec-websocket-key"),
            version: value("sec-websocket-version"),
            rest: bytes[length..].to_vec(),
        }))
    }

    /// The answer that makes a WebSocket of the connection.
    ///
    /// # Errors
    /// A request that asks for none.
    pub fn switch(&self) -> Result<String, Refusal> {
        let key = self.key.as_deref().filter(|key| key.len() == 24 && self.upgrade);
        let Some(key) = key.filter(|_| self.version.as_deref() == Some("13")) else {
            return Err(("426 Upgrade Required", "expected a WebSocket of version 13".into()));
        };
        let accept = derive_accept_key(key.as_bytes());
        Ok(format!(
            "HTTP/1.1 101 Switching Protocols\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Accept: {accept}\r\n\r\n"
        ))
    }
}

/// Who may ask.
#[derive(Debug, Clone)]
pub struct Guard {
    /// The server's port.
    pub port: u16,
    /// The address that others may reach it at; none where only this machine can.
    pub listen: Option<IpAddr>,
    /// What a WebSocket's query must have as `token`.
    pub token: Option<String>,
}

impl Guard {
    /// Refuses a request that is for another server, from a page of another one, or without the token.
    ///
    /// # Errors
    /// With the status and what was expected.
    pub fn check(&self, head: &Head) -> Result<(), Refusal> {
        let forbidden = |message| Err(("403 Forbidden", message));
        if !head.host.as_deref().is_some_and(|host| self.is_own(host)) {
            return forbidden(format!("Host: expected {}", self.names()));
        }
        let same = |origin: &str| {
            let host = origin.strip_prefix("http://").unwrap_or("");
            self.is_own(host)
                && head.host.as_deref().is_some_and(|of| of.eq_ignore_ascii_case(host))
        };
        if !head.origin.as_deref().is_none_or(same) {
            return forbidden("Origin: expected this server's own page, or none".into());
        }
        // Without it the page could only try in vain.
        if ["/", "/ws"].contains(&head.path.as_str()) && !self.has_token(&head.query) {
            return forbidden(
                "token: expected the whole address that hapticore has printed, with ?token=…"
                    .into(),
            );
        }
        Ok(())
    }

    fn names(&self) -> String {
        format!("127.0.0.1:{0}, [::1]:{0} or localhost:{0}", self.port)
    }

    /// Whether a `Host` names this server. A name of a foreign domain never does, whatever it resolves to.
    fn is_own(&self, host: &str) -> bool {
        let host = host.to_ascii_lowercase();
        let port = format!(":{}", self.port);
        let name = match host.strip_suffix(&port) {
            Some(name) => name,
            None if self.port == 80 => &host,
            None => return false,
        };
        if ["127.0.0.1", "[::1]", "localhost"].contains(&name) {
            return true;
        }
        let bare = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        let address = bare.parse::<IpAddr>().ok();
        // Bound to all addresses of the machine, any of them may be named; the token is asked for anyway.
        self.listen.is_some_and(|own| address.is_some_and(|of| own.is_unspecified() || own == of))
    }

    fn has_token(&self, query: &str) -> bool {
        let Some(token) = &self.token else { return true };
        let given = query.split('&').find_map(|pair| pair.strip_prefix("token=")).unwrap_or("");
        // In the same time for any token of the same length.
        given.len() == token.len()
            && given.bytes().zip(token.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
    }
}

/// Writes an answer and its text.
///
/// # Errors
/// A client that is gone.
pub fn respond(stream: &mut impl Write, status: &str, kind: &str, body: &[u8]) -> io::Result<()> {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\
         Cache-Control: no-cache\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         X-Frame-Options: DENY\r\nContent-Security-Policy: default-src 'self'; \
         style-src 'self' 'unsafe-inline'; img-src 'self' data:; frame-ancestors 'none'\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(body)?;
    stream.flush()
}

/// Writes a refusal.
///
/// # Errors
/// A client that is gone.
pub fn refuse(stream: &mut impl Write, (status, message): &Refusal) -> io::Result<()> {
    respond(stream, status, "text/plain; charset=utf-8", format!("{message}\n").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(guard: &Guard, lines: &str) -> Result<(), &'static str> {
        let text = format!("GET /ws?token=abc HTTP/1.1\r\n{lines}\r\n");
        let head = Head::read(&mut text.as_bytes()).unwrap().unwrap();
        guard.check(&head).map_err(|(status, _)| status)
    }

    #[test]
    fn only_its_own_host_and_origin_pass() {
        let guard = Guard { port: 8091, listen: None, token: None };
        for lines in [
            "Host: 127.0.0.1:8091\r\n",
            "Host: LOCALHOST:8091\r\nOrigin: http://localhost:8091\r\n",
            "Host: [::1]:8091\r\nOrigin: http://[::1]:8091\r\n",
        ] {
            assert_eq!(check(&guard, lines), Ok(()), "{lines}");
        }
        for lines in [
            "",
            "Host: evil.example:8091\r\n",
            "Host: 127.0.0.1\r\n",
            "Host: 127.0.0.1:8091\r\nHost: evil.example\r\n",
            "Host: 192.168.0.2:8091\r\n",
            "Host: localhost.evil.example:8091\r\n",
            "Host: localhost:8091\r\nOrigin: http://evil.example\r\n",
            "Host: localhost:8091\r\nOrigin: null\r\n",
            "Host: localhost:8091\r\nOrigin: http://localhost:8092\r\n",
            "Host: localhost:8091\r\nOrigin: https://localhost:8091\r\n",
            "Host: localhost:8091\r\nOrigin: http://127.0.0.1:8091\r\n",
        ] {
            assert_eq!(check(&guard, lines), Err("403 Forbidden"), "{lines}");
        }
    }

    #[test]
    fn others_need_the_token() {
        let guard = |token: &str| Guard {
            port: 80,
            listen: Some("0.0.0.0".parse().unwrap()),
            token: Some(token.into()),
        };
        let lines = "Host: 192.168.0.2\r\nOrigin: http://192.168.0.2\r\n";
        assert_eq!(check(&guard("abc"), lines), Ok(()));
        assert_eq!(check(&guard("abd"), lines), Err("403 Forbidden"));
        assert_eq!(check(&guard("abc"), "Host: evil.example\r\n"), Err("403 Forbidden"));
    }

    #[test]
    fn a_head_that_is_none_is_refused() {
        let status = |bytes: &[u8]| Head::read(&mut &bytes[..]).unwrap().unwrap_err().0;
        assert_eq!(status(b"\0\x01\x02\xff\r\n\r\n"), "400 Bad Request");
        assert!(
            status(
                &b"GET / HTTP/1.1\r\nA: ".iter().chain(&[b'a'; 9000]).copied().collect::<Vec<_>>()
            )
            .starts_with("431")
        );
        assert!(Head::read(&mut &b"GET / HT"[..]).is_err(), "the client is gone");
    }
}
