//! Features in local coordinates: a straight edge, or an arc with the directions its outward normals may take.

use mainspring_geometry::Vec2;
use mainspring_mechanism::{Cone, Feature, FeatureShape, Pose};

/// A cone of directions, counterclockwise from `start` to `end`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Directions {
    cone: Cone,
    /// The two ends; none for a whole circle.
    pub ends: Option<[Vec2; 2]>,
}

impl Directions {
    fn new(cone: &Cone, local: &Pose) -> Self {
        match *cone {
            Cone::Full => Directions { cone: Cone::Full, ends: None },
            Cone::Narrow { start, end } => {
                let (start, end) = (local.rotate(start), local.rotate(end));
                Directions { cone: Cone::Narrow { start, end }, ends: Some([start, end]) }
            }
            Cone::Wide { middle, cos_half } => {
                let middle = local.rotate(middle);
                let sin_half = ((1.0 - cos_half) * (1.0 + cos_half)).max(0.0).sqrt();
                let ends = [-1.0, 1.0].map(|s| middle * cos_half + middle.perp() * (s * sin_half));
                Directions { cone: Cone::Wide { middle, cos_half }, ends: Some(ends) }
            }
        }
    }

    /// How far inside the unit vector `d` lies; see `Cone::margin`.
    pub fn margin(&self, d: Vec2) -> f64 {
        self.cone.margin(d)
    }
}

/// A feature's shape in local coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Edge {
        from: Vec2,
        tangent: Vec2,
        normal: Vec2,
        length: f64,
    },
    /// Convex arc or corner; concave if `hollow`.
    Arc {
        center: Vec2,
        radius: f64,
        directions: Directions,
        hollow: bool,
    },
}

impl Shape {
    pub fn new(feature: &Feature, local: &Pose) -> Self {
        let arc = |center: &Vec2, radius: &f64, cone: &Cone, hollow| Shape::Arc {
            center: local.apply(*center),
            radius: *radius,
            directions: Directions::new(cone, local),
            hollow,
        };
        match &feature.shape {
            FeatureShape::Edge { from, tangent, normal, length, .. } => Shape::Edge {
                from: local.apply(*from),
                tangent: local.rotate(*tangent),
                normal: local.rotate(*normal),
                length: *length,
            },
            FeatureShape::Round { center, radius, cone } => arc(center, radius, cone, false),
            FeatureShape::Hollow { center, radius, cone } => arc(center, radius, cone, true),
        }
    }
}

/// The direction `d` of the machine seen in a placed body's local coordinates.
pub(crate) fn unrotate(pose: &Pose, d: Vec2) -> Vec2 {
    Vec2::new(pose.cos * d.x + pose.sin * d.y, -pose.sin * d.x + pose.cos * d.y)
}
