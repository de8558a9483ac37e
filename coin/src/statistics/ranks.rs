//! Ranks with ties.

/// The ranks of values, from 1, equal values sharing the mean of theirs.
pub(super) struct Ranks {
    /// In the order of the values.
    pub(super) ranks: Vec<f64>,
    /// Σ (t³ − t) over the groups of t equal values.
    pub(super) tie_sum: f64,
}

pub(super) fn ranks(values: &[f64]) -> Ranks {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&left, &right| values[left].total_cmp(&values[right]));
    let mut ranks = vec![0.0; values.len()];
    let mut tie_sum = 0.0;
    let mut begin = 0;
    for group in order.chunk_by(|&left, &right| values[left] == values[right]) {
        let size = group.len();
        let shared = begin as f64 + (size as f64 + 1.0) / 2.0;
        for &index in group {
            ranks[index] = shared;
        }
        tie_sum += (size * size * size - size) as f64;
        begin += size;
    }
    Ranks { ranks, tie_sum }
}
