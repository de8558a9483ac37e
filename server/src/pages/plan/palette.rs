//! How the owners of a thing look: a colour for each member of the household, and letters for whoever does not tell
//! colours apart.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use coin_schemas::household::{Owners, UserName};
use maud::{Markup, html};

use super::layout::Spot;
use crate::pages::{colour, unit};

/// The looks of the members of a household.
#[derive(Debug, Clone)]
pub struct Palette<'a> {
    looks: BTreeMap<&'a UserName, (String, String)>,
}

impl<'a> Palette<'a> {
    /// Gives every member a colour and the shortest beginning of the name that is nobody else's.
    pub fn new(members: impl Iterator<Item = &'a UserName>) -> Self {
        let members: Vec<&UserName> = members.collect();
        let look = |(place, &name): (usize, &&'a UserName)| {
            let others: Vec<&UserName> = members.iter().copied().filter(|other| *other != name).collect();
            (name, (colour(place), initials(name, &others)))
        };
        Self { looks: members.iter().enumerate().map(look).collect() }
    }

    fn colour(&self, name: &UserName) -> &str {
        self.looks.get(name).map_or("var(--muted)", |(colour, _)| colour)
    }

    /// What stands in a mark: whose it is, for whoever does not tell colours apart.
    fn letters(&self, owners: &Owners) -> String {
        match owners.len() {
            0 => "–".to_owned(),
            many if many > 2 && many == self.looks.len() => "all".to_owned(),
            1 | 2 => owners.iter().filter_map(|name| self.looks.get(name)).map(|(_, text)| &**text).collect(),
            many => many.to_string(),
        }
    }

    /// A mark: a disc in the owner's colour, in as many sectors as there are owners; an empty one where somebody
    /// outside the household is the owner.
    pub(super) fn mark(&self, at: Spot, radius: f64, owners: &Owners) -> Markup {
        html! {
            (self.disc(at, radius, owners))
            text.letters.outside[owners.is_empty()] x=(unit(at.x)) y=(unit(at.y + 3.6)) text-anchor="middle" aria-hidden="true" {
                (self.letters(owners))
            }
        }
    }

    /// A mark without its letters.
    pub(super) fn disc(&self, at: Spot, radius: f64, owners: &Owners) -> Markup {
        let share = TAU / owners.len().max(1) as f64;
        let rim = |turn: f64| (unit(at.x + radius * turn.sin()), unit(at.y - radius * turn.cos()));
        html! {
            @if owners.len() < 2 {
                @let colour = owners.first().map_or("var(--panel)", |name| self.colour(name));
                circle.rim cx=(unit(at.x)) cy=(unit(at.y)) r=(unit(radius)) fill=(colour) {}
            } @else {
                @for (place, name) in owners.iter().enumerate() {
                    @let (from, to) = (rim(share * place as f64), rim(share * (place + 1) as f64));
                    path fill=(self.colour(name)) d=(format!(
                        "M{} {}L{} {}A{radius:.1} {radius:.1} 0 0 1 {} {}z",
                        unit(at.x), unit(at.y), from.0, from.1, to.0, to.1
                    )) {}
                }
                circle.rim cx=(unit(at.x)) cy=(unit(at.y)) r=(unit(radius)) fill="none" {}
            }
        }
    }

    /// A mark by itself, for a legend or a line of text.
    pub fn swatch(&self, owners: &Owners) -> Markup {
        html! {
            svg.swatch viewBox="0 0 24 24" width="20" height="20" aria-hidden="true" {
                (self.mark(Spot { x: 12.0, y: 12.0 }, 11.0, owners))
            }
        }
    }
}

/// The shortest beginning of a name, of at most three letters, with which no other name begins.
fn initials(name: &UserName, others: &[&UserName]) -> String {
    let beginning = |name: &UserName, letters: usize| name.as_str().chars().take(letters).collect::<String>();
    (1..=2)
        .map(|letters| beginning(name, letters))
        .find(|text| others.iter().all(|other| beginning(other, text.chars().count()) != *text))
        .unwrap_or_else(|| beginning(name, 3))
}
