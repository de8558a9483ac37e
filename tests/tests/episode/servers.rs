//! `--server`: the same report, wherever the server runs.

use std::net::TcpListener;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::thread;

use coin_server::store::{Access, Store};
use coin_server::{ServiceOptions, service};
use coin_tests::{EpisodeBuilder, Home, binary, small_house};
use rmcp::transport::streamable_http_server::session::local::LocalSessionManager;
use rmcp::transport::streamable_http_server::{StreamableHttpServerConfig, StreamableHttpService};

fn child(home: &Home) -> String {
    format!("'{}' --db '{}'", binary("coin-server").display(), home.db().display())
}

#[test]
fn a_server_in_its_own_process_gives_the_same_report() {
    let home = Home::import(&small_house());
    let in_process = super::report(&small_house(), &[]);
    let in_child = super::report(&small_house(), &["--server", &child(&home)]);
    assert_eq!(super::without_seconds(in_child), super::without_seconds(in_process));
    // And the home of that server knows the answers.
    let listed = home.server().ok("list_objects", serde_json::json!({"limit": 500}));
    assert_eq!(listed["total"], 34);
    let settled = listed["objects"].as_array().unwrap().iter().filter(|object| object["settled"] == true);
    assert_eq!(settled.count(), 34);
}

/// Serves a home over Streamable HTTP in a thread that lives as long as the test's process.
fn serve_over_http(db: &Path) -> String {
    let store = Arc::new(Store::open(db, Access::ReadWrite).unwrap());
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async move {
            let service = service(store, ServiceOptions::default());
            let handler = StreamableHttpService::new(
                move || Ok(service.clone()),
                Arc::new(LocalSessionManager::default()),
                StreamableHttpServerConfig::default(),
            );
            let router = axum::Router::new().nest_service("/mcp", handler);
            let listener = TcpListener::bind("127.0.0.1:0").unwrap();
            listener.set_nonblocking(true).unwrap();
            sender.send(listener.local_addr().unwrap()).unwrap();
            let listener = tokio::net::TcpListener::from_std(listener).unwrap();
            axum::serve(listener, router).await.unwrap();
        });
    });
    format!("http://{}/mcp", receiver.recv().unwrap())
}

#[test]
fn a_server_behind_a_url_gives_the_same_report() {
    let home = Home::import(&small_house());
    let url = serve_over_http(&home.db());
    let in_process = super::report(&small_house(), &[]);
    let remote = super::report(&small_house(), &["--server", &url]);
    assert_eq!(super::without_seconds(remote), super::without_seconds(in_process));
}

#[test]
fn a_server_of_another_home_is_refused() {
    let other = Home::of(&EpisodeBuilder::three_things());
    super::host(&small_house(), &["--server", &child(&other)])
        .run()
        .expect_code(2)
        .expect_stderr(&["not that of the episode", "coin-server import"]);
}

#[test]
fn a_server_that_cannot_be_started_is_told() {
    super::host(&small_house(), &["--server", "no-such-program --db home.db"])
        .run()
        .expect_code(1)
        .expect_stderr(&["no-such-program"]);
}

#[test]
fn a_program_that_is_no_server_is_told() {
    super::host(&small_house(), &["--server", "true"]).run().expect_code(1).expect_stderr(&["true", "MCP"]);
}

#[test]
fn an_address_where_nobody_listens_is_told() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let url = format!("http://127.0.0.1:{port}/mcp");
    super::host(&small_house(), &["--server", &url]).run().expect_code(1).expect_stderr(&[&url]);
}

#[test]
fn a_database_for_a_server_elsewhere_is_refused() {
    let home = Home::import(&small_house());
    super::host(&small_house(), &["--server", &child(&home), "--db", "home.db"])
        .run()
        .expect_code(2)
        .expect_stderr(&["--db", "--server"]);
}
