//! What is drawn and listed of a home.

use std::path::Path;
use std::time::{Duration, Instant};

use coin_schemas::household::{ClassLabel, ObjectId, Position, UserName};
use rstest::rstest;

use super::*;

/// The largest page of two thousand things, in bytes: a browser opens it at once.
const LARGEST_PAGE: usize = 4_000_000;

/// The longest time in which it is made, without optimisation on a busy machine.
const LONGEST_TIME: Duration = Duration::from_secs(20);

/// The map of the home in the fixture.
fn three_things() -> HomeMap {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/episodes/three-things");
    let store = Store::open_in_memory().unwrap();
    store.import(&crate::episode::load(&folder).unwrap()).unwrap();
    survey(&store).unwrap()
}

/// As many things in as many rooms, in heaps around the furniture.
fn full_house(things: usize, rooms: usize) -> HomeMap {
    let mut map = three_things();
    let thing = &map.objects[0];
    map.objects = (0..things)
        .map(|number| {
            let room = number * rooms / things;
            let (angle, heap) = (number as f64 * 2.4, (number % 7) as f64);
            let from_corner = 0.4 * (number % 13) as f64 / 13.0;
            let x = 6.0 * (room % 5) as f64 + 0.6 * heap + from_corner * angle.cos();
            let y = 6.0 * (room / 5) as f64 + (heap * 1.7) % 4.0 + from_corner * angle.sin();
            MappedObject {
                id: ObjectId::new(format!("thing-{number}")).unwrap(),
                class: ClassLabel::new(["coffee mug", "marker", "deck of cards"][number % 3]).unwrap(),
                room: Some(format!("room {room:02}")),
                position: Position::new([x, y, 0.8]).unwrap(),
                confidence: (number % 11) as f64 / 10.0,
                ..thing.clone()
            }
        })
        .collect();
    map
}

fn marks(page: &str) -> usize {
    page.matches("<a class=\"thing\"").count()
}

#[test]
fn the_page_of_a_small_home() {
    // A line for each element, so that a change can be read.
    insta::assert_snapshot!(page(&three_things()).split_once("</style>").unwrap().1.replace("><", ">\n<"));
}

#[test]
fn the_table_of_a_small_home() {
    insta::assert_snapshot!(text(&three_things()));
}

#[test]
fn two_thousand_things_have_a_plan_for_each_room() {
    let map = full_house(2_000, 10);
    let started = Instant::now();
    let page = page(&map);
    let taken = started.elapsed();
    assert!(page.len() <= LARGEST_PAGE, "{} bytes", page.len());
    assert!(taken <= LONGEST_TIME, "{taken:?}");
    assert_eq!(marks(&page), 2_000, "every thing has one mark that is a link");
    assert_eq!(page.matches("<tr id=\"thing-").count(), 2_000);
    assert_eq!(page.matches("<svg class=\"plan\"").count(), 10);
    assert_eq!(page.matches("<svg class=\"plan overview\"").count(), 1);
    for room in 0..10 {
        assert!(
            page.contains(&format!("<section class=\"of-room\" id=\"room-{room}\"><h2>room {room:02}</h2>"))
        );
    }
}

#[test]
fn every_link_leads_somewhere_and_no_address_is_given_twice() {
    for map in [three_things(), full_house(400, 4)] {
        let page = page(&map);
        let values = |name: &str| -> Vec<String> {
            page.split(&format!(" {name}=\""))
                .skip(1)
                .map(|rest| rest.split('"').next().unwrap().to_owned())
                .collect()
        };
        let ids = values("id");
        let distinct: std::collections::BTreeSet<&String> = ids.iter().collect();
        assert_eq!(distinct.len(), ids.len());
        let links = values("href");
        assert!(links.len() >= 2 * map.objects.len());
        for link in links {
            assert!(distinct.contains(&link.strip_prefix('#').unwrap().to_owned()), "{link} leads nowhere");
        }
    }
}

#[test]
fn names_stay_text() {
    let hostile = "\"/><script>alert('1')</script>";
    let name = UserName::new(hostile).unwrap();
    // The rooms of a small home stand on one plan, those of a large one have plans of their own.
    for mut map in [three_things(), full_house(400, 4)] {
        map.name = Some(hostile.to_owned());
        map.users.insert(name.clone(), serde_json::from_value(serde_json::json!({"role": hostile})).unwrap());
        let thing = &mut map.objects[0];
        thing.class = ClassLabel::new(hostile).unwrap();
        thing.id = ObjectId::new(hostile).unwrap();
        thing.room = Some(hostile.to_owned());
        thing.owners = Owners::from([name.clone()]);
        let page = page(&map);
        assert!(!page.contains("<script"), "the page has no script at all");
        assert!(page.contains("&quot;/&gt;&lt;script&gt;alert('1')&lt;/script&gt;"));
    }
}

#[test]
fn names_move_nothing_at_the_terminal() {
    let mut map = three_things();
    map.objects[0].room = Some("den\u{1b}[2J\nfake line".to_owned());
    let table = text(&map);
    assert!(table.contains("den␛[2J fake line"), "{table}");
    assert_eq!(table.lines().count(), 6, "a title, three things, nothing, the sum");
}

#[test]
fn a_home_without_things_is_drawn() {
    let map = HomeMap { objects: Vec::new(), ..three_things() };
    assert!(page(&map).contains("<svg class=\"plan\""));
    assert!(text(&map).contains("0 things"));
}

#[test]
fn what_is_in_no_room_comes_last() {
    let mut map = full_house(400, 4);
    map.objects.iter_mut().skip(300).for_each(|thing| thing.room = None);
    let page = page(&map);
    let headings: Vec<&str> =
        page.split("<h2>").skip(2).map(|rest| rest.split("</h2>").next().unwrap()).collect();
    assert_eq!(headings, ["room 00", "room 01", "room 02", "In no room"]);
}

#[rstest]
#[case(&["Bob"], false, "Bob")]
#[case(&["Bob"], true, "Bob and somebody outside")]
#[case(&[], true, "somebody outside")]
fn owners_outside_the_household_are_named(
    #[case] owners: &[&str],
    #[case] outside: bool,
    #[case] shown: &str,
) {
    let map = three_things();
    let household: Owners = map.users.keys().cloned().collect();
    let mut thing = map.objects[0].clone();
    thing.owners = owners.iter().map(|name| UserName::new(*name).unwrap()).collect();
    thing.owner_outside_household = outside;
    assert_eq!(whose(&thing, &household), shown);
}
