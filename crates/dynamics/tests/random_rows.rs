//! Rows of blocks with everything that can act on them, drawn at random: every run ends as it should, its energy account
//! closes, nothing overlaps, and what dry friction holds is held by no more than it can.

mod common;

use common::{Random, bodies, coordinate, overlap, slide};
use mainspring_dynamics::{Options, Run, Simulation, Status};
use mainspring_mechanism::{Coordinate, Drive, Forces, Joint, Stop, System, Table};

const BLOCKS: usize = 3;

/// Blocks of unit length along x, `gap` apart, each with what chance gives it.
fn row(random: &mut Random) -> System {
    let chance = |random: &mut Random, p: f64| random.next(0.0, 1.0) < p;
    let gap = if chance(random, 0.2) { 0.0 } else { random.next(0.1, 1.0) };
    let names: Vec<String> = (0..BLOCKS).map(|k| format!("b{k}")).collect();
    let solids: String =
        (0..BLOCKS).map(|k| format!("b{k} = blo() at (movx={})\n", k as f64 * (1.0 + gap))).collect();
    let text = format!(
        "generic m(m)\n{solids}f = blo() at (movy=9)\nattr f : frame = 1\nm = {} asb f\n",
        names.join(" asb ")
    );
    let joints: Vec<(&str, Joint)> =
        names.iter().enumerate().map(|(k, n)| (n.as_str(), slide(k, 1.0, 0.0))).collect();
    let mut forces = Forces::none(BLOCKS);
    let mut coordinates: Vec<Coordinate> = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let damping = if chance(random, 0.5) { random.next(0.0, 1.0) } else { 0.0 };
        let spring =
            if chance(random, 0.6) { (random.next(1.0, 20.0), random.next(-1.0, 1.0)) } else { (0.0, 0.0) };
        let mut c = coordinate(name, random.next(0.3, 3.0), damping, spring);
        if chance(random, 0.5) {
            forces.applied[k] = random.next(-3.0, 3.0);
            c.force += forces.applied[k];
        }
        if chance(random, 0.6) {
            forces.coulomb[k] = random.next(0.1, 3.0);
        }
        if chance(random, 0.6) {
            c.velocity = random.next(-2.0, 2.0);
        }
        let mut stop = |limit: f64, upper: bool| {
            let side = if upper { -1.0 } else { 1.0 };
            forces.stops.push(Stop { coordinate: k, bodies: (k, BLOCKS), upper, limit, lever: 1.0, side });
        };
        if chance(random, 0.4) {
            stop(-random.next(0.0, 1.5), false);
        }
        if chance(random, 0.4) {
            stop(random.next(0.0, 1.5), true);
        }
        coordinates.push(c);
    }
    if chance(random, 0.4) {
        let k = (random.next(0.0, BLOCKS as f64) as usize).min(BLOCKS - 1);
        let drive = if chance(random, 0.3) {
            Drive::Speed { start: 0.0, speed: random.next(-0.3, 0.3) }
        } else {
            let points: Vec<(f64, f64)> = (0..5)
                .map(|n| (0.8 * f64::from(n), if n == 0 { 0.0 } else { random.next(-1.0, 1.0) }))
                .collect();
            Drive::Table(Table::new(&points))
        };
        forces.drives[k] = Some(drive);
        forces.stops.retain(|s| s.coordinate != k);
    }
    System::new(coordinates, bodies(&text, &joints), &[], 10.0).with_forces(forces)
}

fn simulate(system: &System, rtol: f64) -> Run {
    let source = system.direct_search();
    let limits = Options { until: 6.0, max_steps: 20_000, rtol };
    let mut run = Simulation::new(system, &source, limits);
    run.run(&mut |_| true);
    run.into_run()
}

#[test]
fn random_rows_of_blocks() {
    let mut ended = [0; 3];
    for seed in 0..1000 {
        let system = row(&mut Random(seed * 7919 + 1));
        // The energy of springs is told more closely than the default tolerance asks for.
        check(&system, &simulate(&system, 1e-9), 1e-7, &format!("seed {seed}"), &mut ended);
    }
    assert!(ended.iter().all(|n| *n > 20), "{ended:?}");
}

/// Loose tolerances give up accuracy, never a contact.
#[test]
fn loose_tolerances_miss_no_contact() {
    let mut ended = [0; 3];
    for seed in 0..1000 {
        let system = row(&mut Random(seed * 7919 + 1));
        check(&system, &simulate(&system, 1e-6), 1e-3, &format!("loose, seed {seed}"), &mut ended);
    }
}

fn check(system: &System, found: &Run, residual: f64, told: &str, ended: &mut [u32; 3]) {
    let told = format!("{told}: {:?} at {} {:?}", found.status, found.t, found.stats);
    match found.status {
        Status::Complete => ended[0] += 1,
        Status::AtRest => ended[1] += 1,
        Status::Jammed if system.forces.drives.iter().any(Option::is_some) => ended[2] += 1,
        _ => panic!("{told}"),
    }
    let open = found.energy.residual();
    assert!(open.abs() < residual, "{told}: {open:e} {:?}", found.energy);
    let (depth, t) = overlap::deepest(system, found, 1);
    assert!(depth < 1e-6 * system.size, "{told}: overlap {depth:e} at {t}");
    for stop in &system.forces.stops {
        for t in &found.trajectory.times {
            let gap = stop.gap(found.trajectory.state(stop.coordinate, *t).q);
            assert!(gap > -1e-6 * system.size, "{told}: {stop:?} {gap:e} at {t}");
        }
    }
    if found.status == Status::AtRest {
        rests(system, found, &told);
    }
}

/// At rest, forces of springs, constants, contacts and stops leave no more than dry friction can hold.
fn rests(system: &System, found: &Run, told: &str) {
    let mut force: Vec<f64> =
        system.coordinates.iter().zip(&found.q).map(|(c, q)| c.force - c.stiffness * q).collect();
    for contact in &found.closed {
        if let Some(k) = contact.candidate.id.stop() {
            let stop = &system.forces.stops[k];
            force[stop.coordinate] += stop.slope() * contact.force;
            continue;
        }
        let (a, b) = system.interactions[contact.candidate.id.interaction as usize].bodies;
        // The earlier block lies to the left: a force between them drives it left and the other right.
        force[a] -= contact.force;
        force[b] += contact.force;
    }
    for (k, f) in force.iter().enumerate() {
        let driven = system.forces.drives[k].is_some();
        assert!(driven || f.abs() <= system.forces.coulomb[k] + 1e-5, "{told}: block {k} feels {f}");
    }
}
