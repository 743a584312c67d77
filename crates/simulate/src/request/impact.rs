//! Impacts of a free body, a carriage and a pendulum: options → events.

use crate::request::event::{Event, ends, event};
use crate::request::instrument::PendulumInstrument;
use crate::request::recordings::SpecimenRequest;
use clap::{Args, ValueHint};
use std::path::PathBuf;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_files::error::Error;
use windfall_files::option_value::{positive, quantity};
use windfall_identify::rig::kind::{Carriage, Pendulum, Rig};

/// A free body strikes once; texts with units.
#[derive(Clone, Debug, Args)]
pub struct ImpactRequest {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Effective mass, such as "0.2 kg"
    #[arg(long)]
    pub mass: String,
    /// Impact velocity, such as "0.5 m/s"
    #[arg(long, required_unless_present = "height")]
    pub velocity: Option<String>,
    /// Fall from this height in the place of an impact velocity, such as "0.5 m"
    #[arg(long, conflicts_with = "velocity")]
    pub height: Option<String>,
    /// Acceleration towards the fruit before and during contact, such as "9.81 m/s^2" [default: 0
    /// m/s^2, and 9.80665 m/s^2 with --height]
    #[arg(long, visible_alias = "gravity", allow_hyphen_values = true)]
    pub driving_acceleration: Option<String>,
    /// When the contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
}

/// A body on a line strikes, once or in a campaign of recordings; texts with units.
#[derive(Clone, Debug, Args)]
pub struct CarriageRequest {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long)]
    pub law: String,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Mass of the body
    #[arg(long)]
    pub mass: String,
    /// Impact velocity
    #[arg(long)]
    pub velocity: String,
    /// Acceleration towards the fruit
    #[arg(long, default_value = "0 m/s^2", allow_hyphen_values = true)]
    pub driving_acceleration: String,
    /// Sampling rate of the motion; recordings have the rates of their sensors
    #[arg(long, default_value = "200 kHz")]
    pub rate: String,
    /// Write a campaign of recordings into this directory
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub recordings: Option<PathBuf>,
    /// A sensor of the recordings: force, position, velocity or acceleration, then after a colon
    /// any of rate, noise, sensitivity, offset, bits, range; or an encoder, count or phases, with
    /// length and rate; repeated. Force and position at 10 kHz if left out
    #[arg(
        long = "sensor",
        value_name = "NAME[: KEY=VALUE, …]",
        requires = "recordings"
    )]
    pub sensors: Vec<String>,
    /// Leave the mass out of the campaign, so that fit finds it from impulse
    #[arg(long, requires = "recordings")]
    pub unweighed: bool,
    /// Its specimens
    #[command(flatten)]
    pub specimens: SpecimenRequest,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// When the contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
}

/// A pendulum strikes, once or in a campaign of recordings; texts with units.
#[derive(Clone, Debug, Args)]
pub struct PendulumRequest {
    /// Force law with its parameters, or a law card (FILE.toml)
    #[arg(long, required_unless_present = "example")]
    pub law: Option<String>,
    /// File of own laws ([laws.NAME] tables, as in campaign.toml) that --law can name
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub laws: Option<PathBuf>,
    /// Write the example campaign into this directory
    #[arg(long, value_name = "DIR", conflicts_with_all = ["law", "recordings"], value_hint = ValueHint::DirPath)]
    pub example: Option<PathBuf>,
    /// Write a campaign of recordings into this directory
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub recordings: Option<PathBuf>,
    /// Its specimens
    #[command(flatten)]
    pub specimens: SpecimenRequest,
    /// Moment of inertia about the pivot
    #[arg(long, default_value = "0.01435 kg m^2")]
    pub inertia: String,
    /// Pivot to point of contact
    #[arg(long, default_value = "0.505 m")]
    pub arm: String,
    /// Mass of arm and impactor
    #[arg(long, default_value = "0.11 kg")]
    pub mass: String,
    /// Pivot to centre of mass
    #[arg(long, default_value = "0.3 m")]
    pub centre_of_mass: String,
    /// Impact velocity
    #[arg(long, default_value = "0.388 m/s")]
    pub velocity: String,
    /// What records
    #[command(flatten)]
    pub instrument: PendulumInstrument,
    /// When the contact is over
    #[arg(long, default_value = "force-zero", value_parser = ends())]
    pub end: String,
    /// Seed of specimens and noise
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Reads the request for one impact of a free body.
pub fn impact_event(request: &ImpactRequest) -> Result<Event, Error> {
    let given = request.driving_acceleration.as_deref();
    let law = (request.law.as_str(), request.laws.as_deref());
    let (rig, velocity) = match (&request.height, &request.velocity) {
        (Some(height), _) => {
            let driving = match given {
                Some(text) => positive("--driving-acceleration", text, "m/s^2")?,
                None => STANDARD_GRAVITY,
            };
            let rig = Rig::Carriage(Carriage {
                mass: positive("--mass", &request.mass, "kg")?,
                driving_acceleration: driving,
            });
            let height = positive("--height", height, "m")?;
            (rig, (2.0 * driving * height).sqrt())
        }
        (None, velocity) => {
            let rig = carriage(&request.mass, given.unwrap_or("0 m/s^2"))?;
            (rig, speed(velocity.as_deref().unwrap_or_default())?)
        }
    };
    event(law, rig, velocity, &request.end)
}

fn speed(text: &str) -> Result<f64, Error> {
    positive("--velocity", text, "m/s")
}

/// Reads the request for an impact of a body on a line.
pub fn carriage_event(request: &CarriageRequest) -> Result<Event, Error> {
    let carriage = carriage(&request.mass, &request.driving_acceleration)?;
    let law = (request.law.as_str(), request.laws.as_deref());
    event(law, carriage, speed(&request.velocity)?, &request.end)
}

/// Reads the request for an impact of a pendulum.
pub fn pendulum_event(request: &PendulumRequest) -> Result<Event, Error> {
    let law = request.law.as_deref().unwrap_or_default();
    let rig = Rig::Pendulum(Pendulum {
        inertia: positive("--inertia", &request.inertia, "kg m^2")?,
        arm: positive("--arm", &request.arm, "m")?,
        mass: positive("--mass", &request.mass, "kg")?,
        centre_of_mass: quantity("--centre-of-mass", &request.centre_of_mass, "m")?,
        gravity: STANDARD_GRAVITY,
    });
    let law = (law, request.laws.as_deref());
    event(law, rig, speed(&request.velocity)?, &request.end)
}

fn carriage(mass: &str, driving: &str) -> Result<Rig, Error> {
    Ok(Rig::Carriage(Carriage {
        mass: positive("--mass", mass, "kg")?,
        driving_acceleration: quantity("--driving-acceleration", driving, "m/s^2")?,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::event::impact_of_event;

    fn dropped(law: &str, height: &str, driving: Option<&str>) -> Result<Event, Error> {
        impact_event(&ImpactRequest {
            law: law.to_owned(),
            laws: None,
            mass: "0.2 kg".to_owned(),
            velocity: None,
            height: Some(height.to_owned()),
            driving_acceleration: driving.map(str::to_owned),
            end: "force-zero".to_owned(),
        })
    }

    /// Falls of 100 and 5 mm onto a fruit under 9.80665 m/s², integrated by SciPy 1.17
    /// (`solve_ivp`, DOP853, relative tolerance 1e-12).
    #[test]
    fn reference_drops_with_the_weight_during_contact() {
        let falls = [
            // Peak force, largest displacement, duration, restitution, kinetic energy lost, m g d.
            (
                "0.1 m",
                [
                    114.325_988_70,
                    0.002_431_980_396,
                    0.006_200_726_225,
                    0.411_800_452_8,
                    0.162_872_841_8,
                    0.002_287_480_919,
                ],
            ),
            (
                "5 mm",
                [
                    20.779_797_23,
                    0.000_836_602_416_4,
                    0.009_303_698_345,
                    0.466_963_460_9,
                    0.007_668_262_171,
                    0.000_580_014_113_9,
                ],
            ),
        ];
        for (height, expected) in falls {
            let event = dropped("kuwabara-kono(k=753599, c=1524)", height, None).unwrap();
            let found = impact_of_event(&event).unwrap();
            let found = [
                found.peak_force,
                found.max_displacement,
                found.contact_duration,
                found.restitution,
                found.absorbed_energy,
                found.driving_work,
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
            }
        }
        // On the Moon, as the user says: v = √(2 · 1.62 · 0.1).
        let moon = dropped("hertz(k=20000)", "0.1 m", Some("1.62 m/s^2")).unwrap();
        assert!((moon.velocity - 0.324_f64.sqrt()).abs() < 1e-15);
        // An elastic contact gives all energy back, whatever the weight does.
        let found = impact_of_event(&moon).unwrap();
        let left = (found.absorbed_energy + found.driving_work).abs();
        assert!(left < 1e-10, "{left}");
    }

    #[test]
    fn rejects_falls_that_are_none() {
        let refused = |height: &str, driving| {
            let error = dropped("hertz(k=20000)", height, driving).unwrap_err();
            error.to_string()
        };
        assert!(refused("0 m", None).contains("--height"));
        assert!(refused("0.1 kg", None).contains("--height"));
        let upwards = refused("0.1 m", Some("-9.81 m/s^2"));
        assert!(upwards.contains("--driving-acceleration"), "{upwards}");
        // A heavy body on soft, damped ground comes to rest in contact.
        let stays = dropped("kelvin-voigt(k=500, c=60)", "1 mm", None).unwrap();
        let told = impact_of_event(&stays).unwrap_err().to_string();
        assert!(told.contains("still in contact"), "{told}");
    }
}
