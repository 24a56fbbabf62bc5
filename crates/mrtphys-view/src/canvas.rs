//! What is drawn upon: a texture of a size, with its depth and its samples.

use crate::error::ViewError;
use crate::gpu::Gpu;
use crate::image::Image;
use std::sync::mpsc;

/// Colors are stored in the sRGB encoding and mixed as light.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// The same bytes without decoding, as user interfaces that mix encoded colors want them.
pub const ENCODED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Depth.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A texture to draw upon.
pub struct Canvas {
    width: u32,
    height: u32,
    samples: u32,
    texture: wgpu::Texture,
    pub(crate) view: wgpu::TextureView,
    /// the samples of a smoothed picture
    pub(crate) sampled: Option<wgpu::TextureView>,
    pub(crate) depth: wgpu::TextureView,
    read_back: Option<wgpu::Buffer>,
}

impl Canvas {
    /// Of this size \[pixels\]; `smooth`: with four samples a pixel.
    ///
    /// # Errors
    /// The driver cannot draw pictures of this size.
    pub fn new(gpu: &Gpu, width: u32, height: u32, smooth: bool) -> Result<Canvas, ViewError> {
        let limits = gpu.device.limits();
        let largest = limits.max_texture_dimension_2d;
        if !(1..=largest).contains(&width) || !(1..=largest).contains(&height) {
            return Err(ViewError::Size { width, height, largest });
        }
        let samples = if smooth { 4 } else { 1 };
        let texture = |format, samples, usage, view_formats: &[wgpu::TextureFormat]| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("picture"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats,
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let usage = attachment | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
        let colors = texture(FORMAT, 1, usage, &[ENCODED]);
        let view = colors.create_view(&Default::default());
        let sampled = smooth.then(|| texture(FORMAT, samples, attachment, &[]).create_view(&Default::default()));
        let depth = texture(DEPTH, samples, attachment, &[]).create_view(&Default::default());
        gpu.check()?;
        Ok(Canvas { width, height, samples, texture: colors, view, sampled, depth, read_back: None })
    }

    /// Pixels in a row, and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Samples a pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// The picture for a user interface that takes its texels as they are stored (sRGB bytes taken for plain ones).
    pub fn encoded_view(&self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor { format: Some(ENCODED), ..Default::default() })
    }

    /// Reads the picture back. The image's memory is used again.
    ///
    /// # Errors
    /// The driver failed.
    pub fn read(&mut self, gpu: &Gpu, image: &mut Image) -> Result<(), ViewError> {
        let row = self.width * 4;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded) * u64::from(self.height);
        let limit = gpu.device.limits().max_buffer_size;
        if size > limit {
            return Err(ViewError::TooMuch { what: "the picture", needed: size, limit });
        }
        let buffer = self.read_back.get_or_insert_with(|| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("read back"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            })
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: Some(self.height) };
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer, layout },
            wgpu::Extent3d { width: self.width, height: self.height, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        let driver = |e: &dyn std::fmt::Display| ViewError::Driver(e.to_string());
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| driver(&e))?;
        gpu.check()?;
        receiver.recv().map_err(|e| driver(&e))?.map_err(|e| driver(&e))?;
        (image.width, image.height) = (self.width, self.height);
        image.rgba.clear();
        {
            let bytes = buffer.get_mapped_range(..).map_err(|e| driver(&e))?;
            bytes.chunks_exact(padded as usize).for_each(|r| image.rgba.extend_from_slice(&r[..row as usize]));
        }
        buffer.unmap();
        image.rgba.chunks_exact_mut(4).for_each(|p| p[3] = 255);
        Ok(())
    }
}
