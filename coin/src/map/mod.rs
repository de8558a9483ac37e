//! The semantic map (the paper's Section 4.2 and Appendix B): from a stream of detections to one entry for each thing.

pub mod detection;
pub mod tour;
