//! A deterministic fuzzer for what users hand in: input i of a seed is always the same bytes.
//!
//! Inputs are mutated examples, random programs of the language, random machines in both forms, token soup and random bytes ([`input`]). Each is
//! given to every [`Target`]; a panic, an error that breaks the rules for messages, a broken promise of the model,
//! or more than a given time is a failure ([`run`]).

mod drafting;
mod input;
mod program;
mod random;
mod run;
mod soup;
mod target;
mod workshop;

pub use input::{Input, Language, input};
pub use random::Random;
pub use run::{Failure, Options, SLOW, Summary, run};
pub use target::{TARGETS, Target};
