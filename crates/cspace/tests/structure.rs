//! Components, windings and boundary cycles of known pairs, just before and just after a pinch or a split.

mod common;

use common::{body, circle, close, outline, path, polygon, rectangle, slide, system, turn};
use mainspring_cspace::{ConfigurationSpace, SpaceError, SpaceOptions};
use mainspring_mechanism::{Body, Joint, Motion, System};
use std::f64::consts::{PI, TAU};

fn space(system: &System) -> ConfigurationSpace {
    ConfigurationSpace::new(system, [0, 1], [0, 1], &SpaceOptions::default())
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Components as (generators of windings, number of boundary cycles), sorted.
fn shape(map: &ConfigurationSpace) -> Vec<(Vec<[i64; 2]>, usize)> {
    let mut found: Vec<_> =
        map.components().iter().map(|c| (c.windings.generators().to_vec(), c.boundary.len())).collect();
    found.sort();
    found
}

/// Two bars that turn, half lengths l and m, axes `d` apart.
fn bars(l: f64, m: f64, d: f64) -> System {
    system(
        vec![
            body("a", vec![turn(0, 0.0, 0.0)], vec![rectangle(-0.05, -0.05, l, 0.05)]),
            body("b", vec![turn(1, d, 0.0)], vec![rectangle(d - m, -0.05, d + 0.05, 0.05)]),
        ],
        2.0,
    )
}

#[test]
fn bars_begin_to_touch() {
    // Corners reach √(l² + 0.05²): just apart, the whole torus is free; just within reach, there is an island.
    let reach = 2.0 * 1.0f64.hypot(0.05);
    let map = space(&bars(1.0, 1.0, reach + 1e-6));
    assert_eq!(shape(&map), vec![(vec![[1, 0], [0, 1]], 0)]);
    let map = space(&bars(1.0, 1.0, reach - 1e-3));
    let found = shape(&map);
    assert_eq!(found[0].0, vec![[1, 0], [0, 1]]);
    assert!(found.len() == 1 && found[0].1 >= 1, "{found:?}");
}

#[test]
fn a_long_bar_cannot_pass_the_other_axis() {
    // l < d: either bar may turn all round with the other out of the way. l > d: the first bar hits the other's hub
    // at every position of it, so it cannot turn all round.
    let short = shape(&space(&bars(0.9, 0.9, 1.0)));
    assert_eq!(short.len(), 1);
    assert_eq!(short[0].0, vec![[1, 0], [0, 1]]);
    let long = shape(&space(&bars(1.2, 0.9, 1.0)));
    // The second one can still turn, while the first stays away.
    assert_eq!(long.len(), 1, "{long:?}");
    assert_eq!(long[0].0, vec![[0, 1]]);
    assert_eq!(long[0].1, 2);
}

/// A disc on an arm (radius r) that may pass a gate of two posts: the gap between the posts is `width`.
fn gate(width: f64) -> System {
    let post = |y: f64| circle(2.0, y, 0.3, true, if y > 0.0 { 1 } else { 2 });
    let offset = 0.5 * width + 0.3;
    system(
        vec![
            body("ball", vec![slide(0, 1.0, 0.0)], vec![circle(0.0, 0.0, 0.4, true, 0)]),
            body("gate", vec![slide(1, 0.0, 1.0)], vec![post(offset), post(-offset)]),
        ],
        4.0,
    )
}

#[test]
fn a_gate_pinches() {
    let options = SpaceOptions { windows: [Some((0.0, 4.0)), Some((-0.5, 0.5))], ..SpaceOptions::default() };
    let at = |width: f64| {
        let s = gate(width);
        ConfigurationSpace::new(&s, [0, 1], [0, 1], &options).unwrap_or_else(|e| panic!("{e}"))
    };
    let open = at(0.8 + 1e-5);
    assert_eq!(open.components().len(), 1);
    assert!(open.way([0.1, 0.0], [3.9, 0.0]).is_some());
    let shut = at(0.8 - 1e-5);
    assert_eq!(shut.components().len(), 2);
    assert!(shut.way([0.1, 0.0], [3.9, 0.0]).is_none());
    assert_ne!(shut.component_of([0.1, 0.0]), shut.component_of([3.9, 0.0]));
}

#[test]
fn an_arm_turns_all_round_only_if_the_post_can_leave() {
    // An arm whose corners reach √(l² + w²), a post of radius 0.2 that slides away from the arm's axis.
    let reach = 1.0f64.hypot(0.05);
    let s = system(
        vec![
            body("arm", vec![turn(0, 0.0, 0.0)], vec![rectangle(-0.05, -0.05, 1.0, 0.05)]),
            body("post", vec![slide(1, 1.0, 0.0)], vec![circle(0.0, 0.0, 0.2, true, 0)]),
        ],
        2.0,
    );
    let windings = |most: f64| {
        let options = SpaceOptions { windows: [None, Some((0.3, most))], ..SpaceOptions::default() };
        let map = ConfigurationSpace::new(&s, [0, 1], [0, 1], &options).unwrap_or_else(|e| panic!("{e}"));
        shape(&map)
    };
    assert_eq!(windings(reach + 0.2 + 1e-6), vec![(vec![[1, 0]], 2)]);
    // Either corner of the arm's end stops it, and before the end itself, which reaches less far, there is a pocket.
    assert_eq!(windings(reach + 0.2 - 1e-6), vec![(vec![], 1), (vec![], 1)]);
}

#[test]
fn a_room_has_a_door_or_none() {
    // A ball of radius 0.4 in a room with a door of some width, or outside; a closed room is a component of its own.
    let parts = |door: f64| {
        let (a, b) = (-0.5 * door, 0.5 * door);
        let room = [
            (-1.2, -1.2),
            (1.2, -1.2),
            (1.2, a),
            (1.0, a),
            (1.0, -1.0),
            (-1.0, -1.0),
            (-1.0, 1.0),
            (1.0, 1.0),
            (1.0, b),
            (1.2, b),
            (1.2, 1.2),
            (-1.2, 1.2),
        ];
        let s = system(
            vec![
                body("ball", vec![slide(0, 1.0, 0.0)], vec![circle(0.0, 0.0, 0.4, true, 0)]),
                body("room", vec![slide(1, 0.0, 1.0)], vec![polygon(&room)]),
            ],
            4.0,
        );
        let windows = [Some((-3.0, 3.0)), Some((-3.0, 3.0))];
        let options = SpaceOptions { windows, ..SpaceOptions::default() };
        ConfigurationSpace::new(&s, [0, 1], [0, 1], &options).unwrap_or_else(|e| panic!("{e}"))
    };
    // Outside is a ring: a cycle along the window and one round the room, which with an open door runs through it.
    let open = parts(0.8 + 1e-6);
    assert_eq!(shape(&open), vec![(vec![], 2)]);
    assert!(open.way([0.0, 0.0], [2.5, 0.0]).is_some());
    let shut = parts(0.8 - 1e-6);
    assert_eq!(shape(&shut), vec![(vec![], 1), (vec![], 2)]);
    assert!(shut.way([0.0, 0.0], [2.5, 0.0]).is_none());
}

/// Two wheels with `n` and `m` teeth.
fn gears(n: usize, m: usize) -> System {
    // Slender teeth: in each pitch of 2π one of height 2.3, so that there is always one in a gap of the other's.
    let teeth = |n: usize, x: f64, phase: f64| {
        let r = n as f64;
        let at = |i: usize, (off, height): (f64, f64)| {
            let a = (i as f64 + phase + off) * TAU / r;
            (x + (r + height) * a.cos(), (r + height) * a.sin())
        };
        let profile = [(-0.2, -1.3), (-0.03, 1.0), (0.03, 1.0), (0.2, -1.3)];
        let points: Vec<_> = (0..n).flat_map(|i| profile.map(|c| at(i, c))).collect();
        polygon(&points)
    };
    let d = (n + m) as f64;
    system(
        vec![
            body("a", vec![turn(0, 0.0, 0.0)], vec![teeth(n, 0.0, 0.0)]),
            body("b", vec![turn(1, d, 0.0)], vec![teeth(m, d, 0.5)]),
        ],
        2.0 * d,
    )
}

#[test]
fn teeth_that_mesh_make_diagonal_channels() {
    for (n, m, gcd) in [(6, 9, 3), (5, 7, 1), (8, 8, 8)] {
        let s = gears(n, m);
        let map = space(&s);
        assert_eq!(map.repeats(), [n as u32, m as u32]);
        let channels = map.components();
        assert_eq!(channels.len(), 1);
        assert_eq!(channels[0].windings.generators(), &[[1, -1]]);
        assert_eq!(channels[0].copies, gcd);
        let whole = [(m as u32 / gcd) as i64, -i64::from(n as u32 / gcd)];
        assert_eq!(channels[0].turns.generators(), &[whole]);
        // Without the symmetry every channel is found by itself.
        let options = SpaceOptions { periodic: false, ..SpaceOptions::default() };
        let all = ConfigurationSpace::new(&s, [0, 1], [0, 1], &options).unwrap();
        let found = all.components();
        assert_eq!(found.len(), gcd as usize);
        assert_eq!(all.component_count(), map.component_count());
        for c in &found {
            assert_eq!(c.windings.generators(), &[whole]);
            assert_eq!(c.boundary.len(), 2);
            close(c.area * f64::from(gcd), channels[0].area * (n * m) as f64, 1e-7);
        }
    }
}

#[test]
fn a_walk_through_meshing_teeth_keeps_the_ratio() {
    let map = space(&gears(6, 9));
    let inside = map.components()[0].inside;
    let walk = map.walk(inside, 0, inside[0] + 3.0 * TAU).unwrap().unwrap();
    assert_eq!(walk.end, mainspring_cspace::End::Arrived);
    let again = map.walk(walk.last(), 0, inside[0] + 6.0 * TAU).unwrap().unwrap();
    let turned = again.last()[1] - walk.last()[1];
    close(turned, -2.0 * TAU, 1e-9);
    assert!(walk.stages.iter().any(|s| s.curve.is_some()));
    let way = map.way(inside, walk.last()).unwrap();
    assert!(map.reaches(inside, walk.last()), "{way:?}");
    // The same place without turning the other wheel cannot be reached.
    assert!(!map.reaches(inside, [inside[0] + TAU, inside[1]]));
}

#[test]
fn a_walk_goes_on_from_where_another_ended_in_contact() {
    let map = space(&gears(6, 9));
    let inside = map.components()[0].inside;
    for k in 1..400 {
        let pushed = inside[0] + 3.0 + 0.01 * f64::from(k);
        let walk = map.walk(inside, 0, pushed).unwrap().unwrap();
        let contact = walk.last();
        // Whichever way rounding took it.
        for off in [-1e-13, -1e-15, 0.0, 1e-15, 1e-13] {
            let from = [contact[0], contact[1] + off];
            let on = map.walk(from, 0, pushed + 0.1).unwrap().unwrap();
            assert_eq!(on.end, mainspring_cspace::End::Arrived);
            assert!(map.reaches(inside, from) && map.component_of(from) == Some(0));
        }
    }
    let channel = map.walk(inside, 0, inside[0] + 3.0).unwrap().unwrap().last();
    // A thousandth of a turn into the flank is no rounding.
    let blocked = [-1e-3, 1e-3].map(|by| map.walk([channel[0], channel[1] + by], 0, 9.0).unwrap());
    assert!(blocked.iter().any(Option::is_none));
}

#[test]
fn parts_that_never_meet_and_parts_that_always_overlap() {
    let far = space(&bars(1.0, 1.0, 3.0));
    assert_eq!(shape(&far), vec![(vec![[1, 0], [0, 1]], 0)]);
    assert!(far.is_free([0.3, 1.0]) && far.curves().is_empty());
    let discs = |d: f64| {
        space(&system(
            vec![
                body("a", vec![turn(0, 0.0, 0.0)], vec![circle(0.0, 0.0, 1.0, true, 0)]),
                body("b", vec![turn(1, d, 0.0)], vec![circle(d, 0.0, 1.0, true, 1)]),
            ],
            4.0,
        ))
    };
    let inside = discs(1.0);
    assert!(inside.components().is_empty() && !inside.is_free([0.3, 1.0]));
    // Touching for ever is no overlap.
    let touching = discs(2.0);
    assert_eq!(shape(&touching), vec![(vec![[1, 0], [0, 1]], 0)]);
}

#[test]
fn a_shaft_in_a_bore_of_its_own_size() {
    // Coincident arcs: the shaft with a key against a ring with a keyway slot wider than the key by ±0.1 rad.
    let map = |bore: f64| {
        let ring = vec![circle(0.0, 0.0, 2.0, true, 0), circle(0.0, 0.0, bore, false, 1)];
        let shaft = vec![circle(0.0, 0.0, 1.0, true, 2)];
        space(&system(
            vec![body("ring", vec![turn(0, 0.0, 0.0)], ring), body("shaft", vec![turn(1, 0.0, 0.0)], shaft)],
            4.0,
        ))
    };
    assert_eq!(shape(&map(1.1)), vec![(vec![[1, 0], [0, 1]], 0)]);
    assert_eq!(shape(&map(1.0)), vec![(vec![[1, 0], [0, 1]], 0)]);
    assert!(map(0.9).components().is_empty());
}

#[test]
fn concentric_stops_leave_a_diagonal_band() {
    // A dog of half angle 0.1 on a disc and a ring with an inner dog: everything depends on y − x alone.
    let dog = |r: f64, s: f64, half: f64| {
        let at = |r: f64, a: f64| (r * f64::cos(a), r * f64::sin(a), 0.0);
        let bulge = (0.5 * half).tan();
        let (mut a, b, mut c, d) = (at(r, half), at(r, -half), at(s, -half), at(s, half));
        a.2 = -bulge;
        c.2 = bulge;
        path(&[a, b, c, d], 0)
    };
    let s = system(
        vec![
            body("a", vec![turn(0, 0.0, 0.0)], vec![dog(0.5, 1.2, 0.1)]),
            body("b", vec![turn(1, 0.0, 0.0)], vec![dog(1.0, 1.5, 0.15)]),
        ],
        3.0,
    );
    let map = space(&s);
    let found = map.components();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].windings.generators(), &[[1, 1]]);
    assert_eq!(found[0].boundary.len(), 2);
    close(found[0].area, TAU * (TAU - 0.5), 1e-6);
    for x in [-3.0, -1.0, 0.2, 2.0] {
        let free: f64 = map.slice_first(x).iter().map(|i| i.high - i.low).sum();
        close(free, TAU - 0.5, 1e-9);
    }
}

#[test]
fn refusals_say_why() {
    let s = bars(1.0, 1.0, 1.5);
    let none = SpaceOptions::default();
    let fails = |s: &System, b, c, o: &SpaceOptions| ConfigurationSpace::new(s, b, c, o).err().unwrap();
    assert!(matches!(fails(&s, [0, 0], [0, 1], &none), SpaceError::Same { .. }));
    assert!(matches!(fails(&s, [0, 1], [1, 1], &none), SpaceError::Same { .. }));
    assert!(matches!(fails(&s, [0, 2], [0, 1], &none), SpaceError::Absent { .. }));
    let rigid = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![rectangle(0.0, 0.0, 1.0, 1.0)]),
        body("b", vec![turn(0, 0.0, 0.0)], vec![rectangle(2.0, 0.0, 3.0, 1.0)]),
    ];
    let e = fails(&system(rigid, 3.0), [0, 1], [0, 1], &none);
    assert_eq!(e.to_string(), "neither coordinate moves a against b: they belong to one subsystem");
    let geared = Joint { coordinate: 0, ratio: -2.0, motion: Motion::Turn { center: common::p(2.0, 0.0) } };
    let twice = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![rectangle(0.0, 0.0, 1.0, 1.0)]),
        Body {
            name: "b".into(),
            chain: vec![geared, turn(1, 3.0, 0.0)],
            outline: outline(vec![rectangle(2.0, 0.0, 3.0, 1.0)]),
        },
    ];
    assert!(matches!(fails(&system(twice, 3.0), [0, 1], [0, 1], &none), SpaceError::MovesTwice { .. }));
    let three = vec![
        body("a", vec![turn(0, 0.0, 0.0)], vec![rectangle(0.0, 0.0, 1.0, 1.0)]),
        body("b", vec![turn(2, 2.0, 0.0), turn(1, 3.0, 0.0)], vec![rectangle(1.5, 0.0, 3.0, 1.0)]),
    ];
    let three = system(three, 3.0);
    assert!(matches!(fails(&three, [0, 1], [0, 1], &none), SpaceError::MoreFreedoms { .. }));
    let held = SpaceOptions { held: vec![(2, 0.4)], ..SpaceOptions::default() };
    assert!(ConfigurationSpace::new(&three, [0, 1], [0, 1], &held).is_ok());
    let wide = SpaceOptions { windows: [Some((0.0, 7.0)), None], ..SpaceOptions::default() };
    assert!(matches!(fails(&s, [0, 1], [0, 1], &wide), SpaceError::Window { .. }));
    let budget = SpaceOptions { budget: 2, ..SpaceOptions::default() };
    assert!(matches!(fails(&s, [0, 1], [0, 1], &budget), SpaceError::TooComplex { budget: 2 }));
    let boxes = vec![
        body("a", vec![slide(0, 1.0, 0.0)], vec![rectangle(0.0, 0.0, 1.0, 0.5)]),
        body("b", vec![slide(1, 0.0, 1.0)], vec![rectangle(0.0, 0.0, 0.25, 2.0)]),
    ];
    assert!(matches!(fails(&system(boxes, 3.0), [0, 1], [0, 1], &none), SpaceError::Window { .. }));
}

#[test]
fn a_part_carried_by_the_other() {
    // A pawl pinned to a turning cam, against a ratchet: the pawl's angle held, the cam and the ratchet turn; and cam
    // held, pawl and ratchet turn. Both agree with the overlap test.
    let pawl = polygon(&[(1.0, -0.1), (1.9, -0.1), (1.9, 0.2), (1.0, 0.1)]);
    let tooth = polygon(&[(-0.4, -0.4), (0.4, -0.4), (1.6, 0.0), (0.4, 0.4), (-0.4, 0.4)]);
    let s = system(
        vec![
            body("pawl", vec![turn(0, 0.0, 0.0), turn(1, 1.0, 0.0)], vec![pawl]),
            body("ratchet", vec![turn(2, 0.3, 0.1)], vec![tooth]),
        ],
        4.0,
    );
    for (coordinates, held) in [([0, 2], 1), ([1, 2], 0), ([0, 1], 2), ([2, 0], 1)] {
        let options = SpaceOptions { held: vec![(held, 0.7)], ..SpaceOptions::default() };
        let map =
            ConfigurationSpace::new(&s, [0, 1], coordinates, &options).unwrap_or_else(|e| panic!("{e}"));
        let mut random = common::Random(7);
        let (mut free, mut wrong) = (0, 0);
        for _ in 0..4000 {
            let q = [random.next(-PI, PI), random.next(-PI, PI)];
            let mut all = [0.7; 3];
            all[coordinates[0]] = q[0];
            all[coordinates[1]] = q[1];
            let says = map.is_free(q);
            free += usize::from(says);
            wrong += usize::from(says == common::oracle::overlap(&s.bodies[0], &s.bodies[1], &all));
        }
        assert_eq!(wrong, 0, "{coordinates:?}");
        assert!(free > 100 && free < 3900, "{coordinates:?}: {free}");
    }
}
