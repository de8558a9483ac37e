//! Context-aware ownership inference with interaction (COIN): the method, without any input or output.
//!
//! Everything here is a plain function over plain data. There is no clock, no file, no network, no hidden
//! randomness and no environment: the same arguments give the same result, on every machine. The equations
//! are those of the paper *Whose Is This?: Context-Aware Object Ownership Inference with Uncertainty-Guided
//! Questioning* (Hashimoto et al.); each stands in one function that names it.

pub mod agent;
pub mod assignment;
pub mod baselines;
pub mod calibration;
pub mod captions;
pub mod common_sense;
pub mod conformal;
pub mod dialogue;
pub mod evidence;
pub mod gate;
mod language;
pub mod map;
pub mod metrics;
pub mod owners;
pub mod referring;
pub mod roster;
pub mod sharing;
pub mod similarity;
pub mod space;
pub mod statistics;
pub mod usage;

// The tests share their helpers with the integration tests, which know this crate by its name.
#[cfg(test)]
extern crate self as coin;

#[cfg(test)]
#[path = "../tests/support/mod.rs"]
mod support;
