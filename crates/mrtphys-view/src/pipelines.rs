//! How each kind of thing is drawn: one pipeline for each.

use crate::canvas::{DEPTH, FORMAT};
use crate::frame::Instance;
use crate::lists::{Face, Stroke};
use crate::mesh::Vertex;
use std::mem::size_of;
use wgpu::{ShaderModule, VertexAttribute, VertexBufferLayout, vertex_attr_array};

/// A corner of the quad that an edge of a body is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct EdgeCorner {
    /// one end of the edge
    pub start: [f32; 3],
    /// the other
    pub end: [f32; 3],
    /// which corner of the quad, 0 to 3
    pub number: u32,
}

const VERTEX: [VertexAttribute; 2] = vertex_attr_array![0 => Float32x3, 1 => Float32x3];
const EDGE: [VertexAttribute; 3] = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 5 => Uint32];
const INSTANCE: [VertexAttribute; 4] = vertex_attr_array![2 => Float32x4, 3 => Float32x4, 4 => Unorm8x4, 6 => Float32];
const STROKE: [VertexAttribute; 3] = vertex_attr_array![0 => Float32x4, 1 => Float32x3, 2 => Unorm8x4];
const FACE: [VertexAttribute; 5] =
    vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Unorm8x4];

fn buffer<T>(
    attributes: &'static [VertexAttribute],
    step_mode: wgpu::VertexStepMode,
) -> Option<VertexBufferLayout<'static>> {
    Some(VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes })
}

/// The layouts of what the shaders are bound to.
pub struct Layouts {
    /// the picture's uniforms
    pub picture: wgpu::BindGroupLayout,
    /// the shadow map
    pub shadow: wgpu::BindGroupLayout,
    /// the mask of what is outlined
    pub mask: wgpu::BindGroupLayout,
    all: wgpu::PipelineLayout,
    pub(crate) picture_only: wgpu::PipelineLayout,
    pub(crate) masked: wgpu::PipelineLayout,
}

impl Layouts {
    /// Makes them.
    pub fn new(device: &wgpu::Device) -> Layouts {
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let group = |entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let map = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let (both, fragment) = (wgpu::ShaderStages::VERTEX_FRAGMENT, wgpu::ShaderStages::FRAGMENT);
        let picture = group(&[entry(0, both, uniform)]);
        let shadow = group(&[entry(0, fragment, map), entry(1, fragment, sampler)]);
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let all = layout(&[Some(&picture), Some(&shadow)]);
        let picture_only = layout(&[Some(&picture)]);
        let flat = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let mask = group(&[entry(0, fragment, flat)]);
        let masked = layout(&[Some(&picture), Some(&mask)]);
        Layouts { picture, shadow, mask, all, picture_only, masked }
    }
}

/// The shaders.
pub struct Shaders {
    pub(crate) body: ShaderModule,
    pub(crate) line: ShaderModule,
    pub(crate) outline: ShaderModule,
    wall: ShaderModule,
    background: ShaderModule,
    depth: ShaderModule,
}

macro_rules! shader {
    ($device:expr, $($file:literal),+) => {
        $device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(concat!($($file, " "),+)),
            source: wgpu::ShaderSource::Wgsl(
                concat!(include_str!("shaders/common.wgsl"), $(include_str!(concat!("shaders/", $file))),+).into(),
            ),
        })
    };
}

impl Shaders {
    /// Compiles them.
    pub fn new(device: &wgpu::Device) -> Shaders {
        Shaders {
            body: shader!(device, "shadow_map.wgsl", "body.wgsl"),
            line: shader!(device, "line.wgsl"),
            outline: shader!(device, "outline.wgsl"),
            wall: shader!(device, "shadow_map.wgsl", "wall.wgsl"),
            background: shader!(device, "background.wgsl"),
            depth: shader!(device, "depth.wgsl"),
        }
    }
}

/// The buffers of a surface's triangles, or of its edges, and of its bodies.
pub fn body_buffers(edges: bool) -> [Option<VertexBufferLayout<'static>>; 2] {
    use wgpu::VertexStepMode::{Instance as Each, Vertex as Corner};
    let surface = if edges { buffer::<EdgeCorner>(&EDGE, Corner) } else { buffer::<Vertex>(&VERTEX, Corner) };
    [surface, buffer::<Instance>(&INSTANCE, Each)]
}

/// The pipelines for a number of samples a pixel.
pub struct Pipelines {
    /// number of samples
    pub samples: u32,
    /// the background
    pub background: wgpu::RenderPipeline,
    /// walls and boxes
    pub faces: wgpu::RenderPipeline,
    /// bodies lit in every pixel
    pub phong: wgpu::RenderPipeline,
    /// bodies lit at their corners
    pub gouraud: wgpu::RenderPipeline,
    /// bodies of flat triangles
    pub flat: wgpu::RenderPipeline,
    /// bodies without light, which only hide
    pub plain: wgpu::RenderPipeline,
    /// translucent spheres
    pub bubbles: wgpu::RenderPipeline,
    /// edges of bodies
    pub edges: wgpu::RenderPipeline,
    /// lines
    pub lines: wgpu::RenderPipeline,
    /// lines that show through what is before them
    pub lines_on_top: wgpu::RenderPipeline,
}

/// What distinguishes one pipeline from another.
struct Kind<'a> {
    shader: &'a ShaderModule,
    vertex: &'static str,
    fragment: &'static str,
    buffers: &'a [Option<VertexBufferLayout<'static>>],
    strip: bool,
    culled: bool,
    blended: bool,
    /// depth is compared and, unless blended, written
    tested: bool,
    /// pushed back, so that lines on it are seen
    behind: bool,
}

impl Pipelines {
    /// Makes them.
    pub fn new(device: &wgpu::Device, layouts: &Layouts, shaders: &Shaders, samples: u32) -> Pipelines {
        use wgpu::VertexStepMode::Instance as Each;
        let (bodies, edges) = (body_buffers(false), body_buffers(true));
        let strokes = [buffer::<Stroke>(&STROKE, Each)];
        let faces = [buffer::<Face>(&FACE, Each)];
        let body = |vertex, fragment| Kind {
            shader: &shaders.body,
            vertex,
            fragment,
            buffers: &bodies,
            strip: false,
            culled: true,
            blended: false,
            tested: true,
            behind: false,
        };
        let quads = |shader, vertex, fragment, buffers| Kind {
            shader,
            buffers,
            strip: true,
            culled: false,
            blended: true,
            ..body(vertex, fragment)
        };
        let make = |kind: Kind<'_>| pipeline(device, layouts, samples, &kind);
        let line = |buffers| quads(&shaders.line, "line", "ink", buffers);
        Pipelines {
            samples,
            background: make(Kind {
                tested: false,
                blended: false,
                strip: false,
                ..quads(&shaders.background, "everywhere", "sky", &[])
            }),
            faces: make(quads(&shaders.wall, "wall", "face", &faces)),
            phong: make(body("corner", "phong")),
            gouraud: make(body("gouraud_corner", "gouraud")),
            flat: make(body("corner", "flat_shaded")),
            plain: make(Kind { behind: true, ..body("corner", "plain") }),
            bubbles: make(Kind { blended: true, ..body("corner", "phong") }),
            edges: make(Kind { strip: false, ..quads(&shaders.line, "edge", "ink", &edges) }),
            lines: make(line(&strokes)),
            lines_on_top: make(Kind { tested: false, ..line(&strokes) }),
        }
    }
}

fn pipeline(device: &wgpu::Device, layouts: &Layouts, samples: u32, kind: &Kind<'_>) -> wgpu::RenderPipeline {
    use wgpu::PrimitiveTopology::{TriangleList, TriangleStrip};
    let bias = wgpu::DepthBiasState { constant: -4, slope_scale: -1.5, clamp: 0.0 };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(kind.fragment),
        layout: Some(&layouts.all),
        vertex: wgpu::VertexState {
            module: kind.shader,
            entry_point: Some(kind.vertex),
            compilation_options: Default::default(),
            buffers: kind.buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: if kind.strip { TriangleStrip } else { TriangleList },
            cull_mode: kind.culled.then_some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(kind.tested && !kind.blended),
            // Depth falls from 1 at the eye to 0 at infinity.
            depth_compare: Some(if kind.tested {
                wgpu::CompareFunction::GreaterEqual
            } else {
                wgpu::CompareFunction::Always
            }),
            stencil: Default::default(),
            bias: if kind.behind { bias } else { Default::default() },
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: kind.shader,
            entry_point: Some(kind.fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: FORMAT,
                blend: kind.blended.then_some(wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The pipeline of the shadow map: depth only.
pub fn shadow_pipeline(device: &wgpu::Device, layouts: &Layouts, shaders: &Shaders) -> wgpu::RenderPipeline {
    let buffers = body_buffers(false);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow map"),
        layout: Some(&layouts.picture_only),
        vertex: wgpu::VertexState {
            module: &shaders.depth,
            entry_point: Some("shadow_corner"),
            compilation_options: Default::default(),
            buffers: &buffers,
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::LessEqual),
            stencil: Default::default(),
            bias: wgpu::DepthBiasState { constant: 2, slope_scale: 2.0, clamp: 0.0 },
        }),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}
