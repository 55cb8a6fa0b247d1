//! How far a map has come, and whether to give up: shared between the thread that makes it and the one that waits.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Nothing done, nobody stopping.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicU64,
    stop: AtomicBool,
}

impl Progress {
    /// The part done, 0 to 1: of all configurations those that have been looked at.
    pub fn done(&self) -> f64 {
        f64::from_bits(self.done.load(Ordering::Relaxed))
    }

    /// Asks to give up soon.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    pub(crate) fn tell(&self, done: f64) {
        self.done.store(done.to_bits(), Ordering::Relaxed);
    }

    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
