//! Embree's C interface: constants, structures and the table of entry points, as in the headers of Embree 4.3
//! and 4.4.
//!
//! The structures are those of a library built for one level of instances, which is Embree's default. Whether
//! it was built with instance arrays does not matter: that only appends `instPrimID` to a hit, and room for
//! it is always there.

use std::ffi::{c_char, c_int, c_void};

use crate::query::{Ray16, RayHit16};

pub(crate) const DEVICE_PROPERTY_VERSION_MAJOR: c_int = 1;
pub(crate) const DEVICE_PROPERTY_VERSION_MINOR: c_int = 2;
pub(crate) const DEVICE_PROPERTY_VERSION_PATCH: c_int = 3;
pub(crate) const DEVICE_PROPERTY_RAY_MASK_SUPPORTED: c_int = 64;

pub(crate) const ERROR_NONE: c_int = 0;
pub(crate) const ERROR_OUT_OF_MEMORY: c_int = 4;
pub(crate) const ERROR_CANCELLED: c_int = 6;

pub(crate) const GEOMETRY_TYPE_TRIANGLE: c_int = 0;
pub(crate) const GEOMETRY_TYPE_INSTANCE: c_int = 121;

pub(crate) const BUFFER_TYPE_INDEX: c_int = 0;
pub(crate) const BUFFER_TYPE_VERTEX: c_int = 1;

pub(crate) const FORMAT_UINT3: c_int = 0x5003;
pub(crate) const FORMAT_FLOAT3: c_int = 0x9003;
pub(crate) const FORMAT_FLOAT3X4_COLUMN_MAJOR: c_int = 0x9234;

pub(crate) const BUILD_QUALITY_MEDIUM: c_int = 1;
pub(crate) const BUILD_QUALITY_HIGH: c_int = 2;

pub(crate) const SCENE_FLAG_ROBUST: c_int = 1 << 2;

const QUERY_FLAG_INCOHERENT: c_int = 0;
const QUERY_FLAG_COHERENT: c_int = 1 << 16;
const FEATURE_FLAG_ALL: u32 = u32::MAX;

/// Never constructed: gives `RTCDevice` a type of its own.
pub(crate) enum DeviceObject {}
/// Never constructed: gives `RTCScene` a type of its own.
pub(crate) enum SceneObject {}
/// Never constructed: gives `RTCGeometry` a type of its own.
pub(crate) enum GeometryObject {}

/// `RTCErrorFunction`.
pub(crate) type ErrorFunction = unsafe extern "C" fn(user: *mut c_void, code: c_int, message: *const c_char);
/// `RTCProgressMonitorFunction`.
pub(crate) type ProgressFunction = unsafe extern "C" fn(user: *mut c_void, fraction: f64) -> bool;

/// `RTCBounds`.
#[derive(Default)]
#[repr(C, align(16))]
pub(crate) struct Bounds {
    pub(crate) lower: [f32; 3],
    pub(crate) lower_padding: f32,
    pub(crate) upper: [f32; 3],
    pub(crate) upper_padding: f32,
}

/// `RTCRay`.
#[repr(C, align(16))]
pub(crate) struct SingleRay {
    pub(crate) origin: [f32; 3],
    pub(crate) t_near: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) time: f32,
    pub(crate) t_far: f32,
    pub(crate) mask: u32,
    pub(crate) id: u32,
    pub(crate) flags: u32,
}

/// `RTCHit`.
#[repr(C, align(16))]
pub(crate) struct SingleHit {
    pub(crate) normal: [f32; 3],
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) prim_id: u32,
    pub(crate) geom_id: u32,
    pub(crate) inst_id: u32,
    pub(crate) inst_prim_id: u32,
}

/// `RTCRayHit`.
#[repr(C)]
pub(crate) struct SingleRayHit {
    pub(crate) ray: SingleRay,
    pub(crate) hit: SingleHit,
}

/// The `valid` argument of a packet query: -1 for an active lane, 0 for the others.
#[repr(C, align(64))]
pub(crate) struct ActiveLanes(pub(crate) [c_int; 16]);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which differ only in the type of a callback not used
/// here.
#[repr(C)]
pub(crate) struct QueryArguments {
    flags: c_int,
    feature_mask: u32,
    /// Null: Embree then makes a context of the size it was built for.
    context: *mut c_void,
    filter: *const c_void,
    user_geometry: *const c_void,
    /// Read only by libraries built with `EMBREE_MIN_WIDTH`.
    min_width_distance_factor: f32,
}

impl QueryArguments {
    /// What `rtcInitIntersectArguments` sets, with the hint that the rays of a packet run alike.
    pub(crate) const fn new(coherent: bool) -> Self {
        Self {
            flags: if coherent { QUERY_FLAG_COHERENT } else { QUERY_FLAG_INCOHERENT },
            feature_mask: FEATURE_FLAG_ALL,
            context: std::ptr::null_mut(),
            filter: std::ptr::null(),
            user_geometry: std::ptr::null(),
            min_width_distance_factor: 0.0,
        }
    }
}

/// Declares the table of entry points and the function that fills it.
macro_rules! entry_points {
    ($($field:ident = $symbol:literal : fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// Embree's entry points, looked up once.
        pub(crate) struct Api {
            $(pub(crate) $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Api {
            /// Looks up every entry point; the error is the name of the first that is missing.
            pub(crate) fn load(library: &libloading::Library) -> Result<Self, &'static str> {
                Ok(Self {
                    // SAFETY: the types are those of Embree 4's headers. Before `Library::open` has seen
                    // that this is Embree 4 it calls only the device functions, which Embree 3 has, too,
                    // with the same types. The pointers stay valid: the library is never unloaded.
                    $($field: *unsafe { library.get($symbol) }.map_err(|_| $symbol)?,)*
                })
            }
        }
    };
}

entry_points! {
    new_device = "rtcNewDevice": fn(*const c_char) -> *mut DeviceObject;
    release_device = "rtcReleaseDevice": fn(*mut DeviceObject);
    device_property = "rtcGetDeviceProperty": fn(*mut DeviceObject, c_int) -> isize;
    device_error = "rtcGetDeviceError": fn(*mut DeviceObject) -> c_int;
    set_error_function = "rtcSetDeviceErrorFunction":
        fn(*mut DeviceObject, Option<ErrorFunction>, *mut c_void);

    new_geometry = "rtcNewGeometry": fn(*mut DeviceObject, c_int) -> *mut GeometryObject;
    release_geometry = "rtcReleaseGeometry": fn(*mut GeometryObject);
    commit_geometry = "rtcCommitGeometry": fn(*mut GeometryObject);
    set_geometry_mask = "rtcSetGeometryMask": fn(*mut GeometryObject, u32);
    set_time_step_count = "rtcSetGeometryTimeStepCount": fn(*mut GeometryObject, u32);
    // Buffer type, slot, format, stride in bytes, number of items.
    set_new_geometry_buffer = "rtcSetNewGeometryBuffer":
        fn(*mut GeometryObject, c_int, u32, c_int, usize, usize) -> *mut c_void;
    set_instanced_scene = "rtcSetGeometryInstancedScene": fn(*mut GeometryObject, *mut SceneObject);
    // Time step, format, matrix.
    set_geometry_transform = "rtcSetGeometryTransform": fn(*mut GeometryObject, u32, c_int, *const c_void);

    new_scene = "rtcNewScene": fn(*mut DeviceObject) -> *mut SceneObject;
    release_scene = "rtcReleaseScene": fn(*mut SceneObject);
    set_scene_flags = "rtcSetSceneFlags": fn(*mut SceneObject, c_int);
    set_scene_build_quality = "rtcSetSceneBuildQuality": fn(*mut SceneObject, c_int);
    attach_geometry_by_id = "rtcAttachGeometryByID": fn(*mut SceneObject, *mut GeometryObject, u32);
    set_scene_progress = "rtcSetSceneProgressMonitorFunction":
        fn(*mut SceneObject, Option<ProgressFunction>, *mut c_void);
    commit_scene = "rtcCommitScene": fn(*mut SceneObject);
    scene_bounds = "rtcGetSceneBounds": fn(*mut SceneObject, *mut Bounds);

    intersect1 = "rtcIntersect1": fn(*mut SceneObject, *mut SingleRayHit, *const QueryArguments);
    occluded1 = "rtcOccluded1": fn(*mut SceneObject, *mut SingleRay, *const QueryArguments);
    intersect16 = "rtcIntersect16":
        fn(*const ActiveLanes, *mut SceneObject, *mut RayHit16, *const QueryArguments);
    occluded16 = "rtcOccluded16": fn(*const ActiveLanes, *mut SceneObject, *mut Ray16, *const QueryArguments);
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use super::*;
    use crate::query::Hit16;

    // The numbers were printed by a C program that includes the headers of Embree 4.4.

    #[test]
    fn single_ray_structures_are_laid_out_as_in_the_headers() {
        assert_eq!((size_of::<SingleRay>(), align_of::<SingleRay>()), (48, 16));
        assert_eq!((size_of::<SingleHit>(), align_of::<SingleHit>()), (48, 16));
        assert_eq!((size_of::<SingleRayHit>(), offset_of!(SingleRayHit, hit)), (96, 48));
        assert_eq!((offset_of!(SingleRay, origin), offset_of!(SingleRay, t_near)), (0, 12));
        assert_eq!((offset_of!(SingleRay, direction), offset_of!(SingleRay, time)), (16, 28));
        assert_eq!((offset_of!(SingleRay, t_far), offset_of!(SingleRay, mask)), (32, 36));
        assert_eq!((offset_of!(SingleRay, id), offset_of!(SingleRay, flags)), (40, 44));
        assert_eq!((offset_of!(SingleHit, u), offset_of!(SingleHit, v)), (12, 16));
        assert_eq!((offset_of!(SingleHit, prim_id), offset_of!(SingleHit, geom_id)), (20, 24));
        assert_eq!((offset_of!(SingleHit, inst_id), offset_of!(SingleHit, inst_prim_id)), (28, 32));
    }

    #[test]
    fn packet_structures_are_laid_out_as_in_the_headers() {
        assert_eq!((size_of::<Ray16>(), align_of::<Ray16>()), (768, 64));
        assert_eq!((size_of::<Hit16>(), align_of::<Hit16>()), (576, 64));
        assert_eq!((size_of::<RayHit16>(), offset_of!(RayHit16, hit)), (1344, 768));
        assert_eq!((size_of::<ActiveLanes>(), align_of::<ActiveLanes>()), (64, 64));
        assert_eq!((offset_of!(Ray16, t_near), offset_of!(Ray16, dir_x)), (192, 256));
        assert_eq!((offset_of!(Ray16, time), offset_of!(Ray16, t_far)), (448, 512));
        assert_eq!(
            (offset_of!(Ray16, mask), offset_of!(Ray16, id), offset_of!(Ray16, flags)),
            (576, 640, 704)
        );
        assert_eq!((offset_of!(Hit16, ng_y), offset_of!(Hit16, u), offset_of!(Hit16, v)), (64, 192, 256));
        assert_eq!((offset_of!(Hit16, prim_id), offset_of!(Hit16, geom_id)), (320, 384));
        assert_eq!((offset_of!(Hit16, inst_id), offset_of!(Hit16, inst_prim_id)), (448, 512));
    }

    #[test]
    fn bounds_and_arguments_are_laid_out_as_in_the_headers() {
        assert_eq!((size_of::<Bounds>(), align_of::<Bounds>()), (32, 16));
        assert_eq!((offset_of!(Bounds, lower), offset_of!(Bounds, upper)), (0, 16));
        assert_eq!((size_of::<QueryArguments>(), offset_of!(QueryArguments, feature_mask)), (40, 4));
        assert_eq!((offset_of!(QueryArguments, context), offset_of!(QueryArguments, filter)), (8, 16));
        assert_eq!(offset_of!(QueryArguments, user_geometry), 24);
        assert_eq!(offset_of!(QueryArguments, min_width_distance_factor), 32);
    }
}
