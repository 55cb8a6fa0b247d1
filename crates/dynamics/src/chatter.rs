//! Chatter that dies out: contacts that close and open in ever shorter times (Zeno), ended where excursions can no
//! longer be told apart from closed. Every blow counts, also one of a contact that never was seen open since the last
//! (a flat part that rocks to rest from corner to corner).

use crate::impact::Impulse;
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
    /// Notes the blows of an instant at time `t`. If one belongs to a chatter that has come to its end: the rate up to
    /// which contacts count as part of it. `size` is the machine's.
    pub fn ends(&mut self, t: f64, size: f64, blows: &[Impulse]) -> Option<f64> {
        let mut ended = None;
        for blow in blows {
            if self.closes(blow.candidate.id, t, blow.rate, size) {
                // Bodies of unlike inertia throw each other faster than they meet.
                ended = Some(f64::max(ended.unwrap_or(0.0), 100.0 * blow.rate.abs()));
            }
        }
        ended
    }

    /// Notes that a contact closes at time `t` with a closing rate; true when it has become a chatter.
    fn closes(&mut self, id: ContactId, t: f64, rate: f64, size: f64) -> bool {
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
