//! A device: Embree's threads, memory and error channel.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::{self, NonNull};
use std::sync::Arc;

use crate::sys::{self, Api, DeviceObject};
use crate::{EmbreeError, Library};

thread_local! {
    /// The first error Embree reported on this thread since the last check.
    static REPORTED: RefCell<Option<(c_int, String)>> = const { RefCell::new(None) };
}

/// Where scenes are built. Clones share it.
#[derive(Clone)]
pub struct Device {
    pub(crate) raw: Arc<RawDevice>,
}

impl Device {
    /// Makes a device whose builds use `threads` threads; 0 means all the machine has.
    ///
    /// # Errors
    /// [`EmbreeError::Device`] if Embree does not run on this processor or was built without ray masks,
    /// [`EmbreeError::OutOfMemory`].
    pub fn new(library: &Library, threads: usize) -> Result<Self, EmbreeError> {
        let raw = RawDevice::new(Arc::clone(&library.api), threads)?;
        if raw.property(sys::DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 1 {
            let message = "this library was built without ray masks, which the visibility of objects needs";
            return Err(EmbreeError::Device { code: sys::ERROR_NONE, message: message.to_owned() });
        }
        Ok(Self { raw: Arc::new(raw) })
    }
}

/// Owner of one `RTCDevice`.
pub(crate) struct RawDevice {
    pub(crate) api: Arc<Api>,
    pub(crate) handle: NonNull<DeviceObject>,
}

// SAFETY: Embree's device functions may be called from any thread, at the same time; the handle is a counted
// reference that is not tied to the thread that made it.
unsafe impl Send for RawDevice {}
// SAFETY: as above.
unsafe impl Sync for RawDevice {}

impl RawDevice {
    /// Makes a device with its errors captured rather than printed.
    pub(crate) fn new(api: Arc<Api>, threads: usize) -> Result<Self, EmbreeError> {
        let config = CString::new(format!("threads={threads}")).expect("the text has no NUL");
        // SAFETY: `config` is a NUL-terminated string that lives through the call.
        let handle = unsafe { (api.new_device)(config.as_ptr()) };
        let Some(handle) = NonNull::new(handle) else {
            // SAFETY: a null device asks for the error of the last `rtcNewDevice` on this thread.
            let code = unsafe { (api.device_error)(ptr::null_mut()) };
            return Err(EmbreeError::from_code(code, "no device could be made on this machine".to_owned()));
        };
        // SAFETY: the handle is alive, and the callback uses no user pointer.
        unsafe { (api.set_error_function)(handle.as_ptr(), Some(record_error), ptr::null_mut()) };
        Ok(Self { api, handle })
    }

    /// A device property, 0 if Embree does not know it.
    pub(crate) fn property(&self, property: c_int) -> isize {
        // SAFETY: the handle is alive as long as `self`.
        unsafe { (self.api.device_property)(self.handle.as_ptr(), property) }
    }
}

impl Drop for RawDevice {
    fn drop(&mut self) {
        // SAFETY: this is the only owner of the reference, and it is given up once. Scenes hold references of
        // their own.
        unsafe { (self.api.release_device)(self.handle.as_ptr()) };
    }
}

/// Turns what Embree reported on this thread since the last check into an error.
///
/// Embree calls the error function on the thread that made the failing call, whichever thread the fault arose
/// on, so builds running side by side on one device cannot receive each other's errors.
pub(crate) fn check() -> Result<(), EmbreeError> {
    match REPORTED.take() {
        Some((code, message)) => Err(EmbreeError::from_code(code, message)),
        None => Ok(()),
    }
}

/// Embree's error callback: keeps the first report for [`check`].
unsafe extern "C" fn record_error(_user: *mut c_void, code: c_int, message: *const c_char) {
    let message = if message.is_null() {
        String::new()
    } else {
        // SAFETY: Embree passes a NUL-terminated string that lives through the call.
        unsafe { CStr::from_ptr(message) }.to_string_lossy().into_owned()
    };
    // A thread that is ending has no one left to tell.
    let _ = REPORTED.try_with(|reported| {
        reported.borrow_mut().get_or_insert((code, message));
    });
}
