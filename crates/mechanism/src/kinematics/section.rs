//! How a part held by surfaces parallel to a direction can move across it.
//!
//! Seen along the direction, motion is a planar twist (v, ω). Where the parts meet at p with normal n out of the
//! moving part, material forbids n·(v + ω × p) > 0. All such half-spaces together leave a cone of twists; its shape
//! tells the pair: nothing left is a prismatic fit, one turning twist and its opposite a round one.

use super::work::Work;
use mainspring_geometry::Vec2;

/// A constraint on (vx, vy, ω): the product must not be positive.
pub(crate) type Wall = [f64; 3];

/// The constraint of a contact at `p` with unit normal `n`; `p` in units of the fit's size.
pub(crate) fn wall(p: Vec2, n: Vec2) -> Wall {
    [n.x, n.y, p.cross(n)]
}

/// What the walls leave free across the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Section {
    /// Nothing.
    Locked,
    /// Only leaving along a direction, one way: a channel open on one side.
    LockedOpen { exit: Vec2 },
    /// Turning about a centre, both ways.
    Turning { center: Vec2 },
    /// Turning about a centre, and leaving one way: half a bearing.
    TurningOpen { center: Vec2, exit: Vec2 },
    /// More than that.
    Free,
}

/// Products of unit vectors below this count as zero.
const NEARLY_ZERO: f64 = 1e-7;
/// More different walls than this are not examined singly: every so-many-th is.
const MAX_WALLS: usize = 160;

/// Where the work runs out, anything may seem free.
pub(crate) fn section(walls: &[Wall], work: &Work) -> Section {
    let walls = distinct(walls, work);
    let Some((first, second)) = spanning(&walls) else { return Section::Free };
    let t = unit(cross(first, second));
    if walls.iter().any(|w| dot(*w, t).abs() > NEARLY_ZERO) {
        return pointed(&walls, work);
    }
    if t[2].abs() < NEARLY_ZERO {
        return Section::Free;
    }
    let center = Vec2::new(-t[1] / t[2], t[0] / t[2]);
    around_center(&walls, center)
}

/// Do the walls allow turning about a centre, one way at least?
pub(crate) fn may_turn(walls: &[Wall], center: Vec2) -> bool {
    let turn = [center.y, -center.x, 1.0];
    [1.0, -1.0].into_iter().any(|sign| walls.iter().all(|w| sign * dot(unit(*w), turn) <= NEARLY_ZERO))
}

/// Walls of rank 3: the cone is given by its extreme rays, where two walls hold with equality.
fn pointed(walls: &[Wall], work: &Work) -> Section {
    let mut rays: Vec<Wall> = Vec::new();
    for (i, a) in walls.iter().enumerate() {
        if !work.spend(i / 2) {
            return Section::Free;
        }
        for b in &walls[..i] {
            let t = cross(*a, *b);
            if dot(t, t).sqrt() < NEARLY_ZERO {
                continue;
            }
            for t in [unit(t), unit(t).map(|c| -c)] {
                let allowed = walls.iter().all(|w| dot(*w, t) <= NEARLY_ZERO);
                if allowed && rays.iter().all(|r| dot(*r, t) < 1.0 - 1e-9) {
                    rays.push(t);
                }
            }
        }
    }
    match rays[..] {
        [] => Section::Locked,
        [t] if t[2].abs() < NEARLY_ZERO => Section::LockedOpen { exit: Vec2::new(t[0], t[1]).unit() },
        _ => Section::Free,
    }
}

/// All walls pass through a centre: do their normals leave a way out?
fn around_center(walls: &[Wall], center: Vec2) -> Section {
    let mut angles: Vec<f64> = walls.iter().map(|w| w[1].atan2(w[0])).collect();
    angles.sort_by(f64::total_cmp);
    let turn = std::f64::consts::TAU;
    let (mut widest, mut after) = (0.0, 0.0);
    for (i, &a) in angles.iter().enumerate() {
        let next = if i + 1 < angles.len() { angles[i + 1] } else { angles[0] + turn };
        if next - a > widest {
            (widest, after) = (next - a, a);
        }
    }
    let half = 0.5 * turn;
    if widest < half - NEARLY_ZERO {
        Section::Turning { center }
    } else if widest <= half + NEARLY_ZERO {
        let (sin, cos) = (after + 0.5 * widest).sin_cos();
        Section::TurningOpen { center, exit: Vec2::new(cos, sin) }
    } else {
        Section::Free
    }
}

fn distinct(walls: &[Wall], work: &Work) -> Vec<Wall> {
    let mut sorted: Vec<Wall> = walls.iter().map(|w| unit(*w)).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(a[2].total_cmp(&b[2])));
    let mut kept: Vec<Wall> = Vec::new();
    for w in sorted {
        if !work.spend(kept.len() / 8 + 1) {
            break;
        }
        if kept.iter().all(|k| dot(*k, w) < 1.0 - 1e-12) {
            kept.push(w);
        }
    }
    let stride = kept.len().div_ceil(MAX_WALLS).max(1);
    kept.into_iter().step_by(stride).collect()
}

/// Two walls that are not parallel, as different as can be; none if there are none.
fn spanning(walls: &[Wall]) -> Option<(Wall, Wall)> {
    let first = *walls.first()?;
    let size = |w: &Wall| dot(cross(first, *w), cross(first, *w));
    let second = *walls.iter().max_by(|a, b| size(a).total_cmp(&size(b)))?;
    (size(&second).sqrt() > NEARLY_ZERO).then_some((first, second))
}

fn dot(a: Wall, b: Wall) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Wall, b: Wall) -> Wall {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Wall) -> Wall {
    let n = dot(a, a).sqrt();
    if n > 0.0 { a.map(|c| c / n) } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(walls: &[Wall]) -> Section {
        super::section(walls, &Work::new(10_000))
    }

    fn v(x: f64, y: f64) -> Vec2 {
        Vec2::new(x, y)
    }

    fn side(n: Vec2, from: Vec2, to: Vec2) -> [Wall; 2] {
        [wall(from, n), wall(to, n)]
    }

    fn box_sides() -> [[Wall; 2]; 4] {
        [
            side(v(-1., 0.), v(-1., -1.), v(-1., 1.)),
            side(v(1., 0.), v(1., -1.), v(1., 1.)),
            side(v(0., -1.), v(-1., -1.), v(1., -1.)),
            side(v(0., 1.), v(-1., 1.), v(1., 1.)),
        ]
    }

    #[test]
    fn four_sides_lock_and_three_leave_one_exit() {
        let sides = box_sides();
        assert_eq!(section(&sides.concat()), Section::Locked);
        assert_eq!(section(&sides[..3].concat()), Section::LockedOpen { exit: v(0.0, 1.0) });
        assert_eq!(section(&sides[..2].concat()), Section::Free);
    }

    #[test]
    fn three_sides_of_a_triangle_lock() {
        let corners = [v(0., 0.), v(4., 0.), v(1., 3.)];
        let walls: Vec<Wall> = (0..3)
            .flat_map(|i| {
                let (p, q) = (corners[i], corners[(i + 1) % 3]);
                side(-(q - p).unit().perp(), p, q)
            })
            .collect();
        assert_eq!(section(&walls), Section::Locked);
    }

    #[test]
    fn round_fits_need_more_than_half_a_turn() {
        let center = v(0.3, -0.2);
        let arc = |degrees: f64| -> Vec<Wall> {
            (0..=8)
                .map(|k| {
                    let (s, c) = (degrees.to_radians() * k as f64 / 8.0).sin_cos();
                    wall(center + v(c, s) * 0.5, v(c, s))
                })
                .collect()
        };
        let Section::Turning { center: found } = section(&arc(200.0)) else { panic!("not turning") };
        assert!((found - center).norm() < 1e-12);
        assert!(matches!(section(&arc(180.0)), Section::TurningOpen { .. }));
        assert_eq!(section(&arc(170.0)), Section::Free);
    }

    #[test]
    fn a_flat_across_a_round_fit_locks_it() {
        let mut walls: Vec<Wall> = (0..6)
            .map(|k| {
                let (s, c) = (k as f64).sin_cos();
                wall(v(c, s), v(c, s))
            })
            .collect();
        walls.extend(side(v(1., 0.), v(0.9, -0.4), v(0.9, 0.4)));
        assert_eq!(section(&walls), Section::Locked);
    }
}
