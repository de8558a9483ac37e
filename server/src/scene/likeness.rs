//! How much things look like what somebody describes.

use coin::referring::likenesses;
use coin::similarity::cosine;
use coin_schemas::household::Score;

use super::Scene;
use crate::store::StoreError;

impl Scene<'_> {
    /// How much every thing looks like what the feature, of length 1, stands for, in the order of [`Self::objects`] and
    /// on the scale of label matches.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn likenesses(&self, feature: &[f32]) -> Result<Vec<Option<Score>>, StoreError> {
        let cosines: Vec<Option<f64>> =
            self.looks()?.iter().map(|look| Some(cosine(feature, look.as_deref()?))).collect();
        Ok(likenesses(&cosines))
    }
}
