//! Free parameters of a law as the coordinates of a search: logarithms of what
//! has a unit, exponents as they are.
//!
//! A stiffness in N/m^e changes with the unit of length when e does, so that its
//! value and e are nearly one number. With a length of the size of the
//! indentation as the unit (N/mm^e) they are two.

use windfall_contact::laws::kind::{Law, LawKind};
use windfall_contact::parameter::LawDescription;
use windfall_identify::error::Error;

/// A logarithm goes this far from its start when the law sets no limit.
const FARTHEST: f64 = 14.0;

/// One free parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCoordinate {
    /// Its position in the law's description.
    pub position: usize,
    /// Whether the coordinate is the logarithm of the value.
    pub logarithmic: bool,
    /// Positions of the exponents that its unit names.
    pub exponents: Vec<usize>,
    /// Lowest coordinate.
    pub low: f64,
    /// Highest coordinate.
    pub high: f64,
}

/// The free parameters of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCoordinates {
    /// The law.
    pub kind: LawKind,
    /// Values of all parameters; those that are free count as a start; SI.
    pub values: Vec<f64>,
    /// The free ones.
    pub free: Vec<LawCoordinate>,
    /// Unit of length of values whose unit names an exponent; m.
    pub length: f64,
}

/// Coordinates of the free parameters of a law.
///
/// * `free`: positions in the law's description
/// * `length`: unit of length of values whose unit names an exponent; m
///
/// # Errors
/// [`Error::NothingToFit`] where none is free.
pub fn law_coordinates(law: &Law, free: &[usize], length: f64) -> Result<LawCoordinates, Error> {
    let kind = law.kind();
    let description = kind.describe();
    if free.is_empty() {
        return Err(Error::NothingToFit { law: kind.name() });
    }
    let mut coordinates = LawCoordinates {
        kind,
        values: law.parameters(),
        free: Vec::new(),
        length,
    };
    for &position in free {
        let parameter = &description.parameters[position];
        coordinates.free.push(LawCoordinate {
            position,
            logarithmic: parameter.unit != "1" && parameter.lower >= 0.0,
            exponents: named_exponents(description, position),
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        });
    }
    let start = coordinates.start();
    for (coordinate, start) in coordinates.free.iter_mut().zip(start) {
        let parameter = &description.parameters[coordinate.position];
        (coordinate.low, coordinate.high) = match coordinate.logarithmic {
            true => (start - FARTHEST, start + FARTHEST),
            false => (parameter.lower, parameter.upper),
        };
    }
    Ok(coordinates)
}

/// Positions of the parameters that a unit names as exponents, as "N/m^e" does.
fn named_exponents(description: &LawDescription, position: usize) -> Vec<usize> {
    let mut named = Vec::new();
    for piece in description.parameters[position].unit.split('^').skip(1) {
        let end = piece.find([' ', '/']).unwrap_or(piece.len());
        let terms = piece[..end].trim_matches(['(', ')']).split('+');
        named.extend(terms.filter_map(|term| description.index_of(term)));
    }
    named
}

impl LawCoordinates {
    /// Coordinates of the start.
    pub fn start(&self) -> Vec<f64> {
        self.of_values(&self.values)
    }

    /// Coordinates of values of all parameters; SI.
    pub fn of_values(&self, values: &[f64]) -> Vec<f64> {
        let typical = self.kind.describe().parameters;
        let coordinate = |free: &LawCoordinate| match free.logarithmic {
            true => {
                let value = values[free.position];
                // A logarithm cannot start from nothing.
                let value = match value > 0.0 {
                    true => value,
                    false => 1e-3 * typical[free.position].typical,
                };
                value.ln() + self.length.ln() * exponent_sum(free, values)
            }
            false => values[free.position],
        };
        self.free.iter().map(coordinate).collect()
    }

    /// Values of all parameters at coordinates; SI.
    pub fn values_at(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut values = self.values.clone();
        let pairs = || self.free.iter().zip(coordinates);
        // Exponents first: units depend on them.
        for (free, coordinate) in pairs().filter(|(free, _)| !free.logarithmic) {
            values[free.position] = *coordinate;
        }
        for (free, coordinate) in pairs().filter(|(free, _)| free.logarithmic) {
            let shift = self.length.ln() * exponent_sum(free, &values);
            values[free.position] = (coordinate - shift).exp();
        }
        values
    }

    /// The law at coordinates.
    ///
    /// # Errors
    /// A value is outside the law's bounds.
    pub fn law_at(&self, coordinates: &[f64]) -> Result<Law, Error> {
        Ok(self.kind.with_parameters(&self.values_at(coordinates))?)
    }

    /// Values of the free parameters at coordinates, with the reference length as
    /// the unit of length where a unit names an exponent.
    pub fn written(&self, coordinates: &[f64]) -> Vec<f64> {
        let pairs = self.free.iter().zip(coordinates);
        pairs
            .map(|(free, coordinate)| match free.logarithmic {
                true => coordinate.exp(),
                false => *coordinate,
            })
            .collect()
    }

    /// Derivatives by the coordinates from those by the law's parameters, which
    /// are `values`.
    pub fn chain(&self, by_parameter: &[f64], values: &[f64]) -> Vec<f64> {
        let slope = |free: &LawCoordinate| match free.logarithmic {
            true => by_parameter[free.position] * values[free.position],
            false => {
                let named = self.free.iter().filter(|other| other.logarithmic);
                let moved: f64 = named
                    .map(|other| {
                        let times = other.exponents.iter().filter(|e| **e == free.position);
                        -(times.count() as f64)
                            * self.length.ln()
                            * values[other.position]
                            * by_parameter[other.position]
                    })
                    .sum();
                by_parameter[free.position] + moved
            }
        };
        self.free.iter().map(slope).collect()
    }

    /// Standard uncertainty of a value from that of its coordinate.
    pub fn sd_of_value(&self, place: usize, value: f64, sd: f64) -> f64 {
        match self.free[place].logarithmic {
            true => value * sd,
            false => sd,
        }
    }

    /// Names of the free parameters.
    pub fn names(&self) -> Vec<&'static str> {
        let parameters = self.kind.describe().parameters;
        let free = self.free.iter();
        free.map(|free| parameters[free.position].name).collect()
    }
}

fn exponent_sum(free: &LawCoordinate, values: &[f64]) -> f64 {
    let named = free.exponents.iter();
    named.map(|position| values[*position]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;

    fn study() -> LawCoordinates {
        let text = r#"adams-impact(k="0.868 N/mm^1.91", e=1.91, c="5.56e-4 N s/mm", d="0.001 mm")"#;
        let law = parse_law(text).unwrap().complete().unwrap();
        law_coordinates(&law, &[0, 1, 2], 1e-3).unwrap()
    }

    #[test]
    fn reference_stiffness_in_the_study_s_unit() {
        let coordinates = study();
        let written = coordinates.written(&coordinates.start());
        assert!((written[0] - 0.868).abs() < 1e-12, "{written:?}");
        assert!((written[1] - 1.91).abs() < 1e-15);
        assert!((written[2] - 0.556).abs() < 1e-13);
        let back = coordinates.values_at(&coordinates.start());
        // 0.868 * 1000^1.91
        assert!((back[0] - 466_143.599_2).abs() < 1e-3);
    }

    #[test]
    fn derivative_chain_of_coordinates() {
        let coordinates = study();
        let at = coordinates.start();
        // A function of all four parameters with known slopes.
        let function = |v: &[f64]| v[0].ln() * v[1] + v[1] * v[1] + v[2].sqrt() * v[1];
        let v = coordinates.values_at(&at);
        let slopes = [
            v[1] / v[0],
            v[0].ln() + 2.0 * v[1] + v[2].sqrt(),
            0.5 * v[1] / v[2].sqrt(),
            0.0,
        ];
        let chained = coordinates.chain(&slopes, &v);
        for place in 0..3 {
            let mut ends = [at.clone(), at.clone()];
            ends[0][place] += 1e-6;
            ends[1][place] -= 1e-6;
            let [up, down] = ends.map(|q| function(&coordinates.values_at(&q)));
            let difference = (up - down) / 2e-6;
            assert!(
                (chained[place] / difference - 1.0).abs() < 1e-7,
                "{place}: {chained:?} {difference}"
            );
        }
    }
}
