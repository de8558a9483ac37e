//! What is said to a person and what the person says back, without a language model (the paper's
//! QUESTION-GENERATION and UNDERSTAND-ANSWER).

mod answer;
mod choices;
mod confirmation;
mod explanation;
mod joint;
mod question;
pub(crate) mod thing;
pub(crate) mod wording;

pub use answer::{Reading, read_answer};
pub use choices::{Choice, Meaning, choices, meaning_of};
pub use confirmation::{Doubt, word_confirmation};
pub use explanation::{
    Conclusion, Explained, Grounds, RelativeGrounds, SeenRelation, Standing, UserGrounds, explain,
};
pub use joint::{as_of_one_thing, read_joint_answer, word_joint_question};
pub use question::{QuestionContext, word_question};
