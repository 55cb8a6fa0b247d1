//! The work outlines may cost, so that hostile input ends in an error and not in a wait.

use crate::OutlineError;

/// What is left of an allowance for outlines: [`OutlineError::TooComplex`] when one of its parts is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutlineBudget {
    /// Pairs of neighbouring curves, some 50 nanoseconds each.
    pub(crate) pairs: usize,
    /// Common points of curves, some 500 nanoseconds each.
    pub(crate) points: usize,
    /// Point-in-primitive tests, some 50 nanoseconds each.
    pub(crate) probes: usize,
}

impl Default for OutlineBudget {
    /// What one outline may cost: about two seconds.
    fn default() -> Self {
        Self { pairs: 4_000_000, points: 1_000_000, probes: 32_000_000 }
    }
}

impl OutlineBudget {
    /// An allowance half as large.
    pub fn halved(&self) -> Self {
        Self { pairs: self.pairs / 2, points: self.points / 2, probes: self.probes / 2 }
    }

    /// Lets one question of several cost at most half of what is left, so that no part of a machine takes what all
    /// others need.
    pub fn half<T>(&mut self, ask: impl FnOnce(&mut Self) -> T) -> T {
        let given = self.halved();
        let mut left = given;
        let answer = ask(&mut left);
        self.pairs -= given.pairs - left.pairs;
        self.points -= given.points - left.points;
        self.probes -= given.probes - left.probes;
        answer
    }

    pub(crate) fn spend_pairs(&mut self, n: usize) -> Result<(), OutlineError> {
        spend(&mut self.pairs, n)
    }

    pub(crate) fn spend_points(&mut self, n: usize) -> Result<(), OutlineError> {
        spend(&mut self.points, n)
    }

    pub(crate) fn spend_probes(&mut self, n: usize) -> Result<(), OutlineError> {
        spend(&mut self.probes, n)
    }
}

fn spend(left: &mut usize, n: usize) -> Result<(), OutlineError> {
    *left = left.checked_sub(n).ok_or(OutlineError::TooComplex)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_is_left_to_others() {
        let mut budget = OutlineBudget { pairs: 8, points: 8, probes: 8 };
        assert_eq!(budget.half(|b| b.spend_probes(5)), Err(OutlineError::TooComplex));
        assert_eq!(budget.half(|b| b.spend_probes(4)), Ok(()));
        assert_eq!(budget, OutlineBudget { pairs: 8, points: 8, probes: 4 });
    }
}
