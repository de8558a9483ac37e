//! Parameters that are taken back where a server refuses them.
//!
//! Servers that speak the same language do not know the same parameters. What an answer names as refused is left out
//! for the rest of the run; where it names nothing, leaving out the form of the reply is tried, and only kept if it
//! helped.

use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

use serde_json::Value;

use super::Provider;
use super::failure::Failure;

/// A parameter that a request can do without, with what it is called in errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parameter {
    /// Step 0: a JSON Schema; 1: any JSON object; 2: not sent.
    ReplyForm,
    /// Step 0: `max_completion_tokens`; 1: `max_tokens`, its older name; 2: not sent.
    Length,
    /// Step 0: sent; 1: not sent.
    Temperature,
    /// Step 0: sent; 1: not sent.
    Seed,
}

const PARAMETERS: [Parameter; 4] =
    [Parameter::ReplyForm, Parameter::Length, Parameter::Temperature, Parameter::Seed];

impl Parameter {
    /// The keys of a request's body under which it may stand.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::ReplyForm => &["response_format"],
            Self::Length => &["max_completion_tokens", "max_tokens"],
            Self::Temperature => &["temperature"],
            Self::Seed => &["seed"],
        }
    }

    /// The words by which an error names it.
    fn words(self) -> &'static [&'static str] {
        match self {
            Self::ReplyForm => &[
                "response_format",
                "json_schema",
                "json schema",
                "json_object",
                "grammar",
                "structured output",
                "guided",
            ],
            Self::Length => &["max_completion_tokens", "max_tokens"],
            Self::Temperature => &["temperature"],
            Self::Seed => &["seed"],
        }
    }

    fn last_step(self) -> u8 {
        match self {
            Self::ReplyForm | Self::Length => 2,
            Self::Temperature | Self::Seed => 1,
        }
    }

    fn is_in(self, body: &Value) -> bool {
        self.keys().iter().any(|key| body.get(key).is_some())
    }
}

/// How a request gives each parameter, as steps of [`Parameter`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Offer([u8; PARAMETERS.len()]);

impl Offer {
    /// At which step a parameter is.
    pub(super) fn step(&self, parameter: Parameter) -> u8 {
        self.0[parameter as usize]
    }

    /// The same with one parameter at the next step.
    pub(super) fn without(mut self, parameter: Parameter) -> Self {
        let step = &mut self.0[parameter as usize];
        *step = (*step + 1).min(parameter.last_step());
        self
    }
}

/// What a server has been found to refuse and to accept, over all calls.
#[derive(Debug)]
pub(super) struct Concessions {
    /// What a request can do without.
    parameters: &'static [Parameter],
    steps: [AtomicU8; PARAMETERS.len()],
    /// Whether a request with a form for its reply was ever answered.
    form_accepted: AtomicBool,
}

impl Concessions {
    /// Nothing is known of the server yet.
    pub(super) fn new(provider: Provider) -> Self {
        let parameters: &[Parameter] = match provider {
            Provider::OpenAi => &PARAMETERS,
            // The length is required.
            Provider::Anthropic => &[Parameter::Temperature],
        };
        Self { parameters, steps: Default::default(), form_accepted: AtomicBool::new(false) }
    }

    /// What is offered to begin with.
    pub(super) fn offer(&self) -> Offer {
        Offer(std::array::from_fn(|place| self.steps[place].load(Ordering::Relaxed)))
    }

    /// Remembers what was answered.
    pub(super) fn accepted(&self, offer: &Offer, body: &Value) {
        if Parameter::ReplyForm.is_in(body) {
            self.form_accepted.store(true, Ordering::Relaxed);
        }
        self.remember(offer);
    }

    fn remember(&self, offer: &Offer) {
        for (step, offered) in self.steps.iter().zip(offer.0) {
            step.fetch_max(offered, Ordering::Relaxed);
        }
    }

    /// A smaller offer that may be accepted after this failure of `body`; `None` where there is none.
    pub(super) fn less(&self, offer: &Offer, body: &Value, failure: &Failure) -> Option<Offer> {
        let told = failure.objection()?;
        let sent = self.parameters.iter().copied().filter(|parameter| parameter.is_in(body));
        let named: Vec<Parameter> =
            sent.filter(|parameter| parameter.words().iter().any(|word| names(told, word))).collect();
        if !named.is_empty() {
            let less = named.into_iter().fold(*offer, Offer::without);
            self.remember(&less);
            return Some(less);
        }
        let may_be_the_form = Parameter::ReplyForm.is_in(body) && !self.form_accepted.load(Ordering::Relaxed);
        may_be_the_form.then(|| offer.without(Parameter::ReplyForm))
    }
}

/// Whether a text names a word, not just holds its letters.
fn names(text: &str, word: &str) -> bool {
    let is_part = |character: char| character.is_ascii_alphanumeric() || character == '_';
    text.match_indices(word).any(|(start, found)| {
        let before = text[..start].chars().next_back();
        let after = text[start + found.len()..].chars().next();
        !before.is_some_and(is_part) && !after.is_some_and(is_part)
    })
}

#[cfg(test)]
mod tests;
