//! Instruments of simulated rigs: options with units → SI.

use crate::request::event::Event;
use clap::Args;
use windfall_campaign::settings::channels::{KINDS, Kind};
use windfall_files::error::Error;
use windfall_files::option_value::{at_least_zero, chosen, positive, quantity, unusable};
use windfall_files::text::toml_source::suggestion;
use windfall_identify::rig::kind::Rig;
use windfall_signal::instrument::{
    Converter, EncoderOutput, EncoderSensor, InitialPhase, Instrument, Sensor, pendulum_instrument,
};
use windfall_signal::kinematics::Encoder;
use windfall_signal::recording::Quantity;

/// Encoder and force sensor of a pendulum; texts with units.
#[derive(Clone, Debug, Args)]
pub struct PendulumInstrument {
    /// Sampling rate
    #[arg(long, default_value = "200 kHz")]
    pub rate: String,
    /// What the encoder writes into the recordings: phases A and B, or decoded counts
    #[arg(long, default_value = "phases", value_parser = ["phases", "counts"])]
    pub encoder: String,
    /// Resolution of the encoder after x4 decoding
    #[arg(long, default_value_t = 360_000.0, value_name = "NUMBER")]
    pub counts_per_revolution: f64,
    /// Sensitivity of the force sensor
    #[arg(long, default_value = "11 mV/N")]
    pub sensitivity: String,
    /// Standard deviation of the force noise of the recordings
    #[arg(long, default_value = "1 N")]
    pub noise: String,
    /// Resolution of the analogue-to-digital converter; no rounding if left out
    #[arg(long, value_name = "NUMBER")]
    pub bits: Option<u32>,
    /// Largest voltage of the converter, of either sign; beyond it the force is clipped
    #[arg(long, default_value = "10 V")]
    pub range: String,
}

/// Largest resolution of a converter; bits.
const MOST_BITS: u32 = 32;

/// Rate of a sensor of a carriage that gives none; Hz.
const SENSOR_RATE: f64 = 10e3;

/// Largest voltage of a converter whose range is not given; V.
const SENSOR_RANGE: f64 = 10.0;

/// Sensors of a carriage: quantity, sensitivity (V per SI unit), noise (SI).
const SENSORS: [(Quantity, f64, f64); 4] = [
    (Quantity::Force, 11e-3, 1.0),
    (Quantity::Displacement, 100.0, 10e-6),
    (Quantity::Rate, 1.0, 5e-3),
    (Quantity::Acceleration, 10e-3, 1.0),
];

/// Logic levels of an encoder; V.
const LEVELS: (f64, f64) = (0.0, 5.0);

/// The instrument of a simulated pendulum on the rig of that event.
pub fn instrument_of_pendulum(
    request: &PendulumInstrument,
    event: &Event,
) -> Result<Instrument, Error> {
    let outputs = [
        ("phases", EncoderOutput::Phases),
        ("counts", EncoderOutput::Counts),
    ];
    let counts_per_revolution = request.counts_per_revolution;
    if !(counts_per_revolution > 0.0 && counts_per_revolution.is_finite()) {
        let problem = format!("{counts_per_revolution} must be above zero, such as 360000");
        return Err(unusable("--counts-per-revolution", problem));
    }
    let sampling_rate = positive("--rate", &request.rate, "Hz")?;
    let mut instrument = pendulum_instrument();
    if let Some(encoder) = &mut instrument.encoder {
        encoder.sampling_rate = sampling_rate;
        encoder.output = chosen("--encoder", &request.encoder, &outputs)?;
        encoder.encoder = Encoder::Rotary {
            counts_per_revolution,
        };
        if let Rig::Pendulum(pendulum) = event.rig {
            encoder.arm = pendulum.arm;
        }
    }
    if let Some(force) = &mut instrument.force {
        force.sampling_rate = sampling_rate;
        force.noise = at_least_zero("--noise", &request.noise, "N")?;
        force.sensitivity = positive("--sensitivity", &request.sensitivity, "V/N")?;
        let range = positive("--range", &request.range, "V")?;
        let bits = request.bits.map(|bits| converter("--bits", bits, range));
        force.converter = bits.transpose()?;
    }
    Ok(instrument)
}

fn converter(option: &str, bits: u32, range: f64) -> Result<Converter, Error> {
    match bits {
        1..=MOST_BITS => Ok(Converter {
            bits,
            low: -range,
            high: range,
        }),
        _ => {
            let problem = format!("{bits} bits: expected 1 to {MOST_BITS}");
            Err(unusable(option, problem))
        }
    }
}

/// Values of one sensor that have not been used yet.
struct Settings<'a> {
    option: String,
    values: Vec<(&'a str, &'a str)>,
}

/// The instrument of a simulated carriage.
///
/// * `texts`: "force", "position: rate=25 Hz, noise=0.1 mm",
///   "velocity: sensitivity=1 V s/m, bits=12, range=5 V",
///   "count: length=0.17 mm, rate=1 kHz", "phases: length=10 um"
///
/// # Errors
/// A sensor or one of its values cannot be read.
pub fn instrument_of_carriage(texts: &[String]) -> Result<Instrument, Error> {
    let mut instrument = Instrument::default();
    for text in texts {
        let (name, values) = text.split_once(':').unwrap_or((text, ""));
        let mut settings = settings(format!("--sensor '{text}'"), values)?;
        match name.trim() {
            "count" => {
                let encoder = linear_encoder(&mut settings, EncoderOutput::Counts)?;
                instrument.encoder = Some(encoder);
            }
            "phases" => {
                let encoder = linear_encoder(&mut settings, EncoderOutput::Phases)?;
                instrument.encoder = Some(encoder);
            }
            name => add_sensor(&mut instrument, name, &mut settings)?,
        }
        if let Some((name, _)) = settings.values.first() {
            let problem = format!("this sensor has no \"{name}\"");
            return Err(unusable(settings.option, problem));
        }
    }
    Ok(instrument)
}

/// "rate=25 Hz, noise=0.1 mm" → names and values.
fn settings(option: String, text: &str) -> Result<Settings<'_>, Error> {
    let mut values = Vec::new();
    let parts = text.split(',').map(str::trim);
    for part in parts.filter(|part| !part.is_empty()) {
        let Some((name, value)) = part.split_once('=') else {
            let problem = format!("\"{part}\": expected NAME=VALUE, such as rate=25 Hz");
            return Err(unusable(option, problem));
        };
        values.push((name.trim(), value.trim()));
    }
    Ok(Settings { option, values })
}

/// Takes a value out of those that are left.
fn take<'a>(settings: &mut Settings<'a>, name: &str) -> Option<&'a str> {
    let values = &mut settings.values;
    let index = values.iter().position(|(known, _)| *known == name)?;
    Some(values.remove(index).1)
}

/// Takes a quantity above zero, or the usual one.
fn take_positive(
    settings: &mut Settings,
    name: &str,
    unit: &str,
    usual: f64,
) -> Result<f64, Error> {
    match take(settings, name) {
        Some(text) => positive(&settings.option, text, unit),
        None => Ok(usual),
    }
}

fn linear_encoder(settings: &mut Settings, output: EncoderOutput) -> Result<EncoderSensor, Error> {
    let Some(length) = take(settings, "length") else {
        let problem = "an encoder needs the length of one count, such as length=0.17 mm";
        return Err(unusable(settings.option.clone(), problem));
    };
    Ok(EncoderSensor {
        line_error: 0.0,
        encoder: Encoder::Linear {
            count_length: positive(&settings.option, length, "m")?,
        },
        arm: 1.0,
        output,
        phase: InitialPhase::Random,
        levels: LEVELS,
        noise: 0.0,
        sampling_rate: take_positive(settings, "rate", "Hz", SENSOR_RATE)?,
    })
}

fn add_sensor(
    instrument: &mut Instrument,
    name: &str,
    settings: &mut Settings,
) -> Result<(), Error> {
    let kind_of = |measured| KINDS.iter().find(move |kind| kind.quantity == measured);
    let found = SENSORS.iter().find_map(|sensor| {
        let kind = kind_of(sensor.0)?;
        (kind.name() == name).then_some((kind, sensor))
    });
    let Some((kind, &(measured, sensitivity, noise))) = found else {
        let known = SENSORS.iter().filter_map(|sensor| kind_of(sensor.0));
        let names: Vec<&str> = known.map(Kind::name).chain(["count", "phases"]).collect();
        let hint = suggestion(name, names.iter().copied());
        let problem = format!("expected one of {}{hint}", names.join(", "));
        return Err(unusable(settings.option.clone(), problem));
    };
    let place = match measured {
        Quantity::Force => &mut instrument.force,
        Quantity::Displacement => &mut instrument.displacement,
        Quantity::Rate => &mut instrument.rate,
        _ => &mut instrument.acceleration,
    };
    *place = Some(Sensor {
        persistence: 0.0,
        sensitivity: take_positive(
            settings,
            "sensitivity",
            &kind.sensitivity_unit(),
            sensitivity,
        )?,
        offset: match take(settings, "offset") {
            Some(text) => quantity(&settings.option, text, "V")?,
            None => 0.0,
        },
        noise: match take(settings, "noise") {
            Some(text) => at_least_zero(&settings.option, text, kind.unit)?,
            None => noise,
        },
        sampling_rate: take_positive(settings, "rate", "Hz", SENSOR_RATE)?,
        converter: sensor_converter(settings)?,
    });
    Ok(())
}

fn sensor_converter(settings: &mut Settings) -> Result<Option<Converter>, Error> {
    let range = take_positive(settings, "range", "V", SENSOR_RANGE)?;
    let Some(text) = take(settings, "bits") else {
        return Ok(None);
    };
    let bits = text.parse().map_err(|_| {
        let problem = format!("bits=\"{text}\": expected a whole number, such as 12");
        unusable(settings.option.clone(), problem)
    })?;
    converter(&settings.option, bits, range).map(Some)
}
