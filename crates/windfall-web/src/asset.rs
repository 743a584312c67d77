//! The page, embedded in the program.

use axum::http::{StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use rust_embed::RustEmbed;

#[derive(RustEmbed)]
#[folder = "assets/"]
struct Assets;

/// A file of the page.
pub(crate) async fn asset(address: Uri) -> Response {
    let name = match address.path().trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    let Some(file) = Assets::get(name) else {
        return (StatusCode::NOT_FOUND, "there is no such file\n").into_response();
    };
    let kind = match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("json") => "application/json",
        _ => "application/octet-stream",
    };
    // Names of files beside index.html change with their content.
    let kept = match name {
        "index.html" => "no-cache",
        _ => "private, max-age=31536000, immutable",
    };
    let headers = [(header::CONTENT_TYPE, kind), (header::CACHE_CONTROL, kept)];
    (headers, file.data).into_response()
}
