//! Helpers shared by the promise tests.
