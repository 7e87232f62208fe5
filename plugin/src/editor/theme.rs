//! Colours, fonts and spacings of the editor, in one place. Everything stands on a grid of 4 points.

use egui::style::{ScrollStyle, WidgetVisuals};
use egui::{Color32, CornerRadius, FontFamily, FontId, Stroke, TextStyle, Visuals};

/// Between neighbours that belong together, points.
pub const TIGHT: f32 = 4.0;
/// Between neighbours, points.
pub const NEAR: f32 = 8.0;
/// Between parts of the window, points.
pub const GAP: f32 = 16.0;
/// Height of the header, points.
pub const HEADER: f32 = 48.0;
/// Height of the side view, points.
pub const SIDE: f32 = 148.0;
/// Height of the panels, points.
pub const PANELS: f32 = 208.0;
/// Room left of the nut for the names of the strings, and right of the saddle, points: the string views lie one under
/// the other.
pub const LEFT: f32 = 48.0;
/// See [`LEFT`].
pub const RIGHT: f32 = 32.0;
/// Radius of corners, points.
pub const ROUND: f32 = 6.0;

/// Behind everything.
pub const GROUND: Color32 = Color32::from_rgb(0x16, 0x17, 0x19);
/// Behind a view.
pub const SURFACE: Color32 = Color32::from_rgb(0x1e, 0x1f, 0x22);
/// Behind something that can be taken hold of.
pub const RAISED: Color32 = Color32::from_rgb(0x2b, 0x2d, 0x31);
/// The same under the mouse.
pub const LIFTED: Color32 = Color32::from_rgb(0x38, 0x3a, 0x40);
/// Lines between things.
pub const LINE: Color32 = Color32::from_rgb(0x3a, 0x3c, 0x41);

/// What is to be read.
pub const TEXT: Color32 = Color32::from_rgb(0xec, 0xe7, 0xdd);
/// What may be read.
pub const SOFT_TEXT: Color32 = Color32::from_rgb(0xab, 0xa5, 0x9a);
/// What stands out.
pub const ACCENT: Color32 = Color32::from_rgb(0xe3, 0xa8, 0x57);
/// What is wrong.
pub const ALARM: Color32 = Color32::from_rgb(0xe8, 0x6a, 0x4f);
/// What is well.
pub const CALM: Color32 = Color32::from_rgb(0x7f, 0xb2, 0x8a);

/// The board, towards the light and away from it.
pub const BOARD: [Color32; 2] = [Color32::from_rgb(0x35, 0x27, 0x21), Color32::from_rgb(0x24, 0x1a, 0x17)];
/// The grain of the board.
pub const GRAIN: Color32 = Color32::from_rgb(0x3e, 0x2e, 0x27);
/// What is beyond the board.
pub const BODY: [Color32; 2] = [Color32::from_rgb(0x25, 0x26, 0x2a), Color32::from_rgb(0x1b, 0x1c, 0x1f)];
/// Frets.
pub const BRASS: Color32 = Color32::from_rgb(0xc2, 0xa1, 0x62);
/// The light on frets.
pub const BRASS_LIGHT: Color32 = Color32::from_rgb(0xf0, 0xdc, 0xae);
/// Nut and dots.
pub const BONE: Color32 = Color32::from_rgb(0xd9, 0xcf, 0xb8);
/// Saddles and poles.
pub const STEEL: Color32 = Color32::from_rgb(0xa3, 0xa8, 0xae);
/// A plain string.
pub const PLAIN: Color32 = Color32::from_rgb(0xe6, 0xe4, 0xde);
/// A wound one.
pub const WOUND: Color32 = Color32::from_rgb(0xd3, 0xbf, 0x99);
/// A finger.
pub const FINGER: Color32 = Color32::from_rgb(0xd8, 0x8f, 0x6f);
/// A pluck.
pub const PLUCK: Color32 = Color32::from_rgb(0x6c, 0xc0, 0xc4);
/// A string that hits a fret.
pub const FLASH: Color32 = Color32::from_rgb(0xff, 0xe2, 0xa8);

/// Small print.
pub const SMALL: FontId = FontId::new(11.0, FontFamily::Proportional);
/// Usual print.
pub const BODY_FONT: FontId = FontId::new(13.0, FontFamily::Proportional);
/// Headings.
pub const HEADING: FontId = FontId::new(17.0, FontFamily::Proportional);

/// Gives a window these.
pub fn dress(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Small, SMALL),
            (TextStyle::Body, BODY_FONT),
            (TextStyle::Button, BODY_FONT),
            (TextStyle::Heading, HEADING),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        style.spacing.item_spacing = egui::vec2(NEAR, TIGHT);
        style.spacing.button_padding = egui::vec2(NEAR, TIGHT);
        // Seen at all times where there is more than fits, and never bright.
        style.spacing.scroll = ScrollStyle {
            dormant_handle_opacity: 0.25,
            active_handle_opacity: 0.35,
            interact_handle_opacity: 0.6,
            ..ScrollStyle::floating()
        };
        style.interaction.selectable_labels = false;
        style.visuals = visuals();
    });
}

fn visuals() -> Visuals {
    let mut visuals = Visuals::dark();
    visuals.panel_fill = GROUND;
    visuals.window_fill = SURFACE;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.extreme_bg_color = GROUND;
    visuals.faint_bg_color = SURFACE;
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.35);
    visuals.selection.stroke = Stroke::new(1.0, TEXT);
    visuals.hyperlink_color = ACCENT;
    let widget = |fill: Color32, line: Color32, text: Color32| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, line),
        corner_radius: CornerRadius::same(4),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    };
    visuals.widgets.noninteractive = widget(SURFACE, LINE, TEXT);
    visuals.widgets.inactive = widget(RAISED, RAISED, TEXT);
    visuals.widgets.hovered = widget(LIFTED, SOFT_TEXT, TEXT);
    visuals.widgets.active = widget(LIFTED, ACCENT, TEXT);
    visuals.widgets.open = widget(LIFTED, LINE, TEXT);
    visuals
}

/// How strong the veil is over what does nothing at present: it can still be read.
pub const VEIL: f32 = 0.45;

/// A colour with a part of its strength, 0 to 1.
pub fn faint(colour: Color32, part: f32) -> Color32 {
    colour.gamma_multiply(part.clamp(0.0, 1.0))
}
