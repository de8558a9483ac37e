//! What is drawn lies within the plan, nothing covers anything, and people can be told apart.

use coin_schemas::household::UserName;
use proptest::collection::vec;
use proptest::prelude::*;

use super::plan::{Palette, Spot, layout, radius};
use super::*;

fn names(text: &str) -> Vec<UserName> {
    text.split_whitespace().map(|name| UserName::new(name).unwrap()).collect()
}

fn any_place() -> impl Strategy<Value = [f64; 3]> {
    let coordinate = prop_oneof![-6.0..6.0_f64, Just(0.0), Just(1.0e9), Just(-1.0e308)];
    (coordinate.clone(), coordinate).prop_map(|(x, y)| [x, y, 0.8])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn marks_lie_within_the_plan(things in vec((any_place(), 0.0..=1.0_f64), 0..30)) {
        let positions: Vec<[f64; 3]> = things.iter().map(|(place, _)| *place).collect();
        let radii: Vec<f64> = things.iter().map(|(_, doubt)| radius(*doubt)).collect();
        let drawn = layout(&positions, &radii);
        prop_assert_eq!(drawn.marks.len(), things.len());
        for (mark, radius) in drawn.marks.iter().zip(&radii) {
            prop_assert!(mark.x >= *radius && mark.x <= 720.0 - radius, "{mark:?}");
            prop_assert!(mark.y >= *radius && mark.y <= drawn.height - radius, "{mark:?}");
        }
    }

    #[test]
    fn a_household_of_things_on_one_table_is_spread_out(
        things in vec(([0.0..1.0_f64, 0.0..1.0_f64, 0.0..1.0_f64], 0.0..=1.0_f64), 1..16),
    ) {
        let positions: Vec<[f64; 3]> = things.iter().map(|(place, _)| *place).collect();
        let radii: Vec<f64> = things.iter().map(|(_, doubt)| radius(*doubt)).collect();
        let marks = layout(&positions, &radii).marks;
        for (one, left) in marks.iter().enumerate() {
            for (other, right) in marks.iter().enumerate().skip(one + 1) {
                let distance = (left.x - right.x).hypot(left.y - right.y);
                prop_assert!(distance + 0.5 >= radii[one] + radii[other], "{left:?} covers {right:?}");
            }
        }
    }
}

#[test]
fn a_mark_grows_with_doubt() {
    let radii: Vec<f64> = (0..=10).map(|tenth| radius(f64::from(tenth) / 10.0)).collect();
    assert!(radii.is_sorted_by(|left, right| left < right), "{radii:?}");
    assert_eq!(radius(f64::NAN), radius(1.0));
}

#[test]
fn north_is_up() {
    let drawn = layout(&[[0.0, 0.0, 0.0], [0.0, 5.0, 0.0], [5.0, 0.0, 0.0]], &[9.0; 3]);
    assert!(drawn.places[1].y < drawn.places[0].y);
    assert!(drawn.places[2].x > drawn.places[0].x);
}

#[test]
fn letters_tell_people_apart() {
    let letters = |members: &str, owners: &str| {
        let members = names(members);
        let palette = Palette::new(members.iter());
        let owners: Owners = names(owners).into_iter().collect();
        let mark = palette.mark(Spot { x: 20.0, y: 20.0 }, 9.0, &owners).into_string();
        let (_, text) = mark.rsplit_once("aria-hidden=\"true\">").unwrap();
        text.split_once('<').unwrap().0.to_owned()
    };
    assert_eq!(letters("Bob Mary Tom", "Mary"), "M");
    assert_eq!(letters("Bob Mary Tom", "Bob Tom"), "BT");
    assert_eq!(letters("Bob Mary Tom", "Bob Mary Tom"), "all");
    assert_eq!(letters("Bob Mary Tom Una", "Bob Mary Tom"), "3");
    assert_eq!(letters("Mark Mary Tom", "Mary"), "Mar");
    assert_eq!(letters("Mia Max Tom", "Mia"), "Mi");
    assert_eq!(letters("Bob Mary", "Bob Mary"), "BM");
    assert_eq!(letters("Bob Mary", ""), "–");
}

#[test]
fn every_owner_has_a_sector() {
    let members = names("Bob Mary Tom");
    let palette = Palette::new(members.iter());
    let at = Spot { x: 20.0, y: 20.0 };
    for count in 2..=3 {
        let owners: Owners = members.iter().take(count).cloned().collect();
        let mark = palette.mark(at, 9.0, &owners).into_string();
        assert_eq!(mark.matches("<path").count(), count);
    }
}

#[test]
fn backgrounds_are_said_as_far_as_they_are_known() {
    let background = |role: Option<&str>, occupation: Option<&str>| Background {
        role: role.map(str::to_owned),
        occupation: occupation.map(str::to_owned),
    };
    assert_eq!(in_brackets(&background(Some("father"), Some("cook"))), " (father, cook)");
    assert_eq!(in_brackets(&background(None, Some("cook"))), " (cook)");
    assert_eq!(in_brackets(&background(None, None)), "");
}
