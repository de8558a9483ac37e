//! What somebody may have meant who named something that is not there.

/// How many names a hint lists.
const MOST: usize = 3;

/// How alike two names are at least, as Jaro–Winkler similarity, to be taken for one another.
const LEAST_SIMILARITY: f64 = 0.7;

/// The known names that are most like the given one, best first; at most three.
fn near_misses<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let given = given.to_lowercase();
    let mut alike: Vec<(f64, &str)> = known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&given, &name.to_lowercase()), name))
        .filter(|&(similarity, _)| similarity >= LEAST_SIMILARITY)
        .collect();
    alike.sort_by(|left, right| right.0.total_cmp(&left.0).then(left.1.cmp(right.1)));
    alike.into_iter().take(MOST).map(|(_, name)| name).collect()
}

/// A sentence that names near misses, with a space before it: ` Did you mean "Bob" or "Rob"?`. Empty where there
/// is none.
pub(crate) fn hint<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = near_misses(given, known).into_iter().map(|name| format!("{name:?}")).collect();
    if quoted.is_empty() { String::new() } else { format!(" Did you mean {}?", quoted.join(" or ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_likest_name_comes_first_whatever_its_case() {
        assert_eq!(near_misses("bob", ["Mary", "Rob", "Bob"]), ["Bob", "Rob"]);
    }

    #[test]
    fn nothing_alike_gives_no_hint() {
        assert_eq!(hint("Zoe", ["Mary", "Bob"]), "");
        assert_eq!(hint("marker", ["Marker", "cup"]), " Did you mean \"Marker\"?");
    }
}
