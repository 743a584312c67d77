//! The interface described (OpenAPI 3.1).

use crate::problem::Problem;
use axum::Json;
use utoipa::OpenApi;

/// The interface.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "windfall",
        description = "What the page of `windfall serve` uses. All numbers are SI. Results have \
                       the keys of the commands' JSON. Requests that change something need the \
                       header X-Windfall, changes of a campaign its version in If-Match.",
    ),
    paths(
        crate::about::about,
        crate::api_campaigns::campaigns,
        crate::api_campaigns::create,
        crate::api_campaigns::campaign,
        crate::api_campaigns::results,
        crate::api_recordings::recordings,
        crate::api_recordings::recording,
        crate::api_recordings::outline,
        crate::api_recordings::upload_recording,
        crate::api_recordings::upload_table,
        crate::api_live::refit,
        crate::api_changes::text,
        crate::api_changes::window,
        crate::api_changes::options,
        crate::api_changes::channels,
        crate::api_changes::impacts,
        crate::api_jobs::start,
        crate::api_jobs::jobs,
        crate::api_jobs::job,
        crate::api_jobs::cancel,
        crate::api_events::job_events,
        crate::api_events::campaign_events,
        crate::api_tables::table,
        crate::api_tables::regression,
        crate::api_tables::surfaces,
        crate::api_files::card,
        crate::api_files::report,
        crate::api_scenes::scenes,
        crate::api_scenes::scene,
        crate::api_scenes::frames,
        crate::api_scenes::hardest,
        crate::api_scenes::history,
    ),
    components(schemas(Problem))
)]
pub(crate) struct Interface;

/// The description itself.
pub(crate) async fn openapi() -> Json<utoipa::openapi::OpenApi> {
    Json(Interface::openapi())
}
