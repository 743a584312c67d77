//! Descriptions of laws: names, units, bounds, formula and source.

use serde::{Serialize, Serializer};
use windfall_numerics::unit::quantity::exponent_text;

/// One parameter of a force law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ParameterDescription {
    /// Name in law expressions, campaign files and results.
    pub name: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// SI unit in the syntax of `windfall_numerics::unit::quantity`; names of parameters
    /// stand for the law's exponents ("N/m^n", "N s/m^(p+1)"). With numbers in
    /// their place: [`LawDescription::unit_of`].
    pub unit: &'static str,
    /// Smallest legal value; SI.
    pub lower: f64,
    /// Largest legal value; SI. In JSON null where there is no bound.
    #[serde(serialize_with = "bound")]
    #[schema(value_type = Option<f64>)]
    pub upper: f64,
    /// Typical value for fruit, the starting point when nothing better is
    /// known; SI.
    pub typical: f64,
    /// Value taken when the expression leaves the parameter out. Such a
    /// parameter is held at its value in a fit unless it is freed by name.
    pub default: Option<f64>,
}

/// A parameter without a default.
pub(crate) const fn parameter(
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    [lower, upper]: [f64; 2],
    typical: f64,
) -> ParameterDescription {
    ParameterDescription {
        name,
        meaning,
        unit,
        lower,
        upper,
        typical,
        default: None,
    }
}

/// Bounds that only keep the arithmetic finite: of a positive scale, and of one that may
/// be zero.
pub(crate) const POSITIVE: [f64; 2] = [1e-9, 1e30];
pub(crate) const FROM_ZERO: [f64; 2] = [0.0, 1e30];
/// Bounds of the exponent of an elastic force.
pub(crate) const EXPONENTS: [f64; 2] = [0.5, 6.0];

/// Bounds from here on only keep the arithmetic finite.
pub const NO_BOUND: f64 = 1e20;

fn bound<S: Serializer>(upper: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    (*upper < NO_BOUND).then_some(upper).serialize(serializer)
}

impl ParameterDescription {
    /// Largest legal value; SI. `None` where there is no bound.
    pub fn bound_above(&self) -> Option<f64> {
        Some(self.upper).filter(|upper| *upper < NO_BOUND)
    }

    /// The same with its typical value as the default.
    pub(crate) const fn held(self) -> Self {
        Self {
            default: Some(self.typical),
            ..self
        }
    }

    /// Whether the unit contains exponents of the law.
    pub(crate) fn unit_names_exponents(&self) -> bool {
        let mut powers = self.unit.split('^').skip(1);
        powers.any(|power| power.starts_with(|c: char| c.is_alphabetic() || c == '('))
    }
}

/// One force law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct LawDescription {
    /// Name in law expressions.
    pub name: &'static str,
    /// Formula in plain text.
    pub formula: &'static str,
    /// Force and slope at first touch.
    pub first_touch: &'static str,
    /// Where the formula comes from.
    pub source: &'static str,
    /// How the force at rest rises with displacement.
    #[serde(skip)]
    pub elastic: Elastic,
    /// Parameter of the damping force, and the power of the displacement that this force
    /// goes with.
    #[serde(skip)]
    pub damping: Option<(&'static str, Power)>,
    /// Parameters that the force is linear in, all at once: that of the force at rest, then
    /// that of the damping.
    #[serde(skip)]
    pub linear: &'static [&'static str],
    /// Whether a slow loading curve determines its parameters.
    #[serde(skip)]
    pub from_compression: bool,
    /// Parameters, in the order of the derivatives of the law.
    pub parameters: &'static [ParameterDescription],
}

/// How a law's force at rest rises with displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elastic {
    /// k d^1.5 of two spheres: every parameter of the law follows the radii and moduli of
    /// what touches.
    Hertzian,
    /// In proportion to a power.
    Power(Power),
    /// In proportion to no power.
    Other,
}

/// A power of the displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Power {
    /// This exponent.
    Number(f64),
    /// The parameter of this name.
    Parameter(&'static str),
}

/// Velocity at first touch, as a parameter of a law: it belongs to the impact and not
/// to the fruit.
pub const IMPACT_VELOCITY: &str = "impact_velocity";
/// Effective mass, as a parameter of a law; it belongs to the impact too.
pub const MASS: &str = "mass";
/// Nominal coefficient of restitution, as a parameter of a law.
pub const RESTITUTION: &str = "restitution";

impl LawDescription {
    /// Exponent of the force at rest; 1. `None` where the force is no power of the
    /// displacement.
    ///
    /// * `values`: of the law's parameters; SI. An exponent that is `None` takes its
    ///   default
    pub fn elastic_exponent(&self, values: &[Option<f64>]) -> Option<f64> {
        match self.elastic {
            Elastic::Hertzian => Some(1.5),
            Elastic::Power(power) => self.exponent(power, values),
            Elastic::Other => None,
        }
    }

    /// Name of the parameter that is the exponent of the force at rest.
    pub fn exponent_name(&self) -> Option<&'static str> {
        match self.elastic {
            Elastic::Power(Power::Parameter(name)) => Some(name),
            _ => None,
        }
    }

    /// Exponent of a power; 1. `None` where its parameter has neither value nor default.
    pub fn exponent(&self, power: Power, values: &[Option<f64>]) -> Option<f64> {
        match power {
            Power::Number(exponent) => Some(exponent),
            Power::Parameter(name) => self.known(name, values),
        }
    }

    /// Position of the parameter `name`; case and `-` or `_` do not count.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        let folded = |name: &str| name.to_lowercase().replace('-', "_");
        let name = folded(name);
        self.parameters
            .iter()
            .position(|parameter| folded(parameter.name) == name)
    }

    /// SI unit of parameter `index` with numbers for the exponents: "N/m^1.91".
    ///
    /// * `values`: one per parameter of the law, SI; exponents that are `None`
    ///   (or beyond the end) take their default
    ///
    /// Returns `None` when an exponent in the unit has neither value nor
    /// default, or when there is no parameter `index`.
    pub fn unit_of(&self, index: usize, values: &[Option<f64>]) -> Option<String> {
        let mut pieces = self.parameters.get(index)?.unit.split('^');
        let mut unit = pieces.next()?.to_string();
        for piece in pieces {
            let end = piece.find([' ', '/']).unwrap_or(piece.len());
            let (power, rest) = piece.split_at(end);
            let power = power
                .trim_matches(['(', ')'])
                .split('+')
                .try_fold(0.0, |sum, term| {
                    let value = term.parse().ok().or_else(|| self.known(term, values))?;
                    Some(sum + value)
                })?;
            unit.push('^');
            unit.push_str(&exponent_text(power));
            unit.push_str(rest);
        }
        Some(unit)
    }

    /// Value or default of the parameter `name`.
    fn known(&self, name: &str, values: &[Option<f64>]) -> Option<f64> {
        let index = self.index_of(name)?;
        let given = values.get(index).copied().flatten();
        given.or(self.parameters[index].default)
    }

    /// First parameter that the unit of parameter `index` needs and that has
    /// neither value nor default.
    pub(crate) fn missing_exponent(
        &self,
        index: usize,
        values: &[Option<f64>],
    ) -> Option<&'static str> {
        let unit = self.parameters[index].unit;
        let names = self.parameters.iter().map(|parameter| parameter.name);
        names
            .filter(|name| {
                unit.contains(&format!("^{name}")) || unit.contains(&format!("^({name}"))
            })
            .find(|name| self.known(name, values).is_none())
    }
}

/// Shortest text that reads back to the same number, with an exponent where the
/// digits would be many.
pub(crate) fn number_text(value: f64) -> String {
    match value.abs() {
        0.0 | 1e-4..1e12 => format!("{value}"),
        _ => format!("{value:e}"),
    }
}
