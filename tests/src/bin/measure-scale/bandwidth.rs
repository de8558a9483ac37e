//! How fast the memory gives what is in it.

use std::hint::black_box;
use std::thread;
use std::time::Instant;

/// A gigabyte of numbers.
const NUMBERS: usize = 1 << 28;

const LANES: usize = 32;

/// The bytes a second at which a gigabyte is summed up, by one thread and by one for each processor: the best of five.
pub(crate) fn measure() -> [f64; 2] {
    let numbers = vec![1.0_f32; NUMBERS];
    let processors = thread::available_parallelism().map_or(1, usize::from);
    [1, processors].map(|threads| {
        let seconds = (0..5).map(|_| {
            let started = Instant::now();
            thread::scope(|scope| {
                for part in numbers.chunks(NUMBERS.div_ceil(threads)) {
                    scope.spawn(move || black_box(sum(part)));
                }
            });
            started.elapsed().as_secs_f64()
        });
        (NUMBERS * size_of::<f32>()) as f64 / seconds.fold(f64::INFINITY, f64::min)
    })
}

fn sum(numbers: &[f32]) -> f32 {
    let mut sums = [0.0_f32; LANES];
    for chunk in numbers.as_chunks::<LANES>().0 {
        for lane in 0..LANES {
            sums[lane] += chunk[lane];
        }
    }
    sums.iter().sum()
}
