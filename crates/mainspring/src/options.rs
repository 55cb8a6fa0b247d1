//! Options that make no sense are bad input, told like any other: what a run may be asked for.

use crate::SimulationOptions;
use mainspring_behavior::PredictOptions;
use mainspring_mechanism::ContactLaw;
use mainspring_model::Error;

/// Tolerances that can be kept: below, rounding of the states themselves is larger; above, contacts are guesses.
const RTOL: (f64, f64) = (1e-13, 1e-2);

/// Refuses a simulation that cannot be done as asked.
pub(crate) fn check_simulation(options: &SimulationOptions) -> Result<(), Error> {
    positive("--until", options.until)
}

/// Refuses a prediction that cannot be done as asked.
pub(crate) fn check_prediction(options: &PredictOptions) -> Result<(), Error> {
    let matching = &options.matching;
    whole("--confirm", u64::from(matching.confirm))?;
    whole("--max-minima", options.max_minima as u64)?;
    positive("--max-time", options.max_time)?;
    fraction("--range-fraction", matching.range_fraction)?;
    fraction("--time-match", matching.time_match)?;
    fraction("--state-match", matching.state_match)
}

/// Refuses a relative tolerance that cannot be kept.
pub(crate) fn check_tolerance(rtol: f64) -> Result<(), Error> {
    let (low, high) = RTOL;
    let what = format!("the relative tolerance is {rtol}; expected a number from {low:e} to {high:e}");
    require((low..=high).contains(&rtol), "--rtol", what)
}

/// Refuses constants of compliant contact that make no force.
pub(crate) fn check_law(law: &ContactLaw) -> Result<(), Error> {
    let ContactLaw { e, d, m } = *law;
    let fits = e > 0.0 && d >= 0.0 && m >= 0.0 && [e, d, m, d * m].iter().all(|x| x.is_finite());
    let what = format!(
        "the constants are E {e}, D {d}, M {m}; expected E above 0, D and M not negative, all finite"
    );
    require(fits, "--contact-constants", what)
}

fn positive(option: &str, value: f64) -> Result<(), Error> {
    let what = format!("the time is {value}; expected a finite number above 0");
    require(value > 0.0 && value.is_finite(), option, what)
}

fn whole(option: &str, value: u64) -> Result<(), Error> {
    require(value >= 1, option, format!("the count is {value}; expected at least 1"))
}

fn fraction(option: &str, value: f64) -> Result<(), Error> {
    let what = format!("the fraction is {value}; expected a number above 0 and up to 1");
    require(value > 0.0 && value <= 1.0, option, what)
}

fn require(holds: bool, option: &str, message: String) -> Result<(), Error> {
    if holds {
        return Ok(());
    }
    Err(Error { file: option.into(), line: 1, column: 1, message })
}
