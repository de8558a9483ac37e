//! JSON Schemas as MCP clients want them: self-contained objects without formats that validators do not know.

use coin_schemas::catalogue::strip_number_formats;
use rmcp::model::JsonObject;
use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::Value;

/// The schema of arguments: what is accepted.
pub(crate) fn of_arguments<T: JsonSchema>() -> JsonObject {
    object_schema::<T>(SchemaSettings::draft2020_12().for_deserialize())
}

/// The schema of a result: what is sent. It says which fields are always there, of what kind every field within them is,
/// and no more: hosts check results with it
/// and show it to few models, who read what a result means in the description of its tool. `schemas/schema/` has the
/// whole of it.
pub(super) fn of_output<T: JsonSchema>() -> JsonObject {
    let mut schema = Schema::from(object_schema::<T>(SchemaSettings::draft2020_12().for_serialize()));
    strip_details(&mut schema);
    transform_subschemas(&mut strip_required, &mut schema);
    into_object(schema)
}

fn strip_details(schema: &mut Schema) {
    transform_subschemas(&mut |nested: &mut Schema| strip_details(nested), schema);
    for detail in ["description", "uniqueItems", "minItems", "maxItems", "minimum", "maximum"] {
        schema.remove(detail);
    }
    strip_variants(schema);
}

fn strip_required(schema: &mut Schema) {
    transform_subschemas(&mut strip_required, schema);
    schema.remove("required");
}

/// One list of texts instead of a choice between constants, one for each text.
fn strip_variants(schema: &mut Schema) {
    let constants = |variants: &Vec<Value>| -> Option<Vec<Value>> {
        variants.iter().map(|variant| variant.get("const").cloned()).collect()
    };
    if let Some(texts) = schema.get("oneOf").and_then(Value::as_array).and_then(constants) {
        schema.remove("oneOf");
        schema.insert("type".to_owned(), "string".into());
        schema.insert("enum".to_owned(), texts.into());
    }
}

fn object_schema<T: JsonSchema>(settings: SchemaSettings) -> JsonObject {
    // Some clients do not follow references, so there are none.
    let settings = settings.with(|settings| {
        settings.inline_subschemas = true;
        settings.meta_schema = None;
    });
    let mut schema = SchemaGenerator::new(settings).into_root_schema_for::<T>();
    strip_number_formats(&mut schema);
    strip_noise(&mut schema);
    into_object(schema)
}

fn into_object(schema: Schema) -> JsonObject {
    match schema.to_value() {
        Value::Object(object) => object,
        // A schema may also be `true` or `false`; a structure's never is.
        _ => JsonObject::new(),
    }
}

/// Removes what the type system knows and a model does not need: type names as titles, the description of the
/// structure, which repeats the tool's, and the line breaks of doc comments.
fn strip_noise(schema: &mut Schema) {
    schema.remove("title");
    schema.remove("description");
    join_lines(schema);
}

fn join_lines(schema: &mut Schema) {
    transform_subschemas(&mut |nested: &mut Schema| join_lines(nested), schema);
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    }
}
