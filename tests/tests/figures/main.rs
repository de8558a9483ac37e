//! Figures that the documentation gives or the project promises, times aside: the tables of the experiment, the built-in
//! calibrations, real homes and a robot's tour. They take minutes and need optimised programs, so they are made anew only with
//! `COIN_SLOW_TESTS=1 cargo test --release -p coin-tests --test figures -- --nocapture --test-threads=1`.

mod calibrations;
mod experiment;
mod real_routines;
mod tour;
