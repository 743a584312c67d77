//! Fruit that feel their acceleration, as instrumented spheres do.

use crate::file::sensors::{SensorKind, SensorPlan};
use crate::run::levels::Levels;
use crate::run::sensors::outcome::{ProbeImpactOutcome, ProbeOutcome};
use crate::run::sensors::trace::Trace;
use windfall_scene::binary;
use windfall_scene::event::{Event, Partner};
use windfall_scene::motion::simulation::FruitState;
use windfall_scene::vector::{Vector, length, plus_scaled, scaled, subtract};

/// Mean acceleration of a probe over a sample, without gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Number of the fruit.
    pub fruit: u32,
    /// Middle of the sample; s.
    pub time: f64,
    /// m/s².
    pub acceleration: Vector,
}

/// An impact: samples above the threshold, one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Impact {
    /// Number of the fruit.
    pub fruit: u32,
    /// Beginning of its first sample; s.
    pub time: f64,
    /// Time of all samples; s.
    pub duration: f64,
    /// Of the largest sample; m/s².
    pub peak: f64,
    /// Integral of the magnitude; m/s.
    pub change: f64,
    /// What was struck, where a load tells.
    pub struck: Option<Partner>,
    /// Whether something ended it before it was over.
    pub lasting: bool,
}

binary!(Impact {
    fruit,
    time,
    duration,
    peak,
    change,
    struck,
    lasting
});

/// One fruit that is a probe.
#[derive(Clone, Debug, Default, PartialEq)]
struct Own {
    fruit: u32,
    /// Velocity at the sample before, half a step before its end; m/s.
    velocity: Option<Vector>,
    /// End of the last sample below the threshold; s.
    quiet: f64,
    open: Option<Impact>,
    /// Partner and peak force of the hardest load that ended since the last quiet sample.
    hardest: Option<(Partner, f64)>,
}

binary!(Own {
    fruit,
    velocity,
    quiet,
    open,
    hardest
});

/// A kind of fruit that are probes.
pub(super) struct Probe {
    /// The sensor.
    pub sensor: usize,
    /// Steps between samples.
    pub every: u64,
    /// Time between samples; s.
    pub interval: f64,
    /// Threshold of an impact; m/s².
    pub least: f64,
    gravity: Vector,
    /// What was seen.
    pub state: ProbeState,
}

/// What the probes of a kind felt.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ProbeState {
    /// Of each fruit, by number.
    own: Vec<Own>,
    /// Whether each has come.
    came: Vec<bool>,
    largest: Option<f64>,
    peaks: Levels,
    changes: Levels,
    impacts: u64,
    hardest: Option<Impact>,
    /// Largest magnitudes and impacts over time.
    pub magnitudes: Trace,
    pub marks: Trace,
}

binary!(ProbeState {
    own,
    came,
    largest,
    peaks,
    changes,
    impacts,
    hardest,
    magnitudes,
    marks
});

impl Probe {
    /// The probes of a sensor; `None` where it is something else.
    ///
    /// * `fruit`: their numbers, rising
    /// * `every`: steps between samples, whose time is `interval`; s
    /// * `end`: of the scene; s
    pub fn new(
        sensor: usize,
        plan: &SensorPlan,
        fruit: &[u32],
        gravity: Vector,
        (every, interval, end): (u64, f64, f64),
    ) -> Option<Self> {
        let SensorKind::Probe { least } = plan.kind else {
            return None;
        };
        let own = fruit.iter().map(|&fruit| Own {
            fruit,
            ..Own::default()
        });
        let trace = Trace::new(interval, end);
        Some(Self {
            sensor,
            every,
            interval,
            least,
            gravity,
            state: ProbeState {
                own: own.collect(),
                came: vec![false; fruit.len()],
                magnitudes: trace.clone(),
                marks: trace,
                ..ProbeState::default()
            },
        })
    }

    fn place_of(&self, fruit: u32) -> Option<usize> {
        let own = &self.state.own;
        own.binary_search_by_key(&fruit, |own| own.fruit).ok()
    }

    /// Whether a fruit is one of the probes.
    pub fn is_probe(&self, fruit: u32) -> bool {
        self.place_of(fruit).is_some()
    }

    /// Takes in a load that ended.
    pub fn load(&mut self, event: &Event) {
        for (fruit, partner) in sides(event) {
            if let Some(place) = self.place_of(fruit) {
                self.state.own[place].struck_by(partner, event);
            }
        }
    }

    /// The sample up to now of a probe, where it was there at its beginning.
    ///
    /// * `half_step`: half a time step; s
    pub fn sample(&mut self, state: &FruitState, now: f64, half_step: f64) -> Option<Sample> {
        let place = self.place_of(state.fruit)?;
        self.state.came[place] = true;
        let before = self.state.own[place].velocity.replace(state.velocity)?;
        let mean = scaled(subtract(state.velocity, before), 1.0 / self.interval);
        let acceleration = plus_scaled(mean, self.gravity, -1.0);
        let time = now - half_step - 0.5 * self.interval;
        let size = length(acceleration);
        let own = &mut self.state;
        own.magnitudes.reach(time, size);
        own.largest = Some(own.largest.map_or(size, |largest| largest.max(size)));
        Some(Sample {
            fruit: state.fruit,
            time,
            acceleration,
        })
    }

    /// Whether a sample ends the impact of its fruit.
    pub fn ends(&self, sample: &Sample) -> bool {
        let own = self.place_of(sample.fruit).map(|own| &self.state.own[own]);
        own.is_some_and(|own| own.open.is_some()) && length(sample.acceleration) < self.least
    }

    /// Takes a sample into the impact of its fruit; the impact that it ended.
    ///
    /// * `lasting`: loads that last now, where it ends one
    pub fn feel(&mut self, sample: &Sample, lasting: &[Event]) -> Option<Impact> {
        let place = self.place_of(sample.fruit)?;
        let size = length(sample.acceleration);
        let (least, interval) = (self.least, self.interval);
        let own = &mut self.state.own[place];
        if size >= least {
            let impact = own.open.get_or_insert(Impact {
                fruit: sample.fruit,
                time: sample.time - 0.5 * interval,
                duration: 0.0,
                peak: 0.0,
                change: 0.0,
                struck: None,
                lasting: false,
            });
            impact.duration += interval;
            impact.change += size * interval;
            impact.peak = impact.peak.max(size);
            return None;
        }
        let ended = self.end_of(place, lasting);
        self.state.own[place].quiet = sample.time + 0.5 * interval;
        ended
    }

    /// Ends the impact of a probe, if it has one.
    fn end_of(&mut self, place: usize, lasting: &[Event]) -> Option<Impact> {
        let own = &mut self.state.own[place];
        let Some(mut impact) = own.open.take() else {
            own.hardest = None;
            return None;
        };
        for event in lasting {
            let mut sides = sides(event).filter(|(fruit, _)| *fruit == impact.fruit);
            if let Some((_, partner)) = sides.next() {
                own.struck_by(partner, event);
            }
        }
        impact.struck = own.hardest.take().map(|(partner, _)| partner);
        self.count(&impact);
        Some(impact)
    }

    fn count(&mut self, impact: &Impact) {
        let own = &mut self.state;
        own.impacts += 1;
        own.peaks.add(impact.peak);
        own.changes.add(impact.change);
        own.marks.reach(impact.time, impact.peak);
        if own.hardest.is_none_or(|before| before.peak < impact.peak) {
            own.hardest = Some(*impact);
        }
    }

    /// A probe leaves the scene: its impact ends.
    pub fn leave(&mut self, fruit: u32) -> Option<Impact> {
        let place = self.place_of(fruit)?;
        self.state.own[place].velocity = None;
        self.cut(place, &[])
    }

    fn cut(&mut self, place: usize, lasting: &[Event]) -> Option<Impact> {
        if let Some(open) = &mut self.state.own[place].open {
            open.lasting = true;
        }
        self.end_of(place, lasting)
    }

    /// The scene ends, and with it all impacts.
    pub fn end(&mut self, lasting: &[Event]) -> Vec<Impact> {
        let probes = 0..self.state.own.len();
        probes
            .filter_map(|place| self.cut(place, lasting))
            .collect()
    }

    /// Whether no probe was there for a sample.
    pub fn is_silent(&self) -> bool {
        self.state.largest.is_none()
    }

    /// What the probes felt.
    ///
    /// * `name`: of a partner
    pub fn outcome(
        &self,
        name: impl Fn(Option<Partner>) -> (Option<String>, Option<u32>),
    ) -> ProbeOutcome {
        let own = &self.state;
        let levels = |of: &Levels| {
            let levels = [0.5, 0.95, 1.0].map(|share| of.level(share));
            (own.impacts > 0).then_some(levels)
        };
        ProbeOutcome {
            fruit: own.came.iter().filter(|came| **came).count(),
            least_acceleration: self.least,
            largest_acceleration: own.largest,
            impacts: own.impacts,
            peak_acceleration: levels(&own.peaks),
            velocity_change: levels(&own.changes),
            hardest: own.hardest.map(|impact| {
                let (struck, struck_fruit) = name(impact.struck);
                ProbeImpactOutcome {
                    fruit: impact.fruit + 1,
                    time: impact.time,
                    duration: impact.duration,
                    peak_acceleration: impact.peak,
                    velocity_change: impact.change,
                    struck,
                    struck_fruit,
                    lasting: impact.lasting,
                }
            }),
        }
    }
}

impl Own {
    /// Takes in a load, unless it was over when the last quiet sample was: loads are told later
    /// than they end.
    fn struck_by(&mut self, partner: Partner, event: &Event) {
        let force = event.peak_force;
        let late = event.time + event.duration >= self.quiet;
        if late && self.hardest.is_none_or(|(_, before)| before < force) {
            self.hardest = Some((partner, force));
        }
    }
}

/// The fruit of a load, each with what it touched.
fn sides(event: &Event) -> impl Iterator<Item = (u32, Partner)> {
    let other = match event.partner {
        Partner::Fruit(other) => Some((other, Partner::Fruit(event.fruit))),
        Partner::Wall(_) => None,
    };
    [(event.fruit, event.partner)].into_iter().chain(other)
}
