//! The impacts of an eccentric drop in numbers.

use crate::eccentric::body::{Planar, State};
use crate::eccentric::contact::{Ending, Piece};
use crate::eccentric::flight::Flight;
use crate::eccentric::follow::EccentricSink;
use crate::eccentric::impact::EccentricImpact;
use crate::eccentric::shape::effective_mass_factor;
use crate::simulate::DropImpact;
use windfall_identify::rig::simulate::highest;

/// Periods of the free plate within which its force is highest.
const PERIODS: f64 = 1.25;

/// Collects the impacts of a drop.
pub(crate) struct EccentricTally<'a> {
    pub planar: &'a Planar,
    pub impacts: Vec<EccentricImpact>,
    touch: State,
}

impl<'a> EccentricTally<'a> {
    pub fn new(planar: &'a Planar) -> Self {
        Self {
            planar,
            impacts: Vec::new(),
            touch: State::default(),
        }
    }
}

/// Puts `value` at `time` into a peak, if it is larger.
fn raise(peak: &mut f64, time_of_peak: &mut f64, (value, time): (f64, f64)) {
    if value > *peak {
        (*peak, *time_of_peak) = (value, time);
    }
}

impl EccentricSink for EccentricTally<'_> {
    fn flight(&mut self, start: f64, flight: &Flight, duration: f64) {
        let (Some(found), Some(plate)) = (self.impacts.last_mut(), &self.planar.plate) else {
            return;
        };
        // The plate rings down: its force is highest within the first period.
        let period = std::f64::consts::TAU * (plate.mass / plate.stiffness).sqrt();
        let end = (PERIODS * period).min(duration);
        let force = |part: f64| {
            let support = self.planar.support_force(&flight.at(part * end));
            support.unwrap_or(0.0)
        };
        let slope = |part: f64| {
            let state = flight.at(part * end);
            let support = self.planar.support_force(&state).unwrap_or(0.0);
            -(plate.stiffness * state.plate_velocity + plate.damping * support / plate.mass)
        };
        let at = highest(1.0, force, slope);
        let impact = &mut found.impact;
        raise(
            &mut impact.peak_support_force,
            &mut impact.time_of_peak_support_force,
            (force(at), start + at * end),
        );
    }

    fn touch(&mut self, time: f64, state: &State) {
        let planar = self.planar;
        let lowest = planar.lowest_point(state);
        self.touch = *state;
        self.impacts.push(EccentricImpact {
            impact: DropImpact {
                onset_time: time,
                impact_velocity: planar.rate(state, &lowest),
                ..DropImpact::LASTING
            },
            rotation: state.rotation,
            lever_arm: -lowest.slope,
            effective_mass_factor: effective_mass_factor(planar.mass, lowest.slope, planar.inertia),
            velocity_before: state.velocity_y,
            angular_velocity_before: state.spin,
            tangential_velocity_before: state.velocity_x,
            translation_energy_before: planar.translation_energy(state),
            rotation_energy_before: planar.rotation_energy(state),
            ..EccentricImpact::LASTING
        });
    }

    fn contact(&mut self, start: f64, piece: &Piece) {
        let Some(found) = self.impacts.last_mut() else {
            return;
        };
        let impact = &mut found.impact;
        let (phase, end) = (&piece.phase, piece.to);
        let forces = |sigma: f64| phase.forces(&piece.at(sigma).state);
        let time = |sigma: f64| start + piece.time_at(sigma);

        let normal = |sigma: f64| forces(sigma).normal;
        let at = highest(end, normal, |sigma| forces(sigma).normal_rate);
        raise(
            &mut impact.peak_contact_force,
            &mut impact.time_of_peak_contact_force,
            (normal(at), time(at)),
        );

        let support = |sigma: f64| {
            let state = piece.at(sigma).state;
            let support = self.planar.support_force(&state);
            support.unwrap_or_else(|| phase.forces(&state).normal)
        };
        let at = highest(end, support, |sigma| {
            let state = piece.at(sigma).state;
            phase.support_rate(&state, &phase.forces(&state))
        });
        raise(
            &mut impact.peak_support_force,
            &mut impact.time_of_peak_support_force,
            (support(at), time(at)),
        );

        let depth = |sigma: f64| piece.at(sigma).state.displacement;
        let at = highest(end, depth, |sigma| forces(sigma).rate);
        raise(
            &mut impact.max_displacement,
            &mut impact.time_of_max_displacement,
            (depth(at), time(at)),
        );
    }

    fn ending(&mut self, start: f64, ending: &Ending) {
        let Some(found) = self.impacts.last_mut() else {
            return;
        };
        let (planar, from, touching) = (self.planar, &self.touch, &ending.touching);
        let to = &touching.state;
        found.impact.impulse = touching.impulse;
        found.friction_impulse = planar.mass * (to.velocity_x - from.velocity_x);
        found.contact_energy = touching.absorbed;
        found.sliding_energy = touching.sliding;
        found.support_energy = touching.support;
        if !ending.left {
            return;
        }
        let rate = planar.rate(to, &planar.lowest_point(to));
        let impact = &mut found.impact;
        impact.force_end_time = start + ending.force_end;
        impact.separation_time = start + ending.time;
        impact.separation_velocity = to.velocity_y;
        impact.restitution = to.velocity_y / -from.velocity_y;
        impact.contact_restitution = -rate / impact.impact_velocity;
        let fallen = planar.height(from) - planar.height(to);
        impact.absorbed_energy = planar.mass
            * (0.5 * (from.velocity_y - to.velocity_y) * (from.velocity_y + to.velocity_y)
                + planar.gravity * fallen);
        found.angular_velocity = to.spin;
        found.tangential_velocity = to.velocity_x;
        found.translation_energy = planar.translation_energy(to);
        found.rotation_energy = planar.rotation_energy(to);
        found.plate_energy_change = planar.plate_energy(to) - planar.plate_energy(from);
        found.height_energy = planar.mass * planar.gravity * fallen;
    }
}
