//! A host that does what it is told by an editor, and writes it down.

use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex};

use low_action::params::LowActionParams;
use nice_plug::context::PluginApi;
use nice_plug::context::gui::GuiContextInner;
use nice_plug::params::internals::ParamPtr;
use nice_plug::plugin::ParamValue;
use nice_plug::prelude::{Param, Params, PluginState};

/// What a host is told.
#[derive(Debug, Clone, PartialEq)]
pub enum Told {
    /// A gesture begins on a parameter.
    Begin(String),
    /// The parameter is set, 0 to 1.
    Set(String, f32),
    /// The gesture ends.
    End(String),
}

/// Whether a host was told of one whole gesture on a parameter, and nothing else.
pub fn is_gesture(told: &[Told], id: &str) -> bool {
    let [Told::Begin(begun), inside @ .., Told::End(ended)] = told else { return false };
    let is_set = |told: &Told| matches!(told, Told::Set(set, _) if set == id);
    begun == id && ended == id && !inside.is_empty() && inside.iter().all(is_set)
}

/// A host that sets what it is told at once, or, if it is late, when it is asked to.
pub struct Recorder {
    params: Arc<LowActionParams>,
    api: PluginApi,
    names: HashMap<ParamPtr, String>,
    told: Mutex<Vec<Told>>,
    /// What it has yet to set, if it is late.
    waiting: Mutex<Option<Vec<(ParamPtr, f32)>>>,
}

impl Recorder {
    /// A host of these parameters.
    pub fn new(params: Arc<LowActionParams>, api: PluginApi) -> Self {
        let names = params.param_map().into_iter().map(|(id, param, _)| (param, id)).collect();
        Self { params, api, names, told: Mutex::default(), waiting: Mutex::default() }
    }

    /// All that it was told since this was last asked.
    pub fn take(&self) -> Vec<Told> {
        std::mem::take(&mut *self.told.lock().expect("nobody panicked"))
    }

    /// From now on it sets nothing before it is asked to, as hosts set nothing before the end of a block.
    pub fn be_late(&self) {
        self.waiting.lock().expect("nobody panicked").get_or_insert_default();
    }

    /// Sets what waits.
    pub fn catch_up(&self) {
        let mut waiting = self.waiting.lock().expect("nobody panicked");
        for (param, value) in waiting.iter_mut().flat_map(|waiting| waiting.drain(..)) {
            // SAFETY: the pointer leads into the parameters, which this host keeps.
            unsafe { param._internal_set_normalized_value(value) };
        }
    }

    fn name(&self, param: ParamPtr) -> String {
        self.names.get(&param).expect("a parameter of the plugin's").clone()
    }

    fn write(&self, told: Told) {
        self.told.lock().expect("nobody panicked").push(told);
    }
}

impl GuiContextInner for Recorder {
    fn plugin_api(&self) -> PluginApi {
        self.api
    }

    unsafe fn raw_begin_set_parameter(&self, param: ParamPtr) {
        self.write(Told::Begin(self.name(param)));
    }

    unsafe fn raw_set_parameter_normalized(&self, param: ParamPtr, normalized: f32) {
        self.write(Told::Set(self.name(param), normalized));
        if let Some(waiting) = &mut *self.waiting.lock().expect("nobody panicked") {
            waiting.push((param, normalized));
            return;
        }
        // SAFETY: the pointer leads into the parameters, which this host keeps.
        unsafe { param._internal_set_normalized_value(normalized) };
    }

    unsafe fn raw_end_set_parameter(&self, param: ParamPtr) {
        self.write(Told::End(self.name(param)));
    }

    fn get_state(&self) -> PluginState {
        let value = |param: &ParamPtr| {
            // SAFETY: the pointers lead into the parameters, which this host keeps.
            unsafe {
                match *param {
                    ParamPtr::FloatParam(param) => ParamValue::F32((*param).unmodulated_plain_value()),
                    ParamPtr::IntParam(param) => ParamValue::I32((*param).unmodulated_plain_value()),
                    ParamPtr::BoolParam(param) => ParamValue::Bool((*param).unmodulated_plain_value()),
                    ParamPtr::EnumParam(param) => match (*param).unmodulated_plain_id() {
                        Some(id) => ParamValue::String(id.to_owned()),
                        None => ParamValue::I32((*param).unmodulated_plain_value()),
                    },
                }
            }
        };
        let params: BTreeMap<_, _> =
            self.names.iter().map(|(param, name)| (name.clone(), value(param))).collect();
        PluginState { version: String::new(), params, fields: self.params.serialize_fields() }
    }

    fn set_state(&self, state: PluginState) {
        for (param, name) in &self.names {
            let Some(value) = state.params.get(name) else { continue };
            let plain = match value {
                ParamValue::F32(value) => *value,
                ParamValue::I32(value) => *value as f32,
                ParamValue::Bool(value) => f32::from(u8::from(*value)),
                ParamValue::String(id) => {
                    let ParamPtr::EnumParam(param) = param else { panic!("{name} cannot be {id:?}") };
                    // SAFETY: the pointer leads into the parameters, which this host keeps.
                    unsafe { (**param).set_from_id(id) };
                    continue;
                }
            };
            // SAFETY: as above.
            unsafe { param._internal_set_normalized_value(param.preview_normalized(plain)) };
        }
        self.params.deserialize_fields(&state.fields);
    }

    fn request_restart(&self) {}
}
