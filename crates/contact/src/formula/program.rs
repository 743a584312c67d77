//! A graph as a flat list of operations on registers, evaluated for one number
//! or for several side by side, without allocating.

use crate::formula::graph::apply;
use crate::formula::syntax::Function;
use windfall_numerics::real::Real;

/// Constants of a law: its parameters and what follows from them alone.
pub(crate) const CONSTANTS: usize = 24;
/// Registers of a short formula, and of any.
pub(crate) const FEW_REGISTERS: usize = 16;
pub(crate) const REGISTERS: usize = 64;
/// Operands from here on are constants.
pub(crate) const FIRST_CONSTANT: u8 = 128;
/// Registers that hold x, v and the largest x so far at the start.
pub(crate) const DISPLACEMENT: u8 = 0;
pub(crate) const RATE: u8 = 1;
pub(crate) const PEAK: u8 = 2;

/// What an instruction does with a (and b, c); registers unless said otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Operation {
    /// Constant `a` in every lane.
    Constant,
    /// Literal `a` in every lane.
    Literal,
    Sum,
    /// a + constant b.
    Shifted,
    Difference,
    /// a − constant b.
    Lowered,
    /// constant a − b.
    Complement,
    Product,
    /// a · constant b.
    Scaled,
    Quotient,
    /// constant a / b.
    Over,
    Reciprocal,
    Negative,
    Root,
    /// a to the power of constant b.
    Power,
    /// a to the power of b.
    PowerOf,
    Call(Function),
    Choice,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Instruction {
    pub operation: Operation,
    pub target: u8,
    pub a: u8,
    pub b: u8,
    pub c: u8,
}

/// Operations in the order of their evaluation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Program {
    pub instructions: Vec<Instruction>,
    pub literals: Vec<f64>,
    /// Registers, or constants from [`FIRST_CONSTANT`] on.
    pub outputs: Vec<u8>,
    /// Whether [`FEW_REGISTERS`] suffice.
    pub few: bool,
}

impl Program {
    /// Values of the outputs at displacement, rate and largest displacement so far.
    #[inline(always)]
    pub(crate) fn evaluate<R: Real, const OUT: usize>(
        &self,
        constants: &[f64; CONSTANTS],
        state: [R; 3],
    ) -> [R; OUT] {
        match self.few {
            true => self.run::<R, OUT, FEW_REGISTERS>(constants, state),
            false => {
                let plain = state[0].each_plain(state);
                state[0].with_each_plain(self.run_long(constants, plain))
            }
        }
    }

    #[inline(never)]
    fn run_long<R: Real, const OUT: usize>(
        &self,
        constants: &[f64; CONSTANTS],
        state: [R; 3],
    ) -> [R; OUT] {
        self.run::<R, OUT, REGISTERS>(constants, state)
    }

    #[inline(always)]
    fn run<R: Real, const OUT: usize, const SIZE: usize>(
        &self,
        constants: &[f64; CONSTANTS],
        state: [R; 3],
    ) -> [R; OUT] {
        let [x, v, peak] = state;
        let mut registers = [x.constant(0.0); SIZE];
        registers[DISPLACEMENT as usize] = x;
        registers[RATE as usize] = v;
        registers[PEAK as usize] = peak;
        for instruction in &self.instructions {
            let Instruction {
                operation,
                target,
                a,
                b,
                c,
            } = *instruction;
            // SIZE is a power of two: the masks make the indices safe for free.
            let at = |operand: u8| registers[operand as usize & (SIZE - 1)];
            let constant = |operand: u8| constants[operand as usize % CONSTANTS];
            let value = match operation {
                Operation::Constant => x.constant(constant(a)),
                Operation::Literal => x.constant(self.literals[a as usize]),
                Operation::Sum => at(a) + at(b),
                Operation::Shifted => at(a) + constant(b),
                Operation::Difference => at(a) - at(b),
                Operation::Lowered => at(a) + -constant(b),
                Operation::Complement => x.constant(constant(a)) - at(b),
                Operation::Product => at(a) * at(b),
                Operation::Scaled => at(a) * constant(b),
                Operation::Quotient => at(a) / at(b),
                Operation::Over => x.constant(constant(a)) / at(b),
                Operation::Reciprocal => x.constant(1.0) / at(a),
                Operation::Negative => -at(a),
                Operation::Root => at(a).sqrt(),
                Operation::Power => at(a).powf(constant(b)),
                Operation::PowerOf => x.with_plain(power_of(at(a).plain(), at(b).plain())),
                Operation::Call(function) => x.with_plain(call(function, at(a).plain())),
                Operation::Choice => at(c).select(at(a), at(b)),
            };
            registers[target as usize & (SIZE - 1)] = value;
        }
        let mut out = [x.constant(0.0); OUT];
        for (out, &operand) in out.iter_mut().zip(&self.outputs) {
            *out = match operand < FIRST_CONSTANT {
                true => registers[operand as usize & (SIZE - 1)],
                false => x.constant(constants[(operand - FIRST_CONSTANT) as usize % CONSTANTS]),
            };
        }
        out
    }
}

#[inline(never)]
fn call<R: Real>(function: Function, a: R) -> R {
    match function {
        Function::Log => a.ln(),
        _ => a.map(|a| apply(function, a)),
    }
}

/// a^b = exp(b ln a).
#[inline(never)]
fn power_of<R: Real>(a: R, b: R) -> R {
    (a.ln() * b).map(f64::exp)
}
