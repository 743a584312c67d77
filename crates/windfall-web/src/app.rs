//! State shared by all requests.

use crate::job::Jobs;
use crate::problem::Problem;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio::sync::Semaphore;
use windfall_files::error::Error;
use windfall_workspace::live_cache::LiveCache;
use windfall_workspace::workspace::Workspace;

/// Blocking tasks that run at once; further ones wait.
const AT_ONCE: usize = 8;

/// An answer in JSON, or what went wrong.
pub(crate) type Answer<T> = Result<Told<T>, Problem>;

/// A value as JSON, without paths of the machine.
pub(crate) struct Told<T> {
    json: String,
    of: PhantomData<T>,
}

impl<T> Told<T> {
    /// The text of it.
    pub(crate) fn into_json(self) -> String {
        self.json
    }
}

impl<T> IntoResponse for Told<T> {
    fn into_response(self) -> Response {
        ([(header::CONTENT_TYPE, "application/json")], self.json).into_response()
    }
}

/// State shared by all requests.
pub(crate) struct Shared {
    /// The directory that is served.
    pub workspace: Workspace,
    /// Recordings in memory.
    pub cache: LiveCache,
    /// Jobs.
    pub jobs: Jobs,
    /// Size limit of an upload; bytes.
    pub upload_limit: u64,
    permits: Semaphore,
}

/// A handle on it.
#[derive(Clone)]
pub(crate) struct App(Arc<Shared>);

impl std::ops::Deref for App {
    type Target = Shared;
    fn deref(&self) -> &Shared {
        &self.0
    }
}

impl Shared {
    /// A value as JSON, without paths of the machine.
    pub(crate) fn tell<T: Serialize>(&self, value: &T) -> Answer<T> {
        let json = serde_json::to_string(value).map_err(|e| Problem::internal(e.to_string()))?;
        Ok(self.tell_json(&json))
    }

    /// A value that is JSON already, without paths of the machine.
    pub(crate) fn tell_json<T>(&self, json: &str) -> Told<T> {
        Told {
            json: self.workspace.without_path(json),
            of: PhantomData,
        }
    }
}

impl App {
    pub fn new(workspace: Workspace, upload_limit: u64) -> Self {
        Self(Arc::new(Shared {
            workspace,
            cache: LiveCache::default(),
            jobs: Jobs::default(),
            upload_limit,
            permits: Semaphore::new(AT_ONCE),
        }))
    }

    /// An error as an answer, without paths of the machine.
    pub(crate) fn problem(&self, error: &Error) -> Problem {
        Problem::of(error, self.told(error))
    }

    /// The text of an error without paths of the machine.
    pub(crate) fn told(&self, error: &Error) -> String {
        self.workspace.without_path(&error.to_string())
    }

    /// Runs slow or file-reading work off the request threads.
    pub(crate) async fn work<T: Send + 'static>(
        &self,
        work: impl FnOnce(&Shared) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Problem> {
        let _permit = self.permits.acquire().await;
        let app = self.clone();
        match tokio::task::spawn_blocking(move || work(&app)).await {
            Ok(result) => result.map_err(|error| self.problem(&error)),
            Err(_) => Err(Problem::internal(
                "windfall failed at this request; the terminal in which it runs says more. \
                 Nothing was changed",
            )),
        }
    }

    /// [`App::work`] on a campaign, with its directory.
    pub(crate) async fn on_campaign<T: Send + 'static>(
        &self,
        id: String,
        work: impl FnOnce(&Shared, &Path) -> Result<T, Error> + Send + 'static,
    ) -> Result<T, Problem> {
        self.work(move |app| {
            let directory: PathBuf = app.workspace.campaign(&id)?;
            work(app, &directory)
        })
        .await
    }

    /// [`App::on_campaign`] whose result is the answer.
    pub(crate) async fn answer<T: Serialize + Send + 'static>(
        &self,
        id: String,
        work: impl FnOnce(&Shared, &Path) -> Result<T, Error> + Send + 'static,
    ) -> Answer<T> {
        self.on_campaign(id, move |app, directory| {
            work(app, directory).map(|value| app.tell(&value))
        })
        .await?
    }
}
