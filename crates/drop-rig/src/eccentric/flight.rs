//! Between contacts: free fall with rotation over the ringing plate, in closed
//! form, and the time of the next contact.

use crate::dual::fixed;
use crate::eccentric::body::{Planar, State};
use crate::plate_ringing::Ringing;
use crate::rig::Plate;

/// Steps of the search for the next contact before it is given up. A hundred
/// are usual.
const LARGEST_STEPS: usize = 1_000_000;
/// The search ends when its steps no longer change the time; part of it.
const SMALLEST_STEP: f64 = 4.0 * f64::EPSILON;

/// Motion without contact from `start`, at time zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flight<'a> {
    planar: &'a Planar,
    start: State,
    ringing: Option<Ringing<1>>,
}

fn ringing_from(plate: &Plate, state: &State) -> Ringing<1> {
    let decay = 0.5 * plate.damping / plate.mass;
    Ringing {
        displacement: fixed(state.plate),
        velocity: fixed(state.plate_velocity),
        decay: fixed(decay),
        frequency_squared: fixed(plate.stiffness / plate.mass - decay * decay),
    }
}

impl<'a> Flight<'a> {
    pub fn new(planar: &'a Planar, start: State) -> Self {
        let plate = planar.plate.as_ref();
        Self {
            planar,
            start,
            ringing: plate.map(|plate| ringing_from(plate, &start)),
        }
    }

    /// State `time` after the start.
    pub fn at(&self, time: f64) -> State {
        let (from, gravity) = (&self.start, self.planar.gravity);
        let still = (from.plate, from.plate_velocity);
        let ringing = self.ringing.as_ref();
        let (plate, plate_velocity) = ringing.map_or(still, |plate| plate.values_at(time));
        let rotation = from.rotation + from.spin * time;
        // As changes since the start, so that small gaps are not differences
        // of large heights.
        let shape = &self.planar.shape;
        let lower = shape.lowest_point(rotation).depth - shape.lowest_point(from.rotation).depth;
        let rise = (from.velocity_y - 0.5 * gravity * time) * time;
        State {
            x: from.x + from.velocity_x * time,
            displacement: from.displacement + (plate - from.plate) + lower - rise,
            rotation,
            plate,
            velocity_x: from.velocity_x,
            velocity_y: from.velocity_y - gravity * time,
            spin: from.spin,
            plate_velocity,
        }
    }

    /// Time from the start to the next contact, with the state then; `None`
    /// if the search does not come to an end.
    ///
    /// # Numerics
    /// Marches by the largest step that cannot pass a contact: with G an upper
    /// bound of |gap″|, the gap stays positive until the root of
    /// gap + gap′ τ − G τ²/2. Near the contact the steps shrink quadratically,
    /// like Newton's. No contact is missed, however the body turns and the
    /// plate rings.
    pub fn next_contact(&self) -> Option<(f64, State)> {
        let turning = self.start.spin * self.start.spin * self.planar.shape.largest_curvature();
        let mut time = 0.0;
        let mut state = self.start;
        for _ in 0..LARGEST_STEPS {
            let lowest = self.planar.lowest_point(&state);
            let (gap, opening) = (-state.displacement, -self.planar.rate(&state, &lowest));
            let bound = self.planar.gravity + turning + self.plate_acceleration(&state);
            let step = safe_step(gap.max(0.0), opening, bound);
            if step <= SMALLEST_STEP * time || (time > 0.0 && gap <= 0.0) {
                state.displacement = 0.0;
                return Some((time, state));
            }
            time += step;
            state = self.at(time);
        }
        None
    }

    /// Upper bound of the plate's acceleration from now on: its energy only
    /// falls.
    fn plate_acceleration(&self, state: &State) -> f64 {
        self.planar.plate.map_or(0.0, |plate| {
            let energy = plate.stiffness * state.plate * state.plate
                + plate.mass * state.plate_velocity * state.plate_velocity;
            ((energy * plate.stiffness).sqrt() + plate.damping * (energy / plate.mass).sqrt())
                / plate.mass
        })
    }
}

/// Positive root of gap + opening τ − bound τ²/2.
fn safe_step(gap: f64, opening: f64, bound: f64) -> f64 {
    let root = (opening * opening + 2.0 * bound * gap).sqrt();
    if opening > 0.0 {
        (opening + root) / bound
    } else if gap > 0.0 {
        2.0 * gap / (root - opening)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eccentric::shape::Shape;

    fn planar(shape: Shape, plate: Option<Plate>) -> Planar {
        Planar {
            shape,
            mass: 0.0048,
            inertia: 2e-7,
            friction: 0.0,
            gravity: 9.80665,
            plate,
        }
    }

    const ELLIPSE: Shape = Shape::Ellipse {
        semi_axes: [0.012, 0.006],
        tilt: 0.4,
    };

    /// A ball that rises with v over a rigid plate is back after 2 v/g.
    #[test]
    fn closed_form_flight_of_a_ball() {
        let ball = Shape::OffsetDisc {
            radius: 0.01,
            offset: 0.0,
            angle: 0.0,
        };
        let planar = planar(ball, None);
        for velocity in [1e-6, 0.3, 2.7] {
            let start = State {
                velocity_y: velocity,
                spin: 50.0,
                ..State::default()
            };
            let flight = Flight::new(&planar, start);
            let (time, state) = flight.next_contact().unwrap();
            let expected = 2.0 * velocity / 9.80665;
            assert!((time / expected - 1.0).abs() < 1e-12, "{time} {expected}");
            assert!((state.velocity_y + velocity).abs() < 1e-12 * velocity);
        }
    }

    /// The first contact of a fast-turning ellipse over a ringing plate against
    /// the first sign change on a fine grid.
    #[test]
    fn closed_form_next_contact_is_the_first() {
        let plate = Plate {
            mass: 0.2,
            stiffness: 645_800.0,
            damping: 52.47,
        };
        let planar = planar(ELLIPSE, Some(plate));
        for spin in [-900.0, -55.0, 0.0, 30.0, 400.0, 2500.0] {
            for velocity_y in [0.01, 0.4, 1.5] {
                let mut start = State {
                    velocity_y,
                    spin,
                    plate: -2e-5,
                    plate_velocity: 0.05,
                    ..State::default()
                };
                // Opening at the start, as after a contact.
                let lowest = planar.lowest_point(&start);
                start.velocity_y += (planar.rate(&start, &lowest) + 0.1).max(0.0);
                let flight = Flight::new(&planar, start);
                let (time, state) = flight.next_contact().unwrap();
                assert!(flight.at(time).displacement.abs() < 1e-15);
                assert_eq!(state.displacement, 0.0);
                let touching = (1..1_000_000)
                    .map(|i| f64::from(i) * 2e-6)
                    .find(|&t| flight.at(t).displacement > 0.0)
                    .unwrap();
                assert!(
                    time <= touching && time > touching - 2.1e-6,
                    "{spin} {velocity_y}: {time} {touching}"
                );
            }
        }
    }
}
