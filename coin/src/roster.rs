//! The members of a household as small numbers, so that a set of owners is one machine word.

use coin_schemas::household::{Background, Owners, OwnershipBoolean, Score, Scores, UserName, Users};
use thiserror::Error;

use crate::owners::OwnerSet;

/// The most members a household can have: owner sets are 64-bit words.
pub const MAX_USERS: usize = 64;

/// The place of a member in the [`Roster`], from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct UserIndex(u8);

impl UserIndex {
    /// The member at `place`; `None` from [`MAX_USERS`] on.
    pub fn new(place: usize) -> Option<Self> {
        u8::try_from(place).ok().filter(|&small| usize::from(small) < MAX_USERS).map(Self)
    }

    /// The place, from 0.
    pub fn place(self) -> usize {
        usize::from(self.0)
    }
}

/// Why people do not make a household, or a name is not of it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RosterError {
    /// There is nobody.
    #[error("a household has at least one member, and none is given")]
    NoUsers,
    /// There are more than [`MAX_USERS`] people.
    #[error("a household has at most {MAX_USERS} members, and {given} are given")]
    TooManyUsers {
        /// How many.
        given: usize,
    },
    /// The name is not of this household.
    #[error("{name:?} is not a member of the household; its members are {}", members.join(", "))]
    UnknownUser {
        /// The name.
        name: String,
        /// Who there is.
        members: Vec<String>,
    },
    /// A member has no score.
    #[error("there is no score for {name}")]
    MissingScore {
        /// Who.
        name: UserName,
    },
}

/// The members of a household in the order of their names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Roster {
    members: Vec<(UserName, Background)>,
}

impl Roster {
    /// Takes 1 to [`MAX_USERS`] people.
    pub fn new(users: &Users) -> Result<Self, RosterError> {
        match users.len() {
            0 => Err(RosterError::NoUsers),
            given if given > MAX_USERS => Err(RosterError::TooManyUsers { given }),
            _ => Ok(Self {
                members: users.iter().map(|(name, background)| (name.clone(), background.clone())).collect(),
            }),
        }
    }

    /// How many members there are.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Never true; a household has at least one member.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// The members in order.
    pub fn indices(&self) -> impl Iterator<Item = UserIndex> + use<> {
        (0..self.len()).filter_map(UserIndex::new)
    }

    /// The names in order.
    pub fn names(&self) -> impl Iterator<Item = &UserName> {
        self.members.iter().map(|(name, _)| name)
    }

    /// The members and their background, as files hold them.
    pub fn users(&self) -> Users {
        self.members.iter().cloned().collect()
    }

    /// The name of a member.
    ///
    /// # Panics
    /// If `user` belongs to a larger roster.
    pub fn name(&self, user: UserIndex) -> &UserName {
        &self.members[user.place()].0
    }

    /// The background of a member.
    ///
    /// # Panics
    /// If `user` belongs to a larger roster.
    pub fn background(&self, user: UserIndex) -> &Background {
        &self.members[user.place()].1
    }

    /// The member of exactly this name.
    pub fn index_of(&self, name: &str) -> Result<UserIndex, RosterError> {
        self.members
            .binary_search_by(|(member, _)| member.as_str().cmp(name))
            .ok()
            .and_then(UserIndex::new)
            .ok_or_else(|| RosterError::UnknownUser {
                name: name.to_owned(),
                members: self.members.iter().map(|(member, _)| member.to_string()).collect(),
            })
    }

    /// All members as a set.
    pub fn everyone(&self) -> OwnerSet {
        self.indices().collect()
    }

    /// The names of a set.
    pub fn owners(&self, set: OwnerSet) -> Owners {
        set.iter().map(|user| self.name(user).clone()).collect()
    }

    /// The set of these names.
    pub fn owner_set<'a>(
        &self,
        names: impl IntoIterator<Item = &'a UserName>,
    ) -> Result<OwnerSet, RosterError> {
        names.into_iter().map(|name| self.index_of(name.as_str())).collect()
    }

    /// Scores in the order of the roster, from scores by name. Every member needs one; other names are refused.
    pub fn score_vector(&self, scores: &Scores) -> Result<Vec<Score>, RosterError> {
        for name in scores.keys() {
            self.index_of(name.as_str())?;
        }
        self.names()
            .map(|name| {
                scores.get(name).copied().ok_or_else(|| RosterError::MissingScore { name: name.clone() })
            })
            .collect()
    }

    /// Scores by name, from scores in the order of the roster.
    ///
    /// # Panics
    /// If there is not exactly one score for each member.
    pub fn scores(&self, vector: &[Score]) -> Scores {
        assert!(vector.len() == self.len(), "one score for each member");
        self.names().cloned().zip(vector.iter().copied()).collect()
    }

    /// For every member whether the set holds it.
    pub fn ownership(&self, set: OwnerSet) -> OwnershipBoolean {
        self.indices().map(|user| (self.name(user).clone(), set.contains(user))).collect()
    }

    /// 1 for the members of the set, 0 for the others.
    pub fn indicator(&self, set: OwnerSet) -> Scores {
        self.indices()
            .map(|user| (self.name(user).clone(), if set.contains(user) { Score::ONE } else { Score::ZERO }))
            .collect()
    }
}

#[cfg(test)]
mod tests;
