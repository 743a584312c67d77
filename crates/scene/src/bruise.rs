//! Bruises: their volume from what one measures of them, and from the contacts of a scene by
//! a model that the user brings. windfall ships no coefficients of any fruit.

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
#[must_use]
pub fn cap_volume(widths: [f64; 2], depth: f64) -> f64 {
    PI * depth * (3.0 * widths[0] * widths[1] + 4.0 * depth * depth) / 24.0
}

/// [`cap_volume`] and the cap of the fruit above that plane, of height
/// x = R − √(R² − w₁w₂/4); m³.
///
/// * `radius`: of the fruit there; m
///
/// Returns `None` where the bruise is wider than the fruit.
#[must_use]
pub fn cap_volume_with_bulge(widths: [f64; 2], depth: f64, radius: f64) -> Option<f64> {
    let square = radius * radius - 0.25 * widths[0] * widths[1];
    (square >= 0.0).then(|| {
        let height = radius - square.sqrt();
        cap_volume(widths, depth) + cap_volume(widths, height)
    })
}

/// Volume of half an ellipsoid, π w₁ w₂ d/6; m³.
#[must_use]
pub fn half_ellipsoid_volume(widths: [f64; 2], depth: f64) -> f64 {
    PI * widths[0] * widths[1] * depth / 6.0
}

/// What of a contact tells its bruise.
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

/// The volume of a bruise from a contact: nothing up to a threshold, then in proportion to
/// what is above it. Coefficients are the user's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BruiseModel {
    /// What tells the bruise.
    pub predictor: Predictor,
    /// Below this nothing bruises; J or N.
    pub threshold: f64,
    /// Its standard uncertainty.
    pub threshold_sd: f64,
    /// Volume per unit of the predictor above the threshold; m³/J or m³/N.
    pub susceptibility: f64,
    /// Its standard uncertainty.
    pub susceptibility_sd: f64,
    /// What contacts on one spot do.
    pub same_spot: SameSpot,
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blow {
    /// Where on this fruit.
    pub spot: Vector,
    /// Absorbed energy that is this fruit's part; J.
    pub absorbed_energy: f64,
    /// Largest normal force; N.
    pub peak_force: f64,
    /// Radius of the area of contact over that of the fruit: the angle that it covers; rad.
    pub angle: f64,
}

crate::binary!(Blow {
    spot,
    absorbed_energy,
    peak_force,
    angle
});

impl Blow {
    /// A contact felt by a fruit.
    ///
    /// * `radius`: of this fruit; m
    /// * `other`: whether it was the partner in the event
    /// * `share`: part of the absorbed energy that this fruit takes; 1
    #[must_use]
    pub fn of(event: &Event, radius: f64, other: bool, share: f64) -> Self {
        // a² = R* d with R* at most R.
        let area = (event.largest_displacement / radius).sqrt();
        Self {
            spot: if other { event.other_spot } else { event.spot },
            absorbed_energy: share * event.absorbed_energy,
            peak_force: event.peak_force,
            angle: area.min(PI),
        }
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
    #[must_use]
    pub fn volume(&self, blow: &Blow) -> f64 {
        self.susceptibility * (blow.predictor(self.predictor) - self.threshold).max(0.0)
    }

    /// Bruises of a fruit. Contacts whose areas overlap are on one spot.
    #[must_use]
    pub fn bruises(&self, blows: &[Blow]) -> Vec<Bruise> {
        let mut found: Vec<(Bruise, f64, f64)> = Vec::new();
        for (contact, blow) in blows.iter().enumerate() {
            let volume = self.volume(blow);
            if volume <= 0.0 {
                continue;
            }
            let before = found.iter_mut().find(|(bruise, angle, _)| {
                dot(bruise.spot, blow.spot).clamp(-1.0, 1.0).acos() < angle.max(blow.angle)
            });
            let Some((bruise, angle, most)) = before else {
                let bruise = Bruise {
                    volume,
                    spot: blow.spot,
                    contact,
                };
                found.push((bruise, blow.angle, volume));
                continue;
            };
            bruise.volume = match self.same_spot {
                SameSpot::Largest => bruise.volume.max(volume),
                SameSpot::Sum => bruise.volume + volume,
            };
            if volume > *most {
                (bruise.contact, *most) = (contact, volume);
            }
            *angle = angle.max(blow.angle);
        }
        found.into_iter().map(|(bruise, ..)| bruise).collect()
    }

    /// Share of fruit whose largest bruise exceeds a limit, with the ends of its interval.
    ///
    /// The interval has in it that other fruit would have come (Jeffreys' distribution of a
    /// binomial share), and the uncertainty of threshold and susceptibility, drawn anew.
    ///
    /// * `blows`: contacts of each fruit
    /// * `limit`: m³
    /// * `level`: of the interval; 1
    #[must_use]
    pub fn share_above(
        &self,
        blows: &[Vec<Blow>],
        limit: f64,
        level: f64,
        (replicates, seed): (usize, u64),
    ) -> Share {
        let count = blows.len();
        let bad = |model: &Self| {
            let largest = |own: &Vec<Blow>| {
                let bruises = model.bruises(own).into_iter();
                bruises.map(|bruise| bruise.volume).fold(0.0, f64::max)
            };
            blows.iter().filter(|own| largest(own) > limit).count()
        };
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        let mut shares: Vec<f64> = (0..replicates)
            .map(|_| {
                let other = |value: f64, sd: f64, generator: &mut ChaCha8Rng| match sd > 0.0 {
                    true => (value + sd * normal(generator)).max(0.0),
                    false => value,
                };
                let model = Self {
                    threshold: other(self.threshold, self.threshold_sd, &mut generator),
                    susceptibility: other(
                        self.susceptibility,
                        self.susceptibility_sd,
                        &mut generator,
                    ),
                    ..*self
                };
                let bad = bad(&model);
                let above = gamma_half(bad, &mut generator);
                above / (above + gamma_half(count - bad, &mut generator))
            })
            .collect();
        shares.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (share * (shares.len() as f64 - 1.0)).round() as usize;
            shares.get(place).copied().unwrap_or(f64::NAN)
        };
        Share {
            share: bad(self) as f64 / count.max(1) as f64,
            low: at(0.5 * (1.0 - level)),
            high: at(0.5 * (1.0 + level)),
        }
    }
}

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
        susceptibility: 3e-6,
        susceptibility_sd: 0.0,
        same_spot: SameSpot::Largest,
    };

    fn blow(energy: f64, spot: Vector) -> Blow {
        Blow {
            spot,
            absorbed_energy: energy,
            peak_force: 0.0,
            angle: 0.2,
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
        let sum = BruiseModel {
            same_spot: SameSpot::Sum,
            ..MODEL
        };
        assert_eq!(volumes(&sum), [180.0, 300.0]);
        assert_eq!(sum.bruises(&blows)[0].contact, 2);
    }

    #[test]
    fn closed_form_shares_and_their_uncertainty() {
        let fruit = |count: usize, energy: f64| vec![vec![blow(energy, [0.0, 0.0, 1.0])]; count];
        let blows = [fruit(3, 0.15), fruit(7, 0.06)].concat();
        let found = MODEL.share_above(&blows, 1e-7, 0.95, (20_000, 1));
        // Quantiles of Beta(3.5, 7.5), by Brown, Cai and DasGupta's (2001) interval of Jeffreys:
        // mean 0.318, standard deviation 0.1345; checked by its first two moments below.
        assert_eq!(found.share, 0.3);
        assert!(
            (0.08..0.11).contains(&found.low) && (0.58..0.63).contains(&found.high),
            "{found:?}"
        );
        // None of ten: the interval does not shrink to nothing.
        let none = MODEL.share_above(&fruit(10, 0.06), 1e-7, 0.95, (20_000, 1));
        assert!(
            none.share == 0.0 && none.low < 1e-3 && (0.20..0.24).contains(&none.high),
            "{none:?}"
        );
        // An uncertain threshold widens it.
        let unsure = BruiseModel {
            threshold_sd: 0.03,
            ..MODEL
        };
        let wide = unsure.share_above(&blows, 2.5e-7, 0.95, (4000, 1));
        let sure = MODEL.share_above(&blows, 2.5e-7, 0.95, (4000, 1));
        assert!(
            wide.high - wide.low > sure.high - sure.low,
            "{wide:?} {sure:?}"
        );
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
