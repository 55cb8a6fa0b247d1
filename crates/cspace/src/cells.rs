//! The search for curves that matter: boxes of configurations, halved until few feature pairs can touch in each.
//!
//! A box in which no pair can touch is free or blocked throughout; one that is surely blocked (`proofs`) bounds no free
//! space. Both are left at once, so the cost follows the free boundary and not the number of all curves. In a small box
//! the curves' elements are cut against each other. Free space ends only at contacts, and no end of a free stretch lies
//! in a surely blocked box: every such end is found.

use crate::around::Around;
use crate::cross::Cuts;
use crate::error::SpaceError;
use crate::pairs::{Catalogue, Cell};
use crate::progress::Progress;
use crate::proofs::Proofs;
use crate::tree::Discs;

/// Feature pairs at which a box is no longer halved.
const FEW: usize = 30;
/// Feature pairs and pairs of tree nodes above which nodes are not opened for their own sake.
const MANY: usize = 4 * FEW;
/// Pairs of tree nodes opened in one box at most.
const OPENED: usize = 300;
/// A box is not halved when its motion is below this part of the size.
const SMALL: f64 = 1e-3;

/// Boxes after which progress is told.
const TELL: usize = 1000;

/// What the search did: counts of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Boxes looked at.
    pub cells: usize,
    /// Of these, boxes proved blocked.
    pub blocked: usize,
    /// Boxes in which curves were cut against each other.
    pub leaves: usize,
    /// Feature pairs with curves made.
    pub pairs: usize,
    /// Elements of those curves.
    pub elements: usize,
    /// Stretches tested for being free.
    pub tested: usize,
}

type Front = Vec<(u32, u32)>;

pub(crate) fn search(
    catalogue: &mut Catalogue,
    proofs: &mut Proofs,
    cuts: &mut Cuts,
    (budget, progress): (usize, &Progress),
) -> Result<Work, SpaceError> {
    let mut work = Work::default();
    if catalogue.trees.iter().any(|t| t.nodes.is_empty()) {
        return Ok(work);
    }
    let whole = Cell::whole(&catalogue.frame.axes);
    let levers = [0, 1].map(|k| catalogue.parts[k].iter().map(|p| p.lever).fold(0.0, f64::max));
    let mut done = 0.0;
    let mut pending: Vec<(Cell, Front)> = vec![(whole, vec![(0, 0)])];
    while let Some((cell, front)) = pending.pop() {
        work.cells += 1;
        if work.cells > budget {
            return Err(SpaceError::TooComplex { budget });
        }
        if work.cells % TELL == 0 {
            progress.tell(done);
            if progress.stopped() {
                return Err(SpaceError::Stopped);
            }
        }
        let motion = [levers[0] * cell.half[0], levers[1] * cell.half[1]];
        let Some(front) = look(catalogue, proofs, cuts, &mut work, (&cell, front, motion[0] + motion[1]))
        else {
            done += cell.half[0] * cell.half[1] / (whole.half[0] * whole.half[1]);
            continue;
        };
        let axis = usize::from(motion[1] > motion[0]);
        let half_of = |side: f64| {
            let mut part = cell;
            part.half[axis] *= 0.5;
            part.center[axis] += side * part.half[axis];
            part
        };
        pending.push((half_of(1.0), front.clone()));
        pending.push((half_of(-1.0), front));
    }
    work.pairs = catalogue.curves.len();
    work.elements = catalogue.elements.len();
    Ok(work)
}

/// Looks at a box in which points move by at most `motion` and the nodes in `front` may touch. If it must be halved: what
/// may touch in it.
fn look(
    catalogue: &mut Catalogue,
    proofs: &mut Proofs,
    cuts: &mut Cuts,
    work: &mut Work,
    (cell, front, motion): (&Cell, Front, f64),
) -> Option<Front> {
    let frame = catalogue.frame;
    let around = Around::new(&frame.moving, cell, frame.size);
    if proofs.cross(&around, front.len()) {
        work.blocked += 1;
        return None;
    }
    let (front, fine) = refine(catalogue, front, &around, motion);
    if front.is_empty() {
        return None;
    }
    if proofs.overlap(&around, front.len()) {
        work.blocked += 1;
        return None;
    }
    if fine && (front.len() <= FEW || motion < SMALL * frame.size) {
        work.leaves += 1;
        cuts.cut(catalogue, &front, cell);
        return None;
    }
    Some(front)
}

/// Drops node pairs out of reach and opens those larger than the box's motion; all, when few are left. Says whether
/// all are single features.
fn refine(catalogue: &Catalogue, front: Front, around: &Around, motion: f64) -> (Front, bool) {
    let [ta, tb] = &catalogue.trees;
    let (mut kept, mut coarse) = (Front::with_capacity(front.len()), front);
    let mut opened = 0;
    for all in [false, true] {
        let mut open = std::mem::take(&mut coarse);
        while let Some((i, j)) = open.pop() {
            // The halves of the box open the rest, where less of it is near.
            if opened >= OPENED || (all && kept.len() + open.len() >= MANY) {
                coarse.push((i, j));
                coarse.append(&mut open);
                break;
            }
            let (m, n) = (&ta.nodes[i as usize], &tb.nodes[j as usize]);
            if !around.near(m, n) {
                continue;
            }
            if m.leaf && n.leaf {
                let [a, b] = [(0, m.link), (1, n.link)].map(|(k, i)| &catalogue.parts[k][i as usize]);
                if around.may_touch(a, b) {
                    kept.push((i, j));
                }
            } else if !all && m.radius + n.radius <= motion {
                coarse.push((i, j));
            } else {
                open.extend(Discs::halved([ta, tb], (i, j)));
                opened += 1;
            }
        }
        if kept.len() + coarse.len() > MANY {
            break;
        }
    }
    let fine = coarse.is_empty();
    kept.append(&mut coarse);
    if fine {
        kept.sort_unstable();
    }
    (kept, fine)
}
