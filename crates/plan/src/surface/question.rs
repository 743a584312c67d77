//! The response at the optimum, and its place, as a question.

use crate::options::SimulationOptions;
use crate::outcome::PrecisionOutcome;
use crate::question::{Count, Levels, Question, Size, Told};
use crate::scatter::KnownScatter;
use nalgebra::{DMatrix, DVector};
use windfall_distribution::quantile::quantile;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_signal::noise::gaussian::{noise_source, normal};
use windfall_statistics::surface::analysis::Surface;
use windfall_statistics::surface::canonical::{Shape, canonical};

/// A surface, its design and a place on it.
pub(crate) struct SurfaceQuestion {
    /// True surface.
    pub surface: Surface,
    /// Model matrix of one fruit at each run, coded; contrasts of blocks last.
    pub x: DMatrix<f64>,
    /// (X'X)⁻¹.
    pub inverse: DMatrix<f64>,
    /// The model's terms at the place where the response is wanted.
    pub at: DVector<f64>,
    /// Shape of the true stationary point, where there is one.
    pub shape: Option<Shape>,
    pub scatter: KnownScatter,
    pub simulation: SimulationOptions,
    pub about: Vec<String>,
    pub findings: Vec<FindingOutcome>,
}

impl SurfaceQuestion {
    /// Runs of the design and terms of the model.
    fn runs(&self) -> (f64, f64) {
        (self.x.nrows() as f64, self.x.ncols() as f64)
    }

    /// Where estimated stationary points of the true shape lie: half the width of the middle
    /// 95 % in each factor, and the share that has another shape.
    ///
    /// Estimated coefficients are drawn from their distribution, which is normal with the
    /// covariance σ² (X'X)⁻¹/r, so that no study needs to be fitted.
    fn location(&self, sd: f64, fruit: usize, shape: Shape) -> Vec<PrecisionOutcome> {
        let Some(root) = self.inverse.clone().cholesky() else {
            return Vec::new();
        };
        let scale = sd / (fruit as f64).sqrt();
        let mut source = noise_source(self.simulation.seed, 0);
        let factors = &self.surface.factors;
        let mut places: Vec<Vec<f64>> = vec![Vec::new(); factors.len()];
        let mut others = 0;
        let mut surface = self.surface.clone();
        for _ in 0..self.simulation.simulations {
            let drawn = DVector::from_fn(self.x.ncols(), |_, _| normal(&mut source));
            let error = root.l() * drawn * scale;
            // the blocks' means come last and move no optimum
            let own = self.surface.coded.len();
            for (place, error) in error.iter().take(own).enumerate() {
                surface.coded[place] = self.surface.coded[place] + error;
            }
            match canonical(&surface).filter(|own| own.shape == shape) {
                Some(own) => {
                    let factors = places.iter_mut().zip(&own.stationary);
                    factors.for_each(|(place, coded)| place.push(*coded));
                }
                None => others += 1,
            }
        }
        let half = |place: &[f64]| 0.5 * (quantile(place, 0.975) - quantile(place, 0.025));
        let shares = factors
            .iter()
            .zip(&places)
            .map(|(factor, place)| PrecisionOutcome {
                of: format!("± {}", factor.name),
                value: factor.half.abs() * half(place),
                se: None,
            });
        let other = PrecisionOutcome {
            of: "other shape".to_owned(),
            value: others as f64 / self.simulation.simulations as f64,
            se: None,
        };
        shares.chain([other]).collect()
    }
}

impl Question for SurfaceQuestion {
    fn name(&self) -> &'static str {
        "surface"
    }

    fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    fn counted(&self) -> &'static str {
        "fruit at each run"
    }

    fn fewest(&self, impacts: usize) -> Result<usize, Error> {
        self.scatter.scatter.check_impacts(impacts)?;
        let (runs, terms) = self.runs();
        // at least one degree of freedom
        match runs * 2.0 - terms >= 1.0 {
            true => Ok(if runs - terms >= 1.0 { 1 } else { 2 }),
            false => Err(unusable(
                "--model",
                format!("{runs} runs are too few for {terms} coefficients"),
            )),
        }
    }

    fn count(&self, size: Size) -> Count {
        let fruit = size.fruit * self.x.nrows();
        Count {
            fruit,
            impacts: fruit * size.impacts,
        }
    }

    fn told(&self, size: Size, levels: &Levels) -> Result<Told, Error> {
        let (runs, terms) = self.runs();
        let n = size.fruit as f64;
        let sd = self.scatter.scatter.of_fruit_mean(0, size.impacts);
        let leverage = (self.at.transpose() * &self.inverse * &self.at)[(0, 0)];
        let (error, df) = (sd * (leverage / n).sqrt(), n * runs - terms);
        let half_width = levels.half_width(error, df);
        Ok(Told {
            half_width: Some(half_width),
            df: Some(df),
            also: match self.shape {
                Some(shape) => self.location(sd, size.fruit, shape),
                None => Vec::new(),
            },
            ..Told::default()
        })
    }

    fn has_effect(&self) -> bool {
        false
    }

    fn has_assurance(&self) -> bool {
        true
    }

    fn effect_option(&self) -> &'static str {
        "--half-width"
    }

    fn half_width_of(&self) -> &'static str {
        match self.shape {
            Some(_) => "half-width of the response there",
            None => "half-width of the response at the centre",
        }
    }

    fn is_closed_form(&self) -> bool {
        // the half-width is; the places are drawn, and a curve of them would take long
        self.shape.is_none()
    }

    fn findings(&self) -> Vec<FindingOutcome> {
        self.findings.clone()
    }
}
