//! `[fit]` and `[calibrate]` of campaign.toml of a drop rig.

use crate::file::{CalibrateFile, DropFitFile, HertzFile};
use windfall_campaign::settings::file::QuantityText;
use windfall_campaign::settings::fit::{ENDS, LawKeys, free_names, law_expressions};
use windfall_contact::expression::{LawExpression, parse_law_among};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, invalid, missing, number_that, positive_quantity, refused,
    suggestion,
};
use windfall_numerics::unit::quantity::{parse_as, parse_unit};

/// The law that is calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct DropLaw {
    /// The law with the values that were given.
    pub law: LawExpression,
    /// Positions of the estimated parameters: those without a value, or freed by name.
    pub free: Vec<usize>,
    /// End of contact.
    pub end: EndRule,
}

/// A way to calibrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Least squares on the whole signal.
    Waveform,
    /// Peaks and intervals, by the simulator itself.
    Features,
    /// Peaks and intervals, by design and response surface.
    Design,
}

/// Words for the ways.
pub const WAYS: [(&str, Way); 3] = [
    ("waveform", Way::Waveform),
    ("features", Way::Features),
    ("design", Way::Design),
];

/// Whose peaks and intervals are the target of features and design.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Target {
    /// Those of all drops.
    #[default]
    All,
    /// Those of the drops from one height; m.
    Height(f64),
    /// Those of one drop, by its id.
    Drop(String),
}

/// A fruit and a rigid plane in Hertz's contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzContact {
    /// Radius of the fruit where it touches; m.
    pub radius: f64,
    /// Its Young's modulus; Pa.
    pub modulus: f64,
    /// Its Poisson's ratio; 1.
    pub poisson: f64,
}

/// Between which values a parameter is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterRange {
    /// Position of the parameter in the law.
    pub position: usize,
    /// Lowest value, in `unit`.
    pub low: f64,
    /// Highest value, in `unit`.
    pub high: f64,
    /// What they are in.
    pub unit: RangeUnit,
}

/// Unit of a range.
///
/// A stiffness in N/mm^e is another one in SI for every exponent e: where the
/// exponent is searched too, a range in N/mm^e is no range in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum RangeUnit {
    /// SI.
    Si,
    /// The text of the range, with the law's exponent by name: "N/mm^e".
    OfExponent {
        /// Position of the exponent in the law.
        exponent: usize,
        /// What comes to the power of the exponent: 0.001 for mm; m.
        length: f64,
        /// SI value of what stands before it: 1 for N, 1000 for kN.
        factor: f64,
        /// As it was written.
        text: String,
    },
}

impl ParameterRange {
    /// SI value of a value in the unit of this range.
    ///
    /// * `law`: values of all parameters, for the exponent
    pub fn si(&self, value: f64, law: &[f64]) -> f64 {
        match &self.unit {
            RangeUnit::Si => value,
            RangeUnit::OfExponent {
                exponent,
                length,
                factor,
                ..
            } => value * factor * length.powf(-law[*exponent]),
        }
    }
}

/// How the law is calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrateSettings {
    /// The law; `None` where the campaign only looks at bounces.
    pub law: Option<DropLaw>,
    /// The user's own laws, by which laws can be named.
    pub user: Vec<LawKind>,
    /// The ways; all that apply where there is none.
    pub ways: Vec<Way>,
    /// Start values of the free parameters.
    pub start: Option<LawExpression>,
    /// What gives start values otherwise.
    pub hertz: Option<HertzContact>,
    /// Bounces of each drop that are used.
    pub bounces: usize,
    /// Whose features are the target.
    pub target: Target,
    /// Width of the targets of a desirability, as a part of them; 1.
    pub tolerance: f64,
    /// Ranges of free parameters, in the order of the law.
    pub ranges: Vec<ParameterRange>,
    /// Seed of whatever is drawn.
    pub seed: u64,
}

/// The study used the first two impacts.
const BOUNCES: u32 = 2;

/// Most bounces of a drop.
const MOST_BOUNCES: u32 = 100;

/// Default of [`CalibrateSettings::tolerance`].
const TOLERANCE: f64 = 0.05;

const TABLE: &str = "[calibrate]";

/// How a campaign is calibrated.
///
/// * `user`: the user's own laws
///
/// # Errors
/// A value cannot be used, or belongs to another law.
pub fn calibrate_settings(
    source: &TomlSource,
    fit: &DropFitFile,
    file: &CalibrateFile,
    user: Vec<LawKind>,
) -> Result<CalibrateSettings, Error> {
    let law = drop_law(source, fit, &user)?;
    let hertz = file.hertz.as_ref();
    Ok(CalibrateSettings {
        ways: ways(source, file)?,
        start: start(source, file, law.as_ref(), &user)?,
        hertz: hertz
            .map(|hertz| hertz_contact(source, hertz))
            .transpose()?,
        bounces: bounces(source, file)?,
        target: target(source, file)?,
        tolerance: tolerance(source, file)?,
        ranges: ranges(source, file, law.as_ref())?,
        seed: file.seed.unwrap_or(1),
        law,
        user,
    })
}

fn drop_law(
    source: &TomlSource,
    file: &DropFitFile,
    user: &[LawKind],
) -> Result<Option<DropLaw>, Error> {
    let end = choice(source, file.end.as_ref(), ("[fit]", "end"), &ENDS)?;
    let keys = LawKeys {
        law: file.law.as_ref(),
        laws: None,
        free: file.free.as_deref(),
    };
    if keys.law.is_none() {
        let Some(free) = keys.free.and_then(<[_]>::first) else {
            return Ok(None);
        };
        let problem = "there is no `law` in [fit] whose parameter this could be".to_owned();
        let key = ("[fit]", "free");
        return Err(refused(source, free, key, problem));
    }
    let laws = law_expressions(source, &keys, user)?;
    let names = free_names(source, &keys, &laws)?;
    Ok(laws.into_iter().next().map(|law| DropLaw {
        free: free_positions(&law, &names),
        law,
        end: end.unwrap_or_default(),
    }))
}

/// Parameters that have no value and no default, and those freed by name.
fn free_positions(law: &LawExpression, names: &[String]) -> Vec<usize> {
    let description = law.kind.describe();
    let named: Vec<_> = names.iter().map(|n| description.index_of(n)).collect();
    let known = law.values_or_defaults();
    (0..description.parameters.len())
        .filter(|i| known[*i].is_none() || named.contains(&Some(*i)))
        .collect()
}

fn ways(source: &TomlSource, file: &CalibrateFile) -> Result<Vec<Way>, Error> {
    let mut ways = Vec::new();
    for word in file.ways.iter().flatten() {
        if let Some(way) = choice(source, Some(word), (TABLE, "ways"), &WAYS)? {
            ways.push(way);
        }
    }
    Ok(ways)
}

fn start(
    source: &TomlSource,
    file: &CalibrateFile,
    law: Option<&DropLaw>,
    user: &[LawKind],
) -> Result<Option<LawExpression>, Error> {
    let Some(text) = &file.start else {
        return Ok(None);
    };
    let wrong = |problem: String| refused(source, text, (TABLE, "start"), problem);
    let start = parse_law_among(text.get_ref(), user).map_err(|error| wrong(error.to_string()))?;
    match law {
        Some(law) if law.law.kind != start.kind => Err(wrong(format!(
            "expected values of the law in [fit], {}",
            law.law.kind.name()
        ))),
        _ => Ok(Some(start)),
    }
}

fn hertz_contact(source: &TomlSource, file: &Spanned<HertzFile>) -> Result<HertzContact, Error> {
    let at = file.span();
    let hertz = file.get_ref();
    let table = "[calibrate] hertz";
    let needed = |key, meaning, unit, example| Needed::of(table, key, meaning, unit, example);
    let radius = needed(
        "radius",
        "radius where it touches",
        "m",
        "radius = \"10 mm\"",
    );
    let modulus = needed("modulus", "Young's modulus", "Pa", "modulus = \"1 MPa\"");
    let poisson = needed("poisson", "Poisson's ratio", "", "poisson = 0.468");
    let quantity = |value: &Option<Spanned<QuantityText>>, needed: &Needed| {
        positive_quantity(source, value.as_ref(), needed)?
            .ok_or_else(|| missing(source, &at, needed, needed.table.to_owned()))
    };
    let (key, fits) = ((table, "poisson"), |ratio| (-1.0..=0.5).contains(&ratio));
    let expected = "a number from -1 to 0.5";
    let ratio = number_that(source, hertz.poisson.as_ref(), key, fits, expected)?
        .ok_or_else(|| missing(source, &at, &poisson, table.to_owned()))?;
    Ok(HertzContact {
        radius: quantity(&hertz.radius, &radius)?,
        modulus: quantity(&hertz.modulus, &modulus)?,
        poisson: ratio,
    })
}

fn bounces(source: &TomlSource, file: &CalibrateFile) -> Result<usize, Error> {
    let (key, fits) = ((TABLE, "bounces"), |n| (1..=MOST_BOUNCES).contains(&n));
    let expected = format!("a whole number from 1 to {MOST_BOUNCES}");
    let number = number_that(source, file.bounces.as_ref(), key, fits, &expected)?;
    Ok(number.unwrap_or(BOUNCES) as usize)
}

fn target(source: &TomlSource, file: &CalibrateFile) -> Result<Target, Error> {
    let needed = Needed {
        table: TABLE,
        key: "target_height",
        meaning: "height whose drops are the target",
        unit: "m",
        example: "target_height = \"500 mm\"",
    };
    let height = positive_quantity(source, file.target_height.as_ref(), &needed)?;
    match (height, &file.target_drop) {
        (Some(_), Some(drop)) => {
            let problem = "`target_height` is given too; keep one of them".to_owned();
            let key = (TABLE, "target_drop");
            Err(refused(source, drop, key, problem))
        }
        (Some(height), None) => Ok(Target::Height(height)),
        (None, Some(drop)) => Ok(Target::Drop(drop.get_ref().clone())),
        (None, None) => Ok(Target::All),
    }
}

fn tolerance(source: &TomlSource, file: &CalibrateFile) -> Result<f64, Error> {
    let (key, fits) = ((TABLE, "tolerance"), |part| part > 0.0 && part < 1.0);
    let expected = "a part above 0 and below 1";
    let part = number_that(source, file.tolerance.as_ref(), key, fits, expected)?;
    Ok(part.unwrap_or(TOLERANCE))
}

fn ranges(
    source: &TomlSource,
    file: &CalibrateFile,
    law: Option<&DropLaw>,
) -> Result<Vec<ParameterRange>, Error> {
    let mut ranges = Vec::new();
    for (name, ends) in file.ranges.iter().flatten() {
        let wrong = |text: &str, problem: String| {
            let key = format!("ranges.{name}");
            invalid(source, &ends.span(), (TABLE, &key), text, problem)
        };
        let Some(law) = law else {
            let problem = "there is no `law` in [fit] whose parameter this could be";
            return Err(wrong(name, problem.to_owned()));
        };
        let parameters = law.law.kind.describe().parameters;
        let position = law.law.kind.describe().index_of(name);
        let Some(position) = position.filter(|position| law.free.contains(position)) else {
            let names: Vec<&str> = law.free.iter().map(|i| parameters[*i].name).collect();
            let hint = suggestion(name, names.iter().copied());
            let problem = format!("no free parameter of this name{hint}: {}", names.join(", "));
            return Err(wrong(name, problem));
        };
        let [low, high] = ends.get_ref();
        let end = |text: &QuantityText| {
            range_end(&law.law, position, &text.0).map_err(|problem| wrong(&text.0, problem))
        };
        let ((low, unit), (high, other)) = (end(low)?, end(high)?);
        if unit != other || low >= high {
            let problem = "expected two values in the same unit, the lower first".to_owned();
            return Err(wrong(&format!("{low}, {high}"), problem));
        }
        ranges.push(ParameterRange {
            position,
            low,
            high,
            unit,
        });
    }
    ranges.sort_by_key(|range| range.position);
    Ok(ranges)
}

/// One end of a range: in SI, or in a unit with the law's exponent.
fn range_end(law: &LawExpression, position: usize, text: &str) -> Result<(f64, RangeUnit), String> {
    let description = law.kind.describe();
    if let Some((before, name)) = text.rsplit_once('^')
        && let Some(exponent) = description.index_of(name.trim())
    {
        let example = format!("expected a value such as \"0.3 N/mm^{}\"", name.trim());
        let (number, unit) = before
            .trim()
            .split_once(' ')
            .ok_or_else(|| example.clone())?;
        let (above, below) = unit.split_once('/').ok_or_else(|| example.clone())?;
        let si = |unit: &str, of: &str| {
            parse_as(&format!("1 {}", unit.trim()), of).map_err(|error| error.to_string())
        };
        let unit = RangeUnit::OfExponent {
            exponent,
            length: si(below, "m")?,
            factor: si(above, "N")?,
            text: unit.trim().to_owned() + "^" + name.trim(),
        };
        return Ok((number.parse().map_err(|_| example)?, unit));
    }
    let unit = description.unit_of(position, &law.values);
    match unit {
        Some(unit) => {
            parse_unit(&unit).map_err(|error| error.to_string())?;
            let value = parse_as(text, &unit).map_err(|error| error.to_string())?;
            Ok((value, RangeUnit::Si))
        }
        None => match text.parse() {
            Ok(value) => Ok((value, RangeUnit::Si)),
            Err(_) => Err(format!(
                "the exponent in the unit of this parameter, {}, is free: write it with the name \
                 of the exponent, such as \"0.3 N/mm^e\", or give a bare number in SI",
                description.parameters[position].unit
            )),
        },
    }
}
