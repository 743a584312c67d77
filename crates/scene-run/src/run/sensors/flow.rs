//! A plane or a plate that fruit pass.

use crate::file::sensors::{SensorKind, SensorPlan};
use crate::run::sensors::outcome::FlowOutcome;
use crate::run::sensors::trace::Trace;
use windfall_scene::binary;
use windfall_scene::periods::Periods;
use windfall_scene::shape::surface::Plate;
use windfall_scene::vector::{Vector, add, cross, dot, plus_scaled, subtract, unit};

/// Bars of a figure at least.
const LEAST_BARS: f64 = 20.0;

/// A pass of a fruit's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pass {
    /// Interpolated; s.
    pub time: f64,
    /// Number of the fruit.
    pub fruit: u32,
    /// Whether in the direction of the normal.
    pub forward: bool,
    /// Where; m.
    pub place: Vector,
    /// Speed along the normal, in its direction; m/s.
    pub speed: f64,
    /// Of the fruit; kg.
    pub mass: f64,
}

/// What is between two looks: where a centre was and is, and when.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// Number of the fruit.
    pub fruit: u32,
    /// Places; m.
    pub places: [Vector; 2],
    /// Times of them; s.
    pub times: [f64; 2],
    /// Of the fruit; kg.
    pub mass: f64,
}

impl Way {
    /// The place after a share of the way; m.
    pub fn place(&self, share: f64) -> Vector {
        let [from, to] = self.places;
        plus_scaled(from, subtract(to, from), share)
    }

    /// Its image whose middle is nearest to a place.
    pub fn image(&self, periods: &Periods, place: Vector) -> Self {
        let middle = self.place(0.5);
        let shift = subtract(periods.image(middle, place), middle);
        Self {
            places: self.places.map(|own| add(own, shift)),
            ..*self
        }
    }

    /// The time after a share of the way; s.
    pub fn time(&self, share: f64) -> f64 {
        self.times[0] + share * (self.times[1] - self.times[0])
    }
}

/// A plane or a plate.
pub(super) struct Flow {
    /// The sensor.
    pub sensor: usize,
    point: Vector,
    normal: Vector,
    /// Whether only what passes within counts.
    plate: Option<Plate>,
    /// A point in the middle of it; m.
    middle: Vector,
    periods: Periods,
    interval: f64,
    /// What was seen.
    pub state: FlowState,
}

/// What a plane or a plate saw.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct FlowState {
    forward: u64,
    backward: u64,
    mass: f64,
    /// Time and mass of the first pass forward.
    first: Option<(f64, f64)>,
    last: f64,
    /// Time and mass of passes forward within the last interval.
    recent: Vec<(f64, f64)>,
    most: u64,
    largest_mass: f64,
    /// Passes over time, forward and backward.
    pub there: Trace,
    pub back: Trace,
}

binary!(FlowState {
    forward,
    backward,
    mass,
    first,
    last,
    recent,
    most,
    largest_mass,
    there,
    back
});

impl Flow {
    /// The plane or plate of a sensor; `None` where it is something else.
    ///
    /// * `end`: of the scene; s
    pub fn new(sensor: usize, plan: &SensorPlan, end: f64, periods: Periods) -> Option<Self> {
        let (point, normal, plate) = match plan.kind {
            SensorKind::Plane { point, normal } => (point, normal, None),
            SensorKind::Plate(own) => {
                let normal = unit(cross(own.edges[0], own.edges[1]))?;
                (own.corner, normal, Some(own))
            }
            _ => return None,
        };
        let trace = Trace::new(plan.interval.min(end / LEAST_BARS), end);
        Some(Self {
            sensor,
            point,
            normal,
            plate,
            middle: plate.map_or(point, |own| {
                let [a, b] = own.edges;
                plus_scaled(point, add(a, b), 0.5)
            }),
            periods,
            interval: plan.interval,
            state: FlowState {
                there: trace.clone(),
                back: trace,
                ..FlowState::default()
            },
        })
    }

    /// The pass of a fruit on its way, if there is one; it is taken for straight and even.
    pub fn pass(&self, way: &Way) -> Option<Pass> {
        let way = &way.image(&self.periods, self.middle);
        let heights = way
            .places
            .map(|own| dot(subtract(own, self.point), self.normal));
        let sides = heights.map(|own| own >= 0.0);
        if sides[0] == sides[1] {
            return None;
        }
        let share = heights[0] / (heights[0] - heights[1]);
        let place = way.place(share);
        if let Some(plate) = &self.plate
            && !within(plate, place)
        {
            return None;
        }
        Some(Pass {
            time: way.time(share),
            fruit: way.fruit,
            forward: sides[1],
            place: self.periods.wrapped(place),
            speed: (heights[1] - heights[0]) / (way.times[1] - way.times[0]),
            mass: way.mass,
        })
    }

    /// Counts a pass; they come in the order of their times.
    pub fn count(&mut self, pass: &Pass) {
        let own = &mut self.state;
        if !pass.forward {
            own.backward += 1;
            own.back.add(pass.time, 1.0);
            return;
        }
        own.forward += 1;
        own.mass += pass.mass;
        own.there.add(pass.time, 1.0);
        own.first.get_or_insert((pass.time, pass.mass));
        own.last = pass.time;
        let since = pass.time - self.interval;
        own.recent.retain(|(time, _)| *time > since);
        own.recent.push((pass.time, pass.mass));
        own.most = own.most.max(own.recent.len() as u64);
        let mass = own.recent.iter().map(|(_, mass)| mass).sum();
        own.largest_mass = own.largest_mass.max(mass);
    }

    /// Whether nothing passed.
    pub fn is_silent(&self) -> bool {
        self.state.forward + self.state.backward == 0
    }

    /// What it saw.
    pub fn outcome(&self) -> FlowOutcome {
        let own = &self.state;
        let span = own.first.map(|(first, _)| own.last - first);
        let span = span.filter(|span| *span > 0.0);
        let first_mass = own.first.map_or(0.0, |(_, mass)| mass);
        FlowOutcome {
            forward: own.forward,
            backward: own.backward,
            mass_forward: own.mass,
            first: own.first.map(|(time, _)| time),
            last: own.first.map(|_| own.last),
            mean_flow: span.map(|span| (own.forward - 1) as f64 / span),
            mean_mass_flow: span.map(|span| (own.mass - first_mass) / span),
            largest_flow: own.most as f64 / self.interval,
            largest_mass_flow: own.largest_mass / self.interval,
        }
    }
}

/// Whether a point of the plane of a parallelogram is within it.
fn within(plate: &Plate, place: Vector) -> bool {
    let [a, b] = plate.edges;
    let from = subtract(place, plate.corner);
    let normal = cross(a, b);
    let size = dot(normal, normal);
    let shares = [
        dot(cross(from, b), normal) / size,
        dot(cross(a, from), normal) / size,
    ];
    shares.iter().all(|share| (0.0..=1.0).contains(share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flow(kind: SensorKind) -> Flow {
        let plan = SensorPlan {
            name: "gate".to_owned(),
            kind,
            only: None,
            interval: 1.0,
        };
        Flow::new(0, &plan, 10.0, Periods::default()).unwrap()
    }

    fn way(from: Vector, to: Vector) -> Way {
        Way {
            fruit: 3,
            places: [from, to],
            times: [2.0, 2.001],
            mass: 0.2,
        }
    }

    #[test]
    fn closed_form_a_skewed_window_counts_only_what_goes_through() {
        let plate = Plate {
            corner: [0.0, 0.0, 1.0],
            edges: [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0]],
        };
        let own = flow(SensorKind::Plate(plate));
        // (x, y) is within where 0 ≤ x ≤ 1 and 0 ≤ y − x/2 ≤ 1.
        for (x, y, counts) in [
            (0.5, 0.3, true),
            (0.5, 0.2, false),
            (0.5, 1.2, true),
            (0.5, 1.3, false),
            (-0.01, 0.5, false),
            (1.01, 1.0, false),
        ] {
            let down = own.pass(&way([x, y, 1.003], [x, y, 0.999]));
            assert_eq!(down.is_some(), counts, "{x} {y}");
            if let Some(pass) = down {
                assert!(!pass.forward);
                assert!((pass.time - 2.000_75).abs() < 1e-12, "{}", pass.time);
                assert!((pass.speed + 4.0).abs() < 1e-9 && (pass.place[2] - 1.0).abs() < 1e-12);
            }
        }
        assert!(
            own.pass(&way([0.5, 0.5, 0.9], [0.5, 0.5, 1.1]))
                .unwrap()
                .forward
        );
    }

    #[test]
    fn closed_form_flows_of_passes_at_known_times() {
        let normal = [1.0, 0.0, 0.0];
        let mut own = flow(SensorKind::Plane {
            point: [0.0; 3],
            normal,
        });
        assert!(own.is_silent());
        // Every 0.25 s but for a burst of five within 0.4 s.
        let times = [0.0, 0.25, 0.5, 0.75, 1.0, 2.0, 2.1, 2.2, 2.3, 2.4];
        for time in times {
            let pass = own.pass(&way([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0])).unwrap();
            own.count(&Pass { time, ..pass });
        }
        let found = own.outcome();
        assert_eq!((found.forward, found.backward), (10, 0));
        assert!((found.mass_forward - 2.0).abs() < 1e-12);
        assert!((found.mean_flow.unwrap() - 9.0 / 2.4).abs() < 1e-12);
        assert!((found.mean_mass_flow.unwrap() - 1.8 / 2.4).abs() < 1e-12);
        // (0, 1] holds 0.25 … 1.0; (1.4, 2.4] holds five.
        assert_eq!(found.largest_flow, 5.0);
        assert!((found.largest_mass_flow - 1.0).abs() < 1e-12);
    }
}
