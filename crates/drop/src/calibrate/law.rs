//! The law of a calibration: its free parameters as coordinates, in the units of
//! their ranges, and where the search starts.

use crate::calibrate::outcome::StartOutcome;
use crate::calibrate::target::{CalibrateRig, DropData, TargetCondition};
use crate::calibrate_settings::{CalibrateSettings, DropLaw, ParameterRange, RangeUnit};
use windfall_contact::effective::{Elastic, effective_modulus, effective_radius, hertz_stiffness};
use windfall_contact::expression::LawExpression;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::coordinates::{LawCoordinates, law_coordinates};
use windfall_drop_rig::feature_problem::FeatureProblem;
use windfall_drop_rig::start::{exponent_position, stiffness_of_equal_peak};
use windfall_files::error::Error;
use windfall_files::option_value::unusable;

/// Unit of length of a stiffness without a range: indentations are millimetres.
const MILLIMETRE: f64 = 1e-3;

/// The law with its free parameters.
#[derive(Clone, Debug)]
pub struct FreeLaw {
    /// Coordinates from the start values.
    pub coordinates: LawCoordinates,
    /// Range of each free parameter, where given.
    pub ranges: Vec<Option<ParameterRange>>,
    /// The start.
    pub start: Law,
    /// How it came about.
    pub outcome: StartOutcome,
}

/// Prepares the law of a campaign.
///
/// * `energy`: of the first impact of the target; J
///
/// # Errors
/// No parameter is free, or a start value is out of bounds.
pub fn free_law(
    law: &DropLaw,
    settings: &CalibrateSettings,
    energy: f64,
) -> Result<FreeLaw, Error> {
    let (start, outcome) = start_law(law, settings, energy)?;
    let length = settings.ranges.iter().find_map(|range| match &range.unit {
        RangeUnit::OfExponent { length, .. } => Some(*length),
        RangeUnit::Si => None,
    });
    let coordinates =
        law_coordinates(&start, &law.free, length.unwrap_or(MILLIMETRE)).map_err(law_error)?;
    let range = |position: &usize| {
        let mut ranges = settings.ranges.iter();
        ranges.find(|range| range.position == *position).cloned()
    };
    Ok(FreeLaw {
        ranges: law.free.iter().map(range).collect(),
        coordinates,
        start,
        outcome,
    })
}

/// Hertz's stiffness of the fruit on a rigid plane; N/m^1.5.
pub fn hertz_of(settings: &CalibrateSettings) -> Option<f64> {
    let hertz = settings.hertz?;
    let fruit = Elastic {
        modulus: hertz.modulus,
        poisson: hertz.poisson,
    };
    let plate = Elastic {
        modulus: f64::INFINITY,
        poisson: 0.0,
    };
    let radius = effective_radius(hertz.radius, f64::INFINITY);
    Some(hertz_stiffness(effective_modulus(fruit, plate), radius))
}

fn start_law(
    law: &DropLaw,
    settings: &CalibrateSettings,
    energy: f64,
) -> Result<(Law, StartOutcome), Error> {
    let description = law.law.kind.describe();
    let mut values = law.law.values.clone();
    let mut rules: Vec<String> = Vec::new();
    let mut take = |values: &mut Vec<Option<f64>>, position: usize, value: f64, rule: &str| {
        if values[position].is_none() {
            values[position] = Some(value);
            rules.push(format!("{} {rule}", description.parameters[position].name));
        }
    };
    if let Some(start) = &settings.start {
        for (position, value) in start.values.iter().enumerate() {
            if let Some(value) = value {
                let rule = "as given in [calibrate] start";
                take(&mut values, position, *value, rule);
            }
        }
    }
    // Exponents before stiffnesses: these depend on them.
    let exponent = exponent_position(description);
    for &position in &law.free {
        let range = settings.ranges.iter().find(|r| r.position == position);
        if let Some(range) = range
            && description.parameters[position].unit == "1"
        {
            let middle = 0.5 * (range.low + range.high);
            take(&mut values, position, middle, "in the middle of its range");
        }
    }
    if let Some(position) = exponent {
        let usual = description.parameters[position].default.unwrap_or(1.5);
        take(&mut values, position, usual, "as in Hertz's contact");
    }
    let stiffness = hertz_of(settings);
    if let (Some(hertz), Some(position)) = (stiffness, description.index_of("k")) {
        let n = exponent.and_then(|p| values[p]).unwrap_or(1.5);
        let k = stiffness_of_equal_peak(hertz, energy, n);
        let rule = "with the peak force of Hertz's contact at the energy of this drop";
        take(&mut values, position, k, rule);
    }
    let known: Vec<f64> = values
        .iter()
        .zip(description.parameters)
        .map(|(value, parameter)| value.unwrap_or(parameter.typical))
        .collect();
    for &position in &law.free {
        let range = settings.ranges.iter().find(|r| r.position == position);
        match range {
            Some(range) => {
                let middle = range.si((range.low * range.high).max(0.0).sqrt(), &known);
                let middle = match middle > 0.0 {
                    true => middle,
                    false => range.si(0.5 * (range.low + range.high), &known),
                };
                take(&mut values, position, middle, "in the middle of its range");
            }
            None => take(&mut values, position, known[position], "of a usual fruit"),
        }
    }
    let expression = LawExpression {
        kind: law.law.kind,
        values,
    };
    let start = expression
        .complete()
        .map_err(|error| unusable(format!("[fit] law = {}", law.law), error.to_string()))?;
    let outcome = StartOutcome {
        law: LawExpression::from(start).to_string(),
        rule: rules.join("; "),
        hertz_stiffness: stiffness,
    };
    Ok((start, outcome))
}

/// What the ways of a calibration work on.
pub struct Setting<'a> {
    /// The law.
    pub law: &'a FreeLaw,
    /// How it is calibrated.
    pub settings: &'a CalibrateSettings,
    /// The rig.
    pub rig: &'a CalibrateRig,
    /// What is to be met.
    pub target: &'a TargetCondition,
    /// The drops.
    pub drops: &'a [DropData],
    /// All of them as a problem.
    pub problem: &'a FeatureProblem,
    /// End of contact.
    pub end: EndRule,
}

impl FreeLaw {
    /// Number of free parameters.
    pub fn count(&self) -> usize {
        self.coordinates.free.len()
    }

    /// Names of the free parameters.
    pub fn names(&self) -> Vec<String> {
        let names = self.coordinates.names();
        names.into_iter().map(str::to_owned).collect()
    }

    /// Values of all parameters at levels in the units of the ranges; SI.
    pub fn values_of_levels(&self, levels: &[f64]) -> Vec<f64> {
        let mut values = self.coordinates.values.clone();
        // Exponents first: units depend on them.
        for exponents in [true, false] {
            for (place, free) in self.coordinates.free.iter().enumerate() {
                if free.logarithmic != exponents {
                    values[free.position] = self.si(place, levels[place], &values);
                }
            }
        }
        values
    }

    /// The law at levels in the units of the ranges.
    ///
    /// # Errors
    /// A level is outside the law's bounds.
    pub fn law_of_levels(&self, levels: &[f64]) -> Result<Law, Error> {
        let values = self.values_of_levels(levels);
        let law = self.coordinates.kind.with_parameters(&values);
        law.map_err(|error| law_error(error.into()))
    }

    /// Levels at coordinates.
    pub fn levels(&self, at: &[f64]) -> Vec<f64> {
        let values = self.coordinates.values_at(at);
        let free = self.coordinates.free.iter().enumerate();
        free.map(|(place, free)| values[free.position] / self.si(place, 1.0, &values))
            .collect()
    }

    /// SI value of a level.
    fn si(&self, place: usize, level: f64, values: &[f64]) -> f64 {
        let free = &self.coordinates.free[place];
        match &self.ranges[place] {
            Some(range) => range.si(level, values),
            None => {
                let named = free.exponents.iter();
                let power: f64 = named.map(|exponent| values[*exponent]).sum();
                level * self.coordinates.length.powf(-power)
            }
        }
    }

    /// Unit of the levels of a parameter.
    pub fn level_unit(&self, place: usize) -> String {
        let free = &self.coordinates.free[place];
        let unit = self.coordinates.kind.describe().parameters[free.position].unit;
        match self.ranges[place].as_ref().map(|range| &range.unit) {
            Some(RangeUnit::OfExponent { text, .. }) => text.clone(),
            // Without a range: the coordinates' own unit of length.
            None if !free.exponents.is_empty() => unit.replace("/m^", "/mm^"),
            _ => unit.to_owned(),
        }
    }

    /// Limits of the coordinates: the ranges, or a hundredfold about a point.
    pub fn limits(&self, about: &[f64]) -> (Vec<f64>, Vec<f64>) {
        const FAR: f64 = 4.6;
        let values = self.coordinates.values_at(about);
        let pairs = (0..self.count()).map(|place| {
            let free = &self.coordinates.free[place];
            match &self.ranges[place] {
                Some(range) => {
                    let to = |level: f64| {
                        let mut values = values.clone();
                        values[free.position] = self.si(place, level, &values);
                        self.coordinates.of_values(&values)[place]
                    };
                    (to(range.low), to(range.high))
                }
                None if free.logarithmic => (about[place] - FAR, about[place] + FAR),
                None => (
                    free.low.max(about[place] - 1.5),
                    free.high.min(about[place] + 1.5),
                ),
            }
        });
        pairs.unzip()
    }
}

/// An error of the simulator in a calibration.
pub(crate) fn law_error(source: windfall_identify::error::Error) -> Error {
    Error::identify("calibration", source)
}
