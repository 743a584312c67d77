//! Nonlinear regression against the certified values of NIST StRD
//! (<https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml>).

pub mod model;
pub mod read_set;

use model::Model;
use read_set::{DataSet, read_set};
use windfall_numerics::cholesky;
use windfall_numerics::least_squares::{
    Bounds, LeastSquares, Minimum, NormalEquations, Options, minimise,
};

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
    /// Evaluations used.
    pub evaluations: usize,
    /// Why it stopped, in words.
    pub stop: String,
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
    let minimum = minimise(
        &mut Regression { model, rows },
        &start,
        &Bounds::NONE,
        options,
    );
    let sd = deviations(&minimum, rows.len()).unwrap_or([f64::NAN; P]);
    let worst = |found: [f64; P], certified: fn(&read_set::Parameter) -> f64| {
        (0..P)
            .map(|i| digits(found[i], certified(&set.parameters[i])))
            .fold(11.0, f64::min)
    };
    Outcome {
        value_digits: worst(minimum.parameters, |p| p.value),
        sd_digits: worst(sd, |p| p.sd),
        cost_digits: digits(minimum.equations.cost, set.sum_of_squares),
        evaluations: minimum.evaluations,
        stop: format!("{:?}", minimum.stop),
    }
}

/// Both starts of the set `name`; `None` where its file is missing.
pub fn fit_both<const P: usize>(
    name: &str,
    model: Model<P>,
    cost_tolerance: f64,
) -> Option<[Outcome; 2]> {
    let set = read_set(name)?;
    let mut set = set;
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

/// Every nonlinear set of the collection, in both starts; `None` for a name
/// that has no model here.
pub fn fit_named(name: &str, cost_tolerance: f64) -> Option<Option<[Outcome; 2]>> {
    Some(match name {
        "Bennett5" => fit_both(name, model::bennett, cost_tolerance),
        "BoxBOD" | "Misra1a" => fit_both(name, model::misra1a, cost_tolerance),
        "Chwirut1" | "Chwirut2" => fit_both(name, model::chwirut, cost_tolerance),
        "DanWood" => fit_both(name, model::danwood, cost_tolerance),
        "ENSO" => fit_both(name, model::enso, cost_tolerance),
        "Eckerle4" => fit_both(name, model::eckerle, cost_tolerance),
        "Gauss1" | "Gauss2" | "Gauss3" => fit_both(name, model::gauss, cost_tolerance),
        "Hahn1" | "Thurber" => fit_both(name, model::thurber, cost_tolerance),
        "Kirby2" => fit_both(name, model::kirby, cost_tolerance),
        "Lanczos1" | "Lanczos2" | "Lanczos3" => fit_both(name, model::lanczos, cost_tolerance),
        "MGH09" => fit_both(name, model::mgh09, cost_tolerance),
        "MGH10" => fit_both(name, model::mgh10, cost_tolerance),
        "MGH17" => fit_both(name, model::mgh17, cost_tolerance),
        "Misra1b" => fit_both(name, model::misra1b, cost_tolerance),
        "Misra1c" => fit_both(name, model::misra1c, cost_tolerance),
        "Misra1d" => fit_both(name, model::misra1d, cost_tolerance),
        "Nelson" => fit_both(name, model::nelson, cost_tolerance),
        "Rat42" => fit_both(name, model::rat42, cost_tolerance),
        "Rat43" => fit_both(name, model::rat43, cost_tolerance),
        "Roszman1" => fit_both(name, model::roszman, cost_tolerance),
        _ => return None,
    })
}
