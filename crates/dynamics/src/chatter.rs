//! Chatter that dies out: contacts that close and open in ever shorter times (Zeno), ended where excursions can no
//! longer be told apart from closed.

use crate::search::CLOSED;
use mainspring_mechanism::ContactId;

/// Closings in a row, each after an excursion of no more than `CLOSED`, that make a chatter.
const MANY: u32 = 4;

/// The last closing of each contact.
#[derive(Clone, Debug, Default)]
pub struct Chatter {
    last: Vec<(ContactId, f64, u32)>,
}

impl Chatter {
    /// Notes that a contact closes at time `t` with a closing rate; true when it has become a chatter. `size` is
    /// the machine's.
    pub fn closes(&mut self, id: ContactId, t: f64, rate: f64, size: f64) -> bool {
        let Some(entry) = self.last.iter_mut().find(|e| e.0 == id) else {
            self.last.push((id, t, 0));
            return false;
        };
        // Thrown with about this rate and brought back: it went no further than rate · time / 4.
        let excursion = 0.25 * rate.abs() * (t - entry.1);
        *entry = (id, t, if excursion <= 2.0 * CLOSED * size { entry.2 + 1 } else { 0 });
        entry.2 >= MANY
    }
}
