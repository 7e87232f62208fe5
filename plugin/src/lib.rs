//! Low Action.
