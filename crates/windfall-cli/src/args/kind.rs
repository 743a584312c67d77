//! Kinds of templates.

use clap::ValueEnum;
use windfall_campaign::settings::template::TemplateKind;

/// Rigs that have a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NewKind {
    /// Arm with encoder and force sensor that strikes a fruit on an anvil
    Pendulum,
    /// Body on a line: a cart on an incline, a drop hammer
    Carriage,
    /// Slow compression in a testing machine or a gripper
    Compression,
    /// Compression to a deformation that is held: stress relaxation
    Relaxation,
    /// Taps recorded by a microphone: acoustic firmness
    Acoustic,
    /// Drops repeated on one spot, for the critical impact energy
    Repeats,
    /// Fruit fall on a plate over a load cell and bounce
    Drop,
    /// Not a campaign but a scene: many fruit and a machine, simulated
    Scene,
    /// Variants of a scene, compared: pads and drop heights
    SceneStudy,
}

impl NewKind {
    /// The template of a campaign; `None` of a scene.
    pub fn template(self) -> Option<TemplateKind> {
        match self {
            Self::Pendulum => Some(TemplateKind::Pendulum),
            Self::Carriage => Some(TemplateKind::Carriage),
            Self::Compression => Some(TemplateKind::Compression),
            Self::Relaxation => Some(TemplateKind::Relaxation),
            Self::Acoustic => Some(TemplateKind::Acoustic),
            Self::Repeats => Some(TemplateKind::Repeats),
            Self::Drop => Some(TemplateKind::Drop),
            Self::Scene | Self::SceneStudy => None,
        }
    }
}
