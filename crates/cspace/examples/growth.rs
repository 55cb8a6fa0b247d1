//! How the cost of a configuration space grows with the number of segments, and how fast points are located.
//!
//! ```text
//! cargo run --release -p mainspring-cspace --example growth [GREATEST]
//! ```
//! Two parts of n lines and arcs each, lobed or star-shaped, unlike at every corner (nothing repeats), and two toothed
//! wheels, with and without use of their period. One thread.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Random, body, path, polygon, star, system, turn};
use mainspring_cspace::{ConfigurationSpace, SpaceOptions};
use mainspring_mechanism::System;
use std::f64::consts::{PI, TAU};

/// Seconds that this thread has worked: unlike the clock's, the same on a busy machine.
fn worked() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|s| s.parse::<f64>().ok());
    nanoseconds.unwrap_or(f64::NAN) * 1e-9
}

/// Stars whose corners lie at random within `depth` of a circle; all round they meet in about its middle.
fn stars(n: usize, depth: f64) -> System {
    let mut random = Random(n as u64);
    let a = star(&mut random, (0.02, 0.01), 1.0 - depth, 1.0 + depth, n);
    let b = star(&mut random, (1.98, 0.02), 1.0 - depth, 1.0 + depth, n);
    let bodies = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![path(&a, 0)]),
        body("b", vec![turn(1, 2.0, 0.0)], vec![path(&b, 10_000)]),
    ];
    system(bodies, 4.0)
}

/// Outlines like those fitted to smooth shapes: lobes made of n short lines and arcs.
fn lobes(n: usize) -> System {
    let mut random = Random(n as u64);
    let mut part = |x: f64, waves: [(f64, f64); 3]| -> Vec<(f64, f64, f64)> {
        (0..n)
            .map(|i| {
                let a = i as f64 * TAU / n as f64;
                let wave =
                    |(k, (size, phase)): (usize, (f64, f64))| size * ((k + 2) as f64 * a + phase).cos();
                let r = 0.8 + waves.into_iter().enumerate().map(wave).sum::<f64>();
                let bulge = if i % 2 == 0 { random.next(0.0, 0.3) / n as f64 } else { 0.0 };
                (x + r * a.cos(), r * a.sin(), bulge)
            })
            .collect()
    };
    let a = part(0.0, [(0.12, 0.3), (0.1, 1.0), (0.04, 2.0)]);
    let b = part(1.6, [(0.1, 1.3), (0.08, 0.2), (0.06, 2.5)]);
    let bodies = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![path(&a, 0)]),
        body("b", vec![turn(1, 1.6, 0.0)], vec![path(&b, 10_000)]),
    ];
    system(bodies, 4.0)
}

/// Wheels of `n` slender teeth, four segments each.
fn wheels(n: usize) -> System {
    let wheel = |x: f64, phase: f64| {
        let profile = [(-0.2, -1.3), (-0.03, 1.0), (0.03, 1.0), (0.2, -1.3)];
        let corner = |i: usize, (off, height): (f64, f64)| {
            let a = (i as f64 + phase + off) * TAU / n as f64;
            (x + (n as f64 + height) * a.cos(), (n as f64 + height) * a.sin())
        };
        polygon(&(0..n).flat_map(|i| profile.map(|c| corner(i, c))).collect::<Vec<_>>())
    };
    let d = 2.0 * n as f64;
    let bodies = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![wheel(0.0, 0.0)]),
        body("b", vec![turn(1, d, 0.0)], vec![wheel(d, 0.5)]),
    ];
    system(bodies, 2.0 * d)
}

fn row(name: &str, n: usize, system: &System, options: &SpaceOptions) {
    let (start, mut times) = (worked(), 0.0);
    // The clock of a thread's work may be coarse.
    let (made, seconds) = loop {
        let made = ConfigurationSpace::new(system, [0, 1], [0, 1], options);
        times += 1.0;
        if worked() - start > 0.1 || times >= 1000.0 {
            break (made, (worked() - start) / times);
        }
    };
    match made {
        Err(e) => println!("{name:>16} {n:>6} {:>10.2} ms  {e}", 1e3 * seconds),
        Ok(map) => {
            let w = map.work();
            println!(
                "{name:>16} {n:>6} {:>10.2} ms {:>8} cells {:>8} blocked {:>8} leaves {:>8} pairs {:>8} curves {:>6} components {:>7.1} M/s",
                1e3 * seconds,
                w.cells,
                w.blocked,
                w.leaves,
                w.pairs,
                map.curves().len(),
                map.component_count(),
                located(&map),
            );
        }
    }
}

/// Million configurations a second, one at a time, over the whole torus.
fn located(map: &ConfigurationSpace) -> f64 {
    let mut random = Random(5);
    let points: Vec<[f64; 2]> =
        (0..2_000_000).map(|_| [random.next(-PI, PI), random.next(-PI, PI)]).collect();
    let start = worked();
    let free = map.are_free(&points).into_iter().filter(|f| *f).count();
    let rate = points.len() as f64 / (worked() - start) / 1e6;
    assert!(free <= points.len());
    rate
}

/// Time of ordinary pairs: two parts of three to nine lines and arcs.
fn ordinary() {
    let systems: Vec<System> = (0..200)
        .map(|k| {
            let mut random = Random(1000 + k);
            let (n, m) = (3 + random.below(7), 3 + random.below(7));
            let d = random.next(1.1, 1.9);
            let a = star(&mut random, (0.1, 0.1), 0.3, 1.0, n);
            let b = star(&mut random, (d, 0.1), 0.3, 1.0, m);
            let bodies = vec![
                body("a", vec![turn(0, 0.0, 0.0)], vec![path(&a, 0)]),
                body("b", vec![turn(1, d, 0.0)], vec![path(&b, 100)]),
            ];
            system(bodies, 2.0)
        })
        .collect();
    let start = worked();
    for system in &systems {
        assert!(ConfigurationSpace::new(system, [0, 1], [0, 1], &SpaceOptions::default()).is_ok());
    }
    println!("200 ordinary pairs: {:.2} ms each", 1e3 * (worked() - start) / 200.0);
}

fn main() {
    ordinary();
    let greatest: usize = std::env::args().nth(1).and_then(|s| s.parse().ok()).unwrap_or(1000);
    let whole = SpaceOptions { periodic: false, ..SpaceOptions::default() };
    let sizes = [10, 20, 50, 100, 200, 500, 1000, 2000];
    for n in sizes.into_iter().filter(|n| *n <= greatest) {
        row("lobes", n, &lobes(n), &whole);
    }
    for n in sizes.into_iter().filter(|n| *n <= greatest) {
        row("rough stars", n, &stars(n, 0.3), &whole);
    }
    // As rough as their sides are long: every tooth scrapes past every other.
    for n in sizes.into_iter().filter(|n| *n <= greatest) {
        row("scraping stars", n, &stars(n, (8.0 / n as f64).min(0.35)), &whole);
    }
    for n in [8, 16, 64, 250].into_iter().filter(|n| 4 * n <= greatest) {
        row("wheels", 4 * n, &wheels(n), &SpaceOptions::default());
        if n <= 64 {
            row("wheels, unfolded", 4 * n, &wheels(n), &whole);
        }
    }
    if let Ok(status) = std::fs::read_to_string("/proc/self/status") {
        let peak = status.lines().find(|l| l.starts_with("VmHWM"));
        println!("{}", peak.unwrap_or("peak of memory unknown"));
    }
}
