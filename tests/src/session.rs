//! Saved states of the plugin, to look into and to change.

use serde_json::Value;

/// A saved state, which is the length of a text and the text.
pub fn packed(state: &Value) -> Vec<u8> {
    let text = state.to_string();
    let mut bytes = (text.len() as u64).to_le_bytes().to_vec();
    bytes.extend(text.bytes());
    bytes
}

/// What a saved state says.
pub fn unpacked(bytes: &[u8]) -> Value {
    serde_json::from_slice(&bytes[8..]).expect("states are saved as JSON")
}
