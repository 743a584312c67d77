//! A formula as a graph in which equal parts are one, and its exact
//! derivatives.

use crate::formula::syntax::{Function, Operator, Term, What};
use std::collections::BTreeMap;

/// Position of a node in its graph.
pub(crate) type Id = usize;

/// What a node computes from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Node {
    /// Bits of the number.
    Number(u64),
    Displacement,
    Rate,
    /// Largest displacement so far, 0 during first loading.
    Peak,
    Parameter(usize),
    Sum(Id, Id),
    Difference(Id, Id),
    Product(Id, Id),
    Quotient(Id, Id),
    Negative(Id),
    Power(Id, Id),
    Call(Function, Id),
    /// The second where the first is positive, else the third.
    Choice(Id, Id, Id),
}

/// Nodes, each after those that it is made of.
#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    pub nodes: Vec<Node>,
    /// Whether the node depends on parameters and numbers only.
    pub invariant: Vec<bool>,
    /// Force at rest at the largest displacement so far.
    peak_force: Option<Id>,
    known: BTreeMap<Node, Id>,
}

/// What a derivative is taken by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Variable {
    Displacement,
    Rate,
    Peak,
    Parameter(usize),
}

impl Graph {
    fn insert(&mut self, node: Node) -> Id {
        if let Some(id) = self.known.get(&node) {
            return *id;
        }
        let invariant = match node {
            Node::Displacement | Node::Rate | Node::Peak => false,
            _ => parts(node)
                .into_iter()
                .flatten()
                .all(|id| self.invariant[id]),
        };
        let id = self.nodes.len();
        self.nodes.push(node);
        self.invariant.push(invariant);
        self.known.insert(node, id);
        id
    }

    pub(crate) fn number(&mut self, value: f64) -> Id {
        // One zero, whatever its sign.
        self.insert(Node::Number((value + 0.0).to_bits()))
    }

    /// The value of a node that is a number.
    pub(crate) fn value(&self, id: Id) -> Option<f64> {
        match self.nodes[id] {
            Node::Number(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    fn sum(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) => self.number(a + b),
            (Some(0.0), _) => b,
            (_, Some(0.0)) => a,
            _ => match self.nodes[b] {
                Node::Negative(b) => self.difference(a, b),
                _ => self.insert(Node::Sum(a.min(b), a.max(b))),
            },
        }
    }

    fn difference(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) => self.number(a - b),
            (Some(0.0), _) => self.negative(b),
            (_, Some(0.0)) => a,
            _ if a == b => self.number(0.0),
            _ => self.insert(Node::Difference(a, b)),
        }
    }

    /// A product with its invariant factors first, so that they are computed
    /// once for all samples.
    fn product(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) => return self.number(a * b),
            (Some(0.0), _) | (_, Some(0.0)) => return self.number(0.0),
            (Some(1.0), _) => return b,
            (_, Some(1.0)) => return a,
            _ => {}
        }
        let (a, b) = match (self.invariant[a], self.invariant[b]) {
            (false, true) => (b, a),
            (true, false) => (a, b),
            _ => (a.min(b), a.max(b)),
        };
        match (self.invariant[a], self.nodes[a], self.nodes[b]) {
            (true, _, Node::Product(c, d)) if self.invariant[c] && !self.invariant[d] => {
                let factor = self.product(a, c);
                self.product(factor, d)
            }
            (false, Node::Product(c, d), _) if self.invariant[c] => {
                let rest = self.product(d, b);
                self.product(c, rest)
            }
            (false, _, Node::Product(c, d)) if self.invariant[c] => {
                let rest = self.product(a, d);
                self.product(c, rest)
            }
            _ => self.insert(Node::Product(a, b)),
        }
    }

    fn quotient(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b)) {
            (Some(a), Some(b)) if b != 0.0 => self.number(a / b),
            (_, Some(1.0)) => a,
            (Some(0.0), _) => a,
            _ => match self.nodes[a] {
                // An invariant factor stays outside.
                Node::Product(c, d) if self.invariant[c] && !self.invariant[d] => {
                    let rest = self.quotient(d, b);
                    self.product(c, rest)
                }
                _ if self.invariant[b] && !self.invariant[a] => {
                    let one = self.number(1.0);
                    let factor = self.insert(Node::Quotient(one, b));
                    self.product(factor, a)
                }
                _ => self.insert(Node::Quotient(a, b)),
            },
        }
    }

    fn negative(&mut self, a: Id) -> Id {
        match (self.value(a), self.nodes[a]) {
            (Some(a), _) => self.number(-a),
            (_, Node::Negative(inner)) => inner,
            _ => self.insert(Node::Negative(a)),
        }
    }

    fn power(&mut self, a: Id, b: Id) -> Id {
        match (self.value(a), self.value(b), self.nodes[a]) {
            (Some(a), Some(b), _) => self.number(a.powf(b)),
            (_, Some(0.0), _) => self.number(1.0),
            (_, Some(1.0), _) => a,
            // A power goes into the pieces, so that its slope is that of the
            // piece in use and not of one that has none there.
            (_, _, Node::Choice(c, first, second)) => {
                let (first, second) = (self.power(first, b), self.power(second, b));
                self.choice(c, first, second)
            }
            _ => self.insert(Node::Power(a, b)),
        }
    }

    fn call(&mut self, function: Function, a: Id) -> Id {
        if let Some(value) = self.value(a) {
            return self.number(apply(function, value));
        }
        match (function, self.nodes[a]) {
            (Function::Sqrt, _) => {
                let half = self.number(0.5);
                self.power(a, half)
            }
            (Function::Abs, _) => {
                let other = self.negative(a);
                self.choice(a, a, other)
            }
            (Function::Tan, _) => {
                let (sin, cos) = (self.call(Function::Sin, a), self.call(Function::Cos, a));
                self.quotient(sin, cos)
            }
            (_, Node::Choice(c, first, second)) => {
                let (first, second) = (self.call(function, first), self.call(function, second));
                self.choice(c, first, second)
            }
            _ => self.insert(Node::Call(function, a)),
        }
    }

    fn choice(&mut self, condition: Id, first: Id, second: Id) -> Id {
        match self.value(condition) {
            _ if first == second => first,
            Some(value) if value > 0.0 => first,
            Some(_) => second,
            None => self.insert(Node::Choice(condition, first, second)),
        }
    }

    /// The node of a term.
    pub(crate) fn add(&mut self, term: &Term) -> Id {
        match &term.what {
            What::Number(value) => self.number(*value),
            What::Displacement => self.insert(Node::Displacement),
            What::Rate => self.insert(Node::Rate),
            What::Peak => self.insert(Node::Peak),
            // Not a number in a formula without memory, which cannot name it.
            What::PeakForce => self.peak_force.unwrap_or_else(|| self.number(f64::NAN)),
            What::Parameter(index) => self.insert(Node::Parameter(*index)),
            What::Negative(a) => {
                let a = self.add(a);
                self.negative(a)
            }
            What::Binary(operator, a, b) => {
                let (a, b) = (self.add(a), self.add(b));
                match operator {
                    Operator::Plus => self.sum(a, b),
                    Operator::Minus => self.difference(a, b),
                    Operator::Times => self.product(a, b),
                    Operator::Over => self.quotient(a, b),
                    Operator::Power => self.power(a, b),
                }
            }
            What::Call(function, a) => {
                let a = self.add(a);
                self.call(*function, a)
            }
            What::Smaller(a, b) => {
                let (a, b) = (self.add(a), self.add(b));
                let condition = self.difference(b, a);
                self.choice(condition, a, b)
            }
            What::Larger(a, b) => {
                let (a, b) = (self.add(a), self.add(b));
                let condition = self.difference(a, b);
                self.choice(condition, a, b)
            }
            What::If {
                left,
                right,
                strict,
                then,
                otherwise,
            } => {
                let (left, right) = (self.add(left), self.add(right));
                let (then, otherwise) = (self.add(then), self.add(otherwise));
                match strict {
                    true => {
                        let condition = self.difference(left, right);
                        self.choice(condition, then, otherwise)
                    }
                    false => {
                        let condition = self.difference(right, left);
                        self.choice(condition, otherwise, then)
                    }
                }
            }
        }
    }

    /// The force of a law with memory: `unloading` below the largest displacement so far, and
    /// `loading` beyond it. Returns the node of unloading, and that of the force.
    pub(crate) fn remembering(&mut self, loading: Id, unloading: &Term) -> (Id, Id) {
        let mut done = vec![None; loading + 1];
        self.peak_force = Some(self.at_rest_at_peak(loading, &mut done));
        let unloading = self.add(unloading);
        let (peak, x) = (self.insert(Node::Peak), self.insert(Node::Displacement));
        let below = self.difference(peak, x);
        (unloading, self.choice(below, unloading, loading))
    }

    /// Whether a condition is that of [`remembering`](Self::remembering).
    pub(crate) fn is_memory(&self, condition: Id) -> bool {
        match self.nodes[condition] {
            Node::Difference(a, b) => {
                (self.nodes[a], self.nodes[b]) == (Node::Peak, Node::Displacement)
            }
            _ => false,
        }
    }

    /// A node with the largest displacement in the place of x, and no rate.
    fn at_rest_at_peak(&mut self, id: Id, done: &mut Vec<Option<Id>>) -> Id {
        if let Some(known) = done[id] {
            return known;
        }
        let mut of = |graph: &mut Self, id: Id| graph.at_rest_at_peak(id, done);
        let out = match self.nodes[id] {
            Node::Displacement | Node::Peak => self.insert(Node::Peak),
            Node::Rate => self.number(0.0),
            Node::Number(_) | Node::Parameter(_) => id,
            Node::Sum(a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.sum(a, b)
            }
            Node::Difference(a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.difference(a, b)
            }
            Node::Product(a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.product(a, b)
            }
            Node::Quotient(a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.quotient(a, b)
            }
            Node::Power(a, b) => {
                let (a, b) = (of(self, a), of(self, b));
                self.power(a, b)
            }
            Node::Negative(a) => {
                let a = of(self, a);
                self.negative(a)
            }
            Node::Call(function, a) => {
                let a = of(self, a);
                self.call(function, a)
            }
            Node::Choice(c, a, b) => {
                let (c, a, b) = (of(self, c), of(self, a), of(self, b));
                self.choice(c, a, b)
            }
        };
        done[id] = Some(out);
        out
    }

    /// Whether a node depends on a variable.
    pub(crate) fn depends(&self, id: Id, by: Variable) -> bool {
        let mut known: Vec<bool> = Vec::with_capacity(id + 1);
        for node in &self.nodes[..=id] {
            let own = match (*node, by) {
                (Node::Displacement, Variable::Displacement)
                | (Node::Rate, Variable::Rate)
                | (Node::Peak, Variable::Peak) => true,
                (Node::Parameter(index), Variable::Parameter(other)) => index == other,
                _ => false,
            };
            let inner = parts(*node).into_iter().flatten().any(|part| known[part]);
            known.push(own || inner);
        }
        known[id]
    }

    /// ∂(node)/∂(variable), exactly.
    pub(crate) fn derivative(&mut self, id: Id, by: Variable) -> Id {
        let mut done = vec![None; id + 1];
        self.slope(id, by, &mut done)
    }

    fn slope(&mut self, id: Id, by: Variable, done: &mut Vec<Option<Id>>) -> Id {
        if let Some(known) = done[id] {
            return known;
        }
        let out = match self.nodes[id] {
            Node::Number(_) => self.number(0.0),
            Node::Displacement => self.number(f64::from(u8::from(by == Variable::Displacement))),
            Node::Rate => self.number(f64::from(u8::from(by == Variable::Rate))),
            Node::Peak => self.number(f64::from(u8::from(by == Variable::Peak))),
            Node::Parameter(i) => self.number(f64::from(u8::from(by == Variable::Parameter(i)))),
            Node::Sum(a, b) => {
                let (da, db) = (self.slope(a, by, done), self.slope(b, by, done));
                self.sum(da, db)
            }
            Node::Difference(a, b) => {
                let (da, db) = (self.slope(a, by, done), self.slope(b, by, done));
                self.difference(da, db)
            }
            Node::Product(a, b) => {
                let (da, db) = (self.slope(a, by, done), self.slope(b, by, done));
                let (left, right) = (self.product(da, b), self.product(a, db));
                self.sum(left, right)
            }
            Node::Quotient(a, b) => {
                let (da, db) = (self.slope(a, by, done), self.slope(b, by, done));
                // (a' − (a/b) b')/b
                let part = self.product(id, db);
                let above = self.difference(da, part);
                self.quotient(above, b)
            }
            Node::Negative(a) => {
                let da = self.slope(a, by, done);
                self.negative(da)
            }
            Node::Power(a, b) => {
                let (da, db) = (self.slope(a, by, done), self.slope(b, by, done));
                let base = self.power_slope(id, a, b);
                let base = self.product(base, da);
                let exponent = match self.value(db) {
                    Some(0.0) => db,
                    _ => {
                        let log = self.call(Function::Log, a);
                        let rate = self.product(log, db);
                        self.product(id, rate)
                    }
                };
                self.sum(base, exponent)
            }
            Node::Call(function, a) => {
                let da = self.slope(a, by, done);
                let outer = self.call_slope(function, id, a);
                self.product(outer, da)
            }
            Node::Choice(c, first, second) => {
                let (first, second) = (self.slope(first, by, done), self.slope(second, by, done));
                self.choice(c, first, second)
            }
        };
        done[id] = Some(out);
        out
    }

    /// ∂(a^b)/∂a.
    fn power_slope(&mut self, power: Id, a: Id, b: Id) -> Id {
        let scaled = match (self.value(b), self.nodes[a]) {
            // x is never zero where a law is evaluated: one power serves both.
            (None, Node::Displacement) => self.quotient(power, a),
            _ => {
                let one = self.number(1.0);
                let less = self.difference(b, one);
                self.power(a, less)
            }
        };
        self.product(b, scaled)
    }

    /// Derivative of a function at its argument.
    fn call_slope(&mut self, function: Function, id: Id, a: Id) -> Id {
        let one = self.number(1.0);
        match function {
            Function::Exp => id,
            Function::Log => self.quotient(one, a),
            Function::Sin => self.call(Function::Cos, a),
            Function::Cos => {
                let sin = self.call(Function::Sin, a);
                self.negative(sin)
            }
            Function::Tanh => {
                let square = self.product(id, id);
                self.difference(one, square)
            }
            Function::Atan => {
                let square = self.product(a, a);
                let below = self.sum(one, square);
                self.quotient(one, below)
            }
            // These are other nodes: see `call`.
            Function::Sqrt | Function::Tan | Function::Abs => self.number(0.0),
        }
    }
}

/// Nodes that a node is made of.
pub(crate) fn parts(node: Node) -> [Option<Id>; 3] {
    match node {
        Node::Number(_) | Node::Displacement | Node::Rate | Node::Peak | Node::Parameter(_) => {
            [None; 3]
        }
        Node::Sum(a, b)
        | Node::Difference(a, b)
        | Node::Product(a, b)
        | Node::Quotient(a, b)
        | Node::Power(a, b) => [Some(a), Some(b), None],
        Node::Negative(a) | Node::Call(_, a) => [Some(a), None, None],
        Node::Choice(c, a, b) => [Some(c), Some(a), Some(b)],
    }
}

/// A function of one number.
#[inline(always)]
pub(crate) fn apply(function: Function, value: f64) -> f64 {
    match function {
        Function::Sqrt => value.sqrt(),
        Function::Exp => value.exp(),
        Function::Log => value.ln(),
        Function::Sin => value.sin(),
        Function::Cos => value.cos(),
        Function::Tan => value.tan(),
        Function::Tanh => value.tanh(),
        Function::Atan => value.atan(),
        Function::Abs => value.abs(),
    }
}
