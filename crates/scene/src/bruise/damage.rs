//! Bruises: their volume from what one measures of them, and from the contacts of a scene by
//! a model that the user brings. windfall ships no coefficients of any fruit.

use crate::bruise::regression::Regression;
use crate::event::Event;
use crate::population::normal;
use crate::vector::{Vector, dot};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Volume of a bruise as the cap of a sphere below the plane of contact,
/// π d (3 w₁w₂ + 4 d²)/24; m³.
///
/// * `widths`: its widths across, the same twice where it is round; m
/// * `depth`: its depth below the plane through its edge; m
///
/// # Source
/// Geometry of a spherical cap; the elliptic form puts w₁w₂ in the place of w² (Mohsenin 1986).
pub fn cap_volume(widths: [f64; 2], depth: f64) -> f64 {
    PI * depth * (3.0 * widths[0] * widths[1] + 4.0 * depth * depth) / 24.0
}

/// [`cap_volume`] and the cap of the fruit above that plane, of height
/// x = R − √(R² − w₁w₂/4); m³.
///
/// * `radius`: of the fruit there; m
///
/// Returns `None` where the bruise is wider than the fruit.
pub fn cap_volume_with_bulge(widths: [f64; 2], depth: f64, radius: f64) -> Option<f64> {
    let square = radius * radius - 0.25 * widths[0] * widths[1];
    (square >= 0.0).then(|| {
        let height = radius - square.sqrt();
        cap_volume(widths, depth) + cap_volume(widths, height)
    })
}

/// Volume of half an ellipsoid, π w₁ w₂ d/6; m³.
pub fn half_ellipsoid_volume(widths: [f64; 2], depth: f64) -> f64 {
    PI * widths[0] * widths[1] * depth / 6.0
}

/// The quantity of a contact that predicts its bruise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predictor {
    /// Energy that the normal contact kept; J.
    AbsorbedEnergy,
    /// Largest normal force; N.
    PeakForce,
}

/// What contacts on one spot do together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SameSpot {
    /// The largest bruise stays: tissue breaks once.
    Largest,
    /// Volumes add up.
    Sum,
}

/// How the volume of a bruise follows from a contact above the threshold.
#[derive(Clone, Debug, PartialEq)]
pub enum VolumeLaw {
    /// In proportion to what is above the threshold.
    Proportional {
        /// Volume per unit of the predictor; m³/J or m³/N.
        susceptibility: f64,
        /// Its standard uncertainty.
        sd: f64,
    },
    /// By a regression of measured bruises.
    Regression(Regression),
}

/// The volume of a bruise from a contact: nothing up to a threshold, then by a law.
/// Coefficients are the user's.
#[derive(Clone, Debug, PartialEq)]
pub struct BruiseModel {
    /// What the threshold is of, and what a law of proportion takes.
    pub predictor: Predictor,
    /// Below this nothing bruises; J or N.
    pub threshold: f64,
    /// Its standard uncertainty.
    pub threshold_sd: f64,
    /// How it differs from fruit to fruit, a standard deviation: then the probability of a
    /// bruise is Φ((x − threshold)/this), a probit; J or N.
    pub threshold_between_fruit: f64,
    /// What is above it.
    pub law: VolumeLaw,
    /// What contacts on one spot do.
    pub same_spot: SameSpot,
    /// Smaller bruises are none: a regression of logarithms makes one of every touch; m³.
    pub least_volume: f64,
}

/// One bruise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bruise {
    /// Volume; m³.
    pub volume: f64,
    /// Where on the fruit: a direction from its centre.
    pub spot: Vector,
    /// The contact that made most of it, by its place among those of the fruit.
    pub contact: usize,
}

/// A contact as its fruit felt it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blow {
    /// Where on this fruit.
    pub spot: Vector,
    /// Absorbed energy that is this fruit's part; J.
    pub absorbed_energy: f64,
    /// Largest normal force; N.
    pub peak_force: f64,
    /// Radius of the area of contact over that of the fruit: the angle that it covers; rad.
    pub angle: f64,
    /// Terms of a regression, without their coefficients.
    pub terms: Vec<f64>,
    /// How this fruit differs from the mean, in standard deviations: its threshold, and its
    /// volumes in a regression.
    pub fruit_draws: [f64; 2],
    /// How this bruise differs from others of the fruit, in standard deviations.
    pub draw: f64,
}

crate::binary!(Blow {
    spot,
    absorbed_energy,
    peak_force,
    angle,
    terms,
    fruit_draws,
    draw
});

impl Blow {
    /// A contact felt by a fruit.
    ///
    /// * `radius`: of this fruit; m
    /// * `other`: whether it was the partner in the event
    /// * `share`: part of the absorbed energy that this fruit takes; 1
    pub fn of(event: &Event, radius: f64, other: bool, share: f64) -> Self {
        // a² = R* d with R* at most R.
        let area = (event.largest_displacement / radius).sqrt();
        Self {
            spot: if other { event.other_spot } else { event.spot },
            absorbed_energy: share * event.absorbed_energy,
            peak_force: event.peak_force,
            angle: area.min(PI),
            ..Self::default()
        }
    }

    /// Whether the areas of contact of two blows on a fruit overlap.
    fn overlaps(&self, other: &Self) -> bool {
        let apart = dot(self.spot, other.spot).clamp(-1.0, 1.0).acos();
        apart < self.angle + other.angle
    }

    fn predictor(&self, which: Predictor) -> f64 {
        match which {
            Predictor::AbsorbedEnergy => self.absorbed_energy,
            Predictor::PeakForce => self.peak_force,
        }
    }
}

impl BruiseModel {
    /// Volume of the bruise of one contact; m³.
    pub fn volume(&self, blow: &Blow) -> f64 {
        self.volume_within(0.0, blow)
    }

    /// Whether a contact bruises, with coefficients within [`REACH`] standard uncertainties.
    pub fn may_bruise(&self, blow: &Blow) -> bool {
        self.volume_within(REACH, blow) > 0.0
    }

    /// The largest volume within so many standard uncertainties of the coefficients; m³.
    fn volume_within(&self, reach: f64, blow: &Blow) -> f64 {
        let above = self.above(reach, blow);
        if above <= 0.0 {
            return 0.0;
        }
        let volume = match &self.law {
            VolumeLaw::Proportional { susceptibility, sd } => (susceptibility + reach * sd) * above,
            VolumeLaw::Regression(own) => {
                let value = own.value(&blow.terms, blow.fruit_draws[1], blow.draw);
                let more = match reach > 0.0 {
                    true => reach * own.sd(&blow.terms),
                    false => 0.0,
                };
                own.volume(value + more)
            }
        };
        self.counted(volume)
    }

    /// How much of the predictor is above the threshold.
    fn above(&self, reach: f64, blow: &Blow) -> f64 {
        let threshold = (self.threshold - reach * self.threshold_sd).max(0.0);
        let threshold = threshold + self.threshold_between_fruit * blow.fruit_draws[0];
        blow.predictor(self.predictor) - threshold.max(0.0)
    }

    /// The volume, or none where it is too small; what is no number is no bruise either.
    fn counted(&self, volume: f64) -> f64 {
        match volume > self.least_volume {
            true => volume,
            false => 0.0,
        }
    }

    /// The model with other coefficients, as uncertain as they are.
    fn drawn(&self, generator: &mut ChaCha8Rng) -> Self {
        let mut other = |value: f64, sd: f64| match sd > 0.0 {
            true => (value + sd * normal(generator)).max(0.0),
            false => value,
        };
        let threshold = other(self.threshold, self.threshold_sd);
        let law = match &self.law {
            VolumeLaw::Proportional { susceptibility, sd } => VolumeLaw::Proportional {
                susceptibility: other(*susceptibility, *sd),
                sd: *sd,
            },
            VolumeLaw::Regression(own) => VolumeLaw::Regression(own.drawn(generator)),
        };
        Self {
            threshold,
            law,
            ..self.clone()
        }
    }

    /// Bruises of a fruit. Blows whose areas overlap are on one spot, and so are those that each
    /// overlap with a third.
    pub fn bruises(&self, blows: &[Blow]) -> Vec<Bruise> {
        // Blows of each spot, with their volumes.
        let mut spots: Vec<Vec<(usize, f64)>> = Vec::new();
        for (contact, blow) in blows.iter().enumerate() {
            let volume = self.volume(blow);
            if volume <= 0.0 {
                continue;
            }
            let overlaps = |other: &(usize, f64)| blow.overlaps(&blows[other.0]);
            let mut joined = vec![(contact, volume)];
            spots.retain_mut(|spot| {
                let one = spot.iter().any(overlaps);
                if one {
                    joined.append(spot);
                }
                !one
            });
            joined.sort_unstable_by_key(|own| own.0);
            spots.push(joined);
        }
        spots.sort_unstable_by_key(|spot| spot[0].0);
        let bruise = |spot: &Vec<(usize, f64)>| {
            let worst = spot
                .iter()
                .fold(spot[0], |a, b| if b.1 > a.1 { *b } else { a });
            Bruise {
                volume: match self.same_spot {
                    SameSpot::Largest => worst.1,
                    SameSpot::Sum => spot.iter().map(|own| own.1).sum(),
                },
                spot: blows[spot[0].0].spot,
                contact: worst.0,
            }
        };
        spots.iter().map(bruise).collect()
    }

    /// Volume of the largest bruise of a fruit; m³.
    pub fn largest(&self, blows: &[Blow]) -> f64 {
        match (self.same_spot, &self.law) {
            // Where only the largest on a spot counts, spots make no difference; and a power
            // is taken only of the largest.
            (SameSpot::Largest, VolumeLaw::Regression(own)) if own.rises() => {
                let above = blows.iter().filter(|blow| self.above(0.0, blow) > 0.0);
                let values =
                    above.map(|blow| own.value(&blow.terms, blow.fruit_draws[1], blow.draw));
                let largest = values.reduce(f64::max);
                largest.map_or(0.0, |value| self.counted(own.volume(value)))
            }
            (SameSpot::Largest, _) => {
                let volumes = blows.iter().map(|blow| self.volume(blow));
                volumes.fold(0.0, f64::max)
            }
            (SameSpot::Sum, _) => {
                let bruises = self.bruises(blows).into_iter();
                bruises.map(|bruise| bruise.volume).fold(0.0, f64::max)
            }
        }
    }

    /// How many fruit have a bruise above each limit: by the model as it is, then by as many
    /// models as are drawn from the uncertainty of its coefficients.
    ///
    /// * `blows`: contacts of each fruit
    /// * `limits`: m³
    /// * `draws`: models drawn, and their seed; the same seed draws the same models
    pub fn counts_above(
        &self,
        blows: &[Vec<Blow>],
        limits: &[f64],
        (draws, seed): (usize, u64),
    ) -> Vec<Vec<usize>> {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut models = vec![self.clone()];
        models.extend((0..draws).map(|_| self.drawn(&mut generator)));
        let mut counts = vec![vec![0; limits.len()]; models.len()];
        // Fruit by fruit: its contacts stay at hand.
        for own in blows {
            for (model, counts) in models.iter().zip(&mut counts) {
                let largest = model.largest(own);
                for (count, limit) in counts.iter_mut().zip(limits) {
                    *count += usize::from(largest > *limit);
                }
            }
        }
        counts
    }

    /// Shares of fruit whose largest bruise exceeds limits, with the ends of their intervals.
    ///
    /// The interval has in it that other fruit would have come (Jeffreys' distribution of a
    /// binomial share, made wider where fruit bruise each other), and the uncertainty of the
    /// coefficients, resampled.
    ///
    /// * `blows`: contacts of each fruit
    /// * `fruit`: how many fruit count; others have no blows
    /// * `limits`: m³, each with the variance of the share over that of independent fruit
    /// * `level`: of the interval; 1
    pub fn shares_above(
        &self,
        (blows, fruit): (&[Vec<Blow>], usize),
        limits: &[(f64, f64)],
        level: f64,
        (draws, seed): (usize, u64),
    ) -> Vec<Share> {
        let volumes: Vec<f64> = limits.iter().map(|own| own.0).collect();
        let counts = self.counts_above(blows, &volumes, (draws, seed));
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        // Another stream than that of the models.
        generator.set_stream(1);
        let share = |place: usize| {
            let own: Vec<usize> = counts.iter().map(|counts| counts[place]).collect();
            share_of(&own, (fruit, limits[place].1), level, &mut generator)
        };
        (0..limits.len()).map(share).collect()
    }
}

/// Variance of a share of fruit over that of independent fruit, at least 1: fruit that bruise
/// each other are bruised together.
///
/// * `bruised`: whether each fruit is; `together`: pairs of fruit of which one is bruised most
///   by the other, each pair once
///
/// # Source
/// Cluster-robust variance of a mean: Liang and Zeger (1986), Biometrika 73, 13-22; with pairs
/// that overlap in place of clusters Conley (1999), J. Econometrics 92, 1-45.
pub fn variance_ratio(bruised: &[bool], together: &[(usize, usize)]) -> f64 {
    let share = bruised.iter().filter(|own| **own).count() as f64 / bruised.len() as f64;
    let apart = |fruit: usize| f64::from(u8::from(bruised[fruit])) - share;
    let own: f64 = (0..bruised.len()).map(|fruit| apart(fruit).powi(2)).sum();
    let pairs = together.iter().map(|(a, b)| apart(*a) * apart(*b));
    match own > 0.0 {
        true => (1.0 + 2.0 * pairs.sum::<f64>() / own).max(1.0),
        false => 1.0,
    }
}

/// A share from counts of fruit: the first by the model as it is, the others by drawn ones.
///
/// * `ratio`: of the variance over that of independent fruit, by which draws are moved away from
///   their centre on the scale ln(p/(1 − p))
fn share_of(
    counts: &[usize],
    (fruit, ratio): (usize, f64),
    level: f64,
    generator: &mut ChaCha8Rng,
) -> Share {
    let spread = |drawn: f64, bad: usize| {
        let logit = |p: f64| (p / (1.0 - p)).ln();
        let centre = logit((bad as f64 + 0.5) / (fruit as f64 + 1.0));
        let moved = centre + ratio.sqrt() * (logit(drawn) - centre);
        1.0 / (1.0 + (-moved).exp())
    };
    let (own, drawn) = counts.split_first().unwrap_or((&0, &[]));
    let mut shares: Vec<f64> = drawn
        .iter()
        .map(|&bad| {
            let above = gamma_half(bad, generator);
            spread(above / (above + gamma_half(fruit - bad, generator)), bad)
        })
        .collect();
    shares.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * (shares.len() as f64 - 1.0)).round() as usize;
        shares.get(place).copied().unwrap_or(f64::NAN)
    };
    Share {
        share: *own as f64 / fruit.max(1) as f64,
        low: at(0.5 * (1.0 - level)),
        high: at(0.5 * (1.0 + level)),
    }
}

/// Standard uncertainties by which coefficients may differ for a contact to be looked at.
pub const REACH: f64 = 5.0;

/// A number of Gamma's distribution of shape `whole` + ½: exponential ones, and half the
/// square of a normal one.
fn gamma_half(whole: usize, generator: &mut ChaCha8Rng) -> f64 {
    let exponential = |_| -(1.0 - generator.random::<f64>()).ln();
    let sum: f64 = (0..whole).map(exponential).sum();
    sum + 0.5 * normal(generator).powi(2)
}

/// A share with its interval; 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// With the model as it is.
    pub share: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_volumes_of_one_bruise() {
        // Width 16, depth 5, fruit of radius 40 mm: by hand.
        let (widths, depth) = ([0.016; 2], 0.005);
        for (found, wanted) in [
            (cap_volume(widths, depth), 568.1),
            (cap_volume_with_bulge(widths, depth, 0.04).unwrap(), 649.6),
            (half_ellipsoid_volume(widths, depth), 670.2),
        ] {
            assert!((1e9 * found - wanted).abs() < 0.05, "{found} {wanted}");
        }
        assert!(cap_volume_with_bulge([0.1; 2], 0.005, 0.04).is_none());
    }

    const MODEL: BruiseModel = BruiseModel {
        predictor: Predictor::AbsorbedEnergy,
        threshold: 0.05,
        threshold_sd: 0.0,
        threshold_between_fruit: 0.0,
        law: VolumeLaw::Proportional {
            susceptibility: 3e-6,
            sd: 0.0,
        },
        same_spot: SameSpot::Largest,
        least_volume: 0.0,
    };

    const SUM: BruiseModel = BruiseModel {
        same_spot: SameSpot::Sum,
        ..MODEL
    };

    fn blow(energy: f64, spot: Vector) -> Blow {
        Blow {
            spot,
            absorbed_energy: energy,
            angle: 0.2,
            ..Blow::default()
        }
    }

    #[test]
    fn contacts_on_one_spot_are_one_bruise() {
        let near = [0.1_f64.sin(), 0.0, 0.1_f64.cos()];
        let blows = [
            blow(0.06, [0.0, 0.0, 1.0]),
            blow(0.04, [1.0, 0.0, 0.0]),
            blow(0.10, near),
            blow(0.15, [0.0, 1.0, 0.0]),
        ];
        let volumes = |model: &BruiseModel| {
            let bruises = model.bruises(&blows);
            bruises
                .iter()
                .map(|own| (1e9 * own.volume).round())
                .collect::<Vec<_>>()
        };
        // 3 mm³/mJ above 50 mJ: 30 and 150 on one spot, 300 on another.
        assert_eq!(volumes(&MODEL), [150.0, 300.0]);
        assert_eq!(volumes(&SUM), [180.0, 300.0]);
        assert_eq!(SUM.bruises(&blows)[0].contact, 2);
    }

    #[test]
    fn areas_that_touch_a_third_are_one_bruise() {
        let at = |angle: f64| [angle.sin(), 0.0, angle.cos()];
        // Each covers 0.2 rad around it.
        let blows = [0.0, 0.39, 0.78, 1.2].map(|angle| blow(0.1, at(angle)));
        let volumes = |blows: &[Blow]| {
            let bruises = SUM.bruises(blows);
            bruises
                .iter()
                .map(|own| (1e9 * own.volume).round())
                .collect::<Vec<_>>()
        };
        assert_eq!(volumes(&blows), [450.0, 150.0]);
        // In any order.
        let [a, b, c, d] = blows;
        assert_eq!(volumes(&[c, d, a, b]), [450.0, 150.0]);
    }

    #[test]
    fn closed_form_shares_and_their_uncertainty() {
        let fruit = |count: usize, energy: f64| vec![vec![blow(energy, [0.0, 0.0, 1.0])]; count];
        let blows = [fruit(3, 0.15), fruit(7, 0.06)].concat();
        let found = MODEL.shares_above((&blows, blows.len()), &[(1e-7, 1.0)], 0.95, (20_000, 1))[0];
        // Quantiles of Beta(3.5, 7.5), by Brown, Cai and DasGupta's (2001) interval of Jeffreys:
        // mean 0.318, standard deviation 0.1345; checked by its first two moments below.
        assert_eq!(found.share, 0.3);
        assert!(
            (0.08..0.11).contains(&found.low) && (0.58..0.63).contains(&found.high),
            "{found:?}"
        );
        // None of ten: the interval does not shrink to nothing.
        let none = MODEL.shares_above((&fruit(10, 0.06), 10), &[(1e-7, 1.0)], 0.95, (20_000, 1))[0];
        assert!(
            none.share == 0.0 && none.low < 1e-3 && (0.20..0.24).contains(&none.high),
            "{none:?}"
        );
        // An uncertain threshold widens it.
        let unsure = BruiseModel {
            threshold_sd: 0.03,
            ..MODEL
        };
        let wide = unsure.shares_above((&blows, blows.len()), &[(2.5e-7, 1.0)], 0.95, (4000, 1))[0];
        let sure = MODEL.shares_above((&blows, blows.len()), &[(2.5e-7, 1.0)], 0.95, (4000, 1))[0];
        assert!(
            wide.high - wide.low > sure.high - sure.low,
            "{wide:?} {sure:?}"
        );
    }

    /// Fruit that are always bruised in pairs are half as many.
    #[test]
    fn closed_form_pairs_double_the_variance() {
        let bruised: Vec<bool> = (0..40).map(|own| own % 8 < 2).collect();
        let pairs: Vec<(usize, usize)> = (0..20).map(|own| (2 * own, 2 * own + 1)).collect();
        assert!((variance_ratio(&bruised, &pairs) - 2.0).abs() < 1e-12);
        assert_eq!(variance_ratio(&bruised, &[]), 1.0);
        assert_eq!(variance_ratio(&[false; 5], &[(0, 1)]), 1.0);
        // Four times the variance is twice the width on the scale of logarithms of odds.
        let fruit = |count: usize, energy: f64| vec![vec![blow(energy, [0.0, 0.0, 1.0])]; count];
        let blows = [fruit(30, 0.15), fruit(70, 0.06)].concat();
        let width = |ratio: f64| {
            let own =
                MODEL.shares_above((&blows, blows.len()), &[(1e-7, ratio)], 0.95, (20_000, 1))[0];
            let logit = |p: f64| (p / (1.0 - p)).ln();
            logit(own.high) - logit(own.low)
        };
        assert!((width(4.0) / width(1.0) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn closed_form_moments_of_the_draws() {
        let mut generator = ChaCha8Rng::seed_from_u64(5);
        let n = 50_000;
        let draws: Vec<f64> = (0..n)
            .map(|_| {
                let (a, b) = (gamma_half(3, &mut generator), gamma_half(7, &mut generator));
                a / (a + b)
            })
            .collect();
        let mean = draws.iter().sum::<f64>() / n as f64;
        let variance = draws.iter().map(|own| (own - mean).powi(2)).sum::<f64>() / n as f64;
        // Beta(a, b): a/(a + b) and a b/((a + b)² (a + b + 1)).
        assert!((mean - 3.5 / 11.0).abs() < 3e-3, "{mean}");
        assert!(
            (variance / (3.5 * 7.5 / (121.0 * 12.0)) - 1.0).abs() < 0.03,
            "{variance}"
        );
    }
}
