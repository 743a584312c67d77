//! What is known of a bench only with an uncertainty, which all its impacts share.

use crate::rig::kind::Rig;
use serde::Serialize;
use windfall_signal::impact::Impact;
use windfall_signal::response::Response;

/// Number of quantities.
const QUANTITIES: usize = 13;

/// A quantity of the bench that may be uncertain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum BenchQuantity {
    /// Moment of inertia of a pendulum; kg m².
    Inertia,
    /// Arm of a pendulum; m.
    Arm,
    /// Mass of a carriage, or of a pendulum in the torque of gravity; kg.
    Mass,
    /// Distance of a pendulum's centre of mass from the pivot; m.
    CentreOfMass,
    /// What the force reads over what it is; 1.
    ForceGain,
    /// What the displacement reads over what it is; 1.
    DisplacementGain,
    /// Time by which the force comes later than the displacement; s.
    ForceDelay,
    /// Corner of a filter of first order that the force passes; Hz.
    ForceFilter,
    /// Natural frequency of the force sensor; Hz.
    SensorFrequency,
    /// Its damping ratio; 1.
    SensorDamping,
    /// Natural frequency of the arm's bending; Hz.
    ArmFrequency,
    /// Its damping ratio; 1.
    ArmDamping,
    /// Bending of the arm by a force; m/N.
    ArmCompliance,
}

impl BenchQuantity {
    /// All of them.
    pub const ALL: [Self; QUANTITIES] = [
        Self::Inertia,
        Self::Arm,
        Self::Mass,
        Self::CentreOfMass,
        Self::ForceGain,
        Self::DisplacementGain,
        Self::ForceDelay,
        Self::ForceFilter,
        Self::SensorFrequency,
        Self::SensorDamping,
        Self::ArmFrequency,
        Self::ArmDamping,
        Self::ArmCompliance,
    ];

    /// Its name in campaign.toml and in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertia => "inertia",
            Self::Arm => "arm",
            Self::Mass => "mass",
            Self::CentreOfMass => "centre_of_mass",
            Self::ForceGain => "force.gain",
            Self::DisplacementGain => "displacement.gain",
            Self::ForceDelay => "force.delay",
            Self::ForceFilter => "force_filter",
            Self::SensorFrequency => "sensor_frequency",
            Self::SensorDamping => "sensor_damping",
            Self::ArmFrequency => "arm_frequency",
            Self::ArmDamping => "arm_damping",
            Self::ArmCompliance => "arm_compliance",
        }
    }

    /// SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Inertia => "kg m^2",
            Self::Arm | Self::CentreOfMass => "m",
            Self::Mass => "kg",
            Self::ForceGain | Self::DisplacementGain | Self::SensorDamping | Self::ArmDamping => {
                "1"
            }
            Self::ForceDelay => "s",
            Self::ForceFilter | Self::SensorFrequency | Self::ArmFrequency => "Hz",
            Self::ArmCompliance => "m/N",
        }
    }

    /// Where it stands in what the instruments do; `None` of the others, and of what they do not.
    pub fn of_response(self, response: &mut Response) -> Option<&mut f64> {
        match self {
            Self::ForceFilter => response.pole.as_mut(),
            Self::SensorFrequency => response.sensor.as_mut().map(|own| &mut own.frequency),
            Self::SensorDamping => response.sensor.as_mut().map(|own| &mut own.damping),
            Self::ArmFrequency => response.arm.as_mut().map(|own| &mut own.swing.frequency),
            Self::ArmDamping => response.arm.as_mut().map(|own| &mut own.swing.damping),
            Self::ArmCompliance => response.arm.as_mut().map(|own| &mut own.compliance),
            _ => None,
        }
    }

    /// Its value on a rig, as the fits take it.
    pub fn value(self, rig: &Rig) -> f64 {
        match (self, rig) {
            (Self::Inertia, Rig::Pendulum(own)) => own.inertia,
            (Self::Arm, Rig::Pendulum(own)) => own.arm,
            (Self::Mass, Rig::Pendulum(own)) => own.mass,
            (Self::CentreOfMass, Rig::Pendulum(own)) => own.centre_of_mass,
            (Self::Mass, Rig::Carriage(own)) => own.mass,
            (Self::ForceGain | Self::DisplacementGain, _) => 1.0,
            _ => 0.0,
        }
    }
}

/// Standard uncertainties of the quantities of a bench; SI, zero where a value is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BenchSd {
    /// In the order of [`BenchQuantity::ALL`].
    sd: [f64; QUANTITIES],
    /// Whether the displacement comes from turns of the arm, and is as long as the arm.
    pub turns: bool,
    /// The quantity that was estimated from force = mass × acceleration: where another one
    /// moves, it follows.
    pub tied: Option<BenchQuantity>,
}

impl BenchSd {
    /// The standard uncertainty of a quantity; SI.
    pub fn of(&self, quantity: BenchQuantity) -> f64 {
        self.sd[quantity as usize]
    }

    /// The same with the uncertainty of one quantity; SI.
    #[must_use]
    pub fn with(mut self, quantity: BenchQuantity, sd: f64) -> Self {
        self.sd[quantity as usize] = sd;
        self
    }

    /// Standard uncertainty of the mass that the contact feels, as a part of it; 1.
    pub fn relative_mass(&self, rig: &Rig) -> f64 {
        let relative = |quantity: BenchQuantity| self.of(quantity) / quantity.value(rig);
        match rig {
            Rig::Pendulum(_) => {
                relative(BenchQuantity::Inertia).hypot(2.0 * relative(BenchQuantity::Arm))
            }
            Rig::Carriage(_) => relative(BenchQuantity::Mass),
        }
    }

    /// The same of mass × acceleration of the displacement, over the force; 1.
    pub fn relative_push(&self, rig: &Rig) -> f64 {
        let gains = [BenchQuantity::ForceGain, BenchQuantity::DisplacementGain];
        let gains = gains.into_iter().map(|own| self.of(own));
        gains.fold(self.relative_mass(rig), f64::hypot)
    }

    /// The same of the kinetic energy: where the displacement is as long as the arm, the arm
    /// cancels; 1.
    pub fn relative_energy(&self, rig: &Rig) -> f64 {
        let mass = match rig {
            Rig::Pendulum(own) if self.turns => self.of(BenchQuantity::Inertia) / own.inertia,
            _ => self.relative_mass(rig),
        };
        mass.hypot(2.0 * self.of(BenchQuantity::DisplacementGain))
    }

    /// Quantities that are uncertain, and by how much.
    pub fn uncertain(&self) -> impl Iterator<Item = (BenchQuantity, f64)> {
        let all = BenchQuantity::ALL.into_iter().zip(self.sd);
        all.filter(|(_, sd)| *sd > 0.0)
    }

    /// An impact and its rig as they would be, had a quantity another value.
    ///
    /// * `step`: by how much the value is larger; SI
    pub(crate) fn moved(
        &self,
        (impact, rig): (&Impact, &Rig),
        quantity: BenchQuantity,
        step: f64,
    ) -> (Impact, Rig) {
        let (mut impact, mut rig) = (impact.clone(), *rig);
        let scale = |series: &mut Option<windfall_signal::impact::Series>, factor: f64| {
            if let Some(series) = series {
                series.values.iter_mut().for_each(|value| *value *= factor);
            }
        };
        // Mass × acceleration of the displacement, over what it was; what the force is, likewise,
        // and the displacement.
        let (mut push, mut force, mut way) = (1.0, 1.0, 1.0);
        match (quantity, &mut rig) {
            (BenchQuantity::Inertia, Rig::Pendulum(own)) => {
                push = 1.0 + step / own.inertia;
                own.inertia += step;
            }
            (BenchQuantity::Arm, Rig::Pendulum(own)) => {
                let factor = 1.0 + step / own.arm;
                own.arm += step;
                push = 1.0 / (factor * factor);
                if self.turns {
                    push = 1.0 / factor;
                    way = factor;
                }
            }
            (BenchQuantity::Mass, Rig::Pendulum(own)) => own.mass += step,
            (BenchQuantity::CentreOfMass, Rig::Pendulum(own)) => own.centre_of_mass += step,
            (BenchQuantity::Mass, Rig::Carriage(own)) => {
                push = 1.0 + step / own.mass;
                own.mass += step;
            }
            (BenchQuantity::ForceGain, _) => force = 1.0 / (1.0 + step),
            (BenchQuantity::DisplacementGain, _) => {
                way = 1.0 / (1.0 + step);
                push = way;
            }
            (BenchQuantity::ForceDelay, _) => {
                if let Some(force) = &mut impact.force {
                    force.times.iter_mut().for_each(|time| *time -= step);
                }
            }
            _ => (),
        }
        if self.tied != Some(quantity) {
            match (self.tied, &mut rig) {
                (Some(BenchQuantity::Inertia), Rig::Pendulum(own)) => own.inertia *= force / push,
                (Some(BenchQuantity::Mass), Rig::Carriage(own)) => own.mass *= force / push,
                (Some(BenchQuantity::ForceGain), _) => force *= push,
                _ => (),
            }
        }
        if force != 1.0 {
            scale(&mut impact.force, force);
        }
        if way != 1.0 {
            scale(&mut impact.displacement, way);
            // A velocity beside a displacement that does not turn has a sensor of its own.
            if self.turns {
                scale(&mut impact.rate, way);
            }
            let velocity = &mut impact.measured.impact_velocity;
            *velocity = velocity.map(|own| own * way);
        }
        (impact, rig)
    }
}
