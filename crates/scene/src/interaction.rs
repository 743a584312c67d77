//! Contacts between two materials.

use crate::error::Error;
use windfall_contact::laws::any_law::LARGEST_PARAMETERS;
use windfall_contact::laws::kind::Law;
use windfall_contact::parameter::Elastic;

/// Standard normal numbers of one fruit: how it differs from the median of its kind. They
/// are the same in all its contacts: a soft fruit is soft against everything.
pub type Draws = [f64; LARGEST_PARAMETERS];

/// How the parameters of a law differ from fruit to fruit.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// Whether the logarithm of each parameter varies, rather than itself.
    pub logarithm: Vec<bool>,
    /// Lower triangle L of the covariance L Lᵀ of what varies; rows as long as the law has
    /// parameters, zero for what does not vary.
    pub factor: Vec<Vec<f64>>,
}

/// The contact of two materials.
#[derive(Clone, Debug, PartialEq)]
pub struct Interaction {
    /// The normal force of the median fruit.
    pub law: Law,
    /// R* that the law was found with; m. Where it is known, laws of Hertz's contact
    /// (hertz, kuwabara-kono) are taken to the R* of each pair: k and c go as √R*. Other
    /// laws hold as they are.
    pub effective_radius: Option<f64>,
    /// How fruit differ.
    pub spread: Option<Spread>,
    /// Coefficient of sliding friction, μ; 1.
    pub friction: f64,
    /// Tangential over normal stiffness of the contact; 1. By Mindlin, for equal elastic
    /// bodies, 2 (1 − ν)/(2 − ν).
    pub tangential_ratio: f64,
    /// Tangential damping over that of the normal law, c_t = ratio · ∂F/∂v; 1.
    pub tangential_damping: f64,
    /// Annuli of the contact area that stick or slip each for itself, 1 to
    /// [`MOST_ANNULI`](crate::annuli::MOST_ANNULI).
    pub annuli: usize,
    /// Coefficient of rolling friction, μ_r; 1. The resisting moment is at most μ_r R* F.
    pub rolling: f64,
}

/// k_t/k_n of two equal elastic bodies.
///
/// # Source
/// Mindlin (1949), J. Appl. Mech. 16, 259.
pub fn mindlin_ratio(poisson: f64) -> f64 {
    2.0 * (1.0 - poisson) / (2.0 - poisson)
}

impl Interaction {
    /// A law without friction.
    pub fn frictionless(law: Law) -> Self {
        Self {
            law,
            effective_radius: None,
            spread: None,
            friction: 0.0,
            tangential_ratio: 0.0,
            tangential_damping: 0.0,
            annuli: 1,
            rolling: 0.0,
        }
    }

    /// Whether anything acts against rolling.
    pub(crate) fn rolls(&self) -> bool {
        self.friction > 0.0 && self.rolling > 0.0
    }

    /// Whether the law follows the radii of what touches.
    pub fn follows_radii(&self) -> bool {
        let hertzian = self.law.kind().describe().elastic == Elastic::Hertzian;
        hertzian && self.effective_radius.is_some()
    }

    /// What radii multiply the force by: √(R*/R* of the law), or 1; 1.
    pub fn scale(&self, radius: f64) -> f64 {
        match self.effective_radius {
            Some(seen) if self.follows_radii() => (radius / seen).sqrt(),
            _ => 1.0,
        }
    }

    /// The law of a fruit on a wall, or of two fruit.
    ///
    /// Of two fruit each varying parameter is the harmonic mean of theirs (their
    /// compliances are in series, as 1/E* = Σ (1 − ν²)/E says), or the mean where it varies
    /// itself and not its logarithm.
    ///
    /// * `radius`: R*; m
    /// * `first`, `second`: how the fruit differ from the median
    ///
    /// # Errors
    /// A fruit that differs so much that a parameter leaves its bounds.
    pub fn law_of(&self, radius: f64, first: &Draws, second: Option<&Draws>) -> Result<Law, Error> {
        let mut law = self.law;
        if let Some(spread) = &self.spread {
            let mut values = law.parameters();
            let own = spread.deviations(first);
            let other = second.map(|draws| spread.deviations(draws));
            for (place, value) in values.iter_mut().enumerate() {
                *value = match (spread.logarithm[place], &other) {
                    (true, None) => *value * own[place].exp(),
                    (true, Some(other)) => {
                        *value * 2.0 / ((-own[place]).exp() + (-other[place]).exp())
                    }
                    (false, None) => *value + own[place],
                    (false, Some(other)) => *value + 0.5 * (own[place] + other[place]),
                };
            }
            law = law.kind().with_parameters(&values)?;
        }
        let ratio = self.scale(radius);
        if ratio != 1.0 {
            let values: Vec<f64> = law.parameters().iter().map(|value| value * ratio).collect();
            law = law.kind().with_parameters(&values)?;
        }
        Ok(law)
    }
}

impl Spread {
    /// How a fruit's parameters (or their logarithms) deviate from the median.
    fn deviations(&self, draws: &Draws) -> Vec<f64> {
        let row = |row: &Vec<f64>| row.iter().zip(draws).map(|(l, z)| l * z).sum();
        self.factor.iter().map(row).collect()
    }
}
