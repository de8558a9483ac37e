//! The map on the simulated tour.

mod judged;
