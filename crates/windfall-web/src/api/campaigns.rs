//! Campaigns: the list, their files, their stored results.

use crate::app::{Answer, App};
use crate::described::{QuestionProblems, RequestProblems};
use crate::given::{Asked, Given};
use crate::problem::Problem;
use axum::Json;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};
use windfall_campaign::settings::template::{TEMPLATES, write_template};
use windfall_workspace::campaign_view::{CampaignView, view_campaign};
use windfall_workspace::measured_view::{MeasuredView, measured_view};
use windfall_workspace::rig_form::{MomentumView, RigForm, momentum_view, rig_forms};
use windfall_workspace::workspace::{CampaignEntry, Detail, StoredResults, stored_results};

/// A campaign to create.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NewCampaign {
    /// Name of its directory.
    id: String,
    /// "pendulum", "carriage", "drop", "compression", "acoustic" or "repeats".
    kind: String,
}

/// All campaigns of the directory.
#[utoipa::path(get, path = "/api/campaigns", responses((status = 200, body = Vec<CampaignEntry>)))]
pub(crate) async fn campaigns(State(app): State<App>) -> Answer<Vec<CampaignEntry>> {
    let entries = app.work(|app| app.workspace.campaigns()).await?;
    app.tell(&entries)
}

/// Makes a campaign from a template, as `windfall new` does.
#[utoipa::path(
    post, path = "/api/campaigns", request_body = NewCampaign,
    responses((status = 201, body = CampaignView), RequestProblems))]
pub(crate) async fn create(
    State(app): State<App>,
    Given(new): Given<NewCampaign>,
) -> Result<Response, Problem> {
    let Some(&(_, kind)) = TEMPLATES.iter().find(|(name, _)| *name == new.kind) else {
        let known = TEMPLATES.map(|(name, _)| name).join(", ");
        let detail = format!("kind \"{}\": expected one of {known}", new.kind);
        return Err(Problem::request(detail));
    };
    let view = app.work(move |app| {
        let directory = app.workspace.place(&new.id)?;
        write_template(kind, &directory)?;
        view_campaign(&directory)
    });
    let view = view.await?;
    Ok((StatusCode::CREATED, with_version(view)).into_response())
}

/// A campaign as its files describe it; its version is the ETag.
#[utoipa::path(
    get, path = "/api/campaigns/{id}", params(("id" = String, Path, example = "bench")),
    responses((status = 200, body = CampaignView), QuestionProblems))]
pub(crate) async fn campaign(
    State(app): State<App>,
    Path(id): Path<String>,
) -> Result<Response, Problem> {
    let view = app.on_campaign(id, |_, directory| view_campaign(directory));
    Ok(with_version(view.await?).into_response())
}

/// A campaign with its version as ETag.
pub(crate) fn with_version(view: CampaignView) -> (HeaderMap, Json<CampaignView>) {
    let mut headers = HeaderMap::new();
    if let Ok(version) = HeaderValue::from_str(&format!("\"{}\"", view.version)) {
        headers.insert(header::ETAG, version);
    }
    (headers, Json(view))
}

/// What a form asks of the rig of each kind of campaign.
#[utoipa::path(get, path = "/api/rigs", responses((status = 200, body = Vec<RigForm>)))]
pub(crate) async fn rigs(State(app): State<App>) -> Answer<Vec<RigForm>> {
    let forms = app.work(|_| rig_forms()).await?;
    app.tell(&forms)
}

/// What impulse and momentum of the first recordings say of the mass of the rig.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/momentum", params(("id" = String, Path, example = "bench")),
    responses((status = 200, body = MomentumView), QuestionProblems))]
pub(crate) async fn momentum(
    State(app): State<App>,
    Path(id): Path<String>,
) -> Answer<MomentumView> {
    app.answer(id, |_, directory| momentum_view(directory))
        .await
}

/// How much of the results.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct ResultsAsked {
    /// How much of each impact; all of it if left out.
    #[param(example = "brief")]
    impacts: Option<Detail>,
}

/// Stored results for the current files and options; nothing is fitted.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/results",
    params(("id" = String, Path, example = "bench"), ResultsAsked),
    responses((status = 200, body = StoredResults), QuestionProblems))]
pub(crate) async fn results(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<ResultsAsked>,
) -> Answer<StoredResults> {
    let detail = asked.impacts.unwrap_or_default();
    app.answer(id, move |_, directory| stored_results(directory, detail))
        .await
}

/// What of a campaign that fits no impacts.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct MeasuredAsked {
    /// Id of a recording; the whole if left out.
    item: Option<String>,
}

/// Stored results of a campaign that fits no impacts, as the report shows them; nothing is
/// evaluated.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/measured",
    params(("id" = String, Path, example = "drops"), MeasuredAsked),
    responses((status = 200, body = MeasuredView), QuestionProblems))]
pub(crate) async fn measured(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<MeasuredAsked>,
) -> Answer<MeasuredView> {
    app.answer(id, move |_, directory| {
        measured_view(directory, asked.item.as_deref())
    })
    .await
}
