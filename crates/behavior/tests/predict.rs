//! What machines will do, against what they are known to do.

#[path = "../../dynamics/tests/common/mod.rs"]
mod common;

use common::{close, coordinate, escapement, escapement_with, fig_13, slide, system, turn};
use mainspring_behavior::{Basis, NoPattern, Outcome, PredictOptions, Prediction, predict};
use mainspring_mechanism::{Coordinate, System};

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const WHEEL: &str = "generic m(m)\na = blo(x=2,y=1) at (movx=-1,movy=-0.5)\nf = blo() at (movy=50)\n\
                     attr f : frame = 1\nm = a asb f\n";
const STOP: &str = "generic m(m)\na = blo(x=2,y=1) at (movx=-2)\nf = blo(x=1,y=3) at (movx=0.75,movy=-1)\n\
                    attr f : frame = 1\nm = a asb f\n";

fn predicted(system: &System, options: &PredictOptions) -> Prediction {
    predict(system, &system.direct_search(), options, &mut |_| true)
}

fn wheel(c: Coordinate) -> System {
    system(vec![c], WHEEL, &[("a", turn(0, 0.0, 0.0))], 2.0)
}

fn spinning(inertia: f64, damping: f64, force: f64, velocity: f64) -> System {
    wheel(Coordinate { force, velocity, ..coordinate("a", inertia, damping, (0.0, 0.0)) })
}

/// The escapement repeats every two minima: −36° of the wheel, lever and balance back where they were, and no more
/// minima are simulated than P_ignore + M (P_confirm + 1).
#[test]
fn the_escapement_repeats() {
    let found = predicted(&escapement(), &PredictOptions::default());
    let Outcome::Repeats { pattern, basis, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!((pattern.minima, *basis), (2, Basis::LowMinima));
    assert!(common::low_minima(&found.run).len() <= 4 + 2 * 3);
    close(pattern.duration, 7.385_6, 2e-3);
    close(pattern.change[0].0, -36.0 * DEGREE, 1e-6);
    // Amplitudes fade with the mainspring: lever and balance return to within what one pattern takes.
    close(pattern.change[1].0, 0.0, 1e-3);
    close(pattern.change[2].0, 0.0, 1e-2);
    assert!(found.run.t < 40.0);
    assert_eq!(found.hypotheses.len(), 2);
    assert!(found.hypotheses[0].fell.is_some() && found.hypotheses[1].fell.is_none());
}

/// A free wheel without friction keeps its kinetic energy: no pattern is claimed.
#[test]
fn a_free_wheel_has_constant_kinetic_energy() {
    let found = predicted(&spinning(2.0, 0.0, 0.0, 1.5), &PredictOptions::default());
    assert_eq!(found.outcome, Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
}

/// A wheel without anything that moves it comes to rest at once.
#[test]
fn a_wheel_left_alone_rests() {
    let found = predicted(&spinning(2.0, 0.0, 0.0, 0.0), &PredictOptions::default());
    let Outcome::ComesToRest { t, jammed, ref held } = found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!((t, jammed, held.len()), (0.0, false, 0));
}

/// An oscillator without friction repeats every half swing or every whole one: after M minima (each at an end of the
/// swing) it is back, in M/2 periods.
#[test]
fn an_undamped_oscillator_repeats() {
    let c = Coordinate { position: 1.0, ..coordinate("a", 2.0, 0.0, (8.0, 0.2)) };
    let found = predicted(&wheel(c), &PredictOptions::default());
    let Outcome::Repeats { pattern, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!(pattern.minima, 2);
    close(pattern.duration, std::f64::consts::PI, 1e-9);
    close(pattern.change[0].0, 0.0, 1e-9);
}

/// An oscillator that loses a thousandth a swing repeats every two minima within the tolerance of matching; one that
/// loses most of its swing comes to rest where its spring is relaxed, and is not jammed.
#[test]
fn damped_oscillators_repeat_or_rest() {
    let c = |h: f64| Coordinate { position: 1.0, ..coordinate("a", 2.0, h, (8.0, 0.2)) };
    let found = predicted(&wheel(c(1e-3)), &PredictOptions::default());
    let Outcome::Repeats { pattern, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!(pattern.minima, 2);
    let found = predicted(&wheel(c(20.0)), &PredictOptions::default());
    let Outcome::ComesToRest { t, jammed, ref held } = found.outcome else { panic!("{:?}", found.outcome) };
    assert!(!jammed && held.is_empty());
    // The slower of the two rates is 5 − √21: the energy falls to 1e-13 of its greatest in some thirty seconds.
    assert!((20.0..60.0).contains(&t), "{t}");
    close(found.run.q[0], 0.2, 1e-5);
}

/// A part that its spring drives onto a stop comes to rest there, jammed, held by the stop alone.
#[test]
fn a_part_on_a_stop_is_jammed() {
    let machine =
        system(vec![coordinate("a", 2.0, 0.5, (3.0, 4.0))], STOP, &[("a", slide(0, 1.0, 0.0))], 10.0);
    let found = predicted(&machine, &PredictOptions::default());
    let Outcome::ComesToRest { t, jammed, ref held } = found.outcome else { panic!("{:?}", found.outcome) };
    assert!(jammed && t < 2.0, "{t}");
    assert_eq!(held.len(), 1);
    close(found.run.q[0], 0.75, 1e-12);
}

/// With a balance spring of 10 the escapement stalls: it comes to rest, jammed, as calculated independently.
#[test]
fn a_weak_balance_spring_jams() {
    let mut coordinates = fig_13();
    coordinates[2] = coordinate("bwheel", 20.0, 6.0, (10.0, 90.0 * DEGREE));
    let found = predicted(&escapement_with(coordinates), &PredictOptions::default());
    let Outcome::ComesToRest { t, jammed, ref held } = found.outcome else { panic!("{:?}", found.outcome) };
    assert!(jammed && !held.is_empty());
    close(t, 28.4283, 2e-3);
    let rest = [-0.384_204_49, 0.237_252_52, 76.837_664_11];
    found.run.q.iter().zip(rest).for_each(|(q, x)| close(q / DEGREE, x, 1e-5));
}

/// A wheel driven against friction within a billionth of its terminal speed turns evenly. Its kinetic energy has no
/// minima; whole turns are the points, and it repeats by one turn each. At exactly that speed its energy is constant.
#[test]
fn a_wheel_at_terminal_speed_repeats_by_turns() {
    let found = predicted(&spinning(2.0, 1.0, 3.0, 3.0 - 3e-9), &PredictOptions::default());
    let Outcome::Repeats { pattern, basis, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!((*basis, pattern.minima), (Basis::Passages, 1));
    close(pattern.change[0].0, std::f64::consts::TAU, 1e-9);
    close(pattern.duration, std::f64::consts::TAU / 3.0, 1e-8);
    let found = predicted(&spinning(2.0, 1.0, 3.0, 3.0), &PredictOptions::default());
    assert_eq!(found.outcome, Outcome::NoPattern(NoPattern::ConstantKineticEnergy));
}

/// From rest the same wheel first gathers speed. While it does every pattern falls; the shortest one is formed again
/// once enough turns agree.
#[test]
fn a_wheel_that_gathers_speed_repeats_in_the_end() {
    let found = predicted(&spinning(2.0, 1.0, 3.0, 0.0), &PredictOptions::default());
    let Outcome::Repeats { pattern, start, .. } = &found.outcome else { panic!("{:?}", found.outcome) };
    assert_eq!(pattern.minima, 1);
    close(pattern.duration, std::f64::consts::TAU / 3.0, 1e-6);
    assert!(start.t > 20.0 && start.t < 100.0, "{}", start.t);
    let again = found.hypotheses.iter().filter(|h| h.minima == 1).count();
    assert_eq!(again, 2, "formed at first, and again in the end");
}

/// The bounds on work are kept: too few minima or too little time are said to be so.
#[test]
fn it_gives_up_when_told() {
    let few = PredictOptions { max_minima: 4, ..PredictOptions::default() };
    assert_eq!(predicted(&escapement(), &few).outcome, Outcome::NoPattern(NoPattern::TooManyMinima));
    let short = PredictOptions { max_time: 10.0, ..PredictOptions::default() };
    assert_eq!(predicted(&escapement(), &short).outcome, Outcome::NoPattern(NoPattern::TooLong));
    let steps = PredictOptions { max_steps: 50, ..PredictOptions::default() };
    assert_eq!(predicted(&escapement(), &steps).outcome, Outcome::NoPattern(NoPattern::StepLimit));
    let found =
        predict(&escapement(), &escapement().direct_search(), &PredictOptions::default(), &mut |t| t < 5.0);
    assert_eq!(found.outcome, Outcome::Stopped);
}

/// A pin that rocks an arm until its spring has run down: a pattern stood when it came to rest, and falls with that.
#[test]
fn what_comes_to_rest_confirms_no_pattern() {
    let mut system = common::examples::example(("rotary-to-reciprocating", "rotary-to-reciprocating"), &[]);
    system.coordinates[0] = coordinate("wheel", 60.0, 60.0, (1.0, 10_000.0 * DEGREE));
    system.coordinates[1] = coordinate("arm", 100.0, 10.0, (0.0, 0.0));
    let found = predicted(&system, &PredictOptions::default());
    assert!(matches!(found.outcome, Outcome::ComesToRest { .. }), "{:?}", found.outcome);
    let last = found.hypotheses.last().expect("one was formed");
    assert_eq!((last.fell, last.why.as_deref()), (Some(found.run.t), Some("the machine came to rest")));
    assert!(found.hypotheses.iter().all(|h| h.fell.is_some() && h.why.is_some()));
}
