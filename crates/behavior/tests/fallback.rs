//! Machines whose kinetic energy never gets low: patterns by prominent minima and by whole turns.

#[path = "../../dynamics/tests/common/mod.rs"]
mod common;

use common::{close, coordinate, overlap, slide, system, turn};
use mainspring_behavior::{Basis, NoPattern, Outcome, Pattern, PredictOptions, Prediction, predict};
use mainspring_mechanism::{Coordinate, System};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2, TAU};

fn predicted(system: &System, options: &PredictOptions) -> Prediction {
    let found = predict(system, &system.direct_search(), options, &mut |_| true);
    overlap::assert_free(system, &found.run);
    found
}

fn repeats(found: &Prediction) -> (&Pattern, Basis) {
    match &found.outcome {
        Outcome::Repeats { pattern, basis, .. } => (pattern, *basis),
        other => panic!("{other:?} after {} s: {:?}", found.run.t, found.hypotheses),
    }
}

/// A wheel of inertia I under a torque T and friction h lifts a flat follower of mass m, which a spring (k, relaxed
/// at r) and friction f hold against it. With x(θ) the follower's height and c = dx/dθ it is a machine of one freedom,
/// (I + m c²) θ″ + m c c′ θ′² = T − h θ′ − c (k (x − x₀ − r) + f c θ′).
struct Cam {
    shape: &'static str,
    /// x, c and c′ at an angle within one period.
    lift: fn(f64) -> [f64; 3],
    period: f64,
    /// I, h and T.
    wheel: [f64; 3],
}

/// m, f, k and r.
const FOLLOWER: [f64; 4] = [1.0, 0.3, 10.0, -3.0];

/// A round cam that turns about a point half a unit off its centre: x = 1 + ½ cos θ.
const ECCENTRIC: Cam = Cam {
    shape: "cyl(d=2) at (movx=0.5)",
    lift: |a| [1.0 + 0.5 * a.cos(), -0.5 * a.sin(), -0.5 * a.cos()],
    period: TAU,
    wheel: [5.0, 2.0, 6.0],
};

/// A square of side 2: its corners lift the follower, x = √2 cos (θ − 45°), and it slams onto the next side each
/// quarter of a turn.
const SQUARE: Cam = Cam {
    shape: "blo(x=2,y=2) at (movx=-1,movy=-1)",
    lift: |a| {
        let (sin, cos) = (a - FRAC_PI_4).sin_cos();
        [SQRT_2 * cos, -SQRT_2 * sin, -SQRT_2 * cos]
    },
    period: FRAC_PI_2,
    wheel: [50.0, 10.0, 32.0],
};

impl Cam {
    /// θ″ at an angle and speed.
    fn acceleration(&self, angle: f64, w: f64) -> f64 {
        let ([inertia, h, torque], [m, f, k, r]) = (self.wheel, FOLLOWER);
        let ([x, c, bend], x0) = ((self.lift)(angle), (self.lift)(0.0)[0]);
        (torque - h * w - c * (k * (x - x0 - r) + f * c * w) - m * c * bend * w * w) / (inertia + m * c * c)
    }

    /// Speed at the start of a period and its duration once both have settled: w dw/dθ = θ″ by Runge and Kutta, and
    /// at a period's end the inelastic blow of follower and next side.
    fn settled(&self) -> (f64, f64) {
        let (steps, mut w, mut duration) = (1000, 3.0, 0.0);
        let step = self.period / f64::from(steps);
        let slope = |a: f64, w: f64| self.acceleration(a, w) / w;
        for _ in 0..200 {
            duration = 0.0;
            for n in 0..steps {
                let a = step * f64::from(n);
                let k1 = slope(a, w);
                let k2 = slope(a + 0.5 * step, w + 0.5 * step * k1);
                let k3 = slope(a + 0.5 * step, w + 0.5 * step * k2);
                let k4 = slope(a + step, w + step * k3);
                let (start, middle) = (w, w + 0.125 * step * (k1 + k2 + k3 + k4));
                w += step * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
                duration += step * (1.0 / start + 4.0 / middle + 1.0 / w) / 6.0;
            }
            let (before, after) = ((self.lift)(self.period)[1], (self.lift)(0.0)[1]);
            let (i, m) = (self.wheel[0], FOLLOWER[0]);
            w *= (i + m * before * after) / (i + m * after * after);
        }
        (w, duration)
    }

    /// The machine, started as it runs once settled; `sense` −1 turns it the other way.
    fn machine(&self, speed: f64, sense: f64) -> System {
        let text = format!(
            "generic m(m)\nwheel = {}\nfollower = blo(x=1,y=8) at (movx={},movy=-4)\nbase = blo() at (movy=50)\n\
             attr base : frame = 1\nm = wheel asb follower asb base\n",
            self.shape,
            (self.lift)(0.0)[0]
        );
        let ([inertia, h, torque], [m, f, k, r]) = (self.wheel, FOLLOWER);
        let wheel = Coordinate {
            force: sense * torque,
            velocity: sense * speed,
            ..coordinate("wheel", inertia, h, (0.0, 0.0))
        };
        let rise = (self.lift)(0.0)[1] * speed;
        let follower = Coordinate { velocity: rise, ..coordinate("follower", m, f, (k, r)) };
        system(
            vec![wheel, follower],
            &text,
            &[("wheel", turn(0, 0.0, 0.0)), ("follower", slide(1, 1.0, 0.0))],
            4.0,
        )
    }
}

/// A driven cam slows down as it lifts its follower, and never stops: one prominent minimum a turn, whichever way it
/// turns, and the period of the machine of one freedom.
#[test]
fn a_driven_cam_repeats_by_prominent_minima() {
    let (speed, duration) = ECCENTRIC.settled();
    for sense in [1.0, -1.0] {
        let found = predicted(&ECCENTRIC.machine(speed, sense), &PredictOptions::default());
        let (pattern, basis) = repeats(&found);
        assert_eq!((basis, pattern.minima), (Basis::ProminentMinima, 1));
        close(pattern.duration, duration, 1e-6);
        close(pattern.change[0].0, sense * TAU, 1e-6);
        close(pattern.change[1].0, 0.0, 1e-6);
        assert!(pattern.change.iter().all(|c| c.1.abs() < 1e-5), "{:?}", pattern.change);
        // P_ignore + M (P_confirm + 1) minima, and the time until the last is seen to be one.
        assert!(found.run.t < (4.0 + 3.0 + 2.0) * duration, "{}", found.run.t);
    }
}

/// From rest the same cam first gathers speed; the answer is the same to the tolerance of matching.
#[test]
fn a_cam_started_from_rest_settles_to_the_same() {
    let found = predicted(&ECCENTRIC.machine(0.0, 1.0), &PredictOptions::default());
    let (pattern, basis) = repeats(&found);
    assert_eq!((basis, pattern.minima), (Basis::ProminentMinima, 1));
    let (_, duration) = ECCENTRIC.settled();
    close(pattern.duration, duration, 0.01 * duration);
    close(pattern.change[0].0, TAU, 0.02 * TAU);
}

/// A square cam strikes the follower with each side: a pattern is a quarter of a turn.
#[test]
fn a_square_cam_repeats_each_quarter_turn() {
    let (speed, duration) = SQUARE.settled();
    let found = predicted(&SQUARE.machine(speed, 1.0), &PredictOptions::default());
    let (pattern, basis) = repeats(&found);
    assert_eq!((basis, pattern.minima), (Basis::ProminentMinima, 1));
    close(pattern.duration, duration, 1e-6);
    close(pattern.change[0].0, FRAC_PI_2, 1e-6);
}

/// Wheels that turn freely or against friction, and an oscillator, none touching another.
fn apart(coordinates: Vec<Coordinate>) -> System {
    let mut text = "generic m(m)\nbase = blo() at (movy=500)\nattr base : frame = 1\n".to_string();
    let names: Vec<String> = coordinates.iter().map(|c| c.name.clone()).collect();
    for (i, name) in names.iter().enumerate() {
        text += &format!("{name} = blo() at (movx={})\n", 10 * i);
    }
    text += &format!("m = base asb {}\n", names.join(" asb "));
    let joints: Vec<_> =
        names.iter().enumerate().map(|(i, n)| (n.as_str(), turn(i, 10.0 * i as f64, 0.0))).collect();
    system(coordinates, &text, &joints, 20.0)
}

fn free(name: &str, inertia: f64, velocity: f64) -> Coordinate {
    Coordinate { velocity, ..coordinate(name, inertia, 0.0, (0.0, 0.0)) }
}

/// Swings at ω = 1 with an amplitude.
fn swinging(amplitude: f64) -> Coordinate {
    Coordinate { position: amplitude, ..coordinate("balance", 1.0, 0.0, (1.0, 0.0)) }
}

/// A swing beside a free wheel: the energy is least at both ends of the swing, and the wheel has turned on.
#[test]
fn a_swing_beside_a_wheel_repeats_by_prominent_minima() {
    let found = predicted(&apart(vec![free("wheel", 2.0, 0.7), swinging(2.0)]), &PredictOptions::default());
    let (pattern, basis) = repeats(&found);
    assert_eq!((basis, pattern.minima), (Basis::ProminentMinima, 2));
    close(pattern.duration, TAU, 1e-8);
    close(pattern.change[0].0, 0.7 * TAU, 1e-8);
    close(pattern.change[1].0, 0.0, 1e-7);
    let alone = predicted(&apart(vec![swinging(2.0)]), &PredictOptions::default());
    assert_eq!(repeats(&alone).1, Basis::LowMinima, "a swing alone does get low");
}

/// A swing too weak to leave prominent minima, three turns of the wheel long: whole turns find it, and what was tried
/// before is told.
#[test]
fn a_weak_swing_beside_a_wheel_repeats_by_whole_turns() {
    let machine = apart(vec![free("wheel", 2.0, 3.0), swinging(0.02)]);
    let found = predicted(&machine, &PredictOptions::default());
    let (pattern, basis) = repeats(&found);
    assert_eq!((basis, pattern.minima), (Basis::Passages, 3));
    close(pattern.duration, TAU, 1e-8);
    close(pattern.change[0].0, 3.0 * TAU, 1e-8);
    close(pattern.change[1].0, 0.0, 1e-8);
    let tried: Vec<usize> = found.hypotheses.iter().map(|h| h.minima).collect();
    assert_eq!(tried, [1, 2, 3]);
    assert!(found.hypotheses[..2].iter().all(|h| h.why.as_ref().is_some_and(|w| w.contains("balance"))));
    let few = PredictOptions { max_minima: 6, ..PredictOptions::default() };
    let found = predicted(&machine, &few);
    assert_eq!(found.outcome, Outcome::NoPattern(NoPattern::TooManyMinima));
    assert!(!found.hypotheses.is_empty());
}

/// Of two wheels near their terminal speeds the faster counts turns; the other moves by its share, backwards too.
#[test]
fn the_wheel_that_turns_furthest_counts() {
    let driven = |name: &str, speed: f64| Coordinate {
        force: speed,
        velocity: speed * (1.0 - 1e-9),
        ..coordinate(name, 2.0, 1.0, (0.0, 0.0))
    };
    let found =
        predicted(&apart(vec![driven("slow", 3.0), driven("fast", -7.0)]), &PredictOptions::default());
    let (pattern, basis) = repeats(&found);
    assert_eq!((basis, pattern.minima), (Basis::Passages, 1));
    close(pattern.duration, TAU / 7.0, 1e-8);
    close(pattern.change[0].0, TAU * 3.0 / 7.0, 1e-7);
    close(pattern.change[1].0, -TAU, 1e-9);
}

/// Two free wheels keep their energy whatever they do: said before any turn is counted.
#[test]
fn constant_energy_is_told_before_any_fallback() {
    let found =
        predicted(&apart(vec![free("a", 2.0, 3.0), free("b", 1.0, -1.0)]), &PredictOptions::default());
    assert_eq!(found.outcome, Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
    assert!(found.hypotheses.is_empty());
}
