//! A short run of the fuzzer.

use mainspring_fuzz::{Options, SLOW, input, run};
use std::time::Duration;

/// Without optimization, on a busy machine.
const PATIENCE: Duration = SLOW.saturating_mul(12);

#[test]
fn twenty_thousand_inputs() {
    let summary =
        run(Options { seed: 20_26, from: 0, inputs: 20_000, threads: 2, steps: 1, patience: PATIENCE });
    let shown: Vec<String> = summary.failures.iter().map(|f| format!("{}: {}", f.index, f.what)).collect();
    assert!(shown.is_empty(), "{shown:#?}");
    // A fuzzer whose inputs are all refused at once, or all accepted, tries nothing.
    assert!((3_000..17_000).contains(&summary.accepted), "{} accepted", summary.accepted);
}

#[test]
fn inputs_do_not_change() {
    assert_eq!(input(1, 7), input(1, 7));
    assert_ne!(input(1, 7), input(1, 8));
    assert_ne!(input(1, 7), input(2, 7));
}

#[test]
fn a_few_machines_compiled() {
    let summary =
        run(Options { seed: 20_26, from: 0, inputs: 400, threads: 2, steps: 2, patience: PATIENCE });
    let shown: Vec<String> = summary.failures.iter().map(|f| format!("{}: {}", f.index, f.what)).collect();
    assert!(shown.is_empty(), "{shown:#?}");
    assert!(summary.accepted > 30 && summary.accepted < summary.read, "{summary:?}");
}
