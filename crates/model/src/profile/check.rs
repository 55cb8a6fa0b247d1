//! Do the boundaries of a part bound something: layers apart, loops simple, holes inside?

use super::draw::{Drawn, SAME, real};
use super::{LayerText, LoopShape, Profile};
use crate::error::{Fault, Place, Read, number};
use mainspring_geometry::{Crossing, CurveId, Edge, Layer, Loop, Segment, Turn, crossing};

/// A loop of a layer and one of its edges.
type At = (usize, usize);

impl Profile {
    /// Refuses loops that touch or cross, holes that lie outside, outer boundaries in each other, layers in each
    /// other.
    pub fn check(&self, drawn: &[Drawn<f64>]) -> Read<()> {
        for (text, layer) in self.layers.iter().zip(drawn) {
            self.check_layer(text, layer)?;
        }
        let mut spans: Vec<([f64; 2], Place)> =
            drawn.iter().zip(&self.layers).map(|(d, t)| (d.z, t.place)).collect();
        spans.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let apart = |w: &[([f64; 2], Place)]| w[1].0[0] >= w[0].0[1] - SAME * (w[1].0[1] - w[0].0[0]);
        match spans.windows(2).find(|w| !apart(w)) {
            None => Ok(()),
            Some(w) => {
                let [from, to] = w[1].0.map(number);
                let message = format!(
                    "part {}: the layer from {from} to {to} lies in another one, from {} to {}; expected layers side by side",
                    self.part,
                    number(w[0].0[0]),
                    number(w[0].0[1])
                );
                Err(Fault::new(w[1].1, message))
            }
        }
    }

    fn check_layer(&self, text: &LayerText, layer: &Drawn<f64>) -> Read<()> {
        let loops: Vec<Vec<Segment>> =
            layer.rings.iter().map(|r| r.edges.iter().map(|e| real(&e.segment)).collect()).collect();
        let bounds = loops.iter().flatten().map(Segment::bounds).reduce(|a, b| {
            let (mut min, mut max) = a;
            (min.x, min.y) = (min.x.min(b.0.x), min.y.min(b.0.y));
            (max.x, max.y) = (max.x.max(b.1.x), max.y.max(b.1.y));
            (min, max)
        });
        let Some((min, max)) = bounds else { return Ok(()) };
        let tolerance = SAME * (max - min).norm();
        self.check_lengths(text, layer, &loops, tolerance)?;
        match crossing(&loops, tolerance) {
            Err(_) => {
                let message = format!(
                    "part {}: too many segments lie near each other; expected fewer in one layer",
                    self.part
                );
                Err(Fault::new(text.place, message))
            }
            Ok(Some(found)) => Err(self.crossed(text, layer, &found)),
            Ok(None) => self.check_nesting(text, layer, &loops),
        }
    }

    fn check_lengths(
        &self,
        text: &LayerText,
        layer: &Drawn<f64>,
        loops: &[Vec<Segment>],
        tolerance: f64,
    ) -> Read<()> {
        for (i, l) in loops.iter().enumerate() {
            if let Some(k) = l.iter().position(|s| s.length() <= 4.0 * tolerance) {
                let what = self.words(text, layer, (i, k));
                let message = format!(
                    "part {}, {what}: its length is {}, nothing beside the part's size; expected a longer one",
                    self.part,
                    number(l[k].length())
                );
                return Err(Fault::new(self.place(text, layer, (i, k)), message));
            }
        }
        Ok(())
    }

    fn crossed(&self, text: &LayerText, layer: &Drawn<f64>, found: &Crossing) -> Box<Fault> {
        // The one written later is at fault, whichever way the loops run.
        let written = |at: At| {
            let ring = &layer.rings[at.0];
            let edge = &ring.edges[at.1];
            (ring.text, ring.copy, edge.piece, edge.text, edge.fillet)
        };
        let (mut first, mut second) = (found.first, found.second);
        if written(first) > written(second) {
            std::mem::swap(&mut first, &mut second);
        }
        let [other, place] = [first, second].map(|at| self.place(text, layer, at));
        let (first, second) = (self.words(text, layer, first), self.words(text, layer, second));
        let message = format!(
            "part {}, {second}: it touches or crosses {first} near ({}, {}); expected boundaries that keep apart",
            self.part,
            number(found.point.x),
            number(found.point.y)
        );
        let mut fault = Fault::new(place, message);
        fault.also = Some(other);
        fault
    }

    /// A hole lies in an odd number of other loops, an outer boundary in an even number.
    fn check_nesting(&self, text: &LayerText, layer: &Drawn<f64>, loops: &[Vec<Segment>]) -> Read<()> {
        let layers: Vec<Layer> = loops.iter().map(|l| alone(l)).collect();
        let boxes: Vec<_> = layers.iter().map(Layer::bounds).collect();
        for (i, ring) in layer.rings.iter().enumerate() {
            let p = loops[i][0].at(0.437);
            let near = |j: usize| {
                boxes[j].is_some_and(|(a, b)| a.x <= p.x && p.x <= b.x && a.y <= p.y && p.y <= b.y)
            };
            let depth = (0..loops.len()).filter(|&j| j != i && near(j) && layers[j].contains(p)).count();
            let l = &text.loops[ring.text];
            if (depth % 2 == 1) != l.hole {
                let what = if l.hole {
                    "it lies outside the material; expected an inner boundary inside an outer one"
                } else {
                    "it lies inside the material; expected an outer boundary outside the others"
                };
                let message = format!("part {}, {}: {what}", self.part, l.name);
                return Err(Fault::new(l.place, message));
            }
        }
        Ok(())
    }

    fn words(&self, text: &LayerText, layer: &Drawn<f64>, at: At) -> String {
        let ring = &layer.rings[at.0];
        let (edge, l) = (&ring.edges[at.1], &text.loops[ring.text]);
        let copy = if ring.copy > 0 { format!(", copy {}", ring.copy + 1) } else { String::new() };
        let piece = if edge.piece > 0 { format!(" of piece {}", edge.piece + 1) } else { String::new() };
        match &l.shape {
            LoopShape::Circle { .. } => format!("{}{copy}", l.name),
            LoopShape::Path { edges, .. } => {
                let word = if edge.fillet { "its fillet" } else { edges[edge.text].word() };
                format!("{}{copy}, segment {}{piece} ({word})", l.name, edge.text + 1)
            }
        }
    }

    fn place(&self, text: &LayerText, layer: &Drawn<f64>, at: At) -> Place {
        let ring = &layer.rings[at.0];
        let l = &text.loops[ring.text];
        match &l.shape {
            LoopShape::Path { edges, .. } => edges[ring.edges[at.1].text].place,
            LoopShape::Circle { .. } => l.place,
        }
    }
}

/// A loop as a layer of its own.
fn alone(segments: &[Segment]) -> Layer {
    let edge = |s: &Segment| Edge {
        segment: *s,
        curve: CurveId { primitive: 0, face: 0 },
        aliases: vec![],
        turn_at_start: Turn::Smooth,
    };
    Layer { bottom: 0.0, top: 1.0, loops: vec![Loop { edges: segments.iter().map(edge).collect() }] }
}
