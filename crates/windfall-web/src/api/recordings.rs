//! Recordings: the list, contents, outlines, uploads.

use crate::app::{Answer, App};
use crate::described::{QuestionProblems, UploadProblems};
use crate::given::Asked;
use crate::problem::Problem;
use axum::Json;
use axum::body::Body;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use tokio_stream::StreamExt;
use utoipa::{IntoParams, ToSchema};
use windfall_files::confined::{Arriving, discard};
use windfall_files::error::Error;
use windfall_files::provenance::digest_file;
use windfall_files::table::csv::read_table;
use windfall_inspect::run::{Inspection, inspect_opened};
use windfall_workspace::campaign_view::{RESULTS_TABLE, TABLES_DIRECTORY};
use windfall_workspace::live_cache::recording_inside;
use windfall_workspace::recording_outline::Outline;
use windfall_workspace::workspace::{RecordingEntry, recordings_inside, recordings_of};

/// Largest number of points of an outline.
const MOST_POINTS: usize = 20_000;

/// A file of a campaign.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct FileAsked {
    /// Its name, relative to the directory of its kind.
    #[param(example = "specimen-01-01.csv")]
    pub file: String,
}

/// A part of a channel.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct OutlineAsked {
    /// The recording.
    #[param(example = "specimen-01-01.csv")]
    file: String,
    /// The channel.
    #[param(example = "force_V")]
    channel: String,
    /// Start; s, or sample number if times are unknown.
    from: Option<f64>,
    /// End.
    to: Option<f64>,
    /// Number of points to return.
    points: Option<usize>,
}

/// An uploaded file.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct Uploaded {
    /// Its name.
    file: String,
    /// Its size.
    bytes: u64,
    /// Its digest.
    sha256: String,
    /// The output of `inspect`; `null` for a table.
    recording: Option<Inspection>,
}

/// The recordings of a campaign.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/recordings", params(("id" = String, Path, example = "bench")),
    responses((status = 200, body = Vec<RecordingEntry>), QuestionProblems))]
pub(crate) async fn recordings(
    State(app): State<App>,
    Path(id): Path<String>,
) -> Answer<Vec<RecordingEntry>> {
    app.answer(id, |_, directory| recordings_of(directory))
        .await
}

/// Contents of a recording, as `windfall inspect` shows them.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/recording", params(("id" = String, Path, example = "bench"), FileAsked),
    responses((status = 200, body = Inspection), QuestionProblems))]
pub(crate) async fn recording(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FileAsked>,
) -> Answer<Inspection> {
    let json = app.on_campaign(id, move |app, directory| {
        app.cache.inspection(directory, &asked.file)
    });
    let json = json.await?;
    Ok(app.tell_json(&json))
}

fn inspected(directory: &std::path::Path, file: &str) -> Result<Inspection, Error> {
    let (path, plan) = recording_inside(directory, file)?;
    let mut found = inspect_opened(&path, &plan.open, &[])?;
    file.clone_into(&mut found.file);
    Ok(found)
}

/// A part of a channel at the resolution of a screen.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/outline", params(("id" = String, Path, example = "bench"), OutlineAsked),
    responses((status = 200, body = Outline), QuestionProblems))]
pub(crate) async fn outline(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<OutlineAsked>,
) -> Answer<Outline> {
    app.answer(id, move |app, directory| {
        let points = asked.points.unwrap_or(1000).clamp(10, MOST_POINTS);
        let finite = |time: Option<f64>| time.filter(|time| time.is_finite());
        let part = (finite(asked.from), finite(asked.to));
        let names = (asked.file.as_str(), asked.channel.as_str());
        app.cache.outline(directory, names, part, points)
    })
    .await
}

/// Uploads a recording into the campaign; existing files are never replaced.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/raw", params(("id" = String, Path, example = "bench"), FileAsked),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 201, body = Uploaded), UploadProblems))]
pub(crate) async fn upload_recording(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FileAsked>,
    body: Body,
) -> Result<Response, Problem> {
    let own = id.clone();
    let folder = app.on_campaign(id, |_, directory| {
        Ok(recordings_inside(directory)?.directory)
    });
    let (path, bytes) = arrive(&app, folder.await?, asked.file.clone(), body).await?;
    let file = asked.file;
    let uploaded = app.on_campaign(own, move |_, directory| {
        // Unreadable files are not kept among the recordings.
        let recording = inspected(directory, &file).inspect_err(|_| discard(&path))?;
        Ok(Uploaded {
            sha256: digest_file(&path)?,
            file,
            bytes,
            recording: Some(recording),
        })
    });
    Ok((StatusCode::CREATED, Json(uploaded.await?)).into_response())
}

/// Uploads a table for regressions and surfaces; existing files are never replaced.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/table", params(("id" = String, Path, example = "bench"), FileAsked),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 201, body = Uploaded), UploadProblems))]
pub(crate) async fn upload_table(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FileAsked>,
    body: Body,
) -> Result<Response, Problem> {
    if !asked.file.to_lowercase().ends_with(".csv") {
        return Err(Problem::request(
            "a table is a CSV: give it a name that ends in .csv",
        ));
    }
    let own = id.clone();
    let folder = app.on_campaign(id, |_, directory| Ok(directory.to_path_buf()));
    let file = format!("{TABLES_DIRECTORY}/{}", asked.file);
    if file.eq_ignore_ascii_case(RESULTS_TABLE) {
        return Err(Problem::request(
            "windfall writes its own results into a table of this name: give yours another one",
        ));
    }
    let (path, bytes) = arrive(&app, folder.await?, file.clone(), body).await?;
    let uploaded = app.on_campaign(own, move |_, _| {
        read_table(&path).inspect_err(|_| discard(&path))?;
        Ok(Uploaded {
            sha256: digest_file(&path)?,
            file,
            bytes,
            recording: None,
        })
    });
    Ok((StatusCode::CREATED, Json(uploaded.await?)).into_response())
}

/// Streams a body to a file; returns its path and size.
async fn arrive(
    app: &App,
    folder: PathBuf,
    name: String,
    body: Body,
) -> Result<(PathBuf, u64), Problem> {
    let begun = app.work(move |_| Arriving::begin(&folder, &name));
    let mut file = begun.await?;
    let mut bytes = 0;
    let mut pieces = body.into_data_stream();
    while let Some(piece) = pieces.next().await {
        let piece = piece.map_err(|_| {
            Problem::request("the upload broke off; nothing of it was kept. Send it again")
        })?;
        bytes += piece.len() as u64;
        if bytes > app.upload_limit {
            return Err(Problem::new(
                StatusCode::PAYLOAD_TOO_LARGE,
                "too-large",
                format!(
                    "files of more than {} MB are not taken here; put it into the directory of \
                     recordings yourself, or start windfall serve with a larger --upload-limit",
                    app.upload_limit / 1_000_000
                ),
            ));
        }
        file = app.work(move |_| file.take(&piece).map(|()| file)).await?;
    }
    if bytes == 0 {
        return Err(Problem::request("the file is empty; nothing was kept"));
    }
    Ok((app.work(|_| file.end()).await?, bytes))
}
