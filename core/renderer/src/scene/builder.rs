//! placeholder
pub struct SceneBuilder; pub struct MeshArrays;
