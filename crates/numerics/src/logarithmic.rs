//! Least squares in the logarithms of parameters that keep their sign, where the plain way to the
//! minimum fails.

use crate::least_squares::{
    Bounds, LeastSquares, Minimum, NormalEquations, Options, Stop, minimise,
};

/// Plain evaluations before logarithms are tried.
const PATIENCE: usize = 700;

/// Longest step of a logarithm.
const LONGEST_STEP: f64 = 2.0;

/// [`minimise`]; if that is stuck or needs more than 700 evaluations, a second minimisation from
/// the start in the logarithms of the parameters, which keep their signs. Returns the lower of the
/// two minima.
///
/// From a start that is far off, exponents and scales lead along a curved valley, or onto a plateau
/// where they have no effect. In logarithms the valley is nearly straight, and steps stay short.
pub fn minimise_either<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    start: &[f64; P],
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Minimum<P> {
    let few = |max_evaluations| Options {
        max_evaluations,
        ..*options
    };
    let patience = options.max_evaluations.min(PATIENCE);
    let plain = minimise(problem, start, bounds, &few(patience));
    if matches!(plain.stop, Stop::Converged | Stop::BadStart) {
        return plain;
    }
    let left = options.max_evaluations.saturating_sub(plain.evaluations);
    if left == 0 {
        return plain;
    }
    let mut other = in_logarithms(problem, start, bounds, &few(left));
    other.evaluations += plain.evaluations;
    let lower = other.stop != Stop::BadStart && other.equations.cost < plain.equations.cost;
    if lower || plain.stop != Stop::EvaluationLimit {
        return if lower { other } else { plain };
    }
    // Slow, but lower than in logarithms: it goes on.
    let left = options.max_evaluations.saturating_sub(other.evaluations);
    let mut slow = minimise(problem, &plain.parameters, bounds, &few(left));
    slow.evaluations += other.evaluations;
    slow
}

/// How a parameter moves.
#[derive(Clone, Copy)]
enum Scale {
    /// As it is: it begins at zero.
    Plain,
    /// By the logarithm of its size, which has this sign.
    Logarithm(f64),
}

impl Scale {
    fn of(start: f64) -> Self {
        match start == 0.0 {
            true => Self::Plain,
            false => Self::Logarithm(start.signum()),
        }
    }

    fn inner(self, value: f64) -> f64 {
        match self {
            Self::Plain => value,
            // What has the other sign is beyond the smallest number.
            Self::Logarithm(sign) => (sign * value).max(0.0).ln(),
        }
    }

    fn value(self, inner: f64) -> f64 {
        match self {
            Self::Plain => inner,
            Self::Logarithm(sign) => sign * inner.exp(),
        }
    }

    fn longest_step(self) -> f64 {
        match self {
            Self::Plain => f64::INFINITY,
            Self::Logarithm(_) => LONGEST_STEP,
        }
    }

    /// Derivative of the value by the inner one.
    fn slope(self, value: f64) -> f64 {
        match self {
            Self::Plain => 1.0,
            Self::Logarithm(_) => value,
        }
    }
}

struct Logarithmic<'a, T, const P: usize> {
    problem: &'a mut T,
    scales: [Scale; P],
}

impl<T: LeastSquares<P>, const P: usize> LeastSquares<P> for Logarithmic<'_, T, P> {
    fn evaluate(&mut self, inner: &[f64; P]) -> Option<NormalEquations<P>> {
        let values: [f64; P] = std::array::from_fn(|i| self.scales[i].value(inner[i]));
        let slopes = std::array::from_fn(|i| self.scales[i].slope(values[i]));
        self.problem
            .evaluate(&values)
            .map(|found| scaled(found, &slopes))
    }
}

/// Normal equations of parameters of which the old ones are functions with these slopes.
fn scaled<const P: usize>(mut found: NormalEquations<P>, slopes: &[f64; P]) -> NormalEquations<P> {
    for i in 0..P {
        found.gradient[i] *= slopes[i];
        for j in 0..P {
            found.normal[i][j] *= slopes[i] * slopes[j];
        }
    }
    found
}

fn in_logarithms<const P: usize>(
    problem: &mut impl LeastSquares<P>,
    start: &[f64; P],
    bounds: &Bounds<P>,
    options: &Options<P>,
) -> Minimum<P> {
    let scales = start.map(Scale::of);
    let inner = |i: usize, value: f64| scales[i].inner(value);
    let ends = |i: usize| {
        let (a, b) = (inner(i, bounds.lower[i]), inner(i, bounds.upper[i]));
        (a.min(b), a.max(b))
    };
    let bounds = Bounds {
        lower: std::array::from_fn(|i| ends(i).0),
        upper: std::array::from_fn(|i| ends(i).1),
    };
    let own = Options {
        largest_step: scales.map(Scale::longest_step),
        ..*options
    };
    let start = std::array::from_fn(|i| inner(i, start[i]));
    let mut minimum = minimise(&mut Logarithmic { problem, scales }, &start, &bounds, &own);
    let at = minimum.parameters;
    minimum.parameters = std::array::from_fn(|i| scales[i].value(at[i]));
    let back = std::array::from_fn(|i| 1.0 / scales[i].slope(minimum.parameters[i]));
    minimum.equations = scaled(minimum.equations, &back);
    for (side, scale) in minimum.at_bound.iter_mut().zip(scales) {
        // Of a negative parameter the smaller size is the upper bound.
        if matches!(scale, Scale::Logarithm(sign) if sign < 0.0) {
            *side = -*side;
        }
    }
    minimum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = a (1 − e^(−b x)), from where the first step leads to the plain on which b has no
    /// effect (as in BoxBOD of NIST).
    struct Rise;

    impl LeastSquares<2> for Rise {
        fn evaluate(&mut self, [a, b]: &[f64; 2]) -> Option<NormalEquations<2>> {
            let mut sum = NormalEquations::ZERO;
            for x in [1.0, 2.0, 3.0, 5.0, 7.0, 10.0] {
                let e = (-b * x).exp();
                let error = a * (1.0 - e) - 200.0 * (1.0 - (-0.5 * x).exp());
                sum.add(1.0, error, &[1.0 - e, a * x * e]);
            }
            Some(sum)
        }
    }

    #[test]
    fn recovers_what_the_plain_way_loses() {
        let options = Options::default();
        let start = [1.0, 1.0];
        let plain = minimise(&mut Rise, &start, &Bounds::NONE, &options);
        assert_eq!(plain.stop, Stop::Stuck);
        let found = minimise_either(&mut Rise, &start, &Bounds::NONE, &options);
        assert_eq!(found.stop, Stop::Converged);
        let [a, b] = found.parameters;
        assert!(
            (a - 200.0).abs() < 1e-6 && (b - 0.5).abs() < 1e-8,
            "{found:?}"
        );
        let expected = Rise.evaluate(&found.parameters).unwrap();
        let off = found.equations.normal[0][1] / expected.normal[0][1] - 1.0;
        assert!(off.abs() < 1e-4, "{off}");
    }

    #[test]
    fn closed_form_bounds_of_a_negative_parameter() {
        struct Square;
        impl LeastSquares<1> for Square {
            fn evaluate(&mut self, [b]: &[f64; 1]) -> Option<NormalEquations<1>> {
                let mut sum = NormalEquations::ZERO;
                sum.add(1.0, b + 3.0, &[1.0]);
                Some(sum)
            }
        }
        let bounds = Bounds {
            lower: [-2.0],
            upper: [5.0],
        };
        let found = in_logarithms(&mut Square, &[-1.0], &bounds, &Options::default());
        assert_eq!((found.at_bound, found.stop), ([-1], Stop::Converged));
        assert!((found.parameters[0] + 2.0).abs() < 1e-12);
    }
}
