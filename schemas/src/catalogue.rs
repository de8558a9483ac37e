//! Every JSON Schema that the project publishes, by file name.

use schemars::{JsonSchema, SchemaGenerator, generate::SchemaSettings};
use serde_json::Value;

use crate::{calibration, doctor, episode, events, experiment, journal, map, model, report, tape, tools};

fn schema_of<T: JsonSchema>() -> Value {
    let mut schema = SchemaGenerator::from(SchemaSettings::draft2020_12()).into_root_schema_for::<T>();
    strip_number_formats(&mut schema);
    schema.to_value()
}

/// Removes `format` beside numbers: `uint32`, `double` and the like are no formats of JSON Schema, and
/// validators warn of them or refuse them.
pub fn strip_number_formats(schema: &mut schemars::Schema) {
    schemars::transform::transform_subschemas(
        &mut |nested: &mut schemars::Schema| strip_number_formats(nested),
        schema,
    );
    let is_text = schema.get("type").and_then(Value::as_str) == Some("string");
    if !is_text {
        schema.remove("format");
    }
}

/// `(file name, schema)` of everything that crosses a boundary.
pub fn schemas() -> Vec<(&'static str, Value)> {
    vec![
        ("diagnosis.schema.json", schema_of::<doctor::Diagnosis>()),
        ("home-map.schema.json", schema_of::<map::HomeMap>()),
        ("episode.schema.json", schema_of::<episode::Episode>()),
        ("caption-line.schema.json", schema_of::<episode::CaptionLine>()),
        ("truth.schema.json", schema_of::<episode::Truth>()),
        ("calibration.schema.json", schema_of::<calibration::Calibration>()),
        ("report.schema.json", schema_of::<report::Report>()),
        ("experiment-results.schema.json", schema_of::<experiment::ExperimentResults>()),
        ("log-event.schema.json", schema_of::<events::LogEvent>()),
        ("journal-entry.schema.json", schema_of::<journal::JournalEntry>()),
        ("tape-header.schema.json", schema_of::<tape::TapeHeader>()),
        ("tape-exchange.schema.json", schema_of::<tape::Exchange>()),
        ("task.schema.json", schema_of::<model::Task>()),
        ("ownership-reply.schema.json", schema_of::<model::OwnershipReply>()),
        ("ownerships-reply.schema.json", schema_of::<model::OwnershipsReply>()),
        ("reading-reply.schema.json", schema_of::<model::ReadingReply>()),
        ("sharing-reply.schema.json", schema_of::<model::SharingReply>()),
        ("get-usage-summary.arguments.schema.json", schema_of::<tools::GetUsageSummary>()),
        ("get-usage-summary.result.schema.json", schema_of::<tools::UsageSummary>()),
        ("nearby-objects.arguments.schema.json", schema_of::<tools::NearbyObjects>()),
        ("nearby-objects.result.schema.json", schema_of::<tools::NearbyObjectsResult>()),
        ("similar-objects.arguments.schema.json", schema_of::<tools::SimilarObjects>()),
        ("similar-objects.result.schema.json", schema_of::<tools::SimilarObjectsResult>()),
        ("record-answer.arguments.schema.json", schema_of::<tools::RecordAnswer>()),
        ("record-answer.result.schema.json", schema_of::<tools::RecordAnswerResult>()),
        ("retract-answer.arguments.schema.json", schema_of::<tools::RetractAnswer>()),
        ("retract-answer.result.schema.json", schema_of::<tools::RetractAnswerResult>()),
        ("record-usage.arguments.schema.json", schema_of::<tools::RecordUsage>()),
        ("record-usage.result.schema.json", schema_of::<tools::RecordUsageResult>()),
        ("record-scores.arguments.schema.json", schema_of::<tools::RecordScores>()),
        ("record-scores.result.schema.json", schema_of::<tools::RecordScoresResult>()),
        ("list-objects.arguments.schema.json", schema_of::<tools::ListObjects>()),
        ("list-objects.result.schema.json", schema_of::<tools::ListObjectsResult>()),
        ("list-users.arguments.schema.json", schema_of::<tools::ListUsers>()),
        ("list-users.result.schema.json", schema_of::<tools::ListUsersResult>()),
        ("observe-objects.arguments.schema.json", schema_of::<tools::ObserveObjects>()),
        ("observe-objects.result.schema.json", schema_of::<tools::ObserveObjectsResult>()),
        ("find-object.arguments.schema.json", schema_of::<tools::FindObject>()),
        ("find-object.result.schema.json", schema_of::<tools::FindObjectResult>()),
        ("whose-is.arguments.schema.json", schema_of::<tools::WhoseIs>()),
        ("whose-is.result.schema.json", schema_of::<tools::WhoseIsResult>()),
        ("next-question.arguments.schema.json", schema_of::<tools::NextQuestion>()),
        ("next-question.result.schema.json", schema_of::<tools::NextQuestionResult>()),
        ("ask-owner.arguments.schema.json", schema_of::<tools::AskOwner>()),
        ("ask-owner.result.schema.json", schema_of::<tools::AskOwnerResult>()),
        ("add-user.arguments.schema.json", schema_of::<tools::AddUser>()),
        ("add-user.result.schema.json", schema_of::<tools::AddUserResult>()),
    ]
}
