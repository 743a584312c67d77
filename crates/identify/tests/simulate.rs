//! Simulated impacts against reference values that were computed elsewhere:
//! with two independent integrators, or in closed form (the tables of check
//! values, 10 digits).

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_identify::rig::simulate::{ImpactSummary, simulate_impact};

/// Relative tolerance of the tables.
const TOLERANCE: f64 = 1e-8;
/// The force is flat at its peak, which makes the time of it less certain.
const TIME_OF_PEAK_TOLERANCE: f64 = 1e-6;

struct Case {
    name: &'static str,
    law: &'static str,
    /// kg, m/s, m/s².
    mass: f64,
    velocity: f64,
    gravity: f64,
    end: EndRule,
    expected: &'static [(&'static str, f64)],
}

const CASES: &[Case] = &[
    Case {
        name: "hertz",
        law: "hertz(k=753599)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 42.49953084),
            ("max_displacement", 0.001470604469),
            ("contact_duration", 0.008656787282),
            ("restitution", 1.0),
            ("absorbed_energy", 0.0),
            ("impulse", 0.2),
        ],
    },
    Case {
        name: "kuwabara_kono",
        law: "kuwabara-kono(k=753599, c=1524)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 32.86620939),
            ("time_of_peak_force", 0.002610715969),
            ("max_displacement", 0.001109922018),
            ("time_of_max_displacement", 0.003867726583),
            ("force_at_max_displacement", 27.86628108),
            ("contact_duration", 0.007650136965),
            ("final_displacement", 0.0004834733915),
            ("separation_velocity", 0.2390715645),
            ("restitution", 0.4781431291),
            ("absorbed_energy", 0.0192844787),
            ("impulse", 0.1478143129),
        ],
    },
    Case {
        name: "kuwabara_kono at 0.1 m/s",
        law: "kuwabara-kono(k=753599, c=1524)",
        mass: 0.2,
        velocity: 0.1,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 4.891984058),
            ("max_displacement", 0.0003274384107),
            ("contact_duration", 0.01087599544),
            ("restitution", 0.5713993684),
            ("absorbed_energy", 0.0006735027618),
        ],
    },
    Case {
        name: "kuwabara_kono at 0.27 m/s",
        law: "kuwabara-kono(k=753599, c=1524)",
        mass: 0.2,
        velocity: 0.27,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 15.81471015),
            ("max_displacement", 0.0006967753425),
            ("contact_duration", 0.008760593468),
            ("restitution", 0.5143829387),
            ("absorbed_energy", 0.005361140302),
        ],
    },
    Case {
        name: "kuwabara_kono at 0.5 m/s",
        law: "kuwabara-kono(k=753599, c=1524)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 32.86620939),
            ("max_displacement", 0.001109922018),
            ("contact_duration", 0.007650136965),
            ("restitution", 0.4781431291),
            ("absorbed_energy", 0.0192844787),
        ],
    },
    Case {
        name: "kuwabara_kono at 1.0 m/s",
        law: "kuwabara-kono(k=753599, c=1524)",
        mass: 0.2,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 75.19656864),
            ("max_displacement", 0.001868646369),
            ("contact_duration", 0.006559592582),
            ("restitution", 0.4371027931),
            ("absorbed_energy", 0.08089411483),
        ],
    },
    Case {
        name: "kuwabara_kono scaled, B = 0.01",
        law: "kuwabara-kono(k=1, c=0.01)",
        mass: 1.0,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.9885474396),
            ("contact_duration", 3.2117983),
            ("max_displacement", 1.08834576),
            ("peak_force", 1.135443261),
            ("final_displacement", 0.009885474396),
        ],
    },
    Case {
        name: "kuwabara_kono scaled, B = 0.09",
        law: "kuwabara-kono(k=1, c=0.09)",
        mass: 1.0,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.9028517712),
            ("contact_duration", 3.163153248),
            ("max_displacement", 1.05014434),
            ("peak_force", 1.079132003),
            ("final_displacement", 0.08125665941),
        ],
    },
    Case {
        name: "kuwabara_kono scaled, B = 0.25",
        law: "kuwabara-kono(k=1, c=0.25)",
        mass: 1.0,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.7600371605),
            ("contact_duration", 3.073379428),
            ("max_displacement", 0.9826972068),
            ("peak_force", 0.9944130893),
            ("final_displacement", 0.1900092901),
        ],
    },
    Case {
        name: "kuwabara_kono scaled, B = 0.64",
        law: "kuwabara-kono(k=1, c=0.64)",
        mass: 1.0,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.5253709375),
            ("contact_duration", 2.889304985),
            ("max_displacement", 0.8548438041),
            ("peak_force", 0.8938770686),
            ("final_displacement", 0.3362374),
        ],
    },
    Case {
        name: "kuwabara_kono scaled, B = 2.25",
        law: "kuwabara-kono(k=1, c=2.25)",
        mass: 1.0,
        velocity: 1.0,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.1864896747),
            ("contact_duration", 2.415504061),
            ("max_displacement", 0.5792609961),
            ("peak_force", 1.075370942),
            ("final_displacement", 0.4196017681),
        ],
    },
    Case {
        name: "kelvin_voigt",
        law: "kelvin-voigt(k=30000, c=40)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 31.3805721),
            ("time_of_peak_force", 0.002104212207),
            ("max_displacement", 0.0009097341079),
            ("time_of_max_displacement", 0.003500157231),
            ("force_at_max_displacement", 27.29202324),
            ("contact_duration", 0.007000314462),
            ("final_displacement", 0.0003310464589),
            ("separation_velocity", 0.2482848441),
            ("restitution", 0.4965696883),
            ("absorbed_energy", 0.01883546362),
            ("impulse", 0.1496569688),
        ],
    },
    Case {
        name: "kelvin_voigt, gap",
        law: "kelvin-voigt(k=30000, c=40)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::GapZero,
        expected: &[
            ("contact_duration", 0.008396259542),
            ("restitution", 0.4318720331),
        ],
    },
    Case {
        name: "kelvin_voigt b<w0/sqrt2",
        law: "kelvin-voigt(k=30000, c=40.0)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("contact_duration", 0.007000314462),
            ("restitution", 0.4965696883),
        ],
    },
    Case {
        name: "kelvin_voigt w0/sqrt2<b<w0",
        law: "kelvin-voigt(k=30000, c=130.0)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("contact_duration", 0.005459997084),
            ("restitution", 0.1695683731),
        ],
    },
    Case {
        name: "kelvin_voigt b>w0",
        law: "kelvin-voigt(k=30000, c=250.0)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("contact_duration", 0.004313223609),
            ("restitution", 0.06749074812),
        ],
    },
    Case {
        name: "hunt_crossley",
        law: "hunt-crossley(k=753599, lambda=678239.1)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 38.71804601),
            ("time_of_peak_force", 0.003371397233),
            ("max_displacement", 0.001327837796),
            ("time_of_max_displacement", 0.004072295836),
            ("force_at_max_displacement", 36.46345804),
            ("contact_duration", 0.008945249464),
            ("final_displacement", 0.0),
            ("separation_velocity", 0.3839998945),
            ("restitution", 0.7679997891),
            ("absorbed_energy", 0.0102544081),
            ("impulse", 0.1767999789),
        ],
    },
    Case {
        name: "hunt_crossley, gap",
        law: "hunt-crossley(k=753599, lambda=678239.1)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::GapZero,
        expected: &[
            ("peak_force", 38.71804601),
            ("time_of_peak_force", 0.003371397233),
            ("max_displacement", 0.001327837796),
            ("time_of_max_displacement", 0.004072295836),
            ("force_at_max_displacement", 36.46345804),
            ("contact_duration", 0.008945249464),
            ("final_displacement", 0.0),
            ("separation_velocity", 0.3839998945),
            ("restitution", 0.7679997891),
            ("absorbed_energy", 0.0102544081),
            ("impulse", 0.1767999789),
        ],
    },
    Case {
        name: "lankarani_nikravesh",
        law: "lankarani-nikravesh(k=753599, restitution=0.7, impact_velocity=0.5)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 38.94642269),
            ("time_of_peak_force", 0.003483665033),
            ("max_displacement", 0.001345802026),
            ("time_of_max_displacement", 0.004105021113),
            ("force_at_max_displacement", 37.20592275),
            ("contact_duration", 0.008898949228),
            ("final_displacement", 0.0),
            ("separation_velocity", 0.3979862977),
            ("restitution", 0.7959725954),
            ("absorbed_energy", 0.009160690686),
            ("impulse", 0.1795972595),
        ],
    },
    Case {
        name: "flores",
        law: "flores(k=753599, restitution=0.7, impact_velocity=0.5)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 38.3905156),
            ("time_of_peak_force", 0.00304755301),
            ("max_displacement", 0.001271823608),
            ("time_of_max_displacement", 0.003969217342),
            ("force_at_max_displacement", 34.18067516),
            ("contact_duration", 0.009113236938),
            ("final_displacement", 0.0),
            ("separation_velocity", 0.3415920999),
            ("restitution", 0.6831841997),
            ("absorbed_energy", 0.01333148373),
            ("impulse", 0.16831842),
        ],
    },
    Case {
        name: "herbert_mcwhannell",
        law: "herbert-mcwhannell(k=753599, restitution=0.7, impact_velocity=0.5)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 38.47572051),
            ("time_of_peak_force", 0.003195080855),
            ("max_displacement", 0.001298214438),
            ("time_of_max_displacement", 0.004017983591),
            ("force_at_max_displacement", 35.25006854),
            ("contact_duration", 0.009029353276),
            ("final_displacement", 0.0),
            ("separation_velocity", 0.3613413245),
            ("restitution", 0.7226826491),
            ("absorbed_energy", 0.01194324472),
            ("impulse", 0.1722682649),
        ],
    },
    Case {
        name: "tsuji",
        law: "tsuji(k=753599, restitution=0.7, mass=0.2)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 35.59385257),
            ("time_of_peak_force", 0.003685889228),
            ("max_displacement", 0.001288232855),
            ("time_of_max_displacement", 0.004144726028),
            ("force_at_max_displacement", 34.8443101),
            ("contact_duration", 0.008054742723),
            ("final_displacement", 0.0003429179074),
            ("separation_velocity", 0.3591006805),
            ("restitution", 0.718201361),
            ("absorbed_energy", 0.01210467013),
            ("impulse", 0.1718201361),
        ],
    },
    Case {
        name: "tsuji, gap",
        law: "tsuji(k=753599, restitution=0.7, mass=0.2)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::GapZero,
        expected: &[("restitution", 0.7), ("contact_duration", 0.009019437107)],
    },
    Case {
        name: "adams_impact",
        law: "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")",
        mass: 0.0048,
        velocity: 3.13,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 12.82377044),
            ("time_of_peak_force", 0.0019076921),
            ("max_displacement", 0.004083855017),
            ("time_of_max_displacement", 0.002001310692),
            ("contact_duration", 0.003719021913),
            ("final_displacement", 0.001261685265),
            ("separation_velocity", 2.433668401),
            ("restitution", 0.7775298405),
            ("absorbed_energy", 0.009297979477),
        ],
    },
    Case {
        name: "adams_impact with gravity",
        law: "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.001 mm\")",
        mass: 0.0048,
        velocity: 3.13,
        gravity: 9.81,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 12.90173769),
            ("time_of_peak_force", 0.001910504209),
            ("max_displacement", 0.004096912182),
            ("time_of_max_displacement", 0.002003849136),
            ("contact_duration", 0.003724969797),
            ("final_displacement", 0.001261984778),
            ("separation_velocity", 2.434771985),
            ("restitution", 0.7778824234),
            ("absorbed_energy", 0.009285084911),
        ],
    },
    Case {
        name: "adams_impact, d = 0.1 mm",
        law: "adams-impact(k=\"0.868 N/mm^1.91\", e=1.91, c=\"5.56e-4 N s/mm\", d=\"0.1 mm\")",
        mass: 0.0048,
        velocity: 3.13,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 12.85582461),
            ("time_of_peak_force", 0.001906690898),
            ("max_displacement", 0.004089210183),
            ("time_of_max_displacement", 0.002000197408),
            ("contact_duration", 0.003716986974),
            ("final_displacement", 0.001262985781),
            ("separation_velocity", 2.438462013),
            ("restitution", 0.7790613461),
            ("absorbed_energy", 0.009241927223),
        ],
    },
    Case {
        name: "walton_braun",
        law: "walton-braun(k1=40000, k2=111111.11111111111)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("restitution", 0.6),
            ("max_displacement", 0.001118033989),
            ("peak_force", 44.72135955),
            ("final_displacement", 0.0007155417528),
            ("contact_duration", 0.005619851785),
            ("absorbed_energy", 0.016),
        ],
    },
    Case {
        name: "thornton",
        law: "thornton(E_star=5e6, R_star=0.04, yield_pressure=3e5)",
        mass: 0.2,
        velocity: 0.5,
        gravity: 0.0,
        end: EndRule::ForceZero,
        expected: &[
            ("peak_force", 43.23201706),
            ("max_displacement", 0.001265200122),
            ("restitution", 0.794065478),
            ("contact_duration", 0.007233475514),
            ("absorbed_energy", 0.009236500417),
            ("final_displacement", 0.0003536361553),
        ],
    },
];

fn field(summary: &ImpactSummary, name: &str) -> f64 {
    match name {
        "peak_force" => summary.peak_force,
        "time_of_peak_force" => summary.time_of_peak_force,
        "max_displacement" => summary.max_displacement,
        "time_of_max_displacement" => summary.time_of_max_displacement,
        "force_at_max_displacement" => summary.force_at_max_displacement,
        "contact_duration" => summary.contact_duration,
        "final_displacement" => summary.final_displacement,
        "separation_velocity" => summary.separation_velocity,
        "restitution" => summary.restitution,
        "absorbed_energy" => summary.absorbed_energy,
        "impulse" => summary.impulse,
        other => panic!("no field {other}"),
    }
}

#[test]
fn reference_every_law_in_the_tables() {
    let mut wrong = Vec::new();
    for case in CASES {
        let law = parse_law(case.law).unwrap().complete().unwrap();
        let summary =
            simulate_impact(&law, case.mass, case.velocity, case.gravity, case.end).unwrap();
        for &(name, expected) in case.expected {
            let found = field(&summary, name);
            let tolerance = if name == "time_of_peak_force" {
                TIME_OF_PEAK_TOLERANCE
            } else {
                TOLERANCE
            };
            // A quantity that is zero is held against the scale of its case.
            let scale = if expected == 0.0 {
                1e-3 * case.velocity.min(1.0)
            } else {
                expected.abs()
            };
            if ((found - expected) / scale).abs() > tolerance {
                wrong.push(format!(
                    "{}: {name} {found:.12e}, expected {expected:.10e}",
                    case.name
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The separation of Kuwabara-Kono obeys d = (c/k) v (the force is zero).
#[test]
fn closed_form_separation_of_kuwabara_kono() {
    let law = parse_law("kuwabara-kono(k=394931, c=681)")
        .unwrap()
        .complete()
        .unwrap();
    let found = simulate_impact(&law, 0.0563, 0.388, 0.0, EndRule::ForceZero).unwrap();
    let expected = 681.0 / 394_931.0 * found.separation_velocity;
    assert!((found.final_displacement / expected - 1.0).abs() < 1e-10);
    let work = 0.5 * 0.0563 * (0.388_f64.powi(2) - found.separation_velocity.powi(2));
    assert!((found.absorbed_energy / work - 1.0).abs() < 1e-12);
    let momentum = 0.0563 * 0.388 * (1.0 + found.restitution);
    assert!((found.impulse / momentum - 1.0).abs() < 1e-9);
}

#[test]
fn rejects_a_body_without_mass() {
    let law = parse_law("hertz(k=1e5)").unwrap().complete().unwrap();
    let error = simulate_impact(&law, 0.0, 0.5, 0.0, EndRule::ForceZero).unwrap_err();
    assert_eq!(
        error.to_string(),
        "mass is 0, but it must be a positive number"
    );
}

#[test]
fn rejects_bodies_that_stay_together() {
    let law = parse_law("kuwabara-kono(k=1e5, c=1e4)")
        .unwrap()
        .complete()
        .unwrap();
    let error = simulate_impact(&law, 0.2, 0.1, 9.81, EndRule::GapZero).unwrap_err();
    assert!(error.to_string().contains("still in contact"), "{error}");
}
