//! Machines on which the fuzzer found that compiling took minutes, kept so that it never does again.

mod support;

use mainspring_mechanism::Warning;
use std::time::{Duration, Instant};
use support::{compile, try_compile};

/// Far above what is needed, also without optimization on a busy machine; far below what it was.
const PATIENCE: Duration = Duration::from_secs(60);

const OVERLAP: &str = " overlap at the start, near ";

/// Compiles a kept machine, which must end soon in one message saying `what`.
fn ends_in(what: &str, text: &str) {
    let start = Instant::now();
    let error = try_compile(text, "", &Default::default()).expect_err("a machine full of faults").to_string();
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    let place = error.strip_prefix("test.padl:").and_then(|e| e.split_once(": error: ")).map(|e| e.0);
    assert!(place.is_some_and(|p| p.contains(':')) && error.contains(what), "{error}");
}

/// Two minutes: every face of some hundred wedges, cones and spheres, most of them copies lying on each other,
/// was held against every other, each time with all primitives that reach there.
#[test]
fn wedges_and_spheres_that_share_their_faces() {
    ends_in(OVERLAP, include_str!("fuzzed/wedges_and_spheres.padl"));
}

/// 25 seconds: copies turned by an odd angle make new planes, whose crossings were all looked for.
#[test]
fn tilted_copies() {
    ends_in(OVERLAP, include_str!("fuzzed/tilted_copies.padl"));
}

/// Rows of rows of copies, marked as a gear: each of its cylinders was compared with all its primitives.
#[test]
fn rows_of_copies() {
    ends_in(
        "too many primitives to tell on which side its teeth are",
        include_str!("fuzzed/rows_of_copies.padl"),
    );
}

/// A minute: thousands of cylinders on one axis, each held against each other with all primitives around them.
/// The work runs out, and the user is told.
#[test]
fn shafts_beside_shafts() {
    let start = Instant::now();
    let mechanism = compile(include_str!("fuzzed/shafts_beside_shafts.padl"));
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    let told = |w: &Warning| w.message.contains("only the first were examined") && w.parts.len() == 2;
    assert!(mechanism.warnings.iter().any(told), "{:?}", mechanism.warnings);
}

/// Eleven seconds: a part that is planar in no direction was integrated by columns, and in each column every span
/// between two walls asked the whole set expression again.
#[test]
fn a_tilted_part_with_a_density() {
    let start = Instant::now();
    let mechanism = compile(include_str!("fuzzed/tilted_with_a_density.padl"));
    assert!(start.elapsed() < PATIENCE, "{:?}", start.elapsed());
    assert!(mechanism.parts.iter().any(|p| p.inertia_from_density));
    let told = |w: &Warning| w.message.contains("is not known better than to 0.1");
    assert!(mechanism.warnings.iter().any(told), "{:?}", mechanism.warnings);
}

/// Six seconds for one outline: a block copied over itself five hundred times, each edge asked of all copies that
/// hold its middle.
#[test]
fn copies_of_copies() {
    ends_in(OVERLAP, include_str!("fuzzed/copies_of_copies.padl"));
}
