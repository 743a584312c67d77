//! All sensors of a scene that runs.

use crate::file::key::{FRUIT, short};
use crate::file::read::ScenePlan;
use crate::file::sensors::{SensorKind, SensorPlan, SensorsPlan};
use crate::geometry::geometry_of;
use crate::run::growing::remove_earlier;
use crate::run::sensors::flow::{Flow, Pass, Way};
use crate::run::sensors::outcome::SensorOutcome;
use crate::run::sensors::probe::Probe;
use crate::run::sensors::space::Space;
use crate::run::sensors::tables::{FIGURE, Lengths, SensorTables, Table};
use std::io::{Read, Result as IoResult, Write};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::write_file::check_target;
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::event::{Event, Partner};
use windfall_scene::motion::simulation::{FruitState, Leaving, SINK_STEPS, Simulation};
use windfall_scene::vector::Vector;

/// Sensors of a run, with what they saw so far.
pub struct Sensors {
    plan: SensorsPlan,
    pub(super) flows: Vec<Flow>,
    pub(super) spaces: Vec<Space>,
    pub(super) probes: Vec<Probe>,
    /// Of each fruit the place at the last look, NaN where it was not there; m.
    places: Vec<Vector>,
    /// Time of the last look; s.
    looked: f64,
    /// Steps between looks at planes and boxes.
    every: u64,
    step: f64,
    /// When the scene begins and ends; s, and steps at its end.
    pub(super) span: [f64; 2],
    all: u64,
    tables: SensorTables,
}

/// Longest time between looks at planes and boxes, unless a time step is longer; s.
const LOOK: f64 = 1e-3;

/// Steps between looks. They divide those between looks at sinks: a fruit is seen in the step in
/// which it leaves.
fn look_steps(step: f64) -> u64 {
    let mut steps = SINK_STEPS;
    while steps > 1 && steps as f64 * step > LOOK {
        steps /= 2;
    }
    steps
}

impl Sensors {
    /// The sensors of a plan, whose time step is known.
    ///
    /// * `kept`: what [`Sensors::sync`] said where a run is resumed
    ///
    /// # Errors
    /// Samples are closer than time steps; a table cannot be written.
    pub fn open(plan: &ScenePlan, out: &Path, kept: Option<Lengths>) -> Result<Self, Error> {
        let (scene, sensors) = (&plan.scene, plan.sensors.clone());
        let step = scene.time_step;
        sensors.check_step(step)?;
        let all = (plan.end / step).ceil() as u64;
        let begun = plan.start.as_ref().map_or(0.0, |own| own.time);
        let numbered = || sensors.all.iter().enumerate();
        let timed = |own: &SensorPlan| {
            let every = (own.interval / step).round().max(1.0) as u64;
            (every, every as f64 * step, plan.end)
        };
        let periods = scene.periods();
        let flows = numbered().filter_map(|(place, own)| Flow::new(place, own, plan.end, periods));
        let fruit = scene.fruit.len();
        let spaces = numbered();
        let spaces =
            spaces.filter_map(|(place, own)| Space::new(place, own, fruit, timed(own), periods));
        let probes = numbered().filter_map(|(place, own)| {
            if !matches!(own.kind, SensorKind::Probe { .. }) {
                return None;
            }
            let fruit = (0..fruit as u32).filter(|fruit| sensors.counts(own, *fruit));
            let fruit: Vec<u32> = fruit.collect();
            Probe::new(place, own, &fruit, scene.gravity, timed(own))
        });
        let (flows, spaces): (Vec<Flow>, Vec<Space>) = (flows.collect(), spaces.collect());
        let probes: Vec<Probe> = probes.collect();
        let wanted = |table: Table| match table {
            Table::Passes => !flows.is_empty(),
            Table::Spaces => !spaces.is_empty(),
            Table::Samples | Table::Impacts => !probes.is_empty(),
        };
        let names: Vec<&str> = sensors.all.iter().map(|own| own.name.as_str()).collect();
        let walls: Vec<&str> = scene.walls.iter().map(|own| own.name.as_str()).collect();
        let tables = SensorTables::open(out, wanted, [&names, &walls], kept)?;
        let places = match flows.is_empty() && spaces.is_empty() {
            true => Vec::new(),
            false => vec![[f64::NAN; 3]; fruit],
        };
        Ok(Self {
            flows,
            spaces,
            probes,
            places,
            looked: begun,
            every: look_steps(step),
            step,
            span: [begun, plan.end],
            all,
            tables,
            plan: sensors,
        })
    }

    /// Refuses a run that could not write the figure in the end.
    ///
    /// # Errors
    /// Somebody else made a file of its name.
    pub fn check_figure(plan: &SensorsPlan, out: &Path) -> Result<(), Error> {
        match plan.all.is_empty() {
            true => Ok(()),
            false => FIGURE
                .iter()
                .try_for_each(|name| check_target(&out.join(name))),
        }
    }

    fn looks(&self) -> bool {
        !self.places.is_empty()
    }

    /// Steps until the next look, but no more than `most`, and one at least.
    pub fn steps(&self, simulation: &Simulation, most: u64) -> u64 {
        let now = simulation.steps();
        let looks = self.looks().then_some(self.every);
        let spaces = self.spaces.iter().map(|own| own.every);
        let all = spaces.chain(self.probes.iter().map(|own| own.every));
        let left = all.chain(looks).map(|every| every - now % every);
        left.fold(most, u64::min).max(1)
    }

    /// Takes in a load that ended.
    pub fn load(&mut self, event: &Event) {
        self.probes.iter_mut().for_each(|own| own.load(event));
    }

    /// Takes in a fruit that left.
    pub fn leave(&mut self, leaving: &Leaving) -> Result<(), Error> {
        let fruit = leaving.fruit;
        if let Some(place) = self.places.get_mut(fruit as usize) {
            *place = [f64::NAN; 3];
        }
        for own in &mut self.spaces {
            own.leave(fruit, leaving.time);
        }
        for own in &mut self.probes {
            if let Some(impact) = own.leave(fruit) {
                self.tables.impact(own.sensor, &impact)?;
            }
        }
        Ok(())
    }

    /// Looks at the scene as far as a look is due.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn take(&mut self, simulation: &Simulation) -> Result<(), Error> {
        let (now, time) = (simulation.steps(), simulation.time());
        let is_due = |every: u64| now.is_multiple_of(every);
        let ends = now >= self.all;
        let looks = self.looks() && (is_due(self.every) || ends);
        if looks || self.spaces.iter().any(|own| is_due(own.every)) {
            let fruit = simulation.fruit();
            if looks {
                self.look(simulation, &fruit)?;
            }
            let spaces = self.spaces.iter_mut();
            for own in spaces.filter(|own| is_due(own.every) || ends) {
                let sensor = &self.plan.all[own.sensor];
                let counts = |own: &&FruitState| self.plan.counts(sensor, own.fruit);
                let counted: Vec<FruitState> = fruit.iter().filter(counts).copied().collect();
                own.last = own.content(&counted, &simulation.scene.fruit);
                if is_due(own.every) {
                    let content = own.last;
                    own.sample(time, &content);
                    self.tables.content(own.sensor, time, &content)?;
                }
            }
        }
        // All contacts are gone through: once for all impacts that end now.
        let mut lasting: Option<Vec<Event>> = None;
        for own in self.probes.iter_mut().filter(|own| is_due(own.every)) {
            let mut states = Vec::new();
            simulation.visit_fruit(|fruit| own.is_probe(fruit), |state| states.push(state));
            states.sort_by_key(|state| state.fruit);
            for state in &states {
                let Some(sample) = own.sample(state, time, 0.5 * self.step) else {
                    continue;
                };
                self.tables.sample(own.sensor, &sample)?;
                let lasting = match own.ends(&sample) {
                    true => lasting
                        .get_or_insert_with(|| simulation.lasting())
                        .as_slice(),
                    false => &[],
                };
                if let Some(impact) = own.feel(&sample, lasting) {
                    self.tables.impact(own.sensor, &impact)?;
                }
            }
        }
        Ok(())
    }

    /// Looks at the ways of all fruit since the last look.
    fn look(&mut self, simulation: &Simulation, fruit: &[FruitState]) -> Result<(), Error> {
        let now = simulation.time();
        let periods = simulation.scene.periods();
        let mut passes: Vec<(usize, Pass)> = Vec::new();
        for state in fruit {
            let number = state.fruit as usize;
            let from = std::mem::replace(&mut self.places[number], state.place);
            if from[0].is_nan() {
                for own in &mut self.spaces {
                    if self.plan.counts(&self.plan.all[own.sensor], state.fruit) {
                        own.come(state.fruit, state.place, now);
                    }
                }
                continue;
            }
            let way = Way {
                fruit: state.fruit,
                places: [from, periods.image(state.place, from)],
                times: [self.looked, now],
                mass: simulation.scene.fruit[number].mass,
            };
            for (place, own) in self.flows.iter().enumerate() {
                if self.plan.counts(&self.plan.all[own.sensor], state.fruit) {
                    passes.extend(own.pass(&way).map(|pass| (place, pass)));
                }
            }
            for own in &mut self.spaces {
                if self.plan.counts(&self.plan.all[own.sensor], state.fruit) {
                    own.follow(&way);
                }
            }
        }
        self.looked = now;
        passes.sort_by(|(_, a), (_, b)| a.time.total_cmp(&b.time));
        for (place, pass) in &passes {
            self.flows[*place].count(pass);
            self.tables.pass(self.flows[*place].sensor, pass)?;
        }
        Ok(())
    }

    /// How far the tables are, on the disk.
    pub fn sync(&mut self) -> Result<Lengths, Error> {
        self.tables.sync()
    }

    /// Whether what is not finished stays.
    pub fn keep(&mut self, keep: bool) {
        self.tables.keep(keep);
    }

    /// Writes what was seen.
    pub fn save(&self, to: &mut dyn Write) -> IoResult<()> {
        self.looked.write(to)?;
        self.places.write(to)?;
        self.flows.iter().try_for_each(|own| own.state.write(to))?;
        self.spaces.iter().try_for_each(|own| own.state.write(to))?;
        self.probes.iter().try_for_each(|own| own.state.write(to))
    }

    /// Takes up what [`Sensors::save`] wrote of the same scene.
    ///
    /// # Errors
    /// Those of the reader; it is of another scene.
    pub fn take_up(&mut self, from: &mut dyn Read) -> IoResult<()> {
        self.looked = Binary::read(from)?;
        let places: Vec<Vector> = Binary::read(from)?;
        if places.len() != self.places.len() {
            return Err(no_value("sensors of this scene"));
        }
        self.places = places;
        for own in &mut self.flows {
            own.state = Binary::read(from)?;
        }
        for own in &mut self.spaces {
            own.state = Binary::read(from)?;
        }
        for own in &mut self.probes {
            own.state = Binary::read(from)?;
        }
        Ok(())
    }

    /// Ends impacts that last, and gives the tables their names; which they are.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn finish(&mut self, simulation: &Simulation, out: &Path) -> Result<Vec<PathBuf>, Error> {
        if !self.probes.is_empty() {
            let lasting = simulation.lasting();
            for own in &mut self.probes {
                for impact in own.end(&lasting) {
                    self.tables.impact(own.sensor, &impact)?;
                }
            }
        }
        if self.plan.all.is_empty() {
            FIGURE
                .iter()
                .try_for_each(|name| remove_earlier(&out.join(name)))?;
        }
        self.tables.finish(out)
    }

    /// What each sensor saw.
    pub fn outcomes(&self, simulation: &Simulation) -> Vec<SensorOutcome> {
        let scene = &simulation.scene;
        let partner = |own: Option<Partner>| match own {
            Some(Partner::Fruit(other)) => (Some(FRUIT.to_owned()), Some(other + 1)),
            Some(Partner::Wall(wall)) => (Some(scene.walls[wall as usize].name.clone()), None),
            None => (None, None),
        };
        let outcome = |(place, plan): (usize, &SensorPlan)| {
            let flow = self.flows.iter().find(|own| own.sensor == place);
            let space = self.spaces.iter().find(|own| own.sensor == place);
            let probe = self.probes.iter().find(|own| own.sensor == place);
            let every = space.map(|own| own.every).or(probe.map(|own| own.every));
            let look = probe.map_or(self.every, |own| own.every);
            SensorOutcome {
                name: plan.name.clone(),
                look: look as f64 * self.step,
                interval: every.map_or(plan.interval, |every| every as f64 * self.step),
                flow: flow.map(Flow::outcome),
                space: space.map(Space::outcome),
                probe: probe.map(|own| own.outcome(partner)),
            }
        };
        self.plan.all.iter().enumerate().map(outcome).collect()
    }

    /// Names of the sensors.
    pub(super) fn name(&self, sensor: usize) -> &str {
        &self.plan.all[sensor].name
    }

    /// Sensors that saw nothing.
    pub fn findings(&self, plan: &ScenePlan) -> Vec<FindingOutcome> {
        let flows = self.flows.iter().map(|own| (own.sensor, own.is_silent()));
        let spaces = self.spaces.iter().map(|own| (own.sensor, own.is_silent()));
        let probes = self.probes.iter().map(|own| (own.sensor, own.is_silent()));
        let all = flows.chain(spaces).chain(probes);
        let silent = all.filter(|own| own.1);
        let silent = silent.map(|(sensor, _)| silent_finding(&plan.sensors.all[sensor], plan));
        silent.collect()
    }
}

/// What it means that a sensor saw nothing.
fn silent_finding(sensor: &SensorPlan, plan: &ScenePlan) -> FindingOutcome {
    let (_, room) = geometry_of(&plan.scene);
    let beyond = |low: Vector, high: Vector| {
        (0..3).any(|axis| low[axis] > room.high[axis] || high[axis] < room.low[axis])
    };
    let (saw, outside) = match &sensor.kind {
        SensorKind::Plane { point, normal } => {
            let corners = [room.low, room.high];
            let height = |own: usize| -> f64 {
                let pick = |axis: usize| corners[own >> axis & 1][axis] - point[axis];
                (0..3).map(|axis| normal[axis] * pick(axis)).sum()
            };
            let sides = (0..8).filter(|own| height(*own) >= 0.0).count();
            ("no fruit passed it", sides == 0 || sides == 8)
        }
        SensorKind::Plate(own) => {
            let [a, b] = own.edges;
            let corner = |k: usize, on: [f64; 2]| own.corner[k] + on[0] * a[k] + on[1] * b[k];
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
            let ends = |pick: fn(f64, f64) -> f64| {
                [0, 1, 2].map(|axis| {
                    let all = corners.map(|on| corner(axis, on));
                    all[1..].iter().fold(all[0], |found, own| pick(found, *own))
                })
            };
            ("no fruit passed it", beyond(ends(f64::min), ends(f64::max)))
        }
        SensorKind::Space { low, high } => ("no fruit was in it", beyond(*low, *high)),
        SensorKind::Probe { .. } => ("its fruit was never there for a sample", false),
    };
    let advice = match outside {
        true => format!(
            "it lies outside of the walls and of the places where fruit come in, which are between {} m and \
             {} m; look at where it is",
            place(room.low),
            place(room.high)
        ),
        false => match sensor.kind {
            SensorKind::Probe { .. } => "look at when and where it comes in".to_owned(),
            _ => "look at where it is, when the scene ends, and whether its `fruit` come there"
                .to_owned(),
        },
    };
    FindingOutcome::new(
        "sensor-silent",
        format!(
            "the sensor \"{}\" is no measured zero: {saw}; {advice}",
            sensor.name
        ),
    )
}

fn place(own: Vector) -> String {
    format!("[{}]", own.map(short).join(", "))
}
