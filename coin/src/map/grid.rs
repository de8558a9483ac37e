//! Which entries are near a place: a grid of cells, so that a search looks at a few cells and not at the home.

use std::collections::{BTreeMap, BTreeSet};

use super::entry::EntryId;

/// The edge of a cell in metres: about the reach of a cup's detection.
const CELL: f64 = 0.5;

type Cell = [i64; 3];

/// Entries by the cell of their middle.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Grid {
    cells: BTreeMap<Cell, BTreeSet<EntryId>>,
}

/// The cell of a place. The conversion keeps to the whole numbers that exist; two places beyond them share a cell.
fn cell(at: [f64; 3]) -> Cell {
    at.map(|metres| (metres / CELL).floor() as i64)
}

impl Grid {
    pub(super) fn insert(&mut self, id: EntryId, at: [f64; 3]) {
        self.cells.entry(cell(at)).or_default().insert(id);
    }

    pub(super) fn remove(&mut self, id: EntryId, at: [f64; 3]) {
        if let Some(ids) = self.cells.get_mut(&cell(at)) {
            ids.remove(&id);
            if ids.is_empty() {
                self.cells.remove(&cell(at));
            }
        }
    }

    /// Every entry in the cells that a box touches, in the order of cells: all entries in the box, and some around it.
    pub(super) fn around(&self, least: [f64; 3], greatest: [f64; 3]) -> Vec<EntryId> {
        let (first, last) = (cell(least), cell(greatest));
        let columns =
            (0..2).map(|axis| (last[axis] as f64 - first[axis] as f64 + 1.0).max(0.0)).product::<f64>();
        let in_heights = |cell: &Cell| (first[2]..=last[2]).contains(&cell[2]);
        let mut found = Vec::new();
        // A box with more columns than there are cells, as a robot in error may give it, is searched from the other side.
        if columns > self.cells.len() as f64 {
            let inside = |cell: &Cell| (0..3).all(|axis| (first[axis]..=last[axis]).contains(&cell[axis]));
            found.extend(self.cells.iter().filter(|(cell, _)| inside(cell)).flat_map(|(_, ids)| ids));
            return found;
        }
        for x in first[0]..=last[0] {
            for y in first[1]..=last[1] {
                let column = self
                    .cells
                    .range([x, y, first[2]]..)
                    .take_while(|(cell, _)| cell[0] == x && cell[1] == y && in_heights(cell));
                found.extend(column.flat_map(|(_, ids)| ids));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests;
