//! The physics of Low Action: a stiff, lossy string over a fretboard, stopped by fingers.
//!
//! ```text
//! Scene ─> Model (coefficients) ─┬─> State, stepped by a Drive ─> strings ─> samples
//! Setup ─> Instrument ───────────┘          ^  ^                    │
//!                gestures ──────────────────┘  └────── body <───────┘
//! ```
//!
//! - A [`Scene`] is an experiment in SI units, a [`Setup`] an instrument as a luthier would describe it.
//!   Both are read from TOML and refused in one line when something is impossible.
//! - A [`Model`] holds every coefficient of one string on its grid. It never changes while it sounds, but for how exactly its
//!   contacts are solved ([`Instrument::set_effort`]).
//! - A [`State`] holds what one sample hands to the next: displacement and motion of the string, fingers,
//!   the contacts that are close (`skyline`). [`State::step`] takes it from sample n to n + 1. Numbers over the grid lie
//!   in a [`field::Field`], in the order in which vectors take them.
//! - A [`Drive`] says what acts in that one step: tension, pushes, hands, moving frets.
//! - A [`Scratch`] is room to work in, and the record of the last step for whoever listens or measures:
//!   [`pickup`] makes a signal of it, [`Ledger`] an energy balance. Neither can change the motion.
//! - A [`Simulation`] runs the strings of a scene; an [`Instrument`] runs those of a set-up under
//!   [`Gesture`]s at exact samples, each a `voice`: a string, the hands on it and what is heard of it.
//! - A `body` is what gives way under the bridge: modes that strings drive and are pushed by, and that sound. Strings over one
//!   hear each other and are stepped `together`, sample by sample; all others go through a run of samples each by itself.
//!
//! Within a step, [`State::step`] predicts the string without contacts (`kernel`), lists the contacts that
//! act, solves for all their forces together (`solver`, by means of `response`), and advances the string
//! (`kernel` again). Building may fail and may allocate; stepping does neither. Everything
//! transcendental on the signal path comes from `libm`, sums have a fixed order and there is no fused
//! multiply-add, so that the same description gives the same bits on every machine.
//!
//! # A scene and an instrument
//!
//! ```
//! use low_action_dsp::{Scene, Simulation};
//!
//! let scene = Scene::from_toml(
//!     "sample_rate = 88200
//!      duration = 0.1
//!      [[string]]
//!      length = 0.65
//!      linear_density = 5.25e-3
//!      tension = 60.0
//!      [[pluck]]
//!      duration = 0.002
//!      position = 0.52
//!      force = -1.0",
//! )?;
//! let mut simulation = Simulation::new(&scene)?;
//! simulation.open_ledger();
//! let mut sound = Vec::new();
//! for _ in 0..simulation.samples() {
//!     let entry = simulation.step().expect("the ledger is open");
//!     assert!(entry.residual.abs() < 1e-14); // J
//!     sound.push(simulation.output()); // the force on the bridge, N
//! }
//! assert!(simulation.ledgers()[0].put_in > 1e-4); // J, by the pluck
//! # Ok::<(), low_action_dsp::Error>(())
//! ```
//!
//! ```
//! use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};
//!
//! let setup = Setup::builtin("electric").expect("it is built in");
//! let mut instrument = Instrument::new(&setup, &Quality::Live.settings(48e3))?;
//! let geometry = instrument.geometry(0);
//! let (fretting, place) = (&setup.player.fretting, geometry.finger_position(5));
//! let pluck = Gesture::Pluck { position: geometry.length - 0.12, force: 1.0, duration: 1.5e-3, release: 0.0 };
//! let gestures = [
//!     (0, Gesture::Place { finger: 0, touch: fretting.touch, position: place, clearance: 1e-4 }),
//!     (0, Gesture::Press { finger: 0, force: fretting.force, duration: 0.004 }),
//!     (480, pluck),
//! ];
//! for (time, gesture) in gestures {
//!     instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
//! }
//! let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
//! instrument.process(&mut left, &mut right);
//! assert!(left.iter().any(|sample| sample.abs() > 0.01));
//! # Ok::<(), low_action_dsp::Error>(())
//! ```
//!
//! # Where to change what
//!
//! | to add or change | where, in `dsp/src` |
//! |---|---|
//! | the law of a contact | `contact.rs` and `contact` (the law, its discrete gradient), `model/barrier.rs` (board and frets), `finger.rs` (pads), `model/steepness.rs` (how stiff is allowed) |
//! | how contacts are solved | `contact_step.rs`, `solver`, `response`, `active.rs` |
//! | losses of the string | `model/coasting.rs`, `kernel` (the step), `scene/decay.rs` (`t60`), `energy/string.rs` (what is booked) |
//! | the stencil, stiffness and stretching | `scene.rs` (names of stencils), `model/stiffness.rs`, `grid.rs`, `kernel` |
//! | a pluck or another push | `gesture.rs` (shape and numbers), `drive.rs`, `hands` and `ramp.rs` (of an instrument), `simulation/scene_string.rs` (of a scene) |
//! | a finger, or a hand laid along a string | `finger.rs`, `gesture.rs`, `hands` |
//! | the body | `body.rs` and `body`, `together.rs` (strings over it), `simulation/scene_body.rs` |
//! | what is heard | `pickup.rs` and `pickup`, `filter.rs`, `decimate.rs`, `level.rs` |
//! | a key of a scene | `scene.rs` and `scene`, then `simulation`; `docs/formats.md` |
//! | a key of a set-up, tuning and fret places | `setup.rs` and `setup`, `neck.rs`, `intonation`; `docs/formats.md` |
//! | a quality | `quality.rs`, `settings.rs`; `docs/trade.md` |
//! | a term of the energy balance | `energy` and `entry.rs`, `plugin/src/cli/trace/booked.rs` (what traces have of it); `docs/physics.md`, `docs/formats.md` |
//!
//! The derivation is in `docs/physics.md`, the contact solver in `docs/solver.md`, the files in
//! `docs/formats.md` of the repository.
//!
//! # Notation
//!
//! Lengths in m, up is positive, x runs from the nut at 0 to the bridge (or saddle) at L. The string at
//! rest lies at u = 0, board and frets at or below. Superscripts count samples: uⁿ is now.
//!
//! | symbol | name in code | unit | meaning |
//! |---|---|---|---|
//! | L | `length` | m | length of the string |
//! | ρ | `linear_density` | kg/m | mass per length, winding included |
//! | T | `tension` | N | tension at rest; `tension_limit` is the most that bends reach |
//! | E, r_c | `youngs_modulus`, `core_radius` | Pa, m | of the core: a winding adds mass, hardly stiffness |
//! | A, I | (in `axial_stiffness`, `kappa_squared`) | m², m⁴ | section πr_c² and its moment πr_c⁴/4 |
//! | c², κ² | `c2`, `kappa_squared` | m²/s², m⁴/s² | T/ρ and EI/ρ |
//! | κ₂², κ₆ | `kappa_squared`, `kappa_6` of [`model::Stiffness`] | m⁴/s², m⁶/s² | κ² as the stencil realises it, and its sixth-order term |
//! | σ₀, σ₁ | `loss_0`, `loss_1` | 1/s, m²/s | loss of all frequencies alike, and growing with frequency |
//! | σₕ | `loss` of a [`Drive`] | 1/s | what a hand laid along the string adds to σ₀ in a step |
//! | τ | `stretch_tension` | N | what stretching adds to T |
//! | k, h, N | `time_step`, `spacing`, `intervals` | s, m, – | grid; the unknowns are u₁ … u_{N−1} |
//! | λ | `courant2` is λ² | – | ck/h, spacings a wave travels in a step |
//! | uⁿ, dⁿ | `displacement`, `motion` | m | the string, and uⁿ − uⁿ⁻¹ |
//! | v | `curvature` | m | undivided second difference of uⁿ |
//! | w, ψ | `motion` in the step, `pull` of the [`Scratch`] | m, – | motion without contact and stretching; stretching takes ψv off it |
//! | s | `inverse_s` is 1/s | – | 1 + σ₀k |
//! | | `decay` | – | (1 − σ₀k)/(1 + σ₀k), what is left of the motion after a step |
//! | m | `mobility` | m/N | k²/(ρhs), how far one newton at a grid point moves it in a step |
//! | q, q̄ | `stretched`, `stretching` | m² | (δuⁿ)ᵀδuⁿ⁺¹, and the mean of that before and after n |
//! | G | `stretch` | 1/m² | k²EA/(4ρLh³s), strength of tension modulation |
//! | h g | `Reading::weights` | – | weights that read a point, and spread a force on it; from section 7 on, and in `docs/solver.md`, they are called g |
//! | b | `height` | m | height of board or crown |
//! | η | `penetration` | m | overlap of two bodies, positive when they touch |
//! | r, c | `change`; −c is `centre` when a solution begins | m | ηⁿ⁺¹ − ηⁿ⁻¹, which without force would be −c |
//! | K, α, β | `stiffness`, `exponent`, `damping` | N/m^α, –, s/m | law of a contact: Kη^α, and its loss |
//! | Φ, φ | `energy`, `force` of [`contact::ContactLaw`] | J, N | energy stored in a contact and its slope |
//! | λ(r), P | `lambda`, `lossy` | N, N/m | force that the stored energy explains; the lossy part is P r |
//! | C, 2√(Tρ) | `residual`, `radiation` | m/N, N s/m | how far a string gives way at a kinked fret and its grid does not; what waves take away there that are too short for it |
//! | f | `force` | N | force of a contact: what its law asks is never below 0, an unfinished answer may pull |
//! | M | `Response` | m/N | answer of the penetrations to the forces: r = −c − M f |
//! | ε, z | `sign`, `pull` of a contact | –, m | +1 for board and frets, −1 for fingers; ε gᵀv |
//! | u_f, d_f | `height`, `motion` of [`finger::Finger`] | m | height of a finger's pad, and its last change |
//! | M_f, R_f | `mass`, `hand_damping` | kg, N s/m | a finger, and the hand behind it |
//! | M̃_f | `Inertia::mass` | kg | what a finger moves with in steps of this length |
//! | m_f | `own_mobility` | m/N | k²/(M̃_f + R_f k/2), how far one newton moves a finger in a step |
//! | mᵢ | | m/N | of a contact: m, for a finger m + m_f |
//! | f₀ | `force` of [`drive::Hand`] | N | push of the hand, towards the board |
//! | f_e | `force` of [`drive::Push`] | N | a pluck |
//! | R, D | `Ratio`, `DELAY` | – | steps of a string in a sample of the host's; samples of the host's by which all are late |
//! | 𝔥, 𝔮, 𝔭 | [`Energies`], `power_loss` (its terms are [`Losses`]) and `power_solver`, `power_in` ([`Inputs`]) | J, W, W | stored, lost, put in |
//!
//! D is also the difference along the string (section 4), and in `docs/solver.md` the slopes of the laws. What section 9 of
//! `docs/physics.md` says of bars and of bodies has letters of its own, each said where it is first used.

// What clippy.toml lists differs from machine to machine.
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod active;
mod band;
mod body;
mod choice;
mod close;
pub mod contact;
mod contact_step;
pub mod curve;
mod decimate;
mod deflection;
pub mod digits;
pub mod drive;
pub mod energy;
pub mod entry;
pub mod error;
pub mod field;
mod filter;
pub mod finger;
mod flexibility;
pub mod gesture;
pub mod grid;
mod handover;
mod hands;
mod instructions;
pub mod instrument;
pub mod intonation;
mod kernel;
mod level;
pub mod model;
pub mod neck;
pub mod observed;
pub mod pickup;
mod preset;
pub mod quality;
mod queue;
mod ramp;
pub mod ratio;
mod release;
mod response;
pub mod roomy;
pub mod scene;
pub mod settings;
pub mod setup;
pub mod simulation;
mod skyline;
mod solver;
pub mod state;
pub mod string;
mod threads;
mod times;
mod together;
mod touching;
mod voice;

pub use drive::Drive;
pub use energy::{Account, BodyLedger, Ledger};
pub use entry::{Energies, Entry, Inputs, Losses};
pub use error::Error;
pub use gesture::{FINGERS_PER_STRING, FingerSlot, Gesture, TimedGesture, Touch};
pub use instrument::{Instrument, QueueFull, StringGeometry};
pub use model::{Barrier, Model, StringParameters};
pub use observed::Observed;
pub use quality::Quality;
pub use ratio::Ratio;
pub use scene::{Scene, SolverSettings, Stencil};
pub use settings::EngineSettings;
pub use setup::Setup;
pub use simulation::Simulation;
pub use solver::Convergence;
pub use state::State;
pub use string::Scratch;
