//! The intervals of one drop → the restitution of its impacts.

/// What is known of a stopwatch and of the drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Step of the stopwatch; s.
    pub resolution: f64,
    /// Standard uncertainty of the instant at which an impact is noticed, besides the step; s.
    pub trigger_sd: f64,
    /// Duration of a contact, which an interval holds besides the flight; s.
    pub contact: f64,
    /// Acceleration of gravity; m/s².
    pub gravity: f64,
    /// Standard uncertainty of drop heights; m.
    pub height_sd: f64,
}

impl Timing {
    /// Standard uncertainty of one instant; s.
    ///
    /// The error of a step is uniform over the step.
    pub fn instant_sd(&self) -> f64 {
        self.trigger_sd.hypot(self.resolution / 12f64.sqrt())
    }
}

/// The impacts of one drop, as they were timed.
#[derive(Clone, Debug, PartialEq)]
pub struct TimedDrop {
    /// What it is called.
    pub name: String,
    /// Height from which it fell, where that is known; m.
    pub height: Option<f64>,
    /// Times from impact to impact; `None` where one was not noticed. s.
    pub intervals: Vec<Option<f64>>,
}

/// One impact with its restitution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedImpact {
    /// Its number; the drop ends in impact 1.
    pub number: usize,
    /// Speed at which it is struck; m/s.
    pub speed: f64,
    /// Standard uncertainty of the speed from timing and height; m/s.
    pub speed_sd: f64,
    /// Speed after it over speed before it; 1.
    pub restitution: f64,
    /// Standard uncertainty of the restitution from timing and height; 1.
    pub sd: f64,
    /// Height of the flight that follows; m.
    pub rebound_height: f64,
}

/// What the intervals of a drop say.
#[derive(Clone, Debug, PartialEq)]
pub struct DropEstimate {
    /// Its impacts.
    pub impacts: Vec<TimedImpact>,
    /// Geometric mean of their restitutions; 1.
    pub restitution: f64,
    /// Its standard uncertainty from timing and height; 1.
    pub sd: f64,
    /// Height of a drop whose first impact has this restitution, and its standard uncertainty
    /// from timing; `None` where the first interval is missing. m.
    pub height: Option<(f64, f64)>,
}

/// Restitution of each impact of a drop and of the drop; `None` where no impact lies between
/// two flights that were timed.
///
/// A body that is not slowed down by the air lands as fast as it left: with the flights T₁, T₂, …
/// (the intervals without the contact)
///
/// ```text
/// impact n+1:  v = g Tₙ/2,  e = Tₙ₊₁/Tₙ     impact 1:  v = √(2 g h),  e = g T₁/(2 v)
/// drop:        e = exp(mean of ln e),       h = g T₁²/(8 e²)
/// ```
///
/// Every impact lies between two intervals: with s the uncertainty of an instant, intervals have
/// the variance 2 s² and neighbours the covariance −s², which is carried through all of these.
///
/// * `drop`: flights must be longer than zero
///
/// # Source
/// Bernstein, A. D. (1977), Listening to the coefficient of restitution, Am. J. Phys. 45, 41,
/// doi 10.1119/1.10904; Stensgaard, I., and Lægsgaard, E. (2001), Listening to the coefficient
/// of restitution - revisited, Am. J. Phys. 69, 301, doi 10.1119/1.1326077. Differences: the
/// errors of successive intervals are correlated, as they share an impact.
pub fn estimate_drop(drop: &TimedDrop, timing: &Timing) -> Option<DropEstimate> {
    let flights: Vec<Option<f64>> = drop
        .intervals
        .iter()
        .map(|own| own.map(|interval| interval - timing.contact))
        .collect();
    let errors = Errors { flights, timing };
    let mut impacts = Vec::new();
    let mut sum = Combination::new(errors.flights.len());
    let first = drop.height.zip(errors.flights.first().copied().flatten());
    if let Some((height, flight)) = first {
        let speed = (2.0 * timing.gravity * height).sqrt();
        let mut log = Combination::new(errors.flights.len());
        log.add(0, 1.0);
        log.height = -0.5 * timing.height_sd / height;
        let speed_sd = 0.5 * speed * timing.height_sd / height;
        impacts.push(errors.impact(1, (speed, speed_sd), 0.5 * timing.gravity * flight, &log));
        sum.join(&log);
    }
    for place in 1..errors.flights.len() {
        let (Some(before), Some(after)) = (errors.flights[place - 1], errors.flights[place]) else {
            continue;
        };
        let mut log = Combination::new(errors.flights.len());
        log.add(place, 1.0);
        log.add(place - 1, -1.0);
        let half = 0.5 * timing.gravity;
        let speed_sd = half * 2f64.sqrt() * timing.instant_sd();
        impacts.push(errors.impact(place + 1, (half * before, speed_sd), half * after, &log));
        sum.join(&log);
    }
    if impacts.is_empty() {
        return None;
    }
    let count = impacts.len() as f64;
    let logs = impacts.iter().map(|own| own.restitution.ln());
    let restitution = (logs.sum::<f64>() / count).exp();
    let mean = sum.times(1.0 / count);
    let height = errors.flights[0].map(|flight| {
        let mut log = mean.times(-2.0);
        log.add(0, 2.0);
        let height = timing.gravity * flight * flight / (8.0 * restitution * restitution);
        (height, height * errors.variance(&log).sqrt())
    });
    Some(DropEstimate {
        impacts,
        restitution,
        sd: restitution * errors.variance(&mean).sqrt(),
        height,
    })
}

/// A sum of logarithms of flights, and of the error of the height.
#[derive(Clone, Debug)]
struct Combination {
    /// Factor of the logarithm of each flight.
    flights: Vec<f64>,
    /// Effect of one standard deviation of the height.
    height: f64,
}

impl Combination {
    fn new(flights: usize) -> Self {
        Self {
            flights: vec![0.0; flights],
            height: 0.0,
        }
    }

    fn add(&mut self, place: usize, factor: f64) {
        self.flights[place] += factor;
    }

    fn join(&mut self, other: &Self) {
        for (own, other) in self.flights.iter_mut().zip(&other.flights) {
            *own += other;
        }
        self.height += other.height;
    }

    fn times(&self, factor: f64) -> Self {
        Self {
            flights: self.flights.iter().map(|own| own * factor).collect(),
            height: self.height * factor,
        }
    }
}

/// Flights with their errors.
struct Errors<'a> {
    flights: Vec<Option<f64>>,
    timing: &'a Timing,
}

impl Errors<'_> {
    /// The impact of this number, from the speeds before (with its uncertainty) and after it,
    /// and the logarithm of its restitution.
    fn impact(
        &self,
        number: usize,
        (speed, speed_sd): (f64, f64),
        after: f64,
        log: &Combination,
    ) -> TimedImpact {
        let restitution = after / speed;
        TimedImpact {
            number,
            speed,
            speed_sd,
            restitution,
            sd: restitution * self.variance(log).sqrt(),
            rebound_height: after * after / (2.0 * self.timing.gravity),
        }
    }

    /// Variance of a combination.
    fn variance(&self, sum: &Combination) -> f64 {
        // The error of a flight is that of the instant at its end less that at its start.
        let slope = |place: usize| match self.flights.get(place) {
            Some(Some(flight)) => sum.flights[place] / flight,
            _ => 0.0,
        };
        let instants = (0..=self.flights.len()).map(|instant| {
            let before = instant.checked_sub(1).map_or(0.0, slope);
            before - slope(instant)
        });
        let instants: f64 = instants.map(|own| own * own).sum();
        let sd = self.timing.instant_sd();
        sd * sd * instants + sum.height * sum.height
    }
}

#[cfg(test)]
#[path = "estimate_tests.rs"]
mod tests;
