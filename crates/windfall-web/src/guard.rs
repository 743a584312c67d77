//! Access control, and restrictions on what browsers do with answers.
//!
//! Every account of a machine reaches its loopback address: whoever sends no token of this
//! run is not answered. The browser gets it from the address that it is opened with and keeps
//! it as a cookie; programs send it as `Authorization: Bearer`.
//!
//! A page of another site cannot use the interface: its requests carry another origin
//! or another host (also after its name has been bound to the loopback address), and
//! changes need a header that only pages of this origin may send.

use crate::problem::Problem;
use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{Html, IntoResponse, Response};
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tower_http::timeout::TimeoutBody;

/// Header that changes need.
const CHANGES: HeaderName = HeaderName::from_static("x-windfall");

/// Time limit for the next piece of a body; a whole one may take as long as it needs.
const PIECE: Duration = Duration::from_secs(30);

/// The page may load itself and nothing from elsewhere.
const PAGE_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
    img-src 'self' data: blob:; connect-src 'self'; font-src 'self'; frame-src 'self'; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A report may only be shown, also inside the page.
pub(crate) const REPORT_POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
    img-src data:; sandbox allow-modals; base-uri 'none'; form-action 'none'; \
    frame-ancestors 'self'";

/// What a browser shows that has no token, or that of an earlier run.
const NO_TOKEN_PAGE: &str = include_str!("no_token.html");

/// What a program is told that has no token.
const NO_TOKEN: &str = "this needs the token of the address that `windfall serve` printed in its \
    terminal: open that whole address, or send the token as Authorization: Bearer TOKEN";

/// Access control.
#[derive(Debug)]
pub(crate) struct Guard {
    /// Where the server is bound.
    pub address: SocketAddr,
    /// Required of every request; `None` where the user wants none.
    pub token: Option<String>,
    /// Admits a browser once: others may read the command line by which it is opened.
    pub once: Mutex<Option<String>>,
}

impl Guard {
    /// Lets a request pass, or says how it is answered instead.
    fn admit(&self, request: &Request) -> Result<(), Box<Response>> {
        let headers = request.headers();
        let checked = self.check(request.method(), headers);
        checked.map_err(|problem| Box::new(problem.into_response()))?;
        // The token moves from the address, where others could see it, to a cookie.
        let query = request.uri().query();
        let query = query.filter(|_| request.method() == Method::GET);
        if let Some(token) = query.and_then(|query| self.enters(query)) {
            return Err(Box::new(self.entered(request.uri().path(), token)));
        }
        match self.admits(headers) {
            true => Ok(()),
            false => Err(Box::new(not_admitted(headers))),
        }
    }

    fn check(&self, method: &Method, headers: &HeaderMap) -> Result<(), Problem> {
        let refused = |detail: &str| Err(Problem::new(StatusCode::FORBIDDEN, "refused", detail));
        let text = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
        let Some(host) = text(header::HOST) else {
            return refused("the request names no host");
        };
        if self.address.ip().is_loopback() && !self.is_own_host(host) {
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
        Ok(())
    }

    /// Whether a request carries the token, where there is one.
    fn admits(&self, headers: &HeaderMap) -> bool {
        let Some(token) = &self.token else {
            return true;
        };
        let bearer = headers.get(header::AUTHORIZATION);
        let bearer = bearer.and_then(|value| value.to_str().ok()?.split_once(' '));
        bearer.is_some_and(|(kind, value)| {
            kind.eq_ignore_ascii_case("bearer") && same(value.trim(), token)
        }) || has_cookie(headers, &self.cookie(), token)
    }

    /// The token, if an address has it in its query, or the code that admits once.
    fn enters(&self, query: &str) -> Option<&str> {
        let token = self.token.as_deref()?;
        let mut once = self.once.lock().unwrap_or_else(PoisonError::into_inner);
        let mut pairs = query.split('&').filter_map(|pair| pair.split_once('='));
        let (_, given) = pairs.find(|(name, _)| *name == "token")?;
        let first = once.as_deref().is_some_and(|code| same(given, code));
        if first {
            *once = None;
        }
        (first || same(given, token)).then_some(token)
    }

    /// Name of the cookie: browsers send those of all servers on a host to each of them.
    fn cookie(&self) -> String {
        format!("windfall-{}", self.address.port())
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

    /// Sets the token as a cookie and redirects to the same address without it.
    fn entered(&self, path: &str, token: &str) -> Response {
        let name = self.cookie();
        let cookie = format!("{name}={token}; HttpOnly; SameSite=Strict; Path=/");
        // Two slashes would name another host.
        let path = format!("/{}", path.trim_start_matches('/'));
        let headers = [(header::SET_COOKIE, cookie), (header::LOCATION, path)];
        (StatusCode::SEE_OTHER, headers).into_response()
    }
}

/// Compares in constant time.
fn same(a: &str, b: &str) -> bool {
    let pairs = a.bytes().zip(b.bytes());
    let differences = pairs.fold(0, |all, (a, b)| all | (a ^ b));
    a.len() == b.len() && std::hint::black_box(differences) == 0
}

fn has_cookie(headers: &HeaderMap, own: &str, token: &str) -> bool {
    let all = headers.get_all(header::COOKIE).iter();
    let texts = all.filter_map(|value| value.to_str().ok());
    let mut pairs = texts.flat_map(|text| text.split(';'));
    pairs.any(|pair| {
        let pair = pair.trim().split_once('=');
        pair.is_some_and(|(name, value)| name == own && same(value, token))
    })
}

/// The answer to a request without the token: a page for people, a problem for programs.
fn not_admitted(headers: &HeaderMap) -> Response {
    let accepted = headers.get(header::ACCEPT);
    let accepted = accepted.and_then(|value| value.to_str().ok());
    let status = StatusCode::UNAUTHORIZED;
    let mut response = match accepted.is_some_and(|kinds| kinds.contains("text/html")) {
        true => {
            let policy = "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'self'";
            let headers = [(header::CONTENT_SECURITY_POLICY, policy)];
            (status, headers, Html(NO_TOKEN_PAGE)).into_response()
        }
        false => Problem::new(status, "token", NO_TOKEN).into_response(),
    };
    let scheme = HeaderValue::from_static("Bearer");
    let headers = response.headers_mut();
    headers.insert(header::WWW_AUTHENTICATE, scheme);
    response
}

/// Answers permitted requests, with strict security headers.
pub(crate) async fn guarded(
    State(guard): State<Arc<Guard>>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = match guard.admit(&request) {
        Ok(()) => {
            let limited = |body| Body::new(TimeoutBody::new(PIECE, body));
            next.run(request.map(limited)).await
        }
        Err(response) => *response,
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

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: (&str, &str) = ("host", "127.0.0.1:8417");

    fn guard(host: [u8; 4], token: Option<&str>) -> Guard {
        Guard {
            address: SocketAddr::from((host, 8417)),
            token: token.map(str::to_owned),
            once: Mutex::new(token.map(|_| "first".to_owned())),
        }
    }

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let pairs = pairs.iter().map(|(name, value)| {
            let value = HeaderValue::from_str(value).unwrap();
            (HeaderName::from_static(name), value)
        });
        pairs.collect()
    }

    fn status(guard: &Guard, method: &Method, pairs: &[(&'static str, &str)]) -> u16 {
        let checked = guard.check(method, &headers(pairs));
        checked.map_or_else(|problem| problem.status, |()| 200)
    }

    #[test]
    fn rejects_other_hosts_and_other_sites() {
        for token in [None, Some("abc")] {
            let guard = guard([127, 0, 0, 1], token);
            let get = |pairs: &[(&'static str, &str)]| status(&guard, &Method::GET, pairs);
            assert_eq!(get(&[OWN]), 200);
            assert_eq!(get(&[("host", "localhost:8417")]), 200);
            assert_eq!(get(&[]), 403);
            // A name of another site that was bound to the loopback address.
            assert_eq!(get(&[("host", "evil.example:8417")]), 403);
            assert_eq!(get(&[("host", "127.0.0.1:80")]), 403);
            assert_eq!(get(&[OWN, ("origin", "http://127.0.0.1:8417")]), 200);
            assert_eq!(get(&[OWN, ("origin", "http://evil.example")]), 403);
            assert_eq!(get(&[OWN, ("origin", "null")]), 403);
            assert_eq!(get(&[OWN, ("sec-fetch-site", "cross-site")]), 403);
            assert_eq!(get(&[OWN, ("sec-fetch-site", "same-site")]), 403);
            assert_eq!(get(&[OWN, ("sec-fetch-site", "none")]), 200);
        }
        // Others call this machine by names that it does not know.
        let open = guard([0, 0, 0, 0], Some("abc"));
        let named = [("host", "bench.example:8417")];
        assert_eq!(status(&open, &Method::GET, &named), 200);
    }

    #[test]
    fn rejects_changes_without_the_header_that_forms_cannot_send() {
        let guard = guard([127, 0, 0, 1], Some("abc"));
        for method in [Method::POST, Method::PUT, Method::DELETE] {
            assert_eq!(status(&guard, &method, &[OWN]), 403);
            let pairs = [OWN, ("x-windfall", "page")];
            assert_eq!(status(&guard, &method, &pairs), 200);
        }
    }

    #[test]
    fn rejects_everything_without_the_token_where_there_is_one() {
        let with = guard([127, 0, 0, 1], Some("abc"));
        let admits = |guard: &Guard, name, value| guard.admits(&headers(&[(name, value)]));
        for (name, value) in [
            ("cookie", "a=b; windfall-8417=abc"),
            ("authorization", "Bearer abc"),
            ("authorization", "bearer  abc"),
        ] {
            assert!(admits(&with, name, value), "{name}: {value}");
        }
        for (name, value) in [
            ("x-other", "abc"),
            ("cookie", "windfall-8417=ab"),
            ("cookie", "windfall-8417=abcd"),
            ("cookie", "windfall-8417="),
            // Of another server on this host.
            ("cookie", "windfall-8418=abc"),
            ("cookie", "windfall-8417=first"),
            ("authorization", "abc"),
            ("authorization", "Basic abc"),
            ("authorization", "Bearer abd"),
            ("authorization", "Bearer "),
        ] {
            assert!(!admits(&with, name, value), "{name}: {value}");
        }
        assert!(admits(&guard([127, 0, 0, 1], None), "x-other", ""));
    }

    #[test]
    fn an_address_admits_with_the_token_and_once_with_the_code() {
        let guard = guard([127, 0, 0, 1], Some("abc"));
        for query in [
            "",
            "token=abd",
            "token=",
            "file=abc",
            "token=abcd",
            "xtoken=abc",
        ] {
            assert_eq!(guard.enters(query), None, "{query}");
        }
        let found = [
            "file=x&token=abc",
            "token=first",
            "token=first",
            "token=abc",
        ];
        let found = found.map(|query| guard.enters(query));
        assert_eq!(found, [Some("abc"), Some("abc"), None, Some("abc")]);
        let entered = guard.entered("//evil.example/", "abc");
        let header = |name: HeaderName| entered.headers()[name].to_str().unwrap();
        assert_eq!(header(header::LOCATION), "/evil.example/");
        let cookie = "windfall-8417=abc; HttpOnly; SameSite=Strict; Path=/";
        assert_eq!(header(header::SET_COOKIE), cookie);
    }
}
