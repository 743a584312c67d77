//! The registry: every law by kind and by value.

use crate::error::Error;
use crate::granular_law::GranularLaw;
use crate::impact_law::ImpactLaw;
use crate::law::ContactLaw;
use crate::laws::user::{UserKind, UserLaw};
use crate::parameter::{LawDescription, RESTITUTION};
use windfall_numerics::unit::nearest_name::nearest_names;

/// Declares the registry from one list: variant and module, which hold a type
/// of the variant's name and its `DESCRIPTION`.
macro_rules! registry {
    (() $($variant:ident in $module:ident,)*) => {
        $(pub use crate::laws::$module::$variant;)*

        /// A force law without its parameters.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum LawKind {
            $(#[doc = concat!("[`", stringify!($variant), "`].")] $variant,)*
            /// One that the user defined, as a formula or a table.
            User(UserKind),
        }

        /// A force law with its parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Law {
            $(#[doc = concat!("[`", stringify!($variant), "`].")] $variant($variant),)*
            /// One that the user defined.
            User(UserLaw),
        }

        impl LawKind {
            /// Every built-in law, in the order in which they are listed to people.
            pub const ALL: [Self; [$(stringify!($variant)),*].len()] = [$(Self::$variant),*];

            /// Formula, parameters, behaviour at first touch and source.
            pub fn describe(self) -> &'static LawDescription {
                match self {
                    $(Self::$variant => &crate::laws::$module::DESCRIPTION,)*
                    Self::User(kind) => kind.description(),
                }
            }

            /// The law of these parameters without a check of their bounds;
            /// `None` when there are too many or too few.
            pub fn from_values(self, values: &[f64]) -> Option<Law> {
                Some(match self {
                    $(Self::$variant => Law::$variant($variant::from(<[f64; _]>::try_from(values).ok()?)),)*
                    Self::User(kind) => Law::User(UserLaw::new(kind, values)?),
                })
            }
        }

        impl Law {
            /// Which law it is.
            pub fn kind(&self) -> LawKind {
                match self {
                    $(Self::$variant(_) => LawKind::$variant,)*
                    Self::User(law) => LawKind::User(law.kind()),
                }
            }

            /// Its parameters in the order of the description; SI.
            ///
            /// Code that must not allocate converts the concrete law of
            /// [`with_law!`](crate::with_law) into `[f64; N]`.
            pub fn parameters(&self) -> Vec<f64> {
                match *self {
                    $(Self::$variant(law) => <[f64; _]>::from(law).to_vec(),)*
                    Self::User(law) => law.parameters().to_vec(),
                }
            }
        }
    };
}

/// Calls the macro `$then` with `$extra` and every built-in law: the one list of them.
#[macro_export]
macro_rules! for_each_law {
    (($($then:tt)*) $extra:tt) => {
        $($then)*! { $extra
            Hertz in hertz,
            KelvinVoigt in kelvin_voigt,
            KuwabaraKono in kuwabara_kono,
            PowerLaw in power,
            HuntCrossley in hunt_crossley,
            LankaraniNikravesh in lankarani_nikravesh,
            Flores in flores,
            HerbertMcWhannell in herbert_mcwhannell,
            Tsuji in tsuji,
            AdamsImpact in adams_impact,
            WaltonBraun in walton_braun,
            Thornton in thornton,
        }
    };
}

for_each_law! { (registry) () }

/// Evaluates an expression with the concrete type of a [`Law`].
///
/// The expression is compiled once per law, so that code generic over
/// [`ContactLaw`] needs no dispatch inside its loops.
///
/// ```
/// use windfall_contact::law::ContactLaw;
/// use windfall_contact::{expression::parse_law, with_law};
///
/// fn stiffness<const N: usize>(law: &impl ContactLaw<N>) -> f64 {
///     law.evaluate(1e-3, 0.0, 0.0).by_displacement
/// }
/// let law = parse_law("kelvin-voigt(k=30000, c=40)")?.complete()?;
/// assert_eq!(with_law!(&law, concrete => stiffness(concrete)), 30000.0);
/// # Ok::<(), windfall_contact::error::Error>(())
/// ```
#[macro_export]
macro_rules! with_law {
    ($law:expr, $concrete:ident => $body:expr) => {
        $crate::for_each_law! { ($crate::with_law_arms) ($law, $concrete => $body) }
    };
}

/// The arms of [`with_law!`](crate::with_law).
#[doc(hidden)]
#[macro_export]
macro_rules! with_law_arms {
    (($law:expr, $concrete:ident => $body:expr) $($variant:ident in $module:ident,)*) => {
        match $law {
            $($crate::laws::kind::Law::$variant($concrete) => $body,)*
            $crate::laws::kind::Law::User($concrete) => $body,
        }
    };
}

impl LawKind {
    /// Name in law expressions.
    pub fn name(self) -> &'static str {
        self.describe().name
    }

    /// The law of a name; case and `_` or `-` do not count.
    ///
    /// # Errors
    /// [`Error::UnknownLaw`] with the laws of similar name.
    pub fn from_name(name: &str) -> Result<Self, Error> {
        Self::from_name_among(name, &[])
    }

    /// The law of a name, among the built-in ones and those of the user.
    ///
    /// # Errors
    /// [`Error::UnknownLaw`] with the laws of similar name.
    pub fn from_name_among(name: &str, user: &[Self]) -> Result<Self, Error> {
        let folded = name.trim().to_lowercase().replace('_', "-");
        let all = || Self::ALL.into_iter().chain(user.iter().copied());
        let named = all().find(|kind| kind.name() == folded);
        named.ok_or_else(|| {
            let known: Vec<_> = all().map(Self::name).collect();
            Error::UnknownLaw {
                name: name.trim().into(),
                nearest: nearest_names(&folded, known.iter().copied()),
                known,
                place: None,
            }
        })
    }

    /// The law with these parameters, in the order of its description; SI.
    ///
    /// # Errors
    /// [`Error::ParameterCount`], and [`Error::OutOfBounds`] for the first value
    /// that is not finite or outside its bounds.
    pub fn with_parameters(self, values: &[f64]) -> Result<Law, Error> {
        let known: Vec<_> = values.iter().copied().map(Some).collect();
        (0..values.len().min(self.describe().parameters.len()))
            .try_for_each(|index| self.check_bounds(index, &known))?;
        self.from_values(values).ok_or_else(|| {
            let description = self.describe();
            Error::ParameterCount {
                law: description.name,
                expected: description.parameters.len(),
                names: description.parameters.iter().map(|p| p.name).collect(),
                found: values.len(),
            }
        })
    }

    /// Whether value `index`, if it is given, is within its bounds.
    pub(crate) fn check_bounds(self, index: usize, values: &[Option<f64>]) -> Result<(), Error> {
        let description = self.describe();
        let parameter = &description.parameters[index];
        let Some(value) = values[index] else {
            return Ok(());
        };
        if (parameter.lower..=parameter.upper).contains(&value) {
            return Ok(());
        }
        let unit = description.unit_of(index, values);
        let unit = unit.unwrap_or_else(|| parameter.unit.into());
        Err(Error::OutOfBounds {
            law: description.name,
            parameter: parameter.name,
            value,
            unit: if unit == "1" { String::new() } else { unit },
            lower: parameter.lower,
            upper: parameter.upper,
            place: None,
        })
    }
}

impl Law {
    /// Force before it is clamped to be repulsive; N. See [`ContactLaw`] for the
    /// arguments.
    pub fn force(&self, displacement: f64, rate: f64, peak: f64) -> f64 {
        with_law!(self, law => law.evaluate(displacement, rate, peak).force)
    }

    /// SI unit of parameter `index`, with numbers for the exponents: "N/m^1.91".
    pub fn unit_of(&self, index: usize) -> String {
        let values: Vec<_> = self.parameters().into_iter().map(Some).collect();
        let unit = self.kind().describe().unit_of(index, &values);
        unit.unwrap_or_default()
    }

    /// The restitution that the law takes as a parameter; 1. `None` for laws without, and for
    /// the user's. What the law delivers differs.
    pub fn nominal_restitution(&self) -> Option<f64> {
        match self {
            Self::User(_) => None,
            _ => {
                let index = self.kind().describe().index_of(RESTITUTION)?;
                self.parameters().get(index).copied()
            }
        }
    }

    /// The law in the terms of engines for granular matter.
    ///
    /// # Errors
    /// The law's name, and why it has no counterpart there.
    pub fn granular(&self) -> Result<GranularLaw, String> {
        let found = with_law!(self, law => law.granular());
        found.map_err(|why| format!("{}: {why}", self.kind().name()))
    }
}
