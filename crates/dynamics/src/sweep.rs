//! The first contact of two bodies between which one joint moves and all else rests.
//!
//! Contacts then lie at positions of that joint known beforehand: a slice of the configuration space. The joint is followed
//! from one to the next by bounds of its own motion, and only near such a place the contact is marched along.

use crate::clearance::Gap;
use crate::linear::Small;
use crate::march::{March, Real};
use crate::opposed::are_opposed;
use crate::pace::{GapPace, Pace};
use crate::search::{Closing, Found, MOST_STEPS, Stretch, Watch};
use crate::sight::Sight;
use crate::world::World;
use mainspring_mechanism::{Candidate, ContactId, Sway, places};

/// A contact is marched along where the joint is this near to its place: the way of the longest lever arm relative to
/// the machine's size. Steps of the integrator leave less.
const NEAR: f64 = 1e-6;
/// Places this far past the end of a feature (relative to the size, radians) are still looked at.
const SLACK: f64 = 1e-4;

/// Where along the motion of one coordinate contacts lie, as long as everything else stays.
#[derive(Clone, Debug, Default)]
pub struct Places {
    coordinate: usize,
    /// Positions of the arms' coordinates for which they were found, that of the moving one aside; empty before the first.
    others: Small<f64>,
    list: Vec<Landing>,
    /// After this way the same places come again; infinite for a slide.
    period: f64,
}

/// One place.
#[derive(Clone, Copy, Debug)]
struct Landing {
    candidate: Candidate,
    /// Position of the coordinate within its period.
    q: f64,
    /// The direction of its motion in which the gap falls, 0 for both.
    closes: i8,
}

/// The only coordinate that moves the bodies of an interaction against each other; None if there are several, or if the
/// interaction has too many contacts to list.
pub fn only_mover(world: &World, interaction: usize, stretch: &Stretch) -> Option<usize> {
    let mut moving = world.arms[interaction].iter().filter(|a| !stretch.paths[a.coordinate].is_rest());
    let arm = moving.next()?;
    let lone = moving.next().is_none() && arm.length > 0.0;
    let all_listed = !world.system.interactions[interaction].pairs.is_empty();
    (lone && all_listed).then_some(arm.coordinate)
}

/// Looks along an interaction that only `coordinate` moves.
pub fn sweep_along(
    world: &mut World,
    (interaction, coordinate): (usize, usize),
    stretch: &Stretch,
    watched: &[(ContactId, Watch)],
    real: Real,
    found: &mut Found,
) {
    let mut sight = Sight::new(world, interaction, stretch, stretch.from);
    let places = find_places(world, (interaction, coordinate), &sight);
    let arm =
        world.arms[interaction].iter().find(|arm| arm.coordinate == coordinate).map_or(1.0, |arm| arm.length);
    let mut sweep = Sweep::new(world, &places, watched, arm);
    let mut t = stretch.from;
    for _ in 0..MOST_STEPS {
        if t >= found.clear_until {
            world.places[interaction] = places;
            return;
        }
        let due = sweep.step(world, &mut sight, t, found.clear_until);
        sweep.look(world, &mut sight, t, real, found);
        t = sweep.marches.iter().map(|m| m.clear).fold(due, f64::min);
    }
    // The bound on work was met: what lies beyond is for the next search.
    *found = Found { closing: None, clear_until: t };
    world.places[interaction] = places;
}

/// Where contacts of an interaction lie along the motion of a coordinate; kept from before if nothing else moved.
fn find_places(world: &mut World, (interaction, coordinate): (usize, usize), sight: &Sight) -> Places {
    let arms = &world.arms[interaction];
    let others = arms.iter().filter(|arm| arm.coordinate != coordinate).map(|arm| sight.q[arm.coordinate]);
    let mut kept = std::mem::take(&mut world.places[interaction]);
    let same = kept.coordinate == coordinate && kept.period > 0.0;
    if same && kept.others.iter().copied().eq(others.clone()) {
        return kept;
    }
    kept.others = others.collect();
    kept.coordinate = coordinate;
    kept.list.clear();
    let second = arms.iter().any(|arm| arm.coordinate == coordinate && arm.second);
    let (a, b) = &sight.placed;
    let moving = if second { b } else { a };
    let Some((sway, ratio)) = moving.sway(coordinate) else { return kept };
    kept.period = match sway {
        Sway::Turn { .. } => std::f64::consts::TAU / ratio.abs(),
        Sway::Slide { .. } => f64::INFINITY,
    };
    let direction = if second { -ratio } else { ratio };
    let system = world.system;
    let pair = &system.interactions[interaction];
    let features = (&system.features[pair.bodies.0], &system.features[pair.bodies.1]);
    let slack = SLACK * system.size;
    for &(first, second, kind) in &pair.pairs {
        let (fa, fb) = (&features.0[first as usize], &features.1[second as usize]);
        for place in places(kind, (fa, fb), (&a.pose, &b.pose), &sway).into_iter().flatten() {
            if place.edge_margin > -slack && place.cone_margin > -SLACK - sight.stretch.outside {
                let id = ContactId { interaction: interaction as u32, first, second };
                let closes = f64::from(place.closes) * direction.signum();
                let q = kept.within_period(sight.q[coordinate] + place.offset / direction);
                let candidate = Candidate { id, kind, distance: 0.0 };
                kept.list.push(Landing { candidate, q, closes: closes as i8 });
            }
        }
    }
    kept
}

/// The sweep from place to place.
struct Sweep<'s, 'a> {
    places: &'s Places,
    /// How near counts as near, by the coordinate.
    near: f64,
    /// Contacts not to look for: closed ones, and those opposed to them.
    left_out: Small<ContactId>,
    watched: &'s [(ContactId, Watch)],
    marches: Small<March<'a>, 4>,
}

impl<'s, 'a> Sweep<'s, 'a> {
    fn new(world: &World<'a>, places: &'s Places, watched: &'s [(ContactId, Watch)], arm: f64) -> Self {
        let closed = watched.iter().filter(|w| w.1 == Watch::Closed).map(|w| w.0);
        let near = NEAR * world.system.size / arm;
        Self { places, near, left_out: closed.collect(), watched, marches: Small::new() }
    }

    /// Begins and ends marches where the joint is at time `t`, and tells until when it comes near no other place.
    fn step(&mut self, world: &World<'a>, sight: &mut Sight<'_, '_, 'a>, t: f64, end: f64) -> f64 {
        let path = &sight.stretch.paths[self.places.coordinate];
        let (state, acceleration) = path.with_acceleration(t);
        let bounds = path.bounds(state, end - t);
        let pace =
            GapPace { speed: bounds.speed, acceleration: bounds.acceleration, jerk: path.jerk(bounds) };
        let mut ways = [f64::INFINITY; 2];
        let mut kept: Small<ContactId> = Small::new();
        let places = self.places;
        let here = places.within_period(state.q);
        for landing in &places.list {
            let id = landing.candidate.id;
            if self.left_out.contains(&id) {
                continue;
            }
            let [up, down] = places.ways(landing.q - here);
            let marching = self.marches.iter().any(|m| m.candidate.id == id);
            let nearest = up.min(down);
            if nearest <= if marching { 2.0 * self.near } else { self.near } {
                kept.push(id);
                if !marching {
                    self.begin(world, sight, &landing.candidate, (t, end));
                }
            } else if landing.closes == 0 {
                ways = [ways[0].min(up), ways[1].min(down)];
            } else {
                let (side, way) = if landing.closes > 0 { (0, up) } else { (1, down) };
                ways[side] = ways[side].min(way);
            }
        }
        self.marches.retain(|m| kept.contains(&m.candidate.id));
        let clear = |way: f64, side: f64| {
            if way == f64::INFINITY {
                return end - t;
            }
            let gap = way - 0.5 * self.near;
            Gap { gap, rate: -side * state.v, acceleration: -side * acceleration }.clearance(&pace, end - t)
        };
        t + clear(ways[0], 1.0).min(clear(ways[1], -1.0)).max(2.0 * f64::EPSILON * t.abs())
    }

    /// Begins to march along a contact, unless it is opposed to a closed one, which keeps it as far open as it is.
    fn begin(
        &mut self,
        world: &World<'a>,
        sight: &mut Sight<'_, '_, 'a>,
        candidate: &Candidate,
        (t, end): (f64, f64),
    ) {
        let mut closed = sight.stretch.components.iter().flat_map(|c| &c.0.contacts);
        if closed.any(|c| are_opposed(world, c, candidate)) {
            self.left_out.push(candidate.id);
            return;
        }
        sight.move_to(world, t);
        let interaction = candidate.id.interaction as usize;
        let state = (sight.q.as_slice(), sight.v.as_slice());
        let pace = Pace::new(&world.arms[interaction], sight.stretch.paths, state, end - t);
        let floor = self.watched.iter().find(|w| w.0 == candidate.id).and_then(|w| w.1.floor());
        let pace = pace.shared(world.shares(candidate));
        self.marches.push(March::new(world.features(candidate), candidate, pace, floor, t));
    }

    /// Looks at the contacts that are due at time `t`.
    fn look(
        &mut self,
        world: &mut World<'a>,
        sight: &mut Sight<'_, '_, 'a>,
        t: f64,
        real: Real,
        found: &mut Found,
    ) {
        if self.marches.iter().all(|m| m.clear > t) {
            return;
        }
        sight.move_to(world, t);
        let relative = sight.relative();
        for march in self.marches.iter_mut().filter(|m| m.clear <= t) {
            if let Some(at) = march.look(world, sight, &relative, found.clear_until, real)
                && at < found.clear_until
            {
                let closing = Some(Closing { t: at, candidate: march.candidate });
                *found = Found { closing, clear_until: at };
            }
        }
    }
}

impl Places {
    /// A position, less whole periods.
    fn within_period(&self, q: f64) -> f64 {
        if self.period < f64::INFINITY { q.rem_euclid(self.period) } else { q }
    }

    /// How far on, and how far back, a place is that lies `way` further on within the period.
    fn ways(&self, way: f64) -> [f64; 2] {
        if self.period < f64::INFINITY {
            let up = if way < 0.0 { way + self.period } else { way };
            return [up, self.period - up];
        }
        if way >= 0.0 { [way, f64::INFINITY] } else { [f64::INFINITY, -way] }
    }
}
