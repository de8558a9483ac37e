//! How many tokens may be spent.

use std::num::NonZeroU64;
use std::str::FromStr;

use thiserror::Error;

/// How many tokens may be spent, prompts and replies together; at least 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TokenBudget(NonZeroU64);

/// The number is no budget.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("a budget is a whole number of tokens from 1, such as 200000 or 200_000, and {given:?} is none")]
pub struct InvalidBudget {
    /// What was given.
    given: String,
}

impl TokenBudget {
    /// So many tokens.
    ///
    /// # Errors
    /// If there are none.
    pub fn new(tokens: u64) -> Result<Self, InvalidBudget> {
        NonZeroU64::new(tokens).map(Self).ok_or_else(|| InvalidBudget { given: tokens.to_string() })
    }

    /// The number of tokens.
    pub fn tokens(self) -> u64 {
        self.0.get()
    }
}

impl FromStr for TokenBudget {
    type Err = InvalidBudget;

    fn from_str(text: &str) -> Result<Self, InvalidBudget> {
        let refused = || InvalidBudget { given: text.to_owned() };
        if !text.starts_with(|first: char| first.is_ascii_digit()) {
            return Err(refused());
        }
        text.replace('_', "").parse().map(Self).map_err(|_| refused())
    }
}
