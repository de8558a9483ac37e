//! Measures how fast MCP servers answer the same calls over standard input and output.
//!
//! It reads a plan from standard input and prints what it measured, both as JSON; `clients/run benchmark` makes the
//! one and reads the other. The servers run side by side and take turns in rounds, so that whatever the machine does
//! meanwhile meets all of them.

mod connection;
mod process;

use std::io::{Read, stdin};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use connection::Connection;

/// What is to be measured.
#[derive(Debug, Deserialize)]
struct Plan {
    servers: Vec<Server>,
    /// The parameters of the calls, which are made in turn.
    calls: Vec<Value>,
    /// How often every server is started, to see how long that takes.
    starts: usize,
    /// Calls before anything is measured.
    warm_up: usize,
    rounds: usize,
    calls_a_round: usize,
}

/// A server and the command that starts it.
#[derive(Debug, Deserialize)]
struct Server {
    name: String,
    command: Vec<String>,
}

/// What one server showed.
#[derive(Debug, Serialize)]
struct Figures {
    name: String,
    /// Results of the calls of the plan, to be compared.
    results: Vec<Value>,
    /// From the start of the program to the answer of the first call, for each start.
    start_milliseconds: Vec<f64>,
    /// For each round, for each call.
    microseconds: Vec<Vec<f64>>,
    /// Of all threads of the server, between the first and the last round.
    processor_microseconds_a_call: f64,
    peak_memory_mebibytes: f64,
}

fn main() {
    let mut text = String::new();
    stdin().read_to_string(&mut text).expect("standard input can be read");
    let plan: Plan = serde_json::from_str(&text).expect("standard input holds a plan");
    println!("{}", json!(measure(&plan)));
}

fn measure(plan: &Plan) -> Vec<Figures> {
    let mut runs: Vec<Run<'_>> = plan.servers.iter().map(|server| Run::begin(server, plan)).collect();
    let servers = runs.len();
    for turn in 0..plan.rounds {
        // Nobody is always the first of a round.
        for place in 0..servers {
            runs[(place + turn) % servers].round();
        }
    }
    runs.into_iter().map(Run::end).collect()
}

/// A server while it is measured.
struct Run<'a> {
    plan: &'a Plan,
    connection: Connection,
    used_before: Duration,
    figures: Figures,
}

impl<'a> Run<'a> {
    fn begin(server: &Server, plan: &'a Plan) -> Self {
        let start = |_| {
            let started = Instant::now();
            Connection::open(&server.command).call(&plan.calls[0]);
            started.elapsed().as_secs_f64() * 1e3
        };
        let start_milliseconds = (0..plan.starts).map(start).collect();
        let mut connection = Connection::open(&server.command);
        let results = plan.calls.iter().map(|parameters| connection.result(parameters)).collect();
        call(&mut connection, plan, plan.warm_up);
        Self {
            used_before: process::used(connection.process()),
            plan,
            connection,
            figures: Figures {
                name: server.name.clone(),
                results,
                start_milliseconds,
                microseconds: Vec::new(),
                processor_microseconds_a_call: 0.0,
                peak_memory_mebibytes: 0.0,
            },
        }
    }

    fn round(&mut self) {
        self.figures.microseconds.push(call(&mut self.connection, self.plan, self.plan.calls_a_round));
    }

    fn end(mut self) -> Figures {
        let process = self.connection.process();
        let used = process::used(process).saturating_sub(self.used_before);
        let calls = (self.plan.rounds * self.plan.calls_a_round) as f64;
        self.figures.processor_microseconds_a_call = used.as_secs_f64() * 1e6 / calls;
        self.figures.peak_memory_mebibytes = process::peak_memory(process) as f64 / 1024.0;
        self.figures
    }
}

/// Makes so many calls of the plan, and tells how many microseconds each took.
fn call(connection: &mut Connection, plan: &Plan, calls: usize) -> Vec<f64> {
    let parameters = plan.calls.iter().cycle().take(calls);
    parameters.map(|parameters| connection.call(parameters).as_secs_f64() * 1e6).collect()
}
