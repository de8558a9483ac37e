//! Measuring many looks quickly, and not quite exactly: enough to know which few are worth [`cosine`](super::cosine).

/// How many sums are kept side by side, so that the processor can add several at once.
const LANES: usize = 32;

/// By how much [`quick_cosine`] may differ from [`cosine`](super::cosine), for features of length 1 and up to 4096
/// dimensions: each of the lanes adds up to 128 products, of which each addition loses at most 2⁻²⁴ of a sum that
/// is at most 1 in all.
pub const QUICK_ERROR: f32 = 2e-5;

/// The cosine of two features of length 1 in single precision, within [`QUICK_ERROR`].
pub fn quick_cosine(left: &[f32], right: &[f32]) -> f32 {
    let (left_chunks, left_rest) = left.as_chunks::<LANES>();
    let (right_chunks, right_rest) = right.as_chunks::<LANES>();
    let mut sums = [0.0_f32; LANES];
    for (a, b) in left_chunks.iter().zip(right_chunks) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f32 = left_rest.iter().zip(right_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f32>() + rest
}

/// How many features [`quick_cosines`] measures at once.
pub const SIDE_BY_SIDE: usize = 16;

/// How many sums are kept for each of them: few enough for the processor, and with 512 dimensions each adds the 128
/// products that [`QUICK_ERROR`] allows for.
const LANES_OF_EACH: usize = 4;

/// The cosines of a feature with several others, all of length 1 and of as many dimensions, up to 512, within
/// [`QUICK_ERROR`]. Where the others stand far apart in memory, the processor fetches them side by side, and many are
/// measured in two thirds of the time.
///
/// # Panics
/// If one of the others is shorter.
pub fn quick_cosines(target: &[f32], others: [&[f32]; SIDE_BY_SIDE]) -> [f32; SIDE_BY_SIDE] {
    let (chunks, rest) = target.as_chunks::<LANES_OF_EACH>();
    let others = others.map(|other| other.as_chunks::<LANES_OF_EACH>());
    let mut sums = [[0.0_f32; LANES_OF_EACH]; SIDE_BY_SIDE];
    for (place, a) in chunks.iter().enumerate() {
        for (sums, (chunks, _)) in sums.iter_mut().zip(&others) {
            let b = &chunks[place];
            for lane in 0..LANES_OF_EACH {
                sums[lane] += a[lane] * b[lane];
            }
        }
    }
    std::array::from_fn(|other| {
        let of_rest: f32 = rest.iter().zip(others[other].1).map(|(a, b)| a * b).sum();
        sums[other].iter().sum::<f32>() + of_rest
    })
}

/// What may be among the `k` best of those that were offered, when scores are known within an error.
#[derive(Debug, Clone)]
pub struct Shortlist<T> {
    k: usize,
    error: f32,
    /// Nothing below this can be among the best any more.
    floor: f32,
    kept: Vec<(f32, T)>,
    /// When the kept ones are looked through next.
    full_at: usize,
}

impl<T> Shortlist<T> {
    /// An empty list. A score may be too high or too low by `error`.
    pub fn new(k: usize, error: f32) -> Self {
        Self { k, error, floor: f32::NEG_INFINITY, kept: Vec::new(), full_at: Self::roomy(k) }
    }

    fn roomy(count: usize) -> usize {
        2 * count + 64
    }

    /// Whether something of this score would be kept.
    pub fn admits(&self, score: f32) -> bool {
        score >= self.floor
    }

    /// Keeps an item, unless it cannot be among the best.
    pub fn offer(&mut self, score: f32, item: T) {
        if self.admits(score) {
            self.kept.push((score, item));
            if self.kept.len() >= self.full_at {
                self.look_through();
            }
        }
    }

    /// Keeps what another list has kept.
    pub fn join(&mut self, other: Self) {
        for (score, item) in other.kept {
            self.offer(score, item);
        }
    }

    fn look_through(&mut self) {
        if self.k == 0 {
            self.kept.clear();
            self.floor = f32::INFINITY;
            return;
        }
        if self.kept.len() > self.k {
            let (_, (last_of_best, _), _) =
                self.kept.select_nth_unstable_by(self.k - 1, |left, right| right.0.total_cmp(&left.0));
            self.floor = *last_of_best - 2.0 * self.error;
            let floor = self.floor;
            self.kept.retain(|(score, _)| *score >= floor);
        }
        self.full_at = Self::roomy(self.kept.len());
    }

    /// All that may be among the `k` best, in no order.
    pub fn into_items(mut self) -> Vec<T> {
        self.look_through();
        self.kept.into_iter().map(|(_, item)| item).collect()
    }
}

/// The largest step count of a component in a [`Code`].
const STEPS: f32 = 127.0;

/// The largest step count of a component in a [`Probe`]: so few that a sum of 512 products stays within 32 bits.
const PROBE_STEPS: f32 = 8191.0;

/// A feature in steps of 8 bits.
#[derive(Debug, Clone, PartialEq)]
pub struct Code {
    /// The size of a step.
    pub step: f32,
    /// How many steps each component is.
    pub steps: Vec<i8>,
}

impl Code {
    /// The nearest code of a feature.
    pub fn of(feature: &[f32]) -> Self {
        let step = largest(feature) / STEPS;
        Self { step, steps: feature.iter().map(|component| (component / step).round() as i8).collect() }
    }
}

/// A feature that is compared with many codes.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    step: f32,
    steps: Vec<i16>,
}

impl Probe {
    /// A probe of a feature of up to 2048 dimensions.
    pub fn of(feature: &[f32]) -> Self {
        let step = largest(feature) / PROBE_STEPS;
        Self { step, steps: feature.iter().map(|component| (component / step).round() as i16).collect() }
    }

    /// About the cosine with a feature, by its code: the size of a step and the steps, each in a byte.
    pub fn cosine(&self, step: f32, steps: &[u8]) -> f32 {
        let product = self.steps.iter().zip(steps).fold(0_i32, |sum, (&probe, &code)| {
            sum.wrapping_add(i32::from(probe) * i32::from(code.cast_signed()))
        });
        product as f32 * self.step * step
    }
}

/// The largest absolute value of a component; never zero, so that it can be divided by.
fn largest(feature: &[f32]) -> f32 {
    feature
        .iter()
        .fold(f32::MIN_POSITIVE * STEPS * PROBE_STEPS, |largest, component| largest.max(component.abs()))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{cosine, normalise};
    use super::*;

    fn any_look(dimension: usize) -> impl Strategy<Value = Vec<f32>> {
        proptest::collection::vec(-1.0..1.0_f32, dimension)
            .prop_filter_map("a zero feature has no direction", |feature| normalise(&feature))
    }

    proptest! {
        #[test]
        fn a_quick_cosine_is_within_its_error(left in any_look(515), right in any_look(515)) {
            let difference = f64::from(quick_cosine(&left, &right)) - cosine(&left, &right);
            prop_assert!(difference.abs() < f64::from(QUICK_ERROR), "{difference}");
        }

        #[test]
        fn several_quick_cosines_are_within_their_error(
            target in any_look(515),
            others in proptest::collection::vec(any_look(515), SIDE_BY_SIDE),
        ) {
            let cosines = quick_cosines(&target, std::array::from_fn(|other| others[other].as_slice()));
            for (quick, other) in cosines.iter().zip(&others) {
                let difference = f64::from(*quick) - cosine(&target, other);
                prop_assert!(difference.abs() < f64::from(QUICK_ERROR), "{difference}");
            }
        }

        #[test]
        fn a_code_is_near_its_feature(left in any_look(512), right in any_look(512)) {
            let code = Code::of(&right);
            let bytes: Vec<u8> = code.steps.iter().map(|step| step.cast_unsigned()).collect();
            let difference = f64::from(Probe::of(&left).cosine(code.step, &bytes)) - cosine(&left, &right);
            // Half a step in each component is a length of √512 / 2 steps in all.
            prop_assert!(difference.abs() < f64::from(code.step) * 12.0, "{difference}");
        }

        #[test]
        fn the_best_are_on_the_shortlist_whatever_the_error_does(
            scores in proptest::collection::vec((-1.0..1.0_f32, -0.1..0.1_f32), 0..400),
            k in 0..20_usize,
            cut in 0..400_usize,
        ) {
            let mut lists = [Shortlist::new(k, 0.1), Shortlist::new(k, 0.1)];
            for (place, (score, error)) in scores.iter().enumerate() {
                lists[usize::from(place < cut)].offer(score + error, place);
            }
            let [mut all, rest] = lists;
            all.join(rest);
            let found = all.into_items();
            let mut best: Vec<usize> = (0..scores.len()).collect();
            best.sort_by(|&left, &right| scores[right].0.total_cmp(&scores[left].0));
            for place in best.into_iter().take(k) {
                prop_assert!(found.contains(&place));
            }
        }
    }

    #[test]
    fn ties_are_all_kept() {
        let mut list = Shortlist::new(2, 0.0);
        for place in 0..500 {
            list.offer(0.5, place);
        }
        list.offer(0.4, 500);
        assert_eq!(list.into_items().len(), 500);
    }
}
