//! Strings, boards, fingers and the solver: each file is a promise.

mod any_instructions;
mod beginnings;
mod board_parabola;
mod bridge_force;
mod dense_by_hand;
mod dense_reference;
mod exact_partials;
mod exact_solutions;
mod extremes;
mod fret_loss;
mod fret_placement;
mod hands_rest;
mod kinked_frets;
mod ledger;
mod measures;
mod model_refusals;
mod others;
mod paper_beyond;
mod paper_pluck;
mod paper_slide;
mod paper_tap;
mod passivity;
mod pluck_tone;
mod scene_body;
mod short_blows;
mod struck_strings;
