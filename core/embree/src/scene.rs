//! Building a scene: triangles and instances go in, a committed scene comes out.

use std::any::Any;
use std::collections::HashSet;
use std::ffi::{c_int, c_void};
use std::panic::{self, AssertUnwindSafe};
use std::ptr::{self, NonNull};
use std::sync::{Arc, Mutex, PoisonError};

use crate::EmbreeError;
use crate::device::{self, Device, RawDevice};
use crate::sys::{self, Bounds, GeometryObject, SceneObject};

/// Ids up to this are taken. Embree keeps a table as long as the largest id, so ids should be small and
/// dense.
const LARGEST_ID: u32 = (1 << 26) - 1;

/// Most time steps a geometry may have.
pub const MOST_STEPS: usize = 129;

/// How much time a build spends on making rays fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildQuality {
    /// Built quickly.
    Medium,
    /// Splits large triangles: slower to build, more memory, faster rays.
    High,
}

/// A scene being put together. Its rays are traced robustly: none slips through between neighboring
/// triangles.
pub struct SceneBuilder {
    scene: RawScene,
    ids: HashSet<u32>,
    has_instances: bool,
}

impl SceneBuilder {
    /// Starts an empty scene.
    ///
    /// # Errors
    /// [`EmbreeError::OutOfMemory`].
    pub fn new(device: &Device, quality: BuildQuality) -> Result<Self, EmbreeError> {
        let device = Arc::clone(&device.raw);
        // SAFETY: the device is alive; the new reference is owned by `RawScene`.
        let handle = NonNull::new(unsafe { (device.api.new_scene)(device.handle.as_ptr()) });
        device::check()?;
        let scene = RawScene { handle: handle.ok_or(EmbreeError::OutOfMemory)?, device };
        let quality = match quality {
            BuildQuality::Medium => sys::BUILD_QUALITY_MEDIUM,
            BuildQuality::High => sys::BUILD_QUALITY_HIGH,
        };
        let api = &scene.device.api;
        // SAFETY: the scene is alive and not shared yet.
        unsafe {
            (api.set_scene_flags)(scene.handle.as_ptr(), sys::SCENE_FLAG_ROBUST);
            (api.set_scene_build_quality)(scene.handle.as_ptr(), quality);
        }
        device::check()?;
        Ok(Self { scene, ids: HashSet::new(), has_instances: false })
    }

    /// Adds a triangle mesh; hits report it as `id`. The arrays are copied.
    ///
    /// Rays whose mask has no bit in common with `mask` do not see it. Triangles with a position that is not
    /// finite (or beyond ±1.8e18) are never hit. A mesh without triangles is allowed.
    ///
    /// # Errors
    /// [`EmbreeError::InvalidInput`] if a triangle names a position that does not exist or `id` is taken or
    /// not below 2^26; [`EmbreeError::OutOfMemory`].
    pub fn add_triangles(
        &mut self,
        id: u32,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        mask: u32,
    ) -> Result<(), EmbreeError> {
        self.add_moving_triangles(id, &[positions], triangles, mask)
    }

    /// As [`add_triangles`](Self::add_triangles), with positions that change: `steps` holds those at even times from 0 to 1,
    /// between which they go straight.
    ///
    /// # Errors
    /// The same; steps that are none, too many ([`MOST_STEPS`]) or of unequal length.
    pub fn add_moving_triangles(
        &mut self,
        id: u32,
        steps: &[&[[f32; 3]]],
        triangles: &[[u32; 3]],
        mask: u32,
    ) -> Result<(), EmbreeError> {
        let step_count = step_count(id, steps.len())?;
        let positions = steps[0];
        if steps.iter().any(|step| step.len() != positions.len()) {
            return Err(EmbreeError::InvalidInput(format!("the steps of mesh {id} differ in length")));
        }
        if let Some(index) = triangles.as_flattened().iter().find(|&&index| index as usize >= positions.len())
        {
            let count = positions.len();
            return Err(EmbreeError::InvalidInput(format!(
                "a triangle of mesh {id} uses position {index}, but there are only {count}"
            )));
        }
        self.reserve_id(id)?;
        if triangles.is_empty() {
            return Ok(());
        }
        let geometry = RawGeometry::new(&self.scene.device, sys::GEOMETRY_TYPE_TRIANGLE)?;
        geometry.set_steps(step_count)?;
        for (slot, positions) in (0..).zip(steps) {
            geometry.copy_buffer(sys::BUFFER_TYPE_VERTEX, slot, sys::FORMAT_FLOAT3, positions)?;
        }
        geometry.copy_buffer(sys::BUFFER_TYPE_INDEX, 0, sys::FORMAT_UINT3, triangles)?;
        self.attach(id, &geometry, mask)
    }

    /// Adds an instance of `scene`; hits report it as `id`. The instanced scene is shared, not copied.
    ///
    /// `transform_columns` takes the instance's space to this scene's: three columns of a linear map, then
    /// the translation. A ray must share a bit with `mask` and with the mask of the mesh inside. A transform
    /// that flattens space (scale 0) is allowed, but what it holds may then not be hit.
    ///
    /// # Errors
    /// [`EmbreeError::InvalidInput`] if the transform is not finite, `scene` is of another device or holds
    /// instances itself, or `id` is taken or not below 2^26; [`EmbreeError::OutOfMemory`].
    pub fn add_instance(
        &mut self,
        id: u32,
        scene: &CommittedScene,
        transform_columns: &[f32; 12],
        mask: u32,
    ) -> Result<(), EmbreeError> {
        self.add_moving_instance(id, scene, &[*transform_columns], mask)
    }

    /// As [`add_instance`](Self::add_instance), with a transform that changes: `steps` holds it at even times from 0 to 1,
    /// between which its elements change evenly.
    ///
    /// # Errors
    /// The same; steps that are none or too many ([`MOST_STEPS`]).
    pub fn add_moving_instance(
        &mut self,
        id: u32,
        scene: &CommittedScene,
        steps: &[[f32; 12]],
        mask: u32,
    ) -> Result<(), EmbreeError> {
        let step_count = step_count(id, steps.len())?;
        if !steps.as_flattened().iter().all(|value| value.is_finite()) {
            return Err(EmbreeError::InvalidInput(format!("the transform of instance {id} is not finite")));
        }
        if !Arc::ptr_eq(&scene.shared.scene.device, &self.scene.device) {
            return Err(EmbreeError::InvalidInput(format!("instance {id} shows a scene of another device")));
        }
        if scene.shared.has_instances {
            return Err(EmbreeError::InvalidInput(format!(
                "instance {id} shows a scene that holds instances itself"
            )));
        }
        self.reserve_id(id)?;
        let geometry = RawGeometry::new(&self.scene.device, sys::GEOMETRY_TYPE_INSTANCE)?;
        geometry.set_steps(step_count)?;
        let (api, handle) = (&self.scene.device.api, geometry.handle.as_ptr());
        // SAFETY: both handles are alive and of one device. Embree takes a reference of its own to the instanced scene.
        unsafe { (api.set_instanced_scene)(handle, scene.handle()) };
        for (step, columns) in (0..).zip(steps) {
            let format = sys::FORMAT_FLOAT3X4_COLUMN_MAJOR;
            // SAFETY: the geometry is alive and has this step; the matrix has the twelve floats the format says and is
            // copied.
            unsafe { (api.set_geometry_transform)(handle, step, format, columns.as_ptr().cast()) };
        }
        device::check()?;
        self.has_instances = true;
        self.attach(id, &geometry, mask)
    }

    /// Builds the acceleration structure on the device's threads, and waits for it.
    ///
    /// `keep_going` is called from the build threads, often and possibly at the same time, with the fraction
    /// done (0 to 1); returning false stops the build. Very small scenes may be built without a call. A panic
    /// in it stops the build and continues on the calling thread.
    ///
    /// # Errors
    /// [`EmbreeError::Cancelled`] if `keep_going` returned false, [`EmbreeError::OutOfMemory`].
    pub fn commit(self, keep_going: &(dyn Fn(f64) -> bool + Sync)) -> Result<CommittedScene, EmbreeError> {
        let progress = BuildProgress { keep_going, panic: Mutex::new(None) };
        let api = &self.scene.device.api;
        let handle = self.scene.handle.as_ptr();
        // SAFETY: the scene is alive and owned here. `progress` outlives the commit, which returns only when
        // all build tasks have ended, and the pointer to it is taken back right after.
        unsafe {
            (api.set_scene_progress)(handle, Some(report_progress), (&raw const progress).cast_mut().cast());
            (api.commit_scene)(handle);
            (api.set_scene_progress)(handle, None, ptr::null_mut());
        }
        let outcome = device::check();
        if let Some(payload) = progress.panic.into_inner().unwrap_or_else(PoisonError::into_inner) {
            panic::resume_unwind(payload);
        }
        outcome?;
        Ok(CommittedScene {
            shared: Arc::new(SharedScene { scene: self.scene, has_instances: self.has_instances }),
        })
    }

    /// Refuses ids that are too large or already used.
    fn reserve_id(&mut self, id: u32) -> Result<(), EmbreeError> {
        if id > LARGEST_ID {
            return Err(EmbreeError::InvalidInput(format!("id {id} is above the largest, {LARGEST_ID}")));
        }
        if !self.ids.insert(id) {
            return Err(EmbreeError::InvalidInput(format!("id {id} is used twice")));
        }
        Ok(())
    }

    /// Finishes a geometry and puts it into the scene.
    fn attach(&self, id: u32, geometry: &RawGeometry, mask: u32) -> Result<(), EmbreeError> {
        let api = &self.scene.device.api;
        // SAFETY: both handles are alive and of one device; the scene takes a reference of its own to the
        // geometry.
        unsafe {
            (api.set_geometry_mask)(geometry.handle.as_ptr(), mask);
            (api.commit_geometry)(geometry.handle.as_ptr());
            (api.attach_geometry_by_id)(self.scene.handle.as_ptr(), geometry.handle.as_ptr(), id);
        }
        device::check()
    }
}

/// A built scene, ready for rays from any number of threads. Clones share it.
#[derive(Clone)]
pub struct CommittedScene {
    shared: Arc<SharedScene>,
}

struct SharedScene {
    scene: RawScene,
    has_instances: bool,
}

impl CommittedScene {
    /// Smallest and largest corner of the box around everything in the scene; of an empty scene, +∞ and -∞.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let mut bounds = Bounds::default();
        // SAFETY: the scene is alive and committed; `bounds` has the layout and alignment of `RTCBounds`.
        unsafe { (self.api().scene_bounds)(self.handle(), &raw mut bounds) };
        [bounds.lower, bounds.upper]
    }

    pub(crate) fn api(&self) -> &sys::Api {
        &self.shared.scene.device.api
    }

    pub(crate) fn handle(&self) -> *mut SceneObject {
        self.shared.scene.handle.as_ptr()
    }
}

/// Owner of one `RTCScene`. Embree itself counts the scenes and geometries it refers to.
struct RawScene {
    handle: NonNull<SceneObject>,
    device: Arc<RawDevice>,
}

// SAFETY: a scene is not tied to the thread that made it. It changes only through `SceneBuilder`, which is
// not shared.
unsafe impl Send for RawScene {}
// SAFETY: through a shared reference only queries, bounds and instancing of a committed scene are reachable,
// which Embree allows from many threads at once; its reference counts are atomic.
unsafe impl Sync for RawScene {}

impl Drop for RawScene {
    fn drop(&mut self) {
        // SAFETY: this is the only owner of the reference, and it is given up once, while the device is still
        // held.
        unsafe { (self.device.api.release_scene)(self.handle.as_ptr()) };
    }
}

/// Owner of one `RTCGeometry` on its way into a scene.
struct RawGeometry<'a> {
    handle: NonNull<GeometryObject>,
    device: &'a RawDevice,
}

impl<'a> RawGeometry<'a> {
    fn new(device: &'a RawDevice, kind: c_int) -> Result<Self, EmbreeError> {
        // SAFETY: the device is alive; the new reference is owned by `RawGeometry`.
        let handle = NonNull::new(unsafe { (device.api.new_geometry)(device.handle.as_ptr(), kind) });
        device::check()?;
        Ok(Self { handle: handle.ok_or(EmbreeError::OutOfMemory)?, device })
    }

    /// Sets the number of time steps; one is what geometries have from the start.
    fn set_steps(&self, count: u32) -> Result<(), EmbreeError> {
        if count > 1 {
            // SAFETY: the geometry is alive and not committed yet.
            unsafe { (self.device.api.set_time_step_count)(self.handle.as_ptr(), count) };
        }
        device::check()
    }

    /// Copies `items` into a buffer that Embree owns, and pads as it needs: it reads 16 bytes at the last
    /// position.
    fn copy_buffer<T: Copy>(
        &self,
        kind: c_int,
        slot: u32,
        format: c_int,
        items: &[[T; 3]],
    ) -> Result<(), EmbreeError> {
        let stride = size_of::<[T; 3]>();
        // SAFETY: the geometry is alive, and stride and format agree.
        let target = unsafe {
            (self.device.api.set_new_geometry_buffer)(
                self.handle.as_ptr(),
                kind,
                slot,
                format,
                stride,
                items.len(),
            )
        };
        device::check()?;
        let target = NonNull::new(target).ok_or(EmbreeError::OutOfMemory)?;
        // SAFETY: Embree has just allocated room for at least `items.len()` items of `stride` bytes, aligned
        // to 16.
        unsafe { ptr::copy_nonoverlapping(items.as_ptr(), target.as_ptr().cast(), items.len()) };
        Ok(())
    }
}

impl Drop for RawGeometry<'_> {
    fn drop(&mut self) {
        // SAFETY: this is the only owner of the reference, and it is given up once.
        unsafe { (self.device.api.release_geometry)(self.handle.as_ptr()) };
    }
}

/// Checks a number of time steps.
fn step_count(id: u32, count: usize) -> Result<u32, EmbreeError> {
    let allowed = u32::try_from(count).ok().filter(|_| (1..=MOST_STEPS).contains(&count));
    allowed.ok_or_else(|| EmbreeError::InvalidInput(format!("{id} has {count} time steps")))
}

/// What the build's progress callback works with.
struct BuildProgress<'a> {
    keep_going: &'a (dyn Fn(f64) -> bool + Sync),
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

/// Embree's progress callback. Lets no panic cross into C++.
unsafe extern "C" fn report_progress(user: *mut c_void, fraction: f64) -> bool {
    // SAFETY: `SceneBuilder::commit` set this pointer to a `BuildProgress` that lives until the commit is
    // over, and which is `Sync`.
    let progress = unsafe { &*user.cast::<BuildProgress<'_>>() };
    match panic::catch_unwind(AssertUnwindSafe(|| (progress.keep_going)(fraction.clamp(0.0, 1.0)))) {
        Ok(keep_going) => keep_going,
        Err(payload) => {
            progress.panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(payload);
            false
        }
    }
}
