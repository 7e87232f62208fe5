//! The `scene` command.

use super::{Failure, Outcome, SceneArgs};

/// Computes a scene.
pub(super) fn run(_arguments: &SceneArgs) -> Outcome {
    Err(Failure::Usage("scenes cannot be computed yet".into()))
}
