//! A law that the user wrote: a compiled formula, or a table.

use crate::formula::program::{CONSTANTS, Program};
use crate::granular_law::GranularLaw;
use crate::law::{ContactForce, ContactLaw};
use crate::laws::any_law_size::LARGEST_PARAMETERS;
use crate::laws::force_table::ForceTable;
use crate::laws::user_finding::UserLawFinding;
use crate::parameter::LawDescription;
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};
use windfall_numerics::monotone_cubic::MonotoneCubic;
use windfall_numerics::real::Real;

/// A parameter of a user's law, as it is declared.
#[derive(Clone, Debug, PartialEq)]
pub struct UserParameter {
    /// Name in the formula, in law expressions and in results.
    pub name: String,
    /// SI unit; exponents may be named: "N/m^n".
    pub unit: String,
    /// What it is, in a few words.
    pub meaning: String,
    /// Smallest value; SI.
    pub lower: f64,
    /// Largest value; SI.
    pub upper: f64,
    /// Where a fit begins; SI.
    pub start: Option<f64>,
    /// Value taken where an expression leaves it out, and held in a fit; SI.
    pub default: Option<f64>,
}

/// How the force of a user's law is given.
#[derive(Clone, Debug, PartialEq)]
pub enum UserForce {
    /// A formula in x (m), v (m/s) and the parameters; N.
    Formula(String),
    /// Formulas of loading, and of unloading and reloading below the largest displacement so
    /// far: in x, v, `x_max` (m), `F_max` (N) and the parameters; N.
    WithMemory {
        /// Of loading.
        force: String,
        /// Below the largest displacement so far.
        unloading: String,
    },
    /// A table, with the parameters `scale` and `damping_scale`.
    Table(ForceTable),
}

/// A law as the user declares it.
#[derive(Clone, Debug, PartialEq)]
pub struct UserLawDefinition {
    /// Name in law expressions.
    pub name: String,
    /// Its force.
    pub force: UserForce,
    /// Its parameters; none for a table.
    pub parameters: Vec<UserParameter>,
}

/// What is known of a definition once it is compiled.
#[derive(Debug)]
pub(crate) struct Known {
    pub definition: UserLawDefinition,
    /// The definition as text: equal texts are equal laws.
    pub key: String,
    pub description: LawDescription,
    pub starts: Vec<Option<f64>>,
    /// Parameters that the force is linear in and that carry it at rest, and
    /// those that carry only what depends on the rate.
    pub linear: (Vec<usize>, Vec<usize>),
    pub findings: Vec<UserLawFinding>,
    pub body: Body,
}

/// What evaluates a law.
#[derive(Debug)]
pub(crate) enum Body {
    Formula(FormulaBody),
    Table {
        force: MonotoneCubic,
        damping: Option<MonotoneCubic>,
    },
}

/// A compiled formula.
#[derive(Debug)]
pub(crate) struct FormulaBody {
    pub main: Program,
    pub prelude: Program,
    /// Constants that the prelude gives, behind the parameters.
    pub hoisted: usize,
    /// Whether the force depends on the largest displacement so far.
    pub memory: bool,
    /// Start power of the powers with known exponents.
    pub start_power: u32,
    /// For powers with an exponent among the constants: the order in x of the
    /// base, and the constant.
    pub powers: Vec<(f64, usize)>,
    /// Constant that holds the displacement at which the formula changes.
    pub kink: Option<usize>,
}

/// A user's law without its parameters: one for each distinct definition, kept
/// until the program ends.
#[derive(Clone, Copy)]
pub struct UserKind(pub(crate) &'static Known);

impl UserKind {
    /// Description of the law.
    pub fn description(self) -> &'static LawDescription {
        &self.0.description
    }

    /// The definition that it was made from.
    pub fn definition(self) -> &'static UserLawDefinition {
        &self.0.definition
    }

    /// What a reader of its results should know.
    pub fn findings(self) -> &'static [UserLawFinding] {
        &self.0.findings
    }

    /// Where a fit begins, by parameter; SI.
    pub fn starts(self) -> &'static [Option<f64>] {
        &self.0.starts
    }

    /// Parameters that the force is linear in and that carry it at rest.
    pub fn linear_at_rest(self) -> &'static [usize] {
        &self.0.linear.0
    }

    /// Parameters that the force is linear in and that carry only what depends
    /// on the rate.
    pub fn linear_in_rate(self) -> &'static [usize] {
        &self.0.linear.1
    }

    /// Displacement at which a table ends, and its force becomes linear; m.
    pub fn table_end(self) -> Option<f64> {
        match &self.0.body {
            Body::Formula(_) => None,
            Body::Table { force, .. } => Some(force.end()),
        }
    }
}

/// Name and definition: results stored for another definition are not reused.
impl fmt::Debug for UserKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.key)
    }
}

impl PartialEq for UserKind {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.0, other.0) || self.0.key == other.0.key
    }
}

impl Eq for UserKind {}

impl PartialOrd for UserKind {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for UserKind {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.key.cmp(&other.0.key)
    }
}

impl Hash for UserKind {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.key.hash(state);
    }
}

/// A user's law with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UserLaw {
    kind: UserKind,
    /// The parameters, and what follows from them alone.
    constants: [f64; CONSTANTS],
    kink: f64,
    start_power: u32,
}

impl UserLaw {
    /// The law of these parameters without a check of their bounds; `None` when
    /// there are too many or too few.
    #[inline]
    pub fn new(kind: UserKind, values: &[f64]) -> Option<Self> {
        let count = kind.0.description.parameters.len();
        if values.len() != count {
            return None;
        }
        let mut constants = [0.0; CONSTANTS];
        constants[..count].copy_from_slice(values);
        let (mut kink, mut start_power) = (f64::INFINITY, 1);
        if let Body::Formula(body) = &kind.0.body {
            let hoisted: [f64; CONSTANTS] = body.prelude.evaluate(&constants, [0.0; 3]);
            constants[count..count + body.hoisted].copy_from_slice(&hoisted[..body.hoisted]);
            start_power = body.start_power;
            for &(order, constant) in &body.powers {
                start_power = start_power.max(start_power_of(order * constants[constant]));
            }
            kink = match body.kink.map(|constant| constants[constant]) {
                Some(at) if at > 0.0 => at,
                _ => f64::INFINITY,
            };
        }
        Some(Self {
            kind,
            constants,
            kink,
            start_power,
        })
    }

    /// Which law it is.
    pub fn kind(&self) -> UserKind {
        self.kind
    }

    /// Its parameters in the order of the description; SI.
    pub fn parameters(&self) -> &[f64] {
        &self.constants[..self.kind.0.description.parameters.len()]
    }
}

/// Power q of t = s^q that makes x^exponent smooth in s, for x that begins like
/// t: half powers need 2, quarters 4. No q serves the others; 2 is what the
/// built-in power law takes.
pub(crate) fn start_power_of(exponent: f64) -> u32 {
    let whole = |times: f64| {
        let scaled = times * exponent;
        (scaled - scaled.round()).abs() < 1e-9
    };
    match () {
        () if whole(1.0) => 1,
        () if whole(2.0) => 2,
        () if whole(4.0) => 4,
        () => 2,
    }
}

/// Force, its slopes in x and v, those in the parameters, and that in the largest displacement.
pub(crate) const OUTPUTS: usize = 4 + LARGEST_PARAMETERS;

impl ContactLaw<LARGEST_PARAMETERS> for UserLaw {
    fn history(&self) -> bool {
        match &self.kind.0.body {
            Body::Formula(body) => body.memory,
            Body::Table { .. } => false,
        }
    }

    fn start_power(&self) -> u32 {
        self.start_power
    }

    fn kink(&self) -> f64 {
        self.kink
    }

    #[inline(always)]
    fn evaluate<R: Real>(&self, d: R, v: R, peak: R) -> ContactForce<R, LARGEST_PARAMETERS> {
        match &self.kind.0.body {
            Body::Formula(body) => {
                let out: [R; OUTPUTS] = body.main.evaluate(&self.constants, [d, v, peak]);
                let mut by_parameter = [d.constant(0.0); LARGEST_PARAMETERS];
                by_parameter.copy_from_slice(&out[3..OUTPUTS - 1]);
                ContactForce {
                    force: out[0],
                    by_displacement: out[1],
                    by_rate: out[2],
                    by_parameter,
                    by_peak: out[OUTPUTS - 1],
                }
            }
            Body::Table { force, damping } => {
                let plain = tabulated(&self.constants, force, damping, d.plain(), v.plain());
                plain.with_plain(d)
            }
        }
    }
}

impl UserLaw {
    pub(crate) fn granular(&self) -> Result<GranularLaw, String> {
        Err("the engine has no formulas or tables of the user".to_owned())
    }
}

#[inline(never)]
fn tabulated<R: Real>(
    constants: &[f64; CONSTANTS],
    force: &MonotoneCubic,
    damping: &Option<MonotoneCubic>,
    d: R,
    v: R,
) -> ContactForce<R, LARGEST_PARAMETERS> {
    let [scale, damping_scale] = [constants[0], constants[1]];
    let zero = d.constant(0.0);
    let elastic = d.map(|d| force.evaluate(d).0);
    let slope = d.map(|d| force.evaluate(d).1);
    let mut by_parameter = [zero; LARGEST_PARAMETERS];
    by_parameter[0] = elastic;
    let mut out = ContactForce {
        force: elastic * scale,
        by_displacement: slope * scale,
        by_rate: zero,
        by_parameter,
        by_peak: zero,
    };
    if let Some(damping) = damping {
        let factor = d.map(|d| damping.evaluate(d).0);
        let slope = d.map(|d| damping.evaluate(d).1);
        out.force = out.force + factor * v * damping_scale;
        out.by_displacement = out.by_displacement + slope * v * damping_scale;
        out.by_rate = factor * damping_scale;
        out.by_parameter[1] = factor * v;
    }
    out
}
