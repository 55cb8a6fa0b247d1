//! Pairs whose curves have a closed law: to 1e-9.

mod common;

use common::{body, circle, close, path, polygon, rectangle, slide, system, turn};
use mainspring_cspace::{ConfigurationSpace, SpaceOptions};
use std::f64::consts::PI;

fn space(system: &mainspring_mechanism::System, windows: [Option<(f64, f64)>; 2]) -> ConfigurationSpace {
    let options = SpaceOptions { windows, ..SpaceOptions::default() };
    ConfigurationSpace::new(system, [0, 1], [0, 1], &options).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn two_eccentric_discs() {
    // |o₁ + e₁ e^{ix} − o₂ − e₂ e^{iy}| = r₁ + r₂ on every curve.
    let (e1, e2, r1, r2, d) = (0.5, 0.4, 1.0, 0.8, 2.2);
    let bodies = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![circle(e1, 0.0, r1, true, 0)]),
        body("b", vec![turn(1, d, 0.0)], vec![circle(d + e2, 0.0, r2, true, 1)]),
    ];
    let s = system(bodies, 4.0);
    let map = space(&s, [None, None]);
    let components = map.components();
    assert_eq!(components.len(), 1);
    // Blocked is one island: free space has one more boundary and both windings of the torus.
    assert_eq!(components[0].windings.generators(), &[[1, 0], [0, 1]]);
    assert_eq!(components[0].boundary.len(), 1);
    assert_eq!(components[0].boundary[0].winding, [0, 0]);
    for curve in map.curves() {
        for k in 0..=20 {
            let [x, y] = curve.at(f64::from(k) / 20.0);
            let dx = e1 * x.cos() - d - e2 * y.cos();
            let dy = e1 * x.sin() - e2 * y.sin();
            close(dx.hypot(dy), r1 + r2, 1e-9);
        }
        let t = curve.transmission(0.4);
        let [x, y] = t.at;
        // F = ½|Δ|²: its gradient by hand.
        let fx = e1 * (x.sin() * d - e2 * (y - x).sin());
        let fy = e2 * (-y.sin() * d + e1 * (y - x).sin());
        close(t.ratio, -fx / fy, 1e-9 * (1.0 + t.ratio.abs()));
    }
}

#[test]
fn eccentric_disc_under_a_flat_follower() {
    // y = r + e sin x for a flat underside at height 0, whatever its width.
    let (e, r) = (0.3, 1.0);
    let bodies = vec![
        body("cam", vec![turn(0, 0.0, 0.0)], vec![circle(e, 0.0, r, true, 0)]),
        body("flat", vec![slide(1, 0.0, 1.0)], vec![rectangle(-2.0, 0.0, 2.0, 0.5)]),
    ];
    let s = system(bodies, 4.0);
    let map = space(&s, [None, None]);
    let mut seen = 0;
    for k in 0..200 {
        let x = -3.0 + 0.03 * f64::from(k);
        let top = map.slice_first(x).into_iter().max_by(|a, b| a.low.total_cmp(&b.low)).unwrap();
        close(top.low, r + e * x.sin(), 1e-9);
        let curve = map.curve(top.curves[0].unwrap()).unwrap();
        let (a, b) = (curve.from()[0], curve.to()[0]);
        let t = curve.transmission((x - a) / (b - a));
        close(t.ratio, e * x.cos(), 1e-9);
        close(t.derivatives[0], -e * x.sin(), 1e-9);
        close(t.derivatives[1], -e * x.cos(), 1e-9);
        // A flat follower that slides along the normal: pressure angle 0.
        close(t.pressure_angles[1], 0.0, 1e-9);
        seen += 1;
    }
    assert_eq!(seen, 200);
    // Above the cam free for all angles, below likewise: two components that wind once.
    let winding: Vec<_> = map.components().iter().map(|c| c.windings.generators().to_vec()).collect();
    assert_eq!(winding, vec![vec![[1, 0]], vec![[1, 0]]]);
}

/// A crank pin (radius r on radius a) in the straight slot of a yoke that slides: y = a cos x ± play.
fn yoke(clearance: f64) -> ConfigurationSpace {
    let (a, r) = (1.0, 0.2);
    let w = r + clearance;
    let hole = [(-w, -2.0, 0.0), (-w, 2.0, 0.0), (w, 2.0, 0.0), (w, -2.0, 0.0)];
    let plate = rectangle(-1.0, -2.5, 1.0, 2.5);
    let bodies = vec![
        body("pin", vec![turn(0, 0.0, 0.0)], vec![circle(a, 0.0, r, true, 0)]),
        body("yoke", vec![slide(1, 1.0, 0.0)], vec![plate, path(&hole, 10)]),
    ];
    space(&system(bodies, 5.0), [None, Some((-1.6, 1.6))])
}

#[test]
fn pin_in_slot() {
    let map = yoke(0.05);
    for k in 0..100 {
        let x = -3.1 + 0.062 * f64::from(k);
        let slot = map.slice_first(x).into_iter().find(|i| i.low < x.cos() && i.high > x.cos()).unwrap();
        close(slot.low, x.cos() - 0.05, 1e-9);
        close(slot.high, x.cos() + 0.05, 1e-9);
        let play = map.play([x, x.cos()]).unwrap().unwrap();
        close(play[1].1 - play[1].0, 0.1, 1e-9);
        close(map.gap([x, x.cos()]).unwrap().gap, 0.05, 1e-9);
    }
    let slot = map.component_of([0.3, 0.3_f64.cos()]).unwrap();
    let component = &map.components()[slot as usize];
    assert_eq!(component.windings.generators(), &[[1, 0]]);
    assert_eq!(component.boundary.len(), 2);
    close(component.area, 2.0 * PI * 0.1, 1e-4);
}

#[test]
fn a_slot_as_wide_as_its_pin_has_no_free_interior() {
    // The passage is a line: the map is that of the interior, in which nothing is left of it.
    let map = yoke(0.0);
    for k in 0..50 {
        let x = -3.0 + 0.12 * f64::from(k);
        assert!(!map.slice_first(x).iter().any(|i| i.low < x.cos() - 1e-7 && i.high > x.cos() + 1e-7));
        assert!(!map.is_free([x, x.cos() + 1e-6]) && !map.is_free([x, x.cos() - 1e-6]));
    }
}

#[test]
fn walk_of_a_yoke() {
    // Pushed a whole turn the pin takes the yoke along, with the play between the two reversals.
    let map = yoke(0.05);
    let walk = map.walk([0.1, 0.1_f64.cos()], 0, 0.1 + 2.0 * PI).unwrap().unwrap();
    assert_eq!(walk.end, mainspring_cspace::End::Arrived);
    // Down on one face, free over the play, up on the other, free, and down again.
    let touching: Vec<bool> = walk.stages.iter().map(|s| s.curve.is_some()).collect();
    assert!(!touching[0] && touching[1]);
    close(walk.last()[0], 0.1 + 2.0 * PI, 1e-12);
    // It came up to 1 − play, and stays there until pushed down from cos x = 1 − 2 play on.
    close(walk.last()[1], 0.95, 1e-9);
    // Pushing the yoke jams at the dead points of the crank.
    let back = map.walk([1.0, 1.0_f64.cos()], 1, 2.0).unwrap().unwrap();
    assert_eq!(back.end, mainspring_cspace::End::Jammed);
    close(back.last()[1], 1.05, 1e-7);
}

#[test]
fn boxes_in_the_plane() {
    // Two rectangles that slide across: blocked is the rectangle of their Minkowski difference.
    let bodies = vec![
        body("a", vec![slide(0, 1.0, 0.0)], vec![rectangle(0.0, 0.0, 1.0, 0.5)]),
        body("b", vec![slide(1, 0.0, 1.0)], vec![rectangle(0.0, 0.0, 0.25, 2.0)]),
    ];
    let map = space(&system(bodies, 3.0), [Some((-4.0, 4.0)), Some((-4.0, 4.0))]);
    let free = map.components();
    assert_eq!(free.len(), 1);
    close(free[0].area, 64.0 - 1.25 * 2.5, 1e-9);
    assert_eq!(free[0].boundary.len(), 2);
    let hole =
        free[0].boundary.iter().min_by_key(|c| c.edges.iter().filter(|e| e.curve.is_none()).count()).unwrap();
    // Flush sides: which corner touches which edge changes along them, so each side is several curves.
    assert!(hole.edges.len() >= 4 && hole.edges.iter().all(|e| e.curve.is_some()));
    for e in &hole.edges {
        let on = |q: [f64; 2]| {
            let (x, y) = (q[0] - (-0.375), q[1] - (-0.75));
            ((x.abs() - 0.625).abs() < 1e-9) || ((y.abs() - 1.25).abs() < 1e-9)
        };
        assert!(on(e.from) && on(e.to), "{e:?}");
    }
    let length: f64 =
        hole.edges.iter().map(|e| (e.to[0] - e.from[0]).abs() + (e.to[1] - e.from[1]).abs()).sum();
    close(length, 2.0 * (1.25 + 2.5), 1e-8);
}

#[test]
fn a_knife_edge_over_a_polygon_cam() {
    // The point rides on the square's sides: y = 1 / cos(x) within an eighth of a turn.
    let bodies = vec![
        body("cam", vec![turn(0, 0.0, 0.0)], vec![rectangle(-1.0, -1.0, 1.0, 1.0)]),
        body("knife", vec![slide(1, 0.0, 1.0)], vec![polygon(&[(0.0, 0.0), (0.1, 1.0), (-0.1, 1.0)])]),
    ];
    let map = space(&system(bodies, 3.0), [None, Some((0.5, 2.0))]);
    assert_eq!(map.repeats(), [4, 1]);
    for k in 0..100 {
        let x = -0.785 + 0.0157 * f64::from(k);
        let high = map.slice_first(x).last().copied().unwrap();
        close(high.low, 1.0 / x.cos(), 1e-9);
        let high = map.slice_first(x + PI).last().copied().unwrap();
        close(high.low, 1.0 / x.cos(), 1e-9);
    }
}
