//! The work one compilation may cost, so that hostile input ends in a warning and not in a wait.

use std::cell::Cell;

/// What is left of an allowance. One unit is one primitive looked at: some forty nanoseconds.
#[derive(Debug)]
pub(crate) struct Work {
    left: Cell<u64>,
    /// Of these, what the question at hand may still cost.
    share: Cell<u64>,
    ran_out: Cell<bool>,
}

impl Work {
    /// `total` units in all.
    pub(crate) fn new(total: u64) -> Self {
        Self { left: Cell::new(total), share: Cell::new(total), ran_out: Cell::new(false) }
    }

    /// Starts a new question, which may cost at most `share` of what is left.
    pub(crate) fn open(&self, share: u64) {
        self.share.set(share.min(self.left.get()));
        self.ran_out.set(false);
    }

    /// Spends some units; false if there are not that many, and from then on until the next question.
    pub(crate) fn spend(&self, units: usize) -> bool {
        let units = units as u64;
        if self.ran_out.get() || units > self.share.get() {
            self.ran_out.set(true);
            return false;
        }
        self.share.set(self.share.get() - units);
        self.left.set(self.left.get() - units);
        true
    }

    /// Did the question at hand cost more than it may?
    pub(crate) fn ran_out(&self) -> bool {
        self.ran_out.get()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_that_costs_too_much_leaves_the_rest_to_others() {
        let work = Work::new(10);
        work.open(6);
        assert!(work.spend(6) && !work.ran_out());
        assert!(!work.spend(1) && work.ran_out());
        work.open(6);
        assert!(!work.ran_out() && work.spend(4));
        assert!(!work.spend(1));
    }
}
