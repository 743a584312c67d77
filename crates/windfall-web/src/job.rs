//! Long work beside the requests: its progress is told, and it can be stopped.

use serde::{Serialize, Serializer};
use serde_json::value::RawValue;
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::watch;
use utoipa::ToSchema;
use windfall_files::error::Error;

/// Jobs that are remembered.
const REMEMBERED: usize = 100;

/// How a job stands.
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
    /// "fit", "laws", "population", "calibrate" or "report".
    pub work: &'static str,
    /// How it stands.
    pub state: JobState,
    /// Items done.
    pub done: usize,
    /// Of how many.
    pub all: usize,
    /// What the equal command would give in JSON, once it is done.
    #[schema(value_type = Option<Object>)]
    #[serde(serialize_with = "shared")]
    pub result: Option<Arc<RawValue>>,
    /// Why it failed.
    pub problem: Option<String>,
    /// The equal command.
    pub command: String,
}

fn shared<S: Serializer>(value: &Option<Arc<RawValue>>, serializer: S) -> Result<S::Ok, S::Error> {
    value.as_deref().serialize(serializer)
}

/// A job that runs, or has run.
pub(crate) struct Job {
    view: watch::Sender<JobView>,
    stop: AtomicBool,
}

impl Job {
    /// How it stands.
    pub(crate) fn view(&self) -> JobView {
        self.view.borrow().clone()
    }

    /// How it stands, again and again.
    pub(crate) fn watch(&self) -> watch::Receiver<JobView> {
        self.view.subscribe()
    }

    /// Asks it to stop.
    pub(crate) fn cancel(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Takes note of its progress; whether it goes on.
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

    /// Takes note of its end.
    pub(crate) fn end(
        &self,
        result: Result<Box<RawValue>, Error>,
        told: impl Fn(&Error) -> String,
    ) {
        self.view.send_modify(|view| match result {
            Ok(json) => {
                view.state = JobState::Done;
                view.result = Some(Arc::from(json));
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

    /// Takes note that windfall itself failed.
    pub(crate) fn fail(&self, problem: &str) {
        self.view.send_modify(|view| {
            if view.state == JobState::Running {
                view.state = JobState::Failed;
                view.problem = Some(problem.to_owned());
            }
        });
    }
}

/// All jobs since the start, the newest last.
#[derive(Default)]
pub(crate) struct Jobs {
    all: Mutex<VecDeque<Arc<Job>>>,
    next: AtomicUsize,
}

impl Jobs {
    fn lock(&self) -> std::sync::MutexGuard<'_, VecDeque<Arc<Job>>> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins a job; `None` where the same work runs on the same campaign already.
    pub(crate) fn begin(
        &self,
        campaign: &str,
        work: &'static str,
        command: String,
    ) -> Option<Arc<Job>> {
        let mut all = self.lock();
        let busy = all.iter().any(|job| {
            let view = job.view.borrow();
            view.state == JobState::Running && view.campaign == campaign && view.work == work
        });
        if busy {
            return None;
        }
        let number = 1 + self.next.fetch_add(1, Ordering::Relaxed);
        let view = JobView {
            job: number.to_string(),
            campaign: campaign.to_owned(),
            work,
            state: JobState::Running,
            done: 0,
            all: 0,
            result: None,
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
        let views = all.iter().map(|job| JobView {
            result: None,
            ..job.view()
        });
        views.collect()
    }

    /// Asks all to stop.
    pub(crate) fn cancel_all(&self) {
        self.lock().iter().for_each(|job| job.cancel());
    }
}
