//! Sets joined where they share coordinates.

/// Joins sets of coordinates that share any, with their members, to sets that share none: in the order of their
/// coordinates, all lists increasing and each coordinate once. Sets without coordinates are left out.
pub fn join_sharing(
    sets: impl IntoIterator<Item = (Vec<usize>, Vec<usize>)>,
) -> Vec<(Vec<usize>, Vec<usize>)> {
    let mut apart: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
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
    use super::join_sharing;

    #[test]
    fn a_late_set_joins_earlier_ones() {
        let sets = [(vec![4], vec![0]), (vec![1, 2], vec![1]), (vec![7], vec![2]), (vec![2, 4], vec![3])];
        let expected = vec![(vec![1, 2, 4], vec![0, 1, 3]), (vec![7], vec![2])];
        assert_eq!(join_sharing(sets), expected);
        assert_eq!(join_sharing([(vec![], vec![5])]), vec![]);
    }
}
