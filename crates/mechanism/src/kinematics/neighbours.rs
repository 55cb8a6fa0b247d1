//! Which boxes touch: a sweep along x, so that thousands of parts far from each other cost little.

use super::bounds::Bounds;

/// Pairs of boxes that touch.
pub(crate) struct Neighbours {
    /// (i, j) with i < j, ordered by j, then by i.
    pub pairs: Vec<(usize, usize)>,
    /// There are more than were asked for.
    pub cut_short: bool,
}

/// At most `most` pairs of touching boxes.
pub(crate) fn neighbours(boxes: &[Bounds], most: usize) -> Neighbours {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a].low.x.total_cmp(&boxes[b].low.x).then(a.cmp(&b)));
    let (mut open, mut pairs): (Vec<usize>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
    for b in order {
        open.retain(|&a| boxes[a].high.x >= boxes[b].low.x);
        let touching = open.iter().filter(|&&a| boxes[a].touches(&boxes[b]));
        pairs.extend(touching.map(|&a| (a.min(b), a.max(b))).take(most + 1 - pairs.len()));
        if pairs.len() > most {
            break;
        }
        open.push(b);
    }
    let cut_short = pairs.len() > most;
    pairs.truncate(most);
    pairs.sort_unstable_by_key(|&(i, j)| (j, i));
    Neighbours { pairs, cut_short }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mainspring_geometry::Vec3;

    #[test]
    fn the_same_pairs_as_one_by_one() {
        let spot = |i: usize, k: usize| ((i * k + i * i) % 17) as f64;
        let boxes: Vec<Bounds> = (0..40)
            .map(|i| {
                let low = Vec3::new(spot(i, 3), spot(i, 5), spot(i, 7));
                Bounds { low, high: low + Vec3::new(spot(i, 1) * 0.3, 4.0, 6.0) }
            })
            .collect();
        let all = (0..40).flat_map(|j| (0..j).map(move |i| (i, j)));
        let touching: Vec<_> = all.filter(|&(i, j)| boxes[i].touches(&boxes[j])).collect();
        let found = neighbours(&boxes, 1000);
        assert!(found.pairs == touching && !found.cut_short && touching.len() > 20);
        assert!(!neighbours(&boxes, touching.len()).cut_short);
        let fewer = neighbours(&boxes, touching.len() - 1);
        assert!(fewer.cut_short && fewer.pairs.len() == touching.len() - 1);
    }
}
