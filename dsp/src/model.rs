//! The model of one string: every coefficient that stays the same while it is played.

use crate::contact::ContactLaw;
use crate::curve::{CountOrList, Curve, OneOrEach};
use crate::error::{Error, plain};
use crate::finger::Inertia;
use crate::flexibility::Flexibility;
use crate::grid::{Grid, Reading};
use crate::scene::{FretPlacement, FretboardSpec, SolverSettings, Stencil, StringSpec};
use crate::skyline::Blocks;

/// The physical numbers of one string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StringParameters {
    /// Length, m.
    pub length: f64,
    /// Mass per length, kg/m.
    pub linear_density: f64,
    /// Tension at rest, N.
    pub tension: f64,
    /// The largest tension that bends will reach, N; the grid is made for it.
    pub tension_limit: f64,
    /// Young's modulus of the core, Pa.
    pub youngs_modulus: f64,
    /// Radius of the core, m.
    pub core_radius: f64,
    /// Loss of all frequencies alike, 1/s.
    pub loss_0: f64,
    /// Loss that grows with frequency, m²/s.
    pub loss_1: f64,
    /// Whether stretching raises the tension.
    pub tension_modulation: bool,
}

impl StringParameters {
    /// The string of a scene at its first moment.
    pub fn from_spec(spec: &StringSpec) -> Self {
        StringParameters {
            length: spec.length,
            linear_density: spec.linear_density,
            tension: spec.tension.at(0.0),
            tension_limit: spec.tension.largest(),
            youngs_modulus: spec.youngs_modulus,
            core_radius: spec.core_radius,
            loss_0: spec.loss_0,
            loss_1: spec.loss_1,
            tension_modulation: spec.tension_modulation,
        }
    }

    /// Axial stiffness EA, N, of the core.
    pub fn axial_stiffness(&self) -> f64 {
        self.youngs_modulus * std::f64::consts::PI * self.core_radius * self.core_radius
    }

    /// κ² = EI/ρ, m⁴/s².
    pub fn kappa_squared(&self) -> f64 {
        let r = self.core_radius;
        self.youngs_modulus * std::f64::consts::PI * r * r * r * r / 4.0 / self.linear_density
    }
}

/// The string's stiffness at one tension: T D_xx − ρκ₂² D_xxxx + ρκ₆ D_xx³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// Tension T, N.
    pub tension: f64,
    /// κ₂², m⁴/s²: bending stiffness over linear density, with the stencil's correction.
    pub kappa_2: f64,
    /// κ₆, m⁶/s²: the sixth-order correction of the wide stencil, 0 in the others.
    pub kappa_6: f64,
}

impl Stiffness {
    /// The stiffness that a stencil gives a string of squared wave speed `c2` and bending `kappa2`.
    fn new(stencil: Stencil, linear_density: f64, tension: f64, kappa: f64, grid: &Grid) -> Self {
        let (k, h) = (grid.time_step, grid.spacing);
        let c2 = tension / linear_density;
        let courant2 = c2 * k * k / (h * h);
        let corrected = kappa + c2 * h * h / 12.0 * (1.0 - courant2);
        let (kappa_2, kappa_6) = match stencil {
            Stencil::Paper => (kappa, 0.0),
            Stencil::Corrected => (corrected, 0.0),
            Stencil::Wide => {
                let sixth = (1.0 - courant2) * h * h * (c2 * h * h * (4.0 - courant2) / 360.0 + kappa / 6.0);
                (corrected, sixth)
            }
        };
        Stiffness { tension, kappa_2, kappa_6 }
    }

    /// λ² + 4κ₂²k²/h⁴ + 16κ₆k²/h⁶ + 4σ₁k/h²: the scheme is stable while this is at most 1.
    fn stability(&self, linear_density: f64, loss_1: f64, grid: &Grid) -> f64 {
        let (k, h2) = (grid.time_step, grid.spacing * grid.spacing);
        let courant2 = self.tension / linear_density * k * k / h2;
        courant2
            + 4.0 * self.kappa_2 * k * k / (h2 * h2)
            + 16.0 * self.kappa_6 * k * k / (h2 * h2 * h2)
            + 4.0 * loss_1 * k / h2
    }
}

/// A place where the string can touch something fixed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Where it is, m from the nut.
    pub place: f64,
    /// The point of the string.
    pub reading: Reading,
    /// The contact law.
    pub law: ContactLaw,
    /// Hunt–Crossley damping, s/m.
    pub damping: f64,
    /// Height of the barrier, m, when the model is made.
    pub height: f64,
    /// What waves too short for the grid take away from a contact that has just been made, N s/m; 0 where frets act on grid
    /// points alone.
    pub radiation: f64,
    /// What it is.
    pub kind: ContactKind,
}

impl Contact {
    /// Whether it takes energy from what moves into it.
    #[inline(always)]
    pub(crate) fn resists(&self) -> bool {
        self.damping > 0.0 || self.radiation > 0.0
    }

    /// How much of a penetration, m, the contact itself is pressed in by: the rest, if any, is how far a string gives way round
    /// a kinked fret.
    pub fn pressed_in(&self, penetration: f64) -> f64 {
        if self.radiation > 0.0 { self.law.own_penetration(penetration) } else { penetration }
    }

    /// For how many steps a contact that has just been made sends off waves that are too short for the grid, less and less:
    /// they are about as long as it takes to cross two or three spacings.
    pub const RADIATING: u64 = 5;

    /// The resistance, N s/m, of a contact that will radiate for so many steps more.
    #[inline(always)]
    pub fn radiating(&self, left: u64) -> f64 {
        left as f64 / Self::RADIATING as f64 * self.radiation
    }

    /// Lets the string bend round a fret as it does within a spacing of the grid: what makes it give way there is a spring
    /// between the two, and what the waves that are too short for the grid take away a resistance, while they do.
    fn bend_round(&mut self, string: &StringParameters, grid: &Grid, flexibility: &Flexibility) {
        if !matches!(self.kind, ContactKind::Fret { .. }) {
            return;
        }
        let reading = grid.straight_reading(self.place);
        let residual = flexibility.residual(self.place, &reading);
        if residual > LACKING * grid.spacing / string.tension {
            self.reading = reading;
            self.law = self.law.giving_way(residual);
            self.radiation = 2.0 * (string.tension * string.linear_density).sqrt();
        }
    }
}

/// What a grid lacks is made up for where it is more than this part of h/T, the depth of the largest chord under a kink being
/// a quarter. So small a part lets a hundredth of the losses behind a fret remain, and less of it makes a spring too stiff for
/// the resistance beside it to keep a string from rattling.
const LACKING: f64 = 0.1;

/// What a fixed contact is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// The board at a grid point.
    Board {
        /// Which grid point.
        node: usize,
    },
    /// A fret.
    Fret {
        /// Which fret, 0 for the first of the barrier's list.
        index: usize,
    },
}

/// Board and frets under one string.
#[derive(Debug, Clone, PartialEq)]
pub struct Barrier {
    /// Contact law of a fret, and of a board point unless `board_reference_spacing` is given.
    pub law: ContactLaw,
    /// Hunt–Crossley damping of board and frets, s/m.
    pub damping: f64,
    /// Height of the board, m, over places, m; none beyond the ends of its points.
    pub board: Option<Curve>,
    /// Places, m from the nut, and heights, m, of the crowns.
    pub frets: Vec<[f64; 2]>,
    /// Where frets act on the grid.
    pub placement: FretPlacement,
    /// Spacing for which the law's stiffness holds at board points, m.
    pub board_reference_spacing: Option<f64>,
}

impl Barrier {
    /// The barrier of a scene under a string of the given length.
    pub fn from_spec(spec: &FretboardSpec, length: f64) -> Result<Self, Error> {
        let places: Vec<f64> = match &spec.frets {
            // Equal temperament: fret m leaves 2^(−m/12) of the string.
            CountOrList::Count(count) => {
                (1..=*count).map(|m| length * (1.0 - libm::exp2(-(m as f64) / 12.0))).collect()
            }
            CountOrList::List(places) => places.clone(),
        };
        let height = |i: usize| match &spec.fret_top {
            None => 0.0,
            Some(OneOrEach::One(height)) => *height,
            Some(OneOrEach::Each(heights)) => heights[i],
        };
        Ok(Barrier {
            law: ContactLaw::new("fretboard", spec.stiffness, spec.exponent)?,
            damping: spec.damping,
            board: spec.board.clone(),
            frets: places.iter().enumerate().map(|(i, &x)| [x, height(i)]).collect(),
            placement: spec.fret_placement,
            board_reference_spacing: spec.board_reference_spacing,
        })
    }

    /// The contacts over a grid, in order of place. Where several share a point, the highest stands
    /// for all: the barrier is one height at each point, and a fret at a grid point replaces the board.
    fn contacts(&self, grid: &Grid) -> Result<Vec<Contact>, Error> {
        let mut contacts = Vec::new();
        let damping = self.damping;
        if let Some(board) = &self.board {
            let scale = self.board_reference_spacing.map_or(1.0, |spacing| grid.spacing / spacing);
            let law = self.law.with_stiffness(self.law.stiffness() * scale);
            for node in 1..grid.intervals {
                let place = grid.place(node);
                let beyond = match board {
                    Curve::Constant(_) => false,
                    Curve::Points(p) => place < p[0][0] || place > p[p.len() - 1][0],
                };
                if !beyond {
                    let reading = Reading::at_node(grid, node);
                    let kind = ContactKind::Board { node };
                    contacts.push(Contact {
                        place,
                        reading,
                        law,
                        damping,
                        height: board.at(place),
                        radiation: 0.0,
                        kind,
                    });
                }
            }
        }
        for (index, &[place, height]) in self.frets.iter().enumerate() {
            grid.check_place(&format!("fretboard.frets[{}]", index + 1), place)?;
            let (place, reading) = match self.placement {
                FretPlacement::Exact | FretPlacement::Kinked => (place, grid.reading(place)),
                FretPlacement::Nearest => {
                    let node = ((place / grid.spacing).round() as usize).clamp(1, grid.intervals - 1);
                    (grid.place(node), Reading::at_node(grid, node))
                }
            };
            let kind = ContactKind::Fret { index };
            let fret = Contact { place, reading, law: self.law, damping, height, radiation: 0.0, kind };
            let same = contacts.iter().position(|other| other.reading == reading);
            match same {
                Some(i) if matches!(contacts[i].kind, ContactKind::Board { .. }) => contacts[i] = fret,
                Some(i) if contacts[i].height >= height => {}
                Some(i) => contacts[i] = fret,
                None => contacts.push(fret),
            }
        }
        contacts.sort_by(|a, b| a.place.total_cmp(&b.place));
        Ok(contacts)
    }
}

/// Everything about one string that stays the same while it is played.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Grid in space and time.
    pub grid: Grid,
    /// The string's physical numbers; `loss_0` is the one realised, which differs from the one asked
    /// for in the last digit.
    pub string: StringParameters,
    /// How the scheme is solved.
    pub settings: SolverSettings,
    /// Fixed contacts in order of place.
    pub contacts: Vec<Contact>,
    /// Number of places for fingers.
    pub finger_slots: usize,
    /// (1 − σ₀k)/(1 + σ₀k), how much of the motion is left after a step.
    pub(crate) decay: f64,
    /// 1/s = 1/(1 + σ₀k) = (1 + decay)/2, exactly.
    pub(crate) inverse_s: f64,
    /// k²/(ρhs): displacement in one step per newton at a grid point, m/N.
    pub(crate) mobility: f64,
    /// 1/(2k), 1/s.
    pub(crate) half_rate: f64,
    /// The contacts beside each group of grid points.
    pub(crate) blocks: Blocks,
    /// k²EA/(4ρLh³s), the strength of tension modulation in units of undivided second differences.
    pub(crate) stretch: f64,
}

impl Model {
    /// Compiles a string over a barrier, with room for fingers, at a sample rate in Hz.
    ///
    /// # Errors
    /// When the string is too short for its grid, a fret is off the string, or a contact is too stiff
    /// to be told from rounding at this rate.
    pub fn new(
        string: StringParameters,
        barrier: Option<&Barrier>,
        finger_slots: usize,
        settings: SolverSettings,
        sample_rate: f64,
    ) -> Result<Model, Error> {
        let time_step = 1.0 / sample_rate;
        let grid = Self::grid(&string, settings.stencil, time_step)?;
        // (1 + x) − 1 rounds `decay` to a multiple of 2⁻⁵², so that 1 + decay is exact: an inverse that
        // is off by half an ulp would drift the energy by 1e-16 in every sample.
        let decay = (1.0 + (1.0 - string.loss_0 * time_step) / (1.0 + string.loss_0 * time_step)) - 1.0;
        let inverse_s = 0.5 * (1.0 + decay);
        let loss_0 = (1.0 - decay) / (1.0 + decay) / time_step;
        let k2 = time_step * time_step;
        let h = grid.spacing;
        let mobility = k2 * inverse_s / (string.linear_density * h);
        let stretch = if string.tension_modulation {
            k2 * string.axial_stiffness() * inverse_s
                / (4.0 * string.linear_density * string.length * h * h * h)
        } else {
            0.0
        };
        let mut contacts = barrier.map_or(Ok(Vec::new()), |barrier| barrier.contacts(&grid))?;
        if let Some(barrier) = barrier {
            // A board's points have each a share of the stiffness: what is the stiffest speaks for all.
            let most = contacts.iter().map(|contact| contact.law.stiffness()).fold(0.0, f64::max);
            check_stiffness("fretboard.stiffness", &barrier.law, most, mobility)?;
        }
        for contact in &mut contacts {
            contact.law = contact.law.no_steeper_than(STEEPEST / mobility);
        }
        if barrier.is_some_and(|barrier| barrier.placement == FretPlacement::Kinked) {
            let kappa = string.kappa_squared();
            let at_rest =
                Stiffness::new(settings.stencil, string.linear_density, string.tension, kappa, &grid);
            let flexibility = Flexibility::new(&string, &at_rest, &grid);
            contacts.iter_mut().for_each(|contact| contact.bend_round(&string, &grid, &flexibility));
        }
        let string = StringParameters { loss_0, ..string };
        let blocks = Blocks::new(&grid, &contacts);
        Ok(Model {
            grid,
            string,
            settings,
            contacts,
            finger_slots,
            decay,
            inverse_s,
            mobility,
            half_rate: 0.5 / time_step,
            blocks,
            stretch,
        })
    }

    /// The finest grid on which the scheme is stable up to the tension limit.
    pub fn grid(string: &StringParameters, stencil: Stencil, time_step: f64) -> Result<Grid, Error> {
        let kappa = string.kappa_squared();
        let fits = |length: f64, intervals: usize| {
            let grid = Grid::new(length, intervals, time_step);
            [string.tension_limit, string.tension].iter().all(|&tension| {
                let stiffness = Stiffness::new(stencil, string.linear_density, tension, kappa, &grid);
                let wave_fits =
                    tension / string.linear_density * time_step * time_step <= grid.spacing * grid.spacing;
                wave_fits && stiffness.stability(string.linear_density, string.loss_1, &grid) <= 1.0
            })
        };
        // The coarsest bound: a wave crosses at most one spacing per step.
        let wave_speed = (string.tension_limit / string.linear_density).sqrt();
        let most = (string.length / (wave_speed * time_step)).min(MOST_INTERVALS as f64) as usize;
        let (mut low, mut high) = (0, most + 1);
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if fits(string.length, middle) { low = middle } else { high = middle }
        }
        if low < LEAST_INTERVALS {
            // The spacing that just fits in so few intervals, from below and above.
            let (mut short, mut long) = (string.length, string.length);
            while !fits(long, LEAST_INTERVALS) {
                (short, long) = (long, 2.0 * long);
            }
            while long - short > 1e-4 * long {
                let middle = 0.5 * (short + long);
                if fits(middle, LEAST_INTERVALS) { long = middle } else { short = middle }
            }
            let accepted = format!(
                "the string is too short for its grid at {} Hz: it must be at least {} m",
                plain(1.0 / time_step),
                // Rounded up in the fourth digit.
                plain((long * 1.001 * 1e6).ceil() / 1e6),
            );
            return Err(Error::range("length", plain(string.length), accepted));
        }
        Ok(Grid::new(string.length, low, time_step))
    }

    /// The string's stiffness at a tension, N.
    pub fn stiffness(&self, tension: f64) -> Stiffness {
        let kappa = self.string.kappa_squared();
        Stiffness::new(self.settings.stencil, self.string.linear_density, tension, kappa, &self.grid)
    }

    /// P = βφ(ηⁿ)/(2k), N/m, of a contact of damping β at a penetration: what its force gains for each metre by which it
    /// is pressed in farther, as [steeply](STEEPEST) as doubles can tell at most.
    #[inline(always)]
    pub(crate) fn lossy(&self, law: &ContactLaw, damping: f64, penetration: f64, own_mobility: f64) -> f64 {
        if damping == 0.0 || penetration <= 0.0 {
            return 0.0;
        }
        let lossy = damping * law.own_force(penetration) * self.half_rate;
        let mobility = self.mobility + own_mobility;
        if lossy * mobility > STEEPEST { STEEPEST / mobility } else { lossy }
    }

    /// The law of a finger's pad.
    ///
    /// # Errors
    /// When the pad is too stiff to be told from rounding at this rate.
    pub fn finger_law(&self, touch: &crate::gesture::Touch) -> Result<ContactLaw, Error> {
        let law = ContactLaw::new("finger", touch.stiffness, touch.exponent)?;
        let mobility = self.mobility + Inertia::new(touch, self.grid.time_step).mobility;
        check_stiffness("finger.stiffness", &law, law.stiffness(), mobility)?;
        Ok(law.no_steeper_than(STEEPEST / mobility))
    }
}

/// The fewest intervals of a grid: room for one cubic interpolation.
const LEAST_INTERVALS: usize = 4;

/// The most intervals of a grid, a limit against descriptions that would fill the memory.
const MOST_INTERVALS: usize = 1_000_000;

/// A contact is refused if M φ′ is above this at 1 cm of motion in one step.
const CONDITIONING: f64 = 1e10;

/// Beyond this M φ′ a contact grows no steeper: it then yields 1e-8 of what the point would move without it,
/// and the last digit of a motion still is 1e-8 of the force.
const STEEPEST: f64 = 1e8;

/// The stiffest contact of an exponent, N/m^exponent, that is accepted where one newton moves a point by
/// `mobility`, m/N, in a step: Mα K^(1/α) F^(1−1/α) ≤ 1e10 with F = 1 cm/M, M the mobility.
pub fn stiffest(exponent: f64, mobility: f64) -> f64 {
    let force = 0.01 / mobility;
    let conditioning = mobility * exponent * libm::pow(force, 1.0 - 1.0 / exponent);
    libm::pow(CONDITIONING / conditioning, exponent)
}

/// Refuses a contact that is stiffer than that: of a stiffness, N/m^exponent, that is a part or a multiple of the one
/// that its description gives it, which is the one named.
fn check_stiffness(name: &str, given: &ContactLaw, stiffness: f64, mobility: f64) -> Result<(), Error> {
    let limit = stiffest(given.exponent(), mobility);
    if stiffness <= limit {
        return Ok(());
    }
    // Half a percent is as much as three digits can be too high by.
    let accepted = format!(
        "at this sample rate it must be at most {:.2e} N/m^exponent",
        0.995 * limit * (given.stiffness() / stiffness)
    );
    Err(Error::range(name, plain(given.stiffness()), accepted))
}
