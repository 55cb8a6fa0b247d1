//! Places of contact along one joint's motion, in closed form, against gaps evaluated along it.

use mainspring_geometry::Vec2;
use mainspring_mechanism::{Feature, GapKind, GapState, Motion, Pose, Sway, features, gap_state, places};
use shapes::{outline, p};
use std::f64::consts::PI;

#[path = "support/shapes.rs"]
mod shapes;

/// One pair of features and one motion of the first body.
struct Case<'f> {
    kind: GapKind,
    features: (&'f Feature, &'f Feature),
    poses: (Pose, Pose),
    sway: Sway,
}

impl Case<'_> {
    fn at(&self, offset: f64) -> GapState {
        let motion = match self.sway {
            Sway::Turn { center } => Motion::Turn { center },
            Sway::Slide { direction } => Motion::Slide { direction },
        };
        let moved = motion.pose(offset).then_after(&self.poses.0);
        gap_state(self.kind, self.features.0, self.features.1, &moved, &self.poses.1)
    }

    /// Every place has gap zero, with margins and a direction as evaluated there.
    fn check_places(&self) -> usize {
        let found = places(self.kind, self.features, (&self.poses.0, &self.poses.1), &self.sway);
        for place in found.into_iter().flatten().filter(|place| place.offset.abs() < 100.0) {
            let state = self.at(place.offset);
            assert!(state.gap.abs() < 1e-8, "{place:?} {}", state.gap);
            if state.edge_margin.is_finite() {
                assert!((state.edge_margin - place.edge_margin).abs() < 1e-7, "{place:?} {state:?}");
            }
            assert!((state.cone_margin - place.cone_margin).abs() < 1e-7, "{place:?} {state:?}");
            let (before, after) = (self.at(place.offset - 1e-6).gap, self.at(place.offset + 1e-6).gap);
            if (after - before).abs() > 1e-9 {
                assert_eq!(f64::from(place.closes), (before - after).signum(), "{place:?}");
            }
        }
        found.into_iter().flatten().count()
    }

    /// Every change of sign of the gap along the motion is a place.
    fn check_none_missed(&self) {
        let found = places(self.kind, self.features, (&self.poses.0, &self.poses.1), &self.sway);
        let mut before = (-PI, self.at(-PI).gap);
        for n in -199..=200 {
            let x = PI * f64::from(n) / 200.0;
            let gap = self.at(x).gap;
            if gap * before.1 < 0.0 {
                let within = |offset: f64| offset > before.0 - 1e-9 && offset < x + 1e-9;
                assert!(found.iter().flatten().any(|place| within(place.offset)), "{x} {found:?}");
            }
            before = (x, gap);
        }
    }
}

#[test]
fn places_are_where_gaps_are_zero() {
    let mut seed = 3u64;
    let mut next = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (first, second) = (features(&outline(p(0.0, 0.0)), 5.0), features(&outline(p(0.4, -0.2)), 5.0));
    let mut count = 0;
    for round in 0..200 {
        let mut pose = || {
            let (sin, cos) = next(-PI, PI).sin_cos();
            Pose { cos, sin, shift: Vec2::new(next(-2.0, 2.0), next(-2.0, 2.0)) }
        };
        let poses = (pose(), pose());
        let (sin, cos) = next(-PI, PI).sin_cos();
        let turn = Sway::Turn { center: Vec2::new(next(-3.0, 3.0), next(-3.0, 3.0)) };
        let sway = if round % 2 == 0 { turn } else { Sway::Slide { direction: Vec2::new(cos, sin) } };
        for a in &first {
            for b in &second {
                let Some(kind) = GapKind::of(a, b) else { continue };
                let case = Case { kind, features: (a, b), poses, sway };
                count += case.check_places();
                case.check_none_missed();
            }
        }
    }
    assert!(count > 5000, "{count}");
}
