//! Progress and changes as server-sent events.

use crate::api::jobs::found;
use crate::app::{App, Told};
use crate::job::JobState;
use crate::problem::Problem;
use axum::extract::{Path, State};
use axum::response::Sse;
use axum::response::sse::{Event, KeepAlive};
use serde::Serialize;
use std::convert::Infallible;
use std::time::Duration;
use tokio_stream::wrappers::{IntervalStream, ReceiverStream};
use tokio_stream::{Stream, StreamExt};
use utoipa::ToSchema;
use windfall_workspace::campaign_view::campaign_stamp;

/// Least time between two events of progress.
const TICK: Duration = Duration::from_millis(100);

/// How often the files of a campaign are checked.
const LOOK: Duration = Duration::from_secs(1);

type Events<S> = Sse<axum::response::sse::KeepAliveStream<S>>;

/// The files of a campaign, or its store, have changed.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct CampaignChanged {
    /// The version of the campaign now.
    version: String,
}

/// Progress of a job until it ends: the data of each event is a `JobView`.
#[utoipa::path(
    get, path = "/api/jobs/{job}/events", params(("job" = String, Path)),
    responses(
        (status = 200, body = Object, content_type = "text/event-stream"),
        (status = 404, body = Problem, content_type = "application/problem+json"),
    )
)]
pub(crate) async fn job_events(
    State(app): State<App>,
    Path(job): Path<String>,
) -> Result<Events<impl Stream<Item = Result<Event, Infallible>>>, Problem> {
    let mut views = found(&app, &job)?.watch();
    let (send, events) = tokio::sync::mpsc::channel(1);
    tokio::spawn(async move {
        loop {
            let view = views.borrow_and_update().clone();
            let ended = view.state != JobState::Running;
            let name = if ended { "end" } else { "progress" };
            let text = app
                .tell(&view)
                .map_or_else(|problem| problem.detail, Told::into_json);
            let event = Ok(Event::default().event(name).data(text));
            // Nothing follows the end: the stream is closed.
            if send.send(event).await.is_err() || ended {
                return;
            }
            tokio::time::sleep(TICK).await;
            if views.changed().await.is_err() {
                return;
            }
        }
    });
    let events = ReceiverStream::new(events);
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}

/// Changes of a campaign's files or store on disk: the data of each event is a `CampaignChanged`.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/events", params(("id" = String, Path, example = "bench")),
    responses(
        (status = 200, body = Object, content_type = "text/event-stream"),
        (status = 404, body = Problem, content_type = "application/problem+json"),
    )
)]
pub(crate) async fn campaign_events(
    State(app): State<App>,
    Path(id): Path<String>,
) -> Result<Events<impl Stream<Item = Result<Event, Infallible>>>, Problem> {
    let directory = app.on_campaign(id, |_, directory| Ok(directory.to_path_buf()));
    let directory = directory.await?;
    let look = move |_| {
        let (app, directory) = (app.clone(), directory.clone());
        async move { app.work(move |_| campaign_stamp(&directory)).await.ok() }
    };
    let mut last = None;
    let stamps = IntervalStream::new(tokio::time::interval(LOOK)).then(look);
    let events = stamps.filter_map(move |stamp| {
        let stamp = stamp?;
        let before = last.replace(stamp.clone());
        // The first stamp is what the page has just read.
        (before? != stamp).then(|| {
            let changed = CampaignChanged {
                version: stamp.version,
            };
            let text = serde_json::to_string(&changed).unwrap_or_default();
            Ok(Event::default().event("changed").data(text))
        })
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::default()))
}
