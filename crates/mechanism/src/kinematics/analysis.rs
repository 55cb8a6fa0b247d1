//! From shapes to pairs in the machine: lower pairs, gears, what the pairs forbid each other, what nothing uses.

use super::axial;
use super::fits::Solid;
use super::gears::{GearData, meshes};
use super::lower::{MAX_MISSES, MAX_NEIGHBOURS, lower_pairs};
use super::mechanism::{CompileOptions, Warning};
use super::mobility::{ClosedChain, Loops, loops, without};
use super::near_miss::Miss;
use super::pair::{Dropped, Freedom, Pair, PairKind};
use super::patch::Scene;
use super::plane::{self, WorkingPlane};
use super::reach::{Parts, Placed};
use super::subsystems::{Hold, holds};
use super::{flat_pairs, stated};
use mainspring_geometry::{Csg, Outline, OutlineBudget, OutlineRecipe, Rigid3, Vec3};
use mainspring_model::{PartModel, Supplement};

/// The shapes of all parts.
pub(crate) struct Shapes<'a> {
    pub scene: &'a Scene<'a>,
    pub solids: &'a [Solid<'a>],
    pub csgs: &'a [&'a Csg],
    pub leaves: &'a [Vec<u32>],
    pub label: &'a dyn Fn(u32) -> String,
    pub models: &'a [PartModel],
    /// Motions and gears that the file states.
    pub stated: &'a Supplement,
}

/// What the shapes say about motion.
pub(crate) struct Found {
    pub pairs: Vec<Pair>,
    pub misses: Vec<Miss>,
    pub plane: WorkingPlane,
    pub closed_chains: Vec<ClosedChain>,
    pub mobility: usize,
    pub warnings: Vec<Warning>,
    /// Rates of the pairs of each closed chain that has one motion.
    pub rates: Vec<Vec<(usize, f64)>>,
}

pub(crate) fn analyse(
    shapes: &Shapes<'_>,
    gears: &[GearData],
    frame: usize,
    size: f64,
    options: &CompileOptions,
) -> Found {
    let scene = shapes.scene;
    let parts = shapes.csgs.len();
    let lower = lower_pairs(scene, shapes.solids, options.pair_clearance);
    let (mut pairs, mut misses) = (lower.pairs, lower.misses);
    let meshes = meshes(gears, &pairs, scene.tolerance);
    pairs.extend(meshes.pairs);
    pairs.extend(drawn_pairs(shapes, options.pair_clearance));
    pairs.sort_by_key(|p| (!p.is_lower(), p.parts));
    let told = stated::apply(&mut pairs, shapes.stated, frame, scene.tolerance);
    let many = misses.len() > MAX_MISSES;
    misses.truncate(MAX_MISSES);
    misses.extend(meshes.misses);
    let mut warnings: Vec<Warning> = meshes.warnings.into_iter().map(plain).collect();
    warnings.extend(told);
    warnings.extend(cut_short(&lower.cut_short));
    let partly = "the parts have too many faces: near misses were not looked for everywhere";
    warnings.extend(lower.misses_cut_short.then(|| plain(partly.into())));
    let crowded = format!("only the first {MAX_NEIGHBOURS} pairs of parts near each other were examined");
    warnings.extend(lower.crowded.then(|| plain(crowded)));
    warnings.extend(many.then(|| plain(format!("only the first {MAX_MISSES} near misses are listed"))));

    let (loops, too_large) = loops(parts, frame, &pairs, size);
    warnings.extend(
        too_large.iter().map(|p| plain(format!("a loop of {} parts is too large to be examined", p.len()))),
    );
    // Gears that lock each other are told as such: their pairs stay what they are.
    let linkages = loops.iter().filter(|l| !l.gears_only);
    let blocked: Vec<(usize, Freedom)> = linkages.flat_map(Loops::unavailable).collect();
    for (index, freedom) in &blocked {
        drop_freedom(&mut pairs[*index], *freedom, true, "the other pairs of its loop forbid it".into());
    }
    let plane = plane::choose(&pairs, scene.primitives, shapes.csgs);
    let mut left_out = blocked;
    if !options.keep_axial {
        let idle = idle(shapes, &pairs, frame, &plane, &loops);
        for (index, freedom) in &idle.left_out {
            drop_freedom(&mut pairs[*index], *freedom, false, idle_reason(*freedom));
        }
        left_out.extend(&idle.left_out);
        warnings.extend(idle.kept.iter().map(|(index, why)| kept(&pairs[*index], why)));
    }
    let closed_chains = chains(&loops, &left_out);
    let mobility = mobility(&pairs, &loops, &left_out);
    let linkages = loops.iter().filter(|l| !l.gears_only);
    let rates = linkages.filter_map(|l| l.rates(&left_out)).collect();
    let plane = WorkingPlane { planar: plane::is_planar(&pairs, plane.normal), ..plane };
    Found { pairs, misses, plane, closed_chains, mobility, warnings, rates }
}

/// Pairs with drawn parts whose motion is not stated, by their boundaries in the plane z = 0.
fn drawn_pairs(shapes: &Shapes<'_>, clearance: f64) -> Vec<Pair> {
    let Scene { primitives, tolerance, .. } = *shapes.scene;
    let is_free =
        |i: usize| shapes.models[i].walls.is_some() && !shapes.stated.motions.iter().any(|m| m.part == i);
    let n = shapes.models.len();
    if !(0..n).any(is_free) {
        return vec![];
    }
    let (plane, mut budget) = (Rigid3::identity(), OutlineBudget::default());
    let mut outline = |i: usize| {
        let recipe = match &shapes.models[i].walls {
            Some(walls) => OutlineRecipe::of_walls(primitives, walls, &plane),
            None => budget.half(|b| OutlineRecipe::find_within(primitives, shapes.csgs[i], &plane, b)),
        };
        recipe.ok().map(|r| r.evaluate(primitives, &plane))
    };
    let outlines: Vec<Option<Outline>> = (0..n).map(&mut outline).collect();
    let mut found = Vec::new();
    for i in 0..n {
        for j in (i + 1..n).filter(|&j| is_free(i) || is_free(j)) {
            let near = shapes.solids[i].bounds.grown(clearance + tolerance).touches(&shapes.solids[j].bounds);
            if let (true, Some(a), Some(b)) = (near, &outlines[i], &outlines[j]) {
                found.extend(flat_pairs::find([a, b], (i, j), clearance, tolerance));
            }
        }
    }
    found
}

fn cut_short(pairs: &[(usize, usize)]) -> Option<Warning> {
    let &(first, second) = pairs.first()?;
    let others = match pairs.len() - 1 {
        0 => String::new(),
        n => format!(" (and so have {n} other pairs of parts)"),
    };
    let message =
        format!("these parts have too many faces against each other{others}: only the first were examined");
    Some(Warning { place: None, parts: vec![first, second], message })
}

fn plain(message: String) -> Warning {
    Warning { place: None, parts: vec![], message }
}

fn idle(
    shapes: &Shapes<'_>,
    pairs: &[Pair],
    frame: usize,
    plane: &WorkingPlane,
    loops: &[Loops],
) -> axial::Idle {
    let holds = holds(shapes.csgs.len(), frame, pairs);
    axial::idle(&shapes.parts(&holds, pairs, plane.normal), loops, shapes.label)
}

impl Shapes<'_> {
    pub(crate) fn parts<'a>(
        &'a self,
        holds: &'a [Option<Hold>],
        pairs: &'a [Pair],
        normal: Vec3,
    ) -> Parts<'a> {
        let Scene { primitives, boxes, tolerance, .. } = *self.scene;
        Parts::new(
            Placed { primitives, boxes, csgs: self.csgs, leaves: self.leaves, tolerance },
            holds,
            pairs,
            normal,
        )
    }
}

fn drop_freedom(pair: &mut Pair, freedom: Freedom, blocked: bool, reason: String) {
    pair.kind = without(pair.kind, freedom);
    pair.dropped.push(Dropped { freedom, blocked, reason });
}

fn idle_reason(freedom: Freedom) -> String {
    match freedom {
        Freedom::Sliding => {
            "no spring, force, initial velocity, other pair or possible contact normal has a \
                             component along the axis"
                .into()
        }
        Freedom::Turning => "all motion is planar and the axis lies in the plane: no spring, force, initial \
                             velocity or other pair turns the part about it"
            .into(),
    }
}

fn kept(pair: &Pair, why: &str) -> Warning {
    let parts = vec![pair.parts.0, pair.parts.1];
    Warning { place: None, parts, message: format!("this cylindrical pair keeps both freedoms: {why}") }
}

/// The loops to be told: all but trains of gears that can move.
fn chains(loops: &[Loops], left_out: &[(usize, Freedom)]) -> Vec<ClosedChain> {
    let tell = |l: &Loops| ClosedChain {
        parts: l.parts.clone(),
        mobility: l.mobility(left_out),
        gears_only: l.gears_only,
    };
    loops.iter().map(tell).filter(|c| !c.gears_only || c.mobility == 0).collect()
}

/// Free motions of the loops, and one for each freedom of the pairs in none.
fn mobility(pairs: &[Pair], loops: &[Loops], left_out: &[(usize, Freedom)]) -> usize {
    let alone =
        |(index, p): &(usize, &Pair)| p.kind != PairKind::Gear && !loops.iter().any(|l| l.has(*index));
    let freedoms = |p: &Pair| usize::from(p.kind.turns()) + usize::from(p.kind.slides());
    let open: usize = pairs.iter().enumerate().filter(alone).map(|(_, p)| freedoms(p)).sum();
    open + loops.iter().map(|l| l.mobility(left_out)).sum::<usize>()
}
