//! What a picture of a configuration space is drawn from: curves as polylines, free space as polygons.
//!
//! Between two neighbouring ends of curves the order of curves does not change, so one slice tells which curves bound
//! free space there; neighbours bounded by the same curves make one polygon.

use crate::space::Space;
use crate::words::{clean, vec2};
use mainspring_cspace::{Curve, Interval};
use serde_json::{Map, Value, json};

/// Halvings of a stretch of curve: a fold, where the curve runs like a root, is drawn to a thousandth.
const HALVINGS: u32 = 14;
/// Ends of curves nearer than this part of the domain are one.
const SAME: f64 = 1e-9;
/// Chords leave curves by at most this part of the domain.
const CHORD: f64 = 2e-4;

/// Points on a curve (coordinates q) whose chords leave it by at most `chord` of the `lengths` of the domain.
pub(crate) fn polyline(curve: &Curve, lengths: [f64; 2], chord: f64) -> Vec<[f64; 2]> {
    if curve.is_upright() {
        return vec![curve.from(), curve.to()];
    }
    let mut points = vec![curve.from()];
    for k in 0..4 {
        let (a, b) = (0.25 * f64::from(k), 0.25 * f64::from(k + 1));
        let ends = [curve.at(a), curve.at(b)];
        halve(curve, lengths, chord, (a, b), ends, HALVINGS, &mut points);
        points.push(ends[1]);
    }
    if let Some(last) = points.last_mut() {
        *last = curve.to();
    }
    straightened(points, lengths, 0.2 * chord)
}

/// Adds the points between two ends.
fn halve(
    curve: &Curve,
    lengths: [f64; 2],
    chord: f64,
    (a, b): (f64, f64),
    [p, q]: [[f64; 2]; 2],
    left: u32,
    points: &mut Vec<[f64; 2]>,
) {
    let middle = 0.5 * (a + b);
    let m = curve.at(middle);
    // Along the first coordinate the middle is the chord's: what is off is off along the second.
    if left == 0 || (m[1] - 0.5 * (p[1] + q[1])).abs() <= chord * lengths[1] {
        return;
    }
    halve(curve, lengths, chord, (a, middle), [p, m], left - 1, points);
    points.push(m);
    halve(curve, lengths, chord, (middle, b), [m, q], left - 1, points);
}

/// Both ends alone where nothing between them is off their chord.
fn straightened(points: Vec<[f64; 2]>, lengths: [f64; 2], slack: f64) -> Vec<[f64; 2]> {
    let (Some(&a), Some(&b)) = (points.first(), points.last()) else { return points };
    let on = |p: &[f64; 2]| a[1] + (b[1] - a[1]) * (p[0] - a[0]) / (b[0] - a[0]);
    if points.iter().all(|p| (on(p) - p[1]).abs() <= slack * lengths[1]) { vec![a, b] } else { points }
}

/// Free space over a range of the first coordinate, between the same two curves.
struct Strip {
    curves: [Option<u32>; 2],
    /// What is added to the curves' own second coordinates; the values themselves at limits of the domain.
    shifts: [f64; 2],
    from: f64,
    to: f64,
}

impl Space {
    /// Free space within the stored domain as polygons (`free`), what moves with which coordinate, and where the others are.
    ///
    /// Polygons may reach over the domain's end by up to one period; both copies are there then.
    pub fn picture_json(&self) -> Value {
        let moves: Vec<Value> = self
            .moves
            .iter()
            .map(|(part, axis, ratio)| json!({"part": part, "axis": axis, "ratio": ratio}))
            .collect();
        let others: Map<String, Value> =
            self.others.iter().map(|(part, x)| (part.clone(), json!(clean(*x)))).collect();
        let tiles: Vec<Value> = (0..2).map(|k| self.tile_json(k)).collect();
        json!({"free": self.polygons(), "moves": moves, "others": others, "tiles": tiles})
    }

    /// The turn of the body that repeats, for one period of the axis in its own sense; null where nothing repeats.
    fn tile_json(&self, k: usize) -> Value {
        self.map.tile_turn(k).map_or(Value::Null, |t| {
            json!({
                "part": self.system.bodies[t.body].name,
                "center": vec2(t.center),
                "angle": t.angle * self.senses()[k],
            })
        })
    }

    fn polygons(&self) -> Vec<Vec<[f64; 2]>> {
        let lengths = self.map.domain().map(|a| a.length);
        let lines: Vec<Vec<[f64; 2]>> =
            self.map.curves().iter().map(|c| polyline(c, lengths, CHORD)).collect();
        let mut found = Vec::new();
        for strip in self.strips() {
            let polygon = self.polygon(&strip, &lines);
            found.extend(self.copies(&polygon));
        }
        found
    }

    /// Ends of curves along the first coordinate.
    fn borders(&self) -> Vec<f64> {
        let axis = self.map.domain()[0];
        let mut found: Vec<f64> = self.map.curves().iter().flat_map(|c| [c.from()[0], c.to()[0]]).collect();
        found.extend([axis.start, axis.end()]);
        found.sort_by(f64::total_cmp);
        found.dedup_by(|b, a| *b - *a < SAME * axis.length);
        found
    }

    fn strips(&self) -> Vec<Strip> {
        let borders = self.borders();
        let mut done: Vec<Strip> = Vec::new();
        let mut open: Vec<Strip> = Vec::new();
        for ends in borders.windows(2) {
            let middle = 0.5 * (ends[0] + ends[1]);
            let mut next = Vec::new();
            for interval in self.map.slice_first(middle) {
                let new = self.strip(&interval, middle, ends);
                let same = |s: &Strip| s.curves == new.curves && s.shifts == new.shifts;
                let from = open.iter().position(same).map_or(new.from, |i| open.swap_remove(i).from);
                next.push(Strip { from, ..new });
            }
            done.append(&mut open);
            open = next;
        }
        done.append(&mut open);
        done
    }

    fn strip(&self, interval: &Interval, middle: f64, ends: &[f64]) -> Strip {
        let length = self.map.domain()[1].length;
        let shift = |curve: Option<u32>, value: f64| match curve.and_then(|c| self.map.curve(c)) {
            Some(curve) => length * ((value - second(&curve, middle)) / length).round(),
            None => value,
        };
        let shifts = [shift(interval.curves[0], interval.low), shift(interval.curves[1], interval.high)];
        Strip { curves: interval.curves, shifts, from: ends[0], to: ends[1] }
    }

    /// Along the lower side to the right, along the upper back.
    fn polygon(&self, strip: &Strip, lines: &[Vec<[f64; 2]>]) -> Vec<[f64; 2]> {
        let side = |k: usize| -> Vec<[f64; 2]> {
            let shift = strip.shifts[k];
            let Some(curve) = strip.curves[k].and_then(|c| self.map.curve(c)) else {
                return vec![[strip.from, shift], [strip.to, shift]];
            };
            let inner = lines[curve.id as usize].iter().filter(|p| p[0] > strip.from && p[0] < strip.to);
            let mut points = vec![[strip.from, second(&curve, strip.from) + shift]];
            points.extend(inner.map(|p| [p[0], p[1] + shift]));
            points.push([strip.to, second(&curve, strip.to) + shift]);
            points
        };
        let (mut points, mut back) = (side(0), side(1));
        back.reverse();
        points.append(&mut back);
        points
    }

    /// The polygon, and once more a period off where it reaches over an end of the domain.
    fn copies(&self, polygon: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let axis = self.map.domain()[1];
        let slack = SAME * axis.length;
        let low = polygon.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
        let high = polygon.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
        let mut offsets = vec![0.0];
        if axis.wraps && high > axis.end() + slack {
            offsets.push(-axis.length);
        }
        if axis.wraps && low < axis.start - slack {
            offsets.push(axis.length);
        }
        let moved = |by: &f64| polygon.iter().map(|p| self.x([p[0], p[1] + by]).map(clean)).collect();
        offsets.iter().map(moved).collect()
    }
}

/// The curve's second coordinate at a first one, held within the curve.
fn second(curve: &Curve, first: f64) -> f64 {
    let (a, b) = (curve.from()[0], curve.to()[0]);
    curve.at(((first - a) / (b - a)).clamp(0.0, 1.0))[1]
}
