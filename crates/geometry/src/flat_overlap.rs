//! Do two outlines overlap as they lie? Touching is allowed.
//!
//! Every boundary is cut where it meets the other; the middle of each piece is judged by the other outline. Where
//! neither has a piece inside the other, they overlap only if one holds the other's inside.

use crate::{Curve, Layer, Outline, OutlineError, Segment, Vec2};

/// Pairs of segments compared for two outlines at most.
const PAIRS: usize = 4_000_000;

impl Outline<f64> {
    /// A point of the plane, and its height, that lies deeper than `tolerance` (a length) inside both outlines.
    ///
    /// # Errors
    /// [`OutlineError::TooComplex`] if the outlines have too many segments near each other.
    pub fn overlap(&self, other: &Self, tolerance: f64) -> Result<Option<(Vec2, f64)>, OutlineError> {
        let mut left = PAIRS;
        for a in &self.layers {
            for b in &other.layers {
                let (bottom, top) = (a.bottom.max(b.bottom), a.top.min(b.top));
                if top - bottom <= tolerance {
                    continue;
                }
                if let Some(p) = common_point(a, b, tolerance, &mut left)? {
                    return Ok(Some((p, 0.5 * (bottom + top))));
                }
            }
        }
        Ok(None)
    }
}

fn segments(layer: &Layer) -> impl Iterator<Item = &Segment> {
    layer.loops.iter().flat_map(|l| &l.edges).map(|e| &e.segment)
}

fn common_point(
    a: &Layer,
    b: &Layer,
    tolerance: f64,
    left: &mut usize,
) -> Result<Option<Vec2>, OutlineError> {
    for (x, y) in [(a, b), (b, a)] {
        let near = reach_of(y, tolerance);
        for s in segments(x) {
            if !near.is_some_and(|n| meet(n, s.bounds())) {
                continue;
            }
            for p in pieces(s, y, tolerance, left)? {
                if is_deep(y, p, tolerance) {
                    return Ok(Some(p));
                }
            }
        }
        if let Some(p) = x.interior_point().filter(|p| is_deep(y, *p, tolerance)) {
            return Ok(Some(p));
        }
    }
    Ok(None)
}

type Corners = (Vec2, Vec2);

fn reach_of(layer: &Layer, margin: f64) -> Option<Corners> {
    let m = Vec2::new(margin, margin);
    layer.bounds().map(|(min, max)| (min - m, max + m))
}

fn meet(a: Corners, b: Corners) -> bool {
    a.0.x <= b.1.x && b.0.x <= a.1.x && a.0.y <= b.1.y && b.0.y <= a.1.y
}

/// The middles of the pieces into which a layer's boundary cuts a segment.
fn pieces(s: &Segment, layer: &Layer, tolerance: f64, left: &mut usize) -> Result<Vec<Vec2>, OutlineError> {
    let mut cuts = vec![0.0, 1.0];
    let (box_s, curve) = (s.bounds(), Curve::along(s));
    for other in segments(layer) {
        *left = left.checked_sub(1).ok_or(OutlineError::TooComplex)?;
        if !reach_of_segment(other, tolerance, box_s) {
            continue;
        }
        let points = curve.common_points(&Curve::along(other), tolerance, 1e-12).into_iter().flatten();
        let ends = [other.start(), other.end()];
        let on = |p: &Vec2| s.reaches(*p, tolerance) && other.reaches(*p, tolerance);
        cuts.extend(points.chain(ends).filter(on).map(|p| s.fraction(p)));
    }
    cuts.retain(|c| (0.0..=1.0).contains(c));
    cuts.sort_by(f64::total_cmp);
    Ok(cuts.windows(2).filter(|w| w[1] > w[0]).map(|w| s.at(0.5 * (w[0] + w[1]))).collect())
}

fn reach_of_segment(s: &Segment, margin: f64, other: Corners) -> bool {
    let (min, max) = s.bounds();
    let m = Vec2::new(margin, margin);
    meet((min - m, max + m), other)
}

fn is_deep(layer: &Layer, p: Vec2, tolerance: f64) -> bool {
    layer.contains(p) && segments(layer).all(|s| s.distance(p) > tolerance)
}
