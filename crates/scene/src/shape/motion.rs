//! How walls move over time.

use crate::shape::placed::Placed;
use crate::vector::{Rotation, UNTURNED, Vector, length, plus_scaled, turn_about};
use std::f64::consts::PI;
use windfall_numerics::monotone_cubic::MonotoneCubic;

/// Motion of a wall. Its moves add up; a wall turns about one axis, which goes along with it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Motion {
    /// What it does, and when.
    pub moves: Vec<Move>,
}

/// One move of a wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// When.
    pub when: When,
    /// What it does.
    pub how: How,
}

/// What a wall does.
#[derive(Clone, Debug, PartialEq)]
pub enum How {
    /// It moves at a velocity; m/s.
    Velocity(Vector),
    /// It vibrates: A sin(2π f t).
    Vibration {
        /// Amplitude and direction; m.
        amplitude: Vector,
        /// Frequency; Hz.
        frequency: f64,
    },
    /// It turns.
    Rotation {
        /// About this axis.
        about: Axis,
        /// Angular velocity; rad/s.
        angular_velocity: f64,
    },
    /// Its surface runs while it stays, as that of a conveyor belt: velocity; m/s. The part
    /// along the surface acts.
    Belt(Vector),
    /// It follows a table of positions.
    Path(Box<Path>),
}

/// An axis of the wall at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// A point of it; m.
    pub point: Vector,
    /// Its direction; length 1.
    pub direction: Vector,
}

/// Positions over time, with a smooth curve between them; the move lasts from the first to the
/// last, and the wall stays where it is before and after it.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Displacement from its place at rest over time; m against s.
    pub shift: [MonotoneCubic; 3],
    /// Angle over time; rad against s.
    pub turn: Option<(Axis, MonotoneCubic)>,
}

/// When a move happens: its speed rises steadily, stays, and falls steadily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct When {
    /// It begins; s. Minus infinity where it always did: it has then come a way of 0 at time 0.
    pub from: f64,
    /// It has ended; s.
    pub until: f64,
    /// How long its speed rises, and how long it falls; s.
    pub ramp: f64,
}

impl Default for When {
    fn default() -> Self {
        Self::ALWAYS
    }
}

impl When {
    /// Without beginning and end.
    pub const ALWAYS: Self = Self {
        from: f64::NEG_INFINITY,
        until: f64::INFINITY,
        ramp: 0.0,
    };

    /// Part of its full speed at a time; 1.
    pub fn share(&self, time: f64) -> f64 {
        let edge = (time - self.from).min(self.until - time);
        match () {
            () if edge < 0.0 || edge == 0.0 && self.ramp > 0.0 => 0.0,
            () if edge >= self.ramp => 1.0,
            () => edge / self.ramp,
        }
    }

    /// Time at full speed that takes it as far as it is; s.
    pub fn elapsed(&self, time: f64) -> f64 {
        if self.from == f64::NEG_INFINITY {
            return time.min(self.until);
        }
        let (time, half) = (time.clamp(self.from, self.until), 0.5 * self.ramp);
        let (begun, left) = (time - self.from, self.until - time);
        if begun < self.ramp {
            return 0.5 * begun * begun / self.ramp;
        }
        let missing = match left < self.ramp {
            true => 0.5 * (self.ramp - left).powi(2) / self.ramp,
            false => 0.0,
        };
        begun - half - missing
    }

    /// All of it in time at full speed; s.
    pub fn whole(&self) -> f64 {
        self.until - self.from - self.ramp
    }

    /// Rate at which its speed rises at a time; 1/s.
    fn rise(&self, time: f64) -> f64 {
        let (begun, left) = (time - self.from, self.until - time);
        match () {
            () if begun < 0.0 || left < 0.0 => 0.0,
            () if begun < self.ramp => 1.0 / self.ramp,
            () if left < self.ramp => -1.0 / self.ramp,
            () => 0.0,
        }
    }

    /// Whether it and another are both under way at some time.
    fn overlaps(&self, other: &Self) -> bool {
        self.from < other.until && other.from < self.until
    }
}

impl Move {
    /// It always was and never ends.
    pub fn always(how: How) -> Self {
        let when = When::ALWAYS;
        Self { when, how }
    }

    /// The axis that it turns about.
    fn axis(&self) -> Option<Axis> {
        match &self.how {
            How::Rotation { about, .. } => Some(*about),
            How::Path(path) => path.turn.as_ref().map(|own| own.0),
            _ => None,
        }
    }

    /// The largest speed that it gives to points within `reach` of its axis, between two times;
    /// m/s.
    fn largest_speed(&self, reach: f64, [first, last]: [f64; 2]) -> f64 {
        let When { from, until, ramp } = self.when;
        if first > until || last < from {
            return 0.0;
        }
        match &self.how {
            How::Velocity(own) => length(*own),
            How::Vibration {
                amplitude,
                frequency,
            } => {
                // While it sets in and ends, the amplitude changes, too.
                let changes = if ramp > 0.0 { 1.0 / ramp } else { 0.0 };
                (2.0 * PI * frequency.abs() + changes) * length(*amplitude)
            }
            How::Rotation {
                angular_velocity, ..
            } => angular_velocity.abs() * reach,
            How::Belt(_) => 0.0,
            How::Path(path) => {
                let shift = path.shift.each_ref().map(MonotoneCubic::largest_slope);
                let turn = path.turn.as_ref().map_or(0.0, |own| own.1.largest_slope());
                length(shift) + turn * reach
            }
        }
    }
}

impl Motion {
    /// A motion that always was and never ends.
    pub fn always(all: impl IntoIterator<Item = How>) -> Self {
        Self {
            moves: all.into_iter().map(Move::always).collect(),
        }
    }

    /// Whether the wall stays where it is (its surface may run).
    pub fn stays(&self) -> bool {
        self.moves.iter().all(|own| matches!(own.how, How::Belt(_)))
    }

    /// Whether its surface runs.
    pub fn runs(&self) -> bool {
        self.moves.iter().any(|own| matches!(own.how, How::Belt(_)))
    }

    /// Whether it has neither beginning nor end.
    pub fn is_steady(&self) -> bool {
        self.moves.iter().all(|own| own.when == When::ALWAYS)
    }

    /// Why its moves cannot be together, if they cannot.
    pub fn problem(&self) -> Option<String> {
        let mut axis: Option<Axis> = None;
        for (number, own) in self.moves.iter().enumerate() {
            let before = &self.moves[..number];
            if let Some(about) = own.axis()
                && *axis.get_or_insert(about) != about
            {
                let problem = "a wall turns about one axis: give all its moves the same `point` and \
                               `axis`";
                return Some(problem.to_owned());
            }
            let same = |other: &&Move| {
                std::mem::discriminant(&own.how) == std::mem::discriminant(&other.how)
                    && own.when.overlaps(&other.when)
            };
            let vibrates = matches!(own.how, How::Vibration { .. });
            if let Some(other) = before.iter().find(same)
                && !vibrates
            {
                let [from, until] = [other.when.from, other.when.until];
                let until = match until.is_finite() {
                    true => format!("until {until} s"),
                    false => "and never ends".to_owned(),
                };
                let from = match from.is_finite() {
                    true => format!("begins at {from} s"),
                    false => "has no beginning".to_owned(),
                };
                return Some(format!(
                    "it overlaps another move of the same kind, which {from} {until}: end that one \
                     before, or begin this one after it"
                ));
            }
        }
        None
    }

    /// Where the wall is at a time: a point x of it at rest is at q x q⁻¹ + t, with the
    /// rotation q and the shift t (m).
    ///
    /// * `time`: s
    pub fn pose(&self, time: f64) -> (Rotation, Vector) {
        let placed = self.at(time);
        (placed.turn, placed.outward([0.0; 3]))
    }

    /// Where a point of the wall at rest is at a time; m.
    pub fn moved(&self, point: Vector, time: f64) -> Vector {
        self.at(time).outward(point)
    }

    pub(crate) fn at(&self, time: f64) -> Placed {
        let mut found = Placed {
            shift: [0.0; 3],
            turn: UNTURNED,
            pivot: [0.0; 3],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            surface: [0.0; 3],
        };
        let mut angle = None;
        let mut turn = |about: Axis, by: f64, rate: f64, found: &mut Placed| {
            let (_, sum) = angle.unwrap_or((about, 0.0));
            angle = Some((about, sum + by));
            found.spin = plus_scaled(found.spin, about.direction, rate);
        };
        for Move { when, how } in &self.moves {
            let (share, elapsed) = (when.share(time), when.elapsed(time));
            match how {
                How::Velocity(own) => {
                    found.shift = plus_scaled(found.shift, *own, elapsed);
                    found.velocity = plus_scaled(found.velocity, *own, share);
                }
                How::Vibration {
                    amplitude,
                    frequency,
                } => {
                    let rate = 2.0 * PI * frequency;
                    let since = if when.from.is_finite() {
                        when.from
                    } else {
                        0.0
                    };
                    let (s, c) = (rate * (time - since)).sin_cos();
                    let speed = share * rate * c + when.rise(time) * s;
                    found.shift = plus_scaled(found.shift, *amplitude, share * s);
                    found.velocity = plus_scaled(found.velocity, *amplitude, speed);
                }
                How::Rotation {
                    about,
                    angular_velocity,
                } => {
                    let [by, rate] = [elapsed, share].map(|own| angular_velocity * own);
                    turn(*about, by, rate, &mut found);
                }
                How::Belt(own) => found.surface = plus_scaled(found.surface, *own, share),
                How::Path(path) => {
                    let then = time.clamp(when.from, when.until);
                    let at = |curve: &MonotoneCubic| curve.evaluate(then);
                    let along = path.shift.each_ref().map(at);
                    found.shift = plus_scaled(found.shift, along.map(|own| own.0), 1.0);
                    found.velocity = plus_scaled(found.velocity, along.map(|own| own.1), share);
                    if let Some((about, curve)) = &path.turn {
                        let (by, rate) = at(curve);
                        turn(*about, by, share * rate, &mut found);
                    }
                }
            }
        }
        if let Some((about, angle)) = angle {
            found.turn = turn_about(about.direction, angle);
            found.pivot = about.point;
        }
        found
    }

    /// The axis at rest that it turns about, where it turns.
    pub(crate) fn axis(&self) -> Option<Axis> {
        self.moves.iter().find_map(Move::axis)
    }

    /// The largest speed of a point of the wall that is within `reach` of its axis, between two
    /// times; m/s.
    pub(crate) fn largest_speed(&self, reach: f64, between: [f64; 2]) -> f64 {
        let speeds = self
            .moves
            .iter()
            .map(|own| own.largest_speed(reach, between));
        speeds.sum()
    }

    /// The largest speed at which its surface runs; m/s.
    pub fn belt_speed(&self) -> f64 {
        let speeds = self.moves.iter().map(|own| match own.how {
            How::Belt(velocity) => length(velocity),
            _ => 0.0,
        });
        speeds.sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMED: When = When {
        from: 1.0,
        until: 4.0,
        ramp: 0.5,
    };

    fn motion(how: How) -> Motion {
        let ramp = match how {
            // A table has its own.
            How::Path(_) => 0.0,
            _ => TIMED.ramp,
        };
        let when = When { ramp, ..TIMED };
        let moves = vec![Move { when, how }];
        Motion { moves }
    }

    #[test]
    fn closed_form_a_trapezoid_of_speed() {
        let lift = motion(How::Velocity([0.0, 0.0, 0.4]));
        let height = |time| lift.at(time).shift[2];
        // Half of the ramp's way in the middle of it is a quarter of it.
        for (time, wanted) in [
            (0.0, 0.0),
            (1.25, 0.4 * 0.0625),
            (1.5, 0.4 * 0.25),
            (3.0, 0.4 * 1.75),
            (3.75, 0.4 * (2.5 - 0.0625)),
            (4.0, 0.4 * TIMED.whole()),
            (9.0, 0.4 * 2.5),
        ] {
            assert!((height(time) - wanted).abs() < 1e-15, "{time}");
        }
        assert_eq!(lift.at(9.0).velocity, [0.0; 3]);
        assert_eq!(lift.largest_speed(0.0, [4.1, 5.0]), 0.0);
    }

    /// The speed of every kind of move is what its place changes by, and its bound holds.
    #[test]
    fn conserves_speed_as_the_change_of_place() {
        let about = Axis {
            point: [0.1, 0.2, 0.0],
            direction: [0.0, 1.0, 0.0],
        };
        let times = [1.0, 1.3, 2.0, 3.5, 4.0];
        let curve = |values: &[f64]| MonotoneCubic::new(&times, values);
        let kinds = [
            How::Velocity([0.3, 0.0, 0.1]),
            How::Vibration {
                amplitude: [0.0, 0.002, 0.001],
                frequency: 3.0,
            },
            How::Rotation {
                about,
                angular_velocity: -1.5,
            },
            How::Path(Box::new(Path {
                shift: [
                    curve(&[0.0, 0.1, 0.1, 0.4, 0.3]),
                    curve(&[0.0; 5]),
                    curve(&[0.0, 0.0, 0.2, 0.3, 0.3]),
                ],
                turn: Some((about, curve(&[0.0, 0.2, 1.0, 1.1, 2.0]))),
            })),
        ];
        let corner = [1.0, 0.5, 0.25];
        let reach = length(crate::vector::subtract(corner, about.point));
        for how in kinds {
            let own = motion(how);
            for step in 0..400 {
                let (time, h) = (0.5 + 0.01 * f64::from(step) + 1e-3, 1e-6);
                let place = |time: f64| own.at(time).outward(corner);
                let (before, after) = (place(time - h), place(time + h));
                let placed = own.at(time);
                let told = placed.velocity_at(placed.outward(corner), [1.0, 0.0, 0.0]);
                for axis in 0..3 {
                    let seen = (after[axis] - before[axis]) / (2.0 * h);
                    assert!((told[axis] - seen).abs() < 1e-5, "{own:?} {time}");
                }
                let bound = own.largest_speed(reach, [time, time]);
                assert!(length(told) <= bound + 1e-12, "{own:?} {time}");
            }
        }
    }

    #[test]
    fn names_moves_that_cannot_be_together() {
        let of = |moves: &[(f64, How)]| {
            let timed = moves.iter().map(|(from, how)| Move {
                when: When {
                    from: *from,
                    until: from + 2.0,
                    ramp: 0.1,
                },
                how: how.clone(),
            });
            let moves = timed.collect();
            Motion { moves }.problem()
        };
        let lift = How::Velocity([0.0, 0.0, 1.0]);
        let turn = |point: Vector| How::Rotation {
            about: Axis {
                point,
                direction: [0.0, 1.0, 0.0],
            },
            angular_velocity: 1.0,
        };
        assert_eq!(of(&[(0.0, lift.clone()), (2.0, lift.clone())]), None);
        assert_eq!(of(&[(0.0, lift.clone()), (1.0, turn([0.0; 3]))]), None);
        let problem = of(&[(0.0, lift.clone()), (1.9, lift)]).unwrap();
        assert!(problem.contains("begins at 0 s until 2 s"), "{problem}");
        let turns = [(0.0, turn([0.0; 3])), (5.0, turn([1.0, 0.0, 0.0]))];
        assert!(of(&turns).unwrap().contains("one axis"));
    }
}
