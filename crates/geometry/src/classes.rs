//! Groups coincident supporting curves. Every class is represented by its first curve in the text, and all
//! points are computed on these representatives, so coincidences need no further tolerance.

use crate::Vec2;
use crate::curve::Curve;
use crate::section::Face;
use std::f64::consts::PI;

/// What counts as equal; all relative to the part's size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerance {
    /// Lengths, in the file's unit.
    pub length: f64,
    /// Directions, in radians.
    pub angle: f64,
    /// The middle of the part, about which offsets of lines are compared.
    pub center: Vec2,
}

impl Tolerance {
    /// Are the middles of two sub-edges with common ends so near that nothing can lie between them? Ends
    /// are moved by up to the tolerance onto their common vertex, hence the factor.
    pub fn sliver(&self, a: Vec2, b: Vec2) -> bool {
        (a - b).norm() <= 2.0 * self.length
    }
}

/// The classes of a list of faces.
#[derive(Debug)]
pub(crate) struct Classes {
    /// Class of every face.
    pub of: Vec<u32>,
    /// Of a face on a line: does its normal agree with the representative's?
    pub same_way: Vec<bool>,
    /// Representatives, in the order of the text.
    pub curves: Vec<Curve>,
}

impl Classes {
    /// `faces` in the order of the text.
    pub fn of(faces: &[Face], tolerance: &Tolerance) -> Self {
        let mut groups = line_groups(faces, tolerance);
        groups.extend(circle_groups(faces, tolerance));
        groups.iter_mut().for_each(|g| g.sort_unstable());
        groups.sort_unstable();
        let mut classes =
            Self { of: vec![0; faces.len()], same_way: vec![true; faces.len()], curves: Vec::new() };
        for (class, group) in groups.iter().enumerate() {
            let first = &faces[group[0] as usize].curve;
            classes.curves.push(*first);
            for &f in group {
                classes.of[f as usize] = class as u32;
                classes.same_way[f as usize] = agree(first, &faces[f as usize].curve);
            }
        }
        classes
    }
}

fn agree(a: &Curve, b: &Curve) -> bool {
    match (a, b) {
        (Curve::Line { normal: n, .. }, Curve::Line { normal: m, .. }) => n.dot(*m) > 0.0,
        _ => true,
    }
}

/// Splits sorted keys where neighbours lie more than `gap` apart.
fn clusters(mut keys: Vec<(f64, u32)>, gap: f64) -> Vec<Vec<(f64, u32)>> {
    keys.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    keys.chunk_by(|a, b| b.0 - a.0 <= gap).map(<[_]>::to_vec).collect()
}

fn circle_groups(faces: &[Face], tolerance: &Tolerance) -> Vec<Vec<u32>> {
    let circles = (0u32..).zip(faces).filter_map(|(i, f)| match f.curve {
        Curve::Circle { center, radius } => Some((i, [radius, center.x, center.y])),
        Curve::Line { .. } => None,
    });
    let circles: Vec<_> = circles.collect();
    let mut groups = vec![(0..circles.len() as u32).collect::<Vec<_>>()];
    for k in 0..3 {
        let split = |g: Vec<u32>| {
            let keys = g.iter().map(|&i| (circles[i as usize].1[k], i)).collect();
            clusters(keys, tolerance.length).into_iter().map(|c| c.into_iter().map(|e| e.1).collect())
        };
        groups = groups.into_iter().flat_map(split).collect();
    }
    groups.into_iter().map(|g| g.into_iter().map(|i| circles[i as usize].0).collect()).collect()
}

fn line_groups(faces: &[Face], tolerance: &Tolerance) -> Vec<Vec<u32>> {
    let angles = (0u32..).zip(faces).filter_map(|(i, f)| match f.curve {
        Curve::Line { normal, .. } => Some((normal.y.atan2(normal.x).rem_euclid(PI), i)),
        Curve::Circle { .. } => None,
    });
    let turned = cut_at_widest_gap(angles.collect());
    let offsets = |cluster: Vec<(f64, u32)>| {
        let sense = Vec2::new(cluster[0].0.cos(), cluster[0].0.sin());
        let offset = |i: u32| match faces[i as usize].curve {
            Curve::Line { point, normal } => {
                normal.dot(point - tolerance.center) * normal.dot(sense).signum()
            }
            Curve::Circle { .. } => 0.0,
        };
        clusters(cluster.iter().map(|&(_, i)| (offset(i), i)).collect(), tolerance.length)
    };
    let groups = clusters(turned, tolerance.angle).into_iter().flat_map(offsets);
    groups.map(|g| g.into_iter().map(|e| e.1).collect()).collect()
}

/// Directions are a circle of length π: moves its cut to where no two neighbours are near.
fn cut_at_widest_gap(mut keys: Vec<(f64, u32)>) -> Vec<(f64, u32)> {
    keys.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let gap =
        |i: usize| if i == 0 { keys[0].0 + PI - keys[keys.len() - 1].0 } else { keys[i].0 - keys[i - 1].0 };
    let Some(widest) = (0..keys.len()).max_by(|&a, &b| gap(a).total_cmp(&gap(b))) else { return keys };
    let cut = keys[widest].0;
    keys.into_iter().map(|(a, i)| (if a < cut { a + PI } else { a }, i)).collect()
}
