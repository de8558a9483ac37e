//! The secret that a client must know.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fs, io};

use axum::extract::{Request, State};
use axum::http::HeaderMap;
use axum::http::header::AUTHORIZATION;
use axum::middleware::Next;
use axum::response::Response;
use subtle::ConstantTimeEq;
use thiserror::Error;

use super::refused_without_token;

/// The scheme of `Authorization`, whose case does not matter.
const SCHEME: &str = "bearer";

/// A bearer token. It is never shown.
#[derive(Clone)]
pub struct Token(Arc<str>);

/// Why a token cannot be used.
#[derive(Debug, Error)]
pub enum TokenError {
    /// No client could send it.
    #[error("it must be one word of visible ASCII characters; `openssl rand -hex 32` makes a good one")]
    Form,
    /// The file cannot be read.
    #[error("the token file {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file's first line is no token.
    #[error("the first line of the token file {}: {source}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with its line.
        source: Box<TokenError>,
    },
}

impl Token {
    /// Takes a token from a text, without the space around it.
    ///
    /// # Errors
    /// If the text cannot stand in a header.
    pub fn new(text: &str) -> Result<Self, TokenError> {
        let text = text.trim();
        if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_graphic()) {
            return Err(TokenError::Form);
        }
        Ok(Self(text.into()))
    }

    /// Takes the first line of a file. A file that others may read is used, with a warning.
    ///
    /// # Errors
    /// If the file cannot be read, or its first line is no token.
    pub fn from_file(path: &Path) -> Result<Self, TokenError> {
        let text = fs::read_to_string(path)
            .map_err(|source| TokenError::Unreadable { path: path.to_owned(), source })?;
        warn_if_others_may_read(path);
        Self::new(text.lines().next().unwrap_or_default())
            .map_err(|source| TokenError::InFile { path: path.to_owned(), source: Box::new(source) })
    }

    /// Whether a request shows this token. How long this takes says nothing about the token but its length.
    fn is_shown_by(&self, headers: &HeaderMap) -> bool {
        let shown = headers.get(AUTHORIZATION).and_then(|value| value.to_str().ok());
        let Some((scheme, token)) = shown.and_then(|value| value.split_once(' ')) else {
            return false;
        };
        scheme.eq_ignore_ascii_case(SCHEME) && bool::from(token.trim().as_bytes().ct_eq(self.0.as_bytes()))
    }
}

impl fmt::Debug for Token {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("Token(…)")
    }
}

#[cfg(unix)]
fn warn_if_others_may_read(path: &Path) {
    use std::os::unix::fs::PermissionsExt;
    const GROUP_OR_OTHERS: u32 = 0o077;
    if fs::metadata(path).is_ok_and(|metadata| metadata.permissions().mode() & GROUP_OR_OTHERS != 0) {
        tracing::warn!(
            "other users of this computer may open the token file {0}; chmod 600 {0}",
            path.display()
        );
    }
}

#[cfg(not(unix))]
fn warn_if_others_may_read(_: &Path) {}

/// Lets only those pass who show the token, where there is one.
pub(super) async fn require(State(token): State<Option<Token>>, request: Request, next: Next) -> Response {
    if token.is_none_or(|token| token.is_shown_by(request.headers())) {
        return next.run(request).await;
    }
    refused_without_token()
}

#[cfg(test)]
mod tests {
    use axum::http::HeaderValue;
    use rstest::rstest;

    use super::*;

    #[rstest]
    #[case::right("Bearer s3cret", true)]
    #[case::case_of_the_scheme("bEARER s3cret", true)]
    #[case::more_space("Bearer  s3cret", true)]
    #[case::wrong("Bearer s3cres", false)]
    #[case::beginning("Bearer s3cre", false)]
    #[case::longer("Bearer s3crets", false)]
    #[case::case_of_the_token("Bearer S3cret", false)]
    #[case::nothing("Bearer ", false)]
    #[case::no_scheme("s3cret", false)]
    #[case::other_scheme("Basic s3cret", false)]
    fn only_the_token_itself_opens(#[case] shown: &'static str, #[case] opens: bool) {
        let token = Token::new("s3cret").unwrap();
        let headers = HeaderMap::from_iter([(AUTHORIZATION, HeaderValue::from_static(shown))]);
        assert_eq!(token.is_shown_by(&headers), opens);
        assert!(!token.is_shown_by(&HeaderMap::new()));
    }

    #[test]
    fn the_first_line_of_a_file_is_the_token() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        fs::write(&path, " s3cret \r\nwhat it is for\n").unwrap();
        let token = Token::from_file(&path).unwrap();
        assert_eq!(&*token.0, "s3cret");
        assert_eq!(format!("{token:?}"), "Token(…)");
    }

    #[test]
    fn what_no_client_could_send_is_no_token() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("token");
        for text in ["", "\n", "\ns3cret", "two words", "schlüssel", "a\u{7}b"] {
            fs::write(&path, text).unwrap();
            let error = Token::from_file(&path).unwrap_err().to_string();
            assert!(error.contains("token: it must be one word of visible ASCII"), "{error}");
        }
        let missing = Token::from_file(&folder.path().join("nowhere")).unwrap_err().to_string();
        assert!(missing.contains("nowhere: No such file"), "{missing}");
    }
}
