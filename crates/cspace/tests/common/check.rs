//! A map against the library of polygons, configuration by configuration.

use super::{Random, polygon};
use mainspring_cspace::{Axis, ConfigurationSpace};
use mainspring_mechanism::System;
use std::f64::consts::TAU;

/// Disagreement is allowed this near to a contact (size 1; radians).
const NEAR: f64 = 1e-6;

/// What was found.
#[derive(Default)]
pub struct Tally {
    pub configurations: usize,
    /// Of these within 1e-3 of a curve.
    pub near: usize,
    pub free: usize,
    /// Disagreements within 1e-6 of a contact.
    pub forgiven: usize,
    /// All others, with what the map says.
    pub wrong: Vec<([f64; 2], bool)>,
}

impl Tally {
    pub fn add(&mut self, other: Tally) {
        self.configurations += other.configurations;
        self.near += other.near;
        self.free += other.free;
        self.forgiven += other.forgiven;
        self.wrong.extend(other.wrong);
    }
}

pub fn compare(space: &ConfigurationSpace, system: &System, random: &mut Random, count: usize) -> Tally {
    let polygons = [0, 1].map(|k| polygon::Polygons::new(&system.bodies[k]));
    let overlap = |q: [f64; 2]| {
        let [a, b] = [0, 1].map(|k| (&system.bodies[k], &polygons[k]));
        polygon::overlap(a, b, &q)
    };
    let axes = space.domain();
    let inside = |a: &Axis, v: f64| a.wraps || (v > a.start && v < a.end());
    let curves = space.curves();
    let mut tally = Tally::default();
    for k in 0..count {
        let near = k % 4 != 0 && !curves.is_empty();
        let q = if near {
            let at = curves[random.below(curves.len())].at(random.next(0.0, 1.0));
            let (off, a) = (10f64.powf(random.next(-7.0, -3.0)), random.next(0.0, TAU));
            [at[0] + off * a.cos(), at[1] + off * a.sin()]
        } else {
            axes.map(|a| random.next(a.start, a.end()))
        };
        if !(inside(&axes[0], q[0]) && inside(&axes[1], q[1])) {
            continue;
        }
        let says = space.is_free(q);
        tally.configurations += 1;
        tally.near += usize::from(near);
        tally.free += usize::from(says);
        match overlap(q) {
            Some(blocked) if blocked != says => continue,
            None => {
                tally.forgiven += 1;
                continue;
            }
            Some(_) => {}
        }
        let close = (0..32).any(|i| {
            let (s, c) = (f64::from(i) * TAU / 16.0).sin_cos();
            let r = if i < 16 { NEAR } else { 0.3 * NEAR };
            overlap([q[0] + r * c, q[1] + r * s]) != Some(says)
        });
        if close { tally.forgiven += 1 } else { tally.wrong.push((q, says)) }
    }
    tally
}
