//! Nonlinear regression against the certified values of NIST StRD
//! (<https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml>).

pub mod model;
pub mod read_set;

use model::Model;
use read_set::{DataSet, read_set};
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{
    Bounds, LeastSquares, Minimum, NormalEquations, Options, Stop,
};
use windfall_numerics::logarithmic::minimise_either;

/// Residuals of a model against observed responses.
pub struct Regression<'a, const P: usize> {
    /// Model and its derivatives.
    pub model: Model<P>,
    /// Response and predictors of each observation.
    pub rows: &'a [Vec<f64>],
}

impl<const P: usize> LeastSquares<P> for Regression<'_, P> {
    fn evaluate(&mut self, parameters: &[f64; P]) -> Option<NormalEquations<P>> {
        let mut equations = NormalEquations::ZERO;
        for row in self.rows {
            let (value, derivatives) = (self.model)(parameters, &row[1..]);
            equations.add(1.0, value - row[0], &derivatives);
        }
        Some(equations)
    }
}

/// Standard deviations of the parameters, √ of the diagonal of s² (JᵀJ)⁻¹ at
/// the last evaluation.
pub fn deviations<const P: usize>(minimum: &Minimum<P>, observations: usize) -> Option<[f64; P]> {
    let inverse = cholesky::inverse(&minimum.equations.normal)?;
    let variance = minimum.equations.cost / (observations - P) as f64;
    Some(std::array::from_fn(|i| (variance * inverse[i][i]).sqrt()))
}

/// Correct significant digits, −log₁₀ of the relative error; NIST certifies 11.
pub fn digits(found: f64, certified: f64) -> f64 {
    let error = ((found - certified) / certified).abs();
    if error.is_finite() {
        (-error.log10()).clamp(0.0, 11.0)
    } else {
        0.0
    }
}

/// What one start of one set gave.
pub struct Outcome {
    /// Digits of the worst parameter.
    pub value_digits: f64,
    /// Digits of the worst standard deviation.
    pub sd_digits: f64,
    /// Digits of the residual sum of squares.
    pub cost_digits: f64,
    /// Digits of the worst standard deviation in units of the residual's.
    pub shape_digits: f64,
    /// Largest error of a value in certified standard deviations.
    pub error_in_sd: f64,
    /// Evaluations used.
    pub evaluations: usize,
    /// Why it stopped.
    pub stop: Stop,
}

/// One set fitted from start `which` (0 or 1).
pub fn fit<const P: usize>(
    set: &DataSet,
    model: Model<P>,
    which: usize,
    options: &Options<P>,
) -> Outcome {
    assert_eq!(set.parameters.len(), P);
    let start = std::array::from_fn(|i| set.parameters[i].starts[which]);
    let rows = &set.rows;
    let minimum = minimise_either(
        &mut Regression { model, rows },
        &start,
        &Bounds::NONE,
        options,
    );
    let sd = deviations(&minimum, rows.len()).unwrap_or([f64::NAN; P]);
    let certified = &set.parameters;
    let residual = (minimum.equations.cost / (rows.len() - P) as f64).sqrt();
    let certified_residual = (set.sum_of_squares / (rows.len() - P) as f64).sqrt();
    let over = |digits_of: &dyn Fn(usize) -> f64| (0..P).map(digits_of).fold(11.0, f64::min);
    Outcome {
        value_digits: over(&|i| digits(minimum.parameters[i], certified[i].value)),
        sd_digits: over(&|i| digits(sd[i], certified[i].sd)),
        shape_digits: over(&|i| digits(sd[i] / residual, certified[i].sd / certified_residual)),
        error_in_sd: (0..P)
            .map(|i| (minimum.parameters[i] - certified[i].value).abs() / certified[i].sd)
            .fold(0.0, f64::max),
        cost_digits: digits(minimum.equations.cost, set.sum_of_squares),
        evaluations: minimum.evaluations,
        stop: minimum.stop,
    }
}

/// Both starts of the set `name`; `None` where its file is missing.
pub fn fit_both<const P: usize>(
    name: &str,
    model: Model<P>,
    cost_tolerance: f64,
) -> Option<[Outcome; 2]> {
    let mut set = read_set(name)?;
    if name == "Nelson" {
        // Its model is of the logarithm of the response.
        set.rows.iter_mut().for_each(|row| row[0] = row[0].ln());
    }
    let options = Options {
        cost_tolerance,
        max_evaluations: 20_000,
        ..Options::default()
    };
    Some([0, 1].map(|which| fit(&set, model, which, &options)))
}

/// A data set by name, fitted from both starts with the given cost tolerance.
pub type Fit = fn(name: &str, cost_tolerance: f64) -> Option<[Outcome; 2]>;

/// Every nonlinear data set of the collection.
pub const SETS: [(&str, Fit); 27] = [
    ("Bennett5", |n, t| fit_both(n, model::bennett, t)),
    ("BoxBOD", |n, t| fit_both(n, model::misra1a, t)),
    ("Chwirut1", |n, t| fit_both(n, model::chwirut, t)),
    ("Chwirut2", |n, t| fit_both(n, model::chwirut, t)),
    ("DanWood", |n, t| fit_both(n, model::danwood, t)),
    ("ENSO", |n, t| fit_both(n, model::enso, t)),
    ("Eckerle4", |n, t| fit_both(n, model::eckerle, t)),
    ("Gauss1", |n, t| fit_both(n, model::gauss, t)),
    ("Gauss2", |n, t| fit_both(n, model::gauss, t)),
    ("Gauss3", |n, t| fit_both(n, model::gauss, t)),
    ("Hahn1", |n, t| fit_both(n, model::thurber, t)),
    ("Kirby2", |n, t| fit_both(n, model::kirby, t)),
    ("Lanczos1", |n, t| fit_both(n, model::lanczos, t)),
    ("Lanczos2", |n, t| fit_both(n, model::lanczos, t)),
    ("Lanczos3", |n, t| fit_both(n, model::lanczos, t)),
    ("MGH09", |n, t| fit_both(n, model::mgh09, t)),
    ("MGH10", |n, t| fit_both(n, model::mgh10, t)),
    ("MGH17", |n, t| fit_both(n, model::mgh17, t)),
    ("Misra1a", |n, t| fit_both(n, model::misra1a, t)),
    ("Misra1b", |n, t| fit_both(n, model::misra1b, t)),
    ("Misra1c", |n, t| fit_both(n, model::misra1c, t)),
    ("Misra1d", |n, t| fit_both(n, model::misra1d, t)),
    ("Nelson", |n, t| fit_both(n, model::nelson, t)),
    ("Rat42", |n, t| fit_both(n, model::rat42, t)),
    ("Rat43", |n, t| fit_both(n, model::rat43, t)),
    ("Roszman1", |n, t| fit_both(n, model::roszman, t)),
    ("Thurber", |n, t| fit_both(n, model::thurber, t)),
];
