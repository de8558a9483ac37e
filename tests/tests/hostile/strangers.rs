//! Who may ask: pages of other sites, names that were made to point here, and clients without the token may not.

use std::fs;

use coin_tests::{HttpRequest, HttpServer, Program};
use rstest::rstest;
use serde_json::json;

const TOKEN: &str = "correct-horse-battery-staple";

fn users() -> HttpRequest {
    HttpRequest::call("list_users", json!({}))
}

#[rstest]
#[case::another_site(users().header("Origin", "https://evil.example"), "Origin")]
#[case::a_sandboxed_page(users().header("Origin", "null"), "Origin")]
#[case::a_name_made_to_point_here(users().header("Host", "evil.example:8750"), "--allow-host")]
#[case::both(users().header("Host", "evil.example").header("Origin", "http://evil.example"), "--allow-host")]
#[case::no_name(users().without("Host"), "Host")]
#[case::a_hello(HttpRequest::initialize().header("Origin", "https://evil.example"), "Origin")]
#[case::a_question_beforehand(HttpRequest::new("OPTIONS", "/mcp").header("Origin", "https://evil.example"), "Origin")]
#[case::a_stream(HttpRequest::new("GET", "/mcp").header("Origin", "https://evil.example"), "Origin")]
#[case::an_end(HttpRequest::new("DELETE", "/mcp").header("Origin", "https://evil.example"), "Origin")]
#[case::a_sign_of_life(HttpRequest::new("GET", "/healthz").header("Host", "evil.example"), "--allow-host")]
#[case::elsewhere(HttpRequest::new("GET", "/").header("Host", "evil.example"), "--allow-host")]
fn what_a_page_of_another_site_sends_is_turned_away(#[case] request: HttpRequest, #[case] part: &str) {
    let home = super::home();
    let server = HttpServer::start(home.db());
    let response = request.send(server.address());
    assert_eq!(response.status, 403, "{response:?}");
    assert!(response.body.contains(part), "{}", response.body);
    assert!(response.header("access-control-allow-origin").is_none(), "{response:?}");
    super::assert_serves(&server);
}

#[rstest]
#[case::name(users().header("Host", "localhost:1234"))]
#[case::version_6(users().header("Host", "[::1]:1234"))]
#[case::a_page_of_this_computer(users().header("Origin", "http://localhost:5173"))]
#[case::an_allowed_name(users().header("Host", "home.lan").header("Origin", "https://home.lan"))]
fn what_comes_from_here_passes(#[case] request: HttpRequest) {
    let home = super::home();
    let arguments = ["--http", "127.0.0.1:0", "--allow-host", "home.lan"];
    let server = HttpServer::start_with(home.db(), &arguments, &[]);
    assert_eq!(request.send(server.address()).status, 200);
}

#[test]
fn there_is_nothing_beside_the_endpoint() {
    let home = super::home();
    let server = HttpServer::start(home.db());
    for path in ["/", "/mcp/", "/mcp/../etc/passwd", "/..%2f..%2fetc/passwd", "/healthz/x", "//", "/MCP"] {
        assert_eq!(HttpRequest::new("GET", path).send(server.address()).status, 404, "{path}");
    }
    let health = HttpRequest::new("GET", "/healthz").send(server.address());
    assert_eq!((health.status, health.body.as_str()), (200, "ok\n"));
}

/// Every way to hand the server its token.
#[rstest]
#[case::in_a_file(&["--token-file", "FILE"], &[])]
#[case::in_the_environment(&[], &[("COIN_TOKEN", TOKEN)])]
#[case::in_a_file_before_the_environment(&["--token-file", "FILE"], &[("COIN_TOKEN", "another")])]
fn only_clients_with_the_token_may_ask(#[case] arguments: &[&str], #[case] environment: &[(&str, &str)]) {
    let home = super::home();
    let file = home.join("token");
    fs::write(&file, format!("{TOKEN}\n")).unwrap();
    let file = file.to_str().unwrap();
    let named = arguments.iter().map(|argument| if *argument == "FILE" { file } else { argument });
    let arguments: Vec<&str> = ["--http", "127.0.0.1:0"].into_iter().chain(named).collect();
    let server = HttpServer::start_with(home.db(), &arguments, environment);

    for shown in [None, Some("Bearer wrong"), Some("Bearer "), Some(TOKEN), Some("Basic Y29ycmVjdA==")] {
        let request =
            shown.into_iter().fold(users(), |request, shown| request.header("Authorization", shown));
        let response = request.send(server.address());
        assert_eq!(response.status, 401, "{shown:?}: {response:?}");
        assert_eq!(response.header("www-authenticate"), Some("Bearer"), "{response:?}");
        assert!(!format!("{response:?}").contains(TOKEN), "{response:?}");
    }
    let right = users().header("Authorization", &format!("Bearer {TOKEN}"));
    assert_eq!(right.send(server.address()).status, 200);
    let health = HttpRequest::new("GET", "/healthz").send(server.address());
    assert_eq!((health.status, health.body.as_str()), (200, "ok\n"));
    assert!(!server.stderr().contains(TOKEN), "{}", server.stderr());
}

fn refused(arguments: &[&str], environment: &[(&str, &str)], parts: &[&str]) {
    let home = super::home();
    let program = Program::new("coin-server").arg("--db").arg(home.db()).args(arguments);
    let program = environment.iter().fold(program, |program, (name, value)| program.env(name, value));
    program.run().expect_code(2).expect_stderr(parts);
}

#[test]
fn a_server_that_others_can_reach_does_not_start_without_a_token() {
    refused(&["--http", "0.0.0.0:0"], &[], &["0.0.0.0", "--token-file", "COIN_TOKEN", "127.0.0.1"]);
    refused(&["--http", "[::]:0"], &[], &["[::]", "--token-file"]);
    let home = super::home();
    let server = HttpServer::start_with(home.db(), &["--http", "0.0.0.0:0"], &[("COIN_TOKEN", TOKEN)]);
    let here = (std::net::Ipv4Addr::LOCALHOST, server.address().port()).into();
    assert_eq!(users().send(here).status, 401);
}

#[test]
fn what_is_no_token_or_no_address_is_refused_at_the_start() {
    refused(&["--http", "127.0.0.1:0"], &[("COIN_TOKEN", "")], &["COIN_TOKEN", "openssl rand -hex 32"]);
    refused(&["--http", "127.0.0.1:0", "--token-file", "nowhere"], &[], &["nowhere", "No such file"]);
    refused(&["--token-file", "token"], &[], &["--http"]);
    refused(&["--http", "localhost:8750"], &[], &["localhost:8750", "127.0.0.1:8750"]);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    refused(&["--http", &address], &[], &[&address, "another port"]);
}

#[cfg(unix)]
#[test]
fn a_token_that_others_may_read_is_warned_of() {
    use std::os::unix::fs::PermissionsExt as _;

    let home = super::home();
    let file = home.join("token");
    fs::write(&file, TOKEN).unwrap();
    let path = file.to_str().unwrap().to_owned();
    let start = |mode| {
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
        HttpServer::start_with(home.db(), &["--http", "127.0.0.1:0", "--token-file", &path], &[]).stderr()
    };
    assert!(start(0o644).contains("chmod 600"));
    assert!(!start(0o600).contains("chmod"));
}
