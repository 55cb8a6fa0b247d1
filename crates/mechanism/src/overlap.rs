//! Which pair of features gives the depth of an overlap, and which takes over as the parts move.
//!
//! Two outlines overlap in pieces; a shallow piece has tips: corners or arcs of one part inside the other. The depth
//! at a tip is the least overlap `o = −g` over the pairs of features around it whose normals oppose:
//! ```text
//! corner P against edge b          b's normal turned round lies in P's cone
//! corner P near a corner Q         the least of (P, b), (P, b'), (a, Q), (a', Q), a and b being the edges at P and Q
//! rounds, hollows                  the line of centres lies in both cones
//! ```
//! For convex parts that is the shortest way out (the distance of the origin from the boundary of the Minkowski
//! difference), so it is continuous as a corner passes a corner: where pairs take over from each other their
//! overlaps are equal. At a smooth joint of the boundary they are equal together with their normals.
//!
//! Along one face several tips act side by side, each with its own depth: of faces that lie flush both ends count.
//! With only the deepest of them the force would jump from end to end as the faces rock, and rocking would never
//! end. At a concave corner both faces count, as in rigid contact. Beyond its features a pair's overlap goes on
//! smoothly (lines and circles are carried on), which is what a solver's trial states see.

use crate::boundary::Boundary;
use crate::feature::{Feature, FeatureShape};
use crate::gap::{GapKind, GapState, gap_state};
use crate::interaction::{Interaction, System};
use crate::source::{Candidate, ContactId};
use crate::system::Pose;

/// How far from a corner, in depths, the pairs around it are looked at. Between edges that meet at an angle α a
/// corner may be nearest to both as far as depth/tan(α/2) away: enough for α down to 15°.
const REACH: f64 = 8.0;
/// Overlaps that a smooth joint hands on agree to this fraction.
const EQUAL: f64 = 1e-6;

/// Where one feature ends and the next begins both may be missed by rounding: by so much of the size, or radians.
const ROUNDING: f64 = 1e-9;

/// What is needed to follow overlaps: the boundaries of all bodies.
#[derive(Clone, Debug)]
pub struct Overlaps<'a> {
    system: &'a System,
    boundaries: Vec<Boundary>,
}

/// The pair that takes over at a tip.
#[derive(Clone, Copy, Debug)]
pub struct Successor {
    pub candidate: Candidate,
    pub state: GapState,
    /// Whether it takes over because its overlap is less; otherwise because the contact point leaves a feature.
    pub less: bool,
}

/// The features of one interaction at given poses.
#[derive(Clone, Copy)]
struct Pair<'a> {
    index: u32,
    interaction: &'a Interaction,
    features: (&'a [Feature], &'a [Feature]),
    boundaries: (&'a Boundary, &'a Boundary),
    poses: (&'a Pose, &'a Pose),
}

impl<'a> Overlaps<'a> {
    pub fn new(system: &'a System) -> Self {
        let boundary = |(body, features): (&crate::system::Body, &Vec<Feature>)| {
            Boundary::new(&body.outline, features, system.size)
        };
        let boundaries = system.bodies.iter().zip(&system.features).map(boundary).collect();
        Self { system, boundaries }
    }

    fn pair<'s>(&'s self, index: u32, poses: (&'s Pose, &'s Pose)) -> Pair<'s> {
        let interaction = &self.system.interactions[index as usize];
        let (a, b) = interaction.bodies;
        Pair {
            index,
            interaction,
            features: (&self.system.features[a], &self.system.features[b]),
            boundaries: (&self.boundaries[a], &self.boundaries[b]),
            poses,
        }
    }

    /// The pair that gives the depth instead of `c`, whose state is `state`, with the bodies at `poses`; None while
    /// `c` does.
    pub fn successor(
        &self,
        c: &Candidate,
        state: &GapState,
        poses: (&Pose, &Pose),
        pairs: &mut Vec<(u32, u32)>,
    ) -> Option<Successor> {
        let on = is_on(state);
        let reach = REACH * -state.gap;
        // In the middle of an edge nothing else is near.
        if on && state.edge_margin > reach && state.edge_margin.is_finite() {
            return None;
        }
        let pair = self.pair(c.id.interaction, poses);
        let ids = (c.id.first, c.id.second);
        pairs.clear();
        pair.around_corners(ids, state, reach, pairs);
        let less = pair.best(ids, pairs, |s| if s.gap > state.gap { Some(-s.gap) } else { None });
        if on || less.is_some() {
            return less.map(|(candidate, state)| Successor { candidate, state, less: true });
        }
        pairs.clear();
        pair.next_along(ids, pairs);
        let difference = |s: &GapState| (s.gap - state.gap).abs();
        let close = EQUAL * -state.gap + 1e-12 * self.system.size;
        let next = pair.best(ids, pairs, |s| Some(difference(s)).filter(|d| *d <= close));
        next.map(|(candidate, state)| Successor { candidate, state, less: false })
    }

    /// The pair that follows along the boundary where the contact point has already left the features of `c`, whatever
    /// its gap: the one whose gap is nearest.
    pub fn follower(
        &self,
        c: &Candidate,
        state: &GapState,
        poses: (&Pose, &Pose),
        pairs: &mut Vec<(u32, u32)>,
    ) -> Option<(Candidate, GapState)> {
        let pair = self.pair(c.id.interaction, poses);
        let ids = (c.id.first, c.id.second);
        pairs.clear();
        pair.next_along(ids, pairs);
        let on = |s: &GapState| s.edge_margin >= -ROUNDING * self.system.size && s.cone_margin >= -ROUNDING;
        let evaluated = pairs.iter().filter_map(|&ids| pair.evaluate(ids)).filter(|(_, s)| on(s));
        let apart = |s: &GapState| (s.gap - state.gap).abs();
        evaluated.min_by(|a, b| apart(&a.1).total_cmp(&apart(&b.1)))
    }

    /// Are two contacts one place on neighbouring features: the same feature on one side, features that follow each
    /// other on the other? Such hand over to each other and never count both.
    pub fn follow(&self, a: &ContactId, b: &ContactId) -> bool {
        if a.interaction != b.interaction {
            return false;
        }
        let bodies = self.system.interactions[a.interaction as usize].bodies;
        let next = |body: usize, i: u32, j: u32| self.boundaries[body].neighbours(i).contains(&j);
        (a.first == b.first && next(bodies.1, a.second, b.second))
            || (a.second == b.second && next(bodies.0, a.first, b.first))
    }

    /// Whether the end of the edge that the contact point is nearer to is a convex corner, where the edge's plane
    /// bounds the part no further.
    pub fn ends_sharply(&self, c: &Candidate, state: &GapState) -> bool {
        let bodies = self.system.interactions[c.id.interaction as usize].bodies;
        let (body, edge) = match c.kind {
            GapKind::RoundEdge { swapped: false } => (bodies.1, c.id.second),
            GapKind::RoundEdge { swapped: true } => (bodies.0, c.id.first),
            _ => return false,
        };
        let features = &self.system.features[body];
        let FeatureShape::Edge { from, to, .. } = features[edge as usize].shape else { return false };
        let (end, other) = if state.near_end { (to, from) } else { (from, to) };
        let near = |k: &&u32| {
            let f = &features[**k as usize];
            f.is_corner() && (f.center - end).norm() < (f.center - other).norm()
        };
        self.boundaries[body].neighbours(edge).iter().any(|k| near(&k))
    }

    /// Do two contacts of one interaction belong to one piece of overlap: the same or adjoining features on both
    /// sides?
    pub fn adjoin(&self, a: &ContactId, b: &ContactId) -> bool {
        if a.interaction != b.interaction {
            return false;
        }
        let bodies = self.system.interactions[a.interaction as usize].bodies;
        let near = |body: usize, i: u32, j: u32| {
            let boundary = &self.boundaries[body];
            let own = boundary.neighbours(i);
            i == j || own.contains(&j) || own.iter().any(|&k| boundary.neighbours(k).contains(&j))
        };
        near(bodies.0, a.first, b.first) && near(bodies.1, a.second, b.second)
    }
}

/// Is the contact point on both features, with opposing normals?
pub fn is_on(state: &GapState) -> bool {
    state.edge_margin >= 0.0 && state.cone_margin >= 0.0
}

impl Pair<'_> {
    /// The sharp corner at which features `i` of a side may hand a contact on: `i` itself, or its end near `point`
    /// (in the machine).
    fn corner(&self, second: bool, i: u32, state: &GapState, reach: f64) -> Option<u32> {
        let (features, boundary, pose) = self.side(second);
        let feature = &features[i as usize];
        if feature.is_corner() {
            return Some(i);
        }
        let away = |&k: &u32| (pose.apply(features[k as usize].center) - state.point).norm();
        let corners = boundary.neighbours(i).iter().copied().filter(|&k| features[k as usize].is_corner());
        let nearest = corners.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        (away(&nearest) <= 2.0 * reach).then_some(nearest)
    }

    fn side(&self, second: bool) -> (&[Feature], &Boundary, &Pose) {
        if second {
            (self.features.1, self.boundaries.1, self.poses.1)
        } else {
            (self.features.0, self.boundaries.0, self.poses.0)
        }
    }

    /// Pairs around a corner P near a corner Q: P against Q's sides, P's sides against Q. Against a round feature a
    /// corner has no alternatives but the smooth ones.
    fn around_corners(&self, ids: (u32, u32), state: &GapState, reach: f64, pairs: &mut Vec<(u32, u32)>) {
        let Some(p) = self.corner(false, ids.0, state, reach) else { return };
        let Some(q) = self.corner(true, ids.1, state, reach) else { return };
        pairs.extend(self.boundaries.1.neighbours(q).iter().map(|&b| (p, b)));
        pairs.extend(self.boundaries.0.neighbours(p).iter().map(|&a| (a, q)));
    }

    /// Pairs reached by going on to the next feature on either side or on both.
    fn next_along(&self, ids: (u32, u32), pairs: &mut Vec<(u32, u32)>) {
        let (next_a, next_b) = (self.boundaries.0.neighbours(ids.0), self.boundaries.1.neighbours(ids.1));
        pairs.extend(next_a.iter().map(|&a| (a, ids.1)));
        pairs.extend(next_b.iter().map(|&b| (ids.0, b)));
        pairs.extend(next_a.iter().flat_map(|&a| next_b.iter().map(move |&b| (a, b))));
    }

    /// Of the overlapping pairs whose contact point is on their features the one of least measure; the present pair
    /// and those without measure are left out.
    fn best(
        &self,
        present: (u32, u32),
        pairs: &[(u32, u32)],
        measure: impl Fn(&GapState) -> Option<f64>,
    ) -> Option<(Candidate, GapState)> {
        let mut best: Option<(f64, Candidate, GapState)> = None;
        for &ids in pairs.iter().filter(|&&ids| ids != present) {
            let Some((candidate, state)) = self.evaluate(ids) else { continue };
            if !is_on(&state) || state.gap >= 0.0 {
                continue;
            }
            if let Some(m) = measure(&state)
                && best.as_ref().is_none_or(|b| m < b.0)
            {
                best = Some((m, candidate, state));
            }
        }
        best.map(|(_, candidate, state)| (candidate, state))
    }

    fn evaluate(&self, ids: (u32, u32)) -> Option<(Candidate, GapState)> {
        let (a, b) = (&self.features.0[ids.0 as usize], &self.features.1[ids.1 as usize]);
        let kind = self.interaction.kind((ids.0 as usize, ids.1 as usize), (a, b))?;
        let id = ContactId { interaction: self.index, first: ids.0, second: ids.1 };
        let state = gap_state(kind, a, b, self.poses.0, self.poses.1);
        Some((Candidate { id, kind, distance: 0.0 }, state))
    }
}
