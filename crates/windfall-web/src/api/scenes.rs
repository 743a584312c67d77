//! Results of scenes: the list, frames, and the history of each fruit.

use crate::app::{Answer, App};
use crate::described::QuestionProblems;
use crate::given::Asked;
use crate::problem::Problem;
use axum::extract::{Path, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::IntoParams;
use windfall_scene_run::frames::history::{
    FruitHistory, FruitTotals, HardestFruit, fruit_history, fruit_totals, hardest_fruit,
};
use windfall_workspace::scene_runs::{
    SceneEntry, SceneView, scene_frames_from, scene_fruit_count, scene_run, scene_runs, scene_view,
};

/// Default and largest number of fruit listed.
const USUAL: usize = 200;
const MOST: usize = 2000;

/// The first frame.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct FramesAsked {
    /// Number of the first frame, from 0.
    #[serde(default)]
    from: usize,
}

/// How many fruit.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct HardestAsked {
    /// Limit; 200 by default, 2000 at most.
    most: Option<usize>,
}

/// Which fruit.
#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(crate) struct FruitAsked {
    /// Its number, from 1.
    fruit: u64,
}

/// The results of scenes in the directory.
#[utoipa::path(get, path = "/api/scenes", responses((status = 200, body = Vec<SceneEntry>)))]
pub(crate) async fn scenes(State(app): State<App>) -> Answer<Vec<SceneEntry>> {
    let entries = app.work(|app| scene_runs(&app.workspace)).await?;
    app.tell(&entries)
}

/// A scene with its walls and the times of its frames.
#[utoipa::path(
    get, path = "/api/scenes/{id}", params(("id" = String, Path, example = "scene.run")),
    responses((status = 200, body = SceneView), QuestionProblems))]
pub(crate) async fn scene(State(app): State<App>, Path(id): Path<String>) -> Answer<SceneView> {
    let view = app.work(move |app| scene_view(&scene_run(&app.workspace, &id)?, id));
    app.tell(&view.await?)
}

/// Whole frames from a number on, as in frames.bin: about 4 MB of them, at least one;
/// none after the last.
#[utoipa::path(
    get, path = "/api/scenes/{id}/frames",
    params(("id" = String, Path, example = "scene.run"), FramesAsked),
    responses((status = 200, body = Vec<u8>, content_type = "application/octet-stream"), QuestionProblems))]
pub(crate) async fn frames(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FramesAsked>,
) -> Result<Response, Problem> {
    let bytes =
        app.work(move |app| scene_frames_from(&scene_run(&app.workspace, &id)?, asked.from));
    let headers = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((headers, bytes.await?).into_response())
}

/// The fruit that were hit hardest, hardest first.
#[utoipa::path(
    get, path = "/api/scenes/{id}/hardest",
    params(("id" = String, Path, example = "scene.run"), HardestAsked),
    responses((status = 200, body = Vec<HardestFruit>), QuestionProblems))]
pub(crate) async fn hardest(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<HardestAsked>,
) -> Answer<Vec<HardestFruit>> {
    let most = asked.most.unwrap_or(USUAL).min(MOST);
    let fruit = app.work(move |app| hardest_fruit(&scene_run(&app.workspace, &id)?, most));
    app.tell(&fruit.await?)
}

/// What the contacts of each fruit came to over the whole run.
#[utoipa::path(
    get, path = "/api/scenes/{id}/totals",
    params(("id" = String, Path, example = "scene.run")),
    responses((status = 200, body = FruitTotals), QuestionProblems))]
pub(crate) async fn totals(State(app): State<App>, Path(id): Path<String>) -> Answer<FruitTotals> {
    let totals = app.work(move |app| {
        let directory = scene_run(&app.workspace, &id)?;
        fruit_totals(&directory, scene_fruit_count(&directory)?)
    });
    app.tell(&totals.await?)
}

/// The contacts of a fruit.
#[utoipa::path(
    get, path = "/api/scenes/{id}/history",
    params(("id" = String, Path, example = "scene.run"), FruitAsked),
    responses((status = 200, body = FruitHistory), QuestionProblems))]
pub(crate) async fn history(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(asked): Asked<FruitAsked>,
) -> Answer<FruitHistory> {
    let history = app.work(move |app| {
        let directory = scene_run(&app.workspace, &id)?;
        fruit_history(&directory, asked.fruit, scene_fruit_count(&directory)?)
    });
    app.tell(&history.await?)
}
