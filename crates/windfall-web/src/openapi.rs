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
        crate::api::campaigns::campaigns,
        crate::api::campaigns::create,
        crate::api::campaigns::campaign,
        crate::api::campaigns::results,
        crate::api::recordings::recordings,
        crate::api::recordings::recording,
        crate::api::recordings::outline,
        crate::api::recordings::upload_recording,
        crate::api::recordings::upload_table,
        crate::api::live::refit,
        crate::api::changes::text,
        crate::api::changes::window,
        crate::api::changes::options,
        crate::api::changes::channels,
        crate::api::changes::impacts,
        crate::api::jobs::start,
        crate::api::jobs::jobs,
        crate::api::jobs::job,
        crate::api::jobs::cancel,
        crate::api::events::job_events,
        crate::api::events::campaign_events,
        crate::api::tables::table,
        crate::api::tables::regression,
        crate::api::tables::surfaces,
        crate::api::files::card,
        crate::api::files::report,
        crate::api::scenes::scenes,
        crate::api::scenes::scene,
        crate::api::scenes::frames,
        crate::api::scenes::hardest,
        crate::api::scenes::history,
    ),
    components(schemas(Problem))
)]
pub(crate) struct Interface;

/// The description itself.
pub(crate) async fn openapi() -> Json<utoipa::openapi::OpenApi> {
    Json(Interface::openapi())
}
