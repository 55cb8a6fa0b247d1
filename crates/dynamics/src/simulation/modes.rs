//! Contact modes: what happens at an instant, and how every coordinate moves from then on.

use super::{LOOSEST, MOST_AT_ONCE, Simulation};
use crate::component::Component;
use crate::events::entries;
use crate::flight::{Flight, State};
use crate::linear::Small;
use crate::path::Path;
use crate::run::Mode;
use crate::settle::{Closed, Instant, Settled, settle};
use crate::ties::{Group, Tie, groups};
use crate::watch::Change;
use mainspring_mechanism::Row;

impl Simulation<'_> {
    /// Resolves impacts, contact forces and dry friction now, logs what changed, and gives every coordinate its path.
    pub(super) fn resolve(&mut self, change: Option<Change>) {
        self.halt(change);
        let before: Small<f64, 8> = Small::from_slice(&self.v);
        let mut v = before.clone();
        let mut instant = Instant {
            t: self.record.t,
            q: &self.q,
            speeds: &self.speeds,
            closed: &self.closed,
            drift: self.options.rtol.min(LOOSEST),
            leaving: change.and_then(Change::leaving),
            chattering: (self.at_once > MOST_AT_ONCE / 2).then_some(f64::INFINITY),
            giving: change.and_then(Change::giving),
        };
        let sliding: Small<f64, 8> = Small::from_slice(&self.world.sliding);
        let mut settled = settle(&mut self.world, &instant, &mut v);
        instant.chattering = self.chatter.ends(self.record.t, self.world.system.size, &settled.impulses);
        if instant.chattering.is_some() {
            let blow = settled;
            settled = settle(&mut self.world, &instant, &mut v);
            settled.add_blow(blow);
        }
        self.v.copy_from_slice(&v);
        self.record.events.extend(entries(&self.world, self.record.t, &self.closed, &settled));
        self.record.energy.work += settled.work;
        self.record.energy.impacts += settled.loss;
        if !settled.impulses.is_empty() {
            self.stats.impacts += 1;
            self.record.minima.impact(settled.loss, self.record.t);
        }
        if !settled.solved {
            self.at_once = MOST_AT_ONCE + 1;
            self.jammed = !self.world.drives.is_empty();
        }
        for (speed, v) in self.speeds.iter_mut().zip(&self.v) {
            *speed = speed.max(v.abs());
        }
        self.world.set_dry(&settled.stuck, &settled.sliding);
        self.set_drives();
        self.set_modes((&before, &sliding), &settled);
        self.released = settled.opening.iter().map(|&(id, gap)| (id, gap.min(0.0))).collect();
        self.closed = settled.closed;
        let Settled { stuck, sliding, .. } = settled;
        self.record.modes.push(Mode { from: self.record.t, closed: self.closed.clone(), stuck, sliding });
    }

    /// Velocities that are zero for dry friction become so.
    fn halt(&mut self, change: Option<Change>) {
        for i in 0..self.v.len() {
            let dry = self.world.system.forces.coulomb[i] > 0.0 && !self.world.moved.is_held(i);
            if dry && (change == Some(Change::Halts(i)) || self.v[i].abs() <= self.halted(i)) {
                self.v[i] = 0.0;
            }
        }
    }

    /// Paths of driven coordinates from now on, and when to look again.
    fn set_drives(&mut self) {
        self.next_knot = self.world.follow_drives(self.record.t);
        for k in 0..self.world.drives.len() {
            let ((i, _), path) = (self.world.drives[k], self.world.driven[k]);
            let rests = path.is_rest();
            self.record.set_path(
                i,
                if rests { Path::Rest { q: path.at(self.record.t).q } } else { Path::Driven(path) },
            );
        }
    }

    /// Rest, flight or component for every coordinate that is not driven.
    fn set_modes(&mut self, (before, sliding): (&[f64], &[f64]), settled: &Settled) {
        let active = settled.closed.iter().zip(&settled.rows).filter(|(c, _)| c.active);
        let (active, rows): (Vec<&Closed>, Vec<Row>) = active.map(|(c, row)| (c, *row)).unzip();
        let mut in_group = vec![false; self.q.len()];
        self.components.clear();
        for group in groups(self.ties(&rows)) {
            group.coordinates.iter().for_each(|&i| in_group[i] = true);
            if self.group_rests(&group, &rows, settled) {
                for &i in &group.coordinates {
                    self.v[i] = 0.0;
                    self.record.set_path(i, Path::Rest { q: self.q[i] });
                }
                continue;
            }
            let contacts = group.contacts.iter().map(|&k| active[k].candidate).collect();
            for &i in group.coordinates.iter().filter(|&&i| settled.stuck[i]) {
                self.record.set_path(i, Path::Rest { q: self.q[i] });
            }
            let component = Component::new(&self.world, group.coordinates, contacts, &settled.closed);
            self.components.push((component, self.record.t));
        }
        let moved = self.world.moved.clone();
        for i in (0..self.q.len()).filter(|&i| !in_group[i] && !moved.is_held(i)) {
            self.set_free(i, before[i], sliding[i], settled);
        }
    }

    /// What ties coordinates that are not driven: contacts that carry force, and masses.
    fn ties(&self, rows: &[Row]) -> Vec<Tie> {
        let moved = &self.world.moved;
        let mut ties: Vec<Tie> = rows.iter().enumerate().map(|(k, row)| Tie::of_row(moved, row, k)).collect();
        for group in &self.world.system.coupled {
            let coordinates = group.coordinates.iter().copied().filter(|&i| !moved.is_held(i)).collect();
            ties.push(Tie { coordinates, contact: None });
        }
        ties
    }

    /// Does a group stay where it is: as many contacts as coordinates that move freely, or no force to move it, and no
    /// drive that moves a part of it? A drive whose lever arm is zero at this instant, as at a dead point, moves it soon.
    fn group_rests(&self, group: &Group, rows: &[Row], settled: &Settled) -> bool {
        let free = group.coordinates.iter().filter(|&&i| !settled.stuck[i]).count();
        let touched = |i: usize| !self.record.paths[i].is_rest() && self.world.moved.is_held(i);
        let by_contact = group.contacts.iter().any(|&k| rows[k].entries().any(|(i, _)| touched(i)));
        let tied = self.world.system.coupled.iter().map(|c| &c.coordinates);
        let mut tied = tied.filter(|c| c.iter().any(|i| group.coordinates.contains(i)));
        if by_contact || tied.any(|c| c.iter().any(|&i| touched(i))) {
            return false;
        }
        let movable = |k: &&usize| rows[**k].entries().any(|(i, _)| !self.world.free.is_held(i));
        let full = group.contacts.iter().filter(movable).count() >= free;
        full || group.coordinates.iter().all(|&i| self.is_still(i, settled))
    }

    /// Nothing ties coordinate `i`: it flies, or stays where nothing moves it.
    fn set_free(&mut self, i: usize, v_before: f64, sliding_before: f64, settled: &Settled) {
        if settled.stuck[i] || self.is_still(i, settled) {
            self.v[i] = 0.0;
            self.record.set_path(i, Path::Rest { q: self.q[i] });
            return;
        }
        let flies_on = matches!(self.record.paths[i], Path::Flight(_))
            && v_before == self.v[i]
            && sliding_before == settled.sliding[i];
        if !flies_on {
            let c = &self.world.system.coordinates[i];
            let state = State { q: self.q[i], v: self.v[i] };
            let force = c.force + self.world.dry_force(i);
            let flight = Flight::new(self.record.t, state, c.inertia, c.damping, c.stiffness, force);
            self.record.set_path(i, Path::Flight(flight));
        }
    }

    /// Neither moving nor about to, to rounding.
    fn is_still(&self, i: usize, settled: &Settled) -> bool {
        let acceleration = settled.acceleration[i].abs();
        let limit = if self.world.moved.is_alone(i) {
            let c = &self.world.system.coordinates[i];
            let force = c.force.abs() + (c.stiffness * self.q[i]).abs() + self.world.system.forces.coulomb[i];
            force / c.inertia
        } else {
            settled.weights[i]
        };
        self.v[i].abs() <= 1e-13 * self.speeds[i] && acceleration <= 1e-13 * limit
    }
}
