//! Steps of the stiff solver: their length by the error asked for.

use super::group::Group;
use super::rosenbrock::{Accelerations, Jacobian, Rosenbrock, Start};
use super::stretch::Stretch;

/// What the error of a step is told against, by coordinate of the system.
pub struct Scales<'s> {
    pub rtol: f64,
    pub positions: &'s [f64],
    pub speeds: &'s [f64],
}

/// The solver with its state from step to step.
#[derive(Clone, Debug)]
pub struct Stepper {
    step: Rosenbrock,
    jacobian: Jacobian,
    pub stretch: Stretch,
    /// Proposed length of the next step; infinite where the last says nothing about it.
    pub next: f64,
    /// Steps tried and not taken.
    pub rejected: u64,
}

impl Default for Stepper {
    fn default() -> Self {
        Self {
            step: Rosenbrock::default(),
            jacobian: Jacobian::default(),
            stretch: Stretch::default(),
            next: f64::INFINITY,
            rejected: 0,
        }
    }
}

impl Stepper {
    /// Finds a step from `t` and the state `(q, v)` of the whole system, at most `longest` long, that fits the
    /// tolerance, and takes it into `stretch`. None if none does.
    pub fn advance(
        &mut self,
        group: &mut Group,
        (t, q, v): (f64, &[f64], &[f64]),
        longest: f64,
        scales: &Scales,
    ) -> Option<()> {
        let own =
            |list: &[f64], group: &Group| group.coordinates.iter().map(|&i| list[i]).collect::<Vec<_>>();
        let (q, v) = (own(q, group), own(v, group));
        let mut a = vec![0.0; q.len()];
        self.step.resize(q.len());
        group.accelerations(t, &q, &v, &mut a);
        group.jacobian(&a, &mut self.jacobian);
        let start = Start { t, q: &q, v: &v, a: &a };
        let shortest = 16.0 * f64::EPSILON * (1.0 + t.abs());
        let mut h = self.next.min(longest);
        if q.is_empty() {
            h = longest;
        } else if self.next == f64::INFINITY {
            // A new contact acts at once: begin with a small part of its own time.
            h = h.min(0.1 / self.stiffness(group.coordinates.len()));
        }
        loop {
            if h.is_nan() || (h < shortest && h < longest) {
                return None;
            }
            let solved = self.step.attempt(group, &start, &self.jacobian, h);
            let error = if solved { self.error(group, &a, h, scales) } else { f64::INFINITY };
            let factor = if error.is_finite() { (0.9 * error.powf(-0.2)).clamp(0.2, 4.0) } else { 0.1 };
            if error <= 1.0 {
                self.next = if q.is_empty() { f64::INFINITY } else { h * factor };
                self.stretch.set(&self.step, &start, h);
                return Some(());
            }
            self.rejected += 1;
            h *= factor.min(0.7);
        }
    }

    /// Greatest rate of the group's own motion: √ of the stiffest diagonal entry.
    fn stiffness(&self, n: usize) -> f64 {
        let greatest = (0..n).map(|k| self.jacobian.by_position[k * n + k].abs()).fold(0.0, f64::max);
        greatest.sqrt().max(f64::MIN_POSITIVE)
    }

    /// Estimated error of the last step relative to the tolerance: velocities against the greatest speeds, positions
    /// against what these speeds cover in the time of the contact's own oscillation.
    fn error(&self, group: &Group, a: &[f64], h: f64, scales: &Scales) -> f64 {
        let (e_q, e_v) = self.step.error();
        let n = group.coordinates.len();
        if n == 0 {
            return 0.0;
        }
        let mut sum = 0.0;
        for (k, &i) in group.coordinates.iter().enumerate() {
            let rate = self.jacobian.by_position[k * n + k].abs().sqrt();
            let speed = scales.speeds[i].max(self.step.end_v[k].abs()).max(a[k].abs() * h);
            let speed = speed.max(f64::MIN_POSITIVE);
            let reach = (speed / rate.max(f64::MIN_POSITIVE)).min(scales.positions[i]);
            let (x, y) = (e_q[k] / reach, e_v[k] / speed);
            sum += x * x + y * y;
        }
        (sum / (2 * n) as f64).sqrt() / scales.rtol
    }
}
