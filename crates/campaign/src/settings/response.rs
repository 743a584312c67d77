//! `[response]` of campaign.toml: what the instruments make of force and displacement.

use crate::settings::file::{QuantityText, ResponseFile};
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{Needed, TomlSource, refused, uncertain_quantity};
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_signal::response::{Bending, Response, Swing};

const TABLE: &str = "[response]";
const FILTER: Needed = Needed::of(
    TABLE,
    "force_filter",
    "corner of a filter of first order that the force passes",
    "Hz",
    "force_filter = \"5 kHz\"",
);
const SENSOR_FREQUENCY: Needed = Needed::of(
    TABLE,
    "sensor_frequency",
    "natural frequency of the force sensor",
    "Hz",
    "sensor_frequency = \"2.00 ± 0.01 kHz\"",
);
const SENSOR_DAMPING: Needed = Needed::of(
    TABLE,
    "sensor_damping",
    "damping ratio of the force sensor",
    "1",
    "sensor_damping = \"0.05 ± 0.01\"",
);
const ARM_FREQUENCY: Needed = Needed::of(
    TABLE,
    "arm_frequency",
    "natural frequency of the arm's bending",
    "Hz",
    "arm_frequency = \"1.5 kHz\"",
);
const ARM_DAMPING: Needed = Needed::of(
    TABLE,
    "arm_damping",
    "damping ratio of the arm's bending",
    "1",
    "arm_damping = \"0.02\"",
);
const ARM_COMPLIANCE: Needed = Needed::of(
    TABLE,
    "arm_compliance",
    "bending of the arm between impactor and displacement sensor, per force",
    "m/N",
    "arm_compliance = \"0.1 um/N\"",
);

/// What the instruments do, and the uncertainties behind it beside those of `sd`.
///
/// # Errors
/// A value cannot be used, or one of those that belong together is missing.
pub fn response_plan(
    source: &TomlSource,
    file: &ResponseFile,
    mut sd: BenchSd,
) -> Result<(Response, BenchSd), Error> {
    let mut read = |value: &Option<Spanned<QuantityText>>, needed: &Needed, quantity| {
        let Some(found) = uncertain_quantity(source, value.as_ref(), needed)? else {
            return Ok(None);
        };
        let ratio = needed.unit == "1";
        let fits = found.0 > 0.0 && (!ratio || found.0 < 1.0);
        if let (Some(value), false) = (value, fits) {
            let expected = if ratio {
                "between 0 and 1"
            } else {
                "above zero"
            };
            let problem = format!("must be {expected}, for example: {}", needed.example);
            return Err(refused(source, value, (TABLE, needed.key), problem));
        }
        sd = sd.with(quantity, found.1);
        Ok(Some(found.0))
    };
    let pole = read(&file.force_filter, &FILTER, BenchQuantity::ForceFilter)?;
    let sensor = [
        read(
            &file.sensor_frequency,
            &SENSOR_FREQUENCY,
            BenchQuantity::SensorFrequency,
        )?,
        read(
            &file.sensor_damping,
            &SENSOR_DAMPING,
            BenchQuantity::SensorDamping,
        )?,
    ];
    let arm = [
        read(
            &file.arm_frequency,
            &ARM_FREQUENCY,
            BenchQuantity::ArmFrequency,
        )?,
        read(&file.arm_damping, &ARM_DAMPING, BenchQuantity::ArmDamping)?,
        read(
            &file.arm_compliance,
            &ARM_COMPLIANCE,
            BenchQuantity::ArmCompliance,
        )?,
    ];
    let alone = |value: &Option<Spanned<QuantityText>>, key, needed: &Needed| match value {
        None => Ok(()),
        Some(value) => {
            let problem = format!("it says nothing without {}: {}", needed.key, needed.example);
            Err(refused(source, value, (TABLE, key), problem))
        }
    };
    match sensor {
        [Some(_), Some(_)] => (),
        [None, _] => alone(&file.sensor_damping, "sensor_damping", &SENSOR_FREQUENCY)?,
        _ => alone(&file.sensor_frequency, "sensor_frequency", &SENSOR_DAMPING)?,
    }
    match arm {
        [Some(_), Some(_), Some(_)] => (),
        [None, Some(_), _] => alone(&file.arm_damping, "arm_damping", &ARM_FREQUENCY)?,
        [None, ..] => alone(&file.arm_compliance, "arm_compliance", &ARM_FREQUENCY)?,
        [_, None, _] => alone(&file.arm_frequency, "arm_frequency", &ARM_DAMPING)?,
        _ => alone(&file.arm_frequency, "arm_frequency", &ARM_COMPLIANCE)?,
    }
    let swing = |[frequency, damping]: [Option<f64>; 2]| {
        frequency
            .zip(damping)
            .map(|(frequency, damping)| Swing { frequency, damping })
    };
    let bending = swing([arm[0], arm[1]]).zip(arm[2]);
    let response = Response {
        pole,
        sensor: swing(sensor),
        arm: bending.map(|(swing, compliance)| Bending { swing, compliance }),
    };
    Ok((response, sd))
}
