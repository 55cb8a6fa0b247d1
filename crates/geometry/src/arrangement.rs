//! Cuts the curve classes of one slab at their common points.
//!
//! Common points are computed between representatives of classes, only where their faces come near each
//! other; points within the tolerance become one vertex.

use crate::budget::OutlineBudget;
use crate::classes::{Classes, Tolerance};
use crate::section::Face;
use crate::{OutlineError, Vec2};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::f64::consts::{PI, TAU};

/// What listing a face in a slab costs, in pairs.
const FACE: usize = 2;

/// A face's stretch of its class, in the parameter of the class curve.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    lo: f64,
    hi: f64,
    face: u32,
}

/// Overlapping stretches of one class joined together.
#[derive(Clone, Copy, Debug)]
struct Run {
    class: u32,
    lo: f64,
    hi: f64,
    circle: bool,
}

/// A piece of a class between two neighbouring vertices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SubEdge {
    pub class: u32,
    /// Vertices in the class's own direction; `None` for a circle nobody cuts.
    pub ends: Option<[u32; 2]>,
    pub middle: Vec2,
}

/// A face along a sub-edge, and whether its class runs the same way as the sub-edge.
pub(crate) type Along = (u32, bool);

/// A sub-edge kept back with the faces along it.
type Held = (SubEdge, Vec<Along>);

/// The curves of a slab and the vertices that cut them.
#[derive(Debug)]
pub(crate) struct Arrangement {
    pub vertices: Vec<Vec2>,
    stretches: BTreeMap<u32, Vec<Stretch>>,
    /// Parameters and vertices of every class, ascending.
    cuts: BTreeMap<u32, Vec<(f64, u32)>>,
}

impl Arrangement {
    /// Of the faces listed in `members`.
    pub fn new(
        faces: &[Face],
        members: &[u32],
        classes: &Classes,
        tolerance: &Tolerance,
        budget: &mut OutlineBudget,
    ) -> Result<Self, OutlineError> {
        budget.spend_pairs(FACE * members.len())?;
        let stretches = stretches(faces, members, classes);
        let runs = runs(&stretches, classes);
        let points = crossings(&runs, classes, tolerance, budget)?;
        let (vertices, of) = merge_points(&points, tolerance.length);
        let mut cuts: BTreeMap<u32, Vec<(f64, u32)>> = BTreeMap::new();
        for (vertex, point) in of.iter().zip(&points) {
            for class in point.classes {
                let t = classes.curves[class as usize].parameter(vertices[*vertex as usize]);
                cuts.entry(class).or_default().push((t, *vertex));
            }
        }
        for list in cuts.values_mut() {
            list.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            list.dedup_by_key(|c| c.1);
        }
        Ok(Self { vertices, stretches, cuts })
    }

    /// Visits every sub-edge with the faces that lie along it.
    pub fn visit(
        &self,
        classes: &Classes,
        tolerance: &Tolerance,
        mut visit: impl FnMut(SubEdge, &[Along]) -> Result<(), OutlineError>,
    ) -> Result<(), OutlineError> {
        let thin = self.thin_slivers(classes, tolerance);
        let mut held: BTreeMap<(u32, u32), Vec<Held>> = BTreeMap::new();
        self.each(classes, |edge, along| match edge.ends.map(sorted).filter(|e| thin.contains(e)) {
            Some(ends) => {
                held.entry(ends).or_default().push((edge, along.to_vec()));
                Ok(())
            }
            None => visit(edge, along),
        })?;
        for mut group in held.into_values() {
            while !group.is_empty() {
                let (edge, along) = collapse(&mut group, tolerance);
                visit(edge, &along)?;
            }
        }
        Ok(())
    }

    /// Pairs of vertices joined by sub-edges of different classes that are nowhere farther apart than the
    /// tolerance, such as a tangent and its circle on the last stretch before they touch.
    fn thin_slivers(&self, classes: &Classes, tolerance: &Tolerance) -> BTreeSet<(u32, u32)> {
        let mut joins: Vec<((u32, u32), Vec2)> = Vec::new();
        for &class in self.stretches.keys() {
            let curve = &classes.curves[class as usize];
            let ends = pieces(self.cuts_of(class), curve.is_circle()).into_iter();
            joins.extend(ends.filter_map(|(e, t)| Some((sorted(e?), curve.point(t)))));
        }
        joins.sort_by_key(|j| j.0);
        let thin = |group: &[((u32, u32), Vec2)]| {
            let near = |i: usize| group[..i].iter().any(|j| tolerance.sliver(j.1, group[i].1));
            (1..group.len()).any(near).then(|| group[0].0)
        };
        joins.chunk_by(|a, b| a.0 == b.0).filter_map(thin).collect()
    }

    fn cuts_of(&self, class: u32) -> &[(f64, u32)] {
        self.cuts.get(&class).map_or(&[][..], |c| c)
    }

    /// Every sub-edge of every class on its own.
    fn each(
        &self,
        classes: &Classes,
        mut visit: impl FnMut(SubEdge, &[Along]) -> Result<(), OutlineError>,
    ) -> Result<(), OutlineError> {
        for (&class, stretches) in &self.stretches {
            let curve = &classes.curves[class as usize];
            let around: Vec<Along> = stretches.iter().map(|s| (s.face, true)).collect();
            let mut sweep = Sweep { stretches, next: 0, open: Vec::new(), faces: Vec::new() };
            for (ends, middle) in pieces(self.cuts_of(class), curve.is_circle()) {
                let along = if curve.is_circle() { &around } else { sweep.at(middle) };
                if !along.is_empty() {
                    visit(SubEdge { class, ends, middle: curve.point(middle) }, along)?;
                }
            }
        }
        Ok(())
    }
}

fn sorted([a, b]: [u32; 2]) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Takes the first of a group and all that lie on it, as one sub-edge.
fn collapse(group: &mut Vec<Held>, tolerance: &Tolerance) -> Held {
    let (first, mut along) = group.remove(0);
    group.retain(|(edge, faces)| {
        let joins = edge.class != first.class && tolerance.sliver(edge.middle, first.middle);
        if joins {
            let same_way = edge.ends == first.ends;
            along.extend(faces.iter().map(|&(face, way)| (face, way == same_way)));
        }
        !joins
    });
    (first, along)
}

/// The intervals between neighbouring cuts, with the parameter of their middle.
fn pieces(cuts: &[(f64, u32)], circle: bool) -> Vec<(Option<[u32; 2]>, f64)> {
    let mut list: Vec<_> =
        cuts.windows(2).map(|w| (Some([w[0].1, w[1].1]), 0.5 * (w[0].0 + w[1].0))).collect();
    match (circle, cuts.first(), cuts.last()) {
        (true, Some(first), Some(last)) => {
            list.push((Some([last.1, first.1]), 0.5 * (last.0 + first.0 + TAU)));
        }
        (true, ..) => list.push((None, 0.0)),
        _ => {}
    }
    list
}

/// Which stretches hold a parameter that only grows.
struct Sweep<'a> {
    stretches: &'a [Stretch],
    next: usize,
    open: Vec<Stretch>,
    faces: Vec<Along>,
}

impl Sweep<'_> {
    fn at(&mut self, t: f64) -> &[Along] {
        self.open.retain(|s| s.hi > t);
        while let Some(s) = self.stretches.get(self.next).filter(|s| s.lo < t) {
            if s.hi > t {
                self.open.push(*s);
            }
            self.next += 1;
        }
        self.faces.clear();
        self.faces.extend(self.open.iter().map(|s| (s.face, true)));
        &self.faces
    }
}

fn stretches(faces: &[Face], members: &[u32], classes: &Classes) -> BTreeMap<u32, Vec<Stretch>> {
    let mut by_class: BTreeMap<u32, Vec<Stretch>> = BTreeMap::new();
    for &face in members {
        let class = classes.of[face as usize];
        let curve = &classes.curves[class as usize];
        let (a, b) = match faces[face as usize].ends {
            Some([a, b]) => (curve.parameter(a), curve.parameter(b)),
            None => (-PI, PI),
        };
        by_class.entry(class).or_default().push(Stretch { lo: a.min(b), hi: a.max(b), face });
    }
    for list in by_class.values_mut() {
        list.sort_by(|a, b| a.lo.total_cmp(&b.lo).then(a.face.cmp(&b.face)));
    }
    by_class
}

fn runs(stretches: &BTreeMap<u32, Vec<Stretch>>, classes: &Classes) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (&class, list) in stretches {
        let circle = classes.curves[class as usize].is_circle();
        for s in list {
            match runs.last_mut() {
                Some(run) if run.class == class && s.lo <= run.hi => run.hi = run.hi.max(s.hi),
                _ => runs.push(Run { class, lo: s.lo, hi: s.hi, circle }),
            }
        }
    }
    runs
}

/// A point that two classes share.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    at: Vec2,
    classes: [u32; 2],
}

fn crossings(
    runs: &[Run],
    classes: &Classes,
    tolerance: &Tolerance,
    budget: &mut OutlineBudget,
) -> Result<Vec<Crossing>, OutlineError> {
    let boxes: Vec<_> = runs.iter().map(|r| r.bounds(classes, tolerance.length)).collect();
    let tree = RTree::bulk_load(
        (0u32..).zip(&boxes).map(|(i, b)| GeomWithData::new(Rectangle::from_aabb(*b), i)).collect(),
    );
    let mut found = Vec::new();
    let mut near = Vec::new();
    for (i, run) in (0u32..).zip(runs) {
        near.clear();
        for other in tree.locate_in_envelope_intersecting(boxes[i as usize]) {
            budget.spend_pairs(usize::from(other.data > i))?;
            near.push(other.data);
        }
        near.retain(|&j| j > i && runs[j as usize].class != run.class);
        near.sort_unstable();
        let before = found.len();
        near.iter().for_each(|&j| run.cross(&runs[j as usize], classes, tolerance, &mut found));
        budget.spend_points(found.len() - before)?;
    }
    Ok(found)
}

impl Run {
    fn bounds(&self, classes: &Classes, margin: f64) -> AABB<[f64; 2]> {
        let curve = &classes.curves[self.class as usize];
        let (a, b) = match *curve {
            crate::Curve::Circle { center, radius } => {
                let half = Vec2::new(radius, radius);
                (center - half, center + half)
            }
            crate::Curve::Line { .. } => (curve.point(self.lo), curve.point(self.hi)),
        };
        let (min, max) = ([a.x.min(b.x), a.y.min(b.y)], [a.x.max(b.x), a.y.max(b.y)]);
        AABB::from_corners(min.map(|k| k - margin), max.map(|k| k + margin))
    }

    fn reaches(&self, p: Vec2, classes: &Classes, margin: f64) -> bool {
        let t = classes.curves[self.class as usize].parameter(p);
        self.circle || (t >= self.lo - margin && t <= self.hi + margin)
    }

    /// Adds the points common to both runs, and ends of one that lie on the other where no such point is.
    fn cross(&self, other: &Run, classes: &Classes, tolerance: &Tolerance, found: &mut Vec<Crossing>) {
        let margin = tolerance.length;
        let both = [self.class, other.class];
        let [a, b] = both.map(|c| &classes.curves[c as usize]);
        let first = found.len();
        let points = a.common_points(b, margin, tolerance.angle).into_iter().flatten();
        let common =
            points.filter(|&p| self.reaches(p, classes, margin) && other.reaches(p, classes, margin));
        found.extend(common.map(|at| Crossing { at, classes: both }));
        for (run, curve, opposite, on) in [(self, a, other, b), (other, b, self, a)] {
            for end in if run.circle { [None; 2] } else { [Some(run.lo), Some(run.hi)] }.into_iter().flatten()
            {
                let at = curve.point(end);
                let known = found[first..].iter().any(|c| (c.at - at).norm() <= 4.0 * margin);
                if !known && on.distance(at) <= margin && opposite.reaches(at, classes, margin) {
                    found.push(Crossing { at, classes: both });
                }
            }
        }
    }
}

/// Vertices, and the vertex of every point: the first one within the tolerance.
fn merge_points(points: &[Crossing], tolerance: f64) -> (Vec<Vec2>, Vec<u32>) {
    let cell = 1024.0 * tolerance;
    let index = |v: f64| (v / cell).floor() as i64;
    let mut grid: HashMap<(i64, i64), Vec<u32>> = HashMap::new();
    let mut vertices: Vec<Vec2> = Vec::new();
    let mut of = Vec::with_capacity(points.len());
    for Crossing { at: p, .. } in points {
        let columns = index(p.x - tolerance)..=index(p.x + tolerance);
        let cells =
            columns.flat_map(|i| (index(p.y - tolerance)..=index(p.y + tolerance)).map(move |j| (i, j)));
        let near = cells.filter_map(|c| grid.get(&c)).flatten();
        let known = near.filter(|&&v| (vertices[v as usize] - *p).norm() <= tolerance).min().copied();
        of.push(known.unwrap_or_else(|| {
            let new = vertices.len() as u32;
            grid.entry((index(p.x), index(p.y))).or_default().push(new);
            vertices.push(*p);
            new
        }));
    }
    (vertices, of)
}
