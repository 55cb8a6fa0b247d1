//! Coordinates tied together by contacts and masses.

use crate::inertia::Freedom;
use mainspring_mechanism::{Indices, Row, join_sharing};

/// Coordinates that something ties together: a contact (an index into the rows) or masses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tie {
    pub coordinates: Indices,
    pub contact: Option<usize>,
}

impl Tie {
    /// The coordinates of a contact's row, those left out that are held.
    pub fn of_row(freedom: &Freedom, row: &Row, k: usize) -> Self {
        let coordinates = row.entries().map(|e| e.0).filter(|&i| !freedom.is_held(i)).collect();
        Self { coordinates, contact: Some(k) }
    }
}

/// Coordinates tied together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// In increasing order.
    pub coordinates: Indices,
    /// Indices into the rows.
    pub contacts: Indices,
}

/// Sorts ties into groups that share coordinates, in a fixed order. Ties without coordinates are left out.
pub fn groups(ties: impl IntoIterator<Item = Tie>) -> Vec<Group> {
    let sets = ties.into_iter().map(|tie| (tie.coordinates, tie.contact.into_iter().collect()));
    let group = |(coordinates, contacts)| Group { coordinates, contacts };
    join_sharing(sets).into_iter().map(group).collect()
}
