//! Model formulas: response, terms, random parts.
//!
//! As in R and patsy but for one thing: the power of a single column is the number
//! squared (`V^2` is `I(V^2)`), where those silently take `V`; the power of a sum
//! crosses (`(a + b)^2` is `a + b + a:b`).

use crate::error::Error;
use crate::model::formula_syntax::{Kind, Node, Operator, parse, spelling};

const MOST_TERMS: usize = 2000;

/// A formula with its terms multiplied out.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    /// What is modelled; `None` where only the right side was given.
    pub response: Option<Node>,
    /// Columns and functions of them, each once.
    pub atoms: Vec<Atom>,
    /// Products of atoms, in the order of their degree; without the intercept.
    pub terms: Vec<Term>,
    /// Whether there is an intercept.
    pub intercept: bool,
    /// Random parts.
    pub random: Vec<RandomPart>,
}

/// A column or a function of columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Atom {
    /// Its one spelling.
    pub name: String,
    /// What it is.
    pub node: Node,
}

/// A product of atoms, as their positions in increasing order.
pub type Term = Vec<usize>;

/// `(terms | groups)`.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomPart {
    /// Terms that vary between groups.
    pub terms: Vec<Term>,
    /// Whether the intercept does.
    pub intercept: bool,
    /// Columns that name the groups, crossed with each other.
    pub groups: Vec<String>,
}

struct Expansion<'a> {
    text: &'a str,
    others: &'a [String],
    atoms: Vec<Atom>,
    random: Vec<RandomPart>,
    intercept: bool,
}

/// Parses a formula and multiplies it out.
///
/// * `columns`: what `.` stands for, without the response
///
/// # Errors
/// [`Error::FormulaSyntax`] with the place.
///
/// ```
/// use windfall_statistics::model::formula::{formula, term_name};
/// let formula = formula("k ~ V*R + t + V^2", &[]).unwrap();
/// let names: Vec<String> = formula.terms.iter().map(|t| term_name(&formula.atoms, t)).collect();
/// assert_eq!(names, ["V", "R", "t", "V^2", "V:R"]);
/// ```
pub fn formula(text: &str, columns: &[String]) -> Result<Formula, Error> {
    let node = parse(text)?;
    let (response, right) = match node.kind {
        Kind::Binary(Operator::Modelled, left, right) => match left.kind {
            Kind::Nothing => (None, *right),
            Kind::Binary(Operator::Modelled, ..) => {
                return Err(wrong(text, left.at, "a formula has one ~"));
            }
            _ => (Some(*left), *right),
        },
        _ => (None, node),
    };
    let name = response.as_ref().map(spelling);
    let others: Vec<String> = columns
        .iter()
        .filter(|column| Some(*column) != name.as_ref())
        .cloned()
        .collect();
    let mut expansion = Expansion {
        text,
        others: &others,
        atoms: Vec::new(),
        random: Vec::new(),
        intercept: true,
    };
    let mut terms = expansion.terms(&right, true)?;
    terms.sort_by_key(Vec::len);
    Ok(Formula {
        response,
        terms,
        intercept: expansion.intercept,
        atoms: expansion.atoms,
        random: expansion.random,
    })
}

/// How a term is written.
pub fn term_name(atoms: &[Atom], term: &[usize]) -> String {
    let names: Vec<&str> = term.iter().map(|atom| atoms[*atom].name.as_str()).collect();
    names.join(":")
}

fn wrong(text: &str, at: usize, problem: &str) -> Error {
    Error::FormulaSyntax {
        formula: text.to_owned(),
        column: at,
        problem: problem.to_owned(),
    }
}

fn union(mut left: Vec<Term>, right: Vec<Term>) -> Vec<Term> {
    for term in right {
        if !left.contains(&term) {
            left.push(term);
        }
    }
    left
}

fn product(left: &[Term], right: &[Term]) -> Vec<Term> {
    let mut found = Vec::new();
    for a in left {
        for b in right {
            let mut term: Term = a.iter().chain(b).copied().collect();
            term.sort_unstable();
            term.dedup();
            found = union(found, vec![term]);
        }
    }
    found
}

impl Expansion<'_> {
    fn wrong(&self, node: &Node, problem: &str) -> Error {
        wrong(self.text, node.at, problem)
    }

    fn atom(&mut self, node: &Node) -> Vec<Term> {
        let name = spelling(node);
        let known = self.atoms.iter().position(|atom| atom.name == name);
        let position = known.unwrap_or_else(|| {
            self.atoms.push(Atom {
                name,
                node: node.clone(),
            });
            self.atoms.len() - 1
        });
        vec![vec![position]]
    }

    /// * `top`: not within a product, so that an intercept may be meant
    fn terms(&mut self, node: &Node, top: bool) -> Result<Vec<Term>, Error> {
        let found = match &node.kind {
            Kind::Name(_) | Kind::Call(..) => self.atom(node),
            Kind::Dot => {
                let others = self.others.to_vec();
                let nodes = others.into_iter().map(|name| Node {
                    at: node.at,
                    kind: Kind::Name(name),
                });
                nodes.fold(Vec::new(), |terms, node| union(terms, self.atom(&node)))
            }
            Kind::Number(number) if top && (*number == 1.0 || *number == 0.0) => {
                self.intercept = *number == 1.0;
                Vec::new()
            }
            Kind::Negative(inner) if top => {
                let rest = self.without(Vec::new(), inner)?;
                debug_assert!(rest.is_empty());
                rest
            }
            Kind::Binary(operator, left, right) => {
                self.binary(node, *operator, left, right, top)?
            }
            Kind::Number(_) | Kind::Negative(_) => {
                return Err(self.wrong(
                    node,
                    "a number is no term: 1 and 0 stand for the intercept, calculations go into I( )",
                ));
            }
            Kind::Text(_) => {
                return Err(self.wrong(
                    node,
                    "text is no term; names of columns with other characters stand in backticks",
                ));
            }
            Kind::Nothing => return Err(self.wrong(node, "a term is missing here")),
        };
        match found.len() > MOST_TERMS {
            true => Err(self.wrong(node, &format!("this makes more than {MOST_TERMS} terms"))),
            false => Ok(found),
        }
    }

    fn binary(
        &mut self,
        node: &Node,
        operator: Operator,
        left: &Node,
        right: &Node,
        top: bool,
    ) -> Result<Vec<Term>, Error> {
        Ok(match operator {
            Operator::Plus => {
                let first = self.terms(left, top)?;
                union(first, self.terms(right, top)?)
            }
            Operator::Minus => {
                let first = self.terms(left, top)?;
                self.without(first, right)?
            }
            Operator::Colon => {
                let first = self.terms(left, false)?;
                product(&first, &self.terms(right, false)?)
            }
            Operator::Star => {
                let first = self.terms(left, false)?;
                let second = self.terms(right, false)?;
                let both = product(&first, &second);
                union(union(first, second), both)
            }
            Operator::Slash => {
                let first = self.terms(left, false)?;
                let second = self.terms(right, false)?;
                let mut all: Term = first.iter().flatten().copied().collect();
                all.sort_unstable();
                all.dedup();
                let nested = product(&[all], &second);
                union(first, nested)
            }
            Operator::Power => self.power(node, left, right)?,
            Operator::Within => {
                self.random_part(left, right)?;
                Vec::new()
            }
            Operator::Modelled => return Err(self.wrong(node, "~ does not stand in a term")),
        })
    }

    fn without(&mut self, terms: Vec<Term>, taken: &Node) -> Result<Vec<Term>, Error> {
        if let Kind::Number(number) = taken.kind {
            return match number {
                1.0 => {
                    self.intercept = false;
                    Ok(terms)
                }
                0.0 => {
                    self.intercept = true;
                    Ok(terms)
                }
                _ => Err(self.wrong(taken, "only terms and 1, the intercept, can be taken out")),
            };
        }
        let known = self.atoms.len();
        let gone = self.terms(taken, false)?;
        self.atoms.truncate(known);
        Ok(terms.into_iter().filter(|t| !gone.contains(t)).collect())
    }

    fn power(&mut self, node: &Node, base: &Node, exponent: &Node) -> Result<Vec<Term>, Error> {
        if matches!(base.kind, Kind::Name(_)) {
            // Checked here, so that the message has its place.
            match exponent.kind {
                Kind::Number(_) | Kind::Negative(_) => return Ok(self.atom(node)),
                _ => return Err(self.wrong(exponent, "the power of a column is a number")),
            }
        }
        let times = match exponent.kind {
            Kind::Number(n) if (1.0..=10.0).contains(&n) && n.fract() == 0.0 => n as usize,
            _ => {
                return Err(self.wrong(
                    exponent,
                    "the power of a sum is a whole number from 1 to 10; calculations go into I( )",
                ));
            }
        };
        let first = self.terms(base, false)?;
        let mut found = first.clone();
        for _ in 1..times {
            let next = union(found.clone(), product(&found, &first));
            if next.len() > MOST_TERMS {
                return Err(self.wrong(node, &format!("this makes more than {MOST_TERMS} terms")));
            }
            found = next;
        }
        Ok(found)
    }

    fn random_part(&mut self, left: &Node, right: &Node) -> Result<(), Error> {
        let outer = std::mem::replace(&mut self.intercept, true);
        let terms = self.terms(left, true)?;
        let intercept = std::mem::replace(&mut self.intercept, outer);
        for groups in self.groups(right)? {
            self.random.push(RandomPart {
                terms: terms.clone(),
                intercept,
                groups,
            });
        }
        Ok(())
    }

    /// `a`, `a:b`, `a/b` = a and a:b, sums of these.
    fn groups(&self, node: &Node) -> Result<Vec<Vec<String>>, Error> {
        Ok(match &node.kind {
            Kind::Name(name) => vec![vec![name.clone()]],
            Kind::Binary(Operator::Plus, left, right) => {
                let mut found = self.groups(left)?;
                found.extend(self.groups(right)?);
                found
            }
            Kind::Binary(Operator::Colon, left, right) => {
                let right = self.groups(right)?;
                let both = self.groups(left)?.into_iter().flat_map(|a| {
                    let joined = |b: &Vec<String>| a.iter().chain(b).cloned().collect();
                    right.iter().map(joined).collect::<Vec<_>>()
                });
                both.collect()
            }
            Kind::Binary(Operator::Slash, left, right) => {
                let outer = self.groups(left)?;
                let all: Vec<String> = outer.iter().flatten().cloned().collect();
                let mut unique: Vec<String> = Vec::new();
                for name in all {
                    if !unique.contains(&name) {
                        unique.push(name);
                    }
                }
                let mut found = outer;
                for inner in self.groups(right)? {
                    found.push(unique.iter().cloned().chain(inner).collect());
                }
                found
            }
            _ => {
                return Err(self.wrong(
                    node,
                    "groups are columns, a:b for pairs of them, or a/b for b within a",
                ));
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> (Vec<String>, bool) {
        let columns = ["y", "a", "b"].map(str::to_owned);
        let found = formula(text, &columns).unwrap();
        let names = found.terms.iter().map(|t| term_name(&found.atoms, t));
        (names.collect(), found.intercept)
    }

    /// Expansions as R's terms() gives them.
    #[test]
    fn reference_expansions() {
        for (text, expected, intercept) in [
            ("y ~ a*b*c", "a b c a:b a:c b:c a:b:c", true),
            ("y ~ (a + b + c)^2", "a b c a:b a:c b:c", true),
            ("y ~ a*b - a", "b a:b", true),
            ("y ~ 0 + a", "a", false),
            ("y ~ a - 1", "a", false),
            ("y ~ -1 + a", "a", false),
            ("y ~ a/b", "a a:b", true),
            ("y ~ (a + b)/c", "a b a:b:c", true),
            ("y ~ a:b + a", "a a:b", true),
            ("y ~ a + a:a + b:a", "a a:b", true),
            ("y ~ .", "a b", true),
            ("y ~ log(a) + exp(b)", "log(a) exp(b)", true),
            ("y ~ 1", "", true),
            ("a^2 + a + b:a", "a^2 a a:b", true),
        ] {
            let (found, with) = names(text);
            let expected: Vec<&str> = expected.split_whitespace().collect();
            assert_eq!(found, expected, "{text}");
            assert_eq!(with, intercept, "{text}");
        }
    }

    #[test]
    fn closed_form_random_parts() {
        let found = formula("y ~ V + (1 + V | fruit) + (0 + V | day) + (1 | a/b)", &[]).unwrap();
        assert_eq!(found.terms.len(), 1);
        assert!(found.intercept);
        let parts: Vec<(bool, usize, String)> = found
            .random
            .iter()
            .map(|part| (part.intercept, part.terms.len(), part.groups.join(":")))
            .collect();
        let expected = [
            (true, 1, "fruit".to_owned()),
            (false, 1, "day".to_owned()),
            (true, 0, "a".to_owned()),
            (true, 0, "a:b".to_owned()),
        ];
        assert_eq!(parts, expected);
    }

    #[test]
    fn rejects_what_is_no_term() {
        for text in [
            "y ~ 2",
            "y ~ a + 3*b",
            "y ~ (a+b)^0.5",
            "y ~ 'a'",
            "a ~ b ~ c",
            "y ~ a^b",
            "y ~ (1 | 3)",
        ] {
            assert!(formula(text, &[]).is_err(), "{text}");
        }
    }
}
