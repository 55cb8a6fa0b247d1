//! Strips around spans, which tell that they are apart before their distance is computed.

use crate::span::Span;
use mainspring_geometry::Vec2;
use mainspring_mechanism::Pose;

/// All points nearer than `thick` to a chord, which reaches `half` to both sides of its centre in direction `along`: as tight
/// around flat arcs as a disc is wide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slat {
    center: Vec2,
    along: Vec2,
    half: f64,
    thick: f64,
}

impl Slat {
    /// The one around a span.
    pub fn around(span: &Span) -> Self {
        let [a, b] = span.ends();
        let (center, half) = ((a + b) * 0.5, 0.5 * (b - a).norm());
        let thick = match *span {
            Span::Line { .. } => 0.0,
            Span::Arc { radius, sector, .. } if sector.sweep < std::f64::consts::PI => {
                half * half / (radius + ((radius - half) * (radius + half)).max(0.0).sqrt())
            }
            Span::Arc { .. } => f64::INFINITY,
        };
        let along = if half > 0.0 { (b - a) * (0.5 / half) } else { Vec2::new(1.0, 0.0) };
        Slat { center, along, half, thick }
    }

    /// At least so far apart are this one, placed at `pose`, and another: across either's chord.
    pub fn apart(&self, pose: &Pose, other: &Self) -> f64 {
        let (d, along) = (pose.apply(self.center) - other.center, pose.rotate(self.along));
        let turned = along.cross(other.along).abs();
        let across = other.along.cross(d).abs() - turned * self.half;
        across.max(along.cross(d).abs() - turned * other.half) - self.thick - other.thick
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mainspring_geometry::Segment;

    /// Lines and arcs of any sweep at random places.
    fn span(mut random: impl FnMut() -> f64) -> Span {
        let mut point = || Vec2::new(random(), random());
        let (from, to) = (point(), point());
        let bulge = point();
        let half = 0.5 * (to - from).norm();
        let radius = half / (0.05 + 0.9 * bulge.x.abs());
        let side = ((radius - half) * (radius + half)).max(0.0).sqrt();
        let center = (from + to) * 0.5 + (to - from).perp() * (bulge.y.signum() * side * 0.5 / half);
        let segment = if bulge.x < -0.5 {
            Segment::Line { from, to }
        } else {
            Segment::Arc { from, to, center, radius, convex: bulge.x * bulge.y > 0.0 }
        };
        Span::new(&segment, &Pose::identity())
    }

    #[test]
    fn slats_are_never_farther_apart_than_their_spans() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut tight = 0;
        for _ in 0..20_000 {
            let (a, b) = (span(&mut random), span(&mut random));
            let (sin, cos) = (3.0 * random()).sin_cos();
            let pose = Pose { cos, sin, shift: Vec2::new(random(), random()) };
            let (bound, distance) =
                (Slat::around(&a).apart(&pose, &Slat::around(&b)), a.placed(&pose).distance(&b));
            assert!(bound <= distance + 1e-12, "{bound} > {distance}");
            tight += usize::from(bound > 0.5 * distance);
        }
        assert!(tight > 2_000, "{tight}");
    }
}
