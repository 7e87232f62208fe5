//! The stencils, in the colours that they have in every picture.

use low_action_dsp::Stencil;
use low_action_figures::Stroke;
use low_action_figures::style::colour;

/// The stencils with their lines.
pub const STENCILS: [(Stencil, Stroke); 3] = [
    (Stencil::Paper, Stroke::new(colour::ORANGE)),
    (Stencil::Corrected, Stroke::new(colour::GREEN)),
    (Stencil::Wide, Stroke::new(colour::BLUE)),
];
