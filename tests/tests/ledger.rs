//! Promise: the energy ledger closes, whatever touches what, at every cap of the solver.

use low_action_dsp::{Scene, Simulation};

struct Balance {
    worst: f64,
    sum: f64,
    change: f64,
}

fn balance(text: &str) -> Balance {
    let scene = Scene::from_toml(text).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    let mut first = None;
    let mut last = 0.0;
    let mut iterations = 0;
    for _ in 0..simulation.samples() {
        let entry = simulation.step().expect("the ledger is open");
        first.get_or_insert(entry.energies.total());
        last = entry.energies.total();
        iterations += simulation.string(0).convergence.iterations;
    }
    let ledger = &simulation.ledgers()[0];
    println!(
        "worst {:e} sum {:e} change {:e} iter/sample {} largest {:e} final {:e}",
        ledger.worst_residual,
        ledger.residual_sum / ledger.largest,
        (last - first.unwrap()) / first.unwrap(),
        iterations as f64 / simulation.samples() as f64,
        ledger.largest,
        last
    );
    Balance {
        worst: ledger.worst_residual,
        sum: ledger.residual_sum.abs() / ledger.largest,
        change: (last - first.unwrap_or(0.0)) / ledger.largest,
    }
}

const STRING: &str = r#"
sample_rate = 88200
duration = 1.0
[[string]]
length = 0.65
linear_density = 5.25e-3
tension = 60.0
youngs_modulus = 2e11
core_radius = 4.3e-4
tension_modulation = true
"#;

#[test]
fn quick() {
    let tap = "[fretboard]\nstiffness = 1e15\nexponent = 2.3\nboard = -0.0022\nfrets = 12\nfret_top = -0.0012\n[[finger]]\nmass = 5e-3\nstiffness=1e10\nexponent=2.3\nposition=0.638\nheight=0.001\nvelocity=-3.0\n";
    let pluck = "[fretboard]\nstiffness = 1e15\nexponent = 2.3\nboard = -0.0022\nfrets = 12\nfret_top = -0.0012\n[[pluck]]\nduration=0.002\nposition=0.52\nforce=-2.0\n";
    let press = "[fretboard]\nstiffness = 1e15\nexponent = 2.3\nboard = -0.0022\nfrets = 12\nfret_top = -0.0012\n[[pluck]]\nduration=0.002\nposition=0.52\nforce=-2.0\n[[finger]]\nmass = 5e-3\nstiffness=1e8\nexponent=1.5\nposition=[[0.0,0.2],[0.5,0.2],[1.0,0.3]]\nheight=0.0001\nforce=6.0\nhand_damping=5.0\ndamping=1.0\n";
    for stencil in ["paper", "corrected", "wide"] {
        for cap in [0, 3, 50] {
            let solver = format!("[solver]\nmax_iterations={cap}\nstencil=\"{stencil}\"\n");
            for scene in [tap, pluck, press] {
                let start = std::time::Instant::now();
                let b = balance(&format!("{STRING}{scene}{solver}"));
                println!("   {stencil} {cap} {:?}", start.elapsed());
                assert!(b.worst < 1e-14, "{}", b.worst);
                assert!(b.sum < 1e-12);
                let _ = b.change;
            }
        }
    }
}
