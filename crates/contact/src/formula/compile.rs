//! From a graph to the program that evaluates it: common steps found, constants hoisted,
//! registers given out.

use crate::formula::error::FormulaError;
use crate::formula::graph::{Graph, Id, Node};
use crate::formula::program::{
    CONSTANTS, DISPLACEMENT, FEW_REGISTERS, FIRST_CONSTANT, Instruction, Operation, PEAK, Program,
    RATE, REGISTERS,
};

/// The program of a law's force and derivatives, with the program of the
/// constants that it needs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Compiled {
    /// Of force and derivatives, with all constants.
    pub main: Program,
    /// Of the constants behind the parameters, with the parameters alone.
    pub prelude: Program,
    /// Nodes whose values are constants, in their order behind the parameters.
    pub hoisted: Vec<Id>,
}

/// Compiles the nodes `roots`; `wanted` are invariant nodes whose values are
/// wanted as constants besides.
pub(crate) fn compile(
    graph: &Graph,
    roots: &[Id],
    wanted: &[Id],
    parameters: usize,
) -> Result<Compiled, FormulaError> {
    let mut main = Lowering::new(graph, parameters, CONSTANTS - parameters);
    for id in wanted {
        main.hoist(*id);
    }
    let program = main.program(roots)?;
    let hoisted = main.hoisted;
    Ok(Compiled {
        main: program,
        prelude: Lowering::new(graph, parameters, 0).program(&hoisted)?,
        hoisted,
    })
}

/// Values that are given: x, v and the largest x so far.
const GIVEN: usize = 3;

/// A value that is computed, before registers are given out.
type Value = usize;

/// What an operand is before registers are given out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Value(Value),
    Constant(u8),
}

struct Lowering<'a> {
    graph: &'a Graph,
    parameters: usize,
    /// Constants that may be hoisted, and those that are.
    room: usize,
    hoisted: Vec<Id>,
    /// Operation and operands of each value; the first are x, v and the largest x so far.
    steps: Vec<(Operation, [Option<Place>; 3])>,
    literals: Vec<f64>,
    places: Vec<Option<Place>>,
}

impl<'a> Lowering<'a> {
    fn new(graph: &'a Graph, parameters: usize, room: usize) -> Self {
        Self {
            graph,
            parameters,
            room,
            hoisted: Vec::new(),
            steps: vec![(Operation::Constant, [None; 3]); GIVEN],
            literals: Vec::new(),
            places: vec![None; graph.nodes.len()],
        }
    }

    /// The constant of an invariant node, while there is room for one.
    fn hoist(&mut self, id: Id) -> Option<Place> {
        let slot = match self.hoisted.iter().position(|known| *known == id) {
            Some(slot) => slot,
            None if self.hoisted.len() < self.room => {
                self.hoisted.push(id);
                self.hoisted.len() - 1
            }
            None => return None,
        };
        Some(Place::Constant((self.parameters + slot) as u8))
    }

    /// The value of an operation; the same operation is done once.
    fn step(&mut self, operation: Operation, operands: &[Place]) -> Place {
        let mut padded = [None; 3];
        for (cell, operand) in padded.iter_mut().zip(operands) {
            *cell = Some(*operand);
        }
        let mut known = self.steps[GIVEN..].iter();
        if let Some(known) = known.position(|step| *step == (operation, padded)) {
            return Place::Value(known + GIVEN);
        }
        self.steps.push((operation, padded));
        Place::Value(self.steps.len() - 1)
    }

    fn place(&mut self, id: Id) -> Place {
        if let Some(place) = self.places[id] {
            return place;
        }
        let hoisted = match self.graph.nodes[id] {
            Node::Parameter(index) => Some(Place::Constant(index as u8)),
            _ if self.graph.invariant[id] => self.hoist(id),
            _ => None,
        };
        let place = hoisted.unwrap_or_else(|| self.computed(id));
        self.places[id] = Some(place);
        place
    }

    /// An operand that must be in a register.
    fn value(&mut self, id: Id) -> Place {
        match self.place(id) {
            Place::Constant(slot) => self.step(Operation::Constant, &[Place::Constant(slot)]),
            value => value,
        }
    }

    fn computed(&mut self, id: Id) -> Place {
        match self.graph.nodes[id] {
            Node::Displacement => Place::Value(0),
            Node::Rate => Place::Value(1),
            Node::Peak => Place::Value(2),
            Node::Parameter(index) => Place::Constant(index as u8),
            Node::Number(bits) => {
                let value = f64::from_bits(bits);
                let same = self.literals.iter().position(|l| l.to_bits() == bits);
                let index = same.unwrap_or_else(|| {
                    self.literals.push(value);
                    self.literals.len() - 1
                });
                self.step(Operation::Literal, &[Place::Constant(index as u8)])
            }
            Node::Sum(a, b) => self.commuting(a, b, Operation::Sum, Operation::Shifted),
            Node::Difference(a, b) => {
                let (a, b) = (self.place(a), self.place(b));
                self.pair(
                    a,
                    b,
                    [
                        Operation::Difference,
                        Operation::Lowered,
                        Operation::Complement,
                    ],
                )
            }
            Node::Product(a, b) => self.commuting(a, b, Operation::Product, Operation::Scaled),
            Node::Quotient(a, b) => self.quotient(a, b),
            Node::Negative(a) => {
                let a = self.value(a);
                self.step(Operation::Negative, &[a])
            }
            Node::Power(a, b) => self.power(a, b),
            Node::Call(function, a) => {
                let a = self.value(a);
                self.step(Operation::Call(function), &[a])
            }
            Node::Choice(c, a, b) => {
                let operands = [self.value(a), self.value(b), self.value(c)];
                self.step(Operation::Choice, &operands)
            }
        }
    }

    /// An operation whose operands may be exchanged: of two registers, and with a constant.
    fn commuting(&mut self, a: Id, b: Id, both: Operation, constant: Operation) -> Place {
        let (a, b) = match (self.place(a), self.place(b)) {
            (a @ Place::Constant(_), b) => (b, a),
            pair => pair,
        };
        self.pair(a, b, [both, constant, constant])
    }

    fn quotient(&mut self, a: Id, b: Id) -> Place {
        if self.graph.value(a) == Some(1.0) {
            let b = self.value(b);
            return self.step(Operation::Reciprocal, &[b]);
        }
        let (a, b) = (self.place(a), self.value(b));
        let operation = match a {
            Place::Value(_) => Operation::Quotient,
            Place::Constant(_) => Operation::Over,
        };
        self.step(operation, &[a, b])
    }

    /// An operation of two operands: `[both in registers, second constant,
    /// first constant]`.
    fn pair(&mut self, a: Place, b: Place, operations: [Operation; 3]) -> Place {
        match (a, b) {
            (Place::Value(_), Place::Value(_)) => self.step(operations[0], &[a, b]),
            (Place::Value(_), Place::Constant(_)) => self.step(operations[1], &[a, b]),
            (Place::Constant(_), Place::Value(_)) => self.step(operations[2], &[a, b]),
            (Place::Constant(_), Place::Constant(_)) => {
                let a = self.step(Operation::Constant, &[a]);
                self.pair(a, b, operations)
            }
        }
    }

    /// Roots and products for powers that are quarters, else by logarithm.
    fn power(&mut self, a: Id, b: Id) -> Place {
        let base = self.value(a);
        if let Some(exponent) = self.graph.value(b)
            && (4.0 * exponent).fract() == 0.0
            && exponent.abs() <= 8.0
        {
            return self.quarters(base, (4.0 * exponent) as i32);
        }
        match self.place(b) {
            Place::Constant(slot) => self.step(Operation::Power, &[base, Place::Constant(slot)]),
            // Not hoisted for lack of room, or it varies.
            exponent => self.step(Operation::PowerOf, &[base, exponent]),
        }
    }

    fn quarters(&mut self, base: Place, quarters: i32) -> Place {
        if quarters < 0 {
            let positive = self.quarters(base, -quarters);
            return self.step(Operation::Reciprocal, &[positive]);
        }
        let (whole, rest) = (quarters / 4, quarters % 4);
        let mut factors = Vec::new();
        let mut square = base;
        let mut left = whole;
        while left > 0 {
            if left % 2 == 1 {
                factors.push(square);
            }
            left /= 2;
            if left > 0 {
                square = self.step(Operation::Product, &[square, square]);
            }
        }
        if rest > 0 {
            let root = self.step(Operation::Root, &[base]);
            if rest >= 2 {
                factors.push(root);
            }
            if rest % 2 == 1 {
                factors.push(self.step(Operation::Root, &[root]));
            }
        }
        let mut factors = factors.into_iter();
        let first = factors.next().unwrap_or(base);
        factors.fold(first, |product, factor| {
            self.step(Operation::Product, &[product, factor])
        })
    }

    /// Gives out registers.
    fn program(&mut self, roots: &[Id]) -> Result<Program, FormulaError> {
        let outputs: Vec<Place> = roots.iter().map(|id| self.place(*id)).collect();
        let mut last = vec![0; self.steps.len()];
        for (index, (_, operands)) in self.steps.iter().enumerate() {
            for operand in operands.iter().flatten() {
                if let Place::Value(value) = operand {
                    last[*value] = index;
                }
            }
        }
        for output in &outputs {
            if let Place::Value(value) = output {
                last[*value] = usize::MAX;
            }
        }
        let too_long = FormulaError::TooLong { limit: REGISTERS };
        if self.literals.len() > usize::from(u8::MAX) {
            return Err(too_long);
        }
        // x, v and the largest x so far begin in the first registers.
        let mut registers: Vec<u8> = vec![DISPLACEMENT, RATE, PEAK];
        let mut holder: Vec<Option<Value>> = (0..GIVEN).map(Some).collect();
        let mut instructions = Vec::new();
        for (index, (operation, operands)) in self.steps.iter().enumerate().skip(GIVEN) {
            let code = |operand: Option<Place>, registers: &[u8]| match operand {
                None => 0,
                Some(Place::Value(value)) => registers[value],
                Some(Place::Constant(slot)) => slot,
            };
            let [a, b, c] = operands.map(|operand| code(operand, &registers));
            let free = holder
                .iter()
                .position(|held| held.is_none_or(|value| last[value] <= index));
            let register = free.unwrap_or(holder.len());
            if register == holder.len() {
                holder.push(None);
            }
            if register >= REGISTERS {
                return Err(too_long);
            }
            holder[register] = Some(index);
            registers.push(register as u8);
            instructions.push(Instruction {
                operation: *operation,
                target: register as u8,
                a,
                b,
                c,
            });
        }
        let outputs = outputs.iter().map(|output| match output {
            Place::Value(value) => registers[*value],
            Place::Constant(slot) => FIRST_CONSTANT + slot,
        });
        Ok(Program {
            outputs: outputs.collect(),
            instructions,
            literals: std::mem::take(&mut self.literals),
            few: holder.len() <= FEW_REGISTERS,
        })
    }
}
