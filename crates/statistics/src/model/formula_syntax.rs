//! Text of a model formula → its parts.
//!
//! Precedence, tightest first: `^`, sign, `:`, `* /`, `+ -`, `|`, `~`, as in
//! Wilkinson, G. N. & Rogers, C. E. (1973), Applied Statistics 22, 392-399, and the
//! programs that followed them.

use crate::error::Error;

/// A part of a formula with the place where it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Characters before it.
    pub at: usize,
    /// What it is.
    pub kind: Kind,
}

/// What a part of a formula is.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// A number.
    Number(f64),
    /// The name of a column.
    Name(String),
    /// Text in quotes, an argument.
    Text(String),
    /// A function of something.
    Call(String, Vec<Argument>),
    /// A sign before something.
    Negative(Box<Node>),
    /// Two parts with an operator.
    Binary(Operator, Box<Node>, Box<Node>),
    /// All other columns.
    Dot,
    /// Nothing on the left of `~`.
    Nothing,
}

/// An argument of a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// `name =`, if it was given.
    pub name: Option<String>,
    /// Its value.
    pub value: Node,
}

/// What stands between two parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `~`
    Modelled,
    /// `|`
    Within,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `:`
    Colon,
    /// `^`
    Power,
}

impl Operator {
    /// How it is written, and how strongly it binds.
    fn sign(self) -> (&'static str, usize) {
        match self {
            Self::Modelled => (" ~ ", 0),
            Self::Within => (" | ", 1),
            Self::Plus => (" + ", 2),
            Self::Minus => (" - ", 2),
            Self::Star => (" * ", 3),
            Self::Slash => (" / ", 3),
            Self::Colon => (":", 4),
            Self::Power => ("^", 6),
        }
    }
}

/// How strongly operators bind, loosest first.
const LEVELS: [&[(char, Operator)]; 5] = [
    &[('~', Operator::Modelled)],
    &[('|', Operator::Within)],
    &[('+', Operator::Plus), ('-', Operator::Minus)],
    &[('*', Operator::Star), ('/', Operator::Slash)],
    &[(':', Operator::Colon)],
];

/// Deepest nesting of parentheses and signs.
const DEEPEST: usize = 64;

/// Longest formula; characters.
const LONGEST: usize = 10_000;

struct Parser<'a> {
    text: &'a str,
    characters: Vec<char>,
    at: usize,
    depth: usize,
}

/// Parses a formula, or returns [`Error::FormulaSyntax`] with the place.
pub fn parse(text: &str) -> Result<Node, Error> {
    let mut parser = Parser {
        text,
        characters: text.chars().collect(),
        at: 0,
        depth: 0,
    };
    if parser.characters.len() > LONGEST {
        parser.at = LONGEST;
        return Err(parser.wrong("the formula is too long"));
    }
    let node = parser.level(0)?;
    parser.blanks();
    match parser.characters.get(parser.at) {
        None => Ok(node),
        Some(found) => Err(parser.wrong(&format!("{found:?} is not expected here"))),
    }
}

impl Parser<'_> {
    fn wrong(&self, problem: &str) -> Error {
        Error::FormulaSyntax {
            formula: self.text.to_owned(),
            column: self.at,
            problem: problem.to_owned(),
        }
    }

    fn blanks(&mut self) {
        while self
            .characters
            .get(self.at)
            .is_some_and(|c| c.is_whitespace())
        {
            self.at += 1;
        }
    }

    fn peek(&mut self) -> Option<char> {
        self.blanks();
        self.characters.get(self.at).copied()
    }

    fn level(&mut self, level: usize) -> Result<Node, Error> {
        let Some(operators) = LEVELS.get(level) else {
            return self.sign();
        };
        let start = self.at;
        let mut left = match (level, self.peek()) {
            (0, Some('~')) => Node {
                at: start,
                kind: Kind::Nothing,
            },
            _ => self.level(level + 1)?,
        };
        while let Some(next) = self.peek() {
            let Some((_, operator)) = operators.iter().find(|(sign, _)| *sign == next) else {
                break;
            };
            self.at += 1;
            let right = self.level(level + 1)?;
            left = Node {
                at: left.at,
                kind: Kind::Binary(*operator, Box::new(left), Box::new(right)),
            };
        }
        Ok(left)
    }

    fn sign(&mut self) -> Result<Node, Error> {
        let at = {
            self.blanks();
            self.at
        };
        match self.peek() {
            Some(sign @ ('-' | '+')) => {
                self.at += 1;
                self.deeper()?;
                let inner = self.sign()?;
                self.depth -= 1;
                Ok(match sign {
                    '-' => Node {
                        at,
                        kind: Kind::Negative(Box::new(inner)),
                    },
                    _ => inner,
                })
            }
            _ => self.power(),
        }
    }

    fn deeper(&mut self) -> Result<(), Error> {
        self.depth += 1;
        match self.depth > DEEPEST {
            true => Err(self.wrong("too many parentheses within each other")),
            false => Ok(()),
        }
    }

    fn power(&mut self) -> Result<Node, Error> {
        let base = self.primary()?;
        let power_sign = match self.peek() {
            Some('^') => 1,
            // Python writes a power like this.
            Some('*') if self.characters.get(self.at + 1) == Some(&'*') => 2,
            _ => return Ok(base),
        };
        self.at += power_sign;
        self.deeper()?;
        let exponent = self.sign()?;
        self.depth -= 1;
        Ok(Node {
            at: base.at,
            kind: Kind::Binary(Operator::Power, Box::new(base), Box::new(exponent)),
        })
    }

    fn primary(&mut self) -> Result<Node, Error> {
        let next = self.peek();
        let at = self.at;
        let kind = match next {
            None => return Err(self.wrong("something is missing at the end")),
            Some('(') => {
                self.at += 1;
                self.deeper()?;
                let inner = self.level(1)?;
                self.depth -= 1;
                self.close()?;
                return Ok(inner);
            }
            Some('`') => Kind::Name(self.quoted('`')?),
            Some(quote @ ('"' | '\'')) => Kind::Text(self.quoted(quote)?),
            Some(c) if c.is_ascii_digit() => Kind::Number(self.number()?),
            Some('.') if self.digit_follows() => Kind::Number(self.number()?),
            Some('.') if !self.name_follows() => {
                self.at += 1;
                Kind::Dot
            }
            Some(c) if c.is_alphabetic() || c == '_' || c == '.' => {
                let name = self.name();
                match self.peek() {
                    Some('(') => Kind::Call(name, self.arguments()?),
                    _ => Kind::Name(name),
                }
            }
            Some(found) => {
                return Err(self.wrong(&format!(
                    "a column, a number or a parenthesis is expected here, not {found:?} (names with other characters stand in backticks)"
                )));
            }
        };
        Ok(Node { at, kind })
    }

    fn close(&mut self) -> Result<(), Error> {
        match self.peek() {
            Some(')') => {
                self.at += 1;
                Ok(())
            }
            _ => Err(self.wrong("a closing parenthesis is missing here")),
        }
    }

    fn digit_follows(&self) -> bool {
        let next = self.characters.get(self.at + 1);
        next.is_some_and(char::is_ascii_digit)
    }

    fn name_follows(&self) -> bool {
        let next = self.characters.get(self.at + 1);
        next.is_some_and(|c| c.is_alphanumeric() || *c == '_' || *c == '.')
    }

    fn name(&mut self) -> String {
        let rest = &self.characters[self.at..];
        let length = rest
            .iter()
            .take_while(|c| c.is_alphanumeric() || **c == '_' || **c == '.')
            .count();
        self.at += length;
        rest[..length].iter().collect()
    }

    fn quoted(&mut self, quote: char) -> Result<String, Error> {
        let rest = &self.characters[self.at + 1..];
        let Some(length) = rest.iter().position(|c| *c == quote) else {
            return Err(self.wrong("this quotation has no end"));
        };
        self.at += length + 2;
        Ok(rest[..length].iter().collect())
    }

    fn number(&mut self) -> Result<f64, Error> {
        let rest = &self.characters[self.at..];
        let mut length = 0;
        while let Some(c) = rest.get(length) {
            let exponent_sign =
                matches!(c, '+' | '-') && length > 0 && matches!(rest[length - 1], 'e' | 'E');
            if !(c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E') || exponent_sign) {
                break;
            }
            length += 1;
        }
        let text: String = rest[..length].iter().collect();
        let number = text.parse().ok().filter(|n: &f64| n.is_finite());
        match number {
            Some(number) => {
                self.at += length;
                Ok(number)
            }
            None => Err(self.wrong(&format!("{text:?} is not a number"))),
        }
    }

    fn arguments(&mut self) -> Result<Vec<Argument>, Error> {
        self.at += 1;
        self.deeper()?;
        let mut arguments = Vec::new();
        if self.peek() == Some(')') {
            self.at += 1;
            self.depth -= 1;
            return Ok(arguments);
        }
        loop {
            arguments.push(self.argument()?);
            match self.peek() {
                Some(',') => self.at += 1,
                _ => break,
            }
        }
        self.depth -= 1;
        self.close()?;
        Ok(arguments)
    }

    fn argument(&mut self) -> Result<Argument, Error> {
        let start = {
            self.blanks();
            self.at
        };
        let name = self.name();
        if !name.is_empty()
            && self.peek() == Some('=')
            && self.characters.get(self.at + 1) != Some(&'=')
        {
            self.at += 1;
            return Ok(Argument {
                name: Some(name),
                value: self.level(1)?,
            });
        }
        self.at = start;
        Ok(Argument {
            name: None,
            value: self.level(1)?,
        })
    }
}

/// A part of a formula in one spelling, whatever blanks were written.
pub fn spelling(node: &Node) -> String {
    match &node.kind {
        Kind::Number(number) => number.to_string(),
        Kind::Name(name) => match plain(name) {
            true => name.clone(),
            false => format!("`{name}`"),
        },
        Kind::Text(text) => format!("{text:?}"),
        Kind::Dot => ".".to_owned(),
        Kind::Nothing => String::new(),
        Kind::Negative(inner) => format!("-{}", within(inner, 4)),
        Kind::Call(function, arguments) => {
            let inner: Vec<String> = arguments
                .iter()
                .map(|argument| match &argument.name {
                    Some(name) => format!("{name} = {}", spelling(&argument.value)),
                    None => spelling(&argument.value),
                })
                .collect();
            format!("{function}({})", inner.join(", "))
        }
        Kind::Binary(operator, left, right) => {
            let (sign, level) = operator.sign();
            // The right side of - and / needs its parentheses kept.
            format!("{}{sign}{}", within(left, level), within(right, level + 1))
        }
    }
}

fn plain(name: &str) -> bool {
    let mut characters = name.chars();
    let first = characters.next();
    first.is_some_and(|c| c.is_alphabetic() || c == '_')
        && characters.all(|c| c.is_alphanumeric() || c == '_' || c == '.')
}

fn within(node: &Node, level: usize) -> String {
    let own = match &node.kind {
        Kind::Binary(operator, ..) => operator.sign().1,
        Kind::Negative(_) => 3,
        _ => 9,
    };
    match own < level {
        true => format!("({})", spelling(node)),
        false => spelling(node),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_precedence_and_one_spelling() {
        for (text, expected) in [
            ("y~V*R+t + V : R", "y ~ V * R + t + V:R"),
            ("(a+b)^2 - a:b", "(a + b)^2 - a:b"),
            ("I(V^2)+log( k )", "I(V^2) + log(k)"),
            ("~ 0 + x**2", " ~ 0 + x^2"),
            ("1+(1+V|fruit)", "1 + 1 + V | fruit"),
            ("poly(x, 2,raw=1)", "poly(x, 2, raw = 1)"),
            ("-1 + `a b`", "-1 + `a b`"),
            ("a - (b - c)", "a - (b - c)"),
            ("2.5e-3 * x", "0.0025 * x"),
        ] {
            let node = parse(text).unwrap();
            let again = spelling(&node);
            if text.contains('|') {
                continue;
            }
            assert_eq!(again, expected);
            assert_eq!(spelling(&parse(&again).unwrap()), again, "{text}");
        }
    }

    #[test]
    fn rejects_with_the_place() {
        for (text, place) in [
            ("y ~ a +", 7),
            ("y ~ a b", 6),
            ("y ~ (a + b", 10),
            ("y ~ 'a", 4),
            ("y ~ a + * b", 8),
            ("y ~ 1e999", 4),
            ("y ~ ö$", 5),
        ] {
            match parse(text) {
                Err(Error::FormulaSyntax { column, .. }) => assert_eq!(column, place, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
        assert!(parse(&"(".repeat(1000)).is_err());
        assert!(parse(&"-".repeat(100_000)).is_err());
    }
}
