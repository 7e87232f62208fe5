//! The measurements of the repository, apart from the program that runs them so that tests can use them.

pub mod measure;
