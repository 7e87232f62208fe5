//! The contact forces of a sample in which many contacts act.

use super::{ARRAYS, Convergence, Demands, Room, Solver, solve, solve_few};
use crate::active::Active;
use crate::instructions::{Instructions, Pass, Vectors};

/// More contacts than the step itself has code for: rare, and apart from it, as the code of all sizes in one place slows
/// down the few. Compiled for each instruction set, as a step is.
pub(super) struct Many<'a> {
    pub solver: &'a mut Solver,
    pub contacts: &'a mut [Active],
    pub pull_factor: f64,
    pub demands: Demands<'a>,
    pub convergence: &'a mut Convergence,
}

impl Many<'_> {
    #[inline(never)]
    pub fn solve(self, instructions: Instructions) -> f64 {
        instructions.run(self)
    }
}

impl Pass for Many<'_> {
    type Output = f64;

    #[inline(always)]
    fn by<V: Vectors>(self, _: V) -> f64 {
        let Many { solver, contacts, pull_factor, demands, convergence } = self;
        match contacts.len() {
            7 => solve_few::<7>(contacts, pull_factor, demands, convergence),
            8 => solve_few::<8>(contacts, pull_factor, demands, convergence),
            9 => solve_few::<9>(contacts, pull_factor, demands, convergence),
            10 => solve_few::<10>(contacts, pull_factor, demands, convergence),
            count => {
                in_order(contacts);
                solver.response.gather(contacts, pull_factor);
                solver.room.clear();
                solver.room.resize(ARRAYS * count, 0.0);
                let room = Room::new(&mut solver.room, count);
                solve(contacts, &mut solver.response, room, demands, convergence)
            }
        }
    }
}

/// Puts contacts in the order in which the response of many has room for them.
fn in_order(contacts: &mut [Active]) {
    contacts.sort_unstable_by(|a, b| a.reading.order(&b.reading).then(a.slot.cmp(&b.slot)));
}
