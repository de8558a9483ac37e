//! Who is behind a request: no web page of somebody else's.
//!
//! A browser sends what any page tells it to, also to this computer. Two headers, which pages cannot change, give
//! it away. `Origin` names the page's site, and only pages of this computer may ask. `Host` names what the page
//! believes to talk to; where a page had its own name resolve to this computer (DNS rebinding), it is that name.

use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use axum::Extension;
use axum::extract::{Request, State};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, StatusCode, Uri, header};
use axum::middleware::Next;
use axum::response::Response;

use super::refused;

/// The two ends of the connection that a request came over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends {
    /// The address that the client connected to.
    pub(super) here: SocketAddr,
    /// The client's address.
    pub(super) there: SocketAddr,
}

/// The names under which a server may be spoken to.
#[derive(Debug)]
pub(super) struct Callers {
    allowed_hosts: Vec<String>,
}

impl Callers {
    pub(super) fn new(allowed_hosts: &[String]) -> Self {
        Self { allowed_hosts: allowed_hosts.iter().map(|host| bare(host)).collect() }
    }

    /// Whether a request may pass, or what is wrong with it.
    fn check(&self, headers: &HeaderMap, here: IpAddr) -> Result<(), &'static str> {
        let host = only(headers, header::HOST)?.ok_or("A request names its Host.")?;
        let host = host.parse::<Authority>().map_err(|_| "Host is no host name.")?;
        if !self.is_ours(host.host(), here) {
            return Err(
                "Host is not a name of this server; start it with --allow-host NAME where it should be one.",
            );
        }
        let Some(origin) = only(headers, header::ORIGIN)? else {
            return Ok(());
        };
        let origin = origin.parse::<Uri>().ok();
        match origin.as_ref().and_then(Uri::host) {
            Some(site) if self.is_ours(site, here) => Ok(()),
            _ => Err("Pages of other sites may not ask this server (Origin)."),
        }
    }

    fn is_ours(&self, name: &str, here: IpAddr) -> bool {
        let name = bare(name);
        match name.parse::<IpAddr>() {
            Ok(address) if address.is_loopback() || address == here.to_canonical() => true,
            _ => name == "localhost" || self.allowed_hosts.contains(&name),
        }
    }
}

/// A host name as it is compared: in small letters, and without the brackets of an address of version 6.
fn bare(name: &str) -> String {
    name.trim_start_matches('[').trim_end_matches(']').to_ascii_lowercase()
}

/// The one value of a header, if it is there.
fn only(headers: &HeaderMap, name: HeaderName) -> Result<Option<&str>, &'static str> {
    let mut values = headers.get_all(name).iter();
    match (values.next(), values.next()) {
        (None, _) => Ok(None),
        (Some(value), None) => value.to_str().map(Some).map_err(|_| "Host and Origin are ASCII."),
        (Some(_), Some(_)) => Err("Host and Origin stand in a request once."),
    }
}

/// Turns away what a page of another site has a browser send.
pub(super) async fn refuse_strangers(
    State(callers): State<Arc<Callers>>,
    Extension(ends): Extension<Ends>,
    request: Request,
    next: Next,
) -> Response {
    match callers.check(request.headers(), ends.here.ip()) {
        Ok(()) => next.run(request).await,
        Err(reason) => refused(StatusCode::FORBIDDEN, reason),
    }
}

#[cfg(test)]
mod tests {
    use axum::http::HeaderValue;
    use rstest::rstest;

    use super::*;

    fn check(headers: &[(HeaderName, &str)]) -> Result<(), &'static str> {
        let headers = headers
            .iter()
            .map(|(name, value)| (name.clone(), HeaderValue::from_bytes(value.as_bytes()).unwrap()));
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(name, value);
        }
        Callers::new(&["Home.lan".to_owned()]).check(&map, "192.168.1.5".parse().unwrap())
    }

    #[rstest]
    #[case::name("localhost")]
    #[case::name_with_port("localhost:8750")]
    #[case::case("LocalHost")]
    #[case::version_4("127.0.0.1:8750")]
    #[case::whole_loopback_network("127.1.2.3")]
    #[case::version_6("[::1]:8750")]
    #[case::where_the_client_connected("192.168.1.5:8750")]
    #[case::allowed("home.LAN:8750")]
    fn hosts_of_this_server_pass(#[case] host: &str) {
        assert_eq!(check(&[(header::HOST, host)]), Ok(()));
        let origin = format!("http://{host}");
        assert_eq!(check(&[(header::HOST, host), (header::ORIGIN, &origin)]), Ok(()));
    }

    #[rstest]
    #[case::rebound("evil.example")]
    #[case::looks_like_ours("localhost.evil.example")]
    #[case::ends_like_ours("evil.home.lan")]
    #[case::a_number("127.0.0.1.evil.example:8750")]
    #[case::another_computer("192.168.1.6")]
    #[case::anywhere("0.0.0.0")]
    #[case::empty("")]
    #[case::no_name("a b")]
    #[case::not_ascii("löcalhost")]
    fn other_hosts_are_refused(#[case] host: &str) {
        assert!(check(&[(header::HOST, host)]).is_err());
        let origin = format!("https://{host}");
        assert!(check(&[(header::HOST, "localhost"), (header::ORIGIN, &origin)]).is_err());
    }

    #[rstest]
    #[case::sandboxed_page("null")]
    #[case::user_that_looks_like_a_host("http://localhost@evil.example")]
    #[case::nothing("")]
    #[case::file("file://")]
    fn other_origins_are_refused(#[case] origin: &str) {
        assert!(check(&[(header::HOST, "localhost"), (header::ORIGIN, origin)]).is_err());
    }

    #[test]
    fn what_stands_there_twice_or_not_at_all_is_refused() {
        assert!(check(&[]).is_err());
        assert!(check(&[(header::HOST, "localhost"), (header::HOST, "localhost")]).is_err());
        let origin = (header::ORIGIN, "http://localhost");
        assert!(check(&[(header::HOST, "localhost"), origin.clone(), origin]).is_err());
    }
}
