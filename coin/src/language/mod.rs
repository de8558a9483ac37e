//! Words and the people they mean: what the readers of captions, answers and requests have in common.

pub(crate) mod contractions;
pub(crate) mod number;
pub(crate) mod parties;
pub(crate) mod people;
pub(crate) mod vocabulary;
pub(crate) mod words;
