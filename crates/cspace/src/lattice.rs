//! Lattices of windings: subgroups of Z², in Hermite normal form.

/// A subgroup of Z² by at most two generators `(a, b)` and `(0, d)`, or one of them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lattice {
    basis: Vec<[i64; 2]>,
}

fn gcd(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Lattice {
    pub fn generators(&self) -> &[[i64; 2]] {
        &self.basis
    }

    /// Adds a generator.
    pub fn add(&mut self, g: [i64; 2]) {
        if g == [0, 0] {
            return;
        }
        let mut rows = std::mem::take(&mut self.basis);
        rows.push(g);
        // Euclid on the first column leaves one row with a first entry.
        let (mut top, mut below) = ([0i64, 0], 0);
        for mut row in rows {
            while row[0] != 0 {
                if top[0] != 0 {
                    let q = top[0].div_euclid(row[0]);
                    top = [top[0] - q * row[0], top[1] - q * row[1]];
                }
                std::mem::swap(&mut top, &mut row);
            }
            below = gcd(below, row[1]);
        }
        if top[0] < 0 {
            top = [-top[0], -top[1]];
        }
        if below != 0 {
            top[1] = top[1].rem_euclid(below);
        }
        if top[0] != 0 {
            self.basis.push(top);
        }
        if below != 0 {
            self.basis.push([0, below]);
        }
    }

    /// Number of cosets in Z² of the lattice together with `(n, 0)` and `(0, m)`.
    pub fn cosets(&self, n: i64, m: i64) -> i64 {
        let mut all = self.clone();
        all.add([n, 0]);
        all.add([0, m]);
        all.basis.iter().enumerate().map(|(i, g)| g[i]).product()
    }

    /// The part that lies in n Z × m Z, counted in units of n and m.
    pub fn within(&self, n: i64, m: i64) -> Lattice {
        let mut part = Lattice::default();
        let d = self.basis.iter().find(|g| g[0] == 0).map_or(0, |g| g[1]);
        if d != 0 {
            part.add([0, d / gcd(d, m)]);
        }
        let Some([a, b]) = self.basis.iter().find(|g| g[0] != 0).copied() else { return part };
        for k in 1..=n * m {
            if k * a % n != 0 {
                continue;
            }
            // k (a, b) + j (0, d) in the grid for some j?
            if let Some(j) = (0..m).find(|j| (k * b + j * d) % m == 0) {
                part.add([k * a / n, (k * b + j * d) / m]);
                break;
            }
        }
        part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hermite_form_does_not_depend_on_the_order() {
        let gens = [[4, 6], [6, 3], [0, 9], [-2, 3]];
        let mut one = Lattice::default();
        let mut two = Lattice::default();
        gens.iter().for_each(|g| one.add(*g));
        gens.iter().rev().for_each(|g| two.add(*g));
        assert_eq!(one, two);
        assert_eq!(one.cosets(1_000_000_007, 1_000_000_007), 1);
    }

    #[test]
    fn a_diagonal_in_a_folded_torus() {
        // Gears of 10 and 15 teeth: one channel per pair of periods, with slope −1.
        let mut l = Lattice::default();
        l.add([1, -1]);
        assert_eq!(l.cosets(10, 15), 5);
        assert_eq!(l.within(10, 15).generators(), &[[3, -2]]);
        assert_eq!(l.cosets(1, 1), 1);
    }
}
