//! `windfall simulate repeats`: drops repeated on one spot of fruit with a known
//! critical energy, to try the program and to check it.

use crate::new_campaign::NewCampaign;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::f64::consts::PI;
use std::path::Path;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_campaign::settings::template::{TemplateKind, template};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::laws::thornton::Thornton;
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, positive, unusable};
use windfall_files::table::write::csv_text;
use windfall_files::text::quote::string_text;
use windfall_identify::rig::kind::{Carriage, Rig};
use windfall_identify::rig::simulate::{simulate_rig, trajectory};
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal, uniform};

/// Effective modulus of tissue and impactor; Pa.
const MODULUS: f64 = 4e6;

/// Effective radius of fruit and impactor; m.
const RADIUS: f64 = 0.03;

/// Spread of the modulus between fruit; 1.
const MODULUS_SPREAD: f64 = 0.15;

/// Energy of the yield of tissue that fails, as a part of the impact energy: it
/// collapses, which no elastic curve resembles; 1.
const COLLAPSE: f64 = 0.3;

/// Mark of the elastic ball.
const REFERENCE: &str = "reference";

/// Recorded before touch and after separation; s.
const LEAD: f64 = 2e-3;

/// Where the impacts of the next energy fall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spots {
    /// On the same spot, as in consecutive height multiple impact tests.
    #[default]
    Same,
    /// On a spot that has not been struck.
    Fresh,
}

/// What is simulated; texts with units.
#[derive(Clone, Debug, Args)]
pub struct SimulateRepeatsRequest {
    /// Number of fruit; an elastic ball is added as reference
    #[arg(long, default_value_t = 12)]
    pub fruit: usize,
    /// Impact energy; may be repeated
    #[arg(long = "energy", default_values = ["0.04 J", "0.056 J", "0.08 J", "0.11 J", "0.16 J", "0.22 J", "0.31 J"])]
    pub energies: Vec<String>,
    /// Impacts on the spot at each energy
    #[arg(long, default_value_t = 2)]
    pub repeats: usize,
    /// Where the impacts of the next energy fall: on the same spot, or on a fresh one
    #[arg(long, default_value = "same", value_parser = spots())]
    pub spots: Spots,
    /// Median critical energy of the fruit
    #[arg(long, default_value = "0.12 J")]
    pub critical_energy: String,
    /// Standard deviation of the logarithm of the critical energy between fruit
    #[arg(long, default_value_t = 0.3)]
    pub spread: f64,
    /// Mass that falls
    #[arg(long, default_value = "200 g")]
    pub mass: String,
    /// Standard deviation of the noise of force
    #[arg(long, default_value = "0.3 N")]
    pub force_noise: String,
    /// Relative standard deviation of the impact velocity from drop to drop
    #[arg(long, default_value_t = 0.003)]
    pub velocity_scatter: f64,
    /// Sampling rate
    #[arg(long, default_value = "50 kHz")]
    pub sampling_rate: String,
    /// Seed of fruit and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

fn spots() -> impl TypedValueParser<Value = Spots> {
    PossibleValuesParser::new(["same", "fresh"]).map(|word| match word.as_str() {
        "fresh" => Spots::Fresh,
        _ => Spots::Same,
    })
}

struct Plan {
    energies: Vec<f64>,
    repeats: usize,
    mass: f64,
    noise: f64,
    scatter: f64,
    rate: f64,
    seed: u64,
}

/// A body on which drops fall: its law now, and what damage does to it.
struct Body {
    id: String,
    role: &'static str,
    law: Law,
    /// Infinite for the reference; J.
    critical: f64,
    damaged: bool,
}

/// Writes a campaign directory with its recordings; the number of recordings.
///
/// Below its critical energy a fruit is elastic (Hertz). At the first impact
/// above it the tissue collapses: Thornton's law with a yield pressure that is
/// reached at a part of the impact energy; from then on the spot is flatter and
/// yields where it was last unloaded, so that it is stiffer in the next impact.
/// An elastic ball takes the same drops, as reference. Critical energies are in
/// truth.csv.
pub fn simulate_repeats(
    directory: &Path,
    request: &SimulateRepeatsRequest,
) -> Result<usize, Error> {
    let plan = plan(request)?;
    let critical = positive("--critical-energy", &request.critical_energy, "J")?;
    let mut new = NewCampaign::create(directory)?;
    let mut bodies = vec![Body {
        id: "ball".to_owned(),
        role: REFERENCE,
        law: hertz(MODULUS)?,
        critical: f64::INFINITY,
        damaged: false,
    }];
    for number in 1..=request.fruit {
        let mut source = noise_source(request.seed, number as u64);
        bodies.push(Body {
            id: format!("fruit-{number:02}"),
            role: "fruit",
            critical: critical * (request.spread * normal(&mut source)).exp(),
            law: hertz(MODULUS * (MODULUS_SPREAD * normal(&mut source)).exp())?,
            damaged: false,
        });
    }
    let mut rows = Vec::new();
    for (number, body) in bodies.iter_mut().enumerate() {
        let mut source = noise_source(request.seed, 1000 + number as u64);
        let untouched = body.law;
        for (level, energy) in plan.energies.iter().enumerate() {
            let spot = match request.spots {
                Spots::Same => 1,
                Spots::Fresh => {
                    (body.law, body.damaged) = (untouched, false);
                    level + 1
                }
            };
            // One more on the reference: its scatter is what all is held against.
            let extra = usize::from(body.role == REFERENCE);
            for repeat in 1..=plan.repeats + extra {
                let id = format!("{}-{}-{repeat}", body.id, level + 1);
                let text = drop_on(body, *energy, &plan, &mut source)?;
                new.file(&format!("raw/{id}.csv"), text)?;
                let height = energy / (plan.mass * STANDARD_GRAVITY);
                let cells = [
                    id.clone(),
                    body.id.clone(),
                    format!("{id}.csv"),
                    spot.to_string(),
                ];
                rows.push([&cells[..], &[height.to_string(), repeat.to_string()]].concat());
            }
        }
    }
    let recordings = rows.len();
    write_tables(&mut new, &bodies, rows, request, &plan)?;
    new.end()?;
    Ok(recordings)
}

fn plan(request: &SimulateRepeatsRequest) -> Result<Plan, Error> {
    let energies = request
        .energies
        .iter()
        .map(|e| positive("--energy", e, "J"));
    let mut energies = energies.collect::<Result<Vec<f64>, _>>()?;
    energies.sort_by(f64::total_cmp);
    if request.repeats < 2 {
        return Err(unusable("--repeats", "expected 2 or more"));
    }
    for (option, value) in [
        ("--spread", request.spread),
        ("--velocity-scatter", request.velocity_scatter),
    ] {
        if !(0.0..1.0).contains(&value) {
            return Err(unusable(option, "expected a part from 0 to below 1"));
        }
    }
    Ok(Plan {
        energies,
        repeats: request.repeats,
        mass: positive("--mass", &request.mass, "kg")?,
        noise: at_least_zero("--force-noise", &request.force_noise, "N")?,
        scatter: request.velocity_scatter,
        rate: positive("--sampling-rate", &request.sampling_rate, "Hz")?,
        seed: request.seed,
    })
}

fn law_of(kind: LawKind, values: &[f64]) -> Result<Law, Error> {
    kind.with_parameters(values)
        .map_err(|error| unusable("the simulated fruit", error.to_string()))
}

/// A sphere that never yields: Thornton's law far below its yield pressure.
fn hertz(modulus: f64) -> Result<Law, Error> {
    law_of(LawKind::Thornton, &[modulus, RADIUS, 1e3 * modulus])
}

fn thornton_of(law: &Law) -> Thornton {
    let values = law.parameters();
    Thornton {
        modulus: values[0],
        radius: values[1],
        yield_pressure: values[2],
    }
}

/// Thornton's law that yields at an elastic energy: that energy is
/// (2/5) F_y d_y = π⁵ R³ p⁵/(60 E⁴).
fn yielding_at(law: Thornton, energy: f64) -> Result<Law, Error> {
    let pressure = 60.0 * law.modulus.powi(4) * energy / (PI.powi(5) * law.radius.powi(3));
    law_of(
        LawKind::Thornton,
        &[law.modulus, law.radius, pressure.powf(0.2)],
    )
}

/// The law of the next impact after a largest force: the radius that Thornton's
/// law unloads with, and a yield where the force was largest,
/// F = π³ R² p³/(6 E²).
fn after(law: Thornton, largest: f64) -> Result<Law, Error> {
    let pressure = PI * law.yield_pressure;
    let flat = (2.0 * largest + law.yield_force()) / (2.0 * pressure);
    let radius = 4.0 * law.modulus / (3.0 * largest) * flat.powf(1.5);
    let pressure = 6.0 * law.modulus.powi(2) * largest / (PI.powi(3) * radius.powi(2));
    law_of(LawKind::Thornton, &[law.modulus, radius, pressure.cbrt()])
}

/// One drop: what the force sensor records, and what it does to the body.
fn drop_on(
    body: &mut Body,
    energy: f64,
    plan: &Plan,
    source: &mut NoiseSource,
) -> Result<String, Error> {
    if energy >= body.critical && !body.damaged {
        body.law = yielding_at(thornton_of(&body.law), COLLAPSE * energy)?;
        body.damaged = true;
    }
    let rig = Rig::Carriage(Carriage {
        mass: plan.mass,
        driving_acceleration: STANDARD_GRAVITY,
    });
    let velocity = (2.0 * energy / plan.mass).sqrt() * (1.0 + plan.scatter * normal(source));
    let failed = |source| Error::identify("a simulated drop", source);
    let summary = simulate_rig(&body.law, &rig, velocity, EndRule::ForceZero).map_err(failed)?;
    let start = -LEAD - uniform(source) / plan.rate;
    let count = ((summary.contact_duration + 2.0 * LEAD) * plan.rate).ceil() as usize;
    let times: Vec<f64> = (0..count).map(|i| start + i as f64 / plan.rate).collect();
    let motion =
        trajectory(&body.law, &rig, velocity, &times, EndRule::ForceZero).map_err(failed)?;
    let law = thornton_of(&body.law);
    if body.damaged && summary.peak_force > law.yield_force() {
        body.law = after(law, summary.peak_force)?;
    }
    let rows = motion.force.iter().enumerate().map(|(i, force)| {
        let shown = force + plan.noise * normal(source);
        vec![
            format!("{:.7}", i as f64 / plan.rate),
            format!("{shown:.4}"),
        ]
    });
    csv_text(
        &["time_s", "force_N"].map(str::to_owned),
        rows.collect::<Vec<_>>(),
    )
}

fn write_tables(
    new: &mut NewCampaign,
    bodies: &[Body],
    rows: Vec<Vec<String>>,
    request: &SimulateRepeatsRequest,
    plan: &Plan,
) -> Result<(), Error> {
    let roles = bodies.iter().map(|b| vec![b.id.clone(), b.role.to_owned()]);
    new.table("specimens.csv", &["id", "role"], roles.collect())?;
    let header = ["id", "specimen", "file", "spot", "drop_height_m", "repeat"];
    new.table("impacts.csv", &header, rows)?;
    let fruit = bodies.iter().filter(|body| body.critical.is_finite());
    let truth = fruit.map(|body| vec![body.id.clone(), body.critical.to_string()]);
    let header = ["specimen", "critical_energy_J"];
    new.table("truth.csv", &header, truth.collect())?;
    let label = format!(
        "median critical energy {} (spread of its logarithm {}), seed {}",
        request.critical_energy, request.spread, plan.seed
    );
    let text = template(TemplateKind::Repeats)
        .replace(
            "title = \"My repeated impacts\"",
            "title = \"Simulated repeated impacts\"",
        )
        .replace(
            "# simulated = \"made by a program\"",
            &format!("simulated = {} #", string_text(&label)),
        )
        .replace("mass = \"200 g\"", &format!("mass = \"{} kg\"", plan.mass));
    new.file("campaign.toml", text)
}
