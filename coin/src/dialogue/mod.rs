//! What is said to a person and what the person says back, without a language model (the paper's
//! QUESTION-GENERATION and UNDERSTAND-ANSWER).

mod answer;
mod question;
mod thing;

pub use answer::{Reading, read_answer};
pub use question::{QuestionContext, word_question};
