//! The contacts of a scene in the terms of other engines, pair by pair of materials.

use crate::delivered::{Delivered, Ends, Force, text_of_delivered};
use crate::hertz::hertz;
use crate::pair::{Given, Pair, elastic, joined, linear, nothing, poisson, sizes};
use std::collections::BTreeMap;
use std::fmt::Write;
use windfall_contact::granular_law::Damping;
use windfall_contact::laws::kind::Law;
use windfall_files::text::quote::{comment_text, string_text};
use windfall_scene::interaction::Draws;
use windfall_scene::scene::Scene;

/// An engine whose contacts windfall can write, but which it does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// MSC Adams.
    Adams,
    /// YADE.
    Yade,
    /// MercuryDPM.
    MercuryDpm,
    /// Altair EDEM.
    Edem,
    /// Project Chrono, smooth contacts.
    Chrono,
}

/// One contact in another engine's terms.
#[derive(Clone, Debug, serde::Serialize, utoipa::ToSchema)]
pub struct ContactTerms {
    /// The two materials.
    pub between: [String; 2],
    /// What the engine is given.
    pub given: String,
    /// What is the law itself there.
    pub exact: String,
    /// What is not.
    pub approximate: String,
    /// Restitution that is delivered: of bodies of mean size, over the speeds of the law's card,
    /// or about that of the match.
    pub delivered: Vec<Delivered>,
}

impl Other {
    /// Its name, for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Adams => "Adams",
            Self::Yade => "YADE",
            Self::MercuryDpm => "MercuryDPM",
            Self::Edem => "EDEM",
            Self::Chrono => "Chrono",
        }
    }

    /// Name of the file that is written, and what begins a comment in it.
    pub fn file(self) -> (&'static str, &'static str) {
        match self {
            Self::Adams => ("contacts.adm", "! "),
            Self::Yade => ("contacts.py", "# "),
            Self::MercuryDpm => ("contacts_mercury.cpp", "// "),
            Self::Edem => ("contacts_edem.txt", ""),
            Self::Chrono => ("contacts_chrono.cpp", "// "),
        }
    }
}

/// Speeds at which a law is looked at that has no range, over that of the match; 1.
const BESIDE: [f64; 3] = [0.5, 1.0, 2.0];
/// How many are looked at over a range.
const LOOKS: u32 = 5;
/// The slowest of a range that begins at zero, over its fastest; 1.
const SLOWEST: f64 = 0.05;
/// Impact speed of the match where nothing is said; m/s.
const SPEED: f64 = 1.0;

/// The speed of the match, and those that are looked at; m/s.
fn speeds(asked: Option<f64>, range: Option<[f64; 2]>) -> (f64, Vec<f64>) {
    match range {
        Some([low, high]) if high > 0.0 => {
            let low = low.max(SLOWEST * high);
            let at = |share: f64| low * (high / low).powf(share);
            let looks = (0..LOOKS).map(|own| at(f64::from(own) / f64::from(LOOKS - 1)));
            (asked.unwrap_or(at(0.5)), looks.collect())
        }
        _ => {
            let speed = asked.unwrap_or(SPEED);
            (speed, BESIDE.map(|own| own * speed).to_vec())
        }
    }
}

/// Contacts that fruit of a scene can have, in the terms of an engine.
///
/// * `speed`: impact speed at which damping that is not the law's takes the same energy, m/s;
///   the middle of the range where it is left out
/// * `ranges`: of impact speeds in which laws were seen, by the pair of materials; m/s
pub fn contact_terms(
    other: Other,
    scene: &Scene,
    speed: Option<f64>,
    ranges: &BTreeMap<(usize, usize), [f64; 2]>,
) -> Vec<ContactTerms> {
    let mut all = Vec::new();
    for (&(a, b), interaction) in &scene.interactions {
        let Some((radius, mass)) = scene.mean_contact((a, b)) else {
            continue;
        };
        // Of the median fruit.
        let law = interaction.law_of(radius, &Draws::default(), None);
        let law = law.unwrap_or(interaction.law);
        let names = [scene.materials[a].as_str(), scene.materials[b].as_str()];
        let (speed, looks) = speeds(speed, ranges.get(&(a, b)).copied());
        let has_fruit = |own: usize| scene.fruit.iter().any(|fruit| fruit.material == own);
        let pair = Pair {
            names,
            interaction,
            law,
            radius,
            mass,
            speed,
            wall: !(has_fruit(a) && has_fruit(b)),
        };
        let own = match other {
            Other::Adams => adams(&pair),
            Other::Yade => yade(&pair),
            Other::MercuryDpm => mercury(&pair),
            Other::Edem => edem(&pair),
            Other::Chrono => chrono(&pair),
        };
        let (given, exact, mut approximate) = own.words;
        let delivered = own.felt.as_ref().map_or(Vec::new(), |(felt, ends)| {
            let at = |&speed: &f64| Delivered {
                speed,
                law: pair.restitution(speed),
                engine: pair.impact(speed).restitution(felt, *ends),
            };
            looks.iter().map(at).collect()
        });
        // Friction in Adams is another one anyway.
        let sheared = interaction.friction > 0.0 && !matches!(other, Other::Adams);
        if interaction.annuli > 1 && sheared && !given.is_empty() {
            let annuli = interaction.annuli;
            let friction = format!("friction has one spring there, here {annuli} annuli");
            approximate = joined(&[&approximate, &friction]);
        }
        all.push(ContactTerms {
            between: names.map(str::to_owned),
            given,
            exact,
            approximate,
            delivered,
        });
    }
    all
}

/// Contacts as the text of a file, with what is exact and what is not in its comments.
pub fn text_of_terms(other: Other, title: &str, terms: &[ContactTerms]) -> String {
    let (_, comment) = other.file();
    // Python would take the encoding from a title that names one.
    let first = match other {
        Other::Yade => "# -*- coding: utf-8 -*-\n",
        _ => "",
    };
    let mut text = format!(
        "{first}{comment}{}\n{comment}Contacts for {}, written by windfall. SI where no unit is named.\n",
        comment_text(title),
        other.title()
    );
    for own in terms {
        let [a, b] = &own.between;
        let _ = write!(
            text,
            "\n{comment}{} and {}\n{comment}exact: {}\n{comment}approximate: {}\n\
             {comment}restitution delivered: {}\n{}\n",
            comment_text(a),
            comment_text(b),
            own.exact,
            own.approximate,
            text_of_delivered(&own.delivered),
            own.given
        );
    }
    text
}

fn adams<'a>(pair: &Pair<'a>) -> Given<'a> {
    let Some((k, n)) = elastic(&pair.law) else {
        return nothing(pair);
    };
    let (c, depth, exact, approximate) = match (pair.law, pair.law.granular()) {
        (Law::AdamsImpact(own), _) => (own.c, own.d, true, String::new()),
        (Law::PowerLaw(own), _) if own.p == 0.0 || own.c == 0.0 => {
            (own.c, ABRUPT, true, String::new())
        }
        (_, Ok(own)) if own.damping == Damping::None => (0.0, ABRUPT, true, String::new()),
        (Law::KelvinVoigt(own), _) => (own.c, ABRUPT, true, String::new()),
        _ => {
            let depth = RAMP * pair.impact(pair.speed).depth;
            let c = pair.matched(|c| impact(k, n, c, depth), Ends::Force);
            (c, depth, false, pair.same_restitution())
        }
    };
    let mm = 1000.0_f64;
    let given = format!(
        "IMPACT(GAP, GAP_RATE, 0.0, {}, {n}, {}, {})",
        k / mm.powf(n),
        c / mm,
        depth * mm
    );
    let size = sizes(pair);
    let what = match exact {
        true => format!("the normal force, in mm, N and s{size}"),
        false => format!("the elastic force, in mm, N and s{size}"),
    };
    let approximate = joined(&[approximate.as_str(), "friction is Adams's own"]);
    Given {
        words: (given, what, approximate),
        felt: Some((Box::new(impact(k, n, c, depth)), Ends::Force)),
    }
}

/// The force of Adams' IMPACT: k dⁿ + c v, with damping that grows up to a depth.
///
/// # Source
/// MSC Software, Adams Solver user's guide, function IMPACT.
fn impact(k: f64, n: f64, c: f64, depth: f64) -> impl Fn(f64, f64) -> f64 {
    move |d: f64, v: f64| {
        let u = (d / depth).min(1.0);
        k * d.powf(n) + c * u * u * (3.0 - 2.0 * u) * v
    }
}

/// Penetration at which damping is whole where it is whole at once; m.
const ABRUPT: f64 = 1e-8;
/// The same where damping grows with the penetration, over the largest one; 1.
const RAMP: f64 = 0.5;

fn yade<'a>(pair: &Pair<'a>) -> Given<'a> {
    let [a, b] = pair.names.map(string_text);
    if let Law::KelvinVoigt(own) = pair.law {
        let share = pair.interaction.tangential_ratio;
        // Of two materials the coefficients are in series.
        let given = format!(
            "viscoelastic[({a}, {b})] = dict(kn={}, ks={}, cn={}, cs={}, frictionAngle={})",
            2.0 * own.k,
            2.0 * share * own.k,
            2.0 * own.c,
            2.0 * pair.interaction.tangential_damping * own.c,
            pair.interaction.friction.atan()
        );
        let exact = "the normal force: ViscElMat of both bodies with these numbers (in series \
                     they are the law's), Law2_ScGeom_ViscElPhys_Basic";
        return Given {
            words: (given, exact.to_owned(), "rolling".to_owned()),
            felt: Some((linear(own.k, own.c), Ends::Force)),
        };
    }
    let Some(own) = hertz(pair) else {
        return nothing(pair);
    };
    let nu = poisson(pair);
    // Walls and facets count as spheres of the fruit's radius there.
    let (modulus, walls) = match pair.wall {
        true => (
            own.modulus * std::f64::consts::SQRT_2,
            "young makes up for R* = R/2 that YADE takes on walls and facets",
        ),
        false => (own.modulus, ""),
    };
    let e = own.restitution;
    let given = format!(
        "hertz[({a}, {b})] = dict(young={}, poisson={nu}, en={e}, frictionAngle={})",
        2.0 * modulus * (1.0 - nu * nu),
        pair.interaction.friction.atan()
    );
    let exact = format!(
        "{}: FrictMat of both bodies with this young, Ip2_FrictMat_FrictMat_MindlinPhys(en=…), \
         Law2_ScGeom_MindlinPhys_Mindlin",
        own.exact
    );
    let approximate = joined(&[&own.approximate, walls]);
    own.given(given, exact, approximate)
}

fn mercury<'a>(pair: &Pair<'a>) -> Given<'a> {
    let of = format!(
        "{{ // {} and {}\n    auto s = speciesHandler.getMixedObject(SPECIES);\n",
        comment_text(pair.names[0]),
        comment_text(pair.names[1])
    );
    let friction = pair.interaction.friction;
    if let Law::KelvinVoigt(own) = pair.law {
        // Its force may pull, so that it takes less damping for the same restitution.
        let c = match own.c > 0.0 {
            true => pair.matched(|c| linear(own.k, c), Ends::Gap),
            false => 0.0,
        };
        let given = format!(
            "{of}    s->setStiffness({});\n    s->setDissipation({c});\n    \
             s->setSlidingStiffness({});\n    s->setSlidingFrictionCoefficient({friction});\n}}",
            own.k,
            pair.interaction.tangential_ratio * own.k
        );
        let exact = "stiffness and restitution, of LinearViscoelasticFrictionSpecies";
        let approximate = "damping, which pulls there before bodies part; rolling";
        return Given {
            words: (given, exact.to_owned(), approximate.to_owned()),
            felt: Some((linear(own.k, c), Ends::Gap)),
        };
    }
    let Some(own) = hertz(pair) else {
        return nothing(pair);
    };
    let (modulus, e) = (own.modulus, own.restitution);
    let given = format!(
        "{of}    s->setEffectiveElasticModulusAndRestitutionCoefficient({modulus}, {e});\n    \
         s->setEffectiveShearModulus({});\n    s->setSlidingFrictionCoefficient({friction});\n}}",
        // k_t/k_n = 8 G*/(2 E*).
        0.25 * pair.interaction.tangential_ratio * modulus
    );
    let exact = format!("{}, of HertzianViscoelasticMindlinSpecies", own.exact);
    let approximate = joined(&[&own.approximate, "rolling"]);
    own.given(given, exact, approximate)
}

fn edem<'a>(pair: &Pair<'a>) -> Given<'a> {
    let Some(own) = hertz(pair) else {
        return nothing(pair);
    };
    let (modulus, e) = (own.modulus, own.restitution);
    let nu = poisson(pair);
    // Of two bodies of one material E = 2 E* (1 − ν²), G = E/(2 (1 + ν)).
    let shear = modulus * (1.0 - nu);
    let given = format!(
        "model\tHertz-Mindlin (no slip)\nPoisson's ratio of both\t{nu}\nshear modulus of both (Pa)\t{shear}\n\
         coefficient of restitution\t{e}\ncoefficient of static friction\t{}\n\
         coefficient of rolling friction\t{}",
        pair.interaction.friction, pair.interaction.rolling
    );
    let one = match pair.names[0] == pair.names[1] {
        true => "",
        false => {
            "a shear modulus of both bodies: EDEM keeps one for each material, not for each pair"
        }
    };
    let (exact, approximate) = (own.exact.clone(), joined(&[&own.approximate, one]));
    own.given(given, exact, approximate)
}

fn chrono<'a>(pair: &Pair<'a>) -> Given<'a> {
    let Ok(law) = pair.law.granular() else {
        return nothing(pair);
    };
    let (size, mass) = (pair.radius, pair.mass);
    // With numbers of one's own a force of Hertz's contact is (kn d + gn m_eff v) R* √d.
    let (model, over) = match law.hertzian {
        true => ("Hertz", size),
        false => ("Hooke", 1.0),
    };
    let (damping, approximate) = match (law.hertzian, law.damping) {
        (_, Damping::None) => (0.0, String::new()),
        (true, Damping::Root(c)) | (false, Damping::Constant(c)) => (c, String::new()),
        (hertzian, _) => {
            let like = |c: f64| of_chrono(hertzian, law.k, c);
            (pair.matched(like, Ends::Force), pair.same_restitution())
        }
    };
    let is_exact = approximate.is_empty();
    let (kn, gn) = (law.k / over, damping / (over * mass));
    let exact = if is_exact {
        "the normal force"
    } else {
        "the elastic force"
    };
    let given = format!(
        "{{ // {} and {}: UseMaterialProperties(false), SetContactForceModel({model})\n    \
         auto m = chrono_types::make_shared<ChContactMaterialSMC>();\n    m->SetKn({kn});\n    m->SetGn({gn});\n    \
         m->SetKt({});\n    m->SetGt({});\n    m->SetFriction({});\n}}",
        comment_text(pair.names[0]),
        comment_text(pair.names[1]),
        pair.interaction.tangential_ratio * if law.hertzian { 1.5 } else { 1.0 } * kn,
        pair.interaction.tangential_damping * gn,
        pair.interaction.friction
    );
    let sizes = format!(
        "bodies of other sizes than R* {size} m and {mass} kg: k and c go as R* there, and as the mass"
    );
    let approximate = joined(&[&approximate, &sizes, "rolling"]);
    Given {
        words: (given, exact.to_owned(), approximate),
        felt: Some((of_chrono(law.hertzian, law.k, damping), Ends::Force)),
    }
}

/// The force of Chrono's smooth contacts, which never pulls: Hooke's or Hertz's.
///
/// # Source
/// Project Chrono, ChDefaultContactForceTorqueSMC.
fn of_chrono<'a>(hertzian: bool, k: f64, c: f64) -> Force<'a> {
    match hertzian {
        true => Box::new(move |d: f64, v: f64| d.sqrt() * (k * d + c * v)),
        false => linear(k, c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_contact::expression::parse_law;
    use windfall_scene::interaction::Interaction;
    use windfall_scene::scene::Fruit;

    fn scene(law: &str) -> Scene {
        let law = parse_law(law).unwrap().complete().unwrap();
        let mut fruit = Fruit::sphere(0, 0.04, 840.0, [0.0; 3]);
        fruit.mass = 0.2;
        Scene {
            materials: vec!["apple".into(), "steel".into()],
            interactions: BTreeMap::from([((0, 1), Interaction::frictionless(law))]),
            fruit: vec![fruit],
            ..Scene::default()
        }
    }

    fn given(other: Other, law: &str) -> ContactTerms {
        contact_terms(other, &scene(law), Some(0.5), &BTreeMap::new()).remove(0)
    }

    fn numbers(text: &str) -> Vec<f64> {
        let parts = text.split([',', '(', ')', ' ', '=', ';', '\t', '\n']);
        parts.filter_map(|own| own.parse().ok()).collect()
    }

    /// Names that would end a comment or a text, or draw the next line into one.
    #[test]
    fn rejects_names_that_would_be_code() {
        let hostile = [
            "a\\",
            "a??/",
            "a &",
            "a */ system(0); /*",
            "a\"); import os; (\"",
            "a', 'b",
            "a\u{2028}b",
            "\u{200b}quince",
            "a\\\"",
            "🍎\"\\",
        ];
        for other in [
            Other::Adams,
            Other::Yade,
            Other::MercuryDpm,
            Other::Edem,
            Other::Chrono,
        ] {
            let text = |name: &str| {
                let mut scene = scene("kuwabara-kono(k=753599, c=1524)");
                scene.materials[0] = name.to_owned();
                text_of_terms(
                    other,
                    name,
                    &contact_terms(other, &scene, Some(0.5), &BTreeMap::new()),
                )
            };
            let plain = text("apple");
            for name in hostile {
                let text = text(name);
                assert_eq!(text.lines().count(), plain.lines().count(), "{text}");
                for (line, wanted) in text.lines().zip(plain.lines()) {
                    let drawn_on = line.ends_with(['\\', '&']) || line.contains("??/");
                    assert!(other == Other::Yade || !drawn_on, "{line}");
                    // The same commands stand before and behind the name.
                    let literal = windfall_files::text::quote::string_text(name);
                    let back = line.replace(&literal, "\"apple\"");
                    let back = back.replace(&comment_text(name), "apple");
                    assert_eq!(back, wanted, "{other:?} {name:?}");
                }
            }
        }
    }

    #[test]
    fn closed_form_units_of_adams() {
        // 0.868 N/mm^1.91 is 466143.5992 N/m^1.91 (DOMAIN.md, section 1.2).
        let law = "adams-impact(k=466143.5992, e=1.91, c=500, d=0.0001)";
        let own = given(Other::Adams, law);
        let numbers = numbers(&own.given);
        for (found, wanted) in numbers.iter().zip([0.0, 0.868, 1.91, 0.5, 0.1]) {
            assert!((found - wanted).abs() < 1e-9, "{}", own.given);
        }
        assert!(own.exact.contains("normal force"));
    }

    #[test]
    fn reference_restitution_of_kuwabara_kono() {
        // DOMAIN.md, section 1.4: e 0.4781431291 of this impact.
        let own = given(Other::Edem, "kuwabara-kono(k=753599, c=1524)");
        assert!(own.approximate.contains("0.4781"), "{}", own.approximate);
        // EDEM's damping pulls until the bodies part, so that the coefficient is what comes.
        let e = own
            .given
            .lines()
            .find(|line| line.contains("restitution"))
            .unwrap();
        assert!((numbers(e)[0] - 0.478_143_129_1).abs() < 1e-4, "{e}");
        let [slow, right, fast] = own.delivered[..] else {
            panic!("{:?}", own.delivered);
        };
        assert!(right.error() < 1e-3, "{right:?}");
        // At other speeds the law has another one, and EDEM the same.
        assert!(
            (slow.engine - fast.engine).abs() < 2e-3,
            "{slow:?} {fast:?}"
        );
        assert!(
            slow.law > right.law && right.law > fast.law,
            "{:?}",
            own.delivered
        );
        // Chrono has the law.
        let own = given(Other::Chrono, "kuwabara-kono(k=753599, c=1524)");
        assert!(own.delivered.iter().all(|own| own.error() < 1e-6));
    }

    #[test]
    fn closed_form_numbers_of_chrono_are_kuwabara_kono() {
        let own = given(Other::Chrono, "kuwabara-kono(k=753599, c=1524)");
        let numbers: Vec<f64> = own
            .given
            .lines()
            .filter(|line| line.contains("n("))
            .flat_map(numbers)
            .collect();
        assert!(
            (numbers[0] * 0.04 - 753_599.0).abs() < 1e-6,
            "{}",
            own.given
        );
        assert!(
            (numbers[1] * 0.04 * 0.2 - 1524.0).abs() < 1e-6,
            "{}",
            own.given
        );
    }

    #[test]
    fn rejects_laws_without_counterpart() {
        let law = "power-law(k=466143.6, n=1.91, c=100, p=0)";
        for other in [Other::Yade, Other::MercuryDpm, Other::Edem, Other::Chrono] {
            let own = given(other, law);
            assert!(own.given.is_empty() && own.approximate.contains("no counterpart"));
        }
        assert!(given(Other::Adams, law).exact.contains("normal force"));
    }
}
