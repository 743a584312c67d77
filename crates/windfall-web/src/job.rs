//! Jobs that run beside the requests, report progress and can be cancelled.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::watch;
use utoipa::ToSchema;
use windfall_drop::calibrate::outcome::CalibrateOutcome;
use windfall_files::error::Error;
use windfall_measure::any_outcome::AnyOutcome;
use windfall_population::outcome::PopulationOutcome;
use windfall_population::ranking::outcome::LawsOutcome;

/// Jobs that are kept in memory.
const REMEMBERED: usize = 100;

/// Kinds of jobs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Work {
    Fit,
    Laws,
    Population,
    Calibrate,
    Report,
}

impl Work {
    /// Its name, also that of the equal command.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Laws => "laws",
            Self::Population => "population",
            Self::Calibrate => "calibrate",
            Self::Report => "report",
        }
    }
}

/// What a report consists of; names are those below the campaign.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub(crate) struct ReportFiles {
    /// The page.
    pub page: String,
    /// All files.
    pub files: Vec<String>,
    /// Results in it.
    pub impacts: usize,
    /// What could not be evaluated.
    pub failed: usize,
}

/// Work with what the equal command gives in JSON, once it is done.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(tag = "work", content = "result", rename_all = "kebab-case")]
pub(crate) enum JobWork {
    Fit(Option<Box<AnyOutcome>>),
    Laws(Option<Box<LawsOutcome>>),
    Population(Option<Box<PopulationOutcome>>),
    Calibrate(Option<Box<CalibrateOutcome>>),
    Report(Option<Box<ReportFiles>>),
}

impl JobWork {
    /// Work without a result.
    fn begun(work: Work) -> Self {
        match work {
            Work::Fit => Self::Fit(None),
            Work::Laws => Self::Laws(None),
            Work::Population => Self::Population(None),
            Work::Calibrate => Self::Calibrate(None),
            Work::Report => Self::Report(None),
        }
    }

    /// Its kind.
    fn kind(&self) -> Work {
        match self {
            Self::Fit(_) => Work::Fit,
            Self::Laws(_) => Work::Laws,
            Self::Population(_) => Work::Population,
            Self::Calibrate(_) => Work::Calibrate,
            Self::Report(_) => Work::Report,
        }
    }
}

/// State of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum JobState {
    Running,
    Done,
    Failed,
    Cancelled,
}

/// A job as it is shown.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub(crate) struct JobView {
    /// Its name in addresses.
    pub job: String,
    /// The campaign.
    pub campaign: String,
    /// What it does, and its result.
    #[serde(flatten)]
    pub work: JobWork,
    /// Its state.
    pub state: JobState,
    /// Items done.
    pub done: usize,
    /// Items in all.
    pub all: usize,
    /// Why it failed.
    pub problem: Option<String>,
    /// The equal command.
    pub command: String,
}

impl JobView {
    fn without_result(&self) -> Self {
        Self {
            job: self.job.clone(),
            campaign: self.campaign.clone(),
            work: JobWork::begun(self.work.kind()),
            problem: self.problem.clone(),
            command: self.command.clone(),
            ..*self
        }
    }
}

/// A job that runs, or has run.
pub(crate) struct Job {
    view: watch::Sender<JobView>,
    stop: AtomicBool,
}

impl Job {
    /// Its state.
    pub(crate) fn view(&self) -> JobView {
        self.view.borrow().clone()
    }

    /// Its state as it changes.
    pub(crate) fn watch(&self) -> watch::Receiver<JobView> {
        self.view.subscribe()
    }

    /// Requests cancellation.
    pub(crate) fn cancel(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Records progress; breaks if the job was cancelled.
    pub(crate) fn progress(&self, done: usize, all: usize) -> ControlFlow<()> {
        self.view.send_modify(|view| {
            view.done = done.max(view.done);
            view.all = all;
        });
        match self.stop.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Records the end.
    pub(crate) fn end(&self, result: Result<JobWork, Error>, told: impl Fn(&Error) -> String) {
        self.view.send_modify(|view| match result {
            Ok(done) => {
                view.state = JobState::Done;
                view.work = done;
            }
            Err(Error::Cancelled) => {
                view.state = JobState::Cancelled;
                view.problem = Some(told(&Error::Cancelled));
            }
            Err(error) => {
                view.state = JobState::Failed;
                view.problem = Some(told(&error));
            }
        });
    }

    /// Records a failure of windfall itself.
    pub(crate) fn fail(&self, problem: &str) {
        self.view.send_modify(|view| {
            if view.state == JobState::Running {
                view.state = JobState::Failed;
                view.problem = Some(problem.to_owned());
            }
        });
    }
}

/// All jobs since the start, newest last.
#[derive(Default)]
pub(crate) struct Jobs {
    all: Mutex<VecDeque<Arc<Job>>>,
    next: AtomicUsize,
}

impl Jobs {
    fn lock(&self) -> std::sync::MutexGuard<'_, VecDeque<Arc<Job>>> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a job; `None` if the same work is already running on the campaign.
    pub(crate) fn begin(&self, campaign: &str, work: Work, command: String) -> Option<Arc<Job>> {
        let mut all = self.lock();
        let busy = all.iter().any(|job| {
            let view = job.view.borrow();
            view.state == JobState::Running && view.campaign == campaign && view.work.kind() == work
        });
        if busy {
            return None;
        }
        let number = 1 + self.next.fetch_add(1, Ordering::Relaxed);
        let view = JobView {
            job: number.to_string(),
            campaign: campaign.to_owned(),
            work: JobWork::begun(work),
            state: JobState::Running,
            done: 0,
            all: 0,
            problem: None,
            command,
        };
        let job = Arc::new(Job {
            view: watch::Sender::new(view),
            stop: AtomicBool::new(false),
        });
        all.push_back(job.clone());
        if all.len() > REMEMBERED {
            let ended = |job: &Arc<Job>| job.view.borrow().state != JobState::Running;
            if let Some(oldest) = all.iter().position(ended) {
                all.remove(oldest);
            }
        }
        Some(job)
    }

    /// A job by its name.
    pub(crate) fn find(&self, name: &str) -> Option<Arc<Job>> {
        let all = self.lock();
        let found = all.iter().find(|job| job.view.borrow().job == name);
        found.cloned()
    }

    /// All jobs without their results.
    pub(crate) fn list(&self) -> Vec<JobView> {
        let all = self.lock();
        let views = all.iter().map(|job| job.view.borrow().without_result());
        views.collect()
    }

    /// Cancels all jobs.
    pub(crate) fn cancel_all(&self) {
        self.lock().iter().for_each(|job| job.cancel());
    }
}
