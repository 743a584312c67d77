//! A box in which fruit are.

use crate::file::sensors::{SensorKind, SensorPlan};
use crate::run::sensors::flow::Way;
use crate::run::sensors::outcome::{ResidenceOutcome, SpaceOutcome};
use crate::run::sensors::trace::Trace;
use windfall_scene::binary;
use windfall_scene::motion::simulation::FruitState;
use windfall_scene::periods::Periods;
use windfall_scene::scene::Fruit;
use windfall_scene::vector::{Vector, add, scaled, subtract, turned};

/// A box.
pub(super) struct Space {
    /// The sensor.
    pub sensor: usize,
    low: Vector,
    high: Vector,
    periods: Periods,
    /// Steps between rows of the table.
    pub every: u64,
    /// What is in it at the end.
    pub last: Content,
    /// What was seen.
    pub state: SpaceState,
}

/// What a box saw.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct SpaceState {
    /// Of each fruit the first entry and the last exit, NaN where there is none; s.
    stays: Vec<[f64; 2]>,
    inside: Vec<bool>,
    most: u64,
    largest_mass: f64,
    largest_level: Option<f64>,
    /// Fruit and level over time.
    pub counts: Trace,
    pub levels: Trace,
}

binary!(SpaceState {
    stays,
    inside,
    most,
    largest_mass,
    largest_level,
    counts,
    levels
});

/// What is in a box at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Content {
    /// Number of fruit.
    pub fruit: u64,
    /// Their mass; kg.
    pub mass: f64,
    /// Height of the highest top of them; m.
    pub level: Option<f64>,
    /// Their volume over that of the box; 1.
    pub share: f64,
}

impl Space {
    /// The box of a sensor; `None` where it is something else.
    ///
    /// * `fruit`: in the scene
    /// * `every`: steps between rows of the table, whose time is `interval`; s
    /// * `end`: of the scene; s
    pub fn new(
        sensor: usize,
        plan: &SensorPlan,
        fruit: usize,
        (every, interval, end): (u64, f64, f64),
        periods: Periods,
    ) -> Option<Self> {
        let SensorKind::Space { low, high } = plan.kind else {
            return None;
        };
        let trace = Trace::new(interval, end);
        Some(Self {
            sensor,
            low,
            high,
            periods,
            every,
            last: Content::default(),
            state: SpaceState {
                stays: vec![[f64::NAN; 2]; fruit],
                inside: vec![false; fruit],
                counts: trace.clone(),
                levels: trace,
                ..SpaceState::default()
            },
        })
    }

    fn middle(&self) -> Vector {
        scaled(add(self.low, self.high), 0.5)
    }

    fn holds(&self, place: Vector) -> bool {
        let place = self.periods.image(place, self.middle());
        (0..3).all(|axis| (self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }

    /// Takes in a fruit that was not there at the look before.
    pub fn come(&mut self, fruit: u32, place: Vector, time: f64) {
        if self.holds(place) {
            self.enter(fruit, time);
        }
    }

    /// Takes in the way of a fruit.
    pub fn follow(&mut self, way: &Way) {
        let [from, to] = way.places.map(|own| self.holds(own));
        if from && to {
            return;
        }
        let Some([enters, leaves]) = self.shares(&self.beside(way, [from, to])) else {
            return;
        };
        if !from {
            self.enter(way.fruit, way.time(enters));
        }
        if !to {
            self.leave(way.fruit, way.time(leaves));
        }
    }

    /// The image of a way that is in the box with the ends that are.
    fn beside(&self, way: &Way, [from, to]: [bool; 2]) -> Way {
        let mark = match (from, to) {
            (true, _) => way.places[0],
            (false, true) => way.places[1],
            (false, false) => way.place(0.5),
        };
        let shift = subtract(self.periods.image(mark, self.middle()), mark);
        Way {
            places: way.places.map(|own| add(own, shift)),
            ..*way
        }
    }

    /// Between which shares of a way it is in the box.
    fn shares(&self, way: &Way) -> Option<[f64; 2]> {
        let [from, to] = way.places;
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let along = to[axis] - from[axis];
            let ends = [self.low[axis], self.high[axis]].map(|end| (end - from[axis]) / along);
            if along != 0.0 {
                first = first.max(ends[0].min(ends[1]));
                last = last.min(ends[0].max(ends[1]));
            } else if !(self.low[axis]..=self.high[axis]).contains(&from[axis]) {
                return None;
            }
        }
        (first <= last).then_some([first, last])
    }

    fn enter(&mut self, fruit: u32, time: f64) {
        let fruit = fruit as usize;
        self.state.inside[fruit] = true;
        let [first, _] = &mut self.state.stays[fruit];
        if first.is_nan() {
            *first = time;
        }
    }

    /// A fruit leaves the box, or the scene.
    pub fn leave(&mut self, fruit: u32, time: f64) {
        let fruit = fruit as usize;
        if std::mem::take(&mut self.state.inside[fruit]) {
            self.state.stays[fruit][1] = time;
        }
    }

    /// What is in it now.
    ///
    /// * `fruit`: those in the scene that count, by number
    pub fn content(&self, fruit: &[FruitState], all: &[Fruit]) -> Content {
        let mut found = Content::default();
        let mut volume = 0.0;
        for state in fruit.iter().filter(|own| self.holds(own.place)) {
            let own = &all[state.fruit as usize];
            found.fruit += 1;
            found.mass += own.mass;
            volume += 4.0 / 3.0 * std::f64::consts::PI * own.mean_radius().powi(3);
            let top = top(state, own);
            found.level = Some(found.level.map_or(top, |level: f64| level.max(top)));
        }
        let sides = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        found.share = volume / sides.iter().product::<f64>();
        found
    }

    /// Takes in what a row of the table says.
    pub fn sample(&mut self, time: f64, content: &Content) {
        let own = &mut self.state;
        own.most = own.most.max(content.fruit);
        own.largest_mass = own.largest_mass.max(content.mass);
        own.counts.reach(time, content.fruit as f64);
        if let Some(level) = content.level {
            own.levels.reach(time, level);
            own.largest_level = Some(own.largest_level.map_or(level, |own| own.max(level)));
        }
    }

    /// Whether nothing was in it.
    pub fn is_silent(&self) -> bool {
        self.state.stays.iter().all(|[first, _]| first.is_nan())
    }

    /// What it saw.
    pub fn outcome(&self) -> SpaceOutcome {
        let (own, now) = (&self.state, &self.last);
        let stays = own.stays.iter().zip(&own.inside);
        let over = stays.filter(|([first, _], inside)| !first.is_nan() && !**inside);
        let mut times: Vec<f64> = over.map(|([first, last], _)| last - first).collect();
        times.sort_by(f64::total_cmp);
        let entered = own.stays.iter().filter(|[first, _]| !first.is_nan());
        let residence = times.last().map(|largest| ResidenceOutcome {
            fruit: times.len() as u64,
            mean: times.iter().sum::<f64>() / times.len() as f64,
            median: 0.5 * (times[(times.len() - 1) / 2] + times[times.len() / 2]),
            largest: *largest,
        });
        SpaceOutcome {
            entered: entered.count() as u64,
            inside: now.fruit,
            mass: now.mass,
            fruit_share: now.share,
            level: now.level,
            most: own.most.max(now.fruit),
            largest_mass: own.largest_mass.max(now.mass),
            largest_level: own
                .largest_level
                .into_iter()
                .chain(now.level)
                .reduce(f64::max),
            residence,
        }
    }
}

/// Height of the top of a fruit; m.
fn top(state: &FruitState, fruit: &Fruit) -> f64 {
    let height = state.place[2];
    let sphere =
        |(offset, radius): &(Vector, f64)| height + turned(state.turn, *offset)[2] + radius;
    match &fruit.clump {
        None => height + fruit.radius,
        Some(own) => {
            let spheres = own.spheres.iter().map(sphere);
            spheres.fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> Space {
        let plan = SensorPlan {
            name: "bin".to_owned(),
            kind: SensorKind::Space {
                low: [0.0, 0.0, 0.0],
                high: [1.0, 2.0, 0.5],
            },
            only: None,
            interval: 0.1,
        };
        Space::new(0, &plan, 3, (10, 0.1, 5.0), Periods::default()).unwrap()
    }

    fn way(fruit: u32, from: Vector, to: Vector, at: f64) -> Way {
        Way {
            fruit,
            places: [from, to],
            times: [at, at + 1.0],
            mass: 0.2,
        }
    }

    #[test]
    fn closed_form_residence_of_straight_ways() {
        let mut own = space();
        assert!(own.is_silent());
        // Through a corner between two looks: in from x = 0 (t = 0.4) to y = 2 (t = 0.5).
        own.follow(&way(0, [-0.4, 1.5, 0.1], [0.6, 2.5, 0.1], 0.0));
        // Past it.
        own.follow(&way(1, [-0.4, 2.5, 0.1], [0.6, 2.6, 0.1], 0.0));
        // In at 0.25, out at 2.5, in again, and gone through a sink at 4.
        own.follow(&way(2, [0.5, 1.0, 0.6], [0.5, 1.0, 0.2], 0.0));
        own.follow(&way(2, [0.5, 1.0, 0.2], [0.5, 1.0, 0.2], 1.0));
        own.follow(&way(2, [0.5, 1.0, 0.2], [1.5, 1.0, 0.2], 2.0));
        own.follow(&way(2, [1.5, 1.0, 0.2], [0.9, 1.0, 0.2], 3.0));
        own.leave(2, 4.0);
        let found = own.outcome();
        assert_eq!(found.entered, 2);
        let residence = found.residence.unwrap();
        assert_eq!(residence.fruit, 2);
        assert!((residence.largest - 3.75).abs() < 1e-12, "{residence:?}");
        assert!((residence.mean - 0.5 * (0.1 + 3.75)).abs() < 1e-12);
        assert!((residence.median - residence.mean).abs() < 1e-12);
    }

    #[test]
    fn closed_form_content_of_a_box() {
        let own = space();
        let radius = 0.1;
        let all = vec![Fruit::sphere(0, radius, 1000.0, [0.0; 3]); 2];
        let at = |fruit, place| FruitState {
            fruit,
            place,
            velocity: [0.0; 3],
            spin: [0.0; 3],
            turn: windfall_scene::vector::UNTURNED,
        };
        let states = [at(0, [0.5, 0.5, 0.3]), at(1, [0.5, 0.5, 0.6])];
        let found = own.content(&states, &all);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        assert_eq!(found.fruit, 1);
        assert!((found.mass - 1000.0 * volume).abs() < 1e-12);
        assert!((found.level.unwrap() - 0.4).abs() < 1e-12 && (found.share - volume).abs() < 1e-12);
    }
}
