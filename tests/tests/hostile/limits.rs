//! What a server bears: slow clients, many clients, clients that do not listen.

use std::num::{NonZeroU32, NonZeroUsize};
use std::thread;
use std::time::{Duration, Instant};

use coin_server::transport::http::Limits;
use coin_tests::{HttpConnection, HttpRequest, HttpResponse, LEGACY_VERSION};
use serde_json::json;

use super::local::{LocalServer, assert_slept, sleep, speak};

/// The limit that a test sets, where it is a time.
const SHORT: Duration = Duration::from_millis(300);

/// What a server may take beyond a limit, on a busy machine.
const GRACE: Duration = Duration::from_secs(15);

/// Sends a byte every now and then until the other end has had enough; tells how long that took.
fn dribble(connection: &mut HttpConnection) -> Duration {
    let started = Instant::now();
    while connection.write(b"a").is_ok() && started.elapsed() < SHORT + GRACE {
        thread::sleep(Duration::from_millis(20));
    }
    started.elapsed()
}

#[test]
fn a_head_that_dribbles_is_cut_off() {
    let server = LocalServer::start(Limits { head: SHORT, ..Limits::default() });
    let mut connection = HttpConnection::open(server.address()).unwrap();
    connection.write(b"POST /mcp HTTP/1.1\r\nHost: localhost\r\nX-Slow: ").unwrap();
    assert!(dribble(&mut connection) < SHORT + GRACE, "the server listens for ever");
    assert_slept(&sleep(Duration::ZERO).send(server.address()));
}

#[test]
fn a_connection_that_says_nothing_is_cut_off() {
    let server = LocalServer::start(Limits { head: SHORT, ..Limits::default() });
    let mut silent = HttpConnection::open(server.address()).unwrap();
    let mut after_a_request = HttpConnection::open(server.address()).unwrap();
    assert_slept(&after_a_request.exchange(&sleep(Duration::ZERO)).unwrap());
    let started = Instant::now();
    assert!(silent.read().is_err());
    assert!(after_a_request.read().is_err());
    assert!(started.elapsed() < SHORT + GRACE);
}

#[test]
fn a_body_that_dribbles_is_answered_and_cut_off() {
    let server = LocalServer::start(Limits { body: SHORT, ..Limits::default() });
    let mut connection = HttpConnection::open(server.address()).unwrap();
    connection.send(&HttpRequest::post("").keeping_back(1 << 20)).unwrap();
    let mut listening = connection.share().unwrap();
    let answer = thread::spawn(move || listening.read().unwrap());
    assert!(dribble(&mut connection) < SHORT + GRACE, "the server listens for ever");
    assert_eq!(answer.join().unwrap().status, 408);
}

#[test]
fn a_client_that_does_not_read_gives_its_place_to_another() {
    let server = LocalServer::start(Limits { connections: 1, write: SHORT, ..Limits::default() });
    let mut deaf = HttpConnection::open(server.address()).unwrap();
    deaf.send(&speak(50 << 20)).unwrap();
    let started = Instant::now();
    assert_slept(&sleep(Duration::ZERO).send(server.address()));
    assert!(started.elapsed() < SHORT + GRACE);
}

#[test]
fn further_connections_wait_for_a_place() {
    let server = LocalServer::start(Limits { connections: 2, head: SHORT, ..Limits::default() });
    let _idle = [(); 2].map(|()| HttpConnection::open(server.address()).unwrap());
    let started = Instant::now();
    assert_slept(&sleep(Duration::ZERO).send(server.address()));
    assert!(started.elapsed() > SHORT / 2, "it did not wait: {:?}", started.elapsed());
}

fn assert_try_again(response: &HttpResponse, status: u16) {
    assert_eq!(response.status, status, "{response:?}");
    assert_eq!(response.header("retry-after"), Some("1"), "{response:?}");
}

#[test]
fn an_address_that_asks_too_often_is_told_to_wait() {
    let rate = NonZeroU32::new(10).unwrap();
    let server = LocalServer::start(Limits { requests_per_second: rate, ..Limits::default() });
    let mut connection = HttpConnection::open(server.address()).unwrap();
    let mut burst = || -> Vec<HttpResponse> {
        (0..30).map(|_| connection.exchange(&sleep(Duration::ZERO)).unwrap()).collect()
    };
    let responses = burst();
    let served = responses.iter().filter(|response| response.status == 200).count();
    assert!((10..20).contains(&served), "{served} of 30 requests were served");
    assert_try_again(responses.last().unwrap(), 429);
    thread::sleep(Duration::from_secs(1));
    assert_slept(&burst()[0]);
}

#[test]
fn more_requests_than_can_be_worked_on_wait_for_their_turn() {
    let limits = Limits { requests_at_once: 1, ..Limits::default() };
    let patient = LocalServer::start(limits.clone());
    let impatient = LocalServer::start(Limits { turn: SHORT, ..limits });
    thread::scope(|scope| {
        for server in [&patient, &impatient] {
            scope.spawn(|| assert_slept(&sleep(4 * SHORT).send(server.address())));
        }
        thread::sleep(SHORT);
        scope.spawn(|| assert_slept(&sleep(Duration::ZERO).send(patient.address())));
        assert_try_again(&sleep(Duration::ZERO).send(impatient.address()), 503);
        assert_eq!(HttpRequest::new("GET", "/healthz").send(impatient.address()).body, "ok\n");
    });
}

#[test]
fn all_bodies_together_are_held_to_a_size() {
    let limits = Limits { body_bytes: 800, bodies_bytes: 1000, ..Limits::default() };
    let server = LocalServer::start(limits);
    let mut holding = HttpConnection::open(server.address()).unwrap();
    holding.send(&HttpRequest::post("a".repeat(700)).keeping_back(1)).unwrap();
    thread::sleep(SHORT);
    assert_try_again(&HttpRequest::post("a".repeat(400)).send(server.address()), 503);
    holding.write(b"a").unwrap();
    assert_eq!(holding.read().unwrap().status, 415);
    assert_slept(&sleep(Duration::ZERO).send(server.address()));
}

#[test]
fn a_body_that_is_too_long_is_refused_however_it_is_sent() {
    let server = LocalServer::start(Limits { body_bytes: 1000, ..Limits::default() });
    assert_eq!(HttpRequest::post("a".repeat(1001)).send(server.address()).status, 413);
    let mut chunks = HttpConnection::open(server.address()).unwrap();
    let head = HttpRequest::post("").head().replace("Content-Length: 0", "Transfer-Encoding: chunked");
    chunks.write(head.as_bytes()).unwrap();
    for _ in 0..11 {
        chunks.write(format!("64\r\n{}\r\n", "a".repeat(100)).as_bytes()).unwrap();
    }
    chunks.write(b"0\r\n\r\n").unwrap();
    assert_eq!(chunks.read().unwrap().status, 413);
}

/// Opens a session and returns its name.
fn session(server: &LocalServer) -> String {
    let response = HttpRequest::initialize().send(server.address());
    assert_eq!(response.message()["result"]["protocolVersion"], LEGACY_VERSION);
    let session = response.header("mcp-session-id").expect("a session has a name").to_owned();
    let message = json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string();
    let initialized = HttpRequest::post(message).header("Mcp-Session-Id", &session);
    assert_eq!(initialized.send(server.address()).status, 202);
    session
}

fn ping(server: &LocalServer, session: &str) -> u16 {
    HttpRequest::in_session(session, "ping", json!({})).send(server.address()).status
}

#[test]
fn the_session_that_was_silent_for_longest_makes_room() {
    let sessions = NonZeroUsize::new(2).unwrap();
    let server = LocalServer::start(Limits { sessions, ..Limits::default() });
    let (first, second) = (session(&server), session(&server));
    assert_eq!(ping(&server, &first), 200);
    let third = session(&server);
    assert_eq!([&first, &second, &third].map(|session| ping(&server, session)), [200, 404, 200]);
}

#[test]
fn a_session_that_is_silent_for_too_long_ends() {
    let server = LocalServer::start(Limits { session_idle: 3 * SHORT, ..Limits::default() });
    let (kept, silent) = (session(&server), session(&server));
    for _ in 0..6 {
        thread::sleep(SHORT);
        assert_eq!(ping(&server, &kept), 200);
    }
    assert_eq!(ping(&server, &silent), 404);
}

#[test]
fn what_is_under_way_at_the_end_is_answered() {
    let server = LocalServer::start(Limits::default());
    let session = session(&server);
    let address = server.address();
    // A stream on which the server could say something some time, if it had anything to say.
    let mut listening = HttpConnection::open(address).unwrap();
    let listen = HttpRequest::in_session(&session, "", json!({})).method("GET");
    listening.send(&listen).unwrap();
    assert_eq!(listening.read_head().unwrap().status, 200);
    let asking = thread::spawn(move || assert_slept(&sleep(3 * SHORT).send(address)));
    thread::sleep(SHORT);
    let started = Instant::now();
    server.end();
    server.wait();
    assert!(started.elapsed() > SHORT, "it did not wait for the request");
    assert!(started.elapsed() < GRACE, "it took {:?}", started.elapsed());
    asking.join().unwrap();
    assert!(HttpConnection::open(address).is_err(), "somebody still listens");
}

#[test]
fn what_takes_too_long_at_the_end_is_broken_off() {
    let server = LocalServer::start(Limits { shutdown: SHORT, ..Limits::default() });
    let mut asking = HttpConnection::open(server.address()).unwrap();
    asking.send(&sleep(Duration::from_secs(600))).unwrap();
    thread::sleep(SHORT);
    let started = Instant::now();
    server.end();
    server.wait();
    assert!(started.elapsed() < SHORT + GRACE, "it took {:?}", started.elapsed());
    assert_ne!(asking.read().map(|response| response.status).unwrap_or_default(), 200);
}
