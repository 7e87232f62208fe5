//! The promise: a blow that lasts many steps loses what the law of its contact says, and one that is over within a step what
//! `docs/physics.md` has tabled: in the mean of all the times at which it may fall between two steps about as much, never a
//! negative amount.

use low_action_dsp::{Scene, Simulation};
use low_action_tests::numbers::largest;

/// Mass, kg, and the pad's law, that of the frets of the built-in instruments: N/m^1.5.
const MASS: f64 = 3e-5;
const STIFFNESS: f64 = 1e10;
const DAMPING: f64 = 0.3;
/// The table's heights within the way of one sample, from the lowest on, m.
const HEIGHTS: usize = 24;
const LOWEST: f64 = 2e-4;
/// The string, kg/m and N.
const DENSITY: f64 = 100.0;
const TENSION: f64 = 1e6;

/// With what parts of its speed, m/s, a mass comes back that is thrown at a string that practically stays where it is.
fn come_back(rate: f64, speed: f64, damping: f64) -> Vec<f64> {
    let one = |number: usize| {
        let height = LOWEST + number as f64 / HEIGHTS as f64 * speed / rate;
        let text = format!(
            "sample_rate = {rate:?}\nduration = 1.0\n[solver]\nmax_iterations = 100\ntolerance = 0.0\n\
             [[string]]\nlength = 0.1\nlinear_density = {DENSITY:?}\ntension = {TENSION:?}\n\
             [[finger]]\nmass = {MASS:?}\nstiffness = {STIFFNESS:?}\nexponent = 1.5\ndamping = {damping:?}\n\
             position = 0.05\nheight = {height:?}\nvelocity = {:?}\n",
            -speed
        );
        let scene = Scene::from_toml(&text).expect("the scene is valid");
        let mut simulation = Simulation::new(&scene).expect("the scene can be built");
        let mut before = height;
        for _ in 0..1000 {
            simulation.step();
            let finger = simulation.string(0).fingers().next().expect("there is one");
            let now = finger.height;
            // Clear of the string again, whether it has been seen inside or not.
            if now > height && finger.force == 0.0 {
                return (now - before) * rate / speed;
            }
            before = now;
        }
        panic!("it has not come back: {text}");
    };
    (0..HEIGHTS).map(one).collect()
}

/// Least, most and mean.
fn range(parts: &[f64]) -> [f64; 3] {
    let least = parts.iter().copied().fold(f64::INFINITY, f64::min);
    [least, largest(parts.iter().copied()), parts.iter().sum::<f64>() / parts.len() as f64]
}

/// What the equation has: m v dv/dη = −φ(1 + βv) from v₀ through the deepest point to −e v₀, the work of φ being nothing on the
/// whole way, so that ∫ v/(1 + βv) dv = 0: β v₀ (1 + e) = ln((1 + β v₀)/(1 − β e v₀)).
fn of_the_equation(speed: f64) -> f64 {
    let thrown = DAMPING * speed;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let part = 0.5 * (low + high);
        let less = thrown * (1.0 + part) > ((1.0 + thrown) / (1.0 - thrown * part)).ln();
        if less { low = part } else { high = part }
    }
    low
}

/// What is deepest, η = (5mv²/4K)^(2/5), is there for 2.943 η/v of Hertz's law without loss, s.
fn lasts(speed: f64) -> f64 {
    2.943 * (1.25 * MASS * speed * speed / STIFFNESS).powf(0.4) / speed
}

#[test]
fn short_blows_lose_what_the_page_says() {
    let page = include_str!("../../../docs/physics.md");
    let mut rows = String::new();
    for rate in [48e3, 192e3, 768e3] {
        let [least, most, mean] = range(&come_back(rate, 1.0, DAMPING));
        let samples = lasts(1.0) * rate;
        let digits = if samples < 1.0 { 2 } else { 1 };
        rows += &format!(
            "| {:.0} kHz | {samples:.digits$} | {least:.3} to {most:.3} | {mean:.3} |\n",
            rate / 1e3
        );
    }
    assert!(page.contains(&rows), "docs/physics.md has other numbers than\n{rows}");
    let equation = of_the_equation(1.0);
    let said = [format!("has {equation:.3}"), format!("in touch for {:.1} µs", 1e6 * lasts(1.0))];
    for said in said {
        assert!(page.contains(&said), "docs/physics.md does not say: {said}");
    }
}

#[test]
fn softer_blows_lose_what_the_page_says() {
    let page = include_str!("../../../docs/physics.md");
    let [least, most, mean] = range(&come_back(48e3, 0.3, DAMPING));
    let equation = of_the_equation(0.3);
    let said = format!("At 0.3 m/s and 48 kHz it is {least:.3} to {most:.3} for {equation:.3}");
    assert!(page.contains(&said), "docs/physics.md does not say: {said} (in the mean {mean:.3})");
}

/// But for what the string takes, of which a point of ρh, h = √(T/ρ) k, is struck: twice MASS/ρh of the speed at most.
#[test]
fn without_loss_all_of_it_comes_back() {
    for rate in [48e3, 192e3, 768e3] {
        let taken = 2.0 * MASS * rate / (TENSION * DENSITY).sqrt();
        let [least, most, _] = range(&come_back(rate, 1.0, 0.0));
        println!("{rate} Hz: {least:.5} to {most:.5}, of which the string may have taken {taken:.1e}");
        assert!(
            least > 1.0 - 1.01 * taken && most < 1.0,
            "{rate} Hz: {least} to {most}, {taken} taken at most"
        );
    }
}
