//! Contacts at a configuration: evaluated, counted, and listed where they are near enough to matter.

use crate::inertia::Freedom;
use crate::linear::Small;
use crate::lists::Lists;
use crate::path::DrivenPath;
use crate::sweep::Places;
use mainspring_mechanism::{
    Approach, Candidate, ContactId, ContactSource, Drive, Feature, GapKind, GapState, MAX_CHAIN, Motion,
    Placed, Relative, Row, System, approach, gap_state,
};
use std::sync::Arc;

/// A coordinate that moves one side of an interaction.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    pub coordinate: usize,
    /// Greatest distance moved per unit of the coordinate (length per radian, or 1), with the slides after it where
    /// they are as modelled.
    pub length: f64,
    /// Slides later in the chain, which lengthen the arm of a turn: places in the list of arms, and lengths per unit of theirs.
    slides: [(u8, f64); MAX_CHAIN - 1],
    slide_count: u8,
    /// Turning per unit of the coordinate (|ratio| or 0).
    pub turn: f64,
    /// On the second body?
    pub second: bool,
}

impl Arm {
    /// The arm's length where slides later in the chain have moved; `moved` tells how far the coordinate of an arm
    /// (its place in the list) is from zero at most.
    #[inline]
    pub fn reach(&self, moved: impl Fn(usize) -> f64) -> f64 {
        let slides = self.slides[..usize::from(self.slide_count)].iter();
        self.length + slides.map(|&(k, factor)| factor * moved(usize::from(k))).sum::<f64>()
    }
}

/// The moment after a start from rest at which a drive shows where it goes, relative to the length of its piece.
const ONSET: f64 = 1e-6;

/// The system with its source of candidates and the work done.
pub struct World<'a> {
    pub system: &'a System,
    pub lists: Lists<'a>,
    pub arms: Vec<Vec<Arm>>,
    /// For each interaction where contacts lie along the motion of one coordinate.
    pub places: Vec<Places>,
    /// Coordinates of prescribed motion.
    pub drives: Vec<(usize, &'a Drive)>,
    /// Their present pieces, which equations follow up to the very end of a piece: accelerations jump there.
    pub driven: Vec<DrivenPath>,
    /// All coordinates move freely but those driven.
    pub moved: Arc<Freedom>,
    /// At present: those stuck by dry friction are held as well.
    pub free: Arc<Freedom>,
    /// Which coordinates dry friction holds, and against what motion (+1, −1, or 0 for none) it acts on others.
    pub stuck: Vec<bool>,
    pub sliding: Vec<f64>,
    /// Gap evaluations so far.
    pub evaluations: u64,
}

/// Two bodies of an interaction, placed.
pub type Pair<'a> = (Placed<'a>, Placed<'a>);

/// A contact evaluated between placed bodies.
#[derive(Clone, Copy, Debug)]
pub struct Touch<'p> {
    pub candidate: Candidate,
    pub state: GapState,
    pub placed: (&'p Placed<'p>, &'p Placed<'p>),
    /// For a stop its coordinate and ∂g/∂q.
    stop: Option<(usize, f64)>,
}

impl Touch<'_> {
    /// ∂g/∂q.
    #[inline]
    pub fn row(&self) -> Row {
        if let Some((i, slope)) = self.stop {
            return Row::single(i, slope);
        }
        self.state.row(self.placed.0, self.placed.1)
    }

    /// ġ at velocities `v`.
    #[inline]
    pub fn rate(&self, v: &[f64]) -> f64 {
        match self.stop {
            Some((i, slope)) => slope * v[i],
            None => self.state.rate(self.placed.0, self.placed.1, v),
        }
    }

    /// The part of g̈ that accelerations do not cause.
    #[inline]
    pub fn bias(&self, v: &[f64]) -> f64 {
        match self.stop {
            Some(_) => 0.0,
            None => self.state.bias(self.placed.0, self.placed.1, v),
        }
    }

    /// The nearer of the margins to the ends of the features: length along edges, `size`·radians across cones.
    pub fn margin(&self, size: f64) -> f64 {
        self.state.edge_margin.min(self.state.cone_margin * size)
    }
}

impl<'a> World<'a> {
    pub fn new(system: &'a System, source: &'a dyn ContactSource) -> Self {
        let arms: Vec<Vec<Arm>> = (0..system.interactions.len()).map(|i| arms(system, i)).collect();
        let places = vec![Places::default(); arms.len()];
        let drives: Vec<(usize, &Drive)> =
            system.forces.drives.iter().enumerate().filter_map(|(i, d)| Some((i, d.as_ref()?))).collect();
        let n = system.coordinates.len();
        let pieces = drives.iter().map(|(_, drive)| DrivenPath::new(drive, 0.0).0).collect();
        let driven = (0..n).map(|i| drives.iter().any(|d| d.0 == i)).collect();
        let moved = Arc::new(Freedom::new(system, driven));
        let free = moved.clone();
        let (stuck, sliding) = (vec![false; n], vec![0.0; n]);
        Self {
            system,
            lists: Lists::new(system, source),
            arms,
            places,
            drives,
            driven: pieces,
            moved,
            free,
            stuck,
            sliding,
            evaluations: 0,
        }
    }

    /// Takes over what dry friction does from now on.
    pub fn set_dry(&mut self, stuck: &[bool], sliding: &[f64]) {
        self.sliding.copy_from_slice(sliding);
        if self.stuck == stuck {
            return;
        }
        self.stuck.copy_from_slice(stuck);
        let held = |i: usize| stuck[i] || self.moved.is_held(i);
        self.free = Arc::new(Freedom::new(self.system, (0..stuck.len()).map(held).collect()));
    }

    /// Force of dry friction on a sliding coordinate.
    #[inline]
    pub fn dry_force(&self, i: usize) -> f64 {
        -self.sliding[i] * self.system.forces.coulomb[i]
    }

    /// Acceleration of a free coordinate that is tied to no other, without contacts.
    #[inline]
    pub fn acceleration_alone(&self, i: usize, q: f64, v: f64) -> f64 {
        let c = &self.system.coordinates[i];
        let linear = c.free_acceleration(q, v);
        if self.sliding[i] == 0.0 { linear } else { linear + self.dry_force(i) / c.inertia }
    }

    /// Writes the accelerations that drives begin to have at time `t`: one that starts from rest without acceleration,
    /// but with a jerk, has that of a moment later, which tells where it goes.
    pub fn prescribe_onset(&self, t: f64, acceleration: &mut [f64]) {
        for (i, drive) in &self.drives {
            let (now, piece) = (drive.at(t), drive.piece(t));
            let rests = now.v == 0.0 && now.a.abs() <= 1e-9 * drive.bounds(t, piece.until).1;
            let moment = if rests && piece.until.is_finite() { ONSET * (piece.until - t) } else { 0.0 };
            acceleration[*i] = drive.at(t + moment).a;
        }
    }

    /// Writes the accelerations of driven coordinates at time `t` within the present pieces.
    pub fn prescribe(&self, t: f64, acceleration: &mut [f64]) {
        for ((i, _), piece) in self.drives.iter().zip(&self.driven) {
            acceleration[*i] = piece.state(t).1;
        }
    }

    /// The relative tolerance of steps: `share` of `rtol` where drives act, but no less than rounding allows.
    pub fn tolerance(&self, rtol: f64, share: f64) -> f64 {
        if self.drives.is_empty() { rtol } else { rtol.min((share * rtol).max(1e-13)) }
    }

    /// Goes on to the pieces that hold at time `t` and just after; returns when the first of them ends.
    pub fn follow_drives(&mut self, t: f64) -> f64 {
        let mut end = f64::INFINITY;
        for ((_, drive), piece) in self.drives.iter().zip(&mut self.driven) {
            let until;
            (*piece, until) = DrivenPath::new(drive, t);
            end = end.min(until);
        }
        end
    }

    /// The features of a contact.
    pub fn features(&self, c: &Candidate) -> (&'a Feature, &'a Feature) {
        let bodies = self.bodies(c);
        let lists = (&self.system.features[bodies.0], &self.system.features[bodies.1]);
        (&lists.0[c.id.first as usize], &lists.1[c.id.second as usize])
    }

    /// The bodies of a contact.
    pub fn bodies(&self, c: &Candidate) -> (usize, usize) {
        if let Some(stop) = c.id.stop() {
            return self.system.forces.stops[stop].bodies;
        }
        self.system.interactions[c.id.interaction as usize].bodies
    }

    /// The bodies of a contact at positions `q`.
    pub fn place(&self, c: &Candidate, q: &[f64]) -> Pair<'a> {
        let (a, b) = self.bodies(c);
        let bodies = &self.system.bodies;
        (Placed::new(&bodies[a], q), Placed::new(&bodies[b], q))
    }

    /// Every body at positions `q`.
    pub fn place_all(&self, q: &[f64]) -> Small<Placed<'a>> {
        self.system.bodies.iter().map(|body| Placed::new(body, q)).collect()
    }

    /// Evaluates a contact between its bodies.
    pub fn touch<'p>(&mut self, c: &Candidate, placed: (&'p Placed<'p>, &'p Placed<'p>)) -> Touch<'p> {
        self.evaluations += 1;
        let (fa, fb) = self.features(c);
        let state = gap_state(c.kind, fa, fb, &placed.0.pose, &placed.1.pose);
        Touch { candidate: *c, state, placed, stop: None }
    }

    /// Evaluates a contact or a stop between its bodies at positions `q`.
    #[inline]
    pub fn touch_at<'p>(
        &mut self,
        c: &Candidate,
        q: &[f64],
        placed: (&'p Placed<'p>, &'p Placed<'p>),
    ) -> Touch<'p> {
        let Some(k) = c.id.stop() else { return self.touch(c, placed) };
        let stop = &self.system.forces.stops[k];
        let state = GapState::of_stop(stop.gap(q[stop.coordinate]));
        Touch { candidate: *c, state, placed, stop: Some((stop.coordinate, stop.slope())) }
    }

    /// Evaluates a contact or a stop among all bodies placed at `q`.
    pub fn touch_among<'p>(&mut self, c: &Candidate, q: &[f64], placed: &'p [Placed<'p>]) -> Touch<'p> {
        let (a, b) = self.bodies(c);
        self.touch_at(c, q, (&placed[a], &placed[b]))
    }

    /// Stops of coordinates that are not driven (drives are known to stay within theirs).
    pub fn stops(&self) -> impl Iterator<Item = usize> + use<'a> {
        let forces = &self.system.forces;
        let free = |k: &usize| forces.drives[forces.stops[*k].coordinate].is_none();
        (0..forces.stops.len()).filter(free)
    }

    /// A known contact or stop by its identity.
    pub fn find(&self, id: ContactId) -> Option<Candidate> {
        match id.stop() {
            Some(k) => Some(stop_candidate(k)),
            None => self.listed(id.interaction as usize).iter().copied().find(|c| c.id == id),
        }
    }

    /// The coordinates that move a contact.
    pub fn coordinates_of(&self, id: ContactId) -> impl Iterator<Item = usize> + '_ {
        let stop = id.stop().map(|k| self.system.forces.stops[k].coordinate);
        let arms: &[Arm] = if stop.is_some() { &[] } else { &self.arms[id.interaction as usize] };
        stop.into_iter().chain(arms.iter().map(|arm| arm.coordinate))
    }

    /// Gap and rate of a contact in the relative motion of its bodies.
    pub fn approach(&mut self, c: &Candidate, relative: &Relative) -> Approach {
        self.evaluations += 1;
        let (fa, fb) = self.features(c);
        approach(c.kind, fa, fb, relative)
    }

    /// How far the arms of either side of an interaction have moved since its list was made.
    pub fn travelled(&self, interaction: usize, q: &[f64]) -> [f64; 2] {
        self.lists.travelled(interaction, &self.arms[interaction], q)
    }

    /// Lever arms of a contact's features as shares of the greatest.
    pub fn shares(&self, c: &Candidate) -> [f64; 2] {
        let shares = &self.system.interactions[c.id.interaction as usize].shares;
        [shares.0[c.id.first as usize], shares.1[c.id.second as usize]]
    }

    /// Makes sure that the list of an interaction names every contact nearer than `within` at `q`; see `Lists`.
    pub fn refresh(&mut self, interaction: usize, q: &[f64], within: f64) -> (f64, f64) {
        self.lists.refresh(interaction, &self.arms[interaction], q, within)
    }

    /// The contacts listed for an interaction, with a lower bound of the distance of their features when listed.
    pub fn listed(&self, interaction: usize) -> &[Candidate] {
        self.lists.of(interaction)
    }
}

/// A stop as a contact.
pub fn stop_candidate(k: usize) -> Candidate {
    Candidate { id: ContactId::of_stop(k), kind: GapKind::RoundRound, distance: 0.0 }
}

fn arms(system: &System, interaction: usize) -> Vec<Arm> {
    let it = &system.interactions[interaction];
    let chains = (&system.bodies[it.bodies.0].chain, &system.bodies[it.bodies.1].chain);
    let shared = chains.0.iter().zip(chains.1).take_while(|(j, k)| j == k).count();
    let mut arms: Vec<Arm> = Vec::new();
    for (chain, levers, second) in [(chains.0, &it.levers.0, false), (chains.1, &it.levers.1, true)] {
        let first = arms.len();
        for (k, (joint, lever)) in chain.iter().zip(levers).enumerate() {
            let (ratio, turns) = (joint.ratio.abs(), matches!(joint.motion, Motion::Turn { .. }));
            // What carries both bodies turns nothing between them.
            let turn = if turns && k >= shared { ratio } else { 0.0 };
            let (mut slides, mut slide_count) = ([(0, 0.0); MAX_CHAIN - 1], 0);
            let later = chain.iter().enumerate().take(MAX_CHAIN).skip(k + 1);
            let later = later.filter(|(_, j)| turn > 0.0 && matches!(j.motion, Motion::Slide { .. }));
            for (n, slide) in later {
                slides[usize::from(slide_count)] = ((first + n) as u8, ratio * slide.ratio.abs());
                slide_count += 1;
            }
            let (coordinate, length) = (joint.coordinate, lever * ratio);
            arms.push(Arm { coordinate, length, slides, slide_count, turn, second });
        }
    }
    arms
}
