//! What was found lately: likely to be found again in the next place looked at.

/// Finds remembered.
const REMEMBERED: usize = 8;

/// The last finds, in no order.
#[derive(Debug)]
pub(crate) struct Recent<T> {
    found: [Option<T>; REMEMBERED],
    next: usize,
}

impl<T> Default for Recent<T> {
    fn default() -> Self {
        Recent { found: [const { None }; REMEMBERED], next: 0 }
    }
}

impl<T> Recent<T> {
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.found.iter().flatten()
    }

    /// Takes the place of the oldest.
    pub fn remember(&mut self, find: T) {
        self.found[self.next % REMEMBERED] = Some(find);
        self.next += 1;
    }
}
