//! Live fits of one impact, as its window and laws are changed.

use crate::app::{Answer, App};
use crate::described::RequestProblems;
use crate::given::Given;
use crate::problem::Problem;
use axum::extract::{Path, State};
use serde::Deserialize;
use utoipa::ToSchema;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_workspace::campaign_view::name_of;
use windfall_workspace::live_fit::{LiveOutcome, LiveRequest};

/// What to fit; what is left out is taken from the campaign.
#[derive(Debug, Default, Deserialize, ToSchema)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Refit {
    /// Id of the impact.
    #[schema(example = "specimen-01-01")]
    impact: String,
    /// Start of the used part of the recording; s.
    from: Option<f64>,
    /// Its end; s.
    to: Option<f64>,
    /// Laws as expressions.
    laws: Vec<String>,
    /// Parameters to estimate even though they have a value.
    free: Vec<String>,
    /// Quantities of the cost function.
    quantities: Vec<String>,
    /// Weights of the cost function.
    weights: Option<String>,
    /// Noise of the channels.
    noise: Option<String>,
    /// "asymptotic" or "profile".
    intervals: Option<String>,
    /// Time of first touch.
    onset: Option<String>,
    /// Velocity at first touch.
    initial_velocity: Option<String>,
    /// Zero of the displacement.
    displacement_offset: Option<String>,
    /// End of contact.
    end: Option<String>,
    /// Whether to return measured series and residuals.
    series: bool,
}

/// Fits one impact now; nothing is kept.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/refit", params(("id" = String, Path, example = "bench")), request_body = Refit,
    responses((status = 200, body = LiveOutcome), RequestProblems))]
pub(crate) async fn refit(
    State(app): State<App>,
    Path(id): Path<String>,
    Given(asked): Given<Refit>,
) -> Answer<LiveOutcome> {
    // Slow methods run as jobs of the whole campaign.
    let quick = ["asymptotic", "profile"];
    let intervals = asked.intervals.as_deref();
    if intervals.is_some_and(|word| !quick.contains(&word)) {
        return Err(Problem::request(
            "a live fit has asymptotic or profile intervals; set the others in the campaign and \
             fit it",
        ));
    }
    app.answer(id, move |app, directory| {
        let impact = app.cache.impact(directory, &asked.impact)?;
        let finite = |time: Option<f64>| time.filter(|time| time.is_finite());
        let request = LiveRequest {
            from: finite(asked.from),
            to: finite(asked.to),
            fit: FitRequest {
                laws: asked.laws,
                free: asked.free,
                quantities: asked.quantities,
                weights: asked.weights,
                noise: asked.noise,
                intervals: asked.intervals,
                onset: asked.onset,
                initial_velocity: asked.initial_velocity,
                displacement_offset: asked.displacement_offset,
                end: asked.end,
                ..FitRequest::default()
            },
            series: asked.series,
        };
        impact.refit(&request, &name_of(directory))
    })
    .await
}
