//! What follows what along a body's boundary: which features meet at a convex corner or in a smooth joint.
//!
//! At a convex corner and in a smooth joint the boundary hands a contact on from feature to feature. At a concave
//! corner it does not: there both sides can be touched at once.

use crate::feature::{Cone, Feature, FeatureShape};
use mainspring_geometry::{Edge, Outline, Segment, Turn};

/// For each feature of a body those that take a contact over at its ends.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary {
    neighbours: Vec<Vec<u32>>,
}

impl Boundary {
    /// Of the features of an outline. `size` is the part's, as for [`crate::features`].
    pub fn new(outline: &Outline, features: &[Feature], size: f64) -> Self {
        let mut neighbours: Vec<Vec<u32>> =
            features.iter().map(|f| f.neighbours.iter().map(|&i| i as u32).collect()).collect();
        let mut join = |a: usize, b: usize| {
            for (from, to) in [(a, b), (b, a)] {
                if !neighbours[from].contains(&(to as u32)) {
                    neighbours[from].push(to as u32);
                }
            }
        };
        for boundary in outline.layers.iter().flat_map(|layer| &layer.loops) {
            let edges = &boundary.edges;
            for (i, edge) in edges.iter().enumerate() {
                if edge.turn_at_start != Turn::Smooth || edges.len() < 2 {
                    continue;
                }
                let before = &edges[(i + edges.len() - 1) % edges.len()];
                let found = |edge: &Edge| find(features, edge, 1e-9 * size);
                if let (Some(a), Some(b)) = (found(before), found(edge)) {
                    join(a, b);
                }
            }
        }
        Self { neighbours }
    }

    /// Features that meet feature `i` at a convex corner or in a smooth joint: a corner those it lies between, an
    /// edge or arc its corners and smooth continuations.
    pub fn neighbours(&self, i: u32) -> &[u32] {
        &self.neighbours[i as usize]
    }
}

/// The feature of an edge; edges that agree in several layers are one feature.
fn find(features: &[Feature], edge: &Edge, tolerance: f64) -> Option<usize> {
    features.iter().position(|f| {
        f.name.curve == edge.curve && f.name.next.is_none() && has_shape(&f.shape, &edge.segment, tolerance)
    })
}

fn has_shape(shape: &FeatureShape, segment: &Segment, tolerance: f64) -> bool {
    let near = |a: mainspring_geometry::Vec2, b| (a - b).norm() <= 2.0 * tolerance;
    match (shape, *segment) {
        (FeatureShape::Edge { from, to, .. }, Segment::Line { from: a, to: b }) => {
            near(*from, a) && near(*to, b)
        }
        (
            FeatureShape::Round { center, radius, cone } | FeatureShape::Hollow { center, radius, cone },
            Segment::Arc { center: c, radius: r, .. },
        ) => {
            let middle = (segment.at(0.5) - c).unit();
            let inside = matches!(cone, Cone::Full) || cone.margin(middle) > 0.0;
            near(*center, c) && (radius - r).abs() <= 2.0 * tolerance && inside
        }
        _ => false,
    }
}
