//! How much things look like what somebody describes.

use coin::referring::likenesses;
use coin::similarity::{cosine, normalise};
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
        let features = self.reader.features()?;
        let cosines = self.objects()?.iter().map(|object| {
            let look = normalise(features.get(&object.key)?)?;
            Some(cosine(feature, &look))
        });
        Ok(likenesses(&cosines.collect::<Vec<_>>()))
    }
}
