use super::ContactLaw;

/// Also where the exponent is so near to 1 that the law is too steep from the first touch on.
#[test]
fn no_law_is_steeper_than_it_may_be() {
    for exponent in [1.0, 1.0001, 1.01, 1.05, 1.5, 5.0] {
        for stiffness in [1e3, 1e9, 1e15] {
            let law =
                ContactLaw::new("test", stiffness, exponent).expect("it is in range").no_steeper_than(1e8);
            for penetration in [1e-45, 1e-30, 1e-12, 1e-6, 1e-3] {
                let slope = law.slope(penetration);
                assert!(slope <= 1e8 * (1.0 + 1e-12), "{stiffness}, {exponent}: {slope} at {penetration}");
            }
        }
    }
}

/// A limit that is higher than one before changes nothing, also where the law is straight from the first touch on.
#[test]
fn a_limit_never_makes_a_law_steeper() {
    for exponent in [1.0, 1.0001, 1.01, 1.05, 1.5, 5.0] {
        for stiffness in [1e3, 1e9, 1e15] {
            let law = ContactLaw::new("test", stiffness, exponent).expect("it is in range");
            for first in [law.no_steeper_than(1e6), law.giving_way(1e-6)] {
                for higher in [1e6, 1e8, 1e30] {
                    let again = first.no_steeper_than(higher);
                    assert_eq!(again, first, "{stiffness}, {exponent}: {higher} after 1e6");
                }
            }
        }
    }
}

/// Before the knee and beyond it, whatever the knee came from.
#[test]
fn another_stiffness_changes_all_forces_alike() {
    let law = |exponent| ContactLaw::new("test", 1e9, exponent).expect("it is in range");
    let laws = [
        law(1.5),
        law(1.5).no_steeper_than(1e6),
        law(1.0001).no_steeper_than(1e6),
        law(1.0).giving_way(1e-6),
    ];
    for law in laws {
        assert_eq!(law.with_stiffness(law.stiffness()), law);
        let stiffer = law.with_stiffness(8.0 * law.stiffness());
        for penetration in [1e-12, 1e-6, 1e-4, 1e-2] {
            let pairs = [
                (law.force(penetration), stiffer.force(penetration)),
                (law.energy(penetration), stiffer.energy(penetration)),
                (law.slope(penetration), stiffer.slope(penetration)),
            ];
            for (before, now) in pairs {
                assert!((now / before - 8.0).abs() < 1e-12, "{law:?} at {penetration}: {before} to {now}");
            }
        }
    }
}

/// A contact of which something gives way by 1 mm/N behind it, of an exponent.
const FLEXIBILITY: f64 = 1e-3;

fn plain_and_giving_way(exponent: f64) -> [ContactLaw; 2] {
    let plain = ContactLaw::new("test", 2e7, exponent).expect("it is in range");
    [plain, plain.giving_way(FLEXIBILITY)]
}

/// Below the knee the contact alone decides; the knee is where it gives way as easily as what is behind it; and beyond it the
/// force goes on along the tangent, and the energy is what that takes.
#[test]
fn what_gives_way_is_the_softer_of_the_two() {
    for exponent in [1.2, 1.5, 2.0, 2.3, 3.0, 5.0] {
        let [plain, law] = plain_and_giving_way(exponent);
        let knee = law.knee();
        // αKη^(α−1) = 1/C.
        let expected = libm::pow(1.0 / (exponent * 2e7 * FLEXIBILITY), 1.0 / (exponent - 1.0));
        assert!((knee / expected - 1.0).abs() < 1e-14, "{exponent}: {knee} m, {expected} m");
        for part in [1e-6, 0.1, 0.5, 1.0] {
            let deep = part * knee;
            assert_eq!(law.force(deep), plain.force(deep));
            assert_eq!(law.energy(deep), plain.energy(deep));
            assert_eq!(law.slope(deep), plain.slope(deep));
            assert_eq!(law.own_force(deep), plain.force(deep));
        }
        for part in [1.5, 3.0, 100.0] {
            let beyond = (part - 1.0) * knee;
            let force = plain.force(knee) + beyond / FLEXIBILITY;
            let energy = plain.energy(knee) + 0.5 * (plain.force(knee) + force) * beyond;
            // Some roundings of powers and sums.
            let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-14;
            let deep = part * knee;
            assert!(near(law.force(deep), force), "{exponent}: {} N, {force} N", law.force(deep));
            assert!(near(law.energy(deep), energy), "{exponent}: {} J, {energy} J", law.energy(deep));
            assert!(near(law.slope(deep), 1.0 / FLEXIBILITY), "{exponent}: {} N/m", law.slope(deep));
            assert!(near(law.own_force(deep), plain.force(knee)));
            assert!(near(law.penetration_at(force), deep));
        }
    }
}

/// Two springs of exponent 1 are one: the softer of the two, from the first touch on.
#[test]
fn of_two_straight_springs_the_softer_one_is_left() {
    let [plain, law] = plain_and_giving_way(1.0);
    for deep in [1e-9, 1e-6, 1e-3] {
        let force = deep / FLEXIBILITY;
        assert!((law.force(deep) / force - 1.0).abs() < 1e-14, "{deep}: {} N", law.force(deep));
        assert!((law.energy(deep) / (0.5 * force * deep) - 1.0).abs() < 1e-14);
        assert!(law.own_force(deep) < 1e-14 * force, "the contact itself is hardly pressed in");
    }
    // Its slope is the same where it begins to touch.
    for deep in [0.0, 1e-49, 1e-6] {
        assert!((law.slope(deep) * FLEXIBILITY - 1.0).abs() < 1e-14, "{deep}: {} N/m", law.slope(deep));
    }
    assert_eq!((plain.slope(0.0), law.slope(-1e-9)), (plain.stiffness(), 0.0));
    // Behind a softer contact, what hardly gives way changes nothing.
    let hard = plain.giving_way(0.9 / 2e7);
    assert_eq!(hard, plain);
}

/// A contact is pressed in as its law says of the force that there is, and the rest is what gives way.
#[test]
fn what_a_contact_is_pressed_in_by_has_its_force() {
    for exponent in [1.0, 1.2, 1.5, 2.3, 5.0] {
        let [plain, law] = plain_and_giving_way(exponent);
        let scale = if exponent > 1.0 { law.knee() } else { 1e-6 };
        for part in [0.1, 0.9, 1.0, 1.1, 3.0, 1e3] {
            let deep = part * scale;
            let own = law.own_penetration(deep);
            assert!(
                (plain.force(own) / law.force(deep) - 1.0).abs() < 1e-14,
                "{exponent}: {own} of {deep} m"
            );
            assert!(own <= deep, "{exponent}: {own} of {deep} m");
            assert_eq!(own == deep, exponent > 1.0 && part <= 1.0, "{exponent}: {own} of {deep} m");
            assert_eq!(plain.own_penetration(deep), deep);
        }
    }
}
