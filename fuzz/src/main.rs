//! `cargo run --release -p mainspring-fuzz -- --inputs 1000000 --seed 1`
//!
//! With `--steps 2` accepted machines are compiled as well, with `--steps 3` they are inspected and run for some
//! steps; without it only the model is tried.
//! With `--language toml` the machines are in TOML.
//! With `--show N` input N is printed instead. Ends with 1 if anything failed.

use mainspring_fuzz::{Language, Options, SLOW, Summary, input, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match parse(&arguments) {
        Err(message) => {
            eprintln!(
                "{message}; expected [--language padl|toml] [--inputs N] [--seed N] [--from N] [--threads N] [--steps N] [--show N]"
            );
            ExitCode::from(2)
        }
        Ok((options, Some(index))) => {
            let input = input(options.language, options.seed, index);
            println!("{}", String::from_utf8_lossy(&input.model));
            println!("---- supplement\n{}", String::from_utf8_lossy(&input.supplement.unwrap_or_default()));
            ExitCode::SUCCESS
        }
        Ok((options, None)) => report(&run(options), options.seed),
    }
}

fn parse(arguments: &[String]) -> Result<(Options, Option<u64>), String> {
    let language = Language::default();
    let mut options =
        Options { language, seed: 1, from: 0, inputs: 20_000, threads: 2, steps: 1, patience: SLOW };
    let mut show = None;
    for pair in arguments.chunks(2) {
        let [name, value] = pair else { return Err(format!("{} without a value", pair[0])) };
        if name == "--language" {
            options.language = match value.as_str() {
                "padl" => Language::Padl,
                "toml" => Language::Toml,
                _ => return Err(format!("no language {value}")),
            };
            continue;
        }
        let number: u64 = value.parse().map_err(|_| format!("{value} is not a number"))?;
        match name.as_str() {
            "--inputs" => options.inputs = number,
            "--seed" => options.seed = number,
            "--from" => options.from = number,
            "--threads" => options.threads = number,
            "--steps" => options.steps = number as usize,
            "--show" => show = Some(number),
            _ => return Err(format!("no option {name}")),
        }
    }
    Ok((options, show))
}

/// Greatest memory that a run may have used, in KiB: 1 GiB.
const MEMORY: u64 = 1024 * 1024;

fn report(summary: &Summary, seed: u64) -> ExitCode {
    for failure in &summary.failures {
        println!("input {} of seed {seed}: {}", failure.index, failure.what);
    }
    let memory = peak_memory();
    let used = memory.map_or("unknown memory".to_string(), |kib| format!("at most {} MiB", kib / 1024));
    let Summary { inputs, read, accepted, slowest, failures } = summary;
    println!(
        "{inputs} inputs, {read} read, {accepted} accepted, {} failures, slowest {} ms, {used}",
        failures.len(),
        slowest.as_millis()
    );
    let fits = memory.is_none_or(|kib| kib < MEMORY);
    if failures.is_empty() && fits { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Peak resident memory in KiB, where the system tells it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
