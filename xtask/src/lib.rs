//! The measurements of the repository and where it is, apart from the program that runs them so that tests can use them.

pub mod files;
pub mod measure;
pub mod numbers;
pub mod repository;
pub mod stencils;
