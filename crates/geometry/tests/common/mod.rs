//! A small builder of solids, generic over the scalar, in the order in which the input language would.
#![allow(dead_code)]

use mainspring_geometry::{Axis, Csg, CsgOp, Primitive, Rigid3, Scalar, Shape, Vec3};

/// A solid under construction: primitives with their set expression.
#[derive(Clone, Debug)]
pub struct Solid<S = f64> {
    pub primitives: Vec<Primitive<S>>,
    pub csg: Csg,
}

pub fn v<S: Scalar>(x: f64, y: f64, z: f64) -> Vec3<S> {
    Vec3::new(S::constant(x), S::constant(y), S::constant(z))
}

impl<S: Scalar> Solid<S> {
    pub fn of(shape: Shape<S>) -> Self {
        let primitives = vec![Primitive { shape, machine_from_local: Rigid3::identity() }];
        Self { primitives, csg: Csg { ops: vec![CsgOp::Leaf(0)] } }
    }

    pub fn block(x: f64, y: f64, z: f64) -> Self {
        Self::of(Shape::Block { x: S::constant(x), y: S::constant(y), z: S::constant(z) })
    }

    /// Diameter and height.
    pub fn cylinder(d: f64, h: f64) -> Self {
        Self::of(Shape::Cylinder { radius: S::constant(0.5 * d), height: S::constant(h) })
    }

    pub fn moved(mut self, by: Rigid3<S>) -> Self {
        for p in &mut self.primitives {
            p.machine_from_local = by.then_after(&p.machine_from_local);
        }
        self
    }

    pub fn at(self, x: f64, y: f64, z: f64) -> Self {
        self.moved(Rigid3::translation(v(x, y, z)))
    }

    /// About z, in degrees.
    pub fn turned(self, degrees: S) -> Self {
        self.moved(Rigid3::rotation(Axis::Z, degrees * (std::f64::consts::PI / 180.0)))
    }

    pub fn turned_by(self, degrees: f64) -> Self {
        self.turned(S::constant(degrees))
    }

    fn with(mut self, other: Self, op: CsgOp) -> Self {
        let base = self.primitives.len() as u32;
        self.primitives.extend(other.primitives);
        self.csg.ops.extend(other.csg.ops.into_iter().map(|o| match o {
            CsgOp::Leaf(i) => CsgOp::Leaf(i + base),
            o => o,
        }));
        self.csg.ops.push(op);
        self
    }

    pub fn un(self, other: Self) -> Self {
        self.with(other, CsgOp::Union)
    }

    pub fn dif(self, other: Self) -> Self {
        self.with(other, CsgOp::Difference)
    }

    pub fn int(self, other: Self) -> Self {
        self.with(other, CsgOp::Intersection)
    }
}

/// The design parameters of Fig. 12: the angle between teeth and the three pallet angles, in degrees.
pub struct Escapement<S> {
    pub gap: S,
    pub pallets: [S; 3],
}

impl<S: Scalar> Escapement<S> {
    pub fn with(values: [S; 4]) -> Self {
        Self { gap: values[0], pallets: [values[1], values[2], values[3]] }
    }

    /// Gelsey 1995, Fig. 12 (mended as ERRATA says).
    pub fn wheel(&self) -> Solid<S> {
        let tooth = || Solid::block(0.3, 5.4, 1.0).at(-3.2, 0.0, 0.0);
        let mut wheel = Solid::cylinder(10.0, 1.0).un(tooth());
        for k in 1..9 {
            wheel = wheel.un(tooth().turned(self.gap * k as f64));
        }
        wheel = wheel.un(tooth().turned(-self.gap + 360.0));
        wheel.dif(Solid::cylinder(1.0, 1.0))
    }

    pub fn lever(&self) -> Solid<S> {
        let pallet = |x: f64| Solid::block(x, 2.0, 1.0);
        let [a, b, c] = self.pallets;
        Solid::block(10.0, 2.2, 1.0)
            .at(-5.0, 6.4, 0.0)
            .un(pallet(0.9).turned(a).at(-3.0, 5.6, 0.0))
            .un(pallet(0.9).turned(b).at(-3.0, 5.6, 0.0))
            .un(pallet(1.0).at(0.0, 0.1, 0.0).turned(c).at(2.4, 5.7, 0.0))
            .un(Solid::block(1.0, 8.0, 1.0).at(-0.5, 8.0, 0.0))
            .un(Solid::block(1.0, 1.8, 1.0).at(0.0, -1.0, 0.0).turned_by(-45.0).at(0.0, 16.2, 0.0))
            .un(Solid::block(1.0, 1.8, 1.0).at(-1.0, -1.0, 0.0).turned_by(45.0).at(0.0, 16.2, 0.0))
            .dif(Solid::cylinder(1.0, 1.0).at(0.0, 7.5, 0.0))
            .at(0.0, -7.5, 0.0)
            .turned_by(5.0)
            .at(0.0, 7.5, 0.0)
    }

    pub fn balance(&self) -> Solid<S> {
        Solid::cylinder(8.0, 1.0)
            .at(0.0, 20.0, -1.0)
            .un(Solid::cylinder(1.0, 2.0).at(-3.0, 20.0, -1.0))
            .dif(Solid::cylinder(1.0, 1.0).at(0.0, 20.0, -1.0))
    }

    pub fn frame(&self) -> Solid<S> {
        let cut = self.wheel().un(self.lever()).un(self.balance());
        Solid::block(13.0, 31.0, 1.0)
            .at(-6.5, -6.5, -2.0)
            .un(Solid::cylinder(1.0, 4.0).at(0.0, 0.0, -2.0))
            .un(Solid::cylinder(1.0, 4.0).at(0.0, 7.5, -2.0))
            .un(Solid::cylinder(1.0, 3.0).at(0.0, 20.0, -2.0))
            .dif(cut)
            .un(Solid::cylinder(1.0, 3.0).at(-1.6, 14.0, -2.0))
            .un(Solid::cylinder(1.0, 3.0).at(1.6, 14.0, -2.0))
    }

    pub fn parts(&self) -> [(&'static str, Solid<S>); 4] {
        [
            ("wheel", self.wheel()),
            ("lever", self.lever()),
            ("balance", self.balance()),
            ("frame", self.frame()),
        ]
    }
}

pub const FIGURE: [f64; 4] = [36.0, 7.0, 25.0, -40.0];

/// A small generator of pseudo-random numbers (xorshift), so that every run tests the same cases.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, n: u64) -> u64 {
        (self.next() >> 11) % n
    }

    /// Between `low` and `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}
