//! The assignment problem: who goes with whom so that the costs are least in all.

/// Gives every row at most one column, and every column at most one row, so that the sum of the costs is least; a row
/// without a column costs `alone`. An infinite cost forbids a pair. Every row of `costs` must have the same length.
///
/// The Hungarian method with shortest augmenting paths (Kuhn 1955; Jonker and Volgenant 1987): O(n² (n + m)) for n
/// rows and m columns. Being alone is a column of each row's own, so a solution always exists.
///
/// Of several best assignments the same one is taken each time, but which one depends on the order of rows and columns.
pub fn least_cost(costs: &[Vec<f64>], alone: f64) -> Vec<Option<usize>> {
    let columns = costs.first().map_or(0, Vec::len);
    let mut search = Search {
        costs,
        columns,
        alone,
        row_potentials: vec![0.0; costs.len()],
        column_potentials: vec![0.0; columns + costs.len()],
        row_of: vec![None; columns + costs.len()],
    };
    for row in 0..costs.len() {
        search.augment(row);
    }
    let mut column_of = vec![None; costs.len()];
    for (column, row) in search.row_of.iter().take(columns).enumerate() {
        if let Some(row) = *row {
            column_of[row] = Some(column);
        }
    }
    column_of
}

struct Search<'a> {
    costs: &'a [Vec<f64>],
    columns: usize,
    alone: f64,
    row_potentials: Vec<f64>,
    column_potentials: Vec<f64>,
    /// The row of each column; the columns after the real ones are those of the rows that stay alone.
    row_of: Vec<Option<usize>>,
}

impl Search<'_> {
    /// What is left of a cost under the potentials; never negative but for rounding.
    fn reduced(&self, row: usize, column: usize) -> f64 {
        let cost = match self.costs[row].get(column) {
            Some(&cost) => cost,
            None if column == self.columns + row => self.alone,
            None => f64::INFINITY,
        };
        cost - self.row_potentials[row] - self.column_potentials[column]
    }

    /// Adds a row, along the shortest path from it to a free column.
    fn augment(&mut self, new: usize) {
        let all = self.row_of.len();
        let mut distance = vec![f64::INFINITY; all];
        let mut before: Vec<Option<usize>> = vec![None; all];
        let mut settled = vec![false; all];
        let mut reached = 0.0;
        let mut row = new;
        let mut last: Option<usize> = None;
        let end = loop {
            for column in (0..all).filter(|&column| !settled[column]) {
                let through = reached + self.reduced(row, column);
                if through < distance[column] {
                    distance[column] = through;
                    before[column] = last;
                }
            }
            let open = (0..all).filter(|&column| !settled[column]);
            let Some(nearest) = open.min_by(|&a, &b| distance[a].total_cmp(&distance[b])) else { return };
            settled[nearest] = true;
            reached = distance[nearest];
            match self.row_of[nearest] {
                Some(owner) => (row, last) = (owner, Some(nearest)),
                None => break nearest,
            }
        };
        for column in (0..all).filter(|&column| settled[column]) {
            let slack = reached - distance[column];
            self.column_potentials[column] -= slack;
            if let Some(owner) = self.row_of[column] {
                self.row_potentials[owner] += slack;
            }
        }
        self.row_potentials[new] += reached;
        let mut column = end;
        while let Some(previous) = before[column] {
            self.row_of[column] = self.row_of[previous];
            column = previous;
        }
        self.row_of[column] = Some(new);
    }
}

#[cfg(test)]
mod tests;
