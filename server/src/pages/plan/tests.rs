//! What is drawn lies within the plan, nothing covers anything, and people can be told apart.

use coin_schemas::household::UserName;
use proptest::collection::vec;
use proptest::prelude::*;

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
            prop_assert!(mark.x >= *radius && mark.x <= drawn.width - radius, "{mark:?}");
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

#[test]
fn names_cover_neither_marks_nor_each_other() {
    let heap: Vec<[f64; 3]> =
        (0..60).map(|place| [f64::from(place % 9) * 0.5, f64::from(place / 9) * 0.4, 0.0]).collect();
    let radii: Vec<f64> = (0..60).map(|place| radius(f64::from(place % 11) / 10.0)).collect();
    let drawn = layout(&heap, &radii);
    let marks: Vec<Nameless<'_>> = drawn
        .marks
        .iter()
        .zip(&radii)
        .map(|(&at, &radius)| Nameless { at, radius, name: "building blocks", room: None })
        .collect();
    let placed: Vec<Area> =
        labels(&marks, &[], &drawn, Vec::new()).into_iter().flatten().map(|label| label.area).collect();
    assert!(placed.len() > 5 && placed.len() < 60, "{} have a name", placed.len());
    for (place, label) in placed.iter().enumerate() {
        assert!(drawn.sheet().contains(label));
        assert!(marks.iter().all(|mark| !Area::around(mark.at, mark.radius).meets(label)));
        assert!(placed[place + 1..].iter().all(|other| !other.meets(label)));
    }
}

#[test]
fn a_name_stays_in_its_room_where_it_can() {
    let drawn = layout(&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]], &[9.5; 2]);
    let at = drawn.marks[0];
    let mark = Nameless { at, radius: 9.5, name: "mug", room: Some(0) };
    let room = Area { left: at.x - 40.0, ..Area::around(at, 12.0) };
    let label = labels(&[mark], &[room], &drawn, Vec::new()).remove(0).unwrap();
    assert_eq!(label.anchor, "end", "the left is inside, the right is not");
}

#[test]
fn a_crowd_gets_a_larger_sheet() {
    let usual = layout(&[[0.0; 3]; 30], &[LARGEST; 30]);
    let crowded = layout(&[[0.0; 3]; 3_000], &[LARGEST; 3_000]);
    assert_eq!(usual.width, 720.0);
    assert!(crowded.width > 2_000.0, "{}", crowded.width);
}

#[test]
fn long_names_are_cut_off() {
    assert_eq!(shortened("mug", 3), "mug");
    assert_eq!(shortened("mugs", 3), "mu…");
}
