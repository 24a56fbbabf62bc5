//! Flow.
/// u
#[derive(Clone, Copy, Debug)]
pub struct UniformFlow;
/// v
#[derive(Clone, Copy, Debug)]
pub struct VortexFlow;
/// s
#[derive(Clone, Copy, Debug)]
pub struct SinkFlow;
