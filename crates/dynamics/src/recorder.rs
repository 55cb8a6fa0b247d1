//! What a run writes down as it goes: paths, events, contact modes, energies, minima of the kinetic energy.

use crate::energy::{Energy, friction_loss, kinetic, potential};
use crate::events::Event;
use crate::flight::State;
use crate::minima::MinimumFinder;
use crate::path::{Path, Piece, Trajectory};
use crate::ranges::Track;
use crate::run::Mode;
use crate::work::applied_work;
use mainspring_mechanism::System;

/// The record of a run up to the time `t`.
#[derive(Clone, Debug)]
pub struct Recorder {
    pub t: f64,
    /// Present paths, by coordinate, and since when.
    pub paths: Vec<Path>,
    since: Vec<f64>,
    pub trajectory: Trajectory,
    pub events: Vec<Event>,
    pub modes: Vec<Mode>,
    pub energy: Energy,
    pub minima: MinimumFinder,
    /// The last stretch of motion and the ranges since they were last taken; kept only when asked for.
    pub track: Option<Track>,
}

impl Recorder {
    /// Nothing has moved yet from `(q, v)`; `driven` is the kinetic energy of what only drives move.
    pub fn new(system: &System, (q, v): (&[f64], &[f64]), driven: f64) -> Self {
        let kinetic_max = kinetic(system, q, v);
        let mut minima = MinimumFinder::default();
        minima.top = (kinetic_max - driven).max(0.0);
        let initial = kinetic_max + potential(system, q);
        Self {
            t: 0.0,
            paths: q.iter().map(|&q| Path::Rest { q }).collect(),
            since: vec![0.0; q.len()],
            trajectory: Trajectory { pieces: vec![vec![]; q.len()], times: vec![0.0] },
            events: vec![],
            modes: vec![],
            energy: Energy { initial, last: initial, kinetic_max, ..Energy::default() },
            minima,
            track: None,
        }
    }

    /// Gives coordinate `i` a path from now on.
    pub fn set_path(&mut self, i: usize, path: Path) {
        if self.paths[i] == path {
            return;
        }
        if self.t > self.since[i] {
            let piece = Piece { from: self.since[i], to: self.t, path: self.paths[i] };
            self.trajectory.pieces[i].push(piece);
        }
        (self.paths[i], self.since[i]) = (path, self.t);
    }

    /// Follows the paths to time `t`; the state there goes into `(q, v)`.
    pub fn commit(&mut self, system: &System, t: f64, (q, v): (&mut [f64], &mut [f64])) {
        self.minima.stretch(system, &self.paths, self.t, t);
        self.energy.friction += friction_loss(system, &self.paths, self.t, t);
        self.energy.work += applied_work(system, &self.paths, self.t, t);
        if let Some(track) = &mut self.track {
            track.ranges.extend(&self.paths, self.t, t);
            (track.from, track.to) = (self.t, t);
            track.paths.clone_from(&self.paths);
        }
        for ((path, q), v) in self.paths.iter().zip(q).zip(v) {
            let state: State = path.at(t);
            (*q, *v) = (state.q, state.v);
        }
        self.t = t;
        if self.trajectory.end() < t {
            self.trajectory.times.push(t);
        }
    }

    /// Closes the record in the final state.
    pub fn finish(&mut self, system: &System, (q, v): (&[f64], &[f64])) {
        for i in 0..self.paths.len() {
            let piece = Piece { from: self.since[i], to: self.t, path: self.paths[i] };
            self.trajectory.pieces[i].push(piece);
        }
        self.energy.kinetic_max = self.energy.kinetic_max.max(self.minima.top);
        self.energy.last = kinetic(system, q, v) + potential(system, q);
    }
}
