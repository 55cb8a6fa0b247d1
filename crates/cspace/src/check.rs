//! What is refused before a map is begun: bodies and coordinates that are none, numbers that are not finite, bodies that touch
//! for ever.

use crate::around::Around;
use crate::element::Frame;
use crate::error::SpaceError;
use crate::options::SpaceOptions;
use crate::pairs::Cell;
use crate::region::Regions;
use crate::witness::{EFFORT, Witnesses};
use mainspring_mechanism::System;

/// Refuses bodies and coordinates that are none or the same, and numbers that are not finite.
pub(crate) fn check(
    system: &System,
    bodies: [usize; 2],
    coordinates: [usize; 2],
    options: &SpaceOptions,
) -> Result<(), SpaceError> {
    for (what, list, count) in
        [("body", bodies, system.bodies.len()), ("coordinate", coordinates, system.coordinates.len())]
    {
        if let Some(&index) = list.iter().find(|&&i| i >= count) {
            return Err(SpaceError::Absent { what, index });
        }
    }
    if let Some(h) = options.held.iter().find(|h| h.0 >= system.coordinates.len()) {
        return Err(SpaceError::Absent { what: "coordinate", index: h.0 });
    }
    if bodies[0] == bodies[1] {
        return Err(SpaceError::Same { what: "body", name: system.bodies[bodies[0]].name.clone() });
    }
    if coordinates[0] == coordinates[1] {
        let name = system.coordinates[coordinates[0]].name.clone();
        return Err(SpaceError::Same { what: "coordinate", name });
    }
    for b in bodies {
        let finite = |f: &mainspring_mechanism::Feature| {
            f.center.x.is_finite() && f.center.y.is_finite() && f.radius.is_finite()
        };
        let held = options.held.iter().all(|h| h.1.is_finite());
        if !held || !system.features[b].iter().all(finite) {
            return Err(SpaceError::NotFinite { body: system.bodies[b].name.clone() });
        }
    }
    Ok(())
}

/// Configurations at which it is asked whether the bodies touch for ever.
const ANYWHERE: usize = 24;

/// A configuration in contact where none should be: the bodies touch for ever, at a point on an axis or along a slide.
pub(crate) fn touching(frame: &Frame, regions: &Regions, witnesses: &Witnesses) -> Option<[f64; 2]> {
    let little = 1e-9 * frame.size;
    // Multiples of the plastic number's inverse powers, which fall at no special place.
    let at = |k: usize, axis: usize| {
        let part = (0.37 + k as f64 * [0.754_877_666_246_692_7, 0.569_840_290_998_053_3][axis]).fract();
        frame.axes[axis].start + part * frame.axes[axis].length
    };
    (0..ANYWHERE).map(|k| [at(k, 0), at(k, 1)]).find(|q| {
        let here = Around::new(&frame.moving, &Cell { center: *q, half: [0.0; 2] }, frame.size);
        let poses = [0, 1].map(|k| frame.moving[k].place(q[k]));
        !witnesses.blocked(&here, 2.0 * little, EFFORT) && regions.barely_overlap(&poses, little)
    })
}
