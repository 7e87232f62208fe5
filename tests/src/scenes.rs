//! Scenes that more than one test computes.

/// Two strings of different grids, board and frets, fingers out of order, moving and pressed.
pub const PLUCKED_AND_TAPPED: &str = r#"
sample_rate = 44100
duration = 0.02
[[string]]
length = 0.65
linear_density = 5.25e-3
tension = 60.0
youngs_modulus = 2e11
core_radius = 4.3e-4
loss_0 = 1.38
loss_1 = 1.25e-4
tension_modulation = true
[[string]]
length = 0.6
linear_density = 1e-3
tension = [[0.0, 60.0], [0.02, 62.0]]
loss_0 = 1.0
[fretboard]
stiffness = 1e12
exponent = 2.3
board = -0.0022
frets = [0.1, 0.2, 0.3]
fret_top = -0.0008
[[pluck]]
string = 1
duration = 0.002
position = 0.5
force = -3.0
[[finger]]
string = 2
mass = 5e-3
stiffness = 1e8
exponent = 2.0
damping = 2.0
hand_damping = 8.0
position = [[0.0, 0.15], [0.02, 0.18]]
height = 0.0001
force = 6.0
[[finger]]
string = 1
mass = 5e-3
stiffness = 1e8
exponent = 2.0
position = 0.25
height = 0.0005
velocity = -2.0
[output]
position = 0.55
"#;
