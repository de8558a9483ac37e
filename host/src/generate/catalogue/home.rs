//! The things of a home.

use super::Activity as A;
use super::Kept::{BathroomShelf, Bedside, Cupboard, Desk, Hook, Seat};
use super::Suits::{Adult, Child, Clerk, Homemaker, Man, Student, Woman};
use super::{Thing, carried, fixed};

/// What a home may hold.
pub(in crate::generate) static HOME: &[Thing] = &[
    carried("mug", Cupboard, 0.95, 28.0)
        .during(&[A::Breakfast, A::Snack, A::Reading])
        .by(&["drinks from"])
        .cleaned("washes")
        .copies(3)
        .common(0.3),
    carried("drinking glass", Cupboard, 1.05, 30.0)
        .during(&[A::Breakfast, A::Lunch, A::Dinner])
        .by(&["drinks from"])
        .cleaned("washes")
        .common(0.7),
    carried("plate", Cupboard, 1.1, 32.0)
        .during(&[A::Breakfast, A::Lunch, A::Dinner])
        .by(&["eats from"])
        .cleaned("washes")
        .common(0.8),
    carried("bowl", Cupboard, 1.1, 26.0)
        .during(&[A::Breakfast, A::Snack])
        .by(&["eats from"])
        .cleaned("washes")
        .copies(2)
        .common(0.6),
    carried("spoon", Cupboard, 0.9, 34.0)
        .during(&[A::Breakfast, A::Lunch, A::Snack])
        .by(&["eats with", "stirs with"])
        .cleaned("washes")
        .common(0.8),
    carried("teapot", Cupboard, 0.95, 15.0)
        .during(&[A::Breakfast, A::Snack])
        .by(&["fills", "pours from"])
        .cleaned("rinses")
        .common(0.7),
    carried("cooking pot", Cupboard, 0.9, 18.0)
        .during(&[A::Cooking])
        .by(&["cooks with", "stirs in"])
        .cleaned("scrubs")
        .suits(Homemaker)
        .common(0.7),
    carried("frying pan", Cupboard, 0.9, 16.0)
        .during(&[A::Cooking, A::Breakfast])
        .by(&["fries with"])
        .cleaned("scrubs")
        .suits(Homemaker)
        .common(0.7),
    carried("kitchen knife", Cupboard, 0.95, 21.0)
        .during(&[A::Cooking, A::Snack])
        .by(&["cuts with"])
        .cleaned("wipes")
        .suits(Adult)
        .common(0.6),
    carried("lunch box", Cupboard, 1.2, 14.0)
        .during(&[A::Breakfast, A::ComingAndGoing])
        .by(&["opens", "fills"])
        .cleaned("washes")
        .copies(2)
        .suits(Student)
        .common(0.1),
    carried("water bottle", Cupboard, 0.95, 27.0)
        .during(&[A::ComingAndGoing, A::Exercise, A::Snack])
        .by(&["drinks from", "fills"])
        .cleaned("rinses")
        .copies(3)
        .common(0.1),
    fixed("coffee maker", Cupboard, 1.0, 24.0)
        .during(&[A::Breakfast, A::Snack])
        .by(&["turns on", "fills", "turns off"])
        .cleaned("wipes")
        .suits(Adult)
        .common(0.8),
    fixed("toaster", Cupboard, 1.0, 13.0)
        .during(&[A::Breakfast])
        .by(&["turns on", "watches", "turns off"])
        .cleaned("wipes")
        .common(0.8),
    carried("kettle", Cupboard, 1.0, 26.0)
        .during(&[A::Breakfast, A::Snack])
        .by(&["turns on", "turns off"])
        .cleaned("rinses")
        .common(0.8),
    carried("apron", Cupboard, 1.3, 13.0)
        .during(&[A::Cooking, A::Dishes])
        .by(&["wears"])
        .suits(Homemaker)
        .common(0.2),
    carried("sponge", Cupboard, 0.9, 22.0)
        .during(&[A::Dishes, A::Cleaning])
        .by(&["scrubs with"])
        .cleaned("rinses")
        .common(0.9),
    carried("toothbrush", BathroomShelf, 0.95, 14.0)
        .during(&[A::Washing])
        .by(&["brushes with"])
        .cleaned("rinses")
        .copies(3)
        .common(0.0),
    carried("toothpaste", BathroomShelf, 0.95, 25.0)
        .during(&[A::Washing])
        .by(&["opens", "closes"])
        .common(0.8),
    carried("shampoo", BathroomShelf, 1.1, 13.0).during(&[A::Washing]).by(&["opens", "uses"]).common(0.5),
    carried("hairbrush", BathroomShelf, 0.9, 16.0)
        .during(&[A::Washing, A::Dressing])
        .by(&["brushes with"])
        .copies(2)
        .suits(Woman)
        .common(0.2),
    carried("hairdryer", BathroomShelf, 0.8, 11.0)
        .during(&[A::Washing, A::Dressing])
        .by(&["turns on", "turns off"])
        .suits(Woman)
        .common(0.5),
    carried("towel", BathroomShelf, 1.3, 24.0)
        .during(&[A::Washing])
        .by(&["dries off with"])
        .copies(3)
        .common(0.3),
    carried("razor", BathroomShelf, 1.0, 8.0)
        .during(&[A::Washing])
        .by(&["shaves with"])
        .cleaned("rinses")
        .suits(Man)
        .common(0.0),
    carried("medicine box", BathroomShelf, 1.5, 9.0)
        .during(&[A::Washing, A::Bedtime])
        .by(&["opens", "closes"])
        .common(0.6),
    carried("jacket", Hook, 1.5, 26.0).during(&[A::ComingAndGoing]).by(&["wears"]).copies(3).common(0.0),
    carried("umbrella", Hook, 0.6, 7.0).during(&[A::ComingAndGoing]).by(&["opens", "closes"]).common(0.5),
    carried("backpack", Hook, 0.5, 22.0)
        .during(&[A::ComingAndGoing, A::Homework])
        .by(&["opens", "closes"])
        .copies(2)
        .suits(Student)
        .common(0.0),
    carried("briefcase", Hook, 0.5, 17.0)
        .during(&[A::ComingAndGoing, A::Computer])
        .by(&["opens", "closes"])
        .suits(Clerk)
        .common(0.0),
    carried("car keys", Hook, 1.1, 18.0).during(&[A::ComingAndGoing]).suits(Adult).common(0.5),
    carried("scarf", Hook, 1.5, 17.0)
        .during(&[A::ComingAndGoing, A::Dressing])
        .by(&["wears"])
        .copies(2)
        .common(0.1),
    carried("gloves", Hook, 1.2, 16.0).during(&[A::ComingAndGoing, A::Garden]).by(&["wears"]).common(0.2),
    carried("running shoes", Hook, 0.1, 14.0)
        .during(&[A::Exercise, A::ComingAndGoing])
        .by(&["wears", "ties"])
        .cleaned("brushes")
        .common(0.0),
    carried("slippers", Hook, 0.1, 29.0)
        .during(&[A::Dressing, A::Bedtime, A::Reading])
        .by(&["wears"])
        .copies(2)
        .common(0.0),
    carried("shopping bag", Hook, 0.7, 12.0)
        .during(&[A::ComingAndGoing])
        .by(&["fills", "empties"])
        .suits(Homemaker)
        .common(0.6),
    carried("laptop", Desk, 0.8, 30.0)
        .during(&[A::Computer])
        .by(&["opens", "types on", "closes"])
        .cleaned("wipes")
        .copies(2)
        .suits(Clerk)
        .common(0.2),
    carried("notebook", Desk, 0.78, 21.0)
        .during(&[A::Computer, A::Homework])
        .by(&["writes in", "reads"])
        .copies(2)
        .common(0.0),
    carried("marker", Desk, 0.8, 17.0).during(&[A::Homework, A::Computer]).by(&["writes with"]).common(0.3),
    carried("pencil case", Desk, 0.8, 18.0)
        .during(&[A::Homework])
        .by(&["opens", "closes"])
        .suits(Student)
        .common(0.0),
    carried("calculator", Desk, 0.8, 9.0).during(&[A::Homework, A::Computer]).by(&["types on"]).common(0.4),
    carried("headphones", Desk, 0.85, 23.0)
        .during(&[A::Music, A::Computer])
        .by(&["wears", "listens with"])
        .copies(2)
        .common(0.1),
    fixed("desk lamp", Desk, 1.1, 22.0)
        .during(&[A::Computer, A::Homework, A::Reading])
        .by(&["turns on", "adjusts", "turns off"])
        .cleaned("dusts")
        .common(0.3),
    carried("keyboard", Desk, 0.78, 24.0)
        .during(&[A::Computer])
        .by(&["types on"])
        .cleaned("wipes")
        .suits(Clerk)
        .common(0.2),
    carried("tablet", Desk, 0.8, 28.0)
        .during(&[A::Play, A::Television, A::Reading])
        .by(&["turns on", "plays on", "turns off"])
        .cleaned("wipes")
        .common(0.4),
    carried("phone charger", Desk, 0.6, 20.0)
        .during(&[A::Bedtime, A::Computer])
        .by(&["plugs in", "unplugs"])
        .copies(2)
        .common(0.3),
    carried("textbook", Desk, 0.8, 15.0)
        .during(&[A::Homework])
        .by(&["reads", "writes in"])
        .copies(2)
        .suits(Student)
        .common(0.0),
    fixed("printer", Desk, 0.9, 7.0)
        .during(&[A::Computer, A::Homework])
        .by(&["turns on", "prints with", "turns off"])
        .cleaned("dusts")
        .common(0.8),
    carried("remote control", Seat, 0.5, 33.0)
        .during(&[A::Television])
        .by(&["presses", "points"])
        .common(0.9),
    fixed("television", Seat, 1.0, 26.0)
        .during(&[A::Television])
        .by(&["turns on", "watches", "turns off"])
        .cleaned("dusts")
        .common(0.9),
    carried("book", Seat, 0.6, 19.0).during(&[A::Reading, A::Bedtime]).by(&["reads"]).copies(3).common(0.1),
    carried("magazine", Seat, 0.5, 12.0)
        .during(&[A::Reading, A::Breakfast])
        .by(&["reads"])
        .suits(Adult)
        .common(0.3),
    carried("newspaper", Seat, 0.5, 15.0)
        .during(&[A::Breakfast, A::Reading])
        .by(&["reads"])
        .suits(Adult)
        .common(0.5),
    carried("board game", Seat, 0.4, 9.0)
        .during(&[A::Play])
        .by(&["opens", "plays", "closes"])
        .suits(Child)
        .common(0.8),
    carried("deck of cards", Seat, 0.5, 10.0).during(&[A::Play]).by(&["shuffles", "plays with"]).common(0.8),
    carried("guitar", Seat, 0.6, 13.0).during(&[A::Music]).by(&["tunes", "plays"]).common(0.1),
    carried("game controller", Seat, 0.5, 25.0)
        .during(&[A::Play, A::Television])
        .by(&["plays with"])
        .suits(Child)
        .common(0.4),
    carried("blanket", Seat, 0.5, 20.0)
        .during(&[A::Television, A::Reading, A::Bedtime])
        .by(&["wraps up in"])
        .cleaned("airs")
        .common(0.5),
    carried("toy car", Seat, 0.2, 22.0).during(&[A::Play]).by(&["plays with"]).suits(Child).common(0.0),
    carried("building blocks", Seat, 0.2, 15.0)
        .during(&[A::Play])
        .by(&["builds with", "plays with"])
        .suits(Child)
        .common(0.1),
    carried("ball", Seat, 0.1, 17.0)
        .during(&[A::Play, A::Exercise])
        .by(&["plays with", "throws"])
        .suits(Child)
        .common(0.3),
    carried("knitting bag", Seat, 0.4, 11.0)
        .during(&[A::Television, A::Reading])
        .by(&["opens", "knits from"])
        .suits(Woman)
        .common(0.0),
    carried("yoga mat", Seat, 0.2, 9.0)
        .during(&[A::Exercise])
        .by(&["unrolls", "stretches on"])
        .cleaned("wipes")
        .common(0.1),
    carried("dumbbells", Seat, 0.2, 10.0).during(&[A::Exercise]).by(&["lifts"]).suits(Man).common(0.2),
    carried("watering can", Seat, 0.3, 10.0)
        .during(&[A::Garden])
        .by(&["fills", "pours from"])
        .suits(Homemaker)
        .common(0.6),
    carried("camera", Seat, 0.9, 6.0)
        .during(&[A::Play, A::Garden])
        .by(&["turns on", "turns off"])
        .suits(Adult)
        .common(0.3),
    fixed("alarm clock", Bedside, 0.6, 15.0)
        .during(&[A::Bedtime, A::Dressing])
        .by(&["sets", "winds", "turns off"])
        .cleaned("dusts")
        .common(0.2),
    carried("reading glasses", Bedside, 0.6, 31.0)
        .during(&[A::Reading, A::Computer])
        .by(&["wears"])
        .cleaned("wipes")
        .suits(Adult)
        .common(0.0),
    carried("pajamas", Bedside, 0.5, 15.0)
        .during(&[A::Bedtime, A::Dressing])
        .by(&["wears"])
        .copies(2)
        .common(0.0),
    carried("hand cream", Bedside, 0.6, 16.0)
        .during(&[A::Bedtime, A::Washing])
        .by(&["opens", "closes"])
        .suits(Woman)
        .common(0.2),
    carried("diary", Bedside, 0.6, 9.0)
        .during(&[A::Bedtime, A::Reading])
        .by(&["writes in", "reads"])
        .common(0.0),
    carried("vacuum cleaner", Hook, 0.4, 7.0)
        .during(&[A::Cleaning])
        .by(&["turns on", "pushes", "turns off"])
        .suits(Homemaker)
        .common(0.8),
    carried("iron", BathroomShelf, 0.9, 8.0)
        .during(&[A::Laundry])
        .by(&["turns on", "irons with", "turns off"])
        .suits(Homemaker)
        .common(0.6),
    carried("laundry basket", BathroomShelf, 0.3, 15.0)
        .during(&[A::Laundry, A::Washing])
        .by(&["fills", "empties"])
        .common(0.8),
    carried("broom", Hook, 0.6, 10.0)
        .during(&[A::Cleaning])
        .by(&["sweeps with"])
        .suits(Homemaker)
        .common(0.8),
];
