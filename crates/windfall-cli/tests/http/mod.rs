//! A server of the program under test, and a client that can be as rude as needed.

use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A running `windfall serve`; it is killed when this goes.
pub struct Running {
    child: Child,
    /// Where it answers.
    pub address: SocketAddr,
    /// What it asks of every request; empty without one.
    pub token: String,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
    }
}

/// An answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// HTTP status.
    pub status: u16,
    /// Lines of the head, in lower case.
    pub head: String,
    /// The body.
    pub body: Vec<u8>,
}

impl Answer {
    /// The body as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|error| panic!("{error}: {} {}", self.status, self.text()))
    }

    /// The body as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// A line of the head.
    pub fn header(&self, name: &str) -> Option<&str> {
        let begin = format!("{name}: ");
        self.head.lines().find_map(|line| line.strip_prefix(&begin))
    }
}

/// Serves a directory on a free port.
pub fn serve(directory: &Path, options: &[&str]) -> Running {
    let mut child = Command::new(env!("CARGO_BIN_EXE_windfall"))
        .args(["serve", "--no-open", "--port", "0"])
        .args(options)
        .arg(directory)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(child.stdout.take().unwrap())
        .read_line(&mut line)
        .unwrap();
    let line = line.trim().trim_start_matches("http://");
    let (address, token) = line.split_once('/').unwrap();
    Running {
        child,
        address: address.parse().unwrap(),
        token: token.trim_start_matches("?token=").to_owned(),
    }
}

impl Running {
    /// Ends it as a power cut would.
    pub fn kill(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// A request with the token, and any head.
    pub fn send(&self, method: &str, path: &str, head: &[(&str, &str)], body: &[u8]) -> Answer {
        let mut stream = self.connect();
        let mut text = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        let all = [("Content-Length", &*body.len().to_string())];
        let host = self.address.to_string();
        let token = format!("Bearer {}", self.token);
        let own = [("Host", host.as_str()), ("Authorization", &token)];
        let named = |name: &str| {
            head.iter()
                .any(|(known, _)| known.eq_ignore_ascii_case(name))
        };
        let usual = own.iter().filter(|(name, _)| !named(name));
        for (name, value) in all.iter().chain(usual).chain(head) {
            text += &format!("{name}: {value}\r\n");
        }
        text += "\r\n";
        stream.write_all(text.as_bytes()).unwrap();
        // A server that refuses early does not read the rest.
        let _ = stream.write_all(body);
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        answer_of(&bytes)
    }

    /// A connection to it.
    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(120)))
            .unwrap();
        stream
    }

    /// What is at an address.
    pub fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &[], b"")
    }

    /// A request of the page with a body in JSON.
    pub fn page(&self, method: &str, path: &str, version: Option<&str>, body: &Value) -> Answer {
        let version = version.map(|version| format!("\"{version}\""));
        let mut head = vec![("X-Windfall", "page"), ("Content-Type", "application/json")];
        head.extend(version.as_deref().map(|version| ("If-Match", version)));
        self.send(method, path, &head, body.to_string().as_bytes())
    }

    /// Sends a file.
    pub fn upload(&self, path: &str, bytes: &[u8]) -> Answer {
        self.send("PUT", path, &[("X-Windfall", "page")], bytes)
    }

    /// Begins work and waits for its end.
    pub fn work(&self, campaign: &str, body: &Value) -> Value {
        let begun = self.page(
            "POST",
            &format!("/api/campaigns/{campaign}/jobs"),
            None,
            body,
        );
        assert_eq!(begun.status, 202, "{}", begun.text());
        let job = begun.json()["job"].as_str().unwrap().to_owned();
        // The stream of events ends with the work.
        let events = self.get(&format!("/api/jobs/{job}/events")).text();
        assert!(events.contains("event: end"), "{events}");
        self.get(&format!("/api/jobs/{job}")).json()
    }
}

/// Sends the beginning of a file and breaks off.
pub fn break_off(running: &Running, path: &str) {
    let mut stream = running.connect();
    let head = format!(
        "PUT {path} HTTP/1.1\r\nHost: {}\r\nAuthorization: Bearer {}\r\nX-Windfall: page\r\n\
         Content-Length: 1000000\r\n\r\n",
        running.address, running.token
    );
    stream.write_all(head.as_bytes()).unwrap();
    stream.write_all(&[b'1'; 5000]).unwrap();
    stream.shutdown(Shutdown::Both).unwrap();
}

fn answer_of(bytes: &[u8]) -> Answer {
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
    let end = end.unwrap_or_else(|| panic!("no head: {:?}", String::from_utf8_lossy(bytes)));
    let head = String::from_utf8_lossy(&bytes[..end]);
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    let chunked = head.to_lowercase().contains("transfer-encoding: chunked");
    let body = &bytes[end + 4..];
    Answer {
        status,
        head: head
            .lines()
            .filter_map(|line| line.split_once(": "))
            .map(|(name, value)| format!("{}: {value}\n", name.to_lowercase()))
            .collect(),
        body: match chunked {
            true => joined_chunks(body),
            false => body.to_vec(),
        },
    }
}

fn joined_chunks(mut rest: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    while let Some(end) = rest.windows(2).position(|two| two == b"\r\n") {
        let size = String::from_utf8_lossy(&rest[..end]);
        let size = usize::from_str_radix(size.trim(), 16).unwrap();
        let chunk = &rest[end + 2..];
        if size == 0 || chunk.len() < size + 2 {
            break;
        }
        body.extend_from_slice(&chunk[..size]);
        rest = &chunk[size + 2..];
    }
    body
}
