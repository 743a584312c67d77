//! Terms of response surfaces: products of powers of factors.

use crate::error::Error;
use crate::model::formula::formula;
use crate::model::formula_syntax::{Kind, Node, Operator};
use std::fmt::Write;

/// Highest power of a factor and highest degree of a term.
const HIGHEST: u32 = 6;

/// Powers of the factors in a term; none of them for the intercept.
pub type Monomial = Vec<u32>;

/// Terms of a surface without the intercept, and how they were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceTerms {
    /// The terms, each once.
    pub monomials: Vec<Monomial>,
    /// Whether factors were written as A, B, C … in their order.
    pub letters: bool,
}

/// The letter of a factor.
pub fn letter(factor: usize) -> String {
    char::from_u32('A' as u32 + factor as u32).map_or_else(String::new, String::from)
}

/// Parses the terms of a surface: `linear`, `2fi`, `quadratic`, `cubic`, or terms
/// with the names of factors or the letters A, B, C … in their order.
///
/// # Errors
/// [`Error::FormulaSyntax`]; [`Error::UnknownColumn`] for what is no factor;
/// [`Error::Request`] for a name that is the letter of another factor.
///
/// ```
/// use windfall_statistics::surface::terms::surface_terms;
/// let factors = ["k", "e"].map(String::from);
/// let terms = surface_terms("A + B + AB + B^2", &factors).unwrap();
/// assert_eq!(terms.monomials, [vec![1, 0], vec![0, 1], vec![1, 1], vec![0, 2]]);
/// assert_eq!(surface_terms("quadratic", &factors).unwrap().monomials.len(), 5);
/// ```
pub fn surface_terms(text: &str, factors: &[String]) -> Result<SurfaceTerms, Error> {
    let lower = text.trim().to_ascii_lowercase();
    let degree = match lower.as_str() {
        "mean" | "1" => Some((0, 0)),
        "linear" => Some((1, 1)),
        "2fi" => Some((2, 1)),
        "quadratic" => Some((2, 2)),
        "cubic" => Some((3, 3)),
        _ => None,
    };
    if let Some((degree, power)) = degree {
        return Ok(SurfaceTerms {
            monomials: all_monomials(factors.len(), degree, power),
            letters: true,
        });
    }
    check_letters(factors)?;
    let found = formula(&text.replace('²', "^2").replace('³', "^3"), factors)?;
    if !found.intercept || found.response.is_some() || !found.random.is_empty() {
        return Err(request(
            text,
            "the model of a surface is a sum of terms; it always has an intercept",
        ));
    }
    let mut letters = false;
    let mut monomials: Vec<Monomial> = Vec::new();
    for term in &found.terms {
        let mut powers = vec![0; factors.len()];
        for atom in term {
            let node = &found.atoms[*atom].node;
            letters |= add_powers(node, 1, factors, &mut powers)?;
        }
        if powers.iter().sum::<u32>() > HIGHEST {
            let problem = format!("terms are of degree {HIGHEST} at most");
            return Err(request(&found.atoms[term[0]].name, &problem));
        }
        if !monomials.contains(&powers) {
            monomials.push(powers);
        }
    }
    // Squares behind products of the same degree, as tables of surfaces have them.
    monomials.sort_by_key(|powers| {
        let degree: u32 = powers.iter().sum();
        (degree, powers.iter().max().copied().unwrap_or(0))
    });
    Ok(SurfaceTerms { monomials, letters })
}

fn request(what: &str, problem: &str) -> Error {
    Error::Request {
        what: what.to_owned(),
        problem: problem.to_owned(),
    }
}

fn check_letters(factors: &[String]) -> Result<(), Error> {
    for (place, name) in factors.iter().enumerate() {
        let other = (0..factors.len()).find(|other| *other != place && letter(*other) == *name);
        if let Some(other) = other {
            let problem = format!(
                "is the name of one factor and the letter of another, {:?}: give the factors in \
                 another order or rename the column",
                factors[other]
            );
            return Err(request(name, &problem));
        }
    }
    Ok(())
}

/// Adds the powers of a part; whether it was written in letters.
fn add_powers(
    node: &Node,
    times: u32,
    factors: &[String],
    powers: &mut Monomial,
) -> Result<bool, Error> {
    match &node.kind {
        Kind::Name(name) => {
            if let Some(place) = factors.iter().position(|factor| factor == name) {
                powers[place] += times;
                return Ok(letter(place) == *name);
            }
            let mut found = Vec::new();
            for character in name.chars() {
                let place = (0..factors.len()).find(|p| letter(*p) == character.to_string());
                found.push(place.ok_or_else(|| unknown(name, factors))?);
            }
            // The power of `AB^2` is that of its last letter.
            let last = found.pop();
            found.into_iter().for_each(|place| powers[place] += 1);
            last.into_iter().for_each(|place| powers[place] += times);
            Ok(true)
        }
        Kind::Binary(Operator::Power, base, exponent) => match exponent.kind {
            Kind::Number(n) if n.fract() == 0.0 && n >= 1.0 && n <= f64::from(HIGHEST) => {
                add_powers(base, n as u32, factors, powers)
            }
            _ => Err(request(
                "a power in the model",
                &format!("powers are whole numbers from 1 to {HIGHEST}"),
            )),
        },
        Kind::Call(function, arguments) if function == "I" && arguments.len() == 1 => {
            add_powers(&arguments[0].value, times, factors, powers)
        }
        Kind::Binary(Operator::Star | Operator::Colon, left, right) => {
            let first = add_powers(left, times, factors, powers)?;
            Ok(add_powers(right, times, factors, powers)? || first)
        }
        _ => Err(request(
            &crate::model::formula_syntax::spelling(node),
            "terms of a surface are products of powers of factors",
        )),
    }
}

fn unknown(name: &str, factors: &[String]) -> Error {
    let known = factors.iter().enumerate();
    let known: Vec<String> = known
        .map(|(place, name)| format!("{name} ({})", letter(place)))
        .collect();
    Error::UnknownColumn {
        name: name.to_owned(),
        known: known.join(", "),
        suggestion: None,
    }
}

/// All products up to a degree and power; linear terms first, squares after products.
pub fn all_monomials(factors: usize, degree: u32, power: u32) -> Vec<Monomial> {
    let mut found: Vec<Monomial> = vec![vec![0; factors]];
    for place in 0..factors {
        found = found
            .into_iter()
            .flat_map(|base| {
                (0..=power).map(move |own| {
                    let mut powers = base.clone();
                    powers[place] = own;
                    powers
                })
            })
            .filter(|powers| powers.iter().sum::<u32>() <= degree)
            .collect();
    }
    found.retain(|powers| powers.iter().any(|p| *p > 0));
    found.sort_by(|a, b| {
        let key = |powers: &Monomial| {
            let degree: u32 = powers.iter().sum();
            (degree, powers.iter().max().copied().unwrap_or(0))
        };
        key(a).cmp(&key(b)).then_with(|| b.cmp(a))
    });
    found
}

/// How a term is written: `AB`, `B^2` with letters, `k:e`, `e^2` with names.
pub fn monomial_name(powers: &[u32], factors: &[String], letters: bool) -> String {
    let mut text = String::new();
    for (place, power) in powers.iter().enumerate().filter(|(_, power)| **power > 0) {
        let name = match letters {
            true => letter(place),
            false => factors[place].clone(),
        };
        if !letters && !text.is_empty() {
            text.push(':');
        }
        text += &name;
        if *power > 1 {
            let _ = write!(text, "^{power}");
        }
    }
    match text.is_empty() {
        true => "(Intercept)".to_owned(),
        false => text,
    }
}

/// Value of a product of powers.
pub fn monomial_value(powers: &[u32], factors: &[f64]) -> f64 {
    let parts = powers.iter().zip(factors);
    parts
        .map(|(power, value)| value.powi(*power as i32))
        .product()
}

/// Whether a term contains another: `AB` and `A^2` both contain `A`.
pub fn contains(outer: &[u32], inner: &[u32]) -> bool {
    outer.iter().zip(inner).all(|(outer, inner)| outer >= inner)
}

/// Whether every term's divisors are there.
pub fn is_hierarchical(monomials: &[Monomial]) -> bool {
    monomials.iter().all(|powers| {
        (0..powers.len())
            .filter(|place| powers[*place] > 0)
            .all(|place| {
                let mut fewer = powers.clone();
                fewer[place] -= 1;
                fewer.iter().all(|power| *power == 0) || monomials.contains(&fewer)
            })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factors() -> Vec<String> {
        ["k", "e", "C"].map(str::to_owned).to_vec()
    }

    #[test]
    fn closed_form_terms_in_letters_and_names() {
        let names = |text: &str| -> Vec<String> {
            let terms = surface_terms(text, &factors()).unwrap();
            let own = terms.monomials.iter();
            own.map(|m| monomial_name(m, &factors(), terms.letters))
                .collect()
        };
        let study = ["A", "B", "C", "AB", "AC", "BC", "B^2"];
        assert_eq!(names("A + B + C + AB + AC + BC + B^2"), study);
        assert_eq!(names("A+B+C+A:B+A:C+B:C+B²"), study);
        assert_eq!(names("(A + B + C)^2 + B^2"), study);
        assert_eq!(names("k + e + k:e + e^2"), ["k", "e", "k:e", "e^2"]);
        assert_eq!(names("linear"), ["A", "B", "C"]);
        assert_eq!(names("2fi").len(), 6);
        assert_eq!(
            names("quadratic")[6..],
            ["A^2", "B^2", "C^2"].map(str::to_owned)
        );
        assert_eq!(names("cubic").len(), 19);
        assert_eq!(names("A + A^2:B + AB^2"), ["A", "AB^2", "A^2B"]);
    }

    #[test]
    fn rejects_what_is_no_factor() {
        for text in [
            "A + D",
            "k + log(e)",
            "A + 2",
            "0 + A",
            "A^9",
            "A^0.5",
            "y ~ A",
        ] {
            assert!(surface_terms(text, &factors()).is_err(), "{text}");
        }
        let swapped = ["B", "A"].map(str::to_owned);
        assert!(surface_terms("A + B", &swapped).is_err());
    }

    #[test]
    fn closed_form_hierarchy() {
        let hierarchical =
            |text: &str| is_hierarchical(&surface_terms(text, &factors()).unwrap().monomials);
        assert!(hierarchical("quadratic") && hierarchical("A + B + AB"));
        assert!(!hierarchical("A + AB") && !hierarchical("B^2"));
    }
}
