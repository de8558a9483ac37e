use rstest::rstest;
use serde_json::json;

use super::super::failure::Refusal;
use super::*;

fn body() -> Value {
    json!({
        "messages": [], "response_format": {"type": "json_schema"}, "max_completion_tokens": 1, "temperature": 0.2,
        "seed": 1,
    })
}

fn refused(body: &str) -> Failure {
    Failure::Status(Refusal::read(400, body, None))
}

/// The steps of reply form, length, temperature and seed after an error of OpenAI's form.
fn after(error: &str) -> Option<[u8; 4]> {
    let concessions = Concessions::new(Provider::OpenAi);
    concessions.accepted(&Offer::default(), &body());
    concessions.less(&Offer::default(), &body(), &refused(error)).map(|offer| offer.0)
}

#[rstest]
// OpenAI points at it.
#[case(r#"{"error": {"message": "Unsupported value: 'temperature' does not support 0.2 with this model, nor does seed.", "param": "temperature"}}"#, Some([0, 0, 1, 0]))]
#[case(r#"{"error": {"message": "Invalid schema for response_format 'ownership'", "param": "response_format"}}"#, Some([1, 0, 0, 0]))]
#[case(r#"{"error": {"message": "This model's maximum context length is 9 tokens, less than max_tokens", "param": "messages"}}"#, None)]
// vLLM, llama.cpp, Mistral and LM Studio in their own words.
#[case(r#"{"message": "max_tokens or max_completion_tokens is too large: 8192"}"#, Some([0, 1, 0, 0]))]
#[case(r#"{"error": {"message": "Cannot use custom grammar constraints with tools.", "code": 400}}"#, Some([1, 0, 0, 0]))]
#[case(r#"{"detail": [{"loc": ["body", "seed"], "msg": "extra"}, {"loc": ["body", "max_completion_tokens"], "input": {"temperature": 1}}]}"#, Some([0, 1, 0, 1]))]
#[case(r#"{"error": "'response_format.type' must be 'json_schema' or 'text'"}"#, Some([1, 0, 0, 0]))]
#[case("temperature is not supported", Some([0, 0, 1, 0]))]
// Letters are no words.
#[case("the seeding of temperatures_of_rooms", None)]
#[case("the conversation is too long", None)]
fn what_an_error_names_is_left_out(#[case] error: &str, #[case] steps: Option<[u8; 4]>) {
    assert_eq!(after(error), steps);
}

#[test]
fn what_was_not_sent_is_not_left_out() {
    let concessions = Concessions::new(Provider::OpenAi);
    let body = json!({"messages": []});
    assert_eq!(concessions.less(&Offer::default(), &body, &refused("temperature, response_format")), None);
}

#[test]
fn the_length_is_required_by_anthropic() {
    let concessions = Concessions::new(Provider::Anthropic);
    let body = json!({"max_tokens": 8192, "temperature": 0.2});
    assert_eq!(concessions.less(&Offer::default(), &body, &refused("max_tokens: 8192 > 4096")), None);
    let less =
        concessions.less(&Offer::default(), &body, &refused("`temperature` is deprecated for this model."));
    assert_eq!(less, Some(Offer::default().without(Parameter::Temperature)));
    assert_eq!(concessions.offer(), less.unwrap(), "it is remembered");
}

#[test]
fn a_guess_is_remembered_once_it_has_helped() {
    let concessions = Concessions::new(Provider::OpenAi);
    let guess = concessions.less(&Offer::default(), &body(), &refused("no")).unwrap();
    assert_eq!(concessions.offer(), Offer::default());
    concessions.accepted(&guess, &body());
    assert_eq!(concessions.offer(), guess);
}

#[rstest]
#[case(401)]
#[case(404)]
#[case(429)]
#[case(500)]
fn only_a_refused_request_leads_to_less(#[case] status: u16) {
    let concessions = Concessions::new(Provider::OpenAi);
    let failure = Failure::Status(Refusal::read(status, "temperature", None));
    assert_eq!(concessions.less(&Offer::default(), &body(), &failure), None);
}

/// Whatever a server says, a call comes to an end.
#[test]
fn every_refusal_leaves_less_to_be_refused() {
    let concessions = Concessions::new(Provider::OpenAi);
    let mut offer = concessions.offer();
    let mut steps = 0;
    let mut body = body();
    while let Some(less) =
        concessions.less(&offer, &body, &refused("response_format seed max_tokens temperature"))
    {
        assert_ne!(less, offer);
        offer = less;
        steps += 1;
        let request = crate::model::ChatRequest {
            conversation: &[],
            tools: &[],
            reply: &crate::model::ReplyFormat::Json { name: "x".to_owned(), schema: json!({}) },
        };
        body = super::super::openai::body("gpt", &request, &offer, 1);
    }
    assert_eq!(steps, 2);
}
