//! What a law says about itself: names, units, bounds, formula and source.

/// One parameter of a force law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterDescription {
    /// Name in law expressions, campaign files and results.
    pub name: &'static str,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// SI unit in the syntax of `windfall_numerics::unit`; `n` and `p` stand
    /// for the law's exponents ("N/m^n").
    pub unit: &'static str,
    /// Smallest legal value; SI.
    pub lower: f64,
    /// Largest legal value; SI.
    pub upper: f64,
    /// Typical value for fruit, the starting point when nothing better is
    /// known; SI.
    pub typical: f64,
    /// Value taken when the expression leaves the parameter out. Such a
    /// parameter is held at its value in a fit unless it is freed by name.
    pub default: Option<f64>,
}

/// One force law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawDescription {
    /// Name in law expressions.
    pub name: &'static str,
    /// Formula in plain text.
    pub formula: &'static str,
    /// Force and slope at first touch.
    pub first_touch: &'static str,
    /// Where the formula comes from.
    pub source: &'static str,
    /// Parameters, in the order of the derivatives of the law.
    pub parameters: &'static [ParameterDescription],
}
