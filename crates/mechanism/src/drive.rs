//! Prescribed motion of one joint position: a constant speed, or a table against time.
//!
//! A table is the monotone cubic of Fritsch and Carlson (SIAM J. Numer. Anal. 17, 1980): between its points
//! `x = x₀ + τ (d₀ + τ (c₂ + τ c₃))` with `c₂ = (3 Δ − 2 d₀ − d₁)/h`, `c₃ = (d₀ + d₁ − 2 Δ)/h²`, Δ the secant's slope.
//! Position and speed are continuous, acceleration jumps at the points. It rises where the points rise and never
//! passes beyond them. Before the first and after the last point it stands still, so both end slopes are 0.

/// Prescribed position of a coordinate or of a joint; radians, or the file's length.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// `start + speed t`.
    Speed {
        start: f64,
        speed: f64,
    },
    Table(Table),
}

/// A table's points with its slopes there.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    positions: Vec<f64>,
    slopes: Vec<f64>,
}

/// Prescribed position, velocity and acceleration at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Driven {
    pub q: f64,
    pub v: f64,
    pub a: f64,
}

/// A stretch of a prescribed motion: `x = c₀ + τ (c₁ + τ (c₂ + τ c₃))` with `τ = t − from`, valid up to `until`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivePiece {
    pub from: f64,
    pub until: f64,
    pub coefficients: [f64; 4],
}

impl Drive {
    /// The motion at time `t`; the acceleration just after it where it jumps.
    pub fn at(&self, t: f64) -> Driven {
        match self {
            Drive::Speed { start, speed } => Driven { q: start + speed * t, v: *speed, a: 0.0 },
            Drive::Table(table) => table.at(t),
        }
    }

    /// The first time after `t` at which the acceleration jumps.
    pub fn next_knot(&self, t: f64) -> Option<f64> {
        match self {
            Drive::Speed { .. } => None,
            Drive::Table(table) => table.times.get(table.times.partition_point(|k| *k <= t)).copied(),
        }
    }

    /// Greatest |velocity| and |acceleration| between two times: exact.
    pub fn bounds(&self, from: f64, to: f64) -> (f64, f64) {
        match self {
            Drive::Speed { speed, .. } => (speed.abs(), 0.0),
            Drive::Table(table) => table.bounds(from, to),
        }
    }

    /// The piece of the motion that holds at time `t` and just after.
    pub fn piece(&self, t: f64) -> DrivePiece {
        match self {
            Drive::Speed { start, speed } => {
                DrivePiece { from: 0.0, until: f64::INFINITY, coefficients: [*start, *speed, 0.0, 0.0] }
            }
            Drive::Table(table) => match table.piece(t) {
                Some(i) => {
                    let ([d0, c2, c3], _) = table.cubic(i);
                    let coefficients = [table.positions[i], d0, c2, c3];
                    DrivePiece { from: table.times[i], until: table.times[i + 1], coefficients }
                }
                None => DrivePiece {
                    from: t,
                    until: self.next_knot(t).unwrap_or(f64::INFINITY),
                    coefficients: [table.at(t).q, 0.0, 0.0, 0.0],
                },
            },
        }
    }

    /// The motion of a coordinate that is `factor` times this one.
    pub fn scaled(&self, factor: f64) -> Self {
        match self {
            Drive::Speed { start, speed } => Drive::Speed { start: start * factor, speed: speed * factor },
            Drive::Table(t) => {
                let scale = |list: &[f64]| list.iter().map(|x| x * factor).collect();
                let (positions, slopes) = (scale(&t.positions), scale(&t.slopes));
                Drive::Table(Table { times: t.times.clone(), positions, slopes })
            }
        }
    }
}

impl Table {
    /// A table through two or more points with increasing times.
    ///
    /// # Panics
    /// If there are fewer points, or their times do not increase.
    pub fn new(points: &[(f64, f64)]) -> Self {
        assert!(points.len() >= 2 && points.windows(2).all(|w| w[0].0 < w[1].0), "increasing times");
        let (times, positions): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let slopes = slopes(&times, &positions);
        Self { times, positions, slopes }
    }

    /// Times and positions.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.times.iter().copied().zip(self.positions.iter().copied())
    }

    /// Index of the piece that holds `t`; none before the first and from the last point on.
    fn piece(&self, t: f64) -> Option<usize> {
        let after = self.times.partition_point(|k| *k <= t);
        (after > 0 && after < self.times.len()).then(|| after - 1)
    }

    /// Coefficients of τ, τ², τ³ in piece `i`, and its length.
    fn cubic(&self, i: usize) -> ([f64; 3], f64) {
        let h = self.times[i + 1] - self.times[i];
        let secant = (self.positions[i + 1] - self.positions[i]) / h;
        let (d0, d1) = (self.slopes[i], self.slopes[i + 1]);
        ([d0, (3.0 * secant - 2.0 * d0 - d1) / h, (d0 + d1 - 2.0 * secant) / (h * h)], h)
    }

    fn at(&self, t: f64) -> Driven {
        let Some(i) = self.piece(t) else {
            let last = self.positions.len() - 1;
            let q = self.positions[if t < self.times[0] { 0 } else { last }];
            return Driven { q, v: 0.0, a: 0.0 };
        };
        let ([d0, c2, c3], _) = self.cubic(i);
        let tau = t - self.times[i];
        Driven {
            q: self.positions[i] + tau * (d0 + tau * (c2 + tau * c3)),
            v: d0 + tau * (2.0 * c2 + 3.0 * tau * c3),
            a: 2.0 * c2 + 6.0 * tau * c3,
        }
    }

    fn bounds(&self, from: f64, to: f64) -> (f64, f64) {
        let first = self.times.partition_point(|k| *k <= from).saturating_sub(1);
        let (mut speed, mut acceleration) = (0f64, 0f64);
        for i in first..self.times.len() - 1 {
            if self.times[i] >= to && i > first {
                break;
            }
            let ([d0, c2, c3], h) = self.cubic(i);
            let (a, b) = ((from - self.times[i]).clamp(0.0, h), (to - self.times[i]).clamp(0.0, h));
            if a >= b {
                continue;
            }
            // The velocity is a parabola: greatest at an end or at its vertex.
            let vertex = if c3 == 0.0 { a } else { (-c2 / (3.0 * c3)).clamp(a, b) };
            for tau in [a, b, vertex] {
                speed = speed.max((d0 + tau * (2.0 * c2 + 3.0 * tau * c3)).abs());
            }
            acceleration =
                acceleration.max((2.0 * c2 + 6.0 * a * c3).abs()).max((2.0 * c2 + 6.0 * b * c3).abs());
        }
        (speed, acceleration)
    }
}

/// Slopes that keep every piece monotone: three-point estimates, 0 where secants change sign and at both ends, then
/// drawn into the circle α² + β² ≤ 9 of each piece (α, β: slopes over the secant's).
fn slopes(times: &[f64], positions: &[f64]) -> Vec<f64> {
    let n = times.len();
    let length = |i: usize| times[i + 1] - times[i];
    let secant = |i: usize| (positions[i + 1] - positions[i]) / length(i);
    let mut d = vec![0.0; n];
    for (i, slope) in d.iter_mut().enumerate().take(n - 1).skip(1) {
        let (before, after) = (secant(i - 1), secant(i));
        if before * after > 0.0 {
            let (h, k) = (length(i - 1), length(i));
            *slope = (k * before + h * after) / (h + k);
        }
    }
    for i in 0..n - 1 {
        let s = secant(i);
        if s == 0.0 {
            continue;
        }
        let size = (d[i] / s).hypot(d[i + 1] / s);
        if size > 3.0 {
            d[i] *= 3.0 / size;
            d[i + 1] *= 3.0 / size;
        }
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [(f64, f64); 6] =
        [(-1.0, 0.0), (0.5, 1.0), (1.0, 1.0), (1.25, 6.0), (4.0, 6.5), (5.0, -2.0)];

    #[test]
    fn passes_through_its_points_and_stands_still_outside() {
        let drive = Drive::Table(Table::new(&POINTS));
        for (t, x) in POINTS {
            assert!((drive.at(t).q - x).abs() < 1e-14, "{t}");
        }
        for t in [-9.0, -1.0, 5.0, 17.0] {
            assert!(drive.at(t).v.abs() < 1e-14, "{t}");
        }
        assert_eq!((drive.at(-9.0).q, drive.at(17.0).q), (0.0, -2.0));
        assert_eq!(drive.next_knot(0.5), Some(1.0));
        assert_eq!((drive.next_knot(-7.0), drive.next_knot(5.0)), (Some(-1.0), None));
    }

    #[test]
    fn is_monotone_between_points_and_smooth_at_them() {
        let drive = Drive::Table(Table::new(&POINTS));
        for w in POINTS.windows(2) {
            let rise = w[1].1 - w[0].1;
            for k in 0..=1000 {
                let t = w[0].0 + (w[1].0 - w[0].0) * f64::from(k) / 1000.0;
                assert!(
                    drive.at(t).v * rise >= -1e-12 && (rise != 0.0 || drive.at(t).v.abs() < 1e-14),
                    "{t}"
                );
            }
            let (before, after) = (drive.at(w[1].0 - 1e-9), drive.at(w[1].0 + 1e-9));
            assert!((before.v - after.v).abs() < 1e-5, "speed jumps at {}", w[1].0);
        }
    }

    /// Two points make x = 3 s² − 2 s³: greatest speed 3/2 of the secant's, acceleration ± 6/h².
    #[test]
    fn two_points_in_closed_form() {
        let drive = Drive::Table(Table::new(&[(2.0, 1.0), (6.0, 9.0)]));
        let (middle, start) = (drive.at(4.0), drive.at(2.0));
        assert_eq!((middle.q, middle.v, middle.a), (5.0, 3.0, 0.0));
        assert_eq!((start.v, start.a), (0.0, 3.0));
        assert_eq!(drive.bounds(0.0, 9.0), (3.0, 3.0));
        assert_eq!(drive.bounds(3.0, 3.5).1, drive.at(3.0).a);
        assert_eq!(drive.bounds(7.0, 9.0), (0.0, 0.0));
        assert_eq!(drive.scaled(-2.0).at(4.0), Driven { q: -10.0, v: -6.0, a: 0.0 });
    }

    #[test]
    fn velocities_are_derivatives_and_bounds_hold() {
        let drive = Drive::Table(Table::new(&POINTS));
        for k in 0..400 {
            let t = -1.5 + 7.0 * (f64::from(k) + 0.37) / 400.0;
            let h = 1e-6;
            let slope = (drive.at(t + h).q - drive.at(t - h).q) / (2.0 * h);
            let Driven { v, a, .. } = drive.at(t);
            assert!((slope - v).abs() < 1e-4 * (1.0 + a.abs()), "{t}: {slope} {v}");
            let piece = drive.piece(t);
            let ([c0, c1, c2, c3], tau) = (piece.coefficients, t - piece.from);
            assert!(
                (c0 + tau * (c1 + tau * (c2 + tau * c3)) - drive.at(t).q).abs() < 1e-13 && piece.until > t
            );
            let (speed, acceleration) = drive.bounds(t, t + 0.3);
            for j in 0..=30 {
                let later = drive.at(t + 0.01 * f64::from(j));
                assert!(later.v.abs() <= speed + 1e-12 && later.a.abs() <= acceleration + 1e-9, "{t} {j}");
            }
        }
    }

    #[test]
    fn constant_speed() {
        let drive = Drive::Speed { start: 1.0, speed: -2.0 };
        assert_eq!(drive.at(3.0), Driven { q: -5.0, v: -2.0, a: 0.0 });
        assert_eq!((drive.bounds(0.0, 1.0), drive.next_knot(0.0)), ((2.0, 0.0), None));
    }
}
