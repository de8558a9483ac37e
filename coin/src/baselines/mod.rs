//! The methods that the paper compares COIN with, as far as they need no model: two heuristics and a generative model.

pub mod actowl;
mod frequency;
mod last_user;
#[cfg(test)]
mod tests;

pub use frequency::frequency;
pub use last_user::last_user;
