//! Which bodies on chains can touch, and how far their features move: bounds that hold wherever the joints are.

use mainspring_geometry::{CurveId, Edge, Layer, Loop, Outline, Segment, Turn, Vec2};
use mainspring_mechanism::{Body, Coordinate, Joint, Motion, System};

fn p(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A disc.
fn disc(center: Vec2, radius: f64, primitive: u32) -> Outline {
    let segment = Segment::Circle { center, radius, convex: true };
    let curve = CurveId { primitive, face: 0 };
    let edges = vec![Edge { segment, curve, aliases: vec![], turn_at_start: Turn::Smooth }];
    Outline { layers: vec![Layer { bottom: 0.0, top: 1.0, loops: vec![Loop { edges }] }] }
}

fn turn(coordinate: usize, center: Vec2) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Turn { center } }
}

fn slide(coordinate: usize, direction: Vec2) -> Joint {
    Joint { coordinate, ratio: 1.0, motion: Motion::Slide { direction } }
}

fn body(chain: Vec<Joint>, outline: Outline) -> Body {
    Body { name: "b".into(), chain, outline }
}

fn system(bodies: Vec<Body>) -> System {
    let c = |_| Coordinate::free("c", 1.0);
    System::new((0..3).map(c).collect(), bodies, &[], 20.0)
}

/// A pawl pinned at (3, 0) to a plate about the origin; its disc of radius ½ is 1 from the pin: it sweeps the ring
/// from 1.5 to 4.5, and a slide on top of that everything near its line.
#[test]
fn chains_sweep_what_they_can_reach() {
    let pawl = || body(vec![turn(0, p(0.0, 0.0)), turn(1, p(3.0, 0.0))], disc(p(4.0, 0.0), 0.5, 1));
    let touches = |at: Vec2| !system(vec![pawl(), body(vec![], disc(at, 0.25, 2))]).interactions.is_empty();
    assert!(touches(p(0.0, 1.26)) && touches(p(-4.7, 0.0)) && touches(p(0.0, -3.0)));
    assert!(!touches(p(0.0, 1.24)) && !touches(p(-4.76, 0.0)));
    let lifted = |at: Vec2| {
        let chain = vec![slide(2, p(1.0, 0.0)), turn(1, p(3.0, 0.0))];
        !system(vec![body(chain, disc(p(4.0, 0.0), 0.5, 1)), body(vec![], disc(at, 0.25, 2))])
            .interactions
            .is_empty()
    };
    assert!(lifted(p(90.0, 1.7)) && !lifted(p(90.0, 1.8)));
}

/// Between a pawl and its own plate only the pawl's joint counts.
#[test]
fn joints_that_both_share_do_not_count() {
    let plate = body(vec![turn(0, p(0.0, 0.0))], disc(p(-1.0, 0.0), 0.5, 1));
    let pawl = |x: f64| body(vec![turn(0, p(0.0, 0.0)), turn(1, p(3.0, 0.0))], disc(p(x, 0.0), 0.25, 2));
    let s = system(vec![plate.clone(), pawl(6.5)]);
    let [i] = &s.interactions[..] else { panic!("{:?}", s.interactions.len()) };
    assert_eq!((i.levers.0, i.levers.1), ([0.0; 4], [0.0, 3.75, 0.0, 0.0]));
    assert_eq!(i.shares.1, [1.0]);
    assert!(system(vec![plate, pawl(5.0)]).interactions.is_empty());
}

/// No feature moves faster than its lever arms allow, wherever the joints of its chain are.
#[test]
fn levers_bound_the_motion_of_features() {
    let (o, a, b) = (p(0.0, 0.0), p(3.0, 1.0), p(4.0, -1.0));
    let arm = body(vec![turn(0, o), turn(1, a), turn(2, b)], disc(p(5.0, 0.5), 0.5, 1));
    let s = system(vec![arm.clone(), body(vec![], disc(p(2.0, 2.0), 0.25, 2))]);
    let levers = s.interactions[0].levers.0;
    let mut greatest = [0.0; 3];
    for k in 0..4000 {
        let angle = |j: usize| 0.37 * k as f64 * (1.0 + 0.618 * j as f64);
        let q = [angle(0), angle(1), angle(2)];
        for (j, greatest) in greatest.iter_mut().enumerate() {
            let seeded: Vec<num_dual::Dual64> =
                (0..3).map(|i| num_dual::Dual64::new(q[i], f64::from(u8::from(i == j)))).collect();
            let center = arm.pose(&seeded).apply(Vec2::constant(p(5.0, 0.5)));
            // The farthest point of the disc moves by its radius more.
            let speed = center.x.eps.hypot(center.y.eps) + 0.5;
            *greatest = f64::max(*greatest, speed);
            assert!(speed <= levers[j] + 1e-12, "{j}: {speed} {}", levers[j]);
        }
    }
    // They are reached: the chain can stretch out.
    assert!((0..3).all(|j| greatest[j] > 0.99 * levers[j]), "{greatest:?} {levers:?}");
}
