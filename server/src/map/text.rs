//! The map as a table for a terminal: one line for each thing, so that other programs can search and sort it.

use coin_schemas::household::Owners;
use coin_schemas::map::HomeMap;
use comfy_table::presets::NOTHING;
use comfy_table::{ContentArrangement, Table};

use super::{Counts, basis, percent, place, whose};
use crate::display::plain_text;

/// What stands where a thing is in no room.
const NO_ROOM: &str = "–";

/// One line for each thing below a line of titles, and at the end how many are known from what.
pub(crate) fn text(map: &HomeMap) -> String {
    let household: Owners = map.users.keys().cloned().collect();
    let mut table = Table::new();
    table.load_preset(NOTHING).set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(["room", "thing", "id", "place in metres", "owners", "sure", "from"]);
    table.add_rows(map.objects.iter().map(|object| {
        [
            object.room.as_deref().map_or(NO_ROOM.into(), plain_text).into_owned(),
            plain_text(object.class.as_str()).into_owned(),
            plain_text(object.id.as_str()).into_owned(),
            place(object),
            whose(object, &household),
            percent(object.confidence),
            basis(object).to_owned(),
        ]
    }));
    for column in table.column_iter_mut() {
        column.set_padding((0, 2));
    }
    format!("{}\n\n{}\n", table.trim_fmt(), Counts::of(&map.objects).in_words())
}
