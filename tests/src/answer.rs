//! What a server answers, checked for form.

use serde_json::Value;

/// A JSON-RPC error.
#[derive(Debug, Clone, PartialEq)]
pub struct RpcError {
    /// The code, such as -32602.
    pub code: i64,
    /// The words.
    pub message: String,
}

/// The result of `tools/call`.
#[derive(Debug, Clone, PartialEq)]
pub struct ToolAnswer {
    /// `structuredContent`; absent in an error.
    pub structured: Option<Value>,
    /// The text of the only content block.
    pub text: String,
    /// Whether the tool says that it failed.
    pub is_error: bool,
}

impl ToolAnswer {
    /// Takes a result apart. It has one content block of text; a success has the same JSON twice, a failure has
    /// words and no structured content.
    #[track_caller]
    pub(crate) fn from_result(result: &Value) -> Self {
        let blocks = result["content"].as_array().expect("a tool result has content");
        assert!(blocks.len() == 1, "a tool result has one content block: {result:#}");
        assert!(blocks[0]["type"] == "text", "the content block is text: {result:#}");
        let text = blocks[0]["text"].as_str().expect("a text block has a text").to_owned();
        let is_error = result.get("isError").and_then(Value::as_bool).unwrap_or(false);
        let structured = result.get("structuredContent").cloned();
        if is_error {
            assert!(structured.is_none(), "an error has no structured content: {result:#}");
            assert!(!text.trim().is_empty(), "an error says what is wrong: {result:#}");
        } else {
            let parsed: Value = serde_json::from_str(&text)
                .unwrap_or_else(|error| panic!("the text of a result is JSON ({error}): {text}"));
            assert!(structured.as_ref() == Some(&parsed), "text and structured content differ: {result:#}");
            assert!(parsed.is_object(), "structured content is an object: {result:#}");
        }
        Self { structured, text, is_error }
    }

    /// The structured content of a success.
    #[track_caller]
    pub fn value(self) -> Value {
        match self {
            Self { is_error: false, structured: Some(value), .. } => value,
            Self { text, .. } => panic!("the call failed: {text}"),
        }
    }

    /// The words of a failure.
    #[track_caller]
    pub fn refusal(self) -> String {
        assert!(self.is_error, "the call was not refused: {}", self.text);
        self.text
    }
}
