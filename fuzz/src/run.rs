//! Running many inputs and collecting what goes wrong.

use crate::input::{Input, Language, input};
use crate::target::TARGETS;
use mainspring_model::{Error, Machine};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What to run.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    pub language: Language,
    pub seed: u64,
    /// First input and number of inputs.
    pub from: u64,
    pub inputs: u64,
    pub threads: u64,
    /// How many of [`TARGETS`] are tried: 1 the model, 2 the compilation as well, 3 a short run.
    pub steps: usize,
    /// Longest time that an input may take.
    pub patience: Duration,
}

/// Longest time that a user should have to wait.
pub const SLOW: Duration = Duration::from_secs(5);

/// An input that went wrong.
#[derive(Clone, Debug)]
pub struct Failure {
    pub index: u64,
    pub what: String,
}

/// What happened.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    pub inputs: u64,
    /// Machines read, and handed to the first step.
    pub read: u64,
    /// Machines that every step accepted.
    pub accepted: u64,
    pub slowest: Duration,
    /// In the order of the inputs.
    pub failures: Vec<Failure>,
}

/// Runs all inputs on several threads; apart from times the result does not depend on their number.
pub fn run(options: Options) -> Summary {
    let threads = options.threads.max(1);
    let runs: Vec<Summary> = std::thread::scope(|scope| {
        let handles: Vec<_> =
            (0..threads).map(|t| scope.spawn(move || run_share(options, t, threads))).collect();
        handles.into_iter().map(|h| h.join().unwrap_or_default()).collect()
    });
    let mut total = Summary::default();
    for run in runs {
        total.inputs += run.inputs;
        total.read += run.read;
        total.accepted += run.accepted;
        total.slowest = total.slowest.max(run.slowest);
        total.failures.extend(run.failures);
    }
    total.failures.sort_by_key(|f| f.index);
    total
}

fn run_share(options: Options, thread: u64, threads: u64) -> Summary {
    let mut summary = Summary::default();
    for index in (options.from..options.from + options.inputs).filter(|i| i % threads == thread) {
        let given = input(options.language, options.seed, index);
        let (mut time, outcome) = timed(&given, options.steps);
        // On a busy machine a short way may take long; a long one takes long again.
        for _ in 0..AGAIN {
            if time > options.patience {
                time = time.min(timed(&given, options.steps).0);
            }
        }
        summary.inputs += 1;
        summary.slowest = summary.slowest.max(time);
        match outcome {
            Ok(reached) => {
                summary.read += u64::from(reached != Reached::Parser);
                summary.accepted += u64::from(reached == Reached::End);
            }
            Err(what) => summary.failures.push(Failure { index, what }),
        }
        if time > options.patience {
            summary.failures.push(Failure { index, what: format!("slow: {time:?}") });
        }
    }
    summary
}

/// How often a slow input is tried again.
const AGAIN: usize = 2;

fn timed(input: &Input, steps: usize) -> (Duration, Result<Reached, String>) {
    let start = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| try_input(input, steps)))
        .unwrap_or_else(|panic| Err(format!("panic: {}", panic_text(&*panic))));
    (start.elapsed(), outcome)
}

/// How far an input came.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reached {
    Parser,
    Steps,
    End,
}

fn try_input(input: &Input, steps: usize) -> Result<Reached, String> {
    let supplement = input.supplement.as_deref().map(|s| ("m.sup", s));
    let machine = match Machine::parse(input.language.file(), &input.model, supplement) {
        Err(e) => return check_error(&e, input).map(|()| Reached::Parser),
        Ok(machine) => Arc::new(machine),
    };
    for target in TARGETS.iter().take(steps) {
        if let Some(e) = (target.check)(&machine).map_err(|e| format!("{}: {e}", target.name))? {
            return check_error(&e, input).map(|()| Reached::Steps);
        }
    }
    Ok(Reached::End)
}

/// The rules for messages: one short line, a place inside the file, what was expected, nothing unprintable.
fn check_error(error: &Error, input: &Input) -> Result<(), String> {
    let shown = error.to_string();
    let bytes = match error.file.as_str() {
        "m.padl" | "m.toml" => Some(&input.model),
        "m.sup" => input.supplement.as_ref(),
        _ => None,
    };
    let Some(bytes) = bytes else { return Err(format!("unknown file: {shown}")) };
    let lines = bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count() + 1;
    let inside = (1..=lines).contains(&(error.line as usize))
        && (1..=bytes.len() + 1).contains(&(error.column as usize));
    if !inside {
        return Err(format!("place outside the file: {shown}"));
    }
    if shown.len() > 400 || shown.chars().any(char::is_control) || !shown.contains("expected ") {
        return Err(format!("ill-formed message: {shown:?}"));
    }
    Ok(())
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("?").to_string()
}
