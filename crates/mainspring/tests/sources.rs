//! Trajectories do not depend on where candidates come from: every example, to the last bit.

use mainspring::{
    CompileOptions, ContactSearch, Machine, Mechanism, SimulationOptions, SimulationResult, simulate,
};
use std::path::PathBuf;

/// All models of the examples.
fn models() -> Vec<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut found: Vec<PathBuf> = std::fs::read_dir(root)
        .unwrap()
        .flat_map(|folder| std::fs::read_dir(folder.unwrap().path()).into_iter().flatten())
        .map(|file| file.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "padl"))
        .collect();
    found.sort();
    found
}

fn run(mechanism: &Mechanism, search: ContactSearch) -> Result<SimulationResult, mainspring::Error> {
    let options = SimulationOptions { until: 6.0, max_steps: 20_000, search, ..SimulationOptions::default() };
    simulate(mechanism, &options, &mut |_| true)
}

#[test]
fn examples_move_the_same_with_maps_as_with_direct_search() {
    let mut moved = 0;
    for path in models() {
        let machine = Machine::load(&path, None).unwrap();
        let mechanism = Mechanism::compile(machine.into(), &[], &CompileOptions::default()).unwrap();
        let (direct, map) = (run(&mechanism, ContactSearch::Direct), run(&mechanism, ContactSearch::Map));
        let (Ok(direct), Ok(map)) = (direct, map) else { continue };
        assert_eq!(direct.json(false).to_string(), map.json(false).to_string(), "{path:?}");
        let bits = |times: &[f64]| times.iter().map(|t| t.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(direct.times()), bits(map.times()), "{path:?}");
        for t in direct.times() {
            let state = |run: &SimulationResult| {
                let (q, v) = run.at(*t);
                [bits(&q), bits(&v)]
            };
            assert_eq!(state(&direct), state(&map), "{path:?} at {t}");
        }
        moved += 1;
    }
    // The slider-crank is a closed chain, which is not simulated.
    assert!(moved >= 5, "{moved} examples moved");
}
