//! What is drawn: the outlines that contact is computed with, in the working plane.

use crate::words::{clean, vec2, vec3};
use mainspring_geometry::{Layer, Segment, Shape, Vec2};
use mainspring_mechanism::{Mechanism, Pair, Part};
use serde_json::{Value, json};

/// Outlines, motions, gears and springs as one object.
pub fn drawing_json(m: &Mechanism) -> Value {
    let parts: Vec<Value> = (0..m.parts.len()).map(|i| part(m, i)).collect();
    let spring = |p: &Part| {
        p.spring.map(|s| json!({"part": p.name, "relaxed": clean(s.relaxed), "constant": s.constant}))
    };
    json!({
        "size": m.size,
        "parts": parts,
        "springs": m.parts.iter().filter_map(spring).collect::<Vec<_>>(),
    })
}

fn part(m: &Mechanism, i: usize) -> Value {
    let part = &m.parts[i];
    let layers: Vec<Value> = part.outline.iter().flat_map(|o| &o.layers).map(layer).collect();
    let motion = part.joint.filter(|_| !part.is_frame).map(|j| motion(m, &m.pairs[j]));
    json!({
        "name": part.name,
        "frame": part.is_frame,
        "carrier": part.carrier.map(|c| &m.parts[c].name),
        "position": clean(part.position),
        "motion": motion,
        "layers": layers,
        "gears": gears(m, i),
    })
}

fn motion(m: &Mechanism, pair: &Pair) -> Value {
    let plane = &m.plane.plane_from_machine;
    if pair.kind.slides() && !pair.kind.turns() {
        let d = plane.rotate(pair.axis.direction);
        return json!({"kind": "slide", "direction": vec2(Vec2::new(d.x, d.y))});
    }
    if !pair.kind.turns() {
        return Value::Null;
    }
    let c = plane.apply(pair.axis.point);
    json!({"kind": "turn", "center": vec2(Vec2::new(c.x, c.y)), "axis": vec3(pair.axis.direction)})
}

fn layer(layer: &Layer) -> Value {
    let loops: Vec<Vec<Value>> =
        layer.loops.iter().map(|l| l.edges.iter().map(|e| segment(&e.segment)).collect()).collect();
    json!({"bottom": layer.bottom, "top": layer.top, "loops": loops})
}

fn segment(segment: &Segment) -> Value {
    match *segment {
        Segment::Line { from, to } => json!({"kind": "line", "from": vec2(from), "to": vec2(to)}),
        Segment::Arc { from, to, center, radius, convex } => json!({
            "kind": "arc", "from": vec2(from), "to": vec2(to),
            "center": vec2(center), "radius": radius, "convex": convex,
        }),
        Segment::Circle { center, radius, convex } => {
            json!({"kind": "circle", "center": vec2(center), "radius": radius, "convex": convex})
        }
    }
}

/// Envelopes of the part's gears.
fn gears(m: &Mechanism, part: usize) -> Vec<Value> {
    let plane = &m.plane.plane_from_machine;
    let members = m.machine.gears().iter().filter(|g| g.part == part).flat_map(|g| &g.members);
    members
        .filter_map(|member| {
            let primitive = &m.primitives[member.primitive as usize];
            let Shape::Cylinder { radius, .. } = primitive.shape else { return None };
            let c = plane.apply(primitive.machine_from_local.translation);
            Some(json!({"center": vec2(Vec2::new(c.x, c.y)), "radius": radius}))
        })
        .collect()
}
