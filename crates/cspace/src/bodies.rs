//! What contact needs of the two bodies of a system: features that count, sections, kinds of contact.

use crate::moving::Moving;
use crate::pairs::Part;
use crate::reduce::Reduced;
use crate::section::Section;
use crate::shape::Shape;
use crate::span::Span;
use mainspring_geometry::{CurveId, Vec2};
use mainspring_mechanism::{Feature, FeatureName, FeatureShape, GapKind, Interaction, Pose, System};

/// Features of a pair of bodies as the system's interaction sees them.
pub(crate) struct Contact<'a> {
    system: &'a System,
    bodies: [usize; 2],
    interaction: Option<&'a Interaction>,
}

/// A feature that can touch anything anywhere, to ask which others are excluded.
fn probe(shape: FeatureShape) -> Feature {
    Feature {
        name: FeatureName { curve: CurveId { primitive: 0, face: 0 }, next: None, occurrence: 0 },
        shape,
        curves: [vec![], vec![]],
        at: (0, 0, 0),
        heights: vec![(0.0, f64::INFINITY)],
        neighbours: vec![],
        center: Vec2::default(),
        radius: 0.0,
    }
}

impl<'a> Contact<'a> {
    pub fn new(system: &'a System, bodies: [usize; 2]) -> Self {
        let pair = (bodies[0].min(bodies[1]), bodies[0].max(bodies[1]));
        let interaction = system.interactions.iter().find(|i| i.bodies == pair);
        Contact { system, bodies, interaction }
    }

    pub fn exists(&self) -> bool {
        self.interaction.is_some()
    }

    fn features(&self, k: usize) -> &'a [Feature] {
        &self.system.features[self.bodies[k]]
    }

    /// The kind of contact of feature `i` of the first and `j` of the second body.
    pub fn kind(&self, i: usize, j: usize) -> Option<GapKind> {
        self.kind_of((i, j), (&self.features(0)[i], &self.features(1)[j]))
    }

    fn kind_of(&self, (i, j): (usize, usize), (a, b): (&Feature, &Feature)) -> Option<GapKind> {
        let interaction = self.interaction?;
        if self.bodies[0] < self.bodies[1] {
            interaction.kind((i, j), (a, b))
        } else {
            interaction.kind((j, i), (b, a))
        }
    }

    /// For each feature of body `k` whether it takes part in contact.
    fn usable(&self, k: usize) -> Vec<bool> {
        let x = Vec2::new(1.0, 0.0);
        let round =
            probe(FeatureShape::Round { center: x, radius: 1.0, cone: mainspring_mechanism::Cone::Full });
        let edge = probe(FeatureShape::Edge { from: x, to: x, tangent: x, normal: x, length: 1.0 });
        let (n, m) = (self.features(k).len(), self.features(1 - k).len());
        let asks = |i: usize, j: usize| {
            let ids = if k == 0 { (i, j) } else { (j, i) };
            self.kind_of(ids, (&round, &edge)).is_some()
        };
        (0..n).map(|i| self.interaction.is_none() || (0..m).any(|j| asks(i, j))).collect()
    }

    /// Features of body `k` that take part in contact.
    pub fn parts(&self, k: usize, moving: &Moving) -> Vec<Part> {
        let usable = self.usable(k);
        let of = |(id, f): (usize, &Feature)| {
            usable[id].then(|| {
                let center = moving.local.apply(f.center);
                let lever = moving.lever(center, f.radius);
                let (shape, neighbours) = (Shape::new(f, &moving.local), f.neighbours.clone());
                let center_lever = match shape {
                    Shape::Arc { center, .. } => moving.lever(center, 0.0),
                    Shape::Edge { .. } => lever,
                };
                Part { id, shape, neighbours, disc: (center, f.radius), lever, center_lever }
            })
        };
        self.features(k).iter().enumerate().filter_map(of).collect()
    }

    /// The layers of body `k`.
    pub fn sections(&self, k: usize, moving: &Moving) -> Vec<Section> {
        let usable = self.usable(k);
        let smooth = self.features(k).iter().enumerate().filter(|(_, f)| f.name.next.is_none());
        let mut by_curve: Vec<(CurveId, usize)> = smooth.map(|(i, f)| (f.name.curve, i)).collect();
        by_curve.sort_unstable();
        let outline = &self.system.bodies[self.bodies[k]].outline;
        outline
            .layers
            .iter()
            .map(|layer| {
                Section::new(layer, &moving.local, |i, j| {
                    let edge = &layer.loops[i].edges[j];
                    let center = Span::new(&edge.segment, &Pose::identity()).disc().0;
                    let off = |f: usize| (self.features(k)[f].center - center).norm();
                    let first = by_curve.partition_point(|(curve, _)| *curve < edge.curve);
                    let all = by_curve[first..].iter().take_while(|(curve, _)| *curve == edge.curve);
                    let nearest = all.map(|(_, f)| *f).min_by(|a, b| off(*a).total_cmp(&off(*b)));
                    nearest.filter(|&f| usable[f]).unwrap_or(usize::MAX)
                })
            })
            .collect()
    }
}

/// Contact of a reduced pair.
pub(crate) fn contact<'a>(system: &'a System, reduced: &Reduced) -> Contact<'a> {
    Contact::new(system, reduced.bodies)
}
