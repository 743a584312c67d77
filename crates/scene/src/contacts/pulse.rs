//! Load pulses of a contact: where one ends and the next begins.
//!
//! A contact that lasts is not one load. Its force is watched by a band, which it leaves only
//! where it has about doubled or halved:
//!
//! * A pulse is over where its force has fallen below half of its peak and then doubles again
//!   from the lowest since, known to a fifth; the next begins where the force rises from there.
//! * What lies between is a rest, a load of its own, where it lasts more than ten times as long
//!   as the pulse before it took to fall below half; so is what follows the last pulse.
//! * A force that has hardly grown for more than ten times as long as it then takes to grow by
//!   half was a rest, too: a blow that reaches a fruit at rest is a pulse.

use crate::binary;

/// A rest lasts more than so many times the upper half of the pulse beside it; 1.
const REST: f64 = 10.0;
/// A force below this part of the peak counts as none; 1.
const NOTHING: f64 = 1.0 / 4096.0;
/// Each lower force that is noted is this part of the one before: at once, while it is above an
/// eighth of the peak and the load does not last; and now and then; 1.
const LOWER: [f64; 2] = [0.8, 0.99];
/// A force rises again from this many times the lowest, and has not where it falls back; 1.
const RISES: [f64; 2] = [1.1, 1.05];
/// A force that grows is looked at each time that it is so many times larger; 1.
const GROWS: f64 = 1.1;

/// A contact at a time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mark {
    /// s
    pub time: f64,
    /// Normal force; N.
    pub force: f64,
    /// Displacement; m.
    pub displacement: f64,
    /// Work on the normal contact since the pulse began; J.
    pub work: f64,
    /// The same on friction and rolling; J.
    pub friction_work: f64,
}

/// The pulse that a contact is in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pulse {
    /// Pulses and rests of the contact before it.
    pub number: u32,
    /// Whether the force has fallen below half of its peak.
    pub fallen: bool,
    /// Where the force rose or fell last: the lowest since it fell.
    pub last: Mark,
    /// Where the next pulse may have begun, if `rising`.
    pub rise: Mark,
    pub rising: bool,
    /// For how long the force had hardly grown before `rise`; once it has fallen, before `later`; s.
    pub still: f64,
    pub later: Mark,
    /// Largest force and displacement before it fell; N, m.
    pub peak: [f64; 2],
    /// When it fell; s.
    pub fell: f64,
    /// When the force that rises from its lowest grew last; s.
    pub grown: f64,
    /// When it had fallen below an eighth of its peak, or had fallen for as long as it took to
    /// fall below half; zero before; s.
    pub calm: f64,
}

binary!(Pulse {
    number,
    fallen,
    last,
    rise,
    rising,
    still,
    later,
    peak,
    fell,
    grown,
    calm
});
binary!(Mark {
    time,
    force,
    displacement,
    work,
    friction_work
});

/// A pulse or a rest that is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Load {
    /// s
    pub began: f64,
    /// s
    pub ended: f64,
    /// Largest normal force; N.
    pub force: f64,
    /// Largest displacement; m.
    pub displacement: f64,
    /// Energy that the normal contact kept, and did not give back later; J.
    pub work: f64,
    /// J
    pub friction_work: f64,
    pub resting: bool,
    /// When the force had fallen below half of its peak; s.
    pub fell: f64,
}

/// What a force that leaves its band is judged by.
pub(crate) struct Watched<'a> {
    /// Largest force and displacement since they are watched; N, m.
    pub peak: [f64; 2],
    /// The upper end of the band: the force was not larger before; N.
    pub above: f64,
    /// Elastic energy at a displacement; J.
    pub stored: &'a dyn Fn(f64) -> f64,
}

/// A force leaves its band.
pub(crate) struct Turn {
    /// Below the first, above the second; N. Zero as the first is half of the peak so far, and a
    /// negative one is looked at now and then.
    pub band: [f64; 2],
    /// Whether largest force and displacement are watched anew from now on.
    pub anew: bool,
    /// The pulse that is over, with the rest after it; the next began at [`Pulse::rise`].
    pub over: Option<(Load, Option<Load>)>,
}

impl Pulse {
    /// The force of a contact has left its band.
    ///
    /// * `began`: when the pulse did; s
    pub(crate) fn turn(&mut self, began: f64, now: Mark, watched: &Watched) -> Turn {
        match self.fallen {
            false if now.force > self.last.force => self.grow(began, now, watched),
            false => {
                (self.fallen, self.rising) = (true, false);
                (self.peak, self.last, self.fell) = (watched.peak, now, now.time);
                self.stay(began, now, true)
            }
            true => self.turn_low(began, now, watched),
        }
    }

    /// The force has grown further.
    fn grow(&mut self, began: f64, now: Mark, watched: &Watched) -> Turn {
        let since = now.time - self.rise.time;
        if self.rising && self.still > REST * since {
            let stored = (watched.stored)(self.rise.displacement);
            let most = [self.rise.force, self.rise.displacement];
            let mut load = self.load_until(began, self.rise, most, stored);
            load.resting = true;
            return self.part(now, load, None, stored);
        }
        let still = now.time - self.last.time;
        let factor = match still > self.last.time - began {
            true => {
                (self.rising, self.rise, self.still) = (true, watched.rising(now), still);
                1.5
            }
            // The speed of a later pulse is the largest that is seen here.
            false if self.number > 0 => GROWS,
            false => 2.0,
        };
        self.last = now;
        Turn {
            band: [0.0, factor * now.force],
            anew: false,
            over: None,
        }
    }

    /// The force falls further, or rises again.
    fn turn_low(&mut self, began: f64, now: Mark, watched: &Watched) -> Turn {
        let [_, falls_back] = RISES;
        if now.force <= self.last.force {
            (self.last, self.rising) = (now, false);
            return self.stay(began, now, true);
        }
        if self.rising && now.force < falls_back * self.base() {
            self.rising = false;
            return self.stay(began, now, false);
        }
        let still = now.time - self.grown;
        if !self.rising {
            (self.rising, self.rise, self.still) = (true, watched.rising(now), 0.0);
        } else if still > self.still {
            (self.later, self.still) = (watched.rising(now), still);
        }
        self.grown = now.time;
        if now.force < 2.0 * self.base() {
            return self.stay(began, now, false);
        }
        // Where it lay still for a while, it rises only after that.
        if self.still > REST * (now.time - self.later.time) {
            self.rise = self.later;
        }
        let stored = (watched.stored)(self.rise.displacement);
        let most = [self.rise.force, self.rise.displacement];
        let (pulse, rest) = self.parts(began, (self.rise, stored), most, watched.stored);
        let ended = pulse.ended.min(self.end());
        self.part(now, Load { ended, ..pulse }, rest, stored)
    }

    /// When a pulse that has fallen is over; s.
    fn end(&self) -> f64 {
        match self.calm > 0.0 {
            true => self.calm.min(self.last.time),
            false => self.last.time,
        }
    }

    /// What counts as the lowest force; N.
    fn base(&self) -> f64 {
        self.last.force.max(NOTHING * self.peak[0])
    }

    /// The band of a force that has fallen.
    fn stay(&mut self, began: f64, now: Mark, anew: bool) -> Turn {
        let base = self.base();
        let lasts = self.last.time - began > 2.0 * (self.fell - began);
        let [at_once, seldom] = LOWER;
        let calm = lasts || 8.0 * self.last.force < self.peak[0];
        if calm && self.calm == 0.0 {
            self.calm = now.time;
        }
        let lower = match calm {
            true => -(seldom * self.last.force).max(f64::MIN_POSITIVE),
            false => at_once * self.last.force,
        };
        let [rises, falls_back] = RISES;
        let band = match self.rising {
            true => [falls_back * base, (GROWS * now.force).min(2.0 * base)],
            false => [lower, rises * base],
        };
        let over = None;
        Turn { band, anew, over }
    }

    /// The next pulse begins.
    ///
    /// * `stored`: elastic energy there; J
    fn part(&mut self, now: Mark, pulse: Load, rest: Option<Load>, stored: f64) -> Turn {
        let next = Mark {
            work: self.rise.work - stored,
            ..self.rise
        };
        *self = Self {
            number: self.number + 1 + u32::from(rest.is_some()),
            last: Mark {
                work: now.work - next.work,
                friction_work: now.friction_work - next.friction_work,
                ..now
            },
            rise: next,
            ..Self::default()
        };
        Turn {
            band: [0.0, GROWS * now.force],
            anew: true,
            over: Some((pulse, rest)),
        }
    }

    /// The pulse up to a moment, and the rest where there was one.
    ///
    /// * `most`: largest force and displacement since they are watched; N, m
    /// * `at_end`: elastic energy then; J
    /// * `stored`: that at a displacement; J
    pub(crate) fn parts(
        &self,
        began: f64,
        (end, at_end): (Mark, f64),
        most: [f64; 2],
        stored: &dyn Fn(f64) -> f64,
    ) -> (Load, Option<Load>) {
        let low = self.last;
        if !self.fallen {
            return (self.load_until(began, end, most, at_end), None);
        }
        if end.time - self.end() <= REST * (self.fell - began) {
            return (self.load_until(began, end, self.peak, at_end), None);
        }
        let [force, displacement] = most;
        let mut pulse = self.load_until(began, low, self.peak, stored(low.displacement));
        pulse.ended = self.end();
        let rest = Load {
            began: self.end(),
            ended: end.time,
            force,
            displacement,
            work: end.work - at_end - pulse.work,
            friction_work: end.friction_work - low.friction_work,
            resting: true,
            fell: end.time,
        };
        (pulse, Some(rest))
    }

    fn load_until(
        &self,
        began: f64,
        end: Mark,
        [force, displacement]: [f64; 2],
        stored: f64,
    ) -> Load {
        Load {
            began,
            ended: end.time,
            force,
            displacement,
            work: end.work - stored,
            friction_work: end.friction_work,
            resting: false,
            fell: if self.fallen { self.fell } else { end.time },
        }
    }
}

impl Watched<'_> {
    /// The moment in which a force rises, with the largest force before it.
    fn rising(&self, now: Mark) -> Mark {
        let force = match self.above > 0.0 {
            true => now.force.min(self.above),
            false => now.force,
        };
        Mark { force, ..now }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads of a history of forces, N, that begins and may end without one.
    ///
    /// * `step`: s
    fn loads(forces: &[f64], step: f64) -> Vec<Load> {
        let (mut pulse, mut began, mut all) = (Pulse::default(), 0.0, Vec::new());
        let ([mut below, mut above], mut peak, mut work) = ([0.0; 2], [0.0_f64; 2], 0.0);
        let mut before = Mark {
            force: forces[0],
            ..Mark::default()
        };
        for (number, &force) in forces.iter().enumerate() {
            let time = number as f64 * step;
            work += if number > 0 {
                0.5 * (force + before.force) * step
            } else {
                0.0
            };
            // As deep as it is pressed.
            let now = Mark {
                time,
                force,
                displacement: force,
                work,
                friction_work: 0.0,
            };
            peak = peak.map(|own| own.max(force));
            let limit = match below {
                0.0 => 0.5 * peak[0],
                own if own > 0.0 => own,
                own if number % 64 == 0 => -own,
                _ => -1.0,
            };
            if force < limit || force > above {
                let watched = Watched {
                    peak,
                    above,
                    stored: &|_| 0.0,
                };
                let turn = pulse.turn(began, now, &watched);
                [below, above] = turn.band;
                if turn.anew {
                    peak = [force; 2];
                }
                if let Some((load, rest)) = turn.over {
                    all.extend([Some(load), rest].into_iter().flatten());
                    began = pulse.rise.time;
                    work -= pulse.rise.work;
                }
            }
            before = now;
        }
        let end = Mark { work, ..before };
        let (load, rest) = pulse.parts(began, (end, 0.0), peak, &|_| 0.0);
        all.extend([Some(load), rest].into_iter().flatten());
        assert_eq!(
            pulse.number as usize + 1 + usize::from(rest.is_some()),
            all.len()
        );
        // Nothing of the work is lost or counted twice.
        let whole: f64 = forces
            .windows(2)
            .map(|own| 0.5 * (own[0] + own[1]) * step)
            .sum();
        let parts: f64 = all.iter().map(|own| own.work).sum();
        assert!((parts / whole - 1.0).abs() < 1e-9, "{parts} {whole}");
        all
    }

    const STEP: f64 = 2e-5;

    fn history(end: f64, force: impl Fn(f64) -> f64) -> Vec<f64> {
        let count = (end / STEP).round() as usize;
        (0..=count)
            .map(|own| force(own as f64 * STEP).max(0.0))
            .collect()
    }

    /// Half a sine of 10 ms and so many newtons, from a time on.
    fn blow(time: f64, from: f64, peak: f64) -> f64 {
        let share = (time - from) / 0.01;
        match (0.0..1.0).contains(&share) {
            true => peak * (std::f64::consts::PI * share).sin(),
            false => 0.0,
        }
    }

    #[test]
    fn one_blow_is_one_pulse() {
        for power in [0.5, 1.0, 1.5, 2.5] {
            let own = loads(
                &history(0.012, |time| blow(time, 0.0, 1.0).powf(power)),
                STEP,
            );
            assert_eq!(own.len(), 1, "{own:?}");
            assert!(
                (own[0].force - 1.0).abs() < 1e-5 && !own[0].resting,
                "{own:?}"
            );
        }
        // That sets in at once and dies away.
        let own = loads(&history(0.02, |time| 12.0 * (-time / 0.003).exp()), STEP);
        assert_eq!(own.len(), 1, "{own:?}");
    }

    #[test]
    fn two_humps_are_two_pulses_where_the_valley_is_below_half_of_both() {
        let humps = |valley: f64, second: f64| {
            let turn = std::f64::consts::TAU;
            let force = move |time: f64| match time {
                own if own < 0.005 => 100.0 * (turn * own / 0.02).sin(),
                own if own < 0.015 => {
                    100.0 - (100.0 - valley) * 0.5 * (1.0 - (turn * (own - 0.005) / 0.02).cos())
                }
                own if own < 0.025 => {
                    valley + (second - valley) * 0.5 * (1.0 - (turn * (own - 0.015) / 0.02).cos())
                }
                own => second * (1.0 - (own - 0.025) / 0.005),
            };
            loads(&history(0.03, force), STEP)
        };
        for (valley, second, wanted) in [
            (55.0, 100.0, 1),
            (45.0, 100.0, 2),
            (30.0, 80.0, 2),
            (30.0, 58.0, 1),
            (2.0, 400.0, 2),
        ] {
            let own = humps(valley, second);
            assert_eq!(own.len(), wanted, "{valley} {second}: {own:?}");
            let last = own[wanted - 1].force;
            assert!((last / second.max(if wanted == 1 { 100.0 } else { 0.0 }) - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_blow_within_a_load_that_lasts_is_a_pulse_and_the_load_is_told_apart() {
        // A fruit that falls, comes to rest, and is struck through its neighbours twice.
        let settled = |time: f64| 5.0 * (1.0 - (-time / 0.004).exp());
        let own = loads(
            &history(2.0, |time| {
                settled(time)
                    + blow(time, 0.0, 90.0)
                    + blow(time, 1.0, 210.0)
                    + blow(time, 1.5, 60.0)
            }),
            STEP,
        );
        let found: Vec<(bool, f64)> = own
            .iter()
            .map(|own| (own.resting, own.force.round()))
            .collect();
        assert_eq!(
            found,
            [
                (false, 94.0),
                (true, 5.0),
                (false, 215.0),
                (true, 6.0),
                (false, 65.0),
                (true, 5.0)
            ],
            "{own:#?}"
        );
        for (load, began) in own.iter().step_by(2).zip([0.0, 1.0, 1.5]) {
            assert!((load.began - began).abs() < 1e-3, "{load:?}");
            assert!(load.ended - load.began < 0.0125, "{load:?}");
        }
        // One that was laid down, not dropped, so that its load only grew.
        let laid = |time: f64| 5.0 * (time / 0.2).min(1.0);
        let own = loads(
            &history(2.0, |time| laid(time) + blow(time, 1.0, 210.0)),
            STEP,
        );
        let found: Vec<bool> = own.iter().map(|own| own.resting).collect();
        assert_eq!(found, [true, false, true], "{own:#?}");
        assert!(
            (own[1].force - 215.0).abs() < 0.1 && own[1].began > 0.999,
            "{own:#?}"
        );
    }

    #[test]
    fn a_blow_after_the_ringing_has_died_away_is_a_pulse_of_its_own() {
        // A fruit that is laid down swings about its weight, higher and lower than it.
        for (decay, turn) in [(0.01, 250.0), (0.02, 400.0), (0.05, 90.0), (0.004, 900.0)] {
            for from in [0.15, 0.2, 1.0, 1.03, 3.0] {
                let weight = |time: f64| 1.82 * (1.0 - (-time / decay).exp() * (turn * time).cos());
                let force = |time: f64| weight(time) + blow(time, from, 180.0);
                let own = loads(&history(from + 0.5, force), STEP);
                let hard: Vec<&Load> = own.iter().filter(|own| own.force > 50.0).collect();
                let [hard] = hard[..] else {
                    panic!("{decay} {turn} {from}: {own:#?}");
                };
                assert!(!hard.resting && hard.began > from - 1e-3, "{hard:?}");
                assert!(hard.ended - hard.began < 0.0125, "{hard:?}");
                // The rests are as light as the weight, with what it swung to.
                let rests = own.iter().filter(|own| own.resting);
                assert!(rests.clone().count() > 0, "{own:#?}");
                for rest in rests {
                    assert!(rest.force < 3.7, "{rest:?}");
                }
            }
        }
    }

    #[test]
    fn a_blow_that_dies_away_slowly_is_as_wide_as_its_upper_half() {
        let force = |time: f64| 800.0 * (time / 3e-4).min(1.0) * (-time / 0.002).exp() + 3.0;
        let own = loads(&history(0.04, force), STEP);
        assert!(
            own[0].force > 600.0 && own[0].fell - own[0].began < 0.002,
            "{own:?}"
        );
    }

    #[test]
    fn a_load_that_ripples_is_one_and_a_load_that_swings_is_many() {
        let swing = |share: f64| {
            let turn = std::f64::consts::TAU * 15.0;
            let force = move |time: f64| 20.0 * (1.0 - share * (turn * time).cos());
            loads(&history(4.0, force), STEP)
        };
        assert_eq!(swing(0.2).len(), 1);
        let own = swing(0.8);
        assert!((58..=61).contains(&own.len()), "{}", own.len());
        // A second run of it is as hard as the first.
        let most = |own: &[Load]| own.iter().map(|own| own.work).fold(0.0, f64::max);
        assert!((most(&own[2..30]) / most(&own[30..58]) - 1.0).abs() < 0.01);
    }
}
