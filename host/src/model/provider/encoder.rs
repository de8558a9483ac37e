//! Encoders behind HTTP: OpenAI's embeddings, which many servers speak.

use std::str::FromStr;

use serde_json::{Value, json};
use thiserror::Error;

use super::connection::Connection;
use super::endpoint::{Endpoint, Service};
use super::{Provider, ProviderSettings};
use crate::model::ModelError;

/// The name of an encoder at a server that speaks OpenAI's embeddings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncoderName(String);

/// Why a text names no encoder.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{given:?} names no encoder; give openai:NAME (any server that speaks OpenAI's Embeddings, at OPENAI_BASE_URL)"
)]
pub struct UnknownEncoder {
    given: String,
}

impl FromStr for EncoderName {
    type Err = UnknownEncoder;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.strip_prefix(Provider::OpenAi.prefix()).and_then(|rest| rest.strip_prefix(':')) {
            Some(name) if !name.is_empty() => Ok(Self(name.to_owned())),
            _ => Err(UnknownEncoder { given: text.to_owned() }),
        }
    }
}

/// Turns words into directions of a feature space. Only the encoder that made a map's features knows its space.
#[derive(Debug)]
pub struct RemoteEncoder {
    name: EncoderName,
    connection: Connection,
}

impl RemoteEncoder {
    /// An encoder whose key and base URL are in the environment.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] if the key is missing or a variable is malformed.
    pub fn from_environment(name: EncoderName, settings: &ProviderSettings) -> Result<Self, ModelError> {
        Self::of(Endpoint::from_environment(Service::Embeddings)?, name, settings)
    }

    /// An encoder at a base URL, such as `http://127.0.0.1:7997/v1`, with a key where the server wants one.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] as for [`RemoteEncoder::from_environment`].
    pub fn at(
        name: EncoderName,
        base_url: &str,
        key: Option<&str>,
        settings: &ProviderSettings,
    ) -> Result<Self, ModelError> {
        Self::of(Endpoint::new(Service::Embeddings, base_url, key)?, name, settings)
    }

    fn of(endpoint: Endpoint, name: EncoderName, settings: &ProviderSettings) -> Result<Self, ModelError> {
        Ok(Self { name, connection: Connection::new(endpoint, settings)? })
    }

    /// The embedding of a text, of whatever length and dimensions the encoder gives it.
    ///
    /// # Errors
    /// [`ModelError::Unusable`] where no request can succeed, [`ModelError::Unanswered`] where this one did not.
    pub async fn embed(&self, text: &str) -> Result<Vec<f64>, ModelError> {
        let EncoderName(name) = &self.name;
        let body = json!({"model": name, "input": text, "encoding_format": "float"});
        let answered = self.connection.send(&body, embedding).await;
        answered.map_err(|given_up| self.connection.explain(&given_up, name))
    }
}

/// Reads the embedding of the one text that was sent.
fn embedding(answer: &Value) -> Result<Vec<f64>, String> {
    let numbers = answer
        .pointer("/data/0/embedding")
        .and_then(Value::as_array)
        .filter(|numbers| !numbers.is_empty())
        .ok_or_else(|| match answer.pointer("/error/message") {
            // Some gateways answer 200 although the encoder behind them failed.
            Some(Value::String(message)) => format!("the answer is an error, {message:?}"),
            _ => "the answer holds no embedding".to_owned(),
        })?;
    let number =
        |value: &Value| value.as_f64().ok_or_else(|| "the embedding holds more than numbers".to_owned());
    numbers.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use rstest::rstest;

    use super::*;

    #[test]
    fn an_encoder_is_named_with_its_provider() {
        assert_eq!("openai:clip:b-32".parse(), Ok(EncoderName("clip:b-32".to_owned())));
    }

    #[rstest]
    #[case("clip")]
    #[case("openai:")]
    #[case("openai")]
    #[case("anthropic:clip")]
    #[case("")]
    fn anything_else_is_told_what_there_is(#[case] text: &str) {
        let error = text.parse::<EncoderName>().unwrap_err().to_string();
        assert!(error.contains("openai:NAME") && error.contains("OPENAI_BASE_URL"), "{error}");
    }

    #[rstest]
    #[case(json!({"data": [{"index": 0, "embedding": [0.5, -1, 2e-3]}]}), Ok(vec![0.5, -1.0, 2e-3]))]
    #[case(json!({"data": [{"embedding": []}]}), Err("the answer holds no embedding"))]
    #[case(json!({"data": [{"embedding": "AACAPw=="}]}), Err("the answer holds no embedding"))]
    #[case(json!({"data": [{"embedding": [0.5, null]}]}), Err("the embedding holds more than numbers"))]
    #[case(json!({"error": {"message": "overloaded"}}), Err("the answer is an error, \"overloaded\""))]
    #[case(json!([]), Err("the answer holds no embedding"))]
    fn an_answer_is_read(#[case] answer: Value, #[case] expected: Result<Vec<f64>, &str>) {
        assert_eq!(embedding(&answer), expected.map_err(str::to_owned));
    }
}
