//! Extractors for requests; malformed ones are answered with a [`Problem`].

use crate::problem::Problem;
use axum::Json;
use axum::extract::rejection::QueryRejection;
use axum::extract::{FromRequest, FromRequestParts, Query, Request};
use axum::http::request::Parts;
use axum::http::{StatusCode, header};
use serde::de::DeserializeOwned;

/// A body in JSON.
pub(crate) struct Given<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequest<S> for Given<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &S) -> Result<Self, Problem> {
        let found = Json::<T>::from_request(request, state).await;
        found.map(|Json(body)| Self(body)).map_err(|rejection| {
            let code = match rejection.status() {
                StatusCode::PAYLOAD_TOO_LARGE => "too-large",
                _ => "request",
            };
            Problem::new(rejection.status(), code, rejection.body_text())
        })
    }
}

/// Query parameters.
pub(crate) struct Asked<T>(pub T);

impl<S: Send + Sync, T: DeserializeOwned> FromRequestParts<S> for Asked<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let found = Query::<T>::from_request_parts(parts, state).await;
        found
            .map(|Query(query)| Self(query))
            .map_err(|rejection: QueryRejection| Problem::request(rejection.body_text()))
    }
}

/// The version of a campaign that a change is based on; "*" for the current one.
pub(crate) struct Version(pub String);

impl<S: Send + Sync> FromRequestParts<S> for Version {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _state: &S) -> Result<Self, Problem> {
        let given = parts.headers.get(header::IF_MATCH);
        let text = given.and_then(|value| value.to_str().ok());
        text.map(|text| Self(text.trim_matches('"').to_owned()))
            .ok_or_else(|| {
                Problem::new(
                    StatusCode::PRECONDITION_REQUIRED,
                    "version",
                    "a change needs the version of the campaign that it rests on, in If-Match",
                )
            })
    }
}
