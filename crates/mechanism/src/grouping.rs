//! Sets joined where they share coordinates.

/// A list of indices that stays off the heap while it is short.
pub type Indices = smallvec::SmallVec<[usize; 4]>;

/// Joins sets of coordinates that share any, with their members, to sets that share none: in the order of their
/// coordinates, all lists increasing and each coordinate once. Sets without coordinates are left out.
pub fn join_sharing(sets: impl IntoIterator<Item = (Indices, Indices)>) -> Vec<(Indices, Indices)> {
    let mut apart: Vec<(Indices, Indices)> = Vec::new();
    for (mut coordinates, mut members) in sets.into_iter().filter(|s| !s.0.is_empty()) {
        let own = coordinates.len();
        apart.retain_mut(|set| {
            let apart = !set.0.iter().any(|i| coordinates[..own].contains(i));
            if !apart {
                coordinates.append(&mut set.0);
                members.append(&mut set.1);
            }
            apart
        });
        coordinates.sort_unstable();
        coordinates.dedup();
        members.sort_unstable();
        apart.push((coordinates, members));
    }
    apart.sort_by(|a, b| a.0.cmp(&b.0));
    apart
}

#[cfg(test)]
mod tests {
    use super::{Indices, join_sharing};
    use smallvec::smallvec;

    #[test]
    fn a_late_set_joins_earlier_ones() {
        let sets: [(Indices, Indices); 4] = [
            (smallvec![4], smallvec![0]),
            (smallvec![1, 2], smallvec![1]),
            (smallvec![7], smallvec![2]),
            (smallvec![2, 4], smallvec![3]),
        ];
        let expected: [(Indices, Indices); 2] =
            [(smallvec![1, 2, 4], smallvec![0, 1, 3]), (smallvec![7], smallvec![2])];
        assert_eq!(join_sharing(sets), expected);
        assert_eq!(join_sharing([(smallvec![], smallvec![5])]), []);
    }
}
