//! Starting and stopping the server.

use crate::api::{campaigns, changes, events, files, jobs, live, recordings, scenes, tables};
use crate::app::App;
use crate::connections::accept;
use crate::guard::{Guard, guarded};
use crate::interrupt::interrupted;
use crate::problem::Problem;
use crate::{about, asset, openapi};
use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::StatusCode;
use axum::middleware::from_fn_with_state;
use axum::routing::{get, post, put};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tower_http::CompressionLevel;
use tower_http::compression::CompressionLayer;
use tower_http::compression::predicate::{DefaultPredicate, NotForContentType, Predicate};
use windfall_workspace::workspace::Workspace;

/// Size limit of a body other than an upload; bytes.
const MOST_BODY: usize = 4 << 20;

/// Grace period for running requests when the server stops.
const GRACE: Duration = Duration::from_secs(2);

/// Default port.
const USUAL_PORT: u16 = 8417;

/// How the server is started.
#[derive(Clone, Debug)]
pub struct ServeRequest {
    /// A campaign directory, or a directory with campaigns in it.
    pub directory: PathBuf,
    /// Address to listen on; loopback unless others need access.
    pub host: IpAddr,
    /// Port; 8417 or a free one if `None`.
    pub port: Option<u16>,
    /// Size limit of an upload; bytes.
    pub upload_limit: u64,
    /// Whether requests need a token; only a server on loopback may do without.
    pub token: bool,
}

/// Why the server cannot start.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The directory cannot be served.
    #[error(transparent)]
    Directory(#[from] windfall_files::error::Error),
    /// The address is unavailable.
    #[error("cannot listen at {address}: {source}; choose another --port or --host")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The system's error.
        source: std::io::Error,
    },
    /// Others could reach a server that asks nobody for a token.
    #[error(
        "--no-token with --host {0}: everybody in the network could change your files; leave out \
         one of them"
    )]
    Open(IpAddr),
    /// The system gives no randomness for a token, or no threads.
    #[error("cannot start: {0}")]
    System(String),
}

/// A server that listens, and answers once [`Server::run`] is called.
pub struct Server {
    app: App,
    guard: Arc<Guard>,
    listener: TcpListener,
}

impl Server {
    /// Opens the directory and listens.
    ///
    /// # Errors
    /// As [`ServeError`] says.
    pub fn open(request: &ServeRequest) -> Result<Self, ServeError> {
        if !request.token && !request.host.is_loopback() {
            return Err(ServeError::Open(request.host));
        }
        let workspace = Workspace::open(&request.directory)?;
        let listener = listener(request)?;
        let failed = |error: std::io::Error| ServeError::System(error.to_string());
        let address = listener.local_addr().map_err(failed)?;
        listener.set_nonblocking(true).map_err(failed)?;
        let secret = || request.token.then(token).transpose();
        let guard = Guard {
            address,
            token: secret()?,
            once: Mutex::new(secret()?),
        };
        Ok(Self {
            app: App::new(workspace, request.upload_limit),
            guard: Arc::new(guard),
            listener,
        })
    }

    /// The address for people and programs, with its token where one is needed.
    pub fn address(&self) -> String {
        self.address_with(self.guard.token.as_deref())
    }

    /// The address to open a browser with: others may see its command line, so that its
    /// token is good for one visit.
    pub fn opening_address(&self) -> String {
        let once = self.guard.once.lock();
        self.address_with(once.unwrap_or_else(PoisonError::into_inner).as_deref())
    }

    fn address_with(&self, token: Option<&str>) -> String {
        let mut at = self.guard.address;
        // Bound to all addresses: loopback opens it here.
        if at.ip().is_unspecified() {
            at.set_ip(IpAddr::V4(Ipv4Addr::LOCALHOST));
        }
        match token {
            Some(token) => format!("http://{at}/?token={token}"),
            None => format!("http://{at}/"),
        }
    }

    /// Serves until interrupted; running jobs are then cancelled and leave nothing half-written.
    ///
    /// # Errors
    /// The system gives no threads, or takes the address away.
    pub fn run(self) -> Result<(), ServeError> {
        let failed = |error: std::io::Error| ServeError::System(error.to_string());
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .enable_all()
            .build()
            .map_err(failed)?;
        let app = self.app.clone();
        let routes = routes(self.app, self.guard);
        let served = runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            tokio::select! {
                () = accept(listener, routes) => {}
                () = interrupted() => {}
            }
            Ok(())
        });
        app.jobs.cancel_all();
        runtime.shutdown_timeout(GRACE);
        served.map_err(failed)
    }
}

fn listener(request: &ServeRequest) -> Result<TcpListener, ServeError> {
    let bind = |port| {
        let address = SocketAddr::new(request.host, port);
        TcpListener::bind(address).map_err(|source| ServeError::Listen { address, source })
    };
    match request.port {
        Some(port) => bind(port),
        None => bind(USUAL_PORT).or_else(|_| bind(0)),
    }
}

/// 128 random bits in hexadecimal.
fn token() -> Result<String, ServeError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| ServeError::System(error.to_string()))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

fn routes(app: App, guard: Arc<Guard>) -> Router {
    let campaign = Router::new()
        .route("/", get(campaigns::campaign))
        .route("/results", get(campaigns::results))
        .route("/measured", get(campaigns::measured))
        .route("/events", get(events::campaign_events))
        .route("/recordings", get(recordings::recordings))
        .route("/recording", get(recordings::recording))
        .route("/outline", get(recordings::outline))
        .route(
            "/raw",
            put(recordings::upload_recording).layer(DefaultBodyLimit::disable()),
        )
        .route(
            "/table",
            get(tables::table)
                .put(recordings::upload_table)
                .layer(DefaultBodyLimit::disable()),
        )
        .route("/refit", post(live::refit))
        .route("/figure", post(live::figure))
        .route("/text", put(changes::text))
        .route("/window", put(changes::window))
        .route("/exclusion", put(changes::exclusion))
        .route("/options", put(changes::options))
        .route("/rig", put(changes::rig))
        .route("/momentum", get(campaigns::momentum))
        .route("/note", put(changes::note))
        .route("/undo", get(changes::undone).post(changes::undo))
        .route("/kept", get(jobs::kept))
        .route("/channels", put(changes::channels))
        .route("/impacts", post(changes::impacts))
        .route("/jobs", post(jobs::start))
        .route("/regress", post(tables::regression))
        .route("/surface", post(tables::surfaces))
        .route("/card", get(files::card))
        .route("/report/{*file}", get(files::report));
    Router::new()
        .route("/api/about", get(about::about))
        .route("/api/rigs", get(campaigns::rigs))
        .route("/api/findings", get(about::findings))
        .route("/api/openapi.json", get(openapi::openapi))
        .route(
            "/api/campaigns",
            get(campaigns::campaigns).post(campaigns::create),
        )
        .nest("/api/campaigns/{id}", campaign)
        .route("/api/contours", post(tables::contours))
        .route("/api/scenes", get(scenes::scenes))
        .route("/api/scenes/{id}", get(scenes::scene))
        .route("/api/scenes/{id}/frames", get(scenes::frames))
        .route("/api/scenes/{id}/hardest", get(scenes::hardest))
        .route("/api/scenes/{id}/history", get(scenes::history))
        .route("/api/scenes/{id}/totals", get(scenes::totals))
        .route("/api/jobs", get(jobs::jobs))
        .route("/api/jobs/{job}", get(jobs::job).delete(jobs::cancel))
        .route("/api/jobs/{job}/events", get(events::job_events))
        .route("/api/{*unknown}", get(unknown))
        .method_not_allowed_fallback(not_allowed)
        .fallback(get(asset::asset))
        .layer(DefaultBodyLimit::max(MOST_BODY))
        .layer(from_fn_with_state(guard, guarded))
        .layer(compression())
        .with_state(app)
}

/// Compression of answers: quick rather than strong, as most go to this machine. Event
/// streams stay as they are, and so do pictures and the frames of scenes.
fn compression() -> CompressionLayer<impl Predicate> {
    let kinds = DefaultPredicate::new().and(NotForContentType::new("application/octet-stream"));
    let layer = CompressionLayer::new().quality(CompressionLevel::Fastest);
    layer.compress_when(kinds)
}

async fn unknown() -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "absent",
        "there is nothing at this address",
    )
}

async fn not_allowed() -> Problem {
    let detail = "this address does not know the method";
    Problem::new(StatusCode::METHOD_NOT_ALLOWED, "method", detail)
}
