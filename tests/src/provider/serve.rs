//! The HTTP server of a scripted provider.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, SystemTime};

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{HeaderMap, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use axum::serve::ListenerExt;
use coin_host::model::provider::Provider;
use coin_host::model::{ChatReply, TokenUsage};
use futures::{StreamExt, stream};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use tokio::net::TcpListener;
use tokio::sync::oneshot;

use super::brain::Turn;
use super::faults::{Fault, Manner, Occasion, RetryAfter};
use super::record::{Entry, Log};
use super::spoil::spoil;
use super::{Script, anthropic, openai, rules};

/// What a path offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Service {
    Conversation,
    Embeddings,
}

struct Shared {
    script: Script,
    log: Arc<Log>,
}

/// Serves until `stopped`, and then breaks off.
pub(super) async fn serve(
    script: Script,
    log: Arc<Log>,
    address: Sender<SocketAddr>,
    stopped: oneshot::Receiver<()>,
) {
    let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port of this machine can be bound");
    address.send(listener.local_addr().expect("a bound socket has an address")).expect("somebody waits");
    // A connection that the server gives up is then reset, not closed in order.
    let listener = listener.tap_io(|connection| {
        connection.set_zero_linger().expect("the socket takes the option");
    });
    let router = Router::new()
        .fallback(answer)
        .layer(DefaultBodyLimit::disable())
        .with_state(Arc::new(Shared { script, log }));
    tokio::select! {
        served = axum::serve(listener, router) => served.expect("the server runs"),
        _ = stopped => {}
    }
}

async fn answer(State(shared): State<Arc<Shared>>, uri: Uri, headers: HeaderMap, body: Bytes) -> Response {
    let asked = match uri.path() {
        "/v1/chat/completions" => Some((Provider::OpenAi, Service::Conversation)),
        "/v1/embeddings" => Some((Provider::OpenAi, Service::Embeddings)),
        "/v1/messages" => Some((Provider::Anthropic, Service::Conversation)),
        _ => None,
    };
    let headers: BTreeMap<String, String> = headers
        .iter()
        .map(|(name, value)| (name.to_string(), String::from_utf8_lossy(value.as_bytes()).into_owned()))
        .collect();
    let body: Value = serde_json::from_slice(&body).unwrap_or_default();
    let provider = asked.map(|(provider, _)| provider);
    let entry = shared.log.begin(provider, uri.path(), headers.clone(), body.clone());
    let Some((provider, service)) = asked else {
        entry.note(|request| request.violations.push(format!("there is nothing at {}", request.path)));
        return finish(&entry, StatusCode::NOT_FOUND.into_response());
    };
    entry.note(|request| {
        request.violations = match service {
            Service::Conversation => rules::violations(provider, &headers, &body),
            Service::Embeddings => rules::embedding_violations(&headers, &body),
        }
    });
    let key = key(provider, &headers);
    let exchange = Exchange { script: &shared.script, entry: &entry, provider, service, key, body };
    let response = exchange.respond().await;
    finish(&entry, response)
}

fn finish(entry: &Entry, response: Response) -> Response {
    entry.note(|request| request.status = Some(response.status().as_u16()));
    response
}

fn key(provider: Provider, headers: &BTreeMap<String, String>) -> Option<String> {
    match provider {
        Provider::OpenAi => headers.get("authorization")?.strip_prefix("Bearer ").map(str::to_owned),
        Provider::Anthropic => headers.get("x-api-key").cloned(),
    }
}

/// One request and what belongs to it.
struct Exchange<'a> {
    script: &'a Script,
    entry: &'a Entry,
    provider: Provider,
    service: Service,
    key: Option<String>,
    body: Value,
}

impl Exchange<'_> {
    async fn respond(&self) -> Response {
        if self.script.key.is_some() && self.key != self.script.key {
            return self.error(401, "this key is not valid", None);
        }
        if self.script.model.as_ref().is_some_and(|model| self.body["model"] != **model) {
            return self.error(404, "there is no such model", Some("model"));
        }
        if let Some(parameter) = self.script.refuses.iter().find(|name| self.holds(name)) {
            return match self.script.manner {
                Manner::Named => self.refusal(parameter),
                Manner::Unnamed => self.error(400, "the request cannot be handled", None),
            };
        }
        let turn = match self.provider {
            Provider::OpenAi => openai::turn(&self.body),
            Provider::Anthropic => anthropic::turn(&self.body),
        };
        let mut occasion = Occasion {
            number: self.entry.number,
            repetitions: self.entry.repetitions,
            turn: &turn,
            chance: self.chance(),
        };
        let fault = self.script.faults.decide(&mut occasion);
        // What is wrong with the transport happens before anybody thinks.
        if let Some(response) = fault.and_then(|fault| self.broken(fault)) {
            self.entry.note(|request| request.fault = fault);
            tokio::time::sleep(self.script.delay).await;
            return response;
        }
        if fault == Some(Fault::Silence) {
            self.entry.note(|request| request.fault = fault);
            std::future::pending::<()>().await;
        }
        tokio::time::sleep(self.script.delay).await;
        match self.service {
            Service::Conversation => self.think(&turn, fault),
            Service::Embeddings => {
                let embedding = (self.script.encoder)(self.body["input"].as_str().unwrap_or_default());
                json(200, &openai::embedding(&embedding, &self.body["model"]))
            }
        }
    }

    fn think(&self, turn: &Turn, fault: Option<Fault>) -> Response {
        self.entry.note(|request| request.was_thought_about = true);
        let mut reply = match self.script.brain.think(turn) {
            Ok(reply) => reply,
            Err(reason) => return self.error(500, &reason, None),
        };
        if let Some(spoilt) = fault.and_then(|fault| spoil(&reply, turn, fault)) {
            self.entry.note(|request| request.fault = fault);
            reply = spoilt;
        }
        let usage = self.usage(&reply);
        self.entry.note(|request| request.usage = usage);
        let id = format!("{:016x}", self.fingerprint());
        json(
            200,
            &match self.provider {
                Provider::OpenAi => openai::answer(&reply, &self.body["model"], &id, usage),
                Provider::Anthropic => anthropic::answer(&reply, &self.body["model"], &id, usage),
            },
        )
    }

    /// What the brain charges, or about four bytes a token where it charges nothing.
    fn usage(&self, reply: &ChatReply) -> TokenUsage {
        if reply.usage != TokenUsage::default() {
            return reply.usage;
        }
        let calls: usize = reply.tool_calls.iter().map(|call| call.arguments.to_text().len()).sum();
        let said = reply.text.as_ref().map_or(0, String::len) + calls;
        let tokens = |bytes: usize| bytes.div_ceil(4) as u64;
        TokenUsage { prompt_tokens: tokens(self.body.to_string().len()), completion_tokens: tokens(said) }
    }

    /// The same for the same body, and different for every repetition of it.
    fn fingerprint(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.script.seed, self.body.to_string(), self.entry.repetitions).hash(&mut hasher);
        hasher.finish()
    }

    fn chance(&self) -> ChaCha8Rng {
        ChaCha8Rng::seed_from_u64(self.fingerprint())
    }

    fn holds(&self, name: &str) -> bool {
        match name {
            "json_schema" | "json_object" => self.body["response_format"]["type"] == name,
            _ => self.body.get(name).is_some(),
        }
    }

    fn refusal(&self, parameter: &str) -> Response {
        match self.provider {
            Provider::Anthropic => {
                self.error(400, &format!("{parameter}: `{parameter}` is deprecated for this model."), None)
            }
            Provider::OpenAi if parameter.starts_with("json_") => {
                let message =
                    format!("'response_format' of type '{parameter}' is not supported with this model.");
                self.error(400, &message, Some("response_format"))
            }
            Provider::OpenAi => {
                let message =
                    format!("Unsupported parameter: '{parameter}' is not supported with this model.");
                self.error(400, &message, Some(parameter))
            }
        }
    }

    /// An error in the provider's form. As careless servers do, it repeats the key.
    fn error(&self, status: u16, message: &str, parameter: Option<&str>) -> Response {
        let key = self.key.as_ref().map(|key| format!(" (your key is {key})")).unwrap_or_default();
        let message = format!("{message}{key}");
        let kind = match status {
            401 => "authentication_error",
            403 => "permission_error",
            404 => "not_found_error",
            429 => "rate_limit_error",
            529 => "overloaded_error",
            500.. => "api_error",
            _ => "invalid_request_error",
        };
        json(
            status,
            &match self.provider {
                Provider::OpenAi => openai::error(&message, kind, None, parameter),
                Provider::Anthropic => anthropic::error(&message, kind),
            },
        )
    }

    /// The response for a fault of the transport.
    fn broken(&self, fault: Fault) -> Option<Response> {
        Some(match fault {
            Fault::Status(status) => self.error(status, "scripted", None),
            Fault::RateLimited(wait) => self.rate_limited(wait),
            Fault::QuotaUsedUp => match self.provider {
                Provider::OpenAi => {
                    let message = "You exceeded your current quota, please check your plan.";
                    json(429, &openai::error(message, "insufficient_quota", Some("insufficient_quota"), None))
                }
                Provider::Anthropic => {
                    self.error(400, "Your credit balance is too low to access the Anthropic API.", None)
                }
            },
            Fault::Reset => {
                let half = Ok(Bytes::from_static(b"{\"id\": "));
                let broken = stream::once(async {
                    // The first half must be on its way.
                    tokio::time::sleep(Duration::from_millis(20)).await;
                    Err(std::io::Error::other("scripted reset"))
                });
                Body::from_stream(stream::iter([half]).chain(broken)).into_response()
            }
            Fault::EndlessBody => {
                let piece = |()| async {
                    tokio::time::sleep(Duration::from_millis(20)).await;
                    Some((Ok::<_, std::io::Error>(Bytes::from_static(b" ")), ()))
                };
                Body::from_stream(stream::unfold((), piece)).into_response()
            }
            Fault::Html => {
                let key = self.key.as_deref().unwrap_or_default();
                let page = format!("<!DOCTYPE html>\n<title>Sign in</title><p>Hello {key}");
                ([(header::CONTENT_TYPE, "text/html")], page).into_response()
            }
            Fault::OtherJson => json(200, &serde_json::json!({"status": "ok", "you": self.key})),
            Fault::Redirect => {
                (StatusCode::TEMPORARY_REDIRECT, [(header::LOCATION, "/elsewhere")]).into_response()
            }
            _ => return None,
        })
    }

    fn rate_limited(&self, wait: Option<RetryAfter>) -> Response {
        let mut response = self.error(429, "too many requests", None);
        let header = match wait {
            None => return response,
            Some(RetryAfter::Seconds(seconds)) => ("retry-after", seconds.to_string()),
            Some(RetryAfter::Milliseconds(milliseconds)) => ("retry-after-ms", milliseconds.to_string()),
            Some(RetryAfter::Date(wait)) => {
                ("retry-after", httpdate::fmt_http_date(SystemTime::now() + wait))
            }
        };
        response.headers_mut().insert(header.0, header.1.parse().expect("numbers and dates fit a header"));
        response
    }
}

fn json(status: u16, body: &Value) -> Response {
    let status = StatusCode::from_u16(status).expect("the script gives statuses of HTTP");
    (status, [(header::CONTENT_TYPE, "application/json")], body.to_string()).into_response()
}
