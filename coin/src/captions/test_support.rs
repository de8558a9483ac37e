//! Households for tests.

use coin_schemas::household::{Background, UserName, Users};

use crate::roster::Roster;

/// Members and their roles; an empty role is none.
pub(crate) fn roster(members: &[(&str, &str)]) -> Roster {
    let users: Users = members
        .iter()
        .map(|&(name, role)| {
            let role = (!role.is_empty()).then(|| role.to_owned());
            (UserName::new(name).unwrap(), Background { role, occupation: None })
        })
        .collect();
    Roster::new(&users).unwrap()
}
