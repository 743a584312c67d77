//! Changes to a campaign's files; each names the version it is based on.

use crate::api::campaigns::with_version;
use crate::app::{Answer, App};
use crate::described::{ChangeProblems, QuestionProblems};
use crate::given::{Asked, Given, Version};
use crate::problem::Problem;
use axum::extract::{Path, State};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use std::collections::BTreeMap;
use utoipa::{IntoParams, ToSchema};
use windfall_workspace::campaign_view::CampaignView;
use windfall_workspace::edit_campaign::{
    Change, ChannelsChange, NewImpact, OptionsChange, change_campaign, undo_change,
};
use windfall_workspace::undo::{FileBeside, Way, beside};

/// The whole of campaign.toml.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TextGiven {
    /// The text.
    text: String,
}

/// The part of the recording that an impact uses.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct WindowGiven {
    /// Id of the impact.
    impact: String,
    /// Its start; s.
    from: Option<f64>,
    /// Its end; s.
    to: Option<f64>,
}

/// Whether an impact counts.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExclusionGiven {
    /// Id of the impact.
    impact: String,
    /// Whether it is left out.
    excluded: bool,
    /// Why; what there is stays where this is blank.
    #[serde(default)]
    note: String,
}

/// A note; a blank one takes away what is there.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct NoteGiven {
    /// Id of the impact that it is on; the campaign if left out.
    impact: Option<String>,
    /// The note.
    note: String,
}

/// A way through the changes.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct UndoGiven {
    /// Whether the newest change is undone, or the one done again that was undone last.
    way: Way,
}

/// A way through the changes.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct WayAsked {
    /// Which change: the newest, or the one that was undone last.
    #[param(example = "undo")]
    way: Way,
}

/// Options of the fit; those left out are unchanged.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct OptionsGiven {
    laws: Option<Vec<String>>,
    free: Option<Vec<String>>,
    quantities: Option<Vec<String>>,
    weights: Option<String>,
    noise: Option<String>,
    intervals: Option<String>,
    onset: Option<String>,
    initial_velocity: Option<String>,
    displacement_offset: Option<String>,
    end: Option<String>,
    /// Column by which results are grouped; empty for none.
    group: Option<String>,
}

/// Keys of `[rig]`; those left out are unchanged.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RigGiven {
    /// Values with their units, by key; a blank one removes the key.
    keys: BTreeMap<String, String>,
}

/// Further impacts.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ImpactsGiven {
    /// Rows of impacts.csv.
    impacts: Vec<NewImpact>,
}

async fn changed(
    app: App,
    id: String,
    version: String,
    change: Change,
) -> Result<Response, Problem> {
    let view = app.on_campaign(id, move |_, directory| {
        change_campaign(directory, &version, &change)
    });
    Ok(with_version(view.await?).into_response())
}

/// Replaces campaign.toml.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/text", request_body = TextGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn text(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<TextGiven>,
) -> Result<Response, Problem> {
    changed(app, id, version, Change::Text(given.text)).await
}

/// Sets from_s and to_s of an impact.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/window", request_body = WindowGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn window(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<WindowGiven>,
) -> Result<Response, Problem> {
    let times = [given.from, given.to].into_iter().flatten();
    if times.clone().any(|time| !time.is_finite()) || given.from >= given.to && times.count() == 2 {
        return Err(Problem::request("a window begins before it ends"));
    }
    let change = Change::Window {
        impact: given.impact,
        from: given.from,
        to: given.to,
    };
    changed(app, id, version, change).await
}

/// Leaves an impact out of means, cards and figures, or lets it count again.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/exclusion", request_body = ExclusionGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn exclusion(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<ExclusionGiven>,
) -> Result<Response, Problem> {
    if given.note.chars().any(char::is_control) {
        return Err(Problem::request("a note is one line"));
    }
    let change = Change::Exclusion {
        impact: given.impact,
        excluded: given.excluded,
        note: given.note,
    };
    changed(app, id, version, change).await
}

/// Sets the note on an impact, whether it counts or not, or the one on the campaign.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/note", request_body = NoteGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn note(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<NoteGiven>,
) -> Result<Response, Problem> {
    let mut unusual = given.note.chars().filter(|c| c.is_control());
    let change = match given.impact {
        Some(_) if unusual.next().is_some() => {
            return Err(Problem::request("a note on an impact is one line"));
        }
        None if unusual.any(|c| c != '\n') => {
            return Err(Problem::request("a note consists of lines of text"));
        }
        Some(impact) => Change::Note {
            impact,
            note: given.note,
        },
        None => Change::CampaignNote(given.note),
    };
    changed(app, id, version, change).await
}

/// Undoes the newest change that was made here, or does the one again that was undone last.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/undo", request_body = UndoGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn undo(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<UndoGiven>,
) -> Result<Response, Problem> {
    let view = app.on_campaign(id, move |_, directory| {
        undo_change(directory, &version, given.way)
    });
    Ok(with_version(view.await?).into_response())
}

/// The files of the newest change as they are, and as undoing it would make them.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/undo",
    params(("id" = String, Path, example = "bench"), WayAsked),
    responses((status = 200, body = Vec<FileBeside>), QuestionProblems))]
pub(crate) async fn undone(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<WayAsked>,
) -> Answer<Vec<FileBeside>> {
    app.answer(id, move |_, directory| beside(directory, asked.way))
        .await
}

/// Sets options of the fit.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/options", request_body = OptionsGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn options(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<OptionsGiven>,
) -> Result<Response, Problem> {
    let lists = [
        ("laws", given.laws),
        ("free", given.free),
        ("quantities", given.quantities),
    ];
    let words = [
        ("weights", given.weights),
        ("noise", given.noise),
        ("intervals", given.intervals),
        ("onset", given.onset),
        ("initial_velocity", given.initial_velocity),
        ("displacement_offset", given.displacement_offset),
        ("end", given.end),
    ];
    let change = OptionsChange {
        lists: present(lists),
        words: present(words),
        group: given.group,
    };
    changed(app, id, version, Change::Options(change)).await
}

fn present<T, const N: usize>(pairs: [(&str, Option<T>); N]) -> BTreeMap<String, T> {
    let given = pairs.into_iter();
    given
        .filter_map(|(key, value)| Some((key.to_owned(), value?)))
        .collect()
}

/// Says what the rig is.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/rig", request_body = RigGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn rig(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<RigGiven>,
) -> Result<Response, Problem> {
    changed(app, id, version, Change::Rig(given.keys)).await
}

/// Sets the columns of the channels.
#[utoipa::path(
    put, path = "/api/campaigns/{id}/channels", request_body = ChannelsChange,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn channels(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<ChannelsChange>,
) -> Result<Response, Problem> {
    changed(app, id, version, Change::Channels(given)).await
}

/// Adds impacts, and specimens that are new.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/impacts", request_body = ImpactsGiven,
    params(("id" = String, Path, example = "bench"), ("If-Match" = String, Header, example = "*")),
    responses((status = 200, body = CampaignView), ChangeProblems))]
pub(crate) async fn impacts(
    State(app): State<App>,
    Path(id): Path<String>,
    Version(version): Version,
    Given(given): Given<ImpactsGiven>,
) -> Result<Response, Problem> {
    changed(app, id, version, Change::Impacts(given.impacts)).await
}
