//! A shape with every kind of feature.

use mainspring_geometry::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn, Vec2};

fn edge(segment: Segment, primitive: u32, turn: Turn) -> Edge {
    Edge { segment, curve: CurveId { primitive, face: 0 }, aliases: vec![], turn_at_start: turn }
}

pub fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A triangle, a disc and a ring's bore: all kinds of features.
pub fn outline(shift: Vec2) -> Outline {
    let corners = [p(0.0, 0.0), p(2.0, 0.3), p(0.4, 1.1)].map(|c| c + shift);
    let triangle = (0..3)
        .map(|i| {
            let segment = Segment::Line { from: corners[i], to: corners[(i + 1) % 3] };
            edge(segment, i as u32, Turn::Convex)
        })
        .collect();
    let circle = |primitive, center: Vec2, radius, convex| Loop {
        edges: vec![edge(
            Segment::Circle { center: center + shift, radius, convex },
            primitive,
            Turn::Smooth,
        )],
    };
    let loops = vec![
        Loop { edges: triangle },
        circle(7, p(3.0, 1.0), 0.4, true),
        circle(8, p(-1.0, -1.5), 2.5, false),
    ];
    Outline { layers: vec![Layer { bottom: 0.0, top: 1.0, loops }] }
}
