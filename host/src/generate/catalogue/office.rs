//! The things of an office.

use super::Activity as A;
use super::Kept::{Cupboard, Desk, Hook, Seat};
use super::Suits::{Clerk, Woman};
use super::{Thing, carried, fixed};

/// What an office may hold.
pub(in crate::generate) static OFFICE: &[Thing] = &[
    carried("mug", Cupboard, 0.95, 26.0)
        .during(&[A::Snack, A::DeskWork])
        .by(&["drinks from"])
        .cleaned("washes")
        .copies(4)
        .common(0.1),
    carried("water bottle", Desk, 0.85, 24.0)
        .during(&[A::DeskWork, A::Lunch])
        .by(&["drinks from", "fills"])
        .copies(3)
        .common(0.0),
    carried("laptop", Desk, 0.8, 30.0)
        .during(&[A::DeskWork, A::Meeting])
        .by(&["opens", "types on", "closes"])
        .copies(4)
        .suits(Clerk)
        .common(0.0),
    carried("keyboard", Desk, 0.78, 26.0)
        .during(&[A::DeskWork])
        .by(&["types on"])
        .cleaned("wipes")
        .copies(2)
        .common(0.0),
    carried("headset", Desk, 0.85, 22.0)
        .during(&[A::DeskWork, A::Meeting])
        .by(&["wears", "speaks into"])
        .copies(3)
        .common(0.1),
    fixed("desk lamp", Desk, 1.1, 14.0)
        .during(&[A::DeskWork])
        .by(&["turns on", "adjusts", "turns off"])
        .copies(2)
        .common(0.1),
    carried("notebook", Desk, 0.78, 21.0)
        .during(&[A::Meeting, A::DeskWork])
        .by(&["writes in", "reads"])
        .copies(3)
        .common(0.0),
    carried("stapler", Desk, 0.8, 13.0).during(&[A::DeskWork]).by(&["staples with"]).common(0.6),
    carried("scissors", Desk, 0.8, 12.0).during(&[A::DeskWork, A::Parcels]).by(&["cuts with"]).common(0.7),
    carried("tape dispenser", Desk, 0.8, 11.0).during(&[A::Parcels, A::DeskWork]).common(0.7),
    carried("whiteboard marker", Seat, 1.1, 19.0)
        .during(&[A::Meeting])
        .by(&["writes with"])
        .copies(2)
        .common(0.9),
    carried("projector remote", Seat, 0.8, 12.0).during(&[A::Meeting]).by(&["presses", "points"]).common(0.9),
    fixed("projector", Seat, 2.0, 10.0)
        .during(&[A::Meeting])
        .by(&["turns on", "adjusts", "turns off"])
        .common(0.9),
    fixed("coffee maker", Cupboard, 1.0, 38.0)
        .during(&[A::Snack])
        .by(&["turns on", "fills", "turns off"])
        .cleaned("wipes")
        .common(1.0),
    carried("kettle", Cupboard, 1.0, 25.0)
        .during(&[A::Snack])
        .by(&["turns on", "turns off"])
        .cleaned("rinses")
        .common(1.0),
    fixed("printer", Hook, 0.9, 30.0)
        .during(&[A::DeskWork])
        .by(&["turns on", "prints with", "refills"])
        .common(1.0),
    carried("calculator", Desk, 0.8, 15.0)
        .during(&[A::DeskWork])
        .by(&["types on"])
        .copies(2)
        .suits(Clerk)
        .common(0.2),
    carried("umbrella", Hook, 0.6, 6.0)
        .during(&[A::ComingAndGoing])
        .by(&["opens", "closes"])
        .copies(2)
        .common(0.2),
    carried("jacket", Hook, 1.5, 18.0)
        .during(&[A::ComingAndGoing, A::Lunch])
        .by(&["wears"])
        .copies(3)
        .common(0.0),
    carried("backpack", Hook, 0.4, 15.0)
        .during(&[A::ComingAndGoing])
        .by(&["opens", "closes"])
        .copies(2)
        .common(0.0),
    carried("phone charger", Desk, 0.6, 19.0)
        .during(&[A::DeskWork])
        .by(&["plugs in", "unplugs"])
        .copies(2)
        .common(0.3),
    fixed("desk fan", Desk, 0.9, 12.0)
        .during(&[A::DeskWork])
        .by(&["turns on", "adjusts", "turns off"])
        .common(0.3),
    carried("tablet", Seat, 0.8, 18.0)
        .during(&[A::Meeting, A::DeskWork])
        .by(&["turns on", "types on", "turns off"])
        .common(0.4),
    carried("hole punch", Desk, 0.8, 9.0).during(&[A::DeskWork]).by(&["punches with"]).common(0.7),
    carried("folder", Desk, 0.8, 16.0)
        .during(&[A::DeskWork, A::Meeting])
        .by(&["opens", "reads", "closes"])
        .copies(3)
        .suits(Clerk)
        .common(0.2),
    carried("plate", Cupboard, 1.1, 14.0)
        .during(&[A::Lunch])
        .by(&["eats from"])
        .cleaned("washes")
        .common(0.9),
    carried("lunch box", Cupboard, 1.2, 12.0)
        .during(&[A::Lunch])
        .by(&["opens", "eats from"])
        .cleaned("washes")
        .copies(3)
        .common(0.0),
    carried("mouse", Desk, 0.78, 25.0).during(&[A::DeskWork]).by(&["clicks"]).copies(2).common(0.0),
    carried("webcam", Desk, 1.1, 11.0).during(&[A::Meeting]).by(&["turns on", "turns off"]).common(0.5),
    carried("label printer", Hook, 0.9, 9.0)
        .during(&[A::Parcels])
        .by(&["turns on", "prints with", "turns off"])
        .common(0.8),
    carried("packing tape", Hook, 0.8, 11.0).during(&[A::Parcels]).by(&["seals with"]).common(0.8),
    carried("watering can", Cupboard, 0.3, 6.0).during(&[A::Snack]).by(&["fills", "pours from"]).common(0.6),
    carried("hand cream", Desk, 0.8, 13.0)
        .during(&[A::DeskWork])
        .by(&["opens", "closes"])
        .suits(Woman)
        .common(0.0),
    carried("reading glasses", Desk, 0.8, 24.0)
        .during(&[A::DeskWork, A::Meeting])
        .by(&["wears"])
        .copies(2)
        .common(0.0),
    carried("first aid kit", Cupboard, 1.5, 4.0).during(&[A::Snack]).by(&["opens", "closes"]).common(0.9),
];
