//! Jobs: fits, comparisons of laws, populations, calibrations, reports.

use crate::app::{Answer, App, Told};
use crate::described::{QuestionProblems, RequestProblems};
use crate::given::Given;
use crate::job::{Job, JobView, JobWork, ReportFiles, Work};
use crate::problem::Problem;
use axum::Json;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;
use utoipa::ToSchema;
use windfall_campaign::pipeline::request::FitRequest;
use windfall_drop::calibrate::run::{CalibrateRequest, calibrate};
use windfall_files::error::Error;
use windfall_files::text::quote::{command, path_word};
use windfall_population::ranking::run::rank_campaign;
use windfall_population::run::{PopulationRequest, population};
use windfall_report::fit_any::fit_any;
use windfall_report::run::{ReportRequest, report_campaign};
use windfall_report::stored_card::CARD_FILE;
use windfall_workspace::campaign_view::{check_work, name_of};
use windfall_workspace::equal_command::{command_of_fit, command_of_population};
use windfall_workspace::kept_work::{Keeping, kept_results, made_of};
use windfall_workspace::results_table::write_results_table;

/// A job to start.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct JobGiven {
    /// What to do.
    work: Work,
    /// Laws instead of the campaign's.
    #[serde(default)]
    laws: Vec<String>,
    /// Covariates of a population.
    #[serde(default)]
    covariates: Vec<String>,
    /// How intervals are computed.
    intervals: Option<String>,
}

impl JobGiven {
    fn fit(&self) -> FitRequest {
        FitRequest {
            laws: self.laws.clone(),
            intervals: self.intervals.clone(),
            ..FitRequest::default()
        }
    }

    fn command(&self, shown: &str) -> String {
        let fit = self.fit();
        match self.work {
            Work::Fit | Work::Laws | Work::Report => {
                command_of_fit(&[self.work.name(), shown], &fit)
            }
            Work::Population => command_of_population(shown, &fit, &self.covariates),
            Work::Calibrate => {
                let card = format!("{shown}/{CARD_FILE}");
                command(&["calibrate", shown, "--card", &card])
            }
        }
    }

    /// Does the work.
    fn run(&self, directory: PathBuf, job: &Job) -> Result<JobWork, Error> {
        let progress = |done: usize, all: usize| job.progress(done, all);
        check_work(&directory)?;
        Ok(match self.work {
            Work::Fit => {
                let outcome = fit_any(&directory, &self.fit(), &progress)?;
                if outcome.results() > 0 {
                    write_results_table(&directory, &outcome)?;
                }
                JobWork::Fit(done(outcome))
            }
            Work::Laws => JobWork::Laws(done(rank_campaign(&directory, &self.fit(), &progress)?)),
            Work::Population => {
                let request = PopulationRequest {
                    directory,
                    fit: self.fit(),
                    covariates: self.covariates.clone(),
                    ..PopulationRequest::default()
                };
                JobWork::Population(done(population(&request, &progress)?))
            }
            Work::Calibrate => {
                let request = CalibrateRequest {
                    card: Some(directory.join(CARD_FILE)),
                    ..CalibrateRequest::default()
                };
                JobWork::Calibrate(done(calibrate(&directory, &request, &progress)?))
            }
            Work::Report => {
                let request = ReportRequest {
                    fit: self.fit(),
                    ..ReportRequest::default()
                };
                let outcome = report_campaign(&directory, &request, &progress)?;
                let inside = |path: &PathBuf| {
                    let own = path.strip_prefix(&directory).unwrap_or(path);
                    own.display().to_string()
                };
                JobWork::Report(done(ReportFiles {
                    page: inside(&outcome.page),
                    files: outcome.files.iter().map(inside).collect(),
                    impacts: outcome.impacts,
                    failed: outcome.failed,
                }))
            }
        })
    }
}

fn done<T>(outcome: T) -> Option<Box<T>> {
    Some(Box::new(outcome))
}

/// Starts a job on a campaign.
#[utoipa::path(
    post, path = "/api/campaigns/{id}/jobs", params(("id" = String, Path, example = "bench")), request_body = JobGiven,
    responses((status = 202, body = JobView), RequestProblems))]
pub(crate) async fn start(
    State(app): State<App>,
    Path(id): Path<String>,
    Given(given): Given<JobGiven>,
) -> Result<Response, Problem> {
    let own = id.clone();
    let directory = app.on_campaign(id, |_, directory| Ok(directory.to_path_buf()));
    let directory = directory.await?;
    let command = given.command(&path_word(name_of(&directory)));
    let Some(job) = app.jobs.begin(&own, given.work, command) else {
        return Err(Problem::new(
            StatusCode::CONFLICT,
            "busy",
            "the same work runs on this campaign already; wait for it, or cancel it",
        ));
    };
    let (view, running) = (job.view(), app.clone());
    // On a thread of its own, so that requests are still answered.
    let begun = std::thread::Builder::new()
        .name("windfall job".to_owned())
        .spawn(move || work(&running, &given, directory, &job));
    begun.map_err(|error| Problem::internal(format!("no thread can be had: {error}")))?;
    Ok((StatusCode::ACCEPTED, Json(view)).into_response())
}

fn work(app: &App, given: &JobGiven, directory: PathBuf, job: &Arc<Job>) {
    /// Reports the end even if the work panics.
    struct Ending<'a>(&'a Job);
    impl Drop for Ending<'_> {
        fn drop(&mut self) {
            self.0
                .fail("windfall failed at this work; the terminal in which it runs says more");
        }
    }
    let ending = Ending(job);
    let keeping = Keeping::begin(&directory, given.work.name(), job.view().command);
    let result = given.run(directory.clone(), job);
    let done = result.is_ok();
    job.end(result, |error| app.told(error));
    drop(ending);
    // The result is shown whether it can be kept or not: a store may be read-only.
    if let (Some(keeping), true) = (keeping, done) {
        let shown = app.tell(&job.view()).map(Told::into_json).ok();
        let shown = shown.and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok());
        let _ = shown.map(|shown| keeping.end(&shown["result"]));
    }
}

/// A result that is kept in the store of a campaign.
#[derive(Debug, Serialize, ToSchema)]
pub(crate) struct KeptWork {
    /// When it was calculated; UTC.
    time: String,
    /// Whether the campaign has changed since.
    stale: bool,
    /// The work with its result.
    #[schema(value_type = JobView)]
    job: serde_json::Value,
}

/// The newest comparison of laws, population and calibration of a campaign, as they are kept in
/// its store.
#[utoipa::path(
    get, path = "/api/campaigns/{id}/kept", params(("id" = String, Path, example = "bench")),
    responses((status = 200, body = Vec<KeptWork>), QuestionProblems))]
pub(crate) async fn kept(State(app): State<App>, Path(id): Path<String>) -> Answer<Vec<KeptWork>> {
    app.answer(id.clone(), move |_, directory| {
        let kept = kept_results(directory)?;
        let now = match kept.is_empty() {
            true => None,
            false => Some(made_of(directory)?),
        };
        let works = kept.into_iter().map(|own| KeptWork {
            stale: Some(&own.made_of) != now.as_ref(),
            time: own.time,
            job: serde_json::json!({
                "job": "kept",
                "campaign": id,
                "work": own.work,
                "result": own.result,
                "state": "done",
                "done": 1,
                "all": 1,
                "problem": null,
                "command": own.command,
            }),
        });
        Ok(works.collect())
    })
    .await
}

/// All jobs since the server was started.
#[utoipa::path(get, path = "/api/jobs", responses((status = 200, body = Vec<JobView>)))]
pub(crate) async fn jobs(State(app): State<App>) -> Answer<Vec<JobView>> {
    app.tell(&app.jobs.list())
}

/// A job, with its result once it is done.
#[utoipa::path(
    get, path = "/api/jobs/{job}", params(("job" = String, Path)),
    responses((status = 200, body = JobView), (status = 404, body = Problem, content_type = "application/problem+json"))
)]
pub(crate) async fn job(State(app): State<App>, Path(job): Path<String>) -> Answer<JobView> {
    app.tell(&found(&app, &job)?.view())
}

/// Cancels a job; nothing unfinished is kept.
#[utoipa::path(
    delete, path = "/api/jobs/{job}", params(("job" = String, Path)),
    responses((status = 200, body = JobView), (status = 404, body = Problem, content_type = "application/problem+json"))
)]
pub(crate) async fn cancel(State(app): State<App>, Path(job): Path<String>) -> Answer<JobView> {
    let job = found(&app, &job)?;
    job.cancel();
    app.tell(&job.view())
}

/// A job by its name.
pub(crate) fn found(app: &App, name: &str) -> Result<Arc<Job>, Problem> {
    app.jobs.find(name).ok_or_else(|| {
        let detail = "there is no such work; the server may have been started anew meanwhile";
        Problem::new(StatusCode::NOT_FOUND, "absent", detail)
    })
}
