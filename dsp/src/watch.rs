//! Which fixed contacts must be looked at in a step. Most are far from the string, and the string cannot
//! have come nearer to any of them than by all that its points have moved since the gap was last seen.

/// Steps of the size of the last one for which contacts are looked at ahead of one.
const AHEAD: f64 = 2.0;

/// Steps of that size for which contacts are listed as near.
const LISTED: f64 = 8.0;

/// Steps of that size after which the list is made anew in any case, to be rid of what is near no more.
const LASTING: f64 = 16.0;

/// Way, m, after which it is counted from 0 again, so that gaps keep their digits.
const LONG: f64 = 1.0;

/// What rounding may take of a gap.
const SHORTENED: f64 = 1.0 - 1e-12;

/// The way that the string has gone, and the way at which it can reach each contact.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Watch {
    /// The most that any point of the string can have moved against any contact, m.
    way: f64,
    /// How much of it in the last step, m.
    last: f64,
    /// The way at which each contact can be reached, m.
    due: Vec<f64>,
    /// Contacts that are near, in order: all that are due before the way `listed`.
    near: Vec<u32>,
    listed: f64,
}

impl Watch {
    /// For so many contacts, all to be looked at.
    pub fn new(contacts: usize) -> Self {
        let mut watch =
            Watch { due: vec![0.0; contacts], near: Vec::with_capacity(contacts), ..Watch::default() };
        watch.forget();
        watch
    }

    /// Has every contact looked at.
    pub fn forget(&mut self) {
        self.due.fill(0.0);
        self.way = 0.0;
        self.last = 0.0;
        self.near.clear();
        self.listed = 0.0;
    }

    /// The way within which contacts are looked at before a step: all that touch at n − 1 or n are, and most
    /// that will at n + 1.
    pub fn ahead(&self) -> f64 {
        self.way + AHEAD * self.last
    }

    /// The way after a step in which no point moves by more than `moved`, m.
    pub fn after(&self, moved: f64) -> f64 {
        self.way + moved
    }

    /// Contacts listed as near, in order: all that are due by the way last asked for.
    pub fn near(&self) -> &[u32] {
        &self.near
    }

    /// Has [`near`](Self::near) hold all that are due by some way.
    #[inline(always)]
    pub fn look(&mut self, way: f64) {
        let known = way < self.listed;
        if !known {
            self.list(way + (LISTED - AHEAD) * self.last, way + LASTING * self.last);
        }
    }

    /// Lists what is due by some way. (What is not a number is.) The list holds until the next contact is due, at
    /// most up to the way `longest`.
    fn list(&mut self, way: f64, longest: f64) {
        self.near.clear();
        self.listed = longest;
        for (contact, &due) in self.due.iter().enumerate() {
            if due > way {
                self.listed = self.listed.min(due);
            } else {
                self.near.push(contact as u32);
            }
        }
    }

    /// Whether a contact may be reached by some way.
    #[inline(always)]
    pub fn is_due(&self, contact: usize, way: f64) -> bool {
        let beyond = self.due[contact] > way;
        !beyond
    }

    /// Notes the gap that there is at present between the string and a contact, m.
    #[inline(always)]
    pub fn note(&mut self, contact: usize, gap: f64) {
        self.due[contact] = self.way + SHORTENED * gap;
    }

    /// The string has made a step in which no point moved by more than `moved`, m.
    #[inline(always)]
    pub fn go(&mut self, moved: f64) {
        self.last = moved;
        self.way += moved;
        if self.way > LONG {
            self.begin_again();
        }
    }

    #[cold]
    fn begin_again(&mut self) {
        let way = std::mem::take(&mut self.way);
        self.due.iter_mut().for_each(|due| *due -= way);
        self.listed -= way;
    }
}
