//! The primitives of which the edges of a drawn part are faces: see [`mainspring_geometry::WallLayer`].

use super::Profile;
use super::draw::{Drawn, DrawnEdge};
use super::fillet::unit;
use crate::angle::with_real;
use crate::error::{Fault, Place, Read};
use mainspring_geometry::{Primitive, Rigid3, Scalar, Segment, Shape, Vec2, Vec3, Wall, WallLayer};

/// How thick the block behind a straight wall is, relative to its length: only its face counts.
const THIN: f64 = 1e-6;

/// What is known of a wall beside its primitive.
#[derive(Clone, Debug)]
pub(crate) struct WallText {
    pub label: String,
    pub place: Place,
}

impl Profile {
    /// One primitive for each edge, in the order in which [`Profile::walls`] names them. Real parts are those of
    /// `f64` to the last bit.
    pub fn primitives<S: Scalar>(&self, values: &[S]) -> Read<Vec<Primitive<S>>> {
        let found = self.over(values)?;
        if S::NDERIV == 0 {
            return Ok(found);
        }
        let plain: Vec<f64> = values.iter().map(|v| v.re()).collect();
        let plain = self.over(&plain)?;
        if plain.len() != found.len() {
            return Err(Fault::new(Place::default(), "the boundary is not the same; expected other values"));
        }
        Ok(found.iter().zip(&plain).map(|(s, p)| exact(s, p)).collect())
    }

    fn over<S: Scalar>(&self, values: &[S]) -> Read<Vec<Primitive<S>>> {
        let mut primitives = Vec::new();
        for (layer, drawn) in self.draw(values)?.iter().enumerate() {
            for ring in &drawn.rings {
                for edge in &ring.edges {
                    let place = super::draw::place_of(self, layer, ring.text, Some(edge.text));
                    primitives.push(primitive(edge, drawn, place, &self.part)?);
                }
            }
        }
        Ok(primitives)
    }

    /// The layers, whose walls are the primitives from `first` on, from bottom to top; and what each wall is called.
    pub fn walls(&self, drawn: &[Drawn<f64>], first: u32) -> (Vec<WallLayer>, Vec<WallText>) {
        let (mut layers, mut texts, mut next) = (Vec::new(), Vec::new(), first);
        for (l, layer) in drawn.iter().enumerate() {
            let mut loops = Vec::new();
            for ring in &layer.rings {
                let wall = |e: &DrawnEdge<f64>| {
                    next += 1;
                    let convex = match e.segment {
                        Segment::Line { .. } => true,
                        Segment::Arc { convex, .. } | Segment::Circle { convex, .. } => convex,
                    };
                    Wall { primitive: next - 1, convex }
                };
                loops.push(ring.edges.iter().map(wall).collect());
                texts.extend(ring.edges.iter().map(|e| self.text(l, ring.text, e)));
            }
            layers.push((layer.z[0], WallLayer { loops }));
        }
        layers.sort_by(|a, b| a.0.total_cmp(&b.0));
        (layers.into_iter().map(|l| l.1).collect(), texts)
    }

    fn text(&self, layer: usize, text: usize, edge: &DrawnEdge<f64>) -> WallText {
        let name = &self.layers[layer].loops[text].name;
        let what = if edge.fillet { "fillet" } else { "segment" };
        WallText {
            label: format!("{} ({name}, {what} {})", self.part, edge.text + 1),
            place: super::draw::place_of(self, layer, text, Some(edge.text)),
        }
    }
}

fn primitive<S: Scalar>(
    edge: &DrawnEdge<S>,
    layer: &Drawn<S>,
    place: Place,
    part: &str,
) -> Read<Primitive<S>> {
    let [bottom, top] = layer.z;
    let height = top - bottom;
    let at = |p: Vec2<S>| Vec3::new(p.x, p.y, bottom);
    let fault = || Fault::new(place, format!("part {part}: a segment has no finite length; expected one"));
    let (shape, origin, x) = match edge.segment {
        Segment::Line { from, to } => {
            let d = to - from;
            let length = crate::angle::root(d.dot(d));
            (Shape::Block { x: length, y: length * THIN, z: height }, at(from), unit(d).ok_or_else(fault)?)
        }
        Segment::Arc { from, center, radius, .. } => {
            (Shape::Cylinder { radius, height }, at(center), unit(from - center).ok_or_else(fault)?)
        }
        Segment::Circle { center, radius, .. } => {
            let x = Vec2::new(S::constant(1.0), S::constant(0.0));
            (Shape::Cylinder { radius, height }, at(center), x)
        }
    };
    let (o, l) = (S::constant(0.0), S::constant(1.0));
    let columns = [Vec3::new(x.x, x.y, o), Vec3::new(o - x.y, x.x, o), Vec3::new(o, o, l)];
    let pose = Rigid3 { columns, translation: origin };
    let p = Primitive { shape, machine_from_local: pose };
    if is_usable(&p.re()) { Ok(p) } else { Err(fault()) }
}

fn is_usable(p: &Primitive) -> bool {
    let sizes = match p.shape {
        Shape::Block { x, y, z } => [x, y, z],
        Shape::Cylinder { radius, height } => [radius, radius, height],
        _ => [0.0; 3],
    };
    let t = p.machine_from_local.translation;
    sizes.iter().all(|s| *s > 0.0 && s.is_finite()) && [t.x, t.y, t.z].iter().all(|c| c.is_finite())
}

/// A primitive with the real parts of another one.
fn exact<S: Scalar>(dual: &Primitive<S>, plain: &Primitive) -> Primitive<S> {
    let shape = match (dual.shape, plain.shape) {
        (Shape::Block { x, y, z }, Shape::Block { x: a, y: b, z: c }) => {
            Shape::Block { x: with_real(x, a), y: with_real(y, b), z: with_real(z, c) }
        }
        (Shape::Cylinder { radius, height }, Shape::Cylinder { radius: r, height: h }) => {
            Shape::Cylinder { radius: with_real(radius, r), height: with_real(height, h) }
        }
        (other, _) => other,
    };
    let vector =
        |v: Vec3<S>, r: Vec3| Vec3::new(with_real(v.x, r.x), with_real(v.y, r.y), with_real(v.z, r.z));
    let (d, p) = (&dual.machine_from_local, &plain.machine_from_local);
    let columns = std::array::from_fn(|i| vector(d.columns[i], p.columns[i]));
    let translation = vector(d.translation, p.translation);
    Primitive { shape, machine_from_local: Rigid3 { columns, translation } }
}
