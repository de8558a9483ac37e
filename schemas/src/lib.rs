//! The shared vocabulary of COIN: every type that crosses a process or a file boundary.
//!
//! The types here hold data and check its form; they decide nothing. The JSON Schemas under
//! `schemas/schema/` are generated from them (see [`catalogue`]), so a program that reads our files needs no
//! Rust, and a type and its schema cannot drift apart.

pub mod calibration;
pub mod catalogue;
pub mod chat;
pub mod doctor;
pub mod episode;
pub mod events;
pub mod experiment;
pub mod household;
pub mod journal;
pub mod map;
pub mod model;
pub mod report;
pub mod tape;
pub mod tools;
