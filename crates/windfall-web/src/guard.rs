//! Access control, and restrictions on what browsers do with answers.
//!
//! A page of another site cannot use the interface: its requests carry another origin
//! or another host (also after its name has been bound to the loopback address), and
//! changes need a header that only pages of this origin may send. Bound to other than
//! loopback, every request needs the token of the address that was shown.

use crate::problem::Problem;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use std::net::SocketAddr;
use std::sync::Arc;

/// Name of the cookie that holds the token.
const COOKIE: &str = "windfall";

/// Header that changes need.
const CHANGES: HeaderName = HeaderName::from_static("x-windfall");

/// The page may load itself and nothing from elsewhere.
const PAGE_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; frame-src 'self'; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A report may only be shown, also inside the page.
pub(crate) const REPORT_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
    img-src data:; sandbox allow-modals; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'self'";

/// Access control.
#[derive(Debug)]
pub(crate) struct Guard {
    /// Where the server is bound.
    pub address: SocketAddr,
    /// Required of every request if others could reach the server.
    pub token: Option<String>,
}

impl Guard {
    fn check(&self, method: &Method, headers: &HeaderMap, query: &str) -> Result<(), Problem> {
        let refused = |detail: &str| Err(Problem::new(StatusCode::FORBIDDEN, "refused", detail));
        let text = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
        let Some(host) = text(header::HOST) else {
            return refused("the request names no host");
        };
        if self.token.is_none() && !self.is_own_host(host) {
            return refused(
                "this server answers under the address that it showed when it was started",
            );
        }
        if let Some(origin) = text(header::ORIGIN)
            && origin != format!("http://{host}")
        {
            return refused("requests from other sites are not answered");
        }
        let site = text(HeaderName::from_static("sec-fetch-site"));
        if site.is_some_and(|site| site != "same-origin" && site != "none") {
            return refused("requests from other sites are not answered");
        }
        let reads = method == Method::GET || method == Method::HEAD;
        if !reads && !headers.contains_key(CHANGES) {
            return refused("changes need the header X-Windfall");
        }
        match &self.token {
            Some(token) if !(has_cookie(headers, token) || has_token(query, token)) => {
                Err(Problem::new(
                    StatusCode::UNAUTHORIZED,
                    "token",
                    "open the whole address that `windfall serve` showed, with its token",
                ))
            }
            _ => Ok(()),
        }
    }

    /// Whether a host is the address that the server is bound to, or localhost.
    fn is_own_host(&self, host: &str) -> bool {
        let port = self.address.port();
        let own = [
            self.address.to_string(),
            format!("localhost:{port}"),
            format!("127.0.0.1:{port}"),
            format!("[::1]:{port}"),
        ];
        own.iter().any(|known| known == host)
    }
}

/// Compares in constant time.
fn same(a: &str, b: &str) -> bool {
    let pairs = a.bytes().zip(b.bytes());
    let differences = pairs.fold(0, |all, (a, b)| all | (a ^ b));
    a.len() == b.len() && differences == 0
}

fn has_cookie(headers: &HeaderMap, token: &str) -> bool {
    let all = headers.get_all(header::COOKIE).iter();
    let texts = all.filter_map(|value| value.to_str().ok());
    let mut pairs = texts.flat_map(|text| text.split(';'));
    pairs.any(|pair| {
        let pair = pair.trim().split_once('=');
        pair.is_some_and(|(name, value)| name == COOKIE && same(value, token))
    })
}

fn has_token(query: &str, token: &str) -> bool {
    let mut pairs = query.split('&').filter_map(|pair| pair.split_once('='));
    pairs.any(|(name, value)| name == "token" && same(value, token))
}

/// Answers permitted requests, with strict security headers.
pub(crate) async fn guarded(
    State(guard): State<Arc<Guard>>,
    request: Request,
    next: Next,
) -> Response {
    let query = request.uri().query().unwrap_or_default().to_owned();
    let checked = guard.check(request.method(), request.headers(), &query);
    // The token moves from the address, where others could see it, to a cookie.
    let entering = guard
        .token
        .as_ref()
        .filter(|token| has_token(&query, token));
    let mut response = match (checked, entering) {
        (Err(problem), _) => problem.into_response(),
        (Ok(()), Some(token)) if request.method() == Method::GET => entered(request.uri(), token),
        (Ok(()), _) => next.run(request).await,
    };
    let headers = response.headers_mut();
    let mut set = |name: HeaderName, value: &'static str| {
        let value = HeaderValue::from_static(value);
        headers.entry(name).or_insert(value);
    };
    set(header::CONTENT_SECURITY_POLICY, PAGE_POLICY);
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(header::REFERRER_POLICY, "no-referrer");
    set(header::CACHE_CONTROL, "no-store");
    for name in ["cross-origin-resource-policy", "cross-origin-opener-policy"] {
        set(HeaderName::from_static(name), "same-origin");
    }
    response
}

/// Sets the token as a cookie and redirects to the same address without it.
fn entered(address: &axum::http::Uri, token: &str) -> Response {
    let cookie = format!("{COOKIE}={token}; HttpOnly; SameSite=Strict; Path=/");
    let headers = [
        (header::SET_COOKIE, cookie),
        (header::LOCATION, address.path().to_owned()),
    ];
    (StatusCode::SEE_OTHER, headers).into_response()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard(token: Option<&str>) -> Guard {
        Guard {
            address: SocketAddr::from(([127, 0, 0, 1], 8417)),
            token: token.map(str::to_owned),
        }
    }

    fn status(guard: &Guard, method: &Method, pairs: &[(&'static str, &str)], query: &str) -> u16 {
        let mut headers = HeaderMap::new();
        for (name, value) in pairs {
            headers.append(
                HeaderName::from_static(name),
                HeaderValue::from_str(value).unwrap(),
            );
        }
        let checked = guard.check(method, &headers, query);
        checked.map_or_else(|problem| problem.status, |()| 200)
    }

    #[test]
    fn rejects_other_hosts_and_other_sites() {
        let guard = guard(None);
        let get = |pairs: &[(&'static str, &str)]| status(&guard, &Method::GET, pairs, "");
        assert_eq!(get(&[("host", "127.0.0.1:8417")]), 200);
        assert_eq!(get(&[("host", "localhost:8417")]), 200);
        assert_eq!(get(&[]), 403);
        // A name of another site that was bound to the loopback address.
        assert_eq!(get(&[("host", "evil.example:8417")]), 403);
        assert_eq!(get(&[("host", "127.0.0.1:80")]), 403);
        let own = ("host", "127.0.0.1:8417");
        assert_eq!(get(&[own, ("origin", "http://127.0.0.1:8417")]), 200);
        assert_eq!(get(&[own, ("origin", "http://evil.example")]), 403);
        assert_eq!(get(&[own, ("origin", "null")]), 403);
        assert_eq!(get(&[own, ("sec-fetch-site", "cross-site")]), 403);
        assert_eq!(get(&[own, ("sec-fetch-site", "same-site")]), 403);
        assert_eq!(get(&[own, ("sec-fetch-site", "none")]), 200);
    }

    #[test]
    fn rejects_changes_without_the_header_that_forms_cannot_send() {
        let guard = guard(None);
        let own = ("host", "127.0.0.1:8417");
        for method in [Method::POST, Method::PUT, Method::DELETE] {
            assert_eq!(status(&guard, &method, &[own], ""), 403);
            let pairs = [own, ("x-windfall", "page")];
            assert_eq!(status(&guard, &method, &pairs, ""), 200);
        }
    }

    #[test]
    fn rejects_everything_without_the_token_where_there_is_one() {
        let guard = guard(Some("abc"));
        let host = ("host", "bench.example:8417");
        let get =
            |pairs: &[(&'static str, &str)], query| status(&guard, &Method::GET, pairs, query);
        assert_eq!(get(&[host], ""), 401);
        assert_eq!(get(&[host], "token=abd"), 401);
        assert_eq!(get(&[host], "token=abcd"), 401);
        assert_eq!(get(&[host], "file=x&token=abc"), 200);
        assert_eq!(get(&[host, ("cookie", "a=b; windfall=abc")], ""), 200);
        assert_eq!(get(&[host, ("cookie", "windfall=ab")], ""), 401);
    }
}
