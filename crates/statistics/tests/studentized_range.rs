//! The studentised range and comparisons of all pairs.

#![allow(clippy::excessive_precision, clippy::print_stdout)] // as the references printed them

use windfall_distribution::studentized_range::{
    studentized_range_upper, studentized_range_upper_quantile,
};
use windfall_statistics::compare::tukey::{games_howell, tukey_kramer};

const INF: f64 = f64::INFINITY;

/// Expected: mpmath 1.3, both integrals by Gauss-Legendre panels at 20 digits.
#[test]
fn reference_tail_by_panels() {
    for (q, means, df, expected) in [
        (3.5, 3, INF, 0.035557041863160375),
        (10.0, 20, INF, 2.9194618372302794e-10),
        (3.0, 2, 5.0, 0.087359308127361667),
        (3.5, 3, 16.0, 0.061152907066985817),
        (8.0, 10, 3.0, 0.078450494593230814),
        (5.2, 50, 30.0, 0.23621699717734416),
        (4.0, 4, 1.0, 0.38436524280096451),
    ] {
        let found = studentized_range_upper(q, means, df);
        let error = (found / expected - 1.0).abs();
        assert!(error < 1e-12, "{q} {means} {df}: {found:e}, {error:e}");
    }
}

/// Two means: the studentised range is √2 |t|.
#[test]
fn closed_form_two_means_are_a_t_test() {
    use windfall_distribution::tail::t_two_sided;
    for df in [1.0, 2.0, 3.5, 7.0, 30.0, 400.0, 1e5] {
        for t in [0.01, 0.5, 1.0, 2.0, 5.0, 12.0] {
            let found = studentized_range_upper(t * 2f64.sqrt(), 2, df);
            let expected = t_two_sided(t, df);
            let error = (found / expected - 1.0).abs();
            assert!(
                error < 2e-12,
                "t {t} of {df}: {found:e} {expected:e} {error:e}"
            );
        }
    }
}

/// Expected: SciPy 1.17, studentized_range.sf(3.5, means, df), by adaptive
/// integration of its own.
#[test]
fn reference_tail_of_scipy() {
    for (means, df, expected) in [
        (2, 1.0, 0.2444634852716644),
        (2, 2.0, 0.1317568578755407),
        (2, 5.0, 0.056193206737753854),
        (2, 12.0, 0.02923135795783205),
        (2, 60.0, 0.016171442271623926),
        (2, 1000.0, 0.013493215703472061),
        (2, INF, 0.013328328780817356),
        (3, 1.0, 0.35987526963605143),
        (3, 2.0, 0.2294715206939828),
        (3, 5.0, 0.11927295546605088),
        (3, 12.0, 0.06999548527518362),
        (3, 60.0, 0.042164397200132764),
        (3, 1000.0, 0.03594703977928948),
        (3, INF, 0.03555704186316044),
        (5, 1.0, 0.4808079965987915),
        (5, 2.0, 0.3596557294752152),
        (5, 5.0, 0.23375547275332287),
        (5, 12.0, 0.16103464248829347),
        (5, 60.0, 0.11014825512284498),
        (5, 1000.0, 0.09717749031444767),
        (5, INF, 0.09633846396542678),
        (10, 1.0, 0.608655868539822),
        (10, 2.0, 0.5259536813988631),
        (10, 5.0, 0.4318313382593125),
        (10, 12.0, 0.3645748517990065),
        (10, 60.0, 0.30278417913188194),
        (10, 1000.0, 0.2833474423622997),
        (10, INF, 0.28201643828913625),
        (20, 1.0, 0.7038907640780394),
        (20, 2.0, 0.6630540214974292),
        (20, 5.0, 0.6303396226074042),
        (20, 12.0, 0.6155105150826998),
        (20, 60.0, 0.6063369148884166),
        (20, 1000.0, 0.6037844569951312),
        (20, INF, 0.6036049452034737),
        (50, 1.0, 0.7936747574900949),
        (50, 2.0, 0.7937226279552119),
        (50, 5.0, 0.824219947058112),
        (50, 12.0, 0.8686154877810212),
        (50, 60.0, 0.9281038719727595),
        (50, 1000.0, 0.9509936652021392),
        (50, INF, 0.952636716761037),
    ] {
        let found = studentized_range_upper(3.5, means, df);
        let error = (found - expected).abs();
        assert!(error < 1e-10, "{means} {df}: {found} {expected} {error:e}");
    }
}

/// Expected: R 4.2.2, ptukey(3.5, means, df, lower = FALSE), whose panels of fixed
/// length are good to 3e-7 at 50 means (SciPy and the panels above side with us).
/// From five degrees of freedom on; at two R gives 0.131711 for two means, where
/// √2 |t| has 0.131757.
#[test]
fn reference_tail_of_r() {
    let mut worst = 0.0_f64;
    for (means, df, expected) in [
        (2, 5.0, 0.056193206737850998),
        (2, 12.0, 0.029231357962710036),
        (2, 60.0, 0.016171442292351457),
        (2, INF, 0.013328328780853438),
        (3, 5.0, 0.119272942380105),
        (3, 12.0, 0.069995485275448743),
        (3, 60.0, 0.042164397220513239),
        (3, INF, 0.035557041863443883),
        (5, 5.0, 0.23375547322869317),
        (5, 12.0, 0.16103464249640065),
        (5, 60.0, 0.11014825514977555),
        (5, INF, 0.096338463979282807),
        (10, 5.0, 0.43183133787483774),
        (10, 12.0, 0.36457485124139488),
        (10, 60.0, 0.30278417815510328),
        (10, INF, 0.28201643763280215),
        (20, 5.0, 0.63033963372886137),
        (20, 12.0, 0.6155105321349128),
        (20, 60.0, 0.60633694897458601),
        (20, INF, 0.60360499879099672),
        (50, 5.0, 0.82421990459726224),
        (50, 12.0, 0.86861541833872469),
        (50, 60.0, 0.92810371509198353),
        (50, INF, 0.9526364555981377),
    ] {
        let found = studentized_range_upper(3.5, means, df);
        let error = (found - expected).abs();
        worst = error.max(worst);
    }
    println!("largest difference from R: {worst:.1e}");
    assert!(worst < 5e-7, "{worst:e}");
}

/// Expected: R 4.2.2, qtukey(0.95, means, df), which stops searching at steps
/// of 1e-4; the quantiles here are those whose tail is 0.05.
#[test]
fn reference_quantiles_of_r() {
    for (means, df, expected) in [
        (3, 5.0, 4.6017254459428374),
        (5, 12.0, 4.5077099196627387),
        (10, 60.0, 4.6463239676794288),
        (20, INF, 5.0116887946867648),
        (50, 5.0, 9.6738119208828444),
        (50, INF, 5.6460261817410524),
    ] {
        let found = studentized_range_upper_quantile(0.05, means, df);
        let error = (found - expected).abs();
        assert!(error < 3e-4, "{means} {df}: {found} {expected} {error:e}");
        let back = studentized_range_upper(found, means, df);
        assert!((back / 0.05 - 1.0).abs() < 1e-12, "{means} {df}: {back}");
    }
    // two means: √2 times Student's t at 0.975 (12.7062047361746941 of one degree)
    let found = studentized_range_upper_quantile(0.05, 2, 1.0);
    assert!((found / (2f64.sqrt() * 12.7062047361746941) - 1.0).abs() < 1e-12);
}

#[test]
fn rejects_what_has_no_range() {
    assert!(studentized_range_upper(3.0, 1, 5.0).is_nan());
    assert!(studentized_range_upper(3.0, 3, 0.0).is_nan());
    assert_eq!(studentized_range_upper(-1.0, 3, 5.0), 1.0);
    assert_eq!(studentized_range_upper_quantile(0.0, 3, 5.0), INF);
}

const A: [f64; 7] = [9.1, 10.4, 8.7, 11.2, 9.9, 10.8, 9.5];
const B: [f64; 7] = [11.0, 12.9, 9.2, 13.1, 12.0, 10.1, 12.6];
const D: [f64; 5] = [8.2, 14.9, 6.1, 12.7, 5.3];

/// Expected: R 4.2.2, TukeyHSD(aov(y ~ g)) with groups of 7, 7 and 5.
#[test]
fn reference_tukey_kramer() {
    let found = tukey_kramer(&[A.to_vec(), B.to_vec(), D.to_vec()], 0.95).unwrap();
    let expected = [
        (
            0,
            1,
            [
                1.61428571428571566,
                -1.6332847199363765,
                4.8618561485078082,
                0.42470252840093137,
            ],
        ),
        (
            0,
            2,
            [
                -0.50285714285714178,
                -4.0603923106777167,
                3.0546780249634331,
                0.92961471879821111,
            ],
        ),
        (
            1,
            2,
            [
                -2.11714285714285744,
                -5.6746780249634323,
                1.4403923106777174,
                0.30137275719190415,
            ],
        ),
    ];
    for (pair, (first, second, [difference, low, high, p])) in found.iter().zip(expected) {
        assert_eq!((pair.first, pair.second), (first, second));
        assert!((pair.difference - difference).abs() < 1e-13);
        // R's critical value is good to 1e-4 in q
        assert!((pair.low - low).abs() < 1e-6, "{} {low}", pair.low);
        assert!((pair.high - high).abs() < 1e-6, "{} {high}", pair.high);
        assert!((pair.p - p).abs() < 1e-9, "{} {p}", pair.p);
    }
}

/// Two groups: Tukey's is the t test with a common variance, Games and Howell's
/// is Welch's.
#[test]
fn closed_form_two_groups() {
    use windfall_statistics::compare::means::{pooled, welch};
    let groups = [A.to_vec(), D.to_vec()];
    let check = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
    };
    let tukey = tukey_kramer(&groups, 0.95).unwrap()[0];
    let t = pooled(&D, &A, 0.95).unwrap();
    check(tukey.p, t.p);
    check(tukey.low, t.low);
    let games = games_howell(&groups, 0.95).unwrap()[0];
    let t = welch(&D, &A, 0.95).unwrap();
    check(games.p, t.p);
    check(games.high, t.high);
    check(games.df, t.df);
}
