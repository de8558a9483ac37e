//! One and several: the singular of a noun.

/// Nouns that end in s and are singular.
pub(crate) const SINGULARS: &[&str] = &[
    "lens",
    "gas",
    "canvas",
    "atlas",
    "bus",
    "iris",
    "chess",
    "series",
    "news",
    "christmas",
    "bias",
    "tennis",
    "mattress",
    "compass",
];

/// Nouns whose plural is no singular with an ending, and nouns that mean something else in the singular: glasses
/// are no more a glass.
const IRREGULAR: &[(&str, &str)] = &[
    ("knives", "knife"),
    ("scarves", "scarf"),
    ("shelves", "shelf"),
    ("loaves", "loaf"),
    ("leaves", "leaf"),
    ("children", "child"),
    ("teeth", "tooth"),
    ("feet", "foot"),
    ("mice", "mouse"),
    ("dice", "dice"),
    ("glasses", "glasses"),
    ("sunglasses", "sunglasses"),
    ("eyeglasses", "eyeglasses"),
    ("clothes", "clothes"),
];

/// The singular of a word in lower case; what looks like no plural stays.
pub(crate) fn singular(word: &str) -> String {
    if let Some((_, singular)) = IRREGULAR.iter().find(|(plural, _)| *plural == word) {
        return (*singular).to_owned();
    }
    let kept = SINGULARS.contains(&word) || word.len() < 3;
    if kept || ["ss", "us", "is"].iter().any(|ending| word.ends_with(ending)) {
        return word.to_owned();
    }
    if let Some(stem) = word.strip_suffix("ies") {
        return format!("{stem}y");
    }
    if let Some(stem) = word.strip_suffix("es")
        && ["ss", "x", "zz", "ch", "sh"].iter().any(|ending| stem.ends_with(ending))
    {
        return stem.to_owned();
    }
    word.strip_suffix('s').unwrap_or(word).to_owned()
}

#[cfg(test)]
mod tests {
    use super::singular;

    #[test]
    fn several_become_one() {
        for (plural, one) in [
            ("cups", "cup"),
            ("brushes", "brush"),
            ("boxes", "box"),
            ("batteries", "battery"),
            ("knives", "knife"),
            ("keys", "key"),
            ("plates", "plate"),
            ("cases", "case"),
            ("dresses", "dress"),
            ("tvs", "tv"),
        ] {
            assert_eq!(singular(plural), one);
        }
    }

    #[test]
    fn what_is_one_stays() {
        for word in ["glasses", "glass", "lens", "bus", "cup", "dress", "tennis"] {
            assert_eq!(singular(word), word);
        }
    }
}
