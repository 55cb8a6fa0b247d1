//! What a prediction may cost, and how closely patterns must match.

use crate::terms::MatchOptions;
use mainspring_dynamics::Contact;

/// Options of `predict`.
#[derive(Clone, Debug, PartialEq)]
pub struct PredictOptions {
    pub matching: MatchOptions,
    pub contact: Contact,
    /// Relative tolerance of integration.
    pub rtol: f64,
    /// Gives up after this many minima (of any series of points).
    pub max_minima: usize,
    /// Gives up after this time, in the file's unit.
    pub max_time: f64,
    /// Gives up after this many steps.
    pub max_steps: u64,
}

impl Default for PredictOptions {
    fn default() -> Self {
        Self {
            matching: MatchOptions::default(),
            contact: Contact::Rigid,
            rtol: 1e-8,
            max_minima: 1000,
            max_time: 1e5,
            max_steps: 2_000_000,
        }
    }
}
