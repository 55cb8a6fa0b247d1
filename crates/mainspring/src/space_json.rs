//! A configuration space as JSON: domain, components, curves, marks, counts of work.

use crate::contacts::feature;
use crate::space::Space;
use crate::space_picture::polyline;
use crate::words::clean;
use mainspring_cspace::{Component, Curve, Cycle, HalfEdge};
use mainspring_mechanism::FeatureShape;
use serde_json::{Map, Value, json};

/// Points of curves lie on them; the chord between two leaves the curve by at most this part of the domain.
const CHORD: f64 = 2e-4;

fn pair(x: [f64; 2]) -> Value {
    json!([clean(x[0]), clean(x[1])])
}

impl Space {
    /// The object that `cspace --json` prints.
    pub fn json(&self) -> Value {
        let components = self.map.components();
        let curves = self.map.curves();
        let held: Map<String, Value> = self.held.iter().map(|(n, q)| (n.clone(), json!(clean(*q)))).collect();
        let start = self.start();
        json!({
            "status": "complete",
            "parts": self.parts.map(|p| self.system.bodies[p].name.clone()),
            "coordinates": self.axes.each_ref().map(|a| &a.name),
            "held": held,
            "domain": ([0, 1].map(|k| self.axis_json(k))),
            "start": {"at": pair(start), "component": self.component_of(start), "gap": self.gap(start).map(|g| clean(g.gap))},
            "components": components.iter().map(|c| self.component_json(c)).collect::<Vec<_>>(),
            "curves": curves.iter().map(|c| self.curve_json(c)).collect::<Vec<_>>(),
            "marks": self.marks.iter().map(|m| json!({
                "coordinate": self.axes[m.axis].name, "name": m.name, "value": clean(m.value),
            })).collect::<Vec<_>>(),
            "stats": self.stats(components.len(), curves.len()),
        })
    }

    fn axis_json(&self, k: usize) -> Value {
        let (low, high) = self.domain()[k];
        json!({
            "coordinate": self.axes[k].name,
            "motion": if self.axes[k].turns { "turn" } else { "slide" },
            "low": clean(low),
            "high": clean(high),
            "period": self.periods()[k],
            "repeats": self.map.repeats()[k],
        })
    }

    fn component_json(&self, c: &Component) -> Value {
        let senses = self.senses();
        let generators = |list: &[[i64; 2]]| -> Vec<[i64; 2]> {
            list.iter().map(|g| ahead([0, 1].map(|k| g[k] * senses[k] as i64))).collect()
        };
        json!({
            "id": c.id,
            "boundary": c.boundary.iter().map(|b| self.cycle_json(b)).collect::<Vec<_>>(),
            "winding": generators(c.windings.generators()),
            "turns": generators(c.turns.generators()),
            "copies": c.copies,
            "area": c.area * (self.axes[0].ratio * self.axes[1].ratio).abs(),
            "inside": pair(self.x(c.inside)),
        })
    }

    /// Free space lies on the left, also where one of the positions runs against its coordinate.
    fn cycle_json(&self, cycle: &Cycle) -> Value {
        let senses = self.senses();
        let turned = senses[0] * senses[1] < 0.0;
        let edge = |e: &HalfEdge| {
            let ends = [self.x(e.from), self.x(e.to)];
            let [from, to] = if turned { [ends[1], ends[0]] } else { ends };
            json!({"curve": e.curve, "from": pair(from), "to": pair(to)})
        };
        let mut edges: Vec<Value> = cycle.edges.iter().map(edge).collect();
        if turned {
            edges.reverse();
        }
        let sign = if turned { -1 } else { 1 };
        let winding = [0, 1].map(|k| sign * cycle.winding[k] * senses[k] as i64);
        json!({"edges": edges, "winding": winding})
    }

    fn curve_json(&self, curve: &Curve) -> Value {
        let [i, j] = curve.features();
        let (low, high) = curve.slopes();
        let ratio = self.axes[1].ratio / self.axes[0].ratio;
        let slope = (low * ratio).min(high * ratio).is_finite().then(|| {
            let (a, b) = (low * ratio, high * ratio);
            [clean(a.min(b)), clean(a.max(b))]
        });
        let sense = self.senses()[usize::from(!curve.is_upright())];
        let free = if curve.free_above() == (sense > 0.0) { "greater" } else { "smaller" };
        let points = polyline(curve, self.map.domain().map(|a| a.length), CHORD);
        json!({
            "id": curve.id,
            "features": [self.feature_json(0, i), self.feature_json(1, j)],
            "points": points.iter().map(|q| pair(self.x(*q))).collect::<Vec<_>>(),
            "from": pair(self.x(curve.from())),
            "to": pair(self.x(curve.to())),
            "slope": slope,
            "free": free,
        })
    }

    /// A feature of the first (0) or the second part as the drawing names it.
    pub fn feature_json(&self, k: usize, index: usize) -> Value {
        let body = self.parts[k];
        let found = &self.system.features[body][index];
        let mut told = feature(&self.system, body, found);
        let kind = match found.shape {
            FeatureShape::Edge { .. } => "edge",
            FeatureShape::Round { radius: 0.0, .. } => "corner",
            FeatureShape::Round { .. } => "arc",
            FeatureShape::Hollow { .. } => "hollow arc",
        };
        if let Some(entries) = told.as_object_mut() {
            entries.insert("kind".into(), json!(kind));
        }
        told
    }

    fn stats(&self, components: usize, curves: usize) -> Value {
        let w = self.map.work();
        json!({
            "components": components,
            "curves": curves,
            "cells": w.cells,
            "cells_blocked": w.blocked,
            "cells_cut": w.leaves,
            "feature_pairs": w.pairs,
            "elements": w.elements,
            "stretches_tested": w.tested,
        })
    }
}

/// A generator and its opposite are the same: the first entry that is not zero is positive.
fn ahead(g: [i64; 2]) -> [i64; 2] {
    if g[0] < 0 || (g[0] == 0 && g[1] < 0) { [-g[0], -g[1]] } else { g }
}
