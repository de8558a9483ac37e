//! Where a provider is reached and with which key.

use std::fmt;
use std::net::IpAddr;

use reqwest::Url;
use reqwest::header::HeaderValue;

use super::Provider;
use crate::model::ModelError;

/// A secret key. It is shown nowhere.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct ApiKey(String);

impl ApiKey {
    /// Takes a key as it was given; `None` where it is blank.
    fn read(given: &str, variable: &str) -> Result<Option<Self>, ModelError> {
        let key = given.trim();
        if key.is_empty() {
            return Ok(None);
        }
        if key.chars().any(|character| character.is_control() || !character.is_ascii()) {
            return Err(unusable(format!(
                "the key in {variable} holds a line break or another character that no key has; set it to the \
                 key alone, in one line"
            )));
        }
        Ok(Some(Self(key.to_owned())))
    }

    /// A header's value, marked as sensitive. `scheme` stands before the key, such as `Bearer `.
    pub(super) fn header(&self, scheme: &str) -> Option<HeaderValue> {
        let mut value = HeaderValue::from_str(&format!("{scheme}{}", self.0)).ok()?;
        value.set_sensitive(true);
        Some(value)
    }

    /// The text with every occurrence of the key replaced.
    pub(super) fn hidden_in(&self, text: &str) -> String {
        text.replace(&self.0, "[key]")
    }
}

impl fmt::Debug for ApiKey {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("[key]")
    }
}

/// What is asked of a provider.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Service {
    /// The turns of a conversation.
    Conversation(Provider),
    /// Embeddings of texts, in OpenAI's form.
    Embeddings,
}

impl Service {
    /// Whose form it has.
    pub(super) fn provider(self) -> Provider {
        match self {
            Self::Conversation(provider) => provider,
            Self::Embeddings => Provider::OpenAi,
        }
    }

    /// How to do without it.
    pub(super) fn without(self) -> &'static str {
        match self {
            Self::Conversation(_) => "run with --model embedded",
            Self::Embeddings => "ask without --encoder",
        }
    }

    /// The path of requests below a base URL's path, which has no slash at its end.
    fn path_below(self, base: &str) -> String {
        match self {
            Self::Conversation(Provider::OpenAi) => format!("{base}/chat/completions"),
            // The version belongs to the path, but is written into base URLs all the same.
            Self::Conversation(Provider::Anthropic) => {
                format!("{}/v1/messages", base.strip_suffix("/v1").unwrap_or(base))
            }
            Self::Embeddings => format!("{base}/embeddings"),
        }
    }
}

/// Where a service is reached and with which key.
#[derive(Debug, Clone)]
pub(super) struct Endpoint {
    pub(super) service: Service,
    /// The base URL as it is shown: no user information, no trailing slash.
    pub(super) shown: String,
    /// Where requests are posted.
    pub(super) url: Url,
    pub(super) key: Option<ApiKey>,
}

impl Endpoint {
    /// The endpoint that the environment names.
    pub(super) fn from_environment(service: Service) -> Result<Self, ModelError> {
        Self::from_variables(service, |name| match std::env::var(name) {
            Ok(value) => Ok(Some(value)),
            Err(std::env::VarError::NotPresent) => Ok(None),
            Err(std::env::VarError::NotUnicode(_)) => {
                Err(unusable(format!("{name} is no text in UTF-8; set it anew or unset it")))
            }
        })
    }

    /// Reads the provider's two variables with `variable`; one that is blank counts as unset.
    pub(super) fn from_variables(
        service: Service,
        variable: impl Fn(&str) -> Result<Option<String>, ModelError>,
    ) -> Result<Self, ModelError> {
        let provider = service.provider();
        let base = variable(provider.url_variable())?.filter(|value| !value.trim().is_empty());
        let key = variable(provider.key_variable())?;
        Self::new(service, base.as_deref().unwrap_or(provider.default_url()), key.as_deref())
    }

    /// A base URL and a key as they were given.
    pub(super) fn new(service: Service, base: &str, key: Option<&str>) -> Result<Self, ModelError> {
        let provider = service.provider();
        let base_url = read_url(provider, base.trim())?;
        let key = key.map(|key| ApiKey::read(key, provider.key_variable())).transpose()?.flatten();
        let shown = base_url.as_str().trim_end_matches('/').to_owned();
        let is_own_service = shown == provider.default_url();
        if key.is_none() && (is_own_service || provider.key_need() == KeyNeed::Always) {
            return Err(unusable(format!(
                "there is no key for {provider}; set {} to one{}, or {}",
                provider.key_variable(),
                match provider.key_need() {
                    KeyNeed::Always => String::new(),
                    KeyNeed::OwnService =>
                        format!(", set {} to a server that needs none", provider.url_variable()),
                },
                service.without(),
            )));
        }
        let mut url = base_url;
        let path = url.path().trim_end_matches('/').to_owned();
        url.set_path(&service.path_below(&path));
        Ok(Self { service, shown, url, key })
    }

    /// Whose form it has.
    pub(super) fn provider(&self) -> Provider {
        self.service.provider()
    }

    /// Whether it is the service of the provider itself.
    pub(super) fn is_own_service(&self) -> bool {
        self.shown == self.provider().default_url()
    }

    /// Whether the server is on this machine.
    pub(super) fn is_loopback(&self) -> bool {
        let host = self.url.host_str().unwrap_or_default();
        let address = host.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        address.map_or_else(
            |_| host == "localhost" || host.ends_with(".localhost"),
            |address| address.is_loopback(),
        )
    }

    /// Says that a key crosses a network in the clear.
    pub(super) fn warn_of_plain_text(&self) {
        if self.key.is_some() && self.url.scheme() == "http" && !self.is_loopback() {
            tracing::warn!(
                url = self.shown,
                "the key in {} is sent over plain http, where others on the network can read it",
                self.provider().key_variable()
            );
        }
    }

    /// The text with every occurrence of the key replaced.
    pub(super) fn without_key(&self, text: &str) -> String {
        self.key.as_ref().map_or_else(|| text.to_owned(), |key| key.hidden_in(text))
    }
}

/// When a provider wants a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KeyNeed {
    /// Wherever it is reached.
    Always,
    /// Only at its own service; the servers that others run in its form often need none.
    OwnService,
}

fn read_url(provider: Provider, given: &str) -> Result<Url, ModelError> {
    let refuse = |reason: &str| {
        unusable(format!(
            "{} is {:?}, {reason}; set it to http(s)://HOST[:PORT][/PATH], such as {}",
            provider.url_variable(),
            without_secrets(given),
            provider.default_url()
        ))
    };
    let url = Url::parse(given).map_err(|error| refuse(&format!("which is no URL ({error})")))?;
    if !["http", "https"].contains(&url.scheme()) || !url.has_host() {
        return Err(refuse("which is no http or https URL"));
    }
    if !url.username().is_empty() || url.password().is_some() {
        return Err(refuse("which held a user name or a password; keys go into the key's variable"));
    }
    if url.query().is_some() || url.fragment().is_some() {
        return Err(refuse("which has a query or a fragment"));
    }
    Ok(url)
}

/// A URL as it was given, without what may be secret: user information and the query. It need not be well-formed.
fn without_secrets(given: &str) -> String {
    let shown = given.split(['?', '#']).next().unwrap_or_default();
    match shown.rsplit_once('@') {
        Some((before, host)) => {
            let scheme = before.split_once("://").map_or("", |(scheme, _)| scheme);
            if scheme.is_empty() { host.to_owned() } else { format!("{scheme}://{host}") }
        }
        None => shown.to_owned(),
    }
}

fn unusable(reason: String) -> ModelError {
    ModelError::Unusable { reason }
}
