//! The volume of a bruise by a regression of measured ones: the user's terms and coefficients.

use crate::population::normal;
use rand_chacha::ChaCha8Rng;

/// What of the volume the regression is of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Response {
    /// The volume itself.
    Volume,
    /// Its logarithm to this base.
    Logarithm(f64),
    /// This power of it.
    Power(f64),
}

/// A regression g(V/unit) = Σ bᵢ xᵢ + between fruit + residual.
///
/// Differences between fruit and residuals are normal. A regression of logarithms then
/// predicts the median; the mean volume is larger.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// g.
    pub response: Response,
    /// Unit that volumes were in; m³.
    pub unit: f64,
    /// b.
    pub coefficients: Vec<f64>,
    /// Lower triangle L of their covariance L Lᵀ; rows.
    pub factor: Vec<Vec<f64>>,
    /// Standard deviation between fruit, of g.
    pub between_fruit: f64,
    /// Standard deviation of what is left, of g.
    pub residual: f64,
}

impl Regression {
    /// g of a bruise.
    ///
    /// * `terms`: x
    /// * `fruit`, `own`: how the fruit and this bruise differ; standard deviations
    pub fn value(&self, terms: &[f64], fruit: f64, own: f64) -> f64 {
        let products = self.coefficients.iter().zip(terms).map(|(b, x)| b * x);
        products.sum::<f64>() + self.between_fruit * fruit + self.residual * own
    }

    /// The volume of which g has a value; m³. Not a number where g has no inverse.
    pub fn volume(&self, value: f64) -> f64 {
        let volume = match self.response {
            Response::Volume => value,
            Response::Logarithm(base) => base.powf(value),
            // Of a root that is below zero nothing is left.
            Response::Power(power) => value.max(0.0).powf(power.recip()),
        };
        self.unit * volume
    }

    /// Whether a larger g is of a larger volume.
    pub fn rises(&self) -> bool {
        match self.response {
            Response::Volume => true,
            Response::Logarithm(base) => base > 1.0,
            Response::Power(power) => power > 0.0,
        }
    }

    /// Standard uncertainty of Σ bᵢ xᵢ.
    pub fn sd(&self, terms: &[f64]) -> f64 {
        let column = |column: usize| {
            let rows = self.factor.iter().zip(terms);
            rows.map(|(row, x)| row.get(column).map_or(0.0, |l| l * x))
                .sum::<f64>()
        };
        let squares = (0..self.factor.len()).map(|own| column(own).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// The same with other coefficients, from their covariance.
    pub(crate) fn drawn(&self, generator: &mut ChaCha8Rng) -> Self {
        let draws: Vec<f64> = self.factor.iter().map(|_| normal(generator)).collect();
        let mut other = self.clone();
        for (own, row) in other.coefficients.iter_mut().zip(&self.factor) {
            *own += row.iter().zip(&draws).map(|(l, z)| l * z).sum::<f64>();
        }
        other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bruise::damage::{Blow, BruiseModel, Predictor, SameSpot, VolumeLaw};
    use rand::SeedableRng;

    /// ln(V/mm³) = 7 + 1.1 ln E − 0.02 T.
    fn regression() -> Regression {
        Regression {
            response: Response::Logarithm(std::f64::consts::E),
            unit: 1e-9,
            coefficients: vec![7.0, 1.1, -0.02],
            factor: vec![vec![0.2], vec![0.05, 0.04], vec![0.0, 0.0, 0.003]],
            between_fruit: 0.3,
            residual: 0.2,
        }
    }

    #[test]
    fn closed_form_volumes_by_hand() {
        let terms = [1.0, 0.4_f64.ln(), 20.0];
        let own = regression();
        // e^(7 − 0.4) 0.4^1.1 = 735.095 · 0.364992
        let of = |own: &Regression, terms: &[f64], fruit, draw| {
            own.volume(own.value(terms, fruit, draw))
        };
        let volume = 1e9 * of(&own, &terms, 0.0, 0.0);
        assert!((volume - 268.3).abs() < 0.05, "{volume}");
        let other = of(&own, &terms, 1.0, -1.0) / of(&own, &terms, 0.0, 0.0);
        assert!((other - 0.1_f64.exp()).abs() < 1e-12);
        let cube = Regression {
            response: Response::Power(1.0 / 3.0),
            coefficients: vec![2.0],
            ..regression()
        };
        assert!((1e9 * of(&cube, &[1.0], 0.0, 0.0) - 8.0).abs() < 1e-9);
        assert_eq!(of(&cube, &[-1.0], 0.0, 0.0), 0.0);
        let line = Regression {
            response: Response::Volume,
            ..cube
        };
        assert_eq!(of(&line, &[-1.0], 0.0, 0.0), -2e-9);
    }

    #[test]
    fn closed_form_uncertainty_of_a_prediction_and_of_draws() {
        let (own, terms) = (regression(), [1.0, -1.0, 20.0]);
        // L Lᵀ x·x with L of three rows: (0.2 − 0.05)² + 0.04² + 0.06².
        let wanted = (0.15_f64.powi(2) + 0.04_f64.powi(2) + 0.06_f64.powi(2)).sqrt();
        assert!((own.sd(&terms) - wanted).abs() < 1e-12);
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let sum = |own: &Regression| -> f64 {
            own.coefficients
                .iter()
                .zip(&terms)
                .map(|(b, x)| b * x)
                .sum()
        };
        let n = 20_000;
        let square = (0..n).map(|_| (sum(&own.drawn(&mut generator)) - sum(&own)).powi(2));
        let sd = (square.sum::<f64>() / f64::from(n)).sqrt();
        // Five standard errors of a standard deviation, 1/√(2n).
        assert!((sd / wanted - 1.0).abs() < 0.025, "{sd} {wanted}");
    }

    /// With thresholds that differ, the share of bruised fruit is Φ of the distance.
    #[test]
    fn closed_form_probit_of_a_threshold_between_fruit() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let model = BruiseModel {
            predictor: Predictor::PeakForce,
            threshold: 50.0,
            threshold_sd: 0.0,
            threshold_between_fruit: 10.0,
            law: VolumeLaw::Proportional {
                susceptibility: 1e-9,
                sd: 0.0,
            },
            same_spot: SameSpot::Largest,
            least_volume: 0.0,
        };
        let fruit: Vec<Vec<Blow>> = (0..20_000)
            .map(|_| {
                vec![Blow {
                    peak_force: 45.0,
                    fruit_draws: [normal(&mut generator), 0.0],
                    ..Blow::default()
                }]
            })
            .collect();
        let found = model.counts_above(&fruit, &[0.0], (0, 1))[0][0] as f64 / 20_000.0;
        // Φ(−0.5) = 0.30854.
        assert!((found - 0.30854).abs() < 5.0 * 0.00327, "{found}");
    }

    /// A contact that no coefficients within reach could make bruise is not looked at.
    #[test]
    fn closed_form_reach_of_uncertain_coefficients() {
        let model = BruiseModel {
            predictor: Predictor::AbsorbedEnergy,
            threshold: 0.0,
            threshold_sd: 0.0,
            threshold_between_fruit: 0.0,
            law: VolumeLaw::Regression(regression()),
            same_spot: SameSpot::Largest,
            least_volume: 10e-9,
        };
        let blow = |energy: f64| Blow {
            absorbed_energy: energy,
            terms: vec![1.0, energy.ln(), 0.0],
            ..Blow::default()
        };
        // 10 mm³ at ln E = (ln 10 − 7)/1.1 = −4.27; there sd is √(0.0135² + 0.171²) = 0.171.
        assert!(model.volume(&blow(0.0145)) > 0.0 && model.volume(&blow(0.0135)) == 0.0);
        assert!(model.may_bruise(&blow(0.0135)) && !model.may_bruise(&blow(0.004)));
    }
}
