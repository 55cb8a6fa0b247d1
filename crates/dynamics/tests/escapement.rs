//! The escapement of Gelsey's Fig. 12 with the supplement of Fig. 13: times, energy, work, variations, run-down.
//!
//! Expected times come from a separate event-driven calculation that shares no code with this one.

mod common;

use common::{
    balanced, changed_escapements, close, escapement, escapement_with, fig_13, low_minima, overlap, run,
};
use mainspring_dynamics::{EventKind, Run, Status};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

const MINIMA: [f64; 10] = [
    3.684_622_024_9,
    7.382_005_208_0,
    11.068_292_051_7,
    14.764_723_953_7,
    18.453_845_156_6,
    22.150_282_307_9,
    25.839_471_465_9,
    29.535_931_552_0,
    33.225_135_312_5,
    36.921_618_807_1,
];

fn times(run: &Run) -> Vec<f64> {
    low_minima(run).iter().map(|m| m.t).collect()
}

/// The ten minima of the kinetic energy agree with an independent calculation, better with a closer tolerance.
#[test]
fn minima_come_when_they_should() {
    for (rtol, allowed) in [(1e-8, 1e-7), (1e-10, 1e-8)] {
        let found = times(&run(&escapement(), 37.0, rtol));
        assert_eq!(found.len(), MINIMA.len(), "{found:?}");
        found.iter().zip(MINIMA).for_each(|(t, expected)| close(*t, expected, allowed));
    }
}

/// From a tolerance of 1e-6 to one of 1e-12 the tenth minimum moves by less than 1e-5.
#[test]
fn results_converge_with_the_tolerance() {
    let tenth: Vec<f64> =
        [1e-6, 1e-8, 1e-10, 1e-12].map(|rtol| times(&run(&escapement(), 37.0, rtol))[9]).into();
    let finest = tenth[3];
    tenth.iter().for_each(|t| close(*t, finest, 1e-5));
    close(tenth[2], finest, 1e-8);
}

/// 37 s take at most 100,000 gap evaluations, the energy balances, and no part ever enters another.
#[test]
fn work_is_small_energy_balances_and_nothing_overlaps() {
    let system = escapement();
    let found = run(&system, 37.0, 1e-8);
    assert_eq!(found.status, Status::Complete);
    assert!(found.stats.gap_evaluations <= 100_000, "{:?}", found.stats);
    balanced(&found);
    overlap::assert_never_overlaps(&system, &found, 3);
}

/// Between a minimum and the next but one, contacts close and release about twenty times, never more than thirty.
#[test]
fn a_pattern_has_few_contact_changes() {
    let found = run(&escapement(), 120.0, 1e-8);
    let minima = times(&found);
    for pair in minima.windows(3) {
        let inside = |t: f64| t > pair[0] && t <= pair[2];
        let changes = found.events.iter().filter(|e| e.kind != EventKind::Impact && inside(e.t)).count();
        assert!((10..=30).contains(&changes), "{changes} changes from {} to {}", pair[0], pair[2]);
    }
}

/// Under a torque that does not fade, periods settle to 7.3854288 and repeat to 1e-6.
#[test]
fn constant_torque_gives_constant_periods() {
    let mut coordinates = fig_13();
    coordinates[0] = common::coordinate("ewheel", 200.0, 20.0, (0.02, -1e7 * DEGREE));
    let found = run(&escapement_with(coordinates), 150.0, 1e-9);
    let minima = times(&found);
    let late: Vec<f64> = minima[30..].windows(3).map(|w| w[2] - w[0]).collect();
    assert!(late.len() > 5);
    // Drawing the spring down by one turn of 1e7 degrees changes the torque by 4e-5 of itself.
    late.iter().for_each(|d| close(*d, 7.385_428_8, 2e-6));
    late.windows(2).for_each(|w| close(w[0], w[1], 1e-6));
    balanced(&found);
}

/// With another balance or mainspring the machine ticks with another period, as calculated independently.
#[test]
fn changed_machines_tick_otherwise() {
    for (system, expected) in changed_escapements() {
        let found = run(&system, expected + 0.5, 1e-9);
        close(times(&found)[9], expected, 1e-6);
        balanced(&found);
    }
}

/// The whole run-down ends at rest: the wheel where its spring is relaxed, the balance where its own is, the minima
/// on the way at the calculated times.
#[test]
fn the_spring_runs_down() {
    let system = escapement();
    let found = run(&system, 1e5, 1e-8);
    assert_eq!(found.status, Status::AtRest);
    // The wheel creeps towards its equilibrium for ever: rest is declared at 1e-13 of the energy.
    close(found.q[0] / DEGREE, -10_000.0, 1e-3);
    close(found.q[1] / DEGREE, -4.700_345_18, 1e-6);
    close(found.q[2] / DEGREE, 90.0, 1e-3);
    let minima = times(&found);
    close(minima[299], 1_108.410_347, 1e-5);
    close(minima[499], 1_849.182_794, 1e-5);
    let last = found.events.last().unwrap().t;
    close(last, 2_079.775, 0.05);
    let worst = minima.windows(3).map(|w| {
        let inside = |t: f64| t > w[0] && t <= w[2];
        found.events.iter().filter(|e| e.kind != EventKind::Impact && inside(e.t)).count()
    });
    assert!(worst.max().unwrap() <= 30);
    // 10000 degrees are 277 teeth and a bit: later minima are those of the balance swinging to rest.
    let wheel: Vec<f64> = low_minima(&found).iter().map(|m| m.q[0] / DEGREE).collect();
    let patterns = wheel.windows(3).step_by(2).filter(|w| (w[2] - w[0] + 36.0).abs() < 1.0).count();
    assert!((200..=277).contains(&patterns), "{patterns}");
    balanced(&found);
}

/// The same machine twice gives the same run to the last bit.
#[test]
fn runs_are_deterministic() {
    let (a, b) = (run(&escapement(), 20.0, 1e-8), run(&escapement(), 20.0, 1e-8));
    assert_eq!(a.trajectory, b.trajectory);
    assert_eq!(a.events, b.events);
    assert_eq!((a.q, a.v, a.stats), (b.q, b.v, b.stats));
}
