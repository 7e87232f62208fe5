//! The model of one string: every coefficient that stays the same while it is played, and how exactly it is solved.

mod barrier;
mod coasting;
mod fixed;
mod parameters;
mod steepness;
mod stiffness;

use std::ops::RangeInclusive;

use crate::contact::ContactLaw;
use crate::digits::{at_least, cleared, plain};
use crate::error::{Error, within};
use crate::finger::Inertia;
use crate::flexibility::Flexibility;
use crate::gesture::Touch;
use crate::grid::{Grid, Reading};
use crate::response::Needs;
use crate::scene::{FretPlacement, MOST_FINGERS, SolverSettings, Stencil};
use crate::skyline::Beside;
pub use barrier::Barrier;
pub(crate) use barrier::equal_place;
pub(crate) use coasting::Coasting;
pub use fixed::{Contact, ContactKind};
pub use parameters::StringParameters;
pub use steepness::stiffest;
use steepness::{STEEPEST, check_stiffness, too_stiff};
pub use stiffness::Stiffness;

/// Everything about one string that stays the same while it is played, but for `settings`, of which an instrument may change the
/// cap and the tolerance ([`set_effort`](crate::Instrument::set_effort)).
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
    /// How the string goes on by itself while no hand is laid along it.
    pub(crate) coasting: Coasting,
    /// 1/(2k), 1/s.
    pub(crate) half_rate: f64,
    /// 1/(N − 1): a sum over all points times that is their mean.
    pub(crate) point_share: f64,
    /// The contacts beside each grid point.
    pub(crate) beside: Beside,
}

impl Model {
    /// What sample rates may be, Hz.
    pub(crate) const RATES: RangeInclusive<f64> = 1e3..=1e7;

    /// Compiles a string over a barrier, with room for so many fingers, 100 at most, at a sample rate in Hz, 1e3 to 1e7.
    ///
    /// # Errors
    /// When a number is out of its range, the string is too short for its grid, a fret is off the string, a contact is too
    /// stiff to be told from rounding at this rate, or contacts are so crowded that what they are to each other takes more than
    /// [`MOST_NUMBERS`].
    pub fn new(
        string: StringParameters,
        barrier: Option<&Barrier>,
        finger_slots: usize,
        settings: SolverSettings,
        sample_rate: f64,
    ) -> Result<Model, Error> {
        let model = Self::of_any_crowd(string, barrier, finger_slots, settings, sample_rate)?;
        // As many as all squared, twice: of few contacts nothing need be counted.
        let all = (model.contacts.len() + finger_slots) as f64;
        if 2.0 * all * all <= MOST_NUMBERS as f64 || model.numbers() <= MOST_NUMBERS {
            return Ok(model);
        }
        let accepted = format!(
            "contacts that share grid points are too many: how each answers each may take {} numbers, with {finger_slots} fingers",
            plain(MOST_NUMBERS as f64)
        );
        let frets = barrier.map_or(0, |barrier| barrier.frets.len());
        Err(Error::range("number of fretboard.frets", frets, accepted))
    }

    /// The same however crowded contacts are: for whoever counts what several strings need together.
    pub(crate) fn of_any_crowd(
        string: StringParameters,
        barrier: Option<&Barrier>,
        finger_slots: usize,
        settings: SolverSettings,
        sample_rate: f64,
    ) -> Result<Model, Error> {
        string.check()?;
        settings.check()?;
        within("finger_slots", finger_slots as f64, 0.0, MOST_FINGERS as f64, "")?;
        within("sample_rate", sample_rate, *Self::RATES.start(), *Self::RATES.end(), "Hz")?;
        let time_step = 1.0 / sample_rate;
        let grid = Self::grid(&string, settings.stencil, time_step)?;
        let coasting = Coasting::new(&string, &grid, string.loss_0);
        let Coasting { loss_0, mobility, .. } = coasting;
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
            let kappa_squared = string.kappa_squared();
            let at_rest =
                Stiffness::new(settings.stencil, string.linear_density, string.tension, kappa_squared, &grid);
            let flexibility = Flexibility::new(&string, &at_rest, &grid);
            contacts.iter_mut().for_each(|contact| contact.bend_round(&string, &grid, &flexibility));
        }
        let string = StringParameters { loss_0, ..string };
        let beside = Beside::new(&grid, &contacts);
        Ok(Model {
            grid,
            string,
            settings,
            contacts,
            finger_slots,
            coasting,
            half_rate: 0.5 / time_step,
            point_share: 1.0 / grid.unknowns() as f64,
            beside,
        })
    }

    /// The finest grid on which the scheme is stable up to the tension limit.
    ///
    /// # Errors
    /// When the string is too short for a grid of the least number of intervals at this time step.
    pub fn grid(string: &StringParameters, stencil: Stencil, time_step: f64) -> Result<Grid, Error> {
        let kappa_squared = string.kappa_squared();
        let fits = |length: f64, intervals: usize| {
            let grid = Grid::new(length, intervals, time_step);
            [string.tension_limit, string.tension].iter().all(|&tension| {
                let stiffness = Stiffness::new(stencil, string.linear_density, tension, kappa_squared, &grid);
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
            let mut long = string.length.max(SHORTEST);
            let mut short = long;
            while !fits(long, LEAST_INTERVALS) && long < LONGEST {
                (short, long) = (long, 2.0 * long);
            }
            while long - short > 1e-4 * long {
                let middle = 0.5 * (short + long);
                if fits(middle, LEAST_INTERVALS) { long = middle } else { short = middle }
            }
            let accepted = format!(
                "the string is too short for its grid at {} Hz: it must be at least {} m",
                plain(cleared(1.0 / time_step)),
                plain(at_least(1.001 * long)),
            );
            return Err(Error::range("length", plain(string.length), accepted));
        }
        Ok(Grid::new(string.length, low, time_step))
    }

    /// How the string goes on by itself under a hand laid along it that adds so much to its loss, 1/s: 0 or more, and no more than
    /// what brings a free point to rest in a step. (A hand so soft that it is lost in rounding does nothing: it never gives.)
    pub(crate) fn coasting_under(&self, loss: f64) -> Coasting {
        let loss = loss.max(0.0).min(2.0 * self.half_rate);
        if loss == 0.0 {
            return self.coasting;
        }
        let under = Coasting::new(&self.string, &self.grid, self.string.loss_0 + loss);
        if under.loss_0 > self.coasting.loss_0 { under } else { self.coasting }
    }

    /// The string's stiffness at a tension, N.
    pub fn stiffness(&self, tension: f64) -> Stiffness {
        let kappa_squared = self.string.kappa_squared();
        Stiffness::new(self.settings.stencil, self.string.linear_density, tension, kappa_squared, &self.grid)
    }

    /// How many numbers say how contacts and fingers answer one another.
    pub(crate) fn numbers(&self) -> usize {
        Needs::numbers(&self.spans(), self.finger_slots)
    }

    /// How many steps it may take to solve once for all contacts and fingers.
    pub(crate) fn contact_work(&self) -> f64 {
        Needs::work(&self.spans(), self.finger_slots)
    }

    /// The grid points that each fixed contact touches, from the first to the one after the last, in the order in which many
    /// are solved.
    pub(crate) fn spans(&self) -> Vec<(usize, usize)> {
        let mut readings: Vec<_> = self.contacts.iter().map(|contact| contact.reading).collect();
        readings.sort_by(Reading::order);
        readings.iter().map(Reading::span).collect()
    }

    /// The tension, N, beyond which the shortest wave of the grid ripples, what stretching adds included, while the string's
    /// own is `tension`.
    pub fn tension_borne(&self, tension: f64) -> f64 {
        let Model { grid, string, .. } = self;
        let square = grid.spacing / grid.time_step * (grid.spacing / grid.time_step);
        let taken = self.stiffness(tension).stability(string.linear_density, string.loss_1, grid);
        tension + (1.0 - taken) * string.linear_density * square
    }

    /// P = βφ(ηⁿ)/(2k), N/m, of a contact of damping β at a penetration, m, where its `force` φ is in N: what its force gains for
    /// each metre by which it is pressed in farther, as [steeply](STEEPEST) as doubles can tell at most.
    #[inline(always)]
    pub(crate) fn lossy(
        &self,
        force: impl Fn(f64) -> f64,
        damping: f64,
        penetration: f64,
        own_mobility: f64,
    ) -> f64 {
        if damping == 0.0 || penetration <= 0.0 {
            return 0.0;
        }
        let lossy = damping * force(penetration) * self.half_rate;
        let mobility = self.coasting.mobility + own_mobility;
        if lossy * mobility > STEEPEST { STEEPEST / mobility } else { lossy }
    }

    /// The law of a finger's pad.
    ///
    /// # Errors
    /// When a number of the touch is out of its range, or the pad is too stiff to be told from rounding at this rate.
    pub fn finger_law(&self, touch: &Touch) -> Result<ContactLaw, Error> {
        touch.check("finger")?;
        let law = ContactLaw::known(touch.stiffness, touch.exponent);
        self.law_if_soft(&law, touch)
            .ok_or_else(|| too_stiff("finger.stiffness", &law, law.stiffness(), self.mobility_under(touch)))
    }

    /// The same of a possible finger without the words, which take memory: fingers are placed while processing.
    pub(crate) fn finger_law_if(&self, touch: &Touch) -> Option<ContactLaw> {
        self.law_if_soft(&ContactLaw::known(touch.stiffness, touch.exponent), touch)
    }

    fn law_if_soft(&self, law: &ContactLaw, touch: &Touch) -> Option<ContactLaw> {
        let mobility = self.mobility_under(touch);
        let soft = law.stiffness() <= stiffest(law.exponent(), mobility);
        soft.then(|| law.no_steeper_than(STEEPEST / mobility))
    }

    /// How far one newton between a finger and the string moves them apart in a step, m/N.
    fn mobility_under(&self, touch: &Touch) -> f64 {
        self.coasting.mobility + Inertia::new(touch, self.grid.time_step).mobility
    }
}

/// The fewest intervals of a grid: room for one cubic interpolation.
const LEAST_INTERVALS: usize = 4;

/// Between these the length is looked for that a string must have, m, whatever numbers there are to begin with.
const SHORTEST: f64 = 1e-9;
const LONGEST: f64 = 1e9;

/// The most numbers that say how the contacts of a string, or of all strings of a scene, answer one another: as many for a crowd of
/// contacts that share grid points as twice its square.
pub const MOST_NUMBERS: usize = 100_000_000;

/// The most intervals of a grid, a limit against descriptions that would fill the memory.
const MOST_INTERVALS: usize = 1_000_000;
