//! Volume, centre and inertia of a part of unit density.

use crate::columns::integrate;
use crate::moments::Moments;
use crate::tree::Tree;
use crate::{Bounds3, Csg, OutlineBudget, OutlineError, OutlineRecipe, Primitive, Rigid3, Vec2, Vec3};

/// Mass properties of a part of unit density, in powers of the file's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    pub volume: f64,
    /// Centre of mass in the machine's coordinates; the origin for an empty part.
    pub center: Vec3,
    /// ∫ (p − center)(p − center)ᵀ, rows of a symmetric matrix along the machine's axes.
    pub second_moments: [[f64; 3]; 3],
    /// Estimated relative error of volume and moments: 0 where they come exactly from an outline (to
    /// rounding), else the change at the last refinement of a numerical integration, usually below 1e-4.
    pub error: f64,
}

impl MassProperties {
    /// Moment of inertia about the axis through `point` along `direction` (any length but zero):
    /// tr C − d·C d about the parallel axis through the centre, plus volume times distance².
    pub fn moment_about(&self, point: Vec3, direction: Vec3) -> f64 {
        let d = direction.unit();
        let e = [d.x, d.y, d.z];
        let c = &self.second_moments;
        let along: f64 = (0..3).flat_map(|i| (0..3).map(move |j| c[i][j] * e[i] * e[j])).sum();
        let arm = (self.center - point).cross(d);
        c[0][0] + c[1][1] + c[2][2] - along + self.volume * arm.dot(arm)
    }
}

/// Volume, centre and second moments of a part of unit density: exact for a part that is planar in some
/// direction (a coordinate axis or an axis of one of its first primitives), from its outline by Green's
/// theorem; numerical for any other.
///
/// # Errors
/// [`OutlineError::Malformed`] only.
pub fn mass_properties(primitives: &[Primitive], csg: &Csg) -> Result<MassProperties, OutlineError> {
    mass_properties_within(primitives, csg, MASS_WORK, &mut OutlineBudget::default())
}

/// What [`mass_properties`] spends on a numerical integration, in primitives met by columns: half a second at most.
pub const MASS_WORK: usize = 8_000_000;

/// As [`mass_properties`], with at most `work` spent on a numerical integration, which is made where the outlines
/// tried cost more than `budget`: with less the error grows.
///
/// # Errors
/// As [`mass_properties`].
pub fn mass_properties_within(
    primitives: &[Primitive],
    csg: &Csg,
    work: usize,
    budget: &mut OutlineBudget,
) -> Result<MassProperties, OutlineError> {
    let tree = Tree::new(csg).ok_or(OutlineError::Malformed { primitive: None })?;
    let absent = tree.primitives().find(|&i| primitives.get(i as usize).is_none());
    if absent.is_some() {
        return Err(OutlineError::Malformed { primitive: absent });
    }
    for plane in planes(primitives, &tree) {
        match OutlineRecipe::find_within(primitives, csg, &plane, budget) {
            Ok(recipe) => return Ok(of_prism(&recipe, primitives, &plane)),
            Err(error @ OutlineError::Malformed { .. }) => return Err(error),
            Err(_) => {}
        }
    }
    let bounds = tree.bounds(|i| Bounds3::of(&primitives[i as usize], &Rigid3::identity()));
    if bounds.is_empty() {
        return Ok(finish(&Moments::default(), Vec3::new(0.0, 0.0, 0.0), 0.0));
    }
    let (moments, error) = integrate(primitives, &tree, &bounds, work);
    let middle = [0, 1, 2].map(|k| 0.5 * (bounds.min[k] + bounds.max[k]));
    Ok(finish(&moments, Vec3::new(middle[0], middle[1], middle[2]), error))
}

/// Primitives whose axes are tried as the normal of the working plane.
const TRIED: usize = 4;

/// Working planes to try, by their normals.
fn planes(primitives: &[Primitive], tree: &Tree) -> Vec<Rigid3> {
    let [x, y, z] = Rigid3::<f64>::identity().columns;
    let own = tree.primitives().take(TRIED).flat_map(|i| primitives[i as usize].machine_from_local.columns);
    let mut normals: Vec<Vec3> = Vec::new();
    for n in [z, x, y].into_iter().chain(own) {
        if n.norm() > 0.5 && normals.iter().all(|m| m.cross(n).norm() > 1e-9) {
            normals.push(n.unit());
        }
    }
    normals.into_iter().map(plane_across).collect()
}

/// Coordinates whose third axis is the unit vector `n`.
fn plane_across(n: Vec3) -> Rigid3 {
    let [x, y, z] = Rigid3::<f64>::identity().columns;
    let helper = if n.x.abs() < 0.5 { x } else { y };
    let u = if n == z { x } else { helper.cross(n).unit() };
    let machine_from_plane = Rigid3 { columns: [u, n.cross(u), n], translation: Vec3::new(0.0, 0.0, 0.0) };
    machine_from_plane.inverse()
}

/// Of unit density, from an outline known already: exact.
///
/// # Panics
/// If `primitives` is not the list the recipe was found on.
pub fn mass_properties_of_outline(
    recipe: &OutlineRecipe,
    primitives: &[Primitive],
    plane_from_machine: &Rigid3,
) -> MassProperties {
    of_prism(recipe, primitives, plane_from_machine)
}

fn of_prism(recipe: &OutlineRecipe, primitives: &[Primitive], plane: &Rigid3) -> MassProperties {
    let outline = recipe.evaluate(primitives, plane);
    let Some((min, max)) = outline.bounds() else {
        return finish(&Moments::default(), Vec3::new(0.0, 0.0, 0.0), 0.0);
    };
    let middle = (min + max) * 0.5;
    let height = 0.5 * (outline.layers[0].bottom + outline.layers[outline.layers.len() - 1].top);
    let mut total = Moments::default();
    for layer in &outline.layers {
        let mut flat = Moments::default();
        for edge in layer.loops.iter().flat_map(|l| &l.edges) {
            flat.add(&Moments::swept(&edge.segment.moved(-middle)));
        }
        total.add(&flat.extruded(layer.bottom - height, layer.top - height));
    }
    let back = plane.inverse();
    finish(&total.rotated(&back), back.apply(Vec3::new(middle.x, middle.y, height)), 0.0)
}

/// From moments about `origin`, along the machine's axes.
fn finish(about: &Moments, origin: Vec3, error: f64) -> MassProperties {
    let volume = about.zeroth;
    if volume <= 0.0 {
        return MassProperties {
            volume: 0.0,
            center: Vec3::new(0.0, 0.0, 0.0),
            second_moments: [[0.0; 3]; 3],
            error,
        };
    }
    let c = about.first.map(|k| k / volume);
    let centered = about.moved(c.map(|k| -k));
    let center = origin + Vec3::new(c[0], c[1], c[2]);
    MassProperties { volume, center, second_moments: centered.second, error }
}

impl crate::Segment<f64> {
    /// The same segment elsewhere.
    pub(crate) fn moved(&self, by: Vec2) -> Self {
        use crate::Segment::{Arc, Circle, Line};
        match *self {
            Line { from, to } => Line { from: from + by, to: to + by },
            Arc { from, to, center, radius, convex } => {
                Arc { from: from + by, to: to + by, center: center + by, radius, convex }
            }
            Circle { center, radius, convex } => Circle { center: center + by, radius, convex },
        }
    }
}
