//! The map against the overlap tests of a library of polygons: random parts of every kind, most of the configurations close
//! to the curves. The full run is `cargo run --release -p mainspring-cspace --example oracle`.

mod common;

use common::{Random, check, pairs};
use mainspring_cspace::{ConfigurationSpace, SpaceError};

#[test]
fn random_pairs_agree() {
    let mut total = check::Tally::default();
    for seed in 0..200 {
        let (system, options, name) = pairs::pair(seed);
        let space = match ConfigurationSpace::new(&system, [0, 1], [0, 1], &options) {
            Ok(space) => space,
            Err(SpaceError::Degenerate { .. }) => continue,
            Err(other) => panic!("{name}: {other}"),
        };
        let found = check::compare(&space, &system, &mut Random(seed + 7), 60);
        assert!(found.wrong.is_empty(), "{name}: {:?}", found.wrong);
        total.add(found);
    }
    assert!(total.configurations > 10_000 && total.near > 3_000, "{} {}", total.configurations, total.near);
    assert!(total.free > 2_000 && total.free < total.configurations - 2_000, "{}", total.free);
}
