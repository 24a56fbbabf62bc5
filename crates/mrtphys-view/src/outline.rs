//! Outlines of chosen bodies, over everything: a mask of where they are, and what is near it.

use crate::canvas::{DEPTH, FORMAT};
use crate::pipelines::{Layouts, Shaders, body_buffers};
use wgpu::{ShaderModule, TextureFormat, VertexBufferLayout};

/// Of the mask, and of the distances along rows.
const MASK: TextureFormat = TextureFormat::R8Unorm;

/// Masks bodies and draws their outlines, for pictures of one size.
pub struct Outliner {
    width: u32,
    height: u32,
    /// triangles and edges of bodies into the mask
    bodies: [wgpu::RenderPipeline; 2],
    rows: wgpu::RenderPipeline,
    /// number of samples, and the pipeline for it
    onto: Option<(u32, wgpu::RenderPipeline)>,
    mask: wgpu::TextureView,
    row: wgpu::TextureView,
    mask_group: wgpu::BindGroup,
    row_group: wgpu::BindGroup,
}

/// What distinguishes the pipelines.
struct Kind<'a> {
    layout: &'a wgpu::PipelineLayout,
    vertex: (&'a ShaderModule, &'static str),
    fragment: &'static str,
    buffers: &'a [Option<VertexBufferLayout<'static>>],
    /// number of samples of the picture; `None`: into a mask
    picture: Option<u32>,
}

impl Outliner {
    /// For pictures of this size \[pixels\].
    pub fn new(device: &wgpu::Device, layouts: &Layouts, shaders: &Shaders, width: u32, height: u32) -> Outliner {
        let body = |edges: bool| {
            let buffers = body_buffers(edges);
            let vertex = if edges { (&shaders.line, "edge") } else { (&shaders.body, "corner") };
            let layout = &layouts.picture_only;
            pipeline(device, &Kind { layout, vertex, fragment: "covered", buffers: &buffers, picture: None })
        };
        let texture = || {
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("mask"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: MASK,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let group = |view: &wgpu::TextureView| {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &layouts.mask,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) }],
            })
        };
        let (mask, row) = (texture(), texture());
        Outliner {
            width,
            height,
            bodies: [body(false), body(true)],
            rows: pipeline(device, &flat(layouts, shaders, "along_row", None)),
            onto: None,
            mask_group: group(&mask),
            row_group: group(&row),
            mask,
            row,
        }
    }

    /// Whether it is for pictures of this size.
    pub fn fits(&self, width: u32, height: u32) -> bool {
        (self.width, self.height) == (width, height)
    }

    /// With the pipeline for pictures of so many samples.
    pub fn prepared(mut self, device: &wgpu::Device, layouts: &Layouts, shaders: &Shaders, samples: u32) -> Outliner {
        if self.onto.as_ref().is_none_or(|(s, _)| *s != samples) {
            self.onto = Some((samples, pipeline(device, &flat(layouts, shaders, "outline", Some(samples)))));
        }
        self
    }

    /// Begins to draw the mask.
    pub fn mask_pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        begin(encoder, &self.mask, wgpu::Color::TRANSPARENT)
    }

    /// Draws triangles of bodies into the mask, or their edges.
    pub fn mask_pipeline(&self, edges: bool) -> &wgpu::RenderPipeline {
        &self.bodies[usize::from(edges)]
    }

    /// Measures distances along rows, within these pixels.
    pub fn row_pass(&self, encoder: &mut wgpu::CommandEncoder, picture: &wgpu::BindGroup, within: [u32; 4]) {
        let mut pass = begin(encoder, &self.row, wgpu::Color::WHITE);
        pass.set_bind_group(0, picture, &[]);
        pass.set_bind_group(1, &self.mask_group, &[]);
        pass.set_pipeline(&self.rows);
        scissor(&mut pass, within);
        pass.draw(0..3, 0..1);
    }

    /// Draws the outlines into a picture of so many samples, within these pixels.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, within: [u32; 4], samples: u32) {
        let Some((_, pipeline)) = self.onto.as_ref().filter(|(s, _)| *s == samples) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.row_group, &[]);
        scissor(pass, within);
        pass.draw(0..3, 0..1);
    }
}

fn scissor(pass: &mut wgpu::RenderPass<'_>, [left, top, right, bottom]: [u32; 4]) {
    pass.set_scissor_rect(left, top, right - left, bottom - top);
}

/// What is not drawn is 0 in the mask and, as white, far away along the rows.
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    clear: wgpu::Color,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("mask"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    })
}

fn flat<'a>(layouts: &'a Layouts, shaders: &'a Shaders, fragment: &'static str, picture: Option<u32>) -> Kind<'a> {
    Kind { layout: &layouts.masked, vertex: (&shaders.outline, "everywhere"), fragment, buffers: &[], picture }
}

fn pipeline(device: &wgpu::Device, kind: &Kind<'_>) -> wgpu::RenderPipeline {
    let (module, vertex) = kind.vertex;
    let depth = wgpu::DepthStencilState {
        format: DEPTH,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: Default::default(),
        bias: Default::default(),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(kind.fragment),
        layout: Some(kind.layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: kind.buffers,
        },
        primitive: Default::default(),
        depth_stencil: kind.picture.map(|_| depth),
        multisample: wgpu::MultisampleState { count: kind.picture.unwrap_or(1), ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(kind.fragment),
            compilation_options: Default::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: if kind.picture.is_some() { FORMAT } else { MASK },
                blend: kind.picture.map(|_| wgpu::BlendState::ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
