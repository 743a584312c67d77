//! What campaign.toml says of the bench: uncertainties, and what is estimated.

use crate::settings::file::CampaignFile;
use crate::settings::model::{BenchPlan, ChannelPlan, MassPlan, RigPlan};
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{Needed, TomlSource, positive_quantity, refused};
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_signal::recording::Quantity;

const KEY: (&str, &str) = ("[fit]", "estimate");

/// Largest eccentricity of an encoder; 1.
const LARGEST_ECCENTRICITY: f64 = 0.1;

/// Quantities that recordings determine: one of the first three, the delay, and one of the
/// last three, with what belongs to it.
pub const ESTIMABLE: [BenchQuantity; 7] = [
    BenchQuantity::Inertia,
    BenchQuantity::Mass,
    BenchQuantity::ForceGain,
    BenchQuantity::ForceDelay,
    BenchQuantity::ForceFilter,
    BenchQuantity::SensorFrequency,
    BenchQuantity::ArmFrequency,
];

/// Those that the residuals of the fits determine.
const OF_RESPONSE: [BenchQuantity; 3] = [
    BenchQuantity::ForceFilter,
    BenchQuantity::SensorFrequency,
    BenchQuantity::ArmFrequency,
];

/// Whether the residuals of the fits determine it, and not force and displacement alone.
pub fn is_of_response(quantity: BenchQuantity) -> bool {
    OF_RESPONSE.contains(&quantity)
}

/// Uncertainties of rig and force, and `[fit] estimate`.
///
/// # Errors
/// A quantity cannot be estimated on this rig, with these channels, or beside the others.
pub fn bench_plan(
    source: &TomlSource,
    file: &CampaignFile,
    (rig, sd): (&RigPlan, BenchSd),
    channels: &[ChannelPlan],
) -> Result<BenchPlan, Error> {
    let has = |quantity| channels.iter().any(|plan| plan.quantity == quantity);
    let force = channels
        .iter()
        .find(|plan| plan.quantity == Quantity::Force);
    let displacement = channels
        .iter()
        .filter(|plan| matches!(plan.quantity, Quantity::Displacement | Quantity::Angle))
        .map(|plan| plan.scale_sd);
    let eccentric = eccentricity(source, file)? / std::f64::consts::SQRT_2;
    let mut sd = sd
        .with(
            BenchQuantity::DisplacementGain,
            displacement.fold(eccentric, f64::hypot),
        )
        .with(
            BenchQuantity::ForceGain,
            force.map_or(0.0, |plan| plan.scale_sd),
        )
        .with(
            BenchQuantity::ForceDelay,
            force.map_or(0.0, |plan| plan.delay_sd),
        );
    let turning = [Quantity::Angle, Quantity::EncoderCount, Quantity::PhaseA];
    sd.turns = matches!(rig, RigPlan::Pendulum(_)) && turning.into_iter().any(has);
    let mut estimate: Vec<BenchQuantity> = Vec::new();
    for word in file.fit.estimate.iter().flatten() {
        let wrong = |problem: String| refused(source, word, KEY, problem);
        let mut all = ESTIMABLE.into_iter();
        let Some(quantity) = all.find(|own| own.name() == word.get_ref()) else {
            let names = ESTIMABLE.map(BenchQuantity::name).join(", ");
            let why = why_untold(word.get_ref());
            return Err(wrong(format!("expected one of {names}{why}")));
        };
        if let Some(problem) = untold(quantity, rig, &estimate) {
            return Err(wrong(problem));
        }
        if force.is_none() || !(sd.turns || has(Quantity::Displacement)) {
            let problem =
                "force and displacement together tell it, and one of them is not recorded";
            return Err(wrong(problem.to_owned()));
        }
        if !estimate.contains(&quantity) {
            estimate.push(quantity);
        }
    }
    Ok(BenchPlan {
        sd,
        estimate,
        found: Vec::new(),
    })
}

/// How far an encoder's disc is off its axis, in radii of its lines: near one angle its counts are
/// longer or shorter by at most that part, and by this part over √2 at an angle that is not known.
fn eccentricity(source: &TomlSource, file: &CampaignFile) -> Result<f64, Error> {
    let encoder = file.encoder.as_ref().map(Spanned::get_ref);
    let given = encoder.and_then(|encoder| encoder.eccentricity.as_ref());
    let key = Needed {
        table: "[encoder]",
        key: "eccentricity",
        meaning: "distance of the disc's centre from the axis, over the radius of its lines",
        unit: "1",
        example: "eccentricity = \"0.1 %\"",
    };
    let value = positive_quantity(source, given, &key)?.unwrap_or(0.0);
    match given {
        Some(given) if value > LARGEST_ECCENTRICITY => {
            let problem = "counts that differ by more than a tenth are no scale";
            Err(refused(source, given, (key.table, key.key), problem))
        }
        _ => Ok(value),
    }
}

/// Why the impacts do not tell something else of the bench, and what does.
fn why_untold(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "arm" | "eccentricity" | "counts_per_revolution" | "gain" | "sensitivity" => {
            ". Force and displacement determine one number for the mass and the scales of both: \
             estimate inertia, mass or force.gain, and give the others with their ±. A ruler \
             tells the arm; two marks at a known angle, counted at the place of the impact, tell \
             the scale of an encoder and what its eccentricity does there"
        }
        "tilt" | "centre_of_mass" | "gravity" | "driving_acceleration" => {
            ". It acts by gravity, which is less than a thousandth of the force in contact: \
             measure it, and give it with its ±"
        }
        "sensor_damping" => ". It is estimated with sensor_frequency",
        "arm_damping" | "arm_compliance" => ". It is estimated with arm_frequency",
        _ => "",
    }
}

/// Why a quantity cannot be told on a rig, beside those that are estimated already.
fn untold(quantity: BenchQuantity, rig: &RigPlan, others: &[BenchQuantity]) -> Option<String> {
    let pendulum = matches!(rig, RigPlan::Pendulum(_));
    match quantity {
        BenchQuantity::Inertia if !pendulum => {
            return Some("a carriage has no inertia; its mass can be estimated".to_owned());
        }
        BenchQuantity::Mass if pendulum => {
            let told = "the mass of a pendulum acts by gravity alone, and a contact does not tell \
                        it; its inertia can be estimated";
            return Some(told.to_owned());
        }
        BenchQuantity::Mass | BenchQuantity::ForceGain
            if matches!(
                rig,
                RigPlan::Carriage {
                    mass: MassPlan::FromImpulse,
                    ..
                }
            ) =>
        {
            let told = "the mass is found from the impulse of this force already; weigh it, and \
                        give the mass";
            return Some(told.to_owned());
        }
        _ => (),
    }
    if is_of_response(quantity) {
        let mut others = others.iter();
        let other = others.find(|own| is_of_response(**own) && **own != quantity)?;
        return Some(format!(
            "it is estimated beside {} already: estimate one of them, and give the other in [response]",
            other.name()
        ));
    }
    let of_gain = |own: &BenchQuantity| *own != BenchQuantity::ForceDelay && !is_of_response(*own);
    let other = others.iter().find(|own| of_gain(own) && **own != quantity);
    let other = other.filter(|_| of_gain(&quantity))?;
    Some(format!(
        "force and displacement together determine one number for {} and {}: estimate one, and give the other \
         its uncertainty behind ±. A known weight on the force sensor tells the gain; a known \
         mass on the moving body tells the inertia",
        other.name(),
        quantity.name()
    ))
}
