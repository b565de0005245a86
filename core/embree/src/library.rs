//! Opening the shared library and making sure that it is an Embree this crate understands.

use std::path::Path;
use std::sync::Arc;

use crate::EmbreeError;
use crate::device::RawDevice;
use crate::sys::{self, Api};

/// An Embree library opened at run time. Clones share it.
///
/// It stays in the process until the end: Embree's build threads outlive every handle, and unloading their
/// code under them would crash. Opening the same file again costs nothing.
#[derive(Clone)]
pub struct Library {
    pub(crate) api: Arc<Api>,
    version: (u32, u32, u32),
}

impl Library {
    /// Opens the Embree shared library at `path` (`.so`, `.dylib` or `.dll`); its TBB is looked for beside it.
    ///
    /// Opening a library runs its code, so `path` must be one the user trusts, and it must have been built for
    /// one level of instances, which is Embree's default: a hit has no room for more.
    ///
    /// # Errors
    /// [`EmbreeError::Missing`] if the system cannot open the file, [`EmbreeError::NotEmbree`] if it is
    /// something else, [`EmbreeError::WrongVersion`] if it is not Embree 4.3 or a later 4.x.
    pub fn open(path: &Path) -> Result<Self, EmbreeError> {
        let opened =
            open_file(path).map_err(|cause| EmbreeError::Missing { path: path.to_owned(), cause })?;
        let api =
            Api::load(&opened).map_err(|symbol| EmbreeError::NotEmbree { path: path.to_owned(), symbol })?;
        std::mem::forget(opened);
        let api = Arc::new(api);
        let version = read_version(&api)?;
        if version.0 != 4 || version.1 < 3 {
            return Err(EmbreeError::WrongVersion { path: path.to_owned(), found: version });
        }
        Ok(Self { api, version })
    }

    /// Major, minor and patch number the library reports.
    pub fn version(&self) -> (u32, u32, u32) {
        self.version
    }
}

/// Asks a device made for the occasion: Embree has no other way to tell its version.
fn read_version(api: &Arc<Api>) -> Result<(u32, u32, u32), EmbreeError> {
    let device = RawDevice::new(Arc::clone(api), 1)?;
    let number = |property| u32::try_from(device.property(property)).unwrap_or(0);
    Ok((
        number(sys::DEVICE_PROPERTY_VERSION_MAJOR),
        number(sys::DEVICE_PROPERTY_VERSION_MINOR),
        number(sys::DEVICE_PROPERTY_VERSION_PATCH),
    ))
}

/// Blender's process has its own Embree and TBB in the global scope. `RTLD_LOCAL` keeps ours out of it, and
/// `RTLD_DEEPBIND` makes ours call itself and its own TBB rather than theirs.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn open_file(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::unix;
    /// From glibc's `dlfcn.h`.
    const RTLD_DEEPBIND: std::ffi::c_int = 0x8;
    let flags = unix::RTLD_NOW | unix::RTLD_LOCAL | RTLD_DEEPBIND;
    // SAFETY: opening runs the library's initializers. The caller names a file installed with the add-on;
    // Embree's and TBB's initializers may run on any thread at any time.
    unsafe { unix::Library::open(Some(path), flags) }.map(Into::into)
}

/// Windows finds the TBB beside Embree only if told to look there, which in turn needs an absolute path.
#[cfg(windows)]
fn open_file(path: &Path) -> Result<libloading::Library, libloading::Error> {
    use libloading::os::windows;
    let flags = windows::LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR | windows::LOAD_LIBRARY_SEARCH_DEFAULT_DIRS;
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    // SAFETY: opening runs the library's initializers. The caller names a file installed with the add-on;
    // Embree's and TBB's initializers may run on any thread at any time.
    unsafe { windows::Library::load_with_flags(absolute, flags) }.map(Into::into)
}

/// Elsewhere the platform's default is right: symbols are local, and bound to the library they were linked
/// with.
#[cfg(not(any(windows, all(target_os = "linux", target_env = "gnu"))))]
fn open_file(path: &Path) -> Result<libloading::Library, libloading::Error> {
    // SAFETY: opening runs the library's initializers. The caller names a file installed with the add-on;
    // Embree's and TBB's initializers may run on any thread at any time.
    unsafe { libloading::Library::new(path) }
}
