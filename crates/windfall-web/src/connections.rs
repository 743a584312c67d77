//! Connections, limited in number and in the time that a client may take.
//!
//! Whoever can reach the port can open connections, with or without a token. Those that wait
//! for a request give way to new ones, so that nobody keeps others out by holding them.

use axum::Router;
use axum::body::{Body, Bytes};
use axum::http::Response;
use http_body::{Frame, SizeHint};
use hyper::server::conn::http1;
use hyper::service::{Service, service_fn};
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::oneshot;

/// Connections that are held at once. A browser opens six; many systems allow a program 256
/// open files, and requests need some for the files that they read.
const MOST: usize = 100;

/// Connections that are held even where the system allows few open files.
const LEAST: usize = 12;

/// Why a connection could not be accepted, where that is the client's doing.
const CLIENT_GONE: [ErrorKind; 2] = [ErrorKind::ConnectionAborted, ErrorKind::ConnectionReset];

/// Time limit for the head of a request, also of the next one on an idle connection.
const HEAD: Duration = Duration::from_secs(10);

/// Pause where the system has no room for another connection.
const NO_ROOM: Duration = Duration::from_millis(20);

/// A connection that is held.
struct Seat {
    /// Since when it has waited for a request; `None` while one is answered.
    waiting: Option<Instant>,
    /// Closes the connection when it goes.
    _open: oneshot::Sender<()>,
}

/// All connections that are held, by number.
#[derive(Clone, Default)]
struct Seats(Arc<Mutex<BTreeMap<u64, Seat>>>);

impl Seats {
    fn lock(&self) -> MutexGuard<'_, BTreeMap<u64, Seat>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn count(&self) -> usize {
        self.lock().len()
    }

    /// Closes those that have waited longest until fewer than `most` are left; `false` if
    /// too many are being answered.
    fn make_room(&self, most: usize) -> bool {
        let mut seats = self.lock();
        while seats.len() >= most {
            let waiting = seats
                .iter()
                .filter_map(|(number, seat)| Some((seat.waiting?, *number)));
            let Some((_, oldest)) = waiting.min() else {
                return false;
            };
            seats.remove(&oldest);
        }
        true
    }

    fn set_waiting(&self, number: u64, waiting: Option<Instant>) {
        if let Some(seat) = self.lock().get_mut(&number) {
            seat.waiting = waiting;
        }
    }
}

/// A request that is being answered: until it goes, its connection is not given up.
struct Answering {
    seats: Seats,
    number: u64,
}

impl Answering {
    fn begin(seats: &Seats, number: u64) -> Self {
        seats.set_waiting(number, None);
        Self {
            seats: seats.clone(),
            number,
        }
    }
}

impl Drop for Answering {
    fn drop(&mut self) {
        self.seats.set_waiting(self.number, Some(Instant::now()));
    }
}

/// The body of an answer; its connection is kept until all of it is sent.
struct Sent {
    body: Body,
    _answering: Answering,
}

impl http_body::Body for Sent {
    type Data = Bytes;
    type Error = axum::Error;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, axum::Error>>> {
        Pin::new(&mut self.body).poll_frame(context)
    }

    fn is_end_stream(&self) -> bool {
        self.body.is_end_stream()
    }

    fn size_hint(&self) -> SizeHint {
        self.body.size_hint()
    }
}

/// Accepts connections and answers their requests; never ends.
pub(crate) async fn accept(listener: TcpListener, routes: Router) {
    let seats = Seats::default();
    let mut most = MOST;
    for number in 0.. {
        let stream = loop {
            match listener.accept().await {
                Ok((stream, _)) => break stream,
                Err(error) if CLIENT_GONE.contains(&error.kind()) => {}
                // No further file can be opened: fewer connections leave some for requests.
                Err(_) => {
                    most = (seats.count() / 2).clamp(LEAST, MOST);
                    seats.make_room(most);
                    tokio::time::sleep(NO_ROOM).await;
                }
            }
        };
        if !seats.make_room(most) {
            continue;
        }
        // What was given up is closed before more is accepted.
        tokio::task::yield_now().await;
        let (open, closed) = oneshot::channel();
        let seat = Seat {
            waiting: Some(Instant::now()),
            _open: open,
        };
        seats.lock().insert(number, seat);
        let (seats, routes) = (seats.clone(), routes.clone());
        tokio::spawn(async move {
            tokio::select! {
                () = answer(stream, routes, &seats, number) => {}
                _ = closed => {}
            }
            seats.lock().remove(&number);
        });
    }
}

/// Answers the requests of a connection until it ends.
async fn answer(stream: TcpStream, routes: Router, seats: &Seats, number: u64) {
    let routes = TowerToHyperService::new(routes);
    let service = service_fn(|request| {
        let answering = Answering::begin(seats, number);
        let answer = routes.call(request);
        async move {
            let (head, body) = answer.await?.into_parts();
            let sent = Sent {
                body,
                _answering: answering,
            };
            Ok::<_, std::convert::Infallible>(Response::from_parts(head, sent))
        }
    });
    // Small answers are not held back to be sent with later ones.
    let _ = stream.set_nodelay(true);
    let mut server = http1::Builder::new();
    server.timer(TokioTimer::new()).header_read_timeout(HEAD);
    // A connection that breaks is the client's matter.
    let _ = server.serve_connection(TokioIo::new(stream), service).await;
}
