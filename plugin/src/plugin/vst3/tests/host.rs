//! A host of one instance, as far as it takes one to play.

use std::cell::RefCell;
use std::io::{Cursor, Read, Seek, SeekFrom, Write};
use std::ptr::null_mut;

use nice_plug::wrapper::vst3::vst3::{ComPtr, Interface};

use super::super::*;

/// The factory, and what it says of its class.
pub fn factory() -> (ComPtr<IPluginFactory>, PClassInfo) {
    // SAFETY: it gives an interface that is ours to keep.
    let factory = unsafe { ComPtr::from_raw(GetPluginFactory().cast::<IPluginFactory>()) };
    let factory = factory.expect("there is a factory");
    // SAFETY: a class of plain numbers, of which all bits may be 0, and there is room for it.
    let class = unsafe {
        let mut class = std::mem::zeroed();
        assert_eq!(factory.getClassInfo(0, &mut class), kResultOk);
        class
    };
    (factory, class)
}

/// An instance of a class, if there is one.
pub fn made(factory: &ComPtr<IPluginFactory>, class: [u8; 16]) -> Option<ComPtr<IAudioProcessor>> {
    let (mut object, id) = (null_mut(), IAudioProcessor::IID);
    // SAFETY: both identifiers have 16 bytes, and there is room for a pointer.
    let said = unsafe { factory.createInstance(class.as_ptr().cast(), id.as_ptr().cast(), &mut object) };
    assert!((said == kResultOk) != object.is_null());
    // SAFETY: it is what was asked for, or null.
    unsafe { ComPtr::from_raw(object.cast::<IAudioProcessor>()) }
}

/// Why a call has nothing to play into.
#[derive(Debug, Clone, Copy)]
pub enum Silence {
    Samples,
    Outputs,
    Memory,
    Addresses,
}

/// Events of one call.
struct Events(Vec<Event>);

impl Class for Events {
    type Interfaces = (IEventList,);
}

impl IEventListTrait for Events {
    unsafe fn getEventCount(&self) -> int32 {
        self.0.len() as int32
    }

    unsafe fn getEvent(&self, index: int32, event: *mut Event) -> tresult {
        // SAFETY: there is room for an event.
        unsafe { event.write(self.0[index as usize]) };
        kResultOk
    }

    unsafe fn addEvent(&self, _: *mut Event) -> tresult {
        kResultFalse
    }
}

/// A change of one parameter.
struct Change(ParamID, int32, ParamValue);

impl Class for Change {
    type Interfaces = (IParamValueQueue,);
}

impl IParamValueQueueTrait for Change {
    unsafe fn getParameterId(&self) -> ParamID {
        self.0
    }

    unsafe fn getPointCount(&self) -> int32 {
        1
    }

    unsafe fn getPoint(&self, _: int32, offset: *mut int32, value: *mut ParamValue) -> tresult {
        // SAFETY: there is room for both.
        unsafe {
            offset.write(self.1);
            value.write(self.2);
        }
        kResultOk
    }

    unsafe fn addPoint(&self, _: int32, _: ParamValue, _: *mut int32) -> tresult {
        kResultFalse
    }
}

/// Changes of one call.
struct Changes(Vec<ComPtr<IParamValueQueue>>);

impl Class for Changes {
    type Interfaces = (IParameterChanges,);
}

impl IParameterChangesTrait for Changes {
    unsafe fn getParameterCount(&self) -> int32 {
        self.0.len() as int32
    }

    unsafe fn getParameterData(&self, index: int32) -> *mut IParamValueQueue {
        self.0[index as usize].as_ptr()
    }

    unsafe fn addParameterData(&self, _: *const ParamID, _: *mut int32) -> *mut IParamValueQueue {
        null_mut()
    }
}

/// What a session has saved, or is to save.
struct Stream(RefCell<Cursor<Vec<u8>>>);

impl Class for Stream {
    type Interfaces = (IBStream,);
}

impl IBStreamTrait for Stream {
    unsafe fn read(&self, buffer: *mut c_void, size: int32, read: *mut int32) -> tresult {
        // SAFETY: there is room for as many bytes, and for their number if it is asked for.
        unsafe {
            let buffer = std::slice::from_raw_parts_mut(buffer.cast::<u8>(), size as usize);
            let count = self.0.borrow_mut().read(buffer).expect("there is nothing to fail");
            read.as_mut().into_iter().for_each(|read| *read = count as int32);
        }
        kResultOk
    }

    unsafe fn write(&self, buffer: *mut c_void, size: int32, written: *mut int32) -> tresult {
        // SAFETY: there are as many bytes, and room for their number if it is asked for.
        unsafe {
            let buffer = std::slice::from_raw_parts(buffer.cast::<u8>(), size as usize);
            self.0.borrow_mut().write_all(buffer).expect("there is room");
            written.as_mut().into_iter().for_each(|written| *written = size);
        }
        kResultOk
    }

    unsafe fn seek(&self, place: int64, mode: int32, result: *mut int64) -> tresult {
        let from = match mode {
            0 => SeekFrom::Start(place as u64),
            1 => SeekFrom::Current(place),
            _ => SeekFrom::End(place),
        };
        let reached = self.0.borrow_mut().seek(from).expect("the place is there");
        // SAFETY: there is room for it if it is asked for.
        unsafe { result.as_mut() }.into_iter().for_each(|result| *result = reached as int64);
        kResultOk
    }

    unsafe fn tell(&self, place: *mut int64) -> tresult {
        // SAFETY: there is room for it.
        unsafe { place.write(self.0.borrow().position() as int64) };
        kResultOk
    }
}

/// The one interface of an object of ours.
fn pointer<C: Class + 'static, I: Interface>(object: C) -> ComPtr<I>
where
    C::Interfaces: nice_plug::wrapper::vst3::vst3::com_scrape_types::MakeHeader<C, ComWrapper<C>>,
{
    ComWrapper::new(object).to_com_ptr().expect("it has that interface")
}

/// One instance that renders offline, so that it sounds the same every time.
pub struct Host {
    processor: ComPtr<IAudioProcessor>,
}

impl Host {
    pub fn new() -> Self {
        let (factory, class) = factory();
        let processor = made(&factory, class.cid.map(|byte| byte as u8)).expect("it is made");
        let host = Self { processor };
        let mut setup = ProcessSetup {
            processMode: ProcessModes_::kOffline as int32,
            symbolicSampleSize: SymbolicSampleSizes_::kSample32 as int32,
            maxSamplesPerBlock: 65_536,
            sampleRate: 48e3,
        };
        // SAFETY: as hosts do, in their order.
        unsafe {
            assert_eq!(host.part::<IPluginBase>().initialize(null_mut()), kResultOk);
            assert_eq!(host.processor.setupProcessing(&mut setup), kResultOk);
            assert_eq!(host.part::<IComponent>().setActive(1), kResultOk);
            assert_eq!(host.processor.setProcessing(1), kResultOk);
        }
        host
    }

    fn part<I: Interface>(&self) -> ComPtr<I> {
        self.processor.cast().expect("it has that interface")
    }

    /// A call, with changes and events.
    fn call(
        &self,
        samples: usize,
        bus: Option<&mut AudioBusBuffers>,
        changes: &[(ParamID, f64)],
        events: &[Event],
    ) {
        let change = |&(id, value): &(ParamID, f64)| pointer(Change(id, 0, value));
        let changes: ComPtr<IParameterChanges> = pointer(Changes(changes.iter().map(change).collect()));
        let events: ComPtr<IEventList> = pointer(Events(events.to_vec()));
        let mut data = ProcessData {
            processMode: ProcessModes_::kOffline as int32,
            symbolicSampleSize: SymbolicSampleSizes_::kSample32 as int32,
            numSamples: samples as int32,
            numInputs: 0,
            numOutputs: int32::from(bus.is_some()),
            inputs: null_mut(),
            outputs: bus.map_or(null_mut(), |bus| bus),
            inputParameterChanges: changes.as_ptr(),
            outputParameterChanges: null_mut(),
            inputEvents: events.as_ptr(),
            outputEvents: null_mut(),
            processContext: null_mut(),
        };
        // SAFETY: all that is pointed to lives until it returns.
        assert_eq!(unsafe { self.processor.process(&mut data) }, kResultOk);
    }

    /// Plays so many samples; the left channel.
    pub fn play(&self, samples: usize, changes: &[(ParamID, f64)], events: &[Event]) -> Vec<f32> {
        let [left, _] = self.play_into(samples, changes, events);
        left
    }

    /// The same into so many channels; all of them.
    pub fn play_into<const N: usize>(
        &self,
        samples: usize,
        changes: &[(ParamID, f64)],
        events: &[Event],
    ) -> [Vec<f32>; N] {
        let mut sound = [0; N].map(|_| vec![f32::NAN; samples]);
        let mut channels = sound.each_mut().map(|channel| channel.as_mut_ptr());
        let memory = AudioBusBuffers__type0 { channelBuffers32: channels.as_mut_ptr() };
        let mut bus = AudioBusBuffers { numChannels: N as int32, silenceFlags: 0, __field0: memory };
        self.call(samples, Some(&mut bus), changes, events);
        sound
    }

    /// Tells it of changes and events without having anything played.
    pub fn flush(&self, silence: Silence, changes: &[(ParamID, f64)], events: &[Event]) {
        let mut nowhere = [null_mut(); 2];
        let channels = match silence {
            Silence::Addresses => nowhere.as_mut_ptr(),
            _ => null_mut(),
        };
        let memory = AudioBusBuffers__type0 { channelBuffers32: channels };
        let mut bus = AudioBusBuffers { numChannels: 2, silenceFlags: 0, __field0: memory };
        match silence {
            Silence::Samples => self.call(0, None, changes, events),
            Silence::Outputs => self.call(512, None, changes, events),
            Silence::Memory | Silence::Addresses => self.call(512, Some(&mut bus), changes, events),
        }
    }

    /// A controller of a channel at a value from 0 to 1.
    pub fn controller(&self, channel: i16, number: i16, value: f64) -> (ParamID, f64) {
        let mut id = 0;
        // SAFETY: there is room for a number.
        let said =
            unsafe { self.part::<IMidiMapping>().getMidiControllerAssignment(0, channel, number, &mut id) };
        assert_eq!(said, kResultOk);
        (id, value)
    }

    /// A parameter, by its name, at a value from 0 to 1.
    pub fn parameter(&self, name: &str, value: f64) -> (ParamID, f64) {
        let controller = self.part::<IEditController>();
        // SAFETY: there is room for each, of plain numbers.
        let id = unsafe {
            (0..controller.getParameterCount()).find_map(|index| {
                let mut info: ParameterInfo = std::mem::zeroed();
                assert_eq!(controller.getParameterInfo(index, &mut info), kResultOk);
                let title = info.title.iter().copied().take_while(|&unit| unit != 0);
                (String::from_utf16_lossy(&title.collect::<Vec<_>>()) == name).then_some(info.id)
            })
        };
        (id.expect("there is one of that name"), value)
    }

    /// For how long it says that it may ring on, samples.
    pub fn tail(&self) -> u32 {
        // SAFETY: nothing is asked for but a number.
        unsafe { self.processor.getTailSamples() }
    }

    /// All parameters that are hidden, and what they usually are.
    pub fn hidden(&self) -> Vec<(ParamID, f64)> {
        let controller = self.part::<IEditController>();
        // SAFETY: there is room for each, of plain numbers.
        unsafe {
            let count = controller.getParameterCount();
            let mut info: ParameterInfo = std::mem::zeroed();
            assert_eq!(controller.getParameterInfo(count, &mut info), kInvalidArgument, "there is one more");
            let all = (0..count).filter_map(|index| {
                assert_eq!(controller.getParameterInfo(index, &mut info), kResultOk);
                (info.flags & (1 << 4) != 0).then_some((info.id, info.defaultNormalizedValue))
            });
            all.collect()
        }
    }

    /// What a session would save.
    pub fn save(&self) -> Vec<u8> {
        let stream = ComWrapper::new(Stream(RefCell::default()));
        let interface = stream.to_com_ptr::<IBStream>().expect("it has that interface");
        // SAFETY: it lives until this returns.
        assert_eq!(unsafe { self.part::<IComponent>().getState(interface.as_ptr()) }, kResultOk);
        stream.0.borrow().get_ref().clone()
    }

    /// Loads it again; whether the plugin took it.
    pub fn load(&self, saved: &[u8]) -> bool {
        let stream: ComPtr<IBStream> = pointer(Stream(RefCell::new(Cursor::new(saved.to_vec()))));
        // SAFETY: as above.
        unsafe { self.part::<IComponent>().setState(stream.as_ptr()) == kResultOk }
    }

    /// What a parameter stands at.
    pub fn value(&self, id: ParamID) -> f64 {
        // SAFETY: nothing is asked for but a number.
        unsafe { self.part::<IEditController>().getParamNormalized(id) }
    }
}

/// The wheel of a channel, in the steps of MIDI.
pub fn bend(host: &Host, channel: i16, steps: u16) -> (ParamID, f64) {
    host.controller(channel, 129, f64::from(steps) / 16383.0)
}

fn event(kind: Event_::EventTypes, data: Event__type0) -> Event {
    Event { busIndex: 0, sampleOffset: 0, ppqPosition: 0.0, flags: 0, r#type: kind as uint16, __field0: data }
}

/// A key goes down.
pub fn on(channel: i16, id: i32, key: i16) -> Event {
    let note = NoteOnEvent { channel, pitch: key, tuning: 0.0, velocity: 0.7, length: 0, noteId: id };
    event(Event_::EventTypes_::kNoteOnEvent, Event__type0 { noteOn: note })
}

/// A key goes up.
pub fn off(channel: i16, id: i32, key: i16) -> Event {
    let note = NoteOffEvent { channel, pitch: key, velocity: 0.0, noteId: id, tuning: 0.0 };
    event(Event_::EventTypes_::kNoteOffEvent, Event__type0 { noteOff: note })
}

/// What is said of one note.
pub fn expression(id: i32, kind: u32, value: f64) -> Event {
    let said = NoteExpressionValueEvent { typeId: kind, noteId: id, value };
    event(Event_::EventTypes_::kNoteExpressionValueEvent, Event__type0 { noteExpressionValue: said })
}
