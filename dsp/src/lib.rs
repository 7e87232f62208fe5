//! The physics of Low Action.
