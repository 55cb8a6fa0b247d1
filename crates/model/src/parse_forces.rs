//! Lines of the supplement for what acts: forces, friction, drives, stops, masses, gravity, contact.

use crate::error::{Fault, Place, Read, number};
use crate::limits::TABLE_POINTS;
use crate::parse_supplement::Reader;
use crate::supplement::{
    ContactData, DriveData, DriveKind, ForceData, GravityData, MassData, PartNumber, StopData, once,
};

impl Reader<'_> {
    /// A line that begins with one of the words for what acts.
    pub fn acting(&mut self, word: &str) -> Read<()> {
        match word {
            "TORQUE" => self.force("torque"),
            "FORCE" => self.force("force"),
            "COULOMB" => self.coulomb(),
            "SPEED" => self.drive("speed"),
            "TABLE" => self.drive("table"),
            "STOP" => self.stop(),
            "MASS" => self.mass(),
            "GRAVITY" => self.gravity(),
            _ => self.contact(),
        }
    }

    /// `TORQUE part value` or `FORCE part value`
    fn force(&mut self, what: &str) -> Read<()> {
        let (part, place) = self.moving(what)?;
        let value = self.number(&format!("the {what}"))?;
        let earlier = self.supplement.forces.iter().find(|f| f.part == part);
        let earlier = earlier.map(|f| (if f.torque { "torque" } else { "force" }, f.place));
        once(self.machine, (part, place), what, earlier)?;
        self.supplement.forces.push(ForceData { part, value, torque: what == "torque", place });
        Ok(())
    }

    /// `COULOMB part value`
    fn coulomb(&mut self) -> Read<()> {
        let what = "Coulomb friction";
        let (part, place) = self.moving(what)?;
        let value = self.not_negative(what)?;
        let earlier = self.supplement.coulomb.iter().find(|f| f.part == part);
        once(self.machine, (part, place), what, earlier.map(|f| (what, f.place)))?;
        self.supplement.coulomb.push(PartNumber { part, value, place });
        Ok(())
    }

    /// `SPEED part value` or `TABLE part t x t x …`
    fn drive(&mut self, what: &str) -> Read<()> {
        let (part, place) = self.moving(what)?;
        let kind = match what {
            "speed" => DriveKind::Speed(self.number("the speed")?),
            _ => DriveKind::Table(self.table(part)?),
        };
        let earlier = self.supplement.drives.iter().find(|d| d.part == part);
        let named = |k: &DriveKind| if matches!(k, DriveKind::Speed(_)) { "speed" } else { "table" };
        once(self.machine, (part, place), what, earlier.map(|d| (named(&d.kind), d.place)))?;
        self.supplement.drives.push(DriveData { part, kind, place });
        Ok(())
    }

    fn table(&mut self, part: usize) -> Read<Vec<(f64, f64)>> {
        let mut points: Vec<(f64, f64)> = Vec::new();
        let name = &self.machine.parts()[part].name;
        while points.len() < 2 || !self.token.is_end() {
            let place = self.token.place;
            if points.len() == TABLE_POINTS {
                let message = format!(
                    "the table of {name} has more than {TABLE_POINTS} points; expected at most {TABLE_POINTS}"
                );
                return Err(Fault::new(place, message));
            }
            let t = self.number("a time and a position, for two points or more")?;
            if let Some((before, _)) = points.last().filter(|p| t <= p.0) {
                let message = format!(
                    "time {} of the table of {name} does not come after {}; expected increasing times",
                    number(t),
                    number(*before)
                );
                return Err(Fault::new(place, message));
            }
            points.push((t, self.number("the position at this time")?));
        }
        Ok(points)
    }

    /// `STOP part low high`, either of them NONE
    fn stop(&mut self) -> Read<()> {
        let (part, place) = self.moving("stop")?;
        let first = self.token.place;
        let (low, high) = (self.limit("lower")?, self.limit("upper")?);
        let name = &self.machine.parts()[part].name;
        match (low, high) {
            (None, None) => {
                let message = format!("a stop of {name} without limits; expected a number for one of them");
                return Err(Fault::new(first, message));
            }
            (Some(l), Some(h)) if l >= h => {
                let message = format!(
                    "the stops of {name} are at {} and {}; expected the lower limit first",
                    number(l),
                    number(h)
                );
                return Err(Fault::new(first, message));
            }
            _ => {}
        }
        let earlier = self.supplement.stops.iter().find(|s| s.part == part);
        once(self.machine, (part, place), "stop", earlier.map(|s| ("stop", s.place)))?;
        self.supplement.stops.push(StopData { part, low, high, place });
        Ok(())
    }

    fn limit(&mut self, which: &str) -> Read<Option<f64>> {
        if self.token.is_word("none") {
            return self.take().map(|_| None);
        }
        self.number(&format!("the {which} limit, or NONE")).map(Some)
    }

    /// `MASS part mass x y z [inertia]`
    fn mass(&mut self) -> Read<()> {
        let (part, place) = self.moving("mass")?;
        let mass = self.positive("mass")?;
        let center = self.vector("of the centre of mass")?;
        let inertia = if self.at_number() {
            Some(self.not_negative("inertia about the centre of mass")?)
        } else {
            None
        };
        let earlier = self.supplement.masses.iter().find(|m| m.part == part);
        once(self.machine, (part, place), "mass", earlier.map(|m| ("mass", m.place)))?;
        self.supplement.masses.push(MassData { part, mass, center, inertia, place });
        Ok(())
    }

    fn vector(&mut self, of: &str) -> Read<[f64; 3]> {
        let mut v = [0.0; 3];
        for (x, axis) in v.iter_mut().zip(["x", "y", "z"]) {
            *x = self.number(&format!("the {axis} {of}"))?;
        }
        Ok(v)
    }

    /// `GRAVITY x y z`
    fn gravity(&mut self) -> Read<()> {
        let place = self.take()?.place;
        let field = self.vector("of gravity")?;
        single(place, "gravity", self.supplement.gravity.as_ref().map(|g| g.place))?;
        self.supplement.gravity = Some(GravityData { field, place });
        Ok(())
    }

    /// `CONTACT E D M`
    fn contact(&mut self) -> Read<()> {
        let place = self.take()?.place;
        let e = self.positive("contact constant E")?;
        let d = self.not_negative("contact constant D")?;
        let m = self.not_negative("contact constant M")?;
        single(place, "contact law", self.supplement.contact.as_ref().map(|c| c.place))?;
        self.supplement.contact = Some(ContactData { e, d, m, place });
        Ok(())
    }
}

fn single(place: Place, what: &str, earlier: Option<Place>) -> Read<()> {
    let Some(at) = earlier else { return Ok(()) };
    let message = format!("a second {what} (the first is at {}:{}); expected one", at.line, at.column);
    Err(Fault::new(place, message))
}
