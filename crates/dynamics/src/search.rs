//! The first contact along a motion: lists of near candidates one after the other, and a march along each candidate.
//! Contacts whose features stay apart by their lever arms alone are not evaluated at all.

use crate::component::Component;
use crate::flight::State;
use crate::linear::Small;
use crate::march::{March, Real};
use crate::opposed::are_opposed;
use crate::pace::Pace;
use crate::path::Path;
use crate::sight::Sight;
use crate::sweep::{only_mover, sweep_along};
use crate::world::{Arm, World};
use mainspring_mechanism::{Candidate, ContactId, Relative, misses_cone};

/// A gap this small, relative to the machine's size, is closed.
pub const CLOSED: f64 = 1e-13;
/// Contacts this near, relative to the machine's size, are resolved together.
pub const TOGETHER: f64 = 1e-10;
/// Contacts that touch overlap by no more than this, relative to the machine's size: steps of the integrator leave
/// less, and what touches is found again although it overlaps.
pub const OVERLAP: f64 = 1e-6;
/// Contact points this near to the end of a feature, relative to the machine's size, count as at the end.
pub const BAND: f64 = 1e-9;
/// Most evaluations along one contact and stretch.
pub const MOST_STEPS: usize = 2000;

/// Along steps of the integrator contacts keep to zero only to this, relative to the machine's size. What is nearer is
/// looked at where the closed contacts hold the parts.
pub const INEXACT: f64 = 2e-7;

/// A contact found to close.
#[derive(Clone, Copy, Debug)]
pub struct Closing {
    pub t: f64,
    pub candidate: Candidate,
}

/// What the search treats apart: contacts that are closed, and contacts that were closed to rounding when the
/// stretch began. The latter are looked for only after a positive sample, and their gaps count from the gap at
/// their release (never positive), which integration leaves a little below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Watch {
    Closed,
    Released { floor: f64 },
}

impl Watch {
    pub fn floor(self) -> Option<f64> {
        match self {
            Watch::Closed => None,
            Watch::Released { floor } => Some(floor),
        }
    }
}

/// The motion over a stretch: one path a coordinate.
#[derive(Clone, Copy)]
pub struct Stretch<'p> {
    pub paths: &'p [Path],
    /// What moves in contact along steps of the integrator.
    pub components: &'p [(Component, f64)],
    pub from: f64,
    pub to: f64,
    /// Radians past the ends of cones at which contacts still count.
    pub outside: f64,
}

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The first contact to close.
    pub closing: Option<Closing>,
    /// Nothing else closes before this time: the end of the stretch, or where the bound on work was met.
    pub clear_until: f64,
}

/// The first contact to close over the stretch, by time and then by identity. The stretch is searched in pieces that
/// double, all interactions in each: what closes first ends the search before others are followed far beyond it.
pub fn first_closing(
    world: &mut World,
    stretch: &Stretch,
    watched: &[(ContactId, Watch)],
    real: Real,
) -> Found {
    let moves =
        |world: &World, i: usize| world.arms[i].iter().any(|a| !stretch.paths[a.coordinate].is_rest());
    let mut found = Found { closing: None, clear_until: stretch.to };
    let mut moving: Small<usize> = Small::new();
    for i in (0..world.arms.len()).filter(|&i| moves(world, i)).collect::<Small<usize>>() {
        match only_mover(world, i, stretch) {
            Some(coordinate) => sweep_along(world, (i, coordinate), stretch, watched, real, &mut found),
            None => moving.push(i),
        }
    }
    if moving.is_empty() {
        return found;
    }
    let stretch = &Stretch { to: found.clear_until, ..*stretch };
    let mut length = first_piece(world, stretch, &moving);
    let mut from = stretch.from;
    for _ in 0..MOST_STEPS {
        let piece = Stretch { from, to: stretch.to.min(from + length), ..*stretch };
        let mut first = Found { closing: None, clear_until: piece.to };
        for &interaction in &moving {
            look_along(world, interaction, &piece, watched, real, &mut first);
        }
        if first.closing.is_some() || first.clear_until < piece.to {
            return first;
        }
        if piece.to >= stretch.to {
            return found;
        }
        from = piece.to;
        length *= 2.0;
    }
    Found { closing: None, clear_until: from }
}

/// A time in which no feature moves further than a twentieth of the machine's size, by present speeds.
fn first_piece(world: &World, stretch: &Stretch, moving: &[usize]) -> f64 {
    let n = stretch.paths.len();
    let (mut q, mut v): (Small<f64, 8>, Small<f64, 8>) =
        (smallvec::smallvec![0.0; n], smallvec::smallvec![0.0; n]);
    let far = 0.05 * world.system.size;
    let time = |world: &World, i: usize, q: &mut [f64], v: &mut [f64]| {
        set_state(&world.arms[i], stretch, stretch.from, q, v);
        let pace = Pace::new(&world.arms[i], stretch.paths, (q, v), 0.0);
        let (speed, acceleration) = (pace.total(), pace.acceleration());
        2.0 * far / (speed + (speed * speed + 2.0 * acceleration * far).sqrt()).max(f64::MIN_POSITIVE)
    };
    moving.iter().map(|&i| time(world, i, &mut q, &mut v)).fold(f64::INFINITY, f64::min)
}

/// Looks along one interaction, from list to list.
fn look_along(
    world: &mut World,
    interaction: usize,
    stretch: &Stretch,
    watched: &[(ContactId, Watch)],
    real: Real,
    found: &mut Found,
) {
    let mut sight = Sight::new(world, interaction, stretch, stretch.from);
    let mut marches = Small::new();
    let mut t = stretch.from;
    for _ in 0..MOST_STEPS {
        if t >= found.clear_until {
            return;
        }
        sight.move_to(world, t);
        let (travelled, room) = world.refresh(interaction, &sight.q, 0.0);
        let state = (sight.q.as_slice(), sight.v.as_slice());
        let (end, pace) =
            horizon(world, interaction, stretch, state, (travelled, room), t, found.clear_until);
        begin_within_reach(world, &sight, interaction, watched, (end, pace), &mut marches);
        follow(world, &mut sight, &mut marches, end, real, found);
        t = end;
    }
    // The bound on work was met: what lies beyond is for the next search.
    if t < found.clear_until {
        *found = Found { closing: None, clear_until: t };
    }
}

/// Begins marches along the contacts of an interaction that may close from the time in sight to `end`.
fn begin_within_reach<'a>(
    world: &World<'a>,
    sight: &Sight,
    interaction: usize,
    watched: &[(ContactId, Watch)],
    (end, pace): (f64, Pace),
    marches: &mut Small<March<'a>, 8>,
) {
    let sides = world.travelled(interaction, &sight.q);
    let farthest = sides[0] + sides[1] + pace.total() * (end - sight.t);
    let relative = Relative::pose(&sight.placed.0.pose, &sight.placed.1.pose);
    let turn = pace.turning() * (end - sight.t) + sight.stretch.outside + 1e-6;
    let closed = || sight.stretch.components.iter().flat_map(|c| &c.0.contacts);
    marches.clear();
    for candidate in world.listed(interaction).iter().filter(|c| c.distance <= farthest) {
        let shares = world.shares(candidate);
        let speed = pace.shared_total(shares);
        let reach = sides[0] * shares[0] + sides[1] * shares[1] + speed * (end - sight.t);
        if candidate.distance > reach {
            continue;
        }
        let watch = watched.iter().find(|w| w.0 == candidate.id).map(|w| w.1);
        // A contact opposed to a closed one stays as far open as it is.
        let apart = || closed().any(|c| are_opposed(world, c, candidate));
        let (a, b) = world.features(candidate);
        let misses = || misses_cone(candidate.kind, a, b, &relative, turn);
        if watch != Some(Watch::Closed) && !misses() && !apart() {
            let floor = watch.and_then(Watch::floor);
            marches.push(March::new((a, b), candidate, pace.shared(shares), floor, sight.t));
        }
    }
}

/// Marches along all contacts on one clock: places are shared by all contacts that are due soon.
fn follow<'a>(
    world: &mut World<'a>,
    sight: &mut Sight<'_, '_, 'a>,
    marches: &mut Small<March<'a>, 8>,
    end: f64,
    real: Real,
    found: &mut Found,
) {
    let mut last = sight.t;
    loop {
        let now = marches.iter().map(|m| m.clear).fold(f64::INFINITY, f64::min);
        if now >= end.min(found.clear_until) {
            return;
        }
        sight.move_to(world, now);
        let relative = sight.relative();
        let soon = now + (now - last);
        last = now;
        for march in marches.iter_mut().filter(|m| m.clear <= soon) {
            if let Some(t) = march.look(world, sight, &relative, end, real)
                && t < found.clear_until
            {
                let closing = Some(Closing { t, candidate: march.candidate });
                *found = Found { closing, clear_until: t };
            }
        }
        marches.retain(|m| m.clear < end);
    }
}

fn set_state(arms: &[Arm], stretch: &Stretch, t: f64, q: &mut [f64], v: &mut [f64]) {
    for arm in arms {
        let State { q: qi, v: vi } = stretch.paths[arm.coordinate].at(t);
        (q[arm.coordinate], v[arm.coordinate]) = (qi, vi);
    }
}

/// How far to look with this list, and the rates of motion until then: no unlisted contact can close before, and the
/// listed ones that can are few.
fn horizon(
    world: &World,
    interaction: usize,
    stretch: &Stretch,
    state: (&[f64], &[f64]),
    (travelled, room): (f64, f64),
    t: f64,
    until: f64,
) -> (f64, Pace) {
    let pace_over = |dt: f64| Pace::new(&world.arms[interaction], stretch.paths, state, dt);
    let pace = pace_over(until - t);
    let nearest = world.listed(interaction).iter().map(|c| c.distance).fold(f64::INFINITY, f64::min);
    let allowed = room.min((nearest - travelled).max(0.0) + 0.04 * world.system.size);
    if pace.total() * (until - t) <= allowed {
        return (until, pace);
    }
    // Bounds of speed shrink with the stretch: lengthen it from the safe side.
    let mut best = (allowed / pace.total(), pace);
    for _ in 0..6 {
        best.1 = pace_over(best.0);
        let longer = (until - t).min(0.5 * (best.0 + allowed / best.1.total()));
        let there = pace_over(longer);
        if there.total() * longer > allowed || longer <= 1.1 * best.0 {
            break;
        }
        best = (longer, there);
    }
    (until.min(t + best.0).max(t + 1e-15 * (1.0 + t.abs())), best.1)
}
