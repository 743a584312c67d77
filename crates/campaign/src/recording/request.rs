//! One recording without a campaign: what campaign.toml would say, as options.

use crate::settings::channels::{KINDS, Kind, parse_scale};
use crate::settings::kind::CampaignKind;
use crate::settings::model::{
    BenchPlan, Campaign, ChannelPlan, FilePlan, FitPlan, ImpactCampaign, ImpactEntry, MassPlan,
    RigPlan, TimePlan,
};
use crate::settings::rig::{FROM_IMPULSE, STANDARD_GRAVITY};
use std::path::Path;
use std::sync::Arc;
use windfall_files::error::Error;
use windfall_files::inputs::check_piped;
use windfall_files::option_value::{at_least_zero, chosen, positive, quantity, unusable};
use windfall_files::text::toml_source::suggestion;
use windfall_formats::open::OpenOptions;
use windfall_identify::fit::problem::FitOptions;
use windfall_identify::rig::kind::Pendulum;
use windfall_signal::ExtractOptions;
use windfall_signal::kinematics::Encoder;
use windfall_signal::trigger::Threshold;
use windfall_source::stream::is_stream;

/// What campaign.toml would say of rig, channels and contact; texts with units.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(
    feature = "clap",
    command(next_help_heading = "One recording without a campaign")
)]
pub struct RecordingRequest {
    /// The rig that the recording comes from
    #[cfg_attr(feature = "clap", arg(long, value_parser = ["pendulum", "carriage"], value_name = "RIG", requires = "laws", required = false))]
    pub rig: String,
    /// Pendulum: moment of inertia about the pivot, such as "0.01435 kg m^2"
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub inertia: Option<String>,
    /// Pendulum: pivot to point of contact, such as "0.505 m"
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub arm: Option<String>,
    /// Mass of arm and impactor, or of the carriage: "0.11 kg", or "from impulse" for a carriage
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub mass: Option<String>,
    /// Pendulum: pivot to centre of mass, such as "0.3 m"
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub centre_of_mass: Option<String>,
    /// Pendulum: acceleration of gravity; 9.80665 m/s^2 if left out
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub gravity: Option<String>,
    /// Carriage: acceleration towards the fruit when nothing touches; 0 if left out
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            requires = "rig",
            value_name = "QUANTITY",
            allow_hyphen_values = true
        )
    )]
    pub driving_acceleration: Option<String>,
    /// A channel: force, position, velocity, acceleration, angle, count, phase_a or phase_b, its
    /// column, and after a colon the unit of the column (SI if left out), what one unit of it
    /// stands for ("-1 N"), or the sensitivity of a sensor ("11 mV/N"); repeated
    #[cfg_attr(
        feature = "clap",
        arg(
            long = "channel",
            requires = "rig",
            value_name = "CHANNEL=COLUMN[:UNIT]"
        )
    )]
    pub channels: Vec<String>,
    /// Column of times, in s unless a unit follows a colon
    #[cfg_attr(
        feature = "clap",
        arg(long, requires = "rig", value_name = "COLUMN[:UNIT]")
    )]
    pub time: Option<String>,
    /// Sampling rate, where there is no column of times
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            requires = "rig",
            value_name = "QUANTITY",
            conflicts_with = "time"
        )
    )]
    pub sampling_rate: Option<String>,
    /// Counts per revolution of a rotary encoder, after x4 decoding
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "NUMBER"))]
    pub counts_per_revolution: Option<f64>,
    /// Displacement per count of a linear encoder, such as "0.17 mm"
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub count_length: Option<String>,
    /// Force above which there is contact: "1 N", or "auto" (from the noise before contact)
    #[cfg_attr(feature = "clap", arg(long, requires = "rig", value_name = "QUANTITY"))]
    pub threshold: Option<String>,
}

/// A campaign of one recording with one impact, no laws yet.
///
/// # Errors
/// An option is missing or cannot be used.
pub fn campaign_of_file(file: &Path, request: &RecordingRequest) -> Result<ImpactCampaign, Error> {
    check_piped(file)?;
    if !file.is_file() && !is_stream(file) {
        let advice = "with --rig the argument is one recording; check its name";
        return Err(Error::FileAbsent {
            path: file.to_path_buf(),
            advice: advice.to_owned(),
        });
    }
    campaign_of(file, None, request)
}

/// [`campaign_of_file`] of a recording in memory.
///
/// * `name`: what it is called in messages and results
/// * `held`: the bytes that its file would have
///
/// # Errors
/// An option is missing or cannot be used.
pub fn campaign_of_bytes(
    name: &Path,
    held: Arc<[u8]>,
    request: &RecordingRequest,
) -> Result<ImpactCampaign, Error> {
    campaign_of(name, Some(held), request)
}

fn campaign_of(
    file: &Path,
    held: Option<Arc<[u8]>>,
    request: &RecordingRequest,
) -> Result<ImpactCampaign, Error> {
    let rig = rig_plan(request)?;
    let (time, time_scale) = time_plan(request)?;
    let channels = request.channels.iter().map(|text| channel_plan(text));
    let directory = file.parent().unwrap_or(Path::new("")).to_path_buf();
    let name = |part: Option<&std::ffi::OsStr>| {
        part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
    };
    let files = FilePlan {
        directory: directory.clone(),
        within: None,
        held,
        open: OpenOptions::default(),
        time,
        time_scale,
        channels: channels.collect::<Result<_, _>>()?,
    };
    if files.channels.is_empty() {
        let problem = "name at least one channel, such as --channel force=F:N";
        return Err(unusable("--channel", problem));
    }
    let shared = Campaign {
        directory,
        kind: CampaignKind::Impacts,
        title: file.display().to_string(),
        simulated: None,
        note: None,
        rig_asked: None,
        files,
        group: None,
        specimens: Vec::new(),
        entries: vec![ImpactEntry {
            id: name(file.file_stem()),
            specimen: name(file.file_stem()),
            file: name(file.file_name()),
            line: 0,
            from: None,
            to: None,
            cells: Vec::new(),
        }],
    };
    Ok(ImpactCampaign {
        bench: BenchPlan::default(),
        shared,
        contact: extract_options(request, &rig)?,
        rig,
        fit: FitPlan {
            laws: Vec::new(),
            known_texts: Vec::new(),
            known: Vec::new(),
            user: Vec::new(),
            free: Vec::new(),
            options: FitOptions::default(),
        },
        covariates: Vec::new(),
    })
}

#[derive(Clone, Copy)]
enum RigKind {
    Pendulum,
    Carriage,
}

fn rig_plan(request: &RecordingRequest) -> Result<RigPlan, Error> {
    let kinds = [
        ("pendulum", RigKind::Pendulum),
        ("carriage", RigKind::Carriage),
    ];
    match chosen("--rig", &request.rig, &kinds)? {
        RigKind::Pendulum => pendulum(request),
        RigKind::Carriage => carriage(request),
    }
}

fn pendulum(request: &RecordingRequest) -> Result<RigPlan, Error> {
    refuse(
        "a pendulum",
        "--driving-acceleration",
        &request.driving_acceleration,
    )?;
    let value = |option, text: &Option<String>, unit, example| {
        positive(option, needed("a pendulum", option, text, example)?, unit)
    };
    let centre = "--centre-of-mass";
    let centre_text = needed("a pendulum", centre, &request.centre_of_mass, "'0.3 m'")?;
    Ok(RigPlan::Pendulum(Pendulum {
        inertia: value("--inertia", &request.inertia, "kg m^2", "'0.01435 kg m^2'")?,
        arm: value("--arm", &request.arm, "m", "'0.505 m'")?,
        mass: value("--mass", &request.mass, "kg", "'0.11 kg'")?,
        centre_of_mass: quantity(centre, centre_text, "m")?,
        gravity: match &request.gravity {
            Some(text) => at_least_zero("--gravity", text, "m/s^2")?,
            None => STANDARD_GRAVITY,
        },
    }))
}

fn carriage(request: &RecordingRequest) -> Result<RigPlan, Error> {
    let strangers = [
        ("--inertia", &request.inertia),
        ("--arm", &request.arm),
        ("--centre-of-mass", &request.centre_of_mass),
        ("--gravity", &request.gravity),
    ];
    for (option, text) in strangers {
        refuse("a carriage", option, text)?;
    }
    let example = "'0.5 kg' or 'from impulse'";
    let mass = match needed("a carriage", "--mass", &request.mass, example)? {
        FROM_IMPULSE => MassPlan::FromImpulse,
        text => MassPlan::Given {
            value: positive("--mass", text, "kg")?,
            sd: 0.0,
        },
    };
    let driving = "--driving-acceleration";
    let driving_acceleration = match &request.driving_acceleration {
        Some(text) => quantity(driving, text, "m/s^2")?,
        None => 0.0,
    };
    Ok(RigPlan::Carriage {
        mass,
        driving_acceleration,
        driving_acceleration_sd: 0.0,
    })
}

fn needed<'a>(
    rig: &str,
    option: &str,
    text: &'a Option<String>,
    example: &str,
) -> Result<&'a str, Error> {
    text.as_deref().ok_or_else(|| {
        unusable(
            option,
            format!("{rig} needs it, for example: {option} {example}"),
        )
    })
}

fn refuse(rig: &str, option: &str, text: &Option<String>) -> Result<(), Error> {
    match text {
        None => Ok(()),
        Some(_) => Err(unusable(
            option,
            format!("{rig} has no such value; leave it out"),
        )),
    }
}

/// Column of times with seconds per unit, or a sampling rate.
fn time_plan(request: &RecordingRequest) -> Result<(TimePlan, f64), Error> {
    match (&request.time, &request.sampling_rate) {
        (Some(text), None) => {
            let Some((column, unit)) = text.rsplit_once(':') else {
                return Ok((TimePlan::Column(text.clone()), 1.0));
            };
            let scale = positive(&format!("--time {text}"), &format!("1 {unit}"), "s")?;
            Ok((TimePlan::Column(column.to_owned()), scale))
        }
        (None, Some(rate)) => {
            let rate = positive("--sampling-rate", rate, "Hz")?;
            Ok((TimePlan::Rate(rate), 1.0))
        }
        (None, None) => Ok((TimePlan::OfFile, 1.0)),
        (Some(_), Some(_)) => Err(unusable(
            "--time",
            "the sampling rate is given too; keep one of the two",
        )),
    }
}

/// "force=F", "force=F:N" or "force=force_V:11 mV/N".
fn channel_plan(text: &str) -> Result<ChannelPlan, Error> {
    let option = || format!("--channel {text}");
    let (name, rest) = text.split_once('=').unwrap_or((text, ""));
    let names = KINDS.iter().map(Kind::name);
    let Some(kind) = KINDS.iter().find(|kind| kind.name() == name) else {
        let known = names.clone().collect::<Vec<_>>().join(", ");
        let hint = suggestion(name, names);
        let problem = format!("expected CHANNEL=COLUMN[:UNIT] with one of {known}{hint}");
        return Err(unusable(option(), problem));
    };
    let (column, scale) = match rest.rsplit_once(':') {
        Some((column, unit)) if !kind.unit.is_empty() => (
            column,
            scale_of(kind, unit).map_err(|problem| unusable(option(), problem))?,
        ),
        _ => (rest, 1.0),
    };
    if column.is_empty() {
        let problem = format!("name the column of the recording: --channel {name}=COLUMN[:UNIT]");
        return Err(unusable(option(), problem));
    }
    Ok(ChannelPlan {
        scale_sd: 0.0,
        delay_sd: 0.0,
        noise_sd: None,
        table: kind.table,
        line: 0,
        quantity: kind.quantity,
        column: column.to_owned(),
        time: None,
        scale,
        offset: 0.0,
        delay: 0.0,
    })
}

/// SI units per unit of the column, from a unit ("mm"), what one unit of the
/// column stands for ("-1 N"), or a sensitivity ("11 mV/N").
fn scale_of(kind: &Kind, unit: &str) -> Result<f64, String> {
    let scale = match parse_scale(unit, kind.unit) {
        Ok(scale) => scale,
        Err(error) => match parse_scale(unit, &kind.sensitivity_unit()) {
            Ok(sensitivity) => 1.0 / sensitivity,
            Err(_) => {
                return Err(format!(
                    "{error}; or a sensitivity in {}",
                    kind.sensitivity_unit()
                ));
            }
        },
    };
    match scale.is_normal() {
        true => Ok(scale),
        false => Err(format!("\"{unit}\" scales the column to nothing")),
    }
}

fn extract_options(request: &RecordingRequest, rig: &RigPlan) -> Result<ExtractOptions, Error> {
    let mut options = ExtractOptions::default();
    if let Some(text) = request.threshold.as_deref().filter(|text| *text != "auto") {
        options.trigger.threshold = Threshold::Fixed(positive("--threshold", text, "N")?);
    }
    options.encoder = match (request.counts_per_revolution, &request.count_length) {
        (None, None) => None,
        (Some(counts_per_revolution), None) => Some(Encoder::Rotary {
            counts_per_revolution,
        }),
        (None, Some(text)) => Some(Encoder::Linear {
            count_length: positive("--count-length", text, "m")?,
        }),
        _ => {
            let problem = "give one of --counts-per-revolution and --count-length";
            return Err(unusable("--count-length", problem));
        }
    };
    match rig {
        RigPlan::Pendulum(pendulum) => options.arm = Some(pendulum.arm),
        RigPlan::Carriage {
            driving_acceleration,
            ..
        } => options.driving_acceleration = *driving_acceleration,
    }
    Ok(options)
}
