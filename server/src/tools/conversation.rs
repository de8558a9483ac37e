//! What a tool and a person say to one another through the client's own forms.
//!
//! A tool that asks is called twice: first it gives a form, then, when the client brings the form back, its result. What
//! it has to know the second time travels with the form, so that any server of the home may go on.

use coin_schemas::household::ObjectId;
use rmcp::model::JsonObject;
use serde::{Deserialize, Serialize};

use crate::store::{FormSerial, SERIAL_BYTES};

/// How the person can be reached during a call.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Person {
    /// The client shows no forms.
    OutOfReach,
    /// The client shows forms.
    WithinReach,
    /// The client brings back a form.
    Replied {
        /// What the tool knew when it gave the form.
        state: FormState,
        /// What the person made of it.
        reply: Reply,
    },
}

/// What a person made of a form.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Reply {
    /// It was filled in.
    Accepted(JsonObject),
    /// The person would not answer.
    Declined,
    /// The person put it away.
    Cancelled,
}

/// Whose turn it is after a call.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Turn<T> {
    /// The tool is done.
    Done(T),
    /// The person is to fill in a form.
    Ask(Form),
}

/// A form.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Form {
    /// What the person reads first.
    pub(crate) message: String,
    /// What may be picked.
    pub(crate) choices: Vec<String>,
    /// What the tool has to know when the form comes back.
    pub(crate) state: FormState,
}

impl Form {
    /// The field of the picked choice.
    pub(crate) const CHOICE: &'static str = "owner";
    /// The field of the person's own words.
    pub(crate) const OWN_WORDS: &'static str = "in_your_words";
}

/// What a tool has to know when a form comes back.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FormState {
    /// The thing in question.
    pub(crate) object_id: ObjectId,
    /// The question as the person reads it.
    pub(crate) question: String,
    /// How many members the household had: "all of us" means them.
    pub(crate) members: usize,
    /// The form's own number.
    serial: [u8; SERIAL_BYTES],
    /// When it stops to count, in seconds of UTC.
    pub(crate) expires_at: i64,
}

impl FormState {
    /// A new form's.
    pub(crate) fn new(
        object_id: ObjectId,
        question: String,
        members: usize,
        serial: FormSerial,
        expires_at: i64,
    ) -> Self {
        Self { object_id, question, members, serial: serial.0, expires_at }
    }

    /// The form's own number.
    pub(crate) fn serial(&self) -> FormSerial {
        FormSerial(self.serial)
    }
}
