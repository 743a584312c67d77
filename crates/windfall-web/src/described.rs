//! Problems that requests can meet, for the description of the interface.

use axum::http::StatusCode;
use std::collections::BTreeMap;
use utoipa::IntoResponses;
use utoipa::openapi::{ContentBuilder, Ref, RefOr, Response, ResponseBuilder};

/// Problems of a change to a campaign.
pub(crate) struct ChangeProblems;

impl IntoResponses for ChangeProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        problems(&[400, 403, 404, 409, 412, 415, 422, 428])
    }
}

/// Problems of a request with a body.
pub(crate) struct RequestProblems;

impl IntoResponses for RequestProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        problems(&[400, 404, 409, 415, 422])
    }
}

/// Problems of a query about a campaign or one of its files.
pub(crate) struct QuestionProblems;

impl IntoResponses for QuestionProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        problems(&[400, 403, 404, 422])
    }
}

/// Problems of an upload.
pub(crate) struct UploadProblems;

impl IntoResponses for UploadProblems {
    fn responses() -> BTreeMap<String, RefOr<Response>> {
        problems(&[400, 403, 404, 409, 413, 422])
    }
}

fn problems(statuses: &[u16]) -> BTreeMap<String, RefOr<Response>> {
    let problem = |status: &u16| {
        let words = StatusCode::from_u16(*status).ok();
        let words = words.and_then(|status| status.canonical_reason());
        let schema = Ref::from_schema_name("Problem");
        let content = ContentBuilder::new().schema(Some(schema)).build();
        let response = ResponseBuilder::new()
            .description(words.unwrap_or_default())
            .content("application/problem+json", content)
            .build();
        (status.to_string(), RefOr::T(response))
    };
    // Every request needs the token.
    [401].iter().chain(statuses).map(problem).collect()
}
