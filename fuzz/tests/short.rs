//! A short run of the fuzzer.

use mainspring_fuzz::{Language, Options, SLOW, Summary, input, run};
use std::time::Duration;

/// Without optimization, on a busy machine.
const PATIENCE: Duration = SLOW.saturating_mul(12);

fn tried(language: Language, inputs: u64, steps: usize) -> Summary {
    let options = Options { language, seed: 20_26, from: 0, inputs, threads: 2, steps, patience: PATIENCE };
    let summary = run(options);
    let shown: Vec<String> = summary.failures.iter().map(|f| format!("{}: {}", f.index, f.what)).collect();
    assert!(shown.is_empty(), "{shown:#?}");
    summary
}

#[test]
fn twenty_thousand_inputs() {
    let summary = tried(Language::Padl, 20_000, 1);
    // A fuzzer whose inputs are all refused at once, or all accepted, tries nothing.
    assert!((3_000..17_000).contains(&summary.accepted), "{} accepted", summary.accepted);
}

#[test]
fn ten_thousand_inputs_in_toml() {
    let summary = tried(Language::Toml, 10_000, 1);
    assert!((700..8_500).contains(&summary.accepted), "{} accepted", summary.accepted);
}

#[test]
fn inputs_do_not_change() {
    for language in [Language::Padl, Language::Toml] {
        assert_eq!(input(language, 1, 7), input(language, 1, 7));
        assert_ne!(input(language, 1, 7), input(language, 1, 8));
        assert_ne!(input(language, 1, 7), input(language, 2, 7));
    }
}

#[test]
fn a_few_machines_compiled() {
    for language in [Language::Padl, Language::Toml] {
        let summary = tried(language, 400, 2);
        assert!(summary.accepted > 30 && summary.accepted < summary.read, "{summary:?}");
    }
}
