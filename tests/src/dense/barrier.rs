//! Board and frets as contacts: at points of the grid, between them, or with the string bent round them.

use nalgebra::{DMatrix, DVector};

use super::setup::at;
use super::{Fret, Law, Placement, Reference, straight_weights, weights};

/// A point of board or fret.
#[derive(Clone, Debug)]
pub struct Barrier {
    /// Spreading column g, 1/m.
    pub column: DVector<f64>,
    /// Height b, m.
    pub height: f64,
    /// Contact law.
    pub law: Law,
    /// Hunt–Crossley damping β, s/m.
    pub damping: f64,
    /// 2√(Tρ) of a kinked fret, which meets a contact that has just been made, N s/m; else 0.
    pub resistance: f64,
}

impl Reference {
    /// A board point at every interior node and a fret at each place; a fret on a node replaces the board there.
    pub(super) fn barriers(&self) -> Vec<Barrier> {
        let Some(fretboard) = &self.setup.fretboard else { return Vec::new() };
        let (spacing, intervals) = (self.spacing, self.intervals);
        let place = |fret: &Fret| match fretboard.placement {
            Placement::Nearest => (fret.position / spacing).round() * spacing,
            Placement::Exact | Placement::Kinked => fret.position,
        };
        let exact = |position: f64, height, stiffness| Barrier {
            column: weights(position, spacing, intervals) / spacing,
            height,
            law: Law::new(stiffness, fretboard.exponent),
            damping: fretboard.damping,
            resistance: 0.0,
        };
        let mut all = Vec::new();
        for node in 1..intervals {
            let position = node as f64 * spacing;
            let fretted = fretboard.frets.iter().any(|f| (place(f) - position).abs() < 1e-9 * spacing);
            if let (Some(board), false) = (&fretboard.board, fretted) {
                let share = fretboard.board_reference_spacing.map_or(1.0, |reference| spacing / reference);
                all.push(exact(position, at(board, position), fretboard.stiffness * share));
            }
        }
        for fret in &fretboard.frets {
            let plain = exact(place(fret), fret.top, fretboard.stiffness);
            let bent = (fretboard.placement == Placement::Kinked).then(|| self.bent_round(fret, &plain));
            all.push(bent.flatten().unwrap_or(plain));
        }
        all
    }

    /// A fret round which the string bends within a cell of the grid, if the grid gives way there by so much less than the
    /// string that it matters: by more than a tenth of h/T.
    fn bent_round(&self, fret: &Fret, exact: &Barrier) -> Option<Barrier> {
        let tension = at(&self.setup.tension, 0.0);
        let weights = straight_weights(fret.position, self.spacing, self.intervals);
        let points = weights.len();
        // A force f at the place is f w/h per length: 0 = ρ S u + f w/h.
        let unit = |j: usize| DVector::from_fn(points, |i, _| f64::from(i == j));
        let columns: Vec<_> = (0..points).map(|j| self.acceleration(0.0, &unit(j))).collect();
        let stiffness = DMatrix::from_columns(&columns) * (-self.setup.linear_density * self.spacing);
        let of_grid = weights.dot(&stiffness.lu().solve(&weights).expect("a taut string is stiff"));
        let lacking = self.setup.flexibility(fret.position, tension) - of_grid;
        (lacking > 0.1 * self.spacing / tension).then(|| Barrier {
            column: weights / self.spacing,
            law: exact.law.giving_way(lacking),
            resistance: 2.0 * (tension * self.setup.linear_density).sqrt(),
            ..exact.clone()
        })
    }
}
