//! A regression of bruise volumes, as `windfall regress --format json` writes it or as a user
//! does by hand, for the contacts of a scene.

use crate::file::bruise_expression::{Expression, expression_of};
use crate::file::card::lower_factor;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::column_title::column_title;
use windfall_files::text::toml_places::invalid_at;
use windfall_files::text::toml_source::{TomlSource, parse_source, read_source, suggestion};
use windfall_numerics::unit::quantity::{parse_as, parse_unit};
use windfall_scene::bruise::regression::{Regression, Response};
use windfall_statistics::model::formula_syntax::{Kind, Node, Operator, parse, spelling};

/// Quantities of a contact, in the order in which its values are listed.
pub const CONTACT_QUANTITIES: [(&str, &str); 9] = [
    ("absorbed energy", "J"),
    ("impact energy", "J"),
    ("peak force", "N"),
    ("impact velocity", "m/s"),
    ("contact duration", "s"),
    ("displacement", "m"),
    ("radius", "m"),
    ("diameter", "m"),
    ("mass", "kg"),
];

/// A regression with what its columns are.
#[derive(Clone, Debug)]
pub struct RegressionPlan {
    /// Coefficients and their covariance.
    pub regression: Regression,
    /// Terms, in the order of the coefficients.
    pub terms: Vec<Expression>,
    /// Columns of the terms.
    pub columns: Vec<ColumnPlan>,
}

/// A column of a regression.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnPlan {
    pub name: String,
    /// What a scene takes for it.
    pub source: ColumnSource,
    /// In which range it was; in its own unit.
    pub range: Option<[f64; 2]>,
}

/// What stands for a column.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnSource {
    /// A quantity of the contact, by its place in [`CONTACT_QUANTITIES`], and what its SI value
    /// is divided by.
    Contact(usize, f64),
    /// A property of the fruit.
    Property(String),
}

impl RegressionPlan {
    /// Values of the columns.
    ///
    /// * `contact`: in the order of [`CONTACT_QUANTITIES`]; SI
    /// * `properties`: of the fruit, in the order of [`RegressionPlan::properties`]
    pub fn columns_of(&self, contact: &[f64; 9], properties: &[f64]) -> Vec<f64> {
        let mut properties = properties.iter();
        let value = |column: &ColumnPlan| match &column.source {
            ColumnSource::Contact(place, unit) => contact[*place] / unit,
            ColumnSource::Property(_) => properties.next().copied().unwrap_or(f64::NAN),
        };
        self.columns.iter().map(value).collect()
    }

    /// Values of the terms.
    pub fn terms_of(&self, columns: &[f64]) -> Vec<f64> {
        self.terms.iter().map(|own| own.value(columns)).collect()
    }

    /// Names of the properties of fruit that it needs.
    pub fn properties(&self) -> Vec<String> {
        let named = |column: &ColumnPlan| match &column.source {
            ColumnSource::Property(name) => Some(name.clone()),
            ColumnSource::Contact(..) => None,
        };
        self.columns.iter().filter_map(named).collect()
    }

    /// Whether a contact lies outside of what the regression was of.
    pub fn is_outside(&self, columns: &[f64]) -> bool {
        let outside = |(column, value): (&ColumnPlan, &f64)| {
            column
                .range
                .is_some_and(|[low, high]| *value < low || *value > high)
        };
        self.columns.iter().zip(columns).any(outside)
    }
}

/// The file: what `windfall regress --format json` writes, or a part of it as TOML.
#[derive(Debug, Deserialize)]
struct RegressionFile {
    response: String,
    terms: Vec<TermFile>,
    #[serde(default)]
    covariance: Vec<Vec<f64>>,
    #[serde(default)]
    sigma: f64,
    #[serde(default)]
    variances: Vec<VarianceFile>,
    #[serde(default)]
    ranges: Vec<RangeFile>,
    volume_unit: Option<String>,
}

#[derive(Debug, Deserialize)]
struct TermFile {
    term: String,
    estimate: f64,
    #[serde(default)]
    se: f64,
}

#[derive(Debug, Deserialize)]
struct VarianceFile {
    group: String,
    kind: String,
    of: String,
    value: f64,
}

#[derive(Debug, Deserialize)]
struct RangeFile {
    column: String,
    low: f64,
    high: f64,
}

/// Reads a regression of bruise volumes.
///
/// * `named`: what columns are whose names do not tell it: "absorbed energy in mJ"
/// * `properties`: of fruit, that a column may be
///
/// # Errors
/// The file cannot be read, or a scene cannot calculate what it says.
pub fn read_regression(
    path: &Path,
    named: &BTreeMap<String, String>,
    properties: &[String],
) -> Result<RegressionPlan, Error> {
    let advice = "write it with `windfall regress TABLE --formula … --format json`";
    let source = read_source(path, advice)?;
    let file = file_of(&source)?;
    let wrong = |keys: &[&str]| {
        let keys: Vec<String> = keys.iter().map(|key| (*key).to_owned()).collect();
        let source = &source;
        move |problem: String| {
            let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
            invalid_at(source, &keys, problem)
        }
    };
    let mut names = Vec::new();
    let mut terms = Vec::new();
    let mut columns = Vec::new();
    for (number, term) in file.terms.iter().enumerate() {
        let at = wrong(&["terms", &number.to_string(), "term"]);
        terms.push(expression_of(&term.term, &mut names).map_err(&at)?);
        for name in &names[columns.len()..] {
            let range = file.ranges.iter().find(|own| own.column == *name);
            columns.push(ColumnPlan {
                range: range.map(|own| [own.low, own.high]),
                name: name.clone(),
                source: source_of(name, named, properties).map_err(&at)?,
            });
        }
    }
    let said = match file.volume_unit {
        Some(_) => "volume_unit",
        None => "response",
    };
    let (response, unit) = response_of(&file).map_err(wrong(&[said]))?;
    if file.sigma < 0.0 {
        let problem = "a standard deviation is not below zero".to_owned();
        return Err(wrong(&["sigma"])(problem));
    }
    let (between_fruit, residual) = scatter_of(&file).map_err(wrong(&["variances"]))?;
    check_estimates(&source, &file)?;
    Ok(RegressionPlan {
        regression: Regression {
            response,
            unit,
            coefficients: file.terms.iter().map(|own| own.estimate).collect(),
            factor: factor_of(&file).map_err(wrong(&["covariance"]))?,
            between_fruit,
            residual,
        },
        terms,
        columns,
    })
}

/// Estimates and their standard errors are numbers, and errors not below zero.
fn check_estimates(source: &TomlSource, file: &RegressionFile) -> Result<(), Error> {
    if file.terms.is_empty() {
        return Err(invalid_at(
            source,
            &["terms"],
            "at least one term is needed",
        ));
    }
    for (number, term) in file.terms.iter().enumerate() {
        let (key, problem) = match () {
            () if !term.estimate.is_finite() => ("estimate", "expected a finite number"),
            () if !(term.se >= 0.0 && term.se.is_finite()) => {
                ("se", "expected a finite number, not below zero")
            }
            () => continue,
        };
        let keys = ["terms", &number.to_string(), key];
        return Err(invalid_at(source, &keys, problem));
    }
    Ok(())
}

fn file_of(source: &TomlSource) -> Result<RegressionFile, Error> {
    let json = source.text.trim_start().starts_with('{');
    match json {
        false => parse_source(source),
        true => serde_json::from_str(&source.text).map_err(|error| {
            let problem = format!(
                "this is not what `windfall regress --format json` writes: {error}; a regression \
                 without degrees of freedom left has no standard errors, and cannot be used"
            );
            unusable(source.path.display().to_string(), problem)
        }),
    }
}

/// What the regression is of, and the unit of volumes; m³.
fn response_of(file: &RegressionFile) -> Result<(Response, f64), String> {
    let text = &file.response;
    let node = parse(text).map_err(|error| error.to_string())?;
    let unknown = || {
        format!(
            "the response \"{text}\" is no volume that a scene can calculate back: a column such \
             as bruise_volume_mm3, its log, log10, log2 or sqrt, or a power of it"
        )
    };
    let column = |node: &Node| match &node.kind {
        Kind::Name(name) => Ok(name.clone()),
        _ => Err(unknown()),
    };
    let (name, response) = match &node.kind {
        Kind::Name(name) => (name.clone(), Response::Volume),
        Kind::Call(function, arguments) => {
            let response = match function.as_str() {
                "log" => Response::Logarithm(std::f64::consts::E),
                "log10" => Response::Logarithm(10.0),
                "log2" => Response::Logarithm(2.0),
                "sqrt" => Response::Power(0.5),
                _ => return Err(unknown()),
            };
            let [argument] = &arguments[..] else {
                return Err(unknown());
            };
            (column(&argument.value)?, response)
        }
        Kind::Binary(Operator::Power, base, power) => {
            let power = expression_of(&spelling(power), &mut Vec::new())?;
            let power = power.value(&[]);
            if !(power > 0.0 && power.is_finite()) {
                return Err(unknown());
            }
            (column(base)?, Response::Power(power))
        }
        _ => return Err(unknown()),
    };
    let unit = match &file.volume_unit {
        Some(unit) => unit.clone(),
        None => column_title(&name).1,
    };
    let size = parse_as(&format!("1 {unit}"), "m^3");
    if let (Some(_), Err(error)) = (&file.volume_unit, &size) {
        return Err(error.to_string());
    }
    let size = size.ok();
    let size = size.filter(|_| !unit.is_empty());
    size.map(|size| (response, size)).ok_or_else(|| {
        format!(
            "the name of the response \"{name}\" does not end in a unit of volume, as \
             bruise_volume_mm3 does; add volume_unit = \"mm^3\" (in JSON \"volume_unit\": \"mm^3\")"
        )
    })
}

/// Standard deviations between fruit, and of what is left.
fn scatter_of(file: &RegressionFile) -> Result<(f64, f64), String> {
    let (mut between, mut residual) = (0.0, file.sigma * file.sigma);
    for own in &file.variances {
        match (own.kind.as_str(), own.group.as_str(), own.of.as_str()) {
            ("sd", "residual", _) => residual += own.value * own.value,
            ("sd", _, "(Intercept)" | "1" | "intercept") => between += own.value * own.value,
            ("sd", group, of) => {
                return Err(format!(
                    "the slope of {of} varies with {group}: a scene knows fruit that differ in \
                     their mean; leave the random slope out (`--random {group}`)"
                ));
            }
            _ => {}
        }
    }
    let found = (between.sqrt(), residual.sqrt());
    match found.0.is_finite() && found.1.is_finite() {
        true => Ok(found),
        false => Err("its standard deviations are no numbers".to_owned()),
    }
}

/// Lower triangle of the covariance of the coefficients; from standard errors where none is
/// given.
fn factor_of(file: &RegressionFile) -> Result<Vec<Vec<f64>>, String> {
    let count = file.terms.len();
    if file.covariance.is_empty() {
        let row = |(place, own): (usize, &TermFile)| {
            let mut row = vec![0.0; count];
            row[place] = own.se;
            row
        };
        return Ok(file.terms.iter().enumerate().map(row).collect());
    }
    if file.covariance.len() != count {
        return Err(format!(
            "its covariance has {} rows for {count} terms",
            file.covariance.len()
        ));
    }
    lower_factor(&file.covariance).ok_or_else(|| "its covariance is none".to_owned())
}

/// What stands for a column.
fn source_of(
    name: &str,
    named: &BTreeMap<String, String>,
    properties: &[String],
) -> Result<ColumnSource, String> {
    if properties.iter().any(|own| own == name) {
        return Ok(ColumnSource::Property(name.to_owned()));
    }
    let (title, unit) = match named.get(name) {
        Some(text) => match text.rsplit_once(" in ") {
            Some((title, unit)) => (title.to_owned(), unit.to_owned()),
            None => (text.clone(), column_title(name).1),
        },
        None => column_title(name),
    };
    let known = CONTACT_QUANTITIES.iter().position(|(own, _)| *own == title);
    let Some(place) = known else {
        let names = CONTACT_QUANTITIES.map(|(own, _)| own);
        let near = suggestion(&title, names);
        return Err(format!(
            "nothing says what the column \"{name}\" is{near}. A contact has {}: name it in \
             [bruise] columns = {{ {name} = \"absorbed energy in J\" }}; what a fruit has belongs \
             into properties = {{ {name} = {{ mean = …, sd = … }} }} of every [[fruit]]",
            names.join(", ")
        ));
    };
    let si = CONTACT_QUANTITIES[place].1;
    if unit.is_empty() {
        return Ok(ColumnSource::Contact(place, 1.0));
    }
    let wanted = parse_unit(si).map_err(|error| error.to_string())?;
    let own = parse_unit(&unit).map_err(|error| error.to_string())?;
    match own.dimension.matches(&wanted.dimension) {
        true => Ok(ColumnSource::Contact(place, own.multiply / own.divide)),
        false => Err(format!(
            "the column \"{name}\" is in {unit}, which is no unit of {title} ({si})"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, named: &[(&str, &str)]) -> Result<RegressionPlan, Error> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bruise");
        std::fs::write(&path, text).unwrap();
        let named = named
            .iter()
            .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()));
        read_regression(&path, &named.collect(), &["temperature_C".to_owned()])
    }

    const OWN: &str = r#"
        response = "log(bruise_volume_mm3)"
        sigma = 0.3
        covariance = [[0.04, 0, 0], [0, 0.01, 0], [0, 0, 1e-4]]
        [[terms]]
        term = "(Intercept)"
        estimate = 7.0
        [[terms]]
        term = "log(absorbed_energy_mJ)"
        estimate = 1.1
        [[terms]]
        term = "temperature_C:radius_mm"
        estimate = -0.02
        [[ranges]]
        column = "absorbed_energy_mJ"
        low = 10
        high = 500
    "#;

    #[test]
    fn closed_form_terms_in_the_units_of_their_columns() {
        let plan = read(OWN, &[]).unwrap();
        assert_eq!(plan.properties(), ["temperature_C"]);
        // 0.2 J, radius 40 mm.
        let contact = [0.2, 0.3, 50.0, 1.0, 0.004, 0.001, 0.04, 0.08, 0.2];
        let columns = plan.columns_of(&contact, &[4.0]);
        assert_eq!(columns, [200.0, 4.0, 40.0]);
        assert_eq!(plan.terms_of(&columns), [1.0, 200.0_f64.ln(), 160.0]);
        assert!(!plan.is_outside(&columns) && plan.is_outside(&[501.0, 4.0, 40.0]));
        assert_eq!(plan.regression.residual, 0.3);
        assert_eq!(plan.regression.unit, 1e-9);
        assert_eq!(plan.regression.factor[1], [0.0, 0.1, 0.0]);
    }

    #[test]
    fn rejects_what_a_scene_cannot_calculate() {
        for (old, new, words) in [
            (
                "absorbed_energy_mJ",
                "energy_mJ",
                "nothing says what the column",
            ),
            (
                "absorbed_energy_mJ",
                "absorbed_energy_mm",
                "no unit of absorbed energy",
            ),
            (
                "temperature_C:radius_mm",
                "poly(radius_mm, 2)",
                "cannot calculate",
            ),
            ("bruise_volume_mm3", "bruise_volume", "volume_unit"),
            (
                "log(bruise_volume_mm3)",
                "exp(bruise_volume_mm3)",
                "calculate back",
            ),
            ("[[0.04, 0, 0], ", "[", "2 rows for 3 terms"),
            ("[0, 0.01, 0]", "[0, -0.01, 0]", "covariance is none"),
        ] {
            assert!(OWN.contains(old), "{old}");
            let error = read(&OWN.replace(old, new), &[]).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        let named = [("energy", "absorbed energy in mJ")];
        let plan = read(&OWN.replace("absorbed_energy_mJ", "energy"), &named).unwrap();
        assert_eq!(plan.columns[0].source, ColumnSource::Contact(0, 1e-3));
    }
}
