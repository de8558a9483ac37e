//! When two sightings are of one thing, and when a thing has moved.

use jiff::SignedDuration;

/// What the map goes by. Every number is a choice, and each says what it is made from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapParameters {
    /// α of N(p, α r I), in metres: a thing of radius r has the variance α r on each axis.
    ///
    /// The paper does not give it. The variance has to cover the extent and the error of a position together: for a cup
    /// (r = 4.5 cm) α = 0.15 m makes a standard deviation of 8 cm, which is the greatest error that is
    /// expected, for a pen (2 cm) 5.5 cm, and for a chair (30 cm) 21 cm, which stays inside the chair.
    pub spread: f64,
    /// The greatest Jeffreys divergence, in nats, between a detection and the entry that it joins.
    ///
    /// For two Gaussians of one extent it is the squared distance in standard deviations: 12 is 3.5 of them, 28 cm for
    /// a cup. Of one position, two extents may differ eightfold or so.
    pub largest_divergence: f64,
    /// The least cosine of two features that look the same, −1…1.
    ///
    /// It has to lie between what views of one thing have (about 0.9 for embeddings of the CLIP kind) and what different
    /// things of one class have (about 0.7).
    pub same_look: f64,
    /// So many views in a row that cover a place without the thing make it gone. With one in ten missed, three views
    /// miss a thing that is there once in a thousand times.
    pub absences: usize,
    /// So many views make an entry one that may have moved, or be what another has moved to. One view may be a mistake of
    /// the detector.
    pub confirming_views: usize,
    /// A thing that was not seen for so long may have moved although nobody saw its place empty.
    pub long_unseen: SignedDuration,
    /// The dimension of every feature.
    pub dimension: usize,
}

impl Default for MapParameters {
    fn default() -> Self {
        Self {
            spread: 0.15,
            largest_divergence: 12.0,
            same_look: 0.8,
            absences: 3,
            confirming_views: 2,
            long_unseen: SignedDuration::from_hours(14 * 24),
            dimension: 512,
        }
    }
}

impl MapParameters {
    /// No entry at a greater distance, in metres, can have a divergence of at most [`Self::largest_divergence`] from
    /// a thing of this radius, whatever its own extent: the divergence is at least |Δ|² / 2 α r.
    pub(super) fn reach(&self, radius: f64) -> f64 {
        libm::sqrt(2.0 * self.largest_divergence * self.spread * radius)
    }
}
