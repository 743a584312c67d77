//! Failures as answers (RFC 9457, `application/problem+json`).

use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;
use windfall_campaign::store::error::StoreError;
use windfall_files::error::Error;

/// A failure.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub(crate) struct Problem {
    /// The status in words.
    pub title: String,
    /// HTTP status.
    pub status: u16,
    /// What is wrong, where, and what to do.
    pub detail: String,
    /// Short name for programs.
    pub code: &'static str,
}

impl Problem {
    /// A problem of a status.
    pub fn new(status: StatusCode, code: &'static str, detail: impl Into<String>) -> Self {
        Self {
            title: status.canonical_reason().unwrap_or_default().to_owned(),
            status: status.as_u16(),
            detail: detail.into(),
            code,
        }
    }

    /// A malformed request.
    pub(crate) fn request(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "request", detail)
    }

    /// A bug or failure of windfall itself.
    pub(crate) fn internal(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, "internal", detail)
    }

    /// An error of a workflow; `text` is how it reads here.
    pub fn of(error: &Error, text: String) -> Self {
        let (status, code) = match error {
            Error::Room(problem) if problem.is_absence() => (StatusCode::NOT_FOUND, "absent"),
            Error::CampaignUnknown { .. }
            | Error::ImpactUnknown { .. }
            | Error::FileAbsent { .. } => (StatusCode::NOT_FOUND, "absent"),
            Error::AlreadyThere { .. } => (StatusCode::CONFLICT, "exists"),
            Error::ChangedMeanwhile => (StatusCode::PRECONDITION_FAILED, "changed-meanwhile"),
            Error::ChangedSince { .. } => (StatusCode::CONFLICT, "changed-since"),
            Error::NameRefused { .. } => (StatusCode::BAD_REQUEST, "name"),
            Error::RecordingsElsewhere => (StatusCode::FORBIDDEN, "elsewhere"),
            Error::Cancelled => (StatusCode::CONFLICT, "cancelled"),
            Error::FileAccess { source, .. }
                if source.kind() == std::io::ErrorKind::StorageFull =>
            {
                (StatusCode::INSUFFICIENT_STORAGE, "disk-full")
            }
            Error::FileAccess { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                (StatusCode::NOT_FOUND, "absent")
            }
            Error::FileAccess { .. } => (StatusCode::INTERNAL_SERVER_ERROR, "files"),
            Error::Room(_) if error.of_room::<StoreError>().is_some() => {
                (StatusCode::INTERNAL_SERVER_ERROR, "files")
            }
            _ => (StatusCode::UNPROCESSABLE_ENTITY, "unusable"),
        };
        Self::new(status, code, text)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::BAD_REQUEST);
        let mut response = (status, Json(self)).into_response();
        let kind = HeaderValue::from_static("application/problem+json");
        response.headers_mut().insert(header::CONTENT_TYPE, kind);
        response
    }
}
