//! The other way round: what an instrument writes of a known motion.

use crate::error::{Error, positive};
use crate::kinematics::Encoder;
use crate::noise::gaussian::{NoiseSource, noise_source, normal, uniform};
use crate::recording::{Channel, Quantity, Recording, Times};
use crate::trajectory::{check_trajectory, cubic, linear, sampling_times};

pub use crate::trajectory::Trajectory;

/// Analogue-to-digital converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    /// Resolution; bits.
    pub bits: u32,
    /// Lowest voltage; V.
    pub low: f64,
    /// Highest voltage; V.
    pub high: f64,
}

/// Sensor with a voltage proportional to a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Volts per SI unit of the quantity.
    pub sensitivity: f64,
    /// Voltage at zero; V.
    pub offset: f64,
    /// Standard deviation of Gaussian noise; SI unit of the quantity.
    pub noise: f64,
    /// Correlation φ of the noise of successive samples, a first-order
    /// autoregression: 0 for white noise; −1 < φ < 1.
    pub persistence: f64,
    /// Samples per second; Hz.
    pub sampling_rate: f64,
    /// Converter that rounds and clips the voltage, if any.
    pub converter: Option<Converter>,
}

/// What an encoder gives out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EncoderOutput {
    /// The two phases; V.
    #[default]
    Phases,
    /// The count after ×4 decoding; 1.
    Counts,
}

/// Position within a count at the time of first contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum InitialPhase {
    /// Drawn with the seed, uniform.
    #[default]
    Random,
    /// A part of a count, 0 to 4 for all states; 1.
    Given(f64),
}

/// Incremental encoder and its wiring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderSensor {
    /// Resolution.
    pub encoder: Encoder,
    /// Arm on whose axis a rotary encoder sits; m. Not used by a linear one.
    pub arm: f64,
    /// What is written.
    pub output: EncoderOutput,
    /// Position within a count at first contact.
    pub phase: InitialPhase,
    /// Voltages of logic low and high; V.
    pub levels: (f64, f64),
    /// Standard deviation of the positions of the lines, drawn with the seed; counts.
    pub line_error: f64,
    /// Standard deviation of white Gaussian noise on the phases; V.
    pub noise: f64,
    /// Samples per second; Hz.
    pub sampling_rate: f64,
}

/// Instrument: the sensors that it has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instrument {
    /// Encoder.
    pub encoder: Option<EncoderSensor>,
    /// Sensor of force.
    pub force: Option<Sensor>,
    /// Sensor of displacement.
    pub displacement: Option<Sensor>,
    /// Sensor of displacement rate.
    pub rate: Option<Sensor>,
    /// Sensor of acceleration.
    pub acceleration: Option<Sensor>,
}

/// The instrument of the 2003 pendulum study: encoder of 360,000 counts per
/// revolution on a 0.505 m arm, force sensor of 11 mV/N with 1 N of noise,
/// all at 200 kHz.
pub fn pendulum_instrument() -> Instrument {
    let sampling_rate = 200e3;
    Instrument {
        encoder: Some(EncoderSensor {
            encoder: Encoder::Rotary {
                counts_per_revolution: 360_000.0,
            },
            arm: 0.505,
            output: EncoderOutput::Phases,
            phase: InitialPhase::Random,
            levels: (0.0, 5.0),
            line_error: 0.0,
            noise: 0.0,
            sampling_rate,
        }),
        force: Some(Sensor {
            sensitivity: 11e-3,
            offset: 0.0,
            noise: 1.0,
            persistence: 0.0,
            sampling_rate,
            converter: None,
        }),
        ..Instrument::default()
    }
}

/// One channel as written: volts, logic levels or counts.
#[derive(Clone, Debug, PartialEq)]
pub struct RawChannel {
    /// What it holds once it is calibrated.
    pub quantity: Quantity,
    /// Unit of the samples: V or 1.
    pub unit: &'static str,
    /// Time of the first sample; s.
    pub start: f64,
    /// Time between samples; s.
    pub interval: f64,
    /// Samples; `unit`.
    pub samples: Vec<f64>,
}

/// What the instrument writes of a trajectory, channel by channel.
///
/// Sampling begins at the first time of the trajectory and ends at its last, so
/// what is recorded before and after the contact is up to the trajectory.
/// Between its times the motion is a cubic (Hermite) and the force a straight
/// line. Phases come from the exact angle asin(x/r).
///
/// # Errors
/// [`Error::BadOption`] for a rate, an arm, a resolution that is not positive
/// or a displacement beyond the arm; [`Error::UnequalLengths`],
/// [`Error::TimeNotIncreasing`], [`Error::TooFewSamples`] for a bad trajectory.
pub fn record(
    trajectory: &Trajectory,
    instrument: &Instrument,
    seed: u64,
) -> Result<Vec<RawChannel>, Error> {
    check_trajectory(trajectory)?;
    let mut channels = Vec::new();
    if let Some(sensor) = &instrument.encoder {
        channels.extend(encoder_channels(trajectory, sensor, seed)?);
    }
    // The number of the stream belongs to the quantity, not to the order.
    let sensors = [
        (Quantity::Force, instrument.force, 10),
        (Quantity::Displacement, instrument.displacement, 11),
        (Quantity::Rate, instrument.rate, 12),
        (Quantity::Acceleration, instrument.acceleration, 13),
    ];
    for (quantity, sensor, stream) in sensors {
        if let Some(sensor) = sensor {
            let mut source = noise_source(seed, stream);
            channels.push(sensor_channel(trajectory, quantity, &sensor, &mut source)?);
        }
    }
    Ok(channels)
}

/// Raw channels with the instrument's own calibration: (volts − offset)/sensitivity.
pub fn calibrated(name: &str, channels: &[RawChannel], instrument: &Instrument) -> Recording {
    let sensor = |quantity| match quantity {
        Quantity::Force => instrument.force,
        Quantity::Displacement => instrument.displacement,
        Quantity::Rate => instrument.rate,
        Quantity::Acceleration => instrument.acceleration,
        _ => None,
    };
    let channels = channels
        .iter()
        .map(|raw| Channel {
            name: raw.quantity.to_string(),
            quantity: raw.quantity,
            times: Times::Uniform {
                start: raw.start,
                interval: raw.interval,
            },
            samples: match sensor(raw.quantity) {
                Some(sensor) => raw
                    .samples
                    .iter()
                    .map(|volts| (volts - sensor.offset) / sensor.sensitivity)
                    .collect(),
                None => raw.samples.clone(),
            },
        })
        .collect();
    Recording {
        name: name.to_owned(),
        channels,
        missing: Vec::new(),
        doubts: Vec::new(),
    }
}

fn encoder_channels(
    trajectory: &Trajectory,
    sensor: &EncoderSensor,
    seed: u64,
) -> Result<Vec<RawChannel>, Error> {
    let at = sampling_times(trajectory, sensor.sampling_rate)?;
    let x = cubic(trajectory, &trajectory.displacement, &trajectory.rate, &at);
    let phase = match sensor.phase {
        InitialPhase::Given(phase) => phase,
        InitialPhase::Random => 4.0 * uniform(&mut noise_source(seed, 0)),
    };
    let counts = exact_counts(&x, sensor)?;
    let counts: Vec<f64> = counts
        .iter()
        .map(|count| counted(count + phase, sensor.line_error, seed))
        .collect();

    let channel = |quantity, unit, samples| RawChannel {
        quantity,
        unit,
        start: at[0],
        interval: 1.0 / sensor.sampling_rate,
        samples,
    };
    if sensor.output == EncoderOutput::Counts {
        return Ok(vec![channel(Quantity::EncoderCount, "1", counts)]);
    }
    // A is high in the states 01 and 11, B in 11 and 10 (written BA).
    let phase_volts = |high: [bool; 4], stream| {
        let mut source = noise_source(seed, stream);
        counts
            .iter()
            .map(|count| {
                let state = count.rem_euclid(4.0) as usize;
                let level = if high[state] {
                    sensor.levels.1
                } else {
                    sensor.levels.0
                };
                noisy(level, sensor.noise, &mut source)
            })
            .collect()
    };
    Ok(vec![
        channel(
            Quantity::PhaseA,
            "V",
            phase_volts([false, true, true, false], 1),
        ),
        channel(
            Quantity::PhaseB,
            "V",
            phase_volts([false, false, true, true], 2),
        ),
    ])
}

/// The count at a position in counts, with each line where its error puts it.
fn counted(position: f64, line_error: f64, seed: u64) -> f64 {
    let count = position.floor();
    if line_error <= 0.0 {
        return count;
    }
    let error = |line: f64| {
        let stream = LINE_STREAM.wrapping_add(line as i64 as u64);
        line_error * normal(&mut noise_source(seed, stream))
    };
    if position < count + error(count) {
        count - 1.0
    } else if position >= count + 1.0 + error(count + 1.0) {
        count + 1.0
    } else {
        count
    }
}

/// Streams of the seed for the errors of the lines, apart from those of noise.
const LINE_STREAM: u64 = 1 << 40;

/// Counts without rounding, zero at zero displacement.
fn exact_counts(x: &[f64], sensor: &EncoderSensor) -> Result<Vec<f64>, Error> {
    match sensor.encoder {
        Encoder::Linear { count_length } => {
            let length = positive("count length", count_length)?;
            Ok(x.iter().map(|x| x / length).collect())
        }
        Encoder::Rotary {
            counts_per_revolution,
        } => {
            let counts = positive("counts per revolution", counts_per_revolution)?;
            let arm = positive("arm", sensor.arm)?;
            let reach = x.iter().map(|x| x.abs()).fold(0.0, f64::max);
            if reach > arm {
                return Err(Error::bad_option(
                    "arm",
                    arm,
                    "an arm longer than the largest displacement",
                ));
            }
            let per_radian = counts / std::f64::consts::TAU;
            Ok(x.iter().map(|x| (x / arm).asin() * per_radian).collect())
        }
    }
}

fn noisy(value: f64, deviation: f64, source: &mut NoiseSource) -> f64 {
    if deviation > 0.0 {
        value + deviation * normal(source)
    } else {
        value
    }
}

fn sensor_channel(
    trajectory: &Trajectory,
    quantity: Quantity,
    sensor: &Sensor,
    source: &mut NoiseSource,
) -> Result<RawChannel, Error> {
    let at = sampling_times(trajectory, sensor.sampling_rate)?;
    let values = match quantity {
        Quantity::Displacement => {
            cubic(trajectory, &trajectory.displacement, &trajectory.rate, &at)
        }
        Quantity::Rate => cubic(trajectory, &trajectory.rate, &trajectory.acceleration, &at),
        Quantity::Acceleration => linear(trajectory, &trajectory.acceleration, &at),
        _ => linear(trajectory, &trajectory.force, &at),
    };
    let step = sensor.converter.map(converter_step).transpose()?;
    if sensor.persistence.is_nan() || sensor.persistence.abs() >= 1.0 {
        return Err(Error::bad_option(
            "persistence",
            sensor.persistence,
            "a correlation between -1 and 1",
        ));
    }
    let mut noise = coloured(sensor, source);
    let samples = values
        .iter()
        .map(|&value| {
            let volts = (value + noise()) * sensor.sensitivity + sensor.offset;
            match (sensor.converter, step) {
                (Some(converter), Some(step)) => converted(volts, converter, step),
                _ => volts,
            }
        })
        .collect();
    Ok(RawChannel {
        quantity,
        unit: "V",
        start: at[0],
        interval: 1.0 / sensor.sampling_rate,
        samples,
    })
}

/// Noise of successive samples.
fn coloured(sensor: &Sensor, source: &mut NoiseSource) -> impl FnMut() -> f64 {
    let Sensor {
        noise, persistence, ..
    } = *sensor;
    let innovation = noise * (1.0 - persistence * persistence).sqrt();
    let mut last = None;
    move || {
        if noise <= 0.0 {
            return 0.0;
        }
        let next = match last {
            None => noise * normal(source),
            Some(last) => persistence * last + innovation * normal(source),
        };
        last = Some(next);
        next
    }
}

/// Volts of one step of the converter.
fn converter_step(converter: Converter) -> Result<f64, Error> {
    if !(1..=32).contains(&converter.bits) {
        return Err(Error::bad_option(
            "converter bits",
            f64::from(converter.bits),
            "1 to 32",
        ));
    }
    let range = positive("converter range", converter.high - converter.low)?;
    Ok(range / 2f64.powi(converter.bits as i32))
}

/// Rounded to a step and held within the range.
fn converted(volts: f64, converter: Converter, step: f64) -> f64 {
    let last = 2f64.powi(converter.bits as i32) - 1.0;
    let code = ((volts - converter.low) / step).round().clamp(0.0, last);
    converter.low + code * step
}
