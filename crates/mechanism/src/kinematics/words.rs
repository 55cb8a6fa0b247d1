//! Evidence in words.

use super::near_miss::number;
use super::pair::{Evidence, EvidenceKind, Pair};

/// Fills in the text of all evidence; `name` gives a part's name, `label` a primitive in words.
pub(crate) fn tell(pairs: &mut [Pair], name: impl Fn(usize) -> String, label: impl Fn(u32) -> String) {
    for pair in pairs {
        let names = [name(pair.parts.0), name(pair.parts.1)];
        for evidence in &mut pair.evidence {
            evidence.text = text(evidence, &names, &label);
        }
    }
}

fn text(evidence: &Evidence, names: &[String; 2], label: impl Fn(u32) -> String) -> String {
    let of = |i: usize| format!("{} of {}", label(evidence.primitives[i]), names[i]);
    let n = number;
    match evidence.what {
        EvidenceKind::ShaftInHole { solid, radius, clearance, from, to, angle } => {
            let mut text = format!("{} fits in {}: radius {}", of(solid), of(1 - solid), n(radius));
            if clearance > 0.0 {
                text += &format!(" with a play of {}", n(clearance));
            }
            text += &format!(", from {} to {} along the axis", n(from), n(to));
            if angle < std::f64::consts::TAU - 1e-6 {
                text += &format!(", over {} degrees", n(angle.to_degrees()));
            }
            text
        }
        EvidenceKind::SideFaces { clearance, area, .. } => {
            let play =
                if clearance > 0.0 { format!(" with a play of {}", n(clearance)) } else { String::new() };
            format!("{} lies against {}{play} over an area of {}", of(0), of(1), n(area))
        }
        EvidenceKind::EndFaces { area, .. } => {
            format!("{} stops {} along the axis over an area of {}", of(1), of(0), n(area))
        }
        EvidenceKind::OpenSide { exit } => {
            format!(
                "open on one side: {} may leave along ({}, {}, {})",
                names[0],
                n(exit.x),
                n(exit.y),
                n(exit.z)
            )
        }
        EvidenceKind::Stated => format!("stated for {} and {}", names[0], names[1]),
        EvidenceKind::Mesh { overlap, internal } => {
            let how = if internal { "internal" } else { "external" };
            format!("{how} mesh of {} and {}: envelopes overlap by {}", of(0), of(1), n(overlap))
        }
    }
}
