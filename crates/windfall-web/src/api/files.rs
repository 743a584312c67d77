//! Files to download: law cards and reports.

use crate::app::App;
use crate::described::QuestionProblems;
use crate::given::Asked;
use crate::guard::REPORT_POLICY;
use crate::problem::Problem;
use axum::extract::{Path, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::IntoParams;
use windfall_files::confined::read_inside;
use windfall_report::run::REPORT_DIRECTORY;
use windfall_report::stored_card::stored_card;

/// The law of a card.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct CardAsked {
    /// Name of the law; ignored for campaigns of drops.
    #[serde(default)]
    law: String,
}

/// The law card of a campaign, as a download.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/card", params(("id" = String, Path, example = "bench"), CardAsked),
    responses((status = 200, body = String, content_type = "application/toml"), QuestionProblems))]
pub(crate) async fn card(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<CardAsked>,
) -> Result<Response, Problem> {
    let text = app.on_campaign(id, move |_, directory| stored_card(directory, &asked.law));
    let headers = [
        (header::CONTENT_TYPE, "application/toml; charset=utf-8"),
        (
            header::CONTENT_DISPOSITION,
            "attachment; filename=\"law.toml\"",
        ),
    ];
    Ok((headers, text.await?).into_response())
}

/// A file of the report of a campaign.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/report/{file}",
    params(("id" = String, Path, example = "bench"), ("file" = String, Path)),
    responses((status = 200, body = Vec<u8>, content_type = "text/html"), QuestionProblems))]
pub(crate) async fn report(
    State(app): State<App>,
    Path((id, file)): Path<(String, String)>,
) -> Result<Response, Problem> {
    let kind = match file.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("csv") => "text/csv; charset=utf-8",
        Some("json") => "application/json",
        _ => "text/plain; charset=utf-8",
    };
    let bytes = app.on_campaign(id, move |app, directory| {
        let bytes = read_inside(directory, &format!("{REPORT_DIRECTORY}/{file}"))?;
        Ok(match String::from_utf8(bytes) {
            Ok(text) => app.workspace.without_path(&text).into_bytes(),
            // A picture.
            Err(bytes) => bytes.into_bytes(),
        })
    });
    let headers = [
        (header::CONTENT_TYPE, kind),
        (header::CONTENT_SECURITY_POLICY, REPORT_POLICY),
    ];
    Ok((headers, bytes.await?).into_response())
}
