//! Tokens are counted where the model counts none, and prompts that are let through fit into the budget.

use std::sync::atomic::{AtomicU64, Ordering};

use futures::future::join_all;
use proptest::prelude::*;
use rstest::rstest;

use super::counter::TOKENS_PER_MESSAGE;
use super::*;
use crate::model::{Message, ReplyFormat};

/// Says one thing, charges what it is told to, and remembers the prompts that it was sent.
struct Says {
    reply: Result<ChatReply, ModelError>,
    prompts: AtomicU64,
}

impl Says {
    fn new(reply: Result<ChatReply, ModelError>) -> Arc<Self> {
        Arc::new(Self { reply, prompts: AtomicU64::new(0) })
    }

    fn words(text: &str, usage: TokenUsage) -> Arc<Self> {
        Self::new(Ok(ChatReply { usage, ..ChatReply::words(text) }))
    }
}

#[async_trait]
impl ChatModel for Says {
    fn name(&self) -> &str {
        "says"
    }

    async fn complete(&self, request: &ChatRequest<'_>) -> Result<ChatReply, ModelError> {
        self.prompts.fetch_add(tokens_sent(request), Ordering::Relaxed);
        // Others get their turn before this one ends.
        tokio::task::yield_now().await;
        self.reply.clone()
    }
}

/// Every word of the tests' prompts is one token.
fn tokens_sent(request: &ChatRequest<'_>) -> u64 {
    request
        .conversation
        .iter()
        .map(|message| match message {
            Message::System { text } => TOKENS_PER_MESSAGE + text.split_whitespace().count() as u64,
            _ => panic!("the tests say nothing else"),
        })
        .sum()
}

fn usage(prompt_tokens: u64, completion_tokens: u64) -> TokenUsage {
    TokenUsage { prompt_tokens, completion_tokens }
}

async fn ask(model: &dyn ChatModel, text: &str) -> Result<ChatReply, ModelError> {
    let conversation = [Message::System { text: text.to_owned() }];
    model.complete(&ChatRequest { conversation: &conversation, tools: &[], reply: &ReplyFormat::Text }).await
}

fn budget(tokens: u64) -> TokenBudget {
    TokenBudget::new(tokens).unwrap()
}

/// "hello world" is the two tokens 24912 and 2375 of o200k.
#[tokio::test]
async fn a_conversation_is_counted_where_the_model_counts_nothing() {
    let model = Metered::new(Says::words("hello world", TokenUsage::default()));
    let counted = usage(2 + TOKENS_PER_MESSAGE, 2);
    assert_eq!(ask(&model, "hello world").await.unwrap().usage, counted);
    assert_eq!(model.spent(), counted);
}

#[tokio::test]
async fn what_the_model_counts_itself_stays() {
    let model = Metered::new(Says::words("hello", usage(70, 7)));
    assert_eq!(ask(&model, "hello world").await.unwrap().usage, usage(70, 7));
    ask(&model, "hello world").await.unwrap();
    assert_eq!(model.spent(), usage(140, 14));
}

#[tokio::test]
async fn what_is_remembered_costs_nothing() {
    let remembered = ChatReply { origin: Origin::Memory, ..ChatReply::words("hello") };
    let model = Metered::with_budget(Says::new(Ok(remembered.clone())), budget(5));
    for _ in 0..3 {
        assert_eq!(ask(&model, "hello world").await.unwrap(), remembered);
    }
    assert_eq!(model.spent(), TokenUsage::default());
}

/// A prompt of five tokens fits into what is left or is not sent.
#[rstest]
#[case::exactly(5, 1)]
#[case::one_too_few(4, 0)]
#[case::the_reply_counts(9, 1)]
#[case::twice(10, 2)]
#[tokio::test]
async fn a_prompt_that_does_not_fit_is_not_sent(#[case] limit: u64, #[case] sent: u64) {
    let says = Says::words("", usage(5, 0));
    let model = Metered::with_budget(says.clone(), budget(limit));
    for number in 0..3 {
        let outcome = ask(&model, "hello world").await;
        assert_eq!(outcome.is_ok(), number < sent);
        if let Err(error) = outcome {
            assert_eq!(error, ModelError::OutOfBudget { limit });
        }
    }
    assert_eq!(says.prompts.load(Ordering::Relaxed), 5 * sent);
}

#[tokio::test]
async fn what_the_model_charged_counts_and_not_the_estimate() {
    let model = Metered::with_budget(Says::words("", usage(2, 1)), budget(10));
    for _ in 0..2 {
        ask(&model, "hello world").await.unwrap();
    }
    assert_eq!(model.spent().total(), 6);
    assert!(ask(&model, "hello world").await.is_err(), "6 and 5 are more than 10");
    assert!(ask(&model, "hello").await.is_ok());
}

#[tokio::test]
async fn a_failed_request_gives_its_tokens_back() {
    let failure = ModelError::Unanswered { reason: "busy".to_owned() };
    let model = Metered::with_budget(Says::new(Err(failure.clone())), budget(5));
    for _ in 0..3 {
        assert_eq!(ask(&model, "hello world").await, Err(failure.clone()));
    }
    assert_eq!(model.spent(), TokenUsage::default());
}

#[tokio::test]
async fn a_request_that_nobody_waits_for_was_still_sent() {
    let model = Metered::with_budget(Says::words("", usage(5, 0)), budget(9));
    let mut call = Box::pin(ask(&model, "hello world"));
    assert!(futures::poll!(call.as_mut()).is_pending());
    drop(call);
    assert_eq!(model.spent(), usage(5, 0));
    assert_eq!(ask(&model, "hello world").await, Err(ModelError::OutOfBudget { limit: 9 }));
}

#[tokio::test]
async fn long_texts_are_counted_like_short_ones() {
    let model = Metered::new(Says::words("", TokenUsage::default()));
    let words = 40_000;
    let counted = ask(&model, &"hello ".repeat(words)).await.unwrap().usage.prompt_tokens;
    let cuts = 6 * words as u64 / 65_536 + 1;
    assert!(counted.abs_diff(words as u64 + TOKENS_PER_MESSAGE) <= 2 * cuts, "{counted}");
}

#[rstest]
#[case::white_space(" ", 1_200_000)]
#[case::one_letter("a", 100_000)]
#[case::three_bytes("€", 100_000)]
#[tokio::test]
async fn no_text_is_too_long_to_count(#[case] piece: &str, #[case] times: usize) {
    let model = Metered::new(Says::words("", TokenUsage::default()));
    assert!(ask(&model, &piece.repeat(times)).await.unwrap().usage.prompt_tokens > 100);
}

#[rstest]
#[case("1", Some(1))]
#[case("200_000", Some(200_000))]
#[case("0", None)]
#[case("-1", None)]
#[case("+1", None)]
#[case("_1", None)]
#[case("many", None)]
#[case("18446744073709551616", None)]
fn a_budget_is_a_positive_number(#[case] text: &str, #[case] tokens: Option<u64>) {
    assert_eq!(text.parse::<TokenBudget>().ok().map(TokenBudget::tokens), tokens);
}

#[test]
fn a_refused_budget_is_explained() {
    insta::assert_snapshot!("0".parse::<TokenBudget>().unwrap_err(), @r#"a budget is a whole number of tokens from 1, such as 200000 or 200_000, and "0" is none"#);
}

proptest! {
    /// The prompts that are let through fit into the budget, and what is spent exceeds it by replies alone.
    #[test]
    fn prompts_fit_into_the_budget(
        words in prop::collection::vec(1_usize..30, 1..40),
        limit in 1_u64..400,
        completion in 0_u64..20,
    ) {
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(4).build().unwrap();
        let says = Says::words(&"word ".repeat(completion as usize), TokenUsage::default());
        let model = Arc::new(Metered::with_budget(says.clone(), budget(limit)));
        let calls = words.iter().map(|&words| {
            let model = Arc::clone(&model);
            let text = vec!["word"; words].join(" ");
            runtime.spawn(async move { ask(model.as_ref(), &text).await })
        });
        let outcomes = runtime.block_on(join_all(calls.collect::<Vec<_>>()));
        let answered = outcomes.into_iter().filter(|outcome| outcome.as_ref().unwrap().is_ok()).count() as u64;
        let sent = says.prompts.load(Ordering::Relaxed);
        prop_assert!(sent <= limit);
        prop_assert_eq!(model.spent().prompt_tokens, sent);
        let longest_reply = completion + 1;
        prop_assert!(model.spent().total() <= limit + answered * longest_reply);
        prop_assert_eq!(model.account().reserved, 0);
    }
}
