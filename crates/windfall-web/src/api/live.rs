//! Live fits of one impact, as its window and laws are changed, and figures for a paper.

use crate::app::{Answer, App};
use crate::described::RequestProblems;
use crate::given::Given;
use crate::problem::Problem;
use axum::extract::{Path, State};
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use utoipa::ToSchema;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_draw::files::FigureFormat;
use windfall_draw::theme::FigureTheme;
use windfall_draw::width::Width;
use windfall_draw::xy::drawing_of_figure;
use windfall_files::option_value::unusable;
use windfall_workspace::campaign_view::name_of;
use windfall_workspace::live_fit::{LiveOutcome, LiveRequest};
use windfall_workspace::measured_view::measured_figure;

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
    asked.check()?;
    app.answer(id, move |app, directory| {
        let impact = app.cache.impact(directory, &asked.impact)?;
        impact.refit(&asked.request(), &name_of(directory))
    })
    .await
}

impl Refit {
    /// Refuses what takes too long for one request.
    fn check(&self) -> Result<(), Problem> {
        // Slow methods run as jobs of the whole campaign.
        let quick = ["asymptotic", "profile"];
        let intervals = self.intervals.as_deref();
        if intervals.is_some_and(|word| !quick.contains(&word)) {
            return Err(Problem::request(
                "a live fit has asymptotic or profile intervals; set the others in the campaign \
                 and fit it",
            ));
        }
        Ok(())
    }

    fn request(self) -> LiveRequest {
        let finite = |time: Option<f64>| time.filter(|time| time.is_finite());
        LiveRequest {
            from: finite(self.from),
            to: finite(self.to),
            fit: FitRequest {
                laws: self.laws,
                free: self.free,
                quantities: self.quantities,
                weights: self.weights,
                noise: self.noise,
                intervals: self.intervals,
                onset: self.onset,
                initial_velocity: self.initial_velocity,
                displacement_offset: self.displacement_offset,
                end: self.end,
                ..FitRequest::default()
            },
            series: self.series,
        }
    }
}

/// A figure to draw for a paper.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FigureGiven {
    /// An impact and what is fitted to it.
    fit: Option<Refit>,
    /// In place of it: the name of a figure of a campaign that fits no impacts.
    figure: Option<String>,
    /// The recording that the figure shows; the whole campaign if left out.
    item: Option<String>,
    /// Width in print: "84 mm"; as large as a screen shows it if left out.
    width: Option<String>,
    /// Kind of file.
    format: Format,
}

/// A kind of file of figures.
#[derive(Clone, Copy, Debug, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
#[schema(as = FigureFormat)]
pub(crate) enum Format {
    /// Vectors for pages and editors.
    Svg,
    /// Vectors for journals.
    Pdf,
    /// 300 dots per inch.
    Png,
}

/// A figure as `fit --figures` draws it, as a download.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/figure", params(("id" = String, Path, example = "bench")), request_body = FigureGiven,
    responses((status = 200, body = Vec<u8>, content_type = "application/octet-stream"), RequestProblems))]
pub(crate) async fn figure(
    State(app): State<App>,
    Path(id): Path<String>,
    Given(asked): Given<FigureGiven>,
) -> Result<Response, Problem> {
    if let Some(fit) = &asked.fit {
        fit.check()?;
    }
    let (format, kind) = match asked.format {
        Format::Svg => (FigureFormat::Svg, "image/svg+xml"),
        Format::Pdf => (FigureFormat::Pdf, "application/pdf"),
        Format::Png => (FigureFormat::Png, "image/png"),
    };
    let bytes = app.on_campaign(id, move |app, directory| {
        let width = asked
            .width
            .as_deref()
            .map(str::parse::<Width>)
            .transpose()?;
        let figure = match (asked.fit, asked.figure) {
            (Some(fit), None) => {
                let impact = app.cache.impact(directory, &fit.impact)?;
                impact.figure(&fit.request())?
            }
            (None, Some(name)) => measured_figure(directory, asked.item.as_deref(), &name)?,
            _ => return Err(unusable("figure", "give either the name of one or a fit")),
        };
        format.of_svg(&drawing_of_figure(&figure, width).svg(FigureTheme::Light.colours()))
    });
    Ok(([(header::CONTENT_TYPE, kind)], bytes.await?).into_response())
}
