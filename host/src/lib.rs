//! The agent host of COIN: it drives a model's tool calls against a tool server, lets the gate decide which
//! questions are asked, has people answer them, and reports who owns what.
//!
//! Nothing here opens the database, and no formula of the method stands here.

pub mod ask;
pub mod calibrate;
pub mod cli;
pub mod client;
mod course;
pub mod driver;
pub mod estimation;
pub mod evidence;
pub mod experiment;
pub mod generate;
pub mod home;
pub mod journal;
mod lines;
pub mod model;
pub mod observer;
pub mod output;
pub mod pages;
pub mod parallel;
pub mod person;
pub mod prompts;
pub mod reply;
pub mod report;
pub mod run;
pub mod steps;
