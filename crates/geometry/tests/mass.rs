//! Mass properties against closed forms.

mod common;
use common::{Random, Solid, v};
use mainspring_geometry::{Axis, MassProperties, Rigid3, Shape, Vec3, mass_properties};
use std::f64::consts::PI;

fn mass(s: &Solid) -> MassProperties {
    mass_properties(&s.primitives, &s.csg).expect("sound input")
}

fn about_z(m: &MassProperties, x: f64, y: f64) -> f64 {
    m.moment_about(Vec3::new(x, y, 0.0), v(0.0, 0.0, 2.0))
}

fn near(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

#[test]
fn a_block_and_a_bushing() {
    let m = mass(&Solid::block(2.0, 3.0, 5.0).at(7.0, 0.0, 0.0));
    assert_eq!(m.error, 0.0);
    assert!(near(m.volume, 30.0, 1e-14) && near(m.center.x, 8.0, 1e-14));
    assert!(near(about_z(&m, 8.0, 1.5), 30.0 * (4.0 + 9.0) / 12.0, 1e-13));
    assert!(near(about_z(&m, 0.0, 1.5), 30.0 * (13.0 / 12.0 + 64.0), 1e-13));
    let x = m.moment_about(Vec3::new(0.0, 1.5, 2.5), v(1.0, 0.0, 0.0));
    assert!(near(x, 30.0 * (9.0 + 25.0) / 12.0, 1e-13));
    let ring = mass(&Solid::cylinder(4.0, 3.0).dif(Solid::cylinder(2.0, 3.0)));
    assert!(near(ring.volume, 9.0 * PI, 1e-13));
    assert!(near(about_z(&ring, 0.0, 0.0), 0.5 * 9.0 * PI * (4.0 + 1.0), 1e-13));
    let across = ring.moment_about(ring.center, v(1.0, 1.0, 0.0));
    assert!(near(across, 9.0 * PI * (3.0 * 5.0 + 9.0) / 12.0, 1e-13));
}

#[test]
fn a_half_disc_with_its_centroid() {
    let half = Solid::cylinder(2.0, 1.0).int(Solid::block(2.0, 1.0, 1.0).at(-1.0, 0.0, 0.0));
    let m = mass(&half);
    assert!(near(m.center.y, 4.0 / (3.0 * PI), 1e-13) && m.center.x.abs() < 1e-15);
    assert!(near(about_z(&m, 0.0, 0.0), PI / 4.0, 1e-13));
    let (i, k) = (m.second_moments[0][0], m.second_moments[1][1]);
    assert!(near(i, PI / 8.0, 1e-13) && near(k, PI / 8.0 - 8.0 / (9.0 * PI), 1e-12));
}

#[test]
fn a_tilted_prism_is_exact_too() {
    let solid = Solid::block(2.0, 3.0, 5.0).un(Solid::cylinder(1.0, 6.0));
    let upright = mass(&solid);
    let turn = Rigid3::rotation(Axis::X, 0.4).then_after(&Rigid3::rotation(Axis::Y, 1.1));
    let place = Rigid3::translation(v(1.0, -2.0, 3.0)).then_after(&turn);
    let tilted = mass(&solid.moved(place));
    assert_eq!(tilted.error, 0.0);
    let center = place.apply(upright.center);
    assert!((tilted.center - center).norm() < 1e-12);
    for d in [v(1.0, 0.0, 0.0), v(0.3, -0.5, 2.0)] {
        let (a, b) = (upright.moment_about(v(1.0, 1.0, 1.0), d), place.rotate(d));
        assert!(near(tilted.moment_about(place.apply(v(1.0, 1.0, 1.0)), b), a, 1e-12));
    }
}

#[test]
fn round_and_slanted_solids_to_the_accuracy_they_state() {
    let (r, h) = (1.5, 2.0);
    let cone = mass(&Solid::of(Shape::Cone { radius: r, height: h }).at(1.0, 2.0, 3.0));
    let volume = PI * r * r * h / 3.0;
    assert!(near(cone.volume, volume, 1e-4) && near(cone.center.z, 3.0 + 0.25 * h, 1e-4));
    assert!(near(about_z(&cone, 1.0, 2.0), 0.3 * volume * r * r, 2e-4));
    let sphere = mass(&Solid::of(Shape::Sphere { radius: r }));
    let volume = 4.0 / 3.0 * PI * r.powi(3);
    assert!(
        near(sphere.volume, volume, 1e-4) && near(about_z(&sphere, 0.0, 0.0), 0.4 * volume * r * r, 2e-4)
    );
    assert!(near(sphere.moment_about(sphere.center, v(1.0, 0.0, 0.0)), 0.4 * volume * r * r, 2e-4));
    let wedge = mass(&Solid::of(Shape::Wedge { x: 2.0, y: 3.0, z: 1.0 }));
    assert!(near(wedge.volume, 3.0, 1e-4));
    assert!(near(wedge.center.x, 2.0 / 3.0, 1e-4) && near(wedge.center.z, 1.0 / 3.0, 1e-4));
    for m in [cone, sphere, wedge] {
        assert!(m.error > 0.0 && m.error < 1e-4, "{}", m.error);
    }
}

#[test]
fn a_bored_sphere_keeps_only_its_height() {
    // The napkin ring: what is left of a bored sphere depends on its height alone.
    let h: f64 = 2.0;
    for r in [1.3_f64, 2.0] {
        let bore = 2.0 * (r * r - 0.25 * h * h).sqrt();
        let ball = Solid::of(Shape::Sphere { radius: r });
        let ring = mass(&ball.dif(Solid::cylinder(bore, 2.0 * r).at(0.0, 0.0, -r)));
        assert!(near(ring.volume, PI * h.powi(3) / 6.0, 1e-3), "{}", ring.volume);
    }
}

#[test]
fn both_methods_agree_on_random_prisms() {
    let mut r = Random(0x5eed_0007);
    for _ in 0..2 {
        let mut s = Solid::block(2.0, 2.0, 1.0);
        for k in 0..4 {
            let (d, x, y) = (r.within(0.5, 2.0), r.within(-1.0, 3.0), r.within(-1.0, 3.0));
            let c = Solid::cylinder(d, 1.0).at(x, y, r.within(-0.5, 0.5));
            s = if k % 2 == 0 { s.un(c) } else { s.dif(c) };
        }
        let exact = mass(&s);
        // A tiny sphere makes the same part unplanar in every direction.
        let round = mass(&s.un(Solid::of(Shape::Sphere { radius: 1e-3 }).at(1.0, 1.0, 1.0)));
        assert!(exact.error == 0.0 && round.error > 0.0);
        assert!(near(round.volume, exact.volume, 1e-3));
        assert!(near(about_z(&round, 0.0, 0.0), about_z(&exact, 0.0, 0.0), 1e-3));
    }
}

#[test]
fn nothing_weighs_nothing() {
    let m = mass(&Solid::block(1.0, 1.0, 1.0).dif(Solid::block(1.0, 1.0, 1.0)));
    assert_eq!((m.volume, about_z(&m, 3.0, 0.0)), (0.0, 0.0));
}
