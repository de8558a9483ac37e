//! `record_usage`: what was seen to be done with things.

use std::collections::HashMap;

use coin::captions::CaptionReader;
use coin_schemas::tools::{MAX_CAPTIONS, RecordUsage, RecordUsageResult, RejectedCaption, UsageCaption};

use super::fields::{self, quoted};
use super::{Effect, Tool, ToolError};
use crate::store::{
    Call, EVENTS_BETWEEN_REPORTS, Household, ObjectKey, Progress, Reader, Stage, Store, StoreError,
    UsageRecord,
};

/// Near misses are looked for this many times in a call; comparing ids takes time.
const EXPLAINED_IDS: usize = 20;

pub(super) struct RecordUsageTool;

impl Tool for RecordUsageTool {
    const NAME: &'static str = "record_usage";
    const TITLE: &'static str = "Record what was seen";
    const DESCRIPTION: &'static str = "Stores captions of what people were seen to do with things; \
        get_usage_summary makes its summary of them. A caption is one line that begins with the home's local \
        time. The person is read from the line; where none can be told the event counts as unattributed. A \
        line that is there already is counted as a duplicate. Lines that cannot be stored are listed in \
        rejected, and all others are stored together.";
    const EXAMPLE: &'static str =
        r#"{"captions": [{"object_id": "3", "caption": "2025-01-19 19:00 Bob takes the Marker"}]}"#;
    const EFFECT: Effect = Effect::Records;

    type Arguments = RecordUsage;
    type Output = RecordUsageResult;

    fn call(store: &Store, arguments: RecordUsage) -> Result<RecordUsageResult, ToolError> {
        let captions = &arguments.captions;
        if captions.len() > MAX_CAPTIONS {
            return Err(ToolError::field(
                "captions",
                format!("{} are given; at most {MAX_CAPTIONS} are allowed in a call", captions.len()),
            ));
        }
        let (household, objects) = store.read(|reader| {
            Ok::<_, ToolError>((fields::household(reader)?, find_objects(reader, captions)?))
        })?;
        // Reading the captions takes longer than storing them, so it is done while nobody has to wait.
        let (records, rejected) = read_captions(captions, &household, &objects, store.call())?;
        let counts = store.write(|writer| {
            let present = fields::household(writer)?;
            // Somebody may have joined meanwhile, and be named in the captions.
            let again = (present != household)
                .then(|| read_captions(captions, &present, &objects, store.call()))
                .transpose()?;
            let records = again.map_or(records, |(records, _)| records);
            let counts = writer.record_usage(&present, &records)?;
            // A camera whose clock is wrong must not carry the home's present into the future with it.
            let plausible = fields::tomorrow();
            let past = records.iter().map(|record| record.observation.at).filter(|&at| at <= plausible);
            if let Some(latest) = past.max() {
                writer.advance_clock(latest)?;
            }
            Ok::<_, ToolError>(counts)
        })?;
        Ok(RecordUsageResult {
            recorded: counts.recorded,
            unattributed: counts.unattributed,
            duplicates: counts.duplicates,
            rejected,
        })
    }
}

type Objects<'a> = HashMap<&'a str, Result<ObjectKey, String>>;

/// The key of every id that the captions name, or what is wrong with the id.
fn find_objects<'a>(reader: &Reader<'_>, captions: &'a [UsageCaption]) -> Result<Objects<'a>, StoreError> {
    let mut objects = Objects::new();
    let mut unknown = 0;
    for caption in captions {
        let id = caption.object_id.as_str();
        if objects.contains_key(id) {
            continue;
        }
        let found = match reader.object_key(id)? {
            Some(key) => Ok(key),
            None if unknown < EXPLAINED_IDS => {
                unknown += 1;
                Err(format!("object_id: {}", fields::unknown_object(reader, id)?))
            }
            None => Err(format!("object_id: there is no object {}", quoted(id))),
        };
        objects.insert(id, found);
    }
    Ok(objects)
}

fn read_captions<'a>(
    captions: &'a [UsageCaption],
    household: &Household,
    objects: &Objects<'_>,
    call: &Call,
) -> Result<(Vec<UsageRecord<'a>>, Vec<RejectedCaption>), StoreError> {
    let reader = CaptionReader::new(household.roster());
    let total = captions.len() as u64;
    let mut records = Vec::with_capacity(captions.len());
    let mut rejected = Vec::new();
    for (index, UsageCaption { object_id, caption }) in captions.iter().enumerate() {
        let done = index as u64;
        if index % EVENTS_BETWEEN_REPORTS == 0 {
            call.advance(Progress { stage: Stage::Reading, done, total })?;
        }
        match read_caption(&reader, objects, object_id, caption) {
            Ok(record) => records.push(record),
            Err(reason) => rejected.push(RejectedCaption { index: done, reason }),
        }
    }
    Ok((records, rejected))
}

fn read_caption<'a>(
    reader: &CaptionReader,
    objects: &Objects<'_>,
    object_id: &str,
    caption: &'a str,
) -> Result<UsageRecord<'a>, String> {
    let object = objects.get(object_id).cloned().unwrap_or_else(|| Err("object_id: unknown".to_owned()))?;
    let observation = reader.read(caption).map_err(|source| format!("caption: {source}"))?;
    Ok(UsageRecord { object, observation, caption })
}
