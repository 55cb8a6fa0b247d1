//! Configuration spaces by names: two parts, two joint positions, other joints held.
//!
//! A part's joint position is x = r q, q the coordinate of its subsystem, r its ratio (1 but for gears). Everything that
//! goes in or comes out is in x of the two named joints: radians or the file's length.

use crate::space_request::{Chosen, SpaceRequest, choose, told};
use crate::space_tiles::Tiles;
use mainspring_cspace::{
    Axis, ConfigurationSpace, End, Gap, Interval, Progress, SpaceOptions, Stage, Transmission,
};
use mainspring_mechanism::{Feature, Mechanism, System};
use mainspring_model::Error;
use std::sync::Arc;

/// One of the two joint positions of a space.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceAxis {
    /// The part whose joint it is.
    pub name: String,
    pub part: usize,
    /// Index of its subsystem's coordinate.
    pub coordinate: usize,
    /// x = ratio · q.
    pub ratio: f64,
    pub turns: bool,
    /// At the start.
    pub start: f64,
}

/// A mark: a named value of one of the two joint positions.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceMark {
    pub axis: usize,
    pub name: String,
    pub value: f64,
}

/// A way through free space: see `mainspring_cspace::Way`.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceWay {
    pub points: Vec<[f64; 2]>,
    /// Periods of the domain between where it ends and the end asked for.
    pub winding: [i64; 2],
    /// The end can be reached in just the turn asked for.
    pub exact: bool,
}

/// A configuration space of a mechanism's two parts, with what is needed to speak of it.
#[derive(Clone, Debug)]
pub struct Space {
    pub(crate) system: Arc<System>,
    pub(crate) map: ConfigurationSpace,
    pub(crate) parts: [usize; 2],
    pub(crate) axes: [SpaceAxis; 2],
    /// Other joints that move the two parts, with the values they are held at.
    pub(crate) held: Vec<(String, f64)>,
    pub(crate) marks: Vec<SpaceMark>,
    /// Parts that move with one of the two: index of the axis, and position over that of the axis.
    pub(crate) moves: Vec<(String, usize, f64)>,
    /// Where all other moving parts are.
    pub(crate) others: Vec<(String, f64)>,
    pub(crate) tiles: Tiles,
}

/// The space of the two parts a request names.
///
/// # Errors
/// Parts or joints that do not exist or do not move, motion that is not planar, and what `mainspring_cspace` refuses.
pub fn configuration_space(mechanism: &Mechanism, request: &SpaceRequest) -> Result<Space, Error> {
    watched_space(mechanism, request, &Progress::default())
}

/// The same, told and stopped by `progress`; stopped, it is an error.
///
/// # Errors
/// As above.
pub fn watched_space(
    mechanism: &Mechanism,
    request: &SpaceRequest,
    progress: &Progress,
) -> Result<Space, Error> {
    let system = mechanism.system_of_shapes()?;
    let Chosen { parts, axes, held, windows } = choose(mechanism, &system, request)?;
    let others = |c: &usize| axes.iter().all(|a| a.coordinate != *c);
    let start = |c: usize| (c, system.coordinates[c].position);
    let mut values: Vec<(usize, f64)> = (0..system.coordinates.len()).filter(others).map(start).collect();
    for (coordinate, value) in held {
        values.iter_mut().filter(|v| v.0 == coordinate).for_each(|v| v.1 = value);
    }
    let options = SpaceOptions { windows, held: values.clone(), ..SpaceOptions::default() };
    let coordinates = [axes[0].coordinate, axes[1].coordinate];
    let map = ConfigurationSpace::watched(&system, parts, coordinates, &options, progress)
        .map_err(|e| told(&e, &axes, parts.map(|p| mechanism.parts[p].name.as_str())))?;
    let held = held_of(mechanism, &system, parts, &values);
    let marks = marks(mechanism, &axes);
    let moves = moves(mechanism, &axes);
    let others = places(mechanism, &values);
    let tiles = Tiles::new(&system, &map, parts);
    Ok(Space { system, map, parts, axes, held, marks, moves, others, tiles })
}

/// The held joints that matter, by the part whose joint each is.
fn held_of(
    mechanism: &Mechanism,
    system: &System,
    parts: [usize; 2],
    values: &[(usize, f64)],
) -> Vec<(String, f64)> {
    let of = |&(c, q): &(usize, f64)| {
        let rest = crate::space_request::rests(system, parts);
        let root = mechanism.subsystems[c].root;
        rest.iter().any(|r| r.contains(&c)).then(|| (mechanism.parts[root].name.clone(), q))
    };
    values.iter().filter_map(of).collect()
}

/// Named values the machine's text gives to the two joints, and their stops.
fn marks(mechanism: &Mechanism, axes: &[SpaceAxis; 2]) -> Vec<SpaceMark> {
    let named = mechanism.machine.supplement().marks.iter().filter_map(|mark| {
        let (c, ratio) = mechanism.subsystem_of(mark.part)?;
        let axis = axes.iter().position(|a| a.coordinate == c)?;
        let value = mark.value * mechanism.unit(mark.part) / ratio * axes[axis].ratio;
        Some(SpaceMark { axis, name: mark.name.clone(), value })
    });
    let stops = (0..2).flat_map(|axis| {
        let stops = mechanism.parts[axes[axis].part].forces.stops;
        [("lower stop", stops[0]), ("upper stop", stops[1])].into_iter().filter_map(move |(name, value)| {
            value.map(|value| SpaceMark { axis, name: name.to_string(), value })
        })
    });
    named.chain(stops).collect()
}

fn moves(mechanism: &Mechanism, axes: &[SpaceAxis; 2]) -> Vec<(String, usize, f64)> {
    let of = |part: usize| {
        let (c, ratio) = mechanism.subsystem_of(part)?;
        let k = axes.iter().position(|a| a.coordinate == c)?;
        Some((mechanism.parts[part].name.clone(), k, ratio / axes[k].ratio))
    };
    (0..mechanism.parts.len()).filter_map(of).collect()
}

fn places(mechanism: &Mechanism, values: &[(usize, f64)]) -> Vec<(String, f64)> {
    let of = |part: usize| {
        let (c, ratio) = mechanism.subsystem_of(part)?;
        let (_, q) = values.iter().find(|v| v.0 == c)?;
        Some((mechanism.parts[part].name.clone(), q * ratio))
    };
    (0..mechanism.parts.len()).filter_map(of).collect()
}

impl Space {
    pub fn axes(&self) -> &[SpaceAxis; 2] {
        &self.axes
    }

    pub fn map(&self) -> &ConfigurationSpace {
        &self.map
    }

    /// Joint positions to the system's coordinates.
    #[inline]
    pub(crate) fn q(&self, x: [f64; 2]) -> [f64; 2] {
        [x[0] / self.axes[0].ratio, x[1] / self.axes[1].ratio]
    }

    #[inline]
    pub(crate) fn x(&self, q: [f64; 2]) -> [f64; 2] {
        [q[0] * self.axes[0].ratio, q[1] * self.axes[1].ratio]
    }

    /// The sense in which either position grows with its coordinate.
    pub(crate) fn senses(&self) -> [f64; 2] {
        [self.axes[0].ratio.signum(), self.axes[1].ratio.signum()]
    }

    /// Ends of the stored domain.
    pub fn domain(&self) -> [(f64, f64); 2] {
        let domain: [Axis; 2] = self.map.domain();
        [0, 1].map(|k| {
            let (a, b) = (domain[k].start * self.axes[k].ratio, domain[k].end() * self.axes[k].ratio);
            (a.min(b), a.max(b))
        })
    }

    /// Periods of the stored domain; none along a coordinate that does not wrap.
    pub fn periods(&self) -> [Option<f64>; 2] {
        let domain = self.map.domain();
        [0, 1].map(|k| domain[k].wraps.then(|| domain[k].length * self.axes[k].ratio.abs()))
    }

    /// Where both joints are at the start.
    pub fn start(&self) -> [f64; 2] {
        [self.axes[0].start, self.axes[1].start]
    }

    /// Is a configuration free? See `ConfigurationSpace::is_free`.
    #[inline]
    pub fn is_free(&self, x: [f64; 2]) -> bool {
        self.map.is_free(self.q(x))
    }

    /// The gap and the features at the nearest contact. See `ConfigurationSpace::gap`.
    pub fn gap(&self, x: [f64; 2]) -> Option<Gap> {
        let q = self.q(x);
        let gap = self.map.gap(q)?;
        Some(Gap { features: self.tiles.at(&self.map, q, gap.features), ..gap })
    }

    /// What touches along a curve at a configuration on it, which may lie beyond the stored domain.
    pub fn touching(&self, curve: u32, x: [f64; 2]) -> Option<[usize; 2]> {
        let features = self.map.curve(curve)?.features();
        Some(self.tiles.at(&self.map, self.q(x), features))
    }

    pub fn component_of(&self, x: [f64; 2]) -> Option<u32> {
        self.map.component_of(self.q(x))
    }

    /// Features of the first (0) or the second (1) part; answers name them by index.
    pub fn features(&self, k: usize) -> &[Feature] {
        &self.system.features[self.parts[k]]
    }

    /// Free intervals of the other joint with joint `axis` at `x`, within one stored period.
    ///
    /// # Errors
    /// As `ConfigurationSpace::slice_second`.
    pub fn slice(&self, axis: usize, x: f64) -> Result<Vec<Interval>, Error> {
        let q = x / self.axes[axis].ratio;
        let other = 1 - axis;
        let found = if axis == 0 {
            self.map.slice_first(q)
        } else {
            let slice = self.map.slice_second(q).map_err(|e| self.told(&e))?;
            // The transposed map numbers components in its own way.
            slice.into_iter().filter_map(|i| self.numbered(i, q)).collect()
        };
        let ratio = self.axes[other].ratio;
        let mut turned: Vec<Interval> = found
            .into_iter()
            .map(|i| {
                let (low, high, [a, b]) = (i.low * ratio, i.high * ratio, i.curves);
                if ratio > 0.0 {
                    Interval { low, high, ..i }
                } else {
                    Interval { low: high, high: low, curves: [b, a], ..i }
                }
            })
            .collect();
        turned.sort_by(|a, b| a.low.total_cmp(&b.low));
        Ok(turned)
    }

    /// The interval of first positions with this space's component.
    fn numbered(&self, i: Interval, second: f64) -> Option<Interval> {
        let inside = [0.5, 0.3, 0.7, 0.1, 0.9].into_iter().map(|f| i.low + f * (i.high - i.low));
        let component = inside.filter_map(|first| self.map.component_of([first, second])).next()?;
        Some(Interval { component, ..i })
    }

    /// How far each joint can move from a free configuration with the other held.
    ///
    /// # Errors
    /// As `ConfigurationSpace::play`.
    pub fn play(&self, x: [f64; 2]) -> Result<Option<[(f64, f64); 2]>, Error> {
        let found = self.map.play(self.q(x)).map_err(|e| self.told(&e))?;
        let ordered = |k: usize, (a, b): (f64, f64)| {
            let (a, b) = (a * self.axes[k].ratio, b * self.axes[k].ratio);
            (a.min(b), a.max(b))
        };
        Ok(found.map(|[a, b]| [ordered(0, a), ordered(1, b)]))
    }

    /// A way between two free configurations; none if there is none.
    pub fn way(&self, from: [f64; 2], to: [f64; 2]) -> Option<SpaceWay> {
        let (from, to) = (self.q(from), self.q(to));
        let way = self.map.way(from, to)?;
        let senses = self.senses();
        Some(SpaceWay {
            points: way.points.into_iter().map(|q| self.x(q)).collect(),
            winding: [0, 1].map(|k| way.winding[k] * senses[k] as i64),
            exact: self.map.reaches(from, to),
        })
    }

    /// Where pushing joint `axis` to `goal` takes the other: stages and how it ended. None from a blocked start.
    ///
    /// # Errors
    /// As `ConfigurationSpace::walk`.
    pub fn walk(&self, from: [f64; 2], axis: usize, goal: f64) -> Result<Option<(Vec<Stage>, End)>, Error> {
        let walk =
            self.map.walk(self.q(from), axis, goal / self.axes[axis].ratio).map_err(|e| self.told(&e))?;
        let stage = |s: &Stage| Stage { from: self.x(s.from), to: self.x(s.to), ..*s };
        Ok(walk.map(|w| (w.stages.iter().map(stage).collect(), w.end)))
    }

    /// Motion transmitted at a fraction of the way along a curve; none for a curve that does not exist.
    pub fn transmission(&self, curve: u32, fraction: f64) -> Option<Transmission> {
        let t = self.map.curve(curve)?.transmission(fraction);
        let [r, s] = [self.axes[0].ratio, self.axes[1].ratio];
        Some(Transmission {
            at: self.x(t.at),
            ratio: t.ratio * s / r,
            derivatives: [t.derivatives[0] * s / (r * r), t.derivatives[1] * s / (r * r * r)],
            ..t
        })
    }

    fn told(&self, error: &mainspring_cspace::SpaceError) -> Error {
        told(error, &self.axes, self.parts.map(|p| self.system.bodies[p].name.as_str()))
    }
}
