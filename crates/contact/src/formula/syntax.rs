//! A force formula as text → its tree: `k*x^1.5 + c*sqrt(x)*v`.

use crate::formula::error::{FormulaError, FormulaPlace};
use std::ops::Range;
use windfall_numerics::unit::nearest_name::nearest_names;

/// Deepest nesting of parentheses, signs and powers.
const DEEPEST: usize = 64;

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Function {
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Tanh,
    Atan,
    Abs,
}

const FUNCTIONS: [(&str, Function); 10] = [
    ("sqrt", Function::Sqrt),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("tanh", Function::Tanh),
    ("atan", Function::Atan),
    ("abs", Function::Abs),
];

/// Names of functions of more than one argument.
const OTHERS: [&str; 3] = ["min", "max", "if"];

/// Names of what a contact remembers.
pub(crate) const REMEMBERED: [&str; 2] = ["x_max", "F_max"];

/// Whether a parameter may not have this name.
pub(crate) fn is_reserved(name: &str) -> bool {
    let functions = FUNCTIONS.iter().map(|(name, _)| *name);
    let mut reserved = functions.chain(OTHERS).chain(["x", "v", "pi", "F"]);
    reserved.any(|known| known == name)
}

/// An operation of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

/// A formula or a part of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Term {
    pub what: What,
    /// Bytes of the text that it fills.
    pub span: Range<usize>,
}

/// What a term is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum What {
    Number(f64),
    Displacement,
    Rate,
    /// Largest displacement so far.
    Peak,
    /// Force at rest at the largest displacement so far.
    PeakForce,
    Parameter(usize),
    Negative(Box<Term>),
    Binary(Operator, Box<Term>, Box<Term>),
    Call(Function, Box<Term>),
    Smaller(Box<Term>, Box<Term>),
    Larger(Box<Term>, Box<Term>),
    /// `if(left > right, then, otherwise)`; `strict` is false for `>=`.
    If {
        left: Box<Term>,
        right: Box<Term>,
        strict: bool,
        then: Box<Term>,
        otherwise: Box<Term>,
    },
}

/// Reads a formula; `F =` before it is accepted.
pub(crate) fn parse_formula(text: &str, parameters: &[String]) -> Result<Term, FormulaError> {
    parse(text, parameters, false)
}

/// Reads the formula of unloading, which may name what the contact remembers.
pub(crate) fn parse_unloading(text: &str, parameters: &[String]) -> Result<Term, FormulaError> {
    parse(text, parameters, true)
}

fn parse(text: &str, parameters: &[String], memory: bool) -> Result<Term, FormulaError> {
    let mut cursor = Cursor {
        text,
        at: 0,
        parameters,
        memory,
        depth: 0,
    };
    cursor.skip_left_side();
    let term = cursor.sum()?;
    cursor.skip_spaces();
    match cursor.rest().is_empty() {
        true => Ok(term),
        false => Err(cursor.expected("an operator (+ - * / ^) or the end of the formula")),
    }
}

struct Cursor<'a> {
    text: &'a str,
    at: usize,
    parameters: &'a [String],
    /// Whether [`REMEMBERED`] are known.
    memory: bool,
    depth: usize,
}

impl<'a> Cursor<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip_spaces(&mut self) {
        self.at = self.text.len() - self.rest().trim_start().len();
    }

    fn skip_left_side(&mut self) {
        let rest = self.text.trim_start();
        if let Some(right) = rest.strip_prefix('F').map(str::trim_start)
            && let Some(right) = right.strip_prefix('=')
        {
            self.at = self.text.len() - right.len();
        }
    }

    fn take(&mut self, wanted: &str) -> bool {
        self.skip_spaces();
        let found = self.rest().starts_with(wanted);
        if found {
            self.at += wanted.len();
        }
        found
    }

    fn expected(&self, expected: &'static str) -> FormulaError {
        FormulaError::Syntax {
            expected,
            found: match self.rest().chars().next() {
                Some(c) => format!("\"{c}\""),
                None => "the end".into(),
            },
            place: FormulaPlace::new(self.text, self.at),
        }
    }

    fn nested<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, FormulaError>,
    ) -> Result<T, FormulaError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.expected("fewer parentheses, signs or powers within each other"));
        }
        let out = read(self);
        self.depth -= 1;
        out
    }

    fn sum(&mut self) -> Result<Term, FormulaError> {
        let mut left = self.product()?;
        loop {
            let operator = match () {
                () if self.take("+") => Operator::Plus,
                () if self.take("-") => Operator::Minus,
                () => return Ok(left),
            };
            left = binary(operator, left, self.product()?);
        }
    }

    fn product(&mut self) -> Result<Term, FormulaError> {
        let mut left = self.signed()?;
        loop {
            self.skip_spaces();
            let operator = match () {
                () if self.take("*") || self.take("·") => Operator::Times,
                () if self.take("/") => Operator::Over,
                () => return Ok(left),
            };
            left = binary(operator, left, self.signed()?);
        }
    }

    fn signed(&mut self) -> Result<Term, FormulaError> {
        self.skip_spaces();
        let start = self.at;
        if self.take("+") {
            return self.nested(Self::signed);
        }
        if self.take("-") {
            let inner = self.nested(Self::signed)?;
            let span = start..inner.span.end;
            let what = What::Negative(Box::new(inner));
            return Ok(Term { what, span });
        }
        self.power()
    }

    fn power(&mut self) -> Result<Term, FormulaError> {
        let base = self.atom()?;
        if self.take("^") || self.take("**") {
            let exponent = self.nested(Self::signed)?;
            return Ok(binary(Operator::Power, base, exponent));
        }
        Ok(base)
    }

    fn atom(&mut self) -> Result<Term, FormulaError> {
        self.skip_spaces();
        let start = self.at;
        if self.take("(") {
            let mut inner = self.nested(Self::sum)?;
            self.close()?;
            inner.span = start..self.at;
            return Ok(inner);
        }
        match self.rest().chars().next() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.named(),
            _ => Err(self.expected("a number, x, v, a parameter, a function or \"(\"")),
        }
    }

    fn close(&mut self) -> Result<(), FormulaError> {
        match self.take(")") {
            true => Ok(()),
            false => Err(self.expected("an operator or \")\"")),
        }
    }

    fn number(&mut self) -> Result<Term, FormulaError> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
            at
        };
        let mut end = digits(start);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            if digits(sign) > sign {
                end = digits(sign);
            }
        }
        let value: Result<f64, _> = self.text[start..end].parse();
        match value {
            Ok(value) if value.is_finite() => {
                self.at = end;
                let what = What::Number(value);
                Ok(Term {
                    what,
                    span: start..end,
                })
            }
            _ => Err(self.expected("a finite number such as 1.5 or 4e5")),
        }
    }

    fn named(&mut self) -> Result<Term, FormulaError> {
        let start = self.at;
        let rest = self.rest();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        let name = &rest[..end.unwrap_or(rest.len())];
        self.at += name.len();
        let parameter = self.parameters.iter().position(|known| known == name);
        let what = match name {
            _ if self.take("(") => return self.call(name, start),
            "x" => What::Displacement,
            "v" => What::Rate,
            "pi" => What::Number(std::f64::consts::PI),
            "x_max" if self.memory => What::Peak,
            "F_max" if self.memory => What::PeakForce,
            _ => match parameter {
                Some(index) => What::Parameter(index),
                None => return Err(self.unknown(name, start)),
            },
        };
        let span = start..start + name.len();
        Ok(Term { what, span })
    }

    fn unknown(&self, name: &str, start: usize) -> FormulaError {
        let functions = FUNCTIONS.iter().map(|(name, _)| *name).chain(OTHERS);
        let remembered = REMEMBERED.iter().filter(|_| self.memory);
        let known: Vec<&str> = ["x", "v", "pi"]
            .into_iter()
            .chain(remembered.copied())
            .chain(self.parameters.iter().map(String::as_str))
            .chain(functions)
            .collect();
        let nearest = nearest_names(name, known.iter().copied());
        FormulaError::UnknownName {
            name: name.into(),
            nearest: nearest.into_iter().map(str::to_owned).collect(),
            known: known.into_iter().map(str::to_owned).collect(),
            place: FormulaPlace::new(self.text, start),
        }
    }

    /// The arguments of a function, behind its opening parenthesis.
    fn call(&mut self, name: &str, start: usize) -> Result<Term, FormulaError> {
        if name == "if" {
            return self.nested(|cursor| cursor.choice(start));
        }
        let function = FUNCTIONS.iter().find(|(known, _)| *known == name);
        let known = function
            .map(|(known, _)| *known)
            .or(OTHERS.into_iter().find(|known| *known == name));
        let Some(known) = known else {
            return Err(self.unknown(name, start));
        };
        let mut arguments = vec![self.nested(Self::sum)?];
        while self.take(",") {
            arguments.push(self.nested(Self::sum)?);
        }
        self.close()?;
        let expected = if function.is_some() { 1 } else { 2 };
        let found = arguments.len();
        let mut arguments = arguments.into_iter().map(Box::new);
        let what = match (function, arguments.next(), arguments.next(), found) {
            (Some((_, function)), Some(only), None, 1) => What::Call(*function, only),
            (None, Some(first), Some(second), 2) if known == "min" => What::Smaller(first, second),
            (None, Some(first), Some(second), 2) => What::Larger(first, second),
            _ => {
                return Err(FormulaError::ArgumentCount {
                    function: known,
                    expected,
                    found,
                    place: FormulaPlace::new(self.text, start),
                });
            }
        };
        let span = start..self.at;
        Ok(Term { what, span })
    }

    /// `left > right, then, otherwise)`.
    fn choice(&mut self, start: usize) -> Result<Term, FormulaError> {
        let left = self.sum()?;
        let (greater, strict) = match () {
            () if self.take(">=") => (true, false),
            () if self.take(">") => (true, true),
            () if self.take("<=") => (false, false),
            () if self.take("<") => (false, true),
            () => return Err(self.expected("a comparison (> >= < <=)")),
        };
        let right = self.sum()?;
        let comma = "\",\": if takes a comparison and two values, as in if(x > d, 0, k*x)";
        if !self.take(",") {
            return Err(self.expected(comma));
        }
        let then = Box::new(self.sum()?);
        if !self.take(",") {
            return Err(self.expected(comma));
        }
        let otherwise = Box::new(self.sum()?);
        self.close()?;
        let (left, right) = match greater {
            true => (left, right),
            false => (right, left),
        };
        let what = What::If {
            left: Box::new(left),
            right: Box::new(right),
            strict,
            then,
            otherwise,
        };
        let span = start..self.at;
        Ok(Term { what, span })
    }
}

fn binary(operator: Operator, left: Term, right: Term) -> Term {
    let span = left.span.start..right.span.end;
    let what = What::Binary(operator, Box::new(left), Box::new(right));
    Term { what, span }
}
