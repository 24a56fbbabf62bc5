//! Draws a [`Frame`].

use crate::canvas::{Canvas, DEPTH};
use crate::error::ViewError;
use crate::frame::{Frame, Instance, Mode};
use crate::gpu::{Gpu, Growing};
use crate::image::Image;
use crate::lists::{Detail, Draw, Face, Form, Lists, Stroke};
use crate::mesh::Mesh;
use crate::outline::Outliner;
use crate::pipelines::{EdgeCorner, Layouts, Pipelines, Shaders, shadow_pipeline};
use crate::uniforms::{Uniforms, edge_width};
use std::collections::BTreeMap;
use std::mem::size_of;
use std::ops::Range;
use std::sync::Arc;
use wgpu::{BufferUsages, util::DeviceExt};

/// Edge of the shadow map \[texels\]: for graphics cards, and for software.
const SHADOW_MAP: (u32, u32) = (2048, 1024);
/// How far a sphere may be from round \[pixels\]: on graphics cards, and in software.
const ROUNDNESS: (f64, f64) = (0.15, 0.3);

/// A surface in the driver's memory.
struct Uploaded {
    /// kept, so that no other surface gets its address
    _mesh: Option<Arc<Mesh>>,
    corners: wgpu::Buffer,
    triangles: wgpu::Buffer,
    edge_corners: wgpu::Buffer,
    edge_triangles: wgpu::Buffer,
    used: bool,
}

/// Draws frames, offscreen or for a window. Surfaces and buffers are kept from picture to picture.
pub struct Renderer {
    gpu: Gpu,
    layouts: Layouts,
    shaders: Shaders,
    pipelines: Vec<Pipelines>,
    shadow_pipeline: wgpu::RenderPipeline,
    shadow_size: u32,
    shadow_map: wgpu::TextureView,
    shadow_group: wgpu::BindGroup,
    picture: wgpu::Buffer,
    picture_group: wgpu::BindGroup,
    spheres: Vec<Option<Uploaded>>,
    surfaces: BTreeMap<usize, Uploaded>,
    lists: Lists,
    instances: Growing,
    strokes: Growing,
    faces: Growing,
    outliner: Option<Outliner>,
    canvas: Option<Canvas>,
}

impl Renderer {
    /// Draws without a window.
    ///
    /// # Errors
    /// There is no graphics driver: the message says what to install.
    pub fn new() -> Result<Renderer, ViewError> {
        Renderer::with(Gpu::without_window()?)
    }

    /// Draws with a device that exists already, such as a window's.
    ///
    /// # Errors
    /// The driver refuses the shaders.
    pub fn with(gpu: Gpu) -> Result<Renderer, ViewError> {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let shaders = Shaders::new(device);
        let shadow_pipeline = shadow_pipeline(device, &layouts, &shaders);
        let shadow_size = if gpu.is_software { SHADOW_MAP.1 } else { SHADOW_MAP.0 };
        let shadow_map = depth_map(device, shadow_size);
        let shadow_group = shadow_group(device, &layouts, &shadow_map);
        let picture = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: size_of::<Uniforms>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let picture_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layouts.picture,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: picture.as_entire_binding() }],
        });
        gpu.check()?;
        Ok(Renderer {
            layouts,
            shaders,
            pipelines: Vec::new(),
            shadow_pipeline,
            shadow_size,
            shadow_map,
            shadow_group,
            picture,
            picture_group,
            spheres: Vec::new(),
            surfaces: BTreeMap::new(),
            lists: Lists::default(),
            instances: Growing::new("bodies", BufferUsages::VERTEX),
            strokes: Growing::new("lines", BufferUsages::VERTEX),
            faces: Growing::new("walls", BufferUsages::VERTEX),
            outliner: None,
            canvas: None,
            gpu,
        })
    }

    /// The device it draws with.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Draws a frame and reads it back.
    ///
    /// # Errors
    /// The driver cannot: the size, the number of bodies, or a failure of its own.
    pub fn render(&mut self, frame: &Frame, width: u32, height: u32) -> Result<Image, ViewError> {
        let mut image = Image::default();
        self.render_into(frame, width, height, &mut image)?;
        Ok(image)
    }

    /// As [`render`](Renderer::render), into an image whose memory is used again.
    ///
    /// # Errors
    /// As `render`.
    pub fn render_into(&mut self, frame: &Frame, width: u32, height: u32, image: &mut Image) -> Result<(), ViewError> {
        let smooth = frame.look.smooth.unwrap_or(!self.gpu.is_software);
        let fits = |c: &Canvas| c.size() == (width, height) && (c.samples() > 1) == smooth;
        let mut canvas = match self.canvas.take().filter(fits) {
            Some(canvas) => canvas,
            None => Canvas::new(&self.gpu, width, height, smooth)?,
        };
        self.draw(frame, &canvas)?;
        canvas.read(&self.gpu, image)?;
        self.canvas = Some(canvas);
        Ok(())
    }

    /// Draws a frame onto a canvas, which a window may then show.
    ///
    /// # Errors
    /// The driver cannot: the number of bodies, or a failure of its own.
    pub fn draw(&mut self, frame: &Frame, canvas: &Canvas) -> Result<(), ViewError> {
        let (width, height) = canvas.size();
        let tolerance = if self.gpu.is_software { ROUNDNESS.1 } else { ROUNDNESS.0 };
        let uniforms = Uniforms::new(frame, width, height, self.shadow_size);
        self.lists.collect(frame, Detail { width, height, tolerance, line_width: edge_width(height) });
        self.gpu.queue.write_buffer(&self.picture, 0, bytemuck::bytes_of(&uniforms));
        self.instances.put(&self.gpu, bytemuck::cast_slice(&self.lists.instances))?;
        self.strokes.put(&self.gpu, bytemuck::cast_slice(&self.lists.strokes))?;
        self.faces.put(&self.gpu, bytemuck::cast_slice(&self.lists.faces))?;
        self.upload(frame);
        let device = &self.gpu.device;
        if !self.pipelines.iter().any(|p| p.samples == canvas.samples()) {
            self.pipelines.push(Pipelines::new(device, &self.layouts, &self.shaders, canvas.samples()));
        }
        if !self.lists.outlined.is_empty() {
            let outliner = self.outliner.take().filter(|o| o.fits(width, height));
            let made = outliner.unwrap_or_else(|| Outliner::new(device, &self.layouts, &self.shaders, width, height));
            self.outliner = Some(made.prepared(device, &self.layouts, &self.shaders, canvas.samples()));
        }
        let device = &self.gpu.device;
        let mut encoder = device.create_command_encoder(&Default::default());
        if uniforms.has_shadows() {
            self.shadow_pass(&mut encoder, frame);
        }
        let [left, top, right, bottom] = self.lists.outline;
        let outliner =
            self.outliner.as_ref().filter(|_| !self.lists.outlined.is_empty() && left < right && top < bottom);
        if let Some(outliner) = outliner {
            self.mask_passes(&mut encoder, frame, outliner);
        }
        if let Some(pipelines) = self.pipelines.iter().find(|p| p.samples == canvas.samples()) {
            let mut pass = self.main_pass(&mut encoder, frame, canvas, pipelines);
            if let Some(outliner) = outliner {
                outliner.draw(&mut pass, self.lists.outline, canvas.samples());
            }
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()
    }

    /// Uploads surfaces that are new, and forgets those that are no longer in the picture.
    fn upload(&mut self, frame: &Frame) {
        let device = &self.gpu.device;
        self.surfaces.values_mut().for_each(|s| s.used = false);
        let bubble = Draw { form: Form::Sphere(BUBBLE_LEVEL), range: self.lists.bubbles.clone() };
        let drawn = self.lists.draws.iter().chain(&self.lists.outlined);
        for draw in drawn.chain((!bubble.range.is_empty()).then_some(&bubble)) {
            match draw.form {
                Form::Sphere(level) => {
                    let level = usize::from(level);
                    self.spheres.resize_with(self.spheres.len().max(level + 1), || None);
                    self.spheres[level].get_or_insert_with(|| upload(device, &Mesh::sphere(level as u8), None));
                }
                Form::Batch(i) => {
                    let mesh = &frame.batches[i].mesh;
                    let address = Arc::as_ptr(mesh) as usize;
                    let entry = self.surfaces.entry(address);
                    entry.or_insert_with(|| upload(device, mesh, Some(mesh.clone()))).used = true;
                }
            }
        }
        self.surfaces.retain(|_, s| s.used);
    }

    fn surface(&self, frame: &Frame, form: Form) -> Option<&Uploaded> {
        match form {
            Form::Sphere(level) => self.spheres.get(usize::from(level))?.as_ref(),
            Form::Batch(i) => self.surfaces.get(&(Arc::as_ptr(&frame.batches[i].mesh) as usize)),
        }
    }

    fn shadow_pass(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            depth_stencil_attachment: Some(depth_attachment(&self.shadow_map, 1.0)),
            ..Default::default()
        });
        pass.set_pipeline(&self.shadow_pipeline);
        pass.set_bind_group(0, &self.picture_group, &[]);
        self.draw_bodies(&mut pass, frame, false);
    }

    /// Masks what is outlined.
    fn mask_passes(&self, encoder: &mut wgpu::CommandEncoder, frame: &Frame, outliner: &Outliner) {
        {
            let mut pass = outliner.mask_pass(encoder);
            pass.set_bind_group(0, &self.picture_group, &[]);
            for edges in [false, true] {
                pass.set_pipeline(outliner.mask_pipeline(edges));
                for draw in &self.lists.outlined {
                    self.draw_some(&mut pass, frame, draw.form, &draw.range, edges);
                }
            }
        }
        outliner.row_pass(encoder, &self.picture_group, self.lists.outline);
    }

    fn main_pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        frame: &Frame,
        canvas: &Canvas,
        p: &Pipelines,
    ) -> wgpu::RenderPass<'a> {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: canvas.sampled.as_ref().unwrap_or(&canvas.view),
                depth_slice: None,
                resolve_target: canvas.sampled.as_ref().map(|_| &canvas.view),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::WHITE), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(depth_attachment(&canvas.depth, 0.0)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.picture_group, &[]);
        pass.set_bind_group(1, &self.shadow_group, &[]);
        pass.set_pipeline(&p.background);
        pass.draw(0..3, 0..1);
        let boxes = self.lists.boxes;
        self.draw_quads::<Face>(&mut pass, &p.faces, &self.faces, 0..boxes);
        match frame.look.mode {
            Mode::Wireframe => {}
            Mode::HiddenLine => pass.set_pipeline(&p.plain),
            Mode::Flat => pass.set_pipeline(&p.flat),
            Mode::Gouraud => pass.set_pipeline(&p.gouraud),
            Mode::Phong => pass.set_pipeline(&p.phong),
        }
        if frame.look.mode != Mode::Wireframe {
            self.draw_bodies(&mut pass, frame, false);
        }
        if frame.look.mode.has_lines() {
            pass.set_pipeline(&p.edges);
            self.draw_bodies(&mut pass, frame, true);
        }
        let (on_top, all) = (self.lists.on_top, self.lists.strokes.len() as u32);
        self.draw_quads::<Stroke>(&mut pass, &p.lines, &self.strokes, 0..on_top);
        self.draw_quads::<Face>(&mut pass, &p.faces, &self.faces, boxes..self.lists.faces.len() as u32);
        if !self.lists.bubbles.is_empty() {
            pass.set_pipeline(&p.bubbles);
            self.draw_some(&mut pass, frame, Form::Sphere(BUBBLE_LEVEL), &self.lists.bubbles, false);
        }
        self.draw_quads::<Stroke>(&mut pass, &p.lines_on_top, &self.strokes, on_top..all);
        pass
    }

    fn draw_bodies(&self, pass: &mut wgpu::RenderPass<'_>, frame: &Frame, edges: bool) {
        for draw in &self.lists.draws {
            self.draw_some(pass, frame, draw.form, &draw.range, edges);
        }
    }

    fn draw_some(&self, pass: &mut wgpu::RenderPass<'_>, frame: &Frame, form: Form, range: &Range<u32>, edges: bool) {
        let (Some(surface), Some(instances)) = (self.surface(frame, form), self.instances.get()) else { return };
        let (corners, triangles) = if edges {
            (&surface.edge_corners, &surface.edge_triangles)
        } else {
            (&surface.corners, &surface.triangles)
        };
        // By the buffer's offset: not every driver can begin at another instance than the first.
        let stride = size_of::<Instance>() as u64;
        pass.set_vertex_buffer(0, corners.slice(..));
        pass.set_vertex_buffer(1, instances.slice(u64::from(range.start) * stride..u64::from(range.end) * stride));
        pass.set_index_buffer(triangles.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..(triangles.size() / 4) as u32, 0, 0..range.end - range.start);
    }

    fn draw_quads<T>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        pipeline: &wgpu::RenderPipeline,
        from: &Growing,
        range: Range<u32>,
    ) {
        let Some(buffer) = from.get().filter(|_| !range.is_empty()) else { return };
        let stride = size_of::<T>() as u64;
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, buffer.slice(u64::from(range.start) * stride..u64::from(range.end) * stride));
        pass.draw(0..4, 0..range.end - range.start);
    }
}

/// Triangulation of translucent spheres.
const BUBBLE_LEVEL: u8 = 4;

fn depth_attachment(view: &wgpu::TextureView, clear: f32) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

fn depth_map(device: &wgpu::Device, size: u32) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow map"),
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

fn shadow_group(device: &wgpu::Device, layouts: &Layouts, map: &wgpu::TextureView) -> wgpu::BindGroup {
    let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow map"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::LessEqual),
        ..Default::default()
    });
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layouts.shadow,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(map) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
        ],
    })
}

fn upload(device: &wgpu::Device, mesh: &Mesh, kept: Option<Arc<Mesh>>) -> Uploaded {
    let buffer = |contents: &[u8], usage| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("surface"), contents, usage })
    };
    let quad = |&[start, end]: &[[f32; 3]; 2]| [0, 1, 2, 3].map(|number| EdgeCorner { start, end, number });
    let edge_corners: Vec<EdgeCorner> = mesh.edges.iter().flat_map(quad).collect();
    let both = |i: u32| [0, 1, 2, 2, 1, 3].map(|k| 4 * i + k);
    let edge_triangles: Vec<u32> = (0..mesh.edges.len() as u32).flat_map(both).collect();
    Uploaded {
        _mesh: kept,
        corners: buffer(bytemuck::cast_slice(&mesh.vertices), BufferUsages::VERTEX),
        triangles: buffer(bytemuck::cast_slice(&mesh.triangles), BufferUsages::INDEX),
        edge_corners: buffer(bytemuck::cast_slice(&edge_corners), BufferUsages::VERTEX),
        edge_triangles: buffer(bytemuck::cast_slice(&edge_triangles), BufferUsages::INDEX),
        used: true,
    }
}
