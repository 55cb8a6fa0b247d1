//! What happens at the end of a stretch: the state moves on, contacts close, change and part, dry friction is resolved, and
//! what the solver does not move gets its path.

use super::changes::Change;
use super::dry;
use super::simulation::Compliant;
use super::tip::Tip;
use crate::energy::{kinetic, quadrature};
use crate::events::{Event, EventKind, moving_together};
use crate::flight::{Flight, State};
use crate::halts::halted;
use crate::path::{DrivenPath, Path};
use crate::run::Mode;
use crate::search::CLOSED;
use crate::settle::Closed;
use mainspring_mechanism::Candidate;

impl Compliant<'_> {
    /// Moves the present to `t` along the paths.
    pub(super) fn commit(&mut self, t: f64) {
        let from = self.record.t;
        let work = self.drive_work(from, t);
        self.record.energy.work += work;
        self.record.commit(self.world.system, t, (&mut self.q, &mut self.v));
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.at_once = if t > from { 0 } else { self.at_once + 1 };
        if !self.world.drives.is_empty() {
            let energy = kinetic(self.world.system, &self.q, &self.v);
            self.record.energy.kinetic_max = self.record.energy.kinetic_max.max(energy);
        }
    }

    /// Work of the drives along the paths, by quadrature of their power.
    pub(super) fn drive_work(&mut self, from: f64, to: f64) -> f64 {
        let paths = &self.record.paths;
        let moving: Vec<usize> =
            self.world.drives.iter().map(|d| d.0).filter(|&i| !paths[i].is_rest()).collect();
        if moving.is_empty() || to <= from {
            return 0.0;
        }
        let (group, system) = (&mut self.group, self.world.system);
        let own = group.coordinates.clone();
        let smooth = quadrature(from, to, |t| {
            group.move_to(t, |k| {
                let State { q, v } = paths[own[k]].at(t);
                (q, v)
            });
            group.drive_power(&moving)
        });
        let dry = |&i: &usize| system.forces.coulomb[i] * (paths[i].at(to).q - paths[i].at(from).q).abs();
        smooth + moving.iter().map(dry).sum::<f64>()
    }

    pub(super) fn close(&mut self, candidate: Candidate) {
        self.group.tips.push(Tip::new(candidate));
        self.settle(None);
        self.log(EventKind::Close, candidate);
        // A new contact acts at once: begin with a small part of its own time.
        self.stepper.next = f64::INFINITY;
    }

    pub(super) fn change(&mut self, change: Change) {
        let mut giving = None;
        match change {
            Change::Clamp(k) => self.group.tips[k].clamped ^= true,
            Change::Hand(k, next) => self.hand(k, next.candidate),
            Change::Gives(i, direction) => giving = Some((i, direction)),
            Change::Part(k) | Change::RanOff(k) => {
                let candidate = self.group.tips[k].candidate;
                if matches!(change, Change::RanOff(_)) {
                    self.lose(k);
                }
                self.group.tips.remove(k);
                self.released.push((candidate.id, 0.0));
                self.settle(None);
                return self.log(EventKind::Release, candidate);
            }
        }
        self.settle(giving);
    }

    /// Another pair of features takes over at tip `k`; where it is a tip already the two become one. What they store
    /// less is lost.
    pub(super) fn hand(&mut self, k: usize, next: Candidate) {
        self.place_group();
        let before = self.group.stored();
        if self.group.tips.iter().any(|tip| tip.candidate.id == next.id) {
            self.group.tips.remove(k);
        } else {
            self.group.tips[k].candidate = next;
        }
        self.record.energy.impacts += before - self.group.stored();
    }

    /// What a tip stores is lost when it runs off.
    pub(super) fn lose(&mut self, k: usize) {
        self.place_group();
        let depth = self.group.state(k).depth;
        self.record.energy.impacts += self.group.law.stored(depth);
    }

    /// Moves the group to the present.
    pub(super) fn place_group(&mut self) {
        let (q, v) = (&self.q, &self.v);
        let own = self.group.coordinates.clone();
        self.group.move_to(self.record.t, |i| (q[own[i]], v[own[i]]));
    }

    pub(super) fn log(&mut self, kind: EventKind, candidate: Candidate) {
        let closed = self.closed();
        let moving_together = moving_together(&self.world, &closed);
        let bodies = self.world.bodies(&candidate);
        let t = self.record.t;
        let event = Event { t, kind, contact: candidate.id, bodies, impulse: 0.0, moving_together };
        self.record.events.push(event);
    }

    /// The contacts that overlap now, with their forces.
    pub fn closed(&mut self) -> Vec<Closed> {
        self.place_group();
        (0..self.group.tips.len())
            .map(|k| {
                let state = self.group.state(k);
                let tip = self.group.tips[k];
                let force = self.group.force_of(k, &state).max(0.0);
                Closed { candidate: tip.candidate, gap: -state.depth, force, active: !tip.clamped }
            })
            .collect()
    }

    /// After something changed: what dry friction holds, paths of what the solver does not move, and the new mode.
    pub(super) fn settle(&mut self, giving: Option<(usize, f64)>) {
        self.set_drives();
        self.group.gather(&self.world, (&self.q, &self.v));
        if self.world.system.forces.coulomb.iter().any(|size| *size > 0.0) {
            self.settle_dry(giving);
            self.group.gather(&self.world, (&self.q, &self.v));
        }
        for i in 0..self.q.len() {
            if self.world.stuck[i] {
                self.record.set_path(i, Path::Rest { q: self.q[i] });
            } else if !self.world.moved.is_held(i) && !self.group.coordinates.contains(&i) {
                self.set_free(i);
            }
        }
        let closed = self.closed();
        let (stuck, sliding) = (self.world.stuck.clone(), self.world.sliding.clone());
        self.record.modes.push(Mode { from: self.record.t, closed, stuck, sliding });
    }

    pub(super) fn settle_dry(&mut self, giving: Option<(usize, f64)>) {
        for i in 0..self.q.len() {
            let dry = self.world.system.forces.coulomb[i] > 0.0 && !self.world.moved.is_held(i);
            if dry && self.v[i].abs() <= halted(i, &self.scales, &self.speeds) {
                self.v[i] = 0.0;
            }
        }
        self.place_group();
        let pressed = self.group.pressed().to_vec();
        let now = dry::resolve(&mut self.world, self.record.t, (&self.q, &self.v), &pressed, giving);
        self.world.set_dry(&now.stuck, &now.sliding);
    }

    /// Paths of driven coordinates from now on, and when to look again.
    pub(super) fn set_drives(&mut self) {
        self.next_knot = f64::INFINITY;
        self.group.drives.clear();
        for k in 0..self.world.drives.len() {
            let (i, drive) = self.world.drives[k];
            let (path, until) = DrivenPath::new(drive, self.record.t);
            let rests = path.is_rest();
            let q = path.at(self.record.t).q;
            self.record.set_path(i, if rests { Path::Rest { q } } else { Path::Driven(path) });
            self.next_knot = self.next_knot.min(until);
            self.group.drives.push((i, path));
        }
    }

    /// Drives move something, or will.
    pub(super) fn drives_act(&self) -> bool {
        let moves = |d: &(usize, _)| !self.record.paths[d.0].is_rest();
        self.next_knot < f64::INFINITY || self.world.drives.iter().any(moves)
    }

    /// No contact acts on coordinate `i`: it flies, or stays where nothing moves it.
    pub(super) fn set_free(&mut self, i: usize) {
        let c = &self.world.system.coordinates[i];
        let dry = self.world.system.forces.coulomb[i];
        let force = c.force.abs() + (c.stiffness * self.q[i]).abs() + dry;
        let acceleration = self.world.acceleration_alone(i, self.q[i], self.v[i]);
        let still =
            self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration.abs() <= 1e-13 * force / c.inertia;
        if still {
            self.v[i] = 0.0;
            self.record.set_path(i, Path::Rest { q: self.q[i] });
            return;
        }
        let slides = self.world.system.forces.coulomb[i] > 0.0;
        if slides || !matches!(self.record.paths[i], Path::Flight(_)) {
            let state = State { q: self.q[i], v: self.v[i] };
            let force = c.force + self.world.dry_force(i);
            let flight = Flight::new(self.record.t, state, c.inertia, c.damping, c.stiffness, force);
            self.record.set_path(i, Path::Flight(flight));
        }
    }

    /// Forgets contacts that parted and are open by now.
    pub(super) fn drop_opened(&mut self) {
        let open = 8.0 * CLOSED * self.world.system.size;
        for (id, floor) in std::mem::take(&mut self.released) {
            let Some(candidate) = self.world.find(id) else { continue };
            let (a, b) = self.world.place(&candidate, &self.q);
            if self.world.touch_at(&candidate, &self.q, (&a, &b)).state.gap <= open {
                self.released.push((id, floor));
            }
        }
    }
}
