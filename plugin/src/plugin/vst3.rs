//! The VST3 plugin: that of the framework, with what it gets wrong put right.
//!
//! nice-plug 0.4.2 takes what a host says of its mode (real time or offline) for what it said the time before: the first
//! bounce would be played as if live, and what is played after it would wait for coefficients on the audio thread. And it has the
//! note expressions "expression" and "brightness" the wrong way round. And where a call has nothing to play into, it loses the
//! call's notes; where the memory it has to play into is nowhere, it follows the address. So hosts are given a class of our own, in
//! which the framework's is told everything twice that it takes late, what it loses waits ([`Waiting`](super::waiting::Waiting)), it plays only into what is
//! there (`outputs`), hosts are told of a state that is refused and of the tail before anything sounds, and events pass [`mended`]. (`cargo xtask hosts` plays the first two.)

mod heard;
mod outputs;
#[cfg(test)]
mod tests;

use std::ffi::c_void;
use std::sync::Arc;

use nice_plug::prelude::*;
use nice_plug::wrapper::setup_logger;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::ChannelContext::{IInfoListener, IInfoListenerTrait};
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::{CString, *};
use nice_plug::wrapper::vst3::vst3::Steinberg::*;
use nice_plug::wrapper::vst3::vst3::{Class, ComWrapper};
use nice_plug::wrapper::vst3::{PluginInfo, Wrapper};

use super::LowAction;
use super::door::Door;
use super::state::taken_in;
use crate::engine::Engine;
use heard::Hidden;

/// An event as the host meant it.
pub(super) fn mended(event: NoteEvent<()>) -> NoteEvent<()> {
    match event {
        NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness: expression } => {
            NoteEvent::PolyExpression { timing, voice_id, channel, key, expression }
        }
        NoteEvent::PolyExpression { timing, voice_id, channel, key, expression: brightness } => {
            NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness }
        }
        event => event,
    }
}

/// The plugin as hosts see it.
struct Instance {
    framework: Wrapper<LowAction>,
    /// What it shares with the plugin in that.
    door: Arc<Door>,
    hidden: Hidden,
}

impl Instance {
    fn new() -> Self {
        let (framework, door) = Door::shared_with(Wrapper::new);
        let hidden = Hidden::of(&framework);
        Self { framework, door, hidden }
    }
}

impl Class for Instance {
    type Interfaces = (
        IComponent,
        IEditController,
        IAudioProcessor,
        IMidiMapping,
        INoteExpressionController,
        IProcessContextRequirements,
        IUnitInfo,
        IInfoListener,
    );
}

/// Methods that are the framework's.
macro_rules! passed_on {
    ($of:ident { $($name:ident($($given:ident: $what:ty),*) -> $answer:ty;)* }) => {
        $(unsafe fn $name(&self, $($given: $what),*) -> $answer {
            // SAFETY: what the host promises is what the framework asks for.
            unsafe { $of::$name(&self.framework, $($given),*) }
        })*
    };
}

impl IPluginBaseTrait for Instance {
    passed_on! { IPluginBaseTrait {
        initialize(context: *mut FUnknown) -> tresult;
        terminate() -> tresult;
    } }
}

impl IComponentTrait for Instance {
    passed_on! { IComponentTrait {
        getControllerClassId(class: *mut TUID) -> tresult;
        setIoMode(mode: IoMode) -> tresult;
        getBusCount(media: MediaType, way: BusDirection) -> int32;
        getBusInfo(media: MediaType, way: BusDirection, index: int32, bus: *mut BusInfo) -> tresult;
        getRoutingInfo(into: *mut RoutingInfo, out: *mut RoutingInfo) -> tresult;
        activateBus(media: MediaType, way: BusDirection, index: int32, state: TBool) -> tresult;
        setActive(state: TBool) -> tresult;
        getState(state: *mut IBStream) -> tresult;
    } }

    unsafe fn setState(&self, state: *mut IBStream) -> tresult {
        // SAFETY: what the host promises is what the framework asks for.
        let (said, taken) = taken_in(|| unsafe { IComponentTrait::setState(&self.framework, state) });
        if said == kResultOk && !taken { kResultFalse } else { said }
    }
}

impl IEditControllerTrait for Instance {
    passed_on! { IEditControllerTrait {
        setComponentState(state: *mut IBStream) -> tresult;
        setState(state: *mut IBStream) -> tresult;
        getState(state: *mut IBStream) -> tresult;
        getParameterCount() -> int32;
        getParamStringByValue(id: ParamID, value: ParamValue, text: *mut String128) -> tresult;
        getParamValueByString(id: ParamID, text: *mut TChar, value: *mut ParamValue) -> tresult;
        normalizedParamToPlain(id: ParamID, value: ParamValue) -> ParamValue;
        plainParamToNormalized(id: ParamID, value: ParamValue) -> ParamValue;
        setParamNormalized(id: ParamID, value: ParamValue) -> tresult;
        setComponentHandler(handler: *mut IComponentHandler) -> tresult;
        createView(name: FIDString) -> *mut IPlugView;
    } }

    unsafe fn getParameterInfo(&self, index: int32, info: *mut ParameterInfo) -> tresult {
        // The framework has every hidden one usually at 0, whatever it stands for, and at 0.5 now; and one more than there are.
        // SAFETY: the host gives room for it, if any.
        unsafe {
            if index >= self.framework.getParameterCount() {
                return kInvalidArgument;
            }
            let said = self.framework.getParameterInfo(index, info);
            if let Some(info) = info.as_mut().filter(|_| said == kResultOk)
                && let Some(usual) = self.hidden.usual(info.id)
            {
                info.defaultNormalizedValue = usual;
            }
            said
        }
    }

    unsafe fn getParamNormalized(&self, id: ParamID) -> ParamValue {
        // SAFETY: nothing is asked for but a number.
        self.hidden.usual(id).unwrap_or_else(|| unsafe { self.framework.getParamNormalized(id) })
    }
}

impl IAudioProcessorTrait for Instance {
    passed_on! { IAudioProcessorTrait {
        setBusArrangements(
            inputs: *mut SpeakerArrangement,
            of_inputs: int32,
            outputs: *mut SpeakerArrangement,
            of_outputs: int32
        ) -> tresult;
        getBusArrangement(way: BusDirection, index: int32, arrangement: *mut SpeakerArrangement) -> tresult;
        canProcessSampleSize(size: int32) -> tresult;
        setProcessing(state: TBool) -> tresult;
    } }

    unsafe fn getLatencySamples(&self) -> uint32 {
        // The framework knows of none until somebody tells it, and then asks for a restart.
        Engine::LATENCY
    }

    unsafe fn getTailSamples(&self) -> uint32 {
        // The framework knows of one only while something sounds.
        // SAFETY: nothing is asked for but a number.
        self.door.tail(unsafe { self.framework.getTailSamples() })
    }

    unsafe fn setupProcessing(&self, setup: *mut ProcessSetup) -> tresult {
        // The first time its mode is remembered, the second time it is used.
        // SAFETY: what the host promises is what the framework asks for, and it keeps nothing of the pointer.
        unsafe {
            let said = self.framework.setupProcessing(setup);
            if said == kResultOk { self.framework.setupProcessing(setup) } else { said }
        }
    }

    unsafe fn process(&self, data: *mut ProcessData) -> tresult {
        // SAFETY: what the host promises is what the framework asks for, and what it has sent stays until this returns.
        unsafe {
            let Some(data) = data.as_ref() else { return kInvalidArgument };
            self.door.waiting.begin_call();
            let said = outputs::within(data, |data| self.framework.process(data));
            self.door.waiting.end_call(|keep| heard::each(data, self.hidden, keep));
            said
        }
    }
}

impl IMidiMappingTrait for Instance {
    passed_on! { IMidiMappingTrait {
        getMidiControllerAssignment(bus: int32, channel: int16, number: CtrlNumber, id: *mut ParamID) -> tresult;
    } }
}

impl INoteExpressionControllerTrait for Instance {
    passed_on! { INoteExpressionControllerTrait {
        getNoteExpressionCount(bus: int32, channel: int16) -> int32;
        getNoteExpressionInfo(bus: int32, channel: int16, index: int32, info: *mut NoteExpressionTypeInfo) -> tresult;
        getNoteExpressionStringByValue(
            bus: int32,
            channel: int16,
            id: NoteExpressionTypeID,
            value: NoteExpressionValue,
            text: *mut String128
        ) -> tresult;
        getNoteExpressionValueByString(
            bus: int32,
            channel: int16,
            id: NoteExpressionTypeID,
            text: *const TChar,
            value: *mut NoteExpressionValue
        ) -> tresult;
    } }
}

impl IProcessContextRequirementsTrait for Instance {
    passed_on! { IProcessContextRequirementsTrait {
        getProcessContextRequirements() -> uint32;
    } }
}

impl IUnitInfoTrait for Instance {
    passed_on! { IUnitInfoTrait {
        getUnitCount() -> int32;
        getUnitInfo(index: int32, info: *mut UnitInfo) -> tresult;
        getProgramListCount() -> int32;
        getProgramListInfo(index: int32, info: *mut ProgramListInfo) -> tresult;
        getProgramName(list: ProgramListID, program: int32, name: *mut String128) -> tresult;
        getProgramInfo(list: ProgramListID, program: int32, id: CString, value: *mut String128) -> tresult;
        hasProgramPitchNames(list: ProgramListID, program: int32) -> tresult;
        getProgramPitchName(list: ProgramListID, program: int32, pitch: int16, name: *mut String128) -> tresult;
        getSelectedUnit() -> UnitID;
        selectUnit(id: UnitID) -> tresult;
        getUnitByBus(media: MediaType, way: BusDirection, bus: int32, channel: int32, id: *mut UnitID) -> tresult;
        setUnitProgramData(list_or_unit: int32, program: int32, data: *mut IBStream) -> tresult;
    } }
}

impl IInfoListenerTrait for Instance {
    passed_on! { IInfoListenerTrait {
        setChannelContextInfos(list: *mut IAttributeList) -> tresult;
    } }
}

/// What makes instances, and says what they are.
struct Factory(PluginInfo);

impl Class for Factory {
    type Interfaces = (IPluginFactory, IPluginFactory2, IPluginFactory3);
}

impl Factory {
    /// Says what the one class there is is like.
    ///
    /// # Safety
    /// `info` must be null or have room for it.
    unsafe fn tell<T>(&self, index: int32, info: *mut T, words: fn(&PluginInfo) -> T) -> tresult {
        if index != 0 || info.is_null() {
            return kInvalidArgument;
        }
        // SAFETY: it has room.
        unsafe { info.write(words(&self.0)) };
        kResultOk
    }
}

impl IPluginFactoryTrait for Factory {
    unsafe fn getFactoryInfo(&self, info: *mut PFactoryInfo) -> tresult {
        // SAFETY: the host gives room for it.
        unsafe { self.tell(0, info, PluginInfo::create_factory_info) }
    }

    unsafe fn countClasses(&self) -> int32 {
        1
    }

    unsafe fn getClassInfo(&self, index: int32, info: *mut PClassInfo) -> tresult {
        // SAFETY: the host gives room for it.
        unsafe { self.tell(index, info, PluginInfo::create_class_info) }
    }

    unsafe fn createInstance(
        &self,
        class: FIDString,
        interface: FIDString,
        object: *mut *mut c_void,
    ) -> tresult {
        if class.is_null() || interface.is_null() || object.is_null() {
            return kInvalidArgument;
        }
        // SAFETY: identifiers of classes have 16 bytes.
        if unsafe { *class.cast::<[u8; 16]>() } != *self.0.cid {
            return kInvalidArgument;
        }
        let Some(unknown) = ComWrapper::new(Instance::new()).to_com_ptr::<FUnknown>() else {
            return kInternalError;
        };
        let unknown = unknown.as_ptr();
        // SAFETY: it is an object of ours, which lives as long as `unknown`; the host gives an identifier and room for a pointer.
        unsafe { ((*(*unknown).vtbl).queryInterface)(unknown, interface.cast(), object) }
    }
}

impl IPluginFactory2Trait for Factory {
    unsafe fn getClassInfo2(&self, index: int32, info: *mut PClassInfo2) -> tresult {
        // SAFETY: the host gives room for it.
        unsafe { self.tell(index, info, PluginInfo::create_class_info_2) }
    }
}

impl IPluginFactory3Trait for Factory {
    unsafe fn getClassInfoUnicode(&self, index: int32, info: *mut PClassInfoW) -> tresult {
        // SAFETY: the host gives room for it.
        unsafe { self.tell(index, info, PluginInfo::create_class_info_unicode) }
    }

    unsafe fn setHostContext(&self, _: *mut FUnknown) -> tresult {
        kResultOk
    }
}

/// Where hosts begin.
#[unsafe(no_mangle)]
extern "system" fn GetPluginFactory() -> *mut c_void {
    let factory = ComWrapper::new(Factory(PluginInfo::for_plugin::<LowAction>()));
    factory.to_com_ptr::<IPluginFactory>().map_or(std::ptr::null_mut(), |factory| factory.into_raw().cast())
}

// Each system has hosts say by its own names that the library has been loaded and will be let go of.

#[cfg(all(unix, not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleEntry(_: *mut c_void) -> bool {
    setup_logger::<LowAction>();
    true
}

#[cfg(all(unix, not(target_os = "macos")))]
#[unsafe(no_mangle)]
extern "C" fn ModuleExit() -> bool {
    true
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleEntry(_: *mut c_void) -> bool {
    setup_logger::<LowAction>();
    true
}

#[cfg(target_os = "macos")]
#[unsafe(no_mangle)]
extern "C" fn bundleExit() -> bool {
    true
}

#[cfg(windows)]
#[unsafe(no_mangle)]
extern "system" fn InitDll() -> bool {
    setup_logger::<LowAction>();
    true
}

#[cfg(windows)]
#[unsafe(no_mangle)]
extern "system" fn ExitDll() -> bool {
    true
}
