//! The graphics driver.

use crate::error::ViewError;
use std::sync::{Arc, Mutex, PoisonError};

/// A device to draw with.
pub struct Gpu {
    /// the device
    pub device: wgpu::Device,
    /// its queue
    pub queue: wgpu::Queue,
    /// the driver's name, for people
    pub name: String,
    /// whether the driver is software: pictures are then drawn with less detail unless asked for
    pub is_software: bool,
    /// the first error that no call returned
    failed: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// A device without a window: the most powerful there is, or as the environment says (`WGPU_BACKEND`).
    ///
    /// # Errors
    /// There is no driver, or it refuses.
    pub fn without_window() -> Result<Gpu, ViewError> {
        let adapter = adapter()?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("mrtphys"),
            // What the driver can do: many bodies need large buffers.
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| ViewError::NoDevice { driver: info.name.clone(), why: e.to_string() })?;
        Ok(Gpu::new(device, queue, &info))
    }

    /// A device that exists already: a window's. Errors of the device that no call returns are collected from now on.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue, info: &wgpu::AdapterInfo) -> Gpu {
        let failed: Arc<Mutex<Option<String>>> = Arc::default();
        let note = failed.clone();
        let first = move |text: String| {
            note.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
        };
        let lost = first.clone();
        device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| first(e.to_string())));
        device.set_device_lost_callback(move |reason, text| {
            // Dropping the device is no failure.
            if reason != wgpu::DeviceLostReason::Destroyed {
                lost(format!("the device was lost: {text}"));
            }
        });
        let name = format!("{} ({:?})", info.name, info.backend);
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        Gpu { device, queue, name, is_software, failed }
    }

    /// What has gone wrong since the last call.
    pub(crate) fn check(&self) -> Result<(), ViewError> {
        let failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner).take();
        failed.map_or(Ok(()), |text| Err(ViewError::Driver(text)))
    }
}

/// OpenGL is tried last: its libraries complain on stderr where there is no display.
///
/// Under Linux Mesa's Vulkan layer `VK_LAYER_MESA_device_select` looks for a Wayland display whenever devices are listed, and
/// libwayland then writes "XDG_RUNTIME_DIR is invalid or not set" where that variable is missing. It does no harm. Only the
/// environment keeps the layer away (`NODEVICE_SELECT=1`), and a program cannot safely change its own once threads may run.
fn adapter() -> Result<wgpu::Adapter, ViewError> {
    let mut why = String::new();
    for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::SECONDARY] {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = backends;
        let instance = wgpu::Instance::new(descriptor.with_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        match pollster::block_on(instance.request_adapter(&options)) {
            Ok(adapter) => return Ok(adapter),
            Err(e) => why = e.to_string().replace('\n', " "),
        }
    }
    Err(ViewError::NoAdapter(why))
}

/// A buffer that grows: kept from picture to picture.
pub struct Growing {
    buffer: Option<wgpu::Buffer>,
    usage: wgpu::BufferUsages,
    what: &'static str,
}

impl Growing {
    /// Nothing yet.
    pub fn new(what: &'static str, usage: wgpu::BufferUsages) -> Growing {
        Growing { buffer: None, usage: usage | wgpu::BufferUsages::COPY_DST, what }
    }

    /// Puts bytes into the buffer; it grows by half where they do not fit.
    pub fn put(&mut self, gpu: &Gpu, bytes: &[u8]) -> Result<(), ViewError> {
        let needed = bytes.len() as u64;
        let limit = gpu.device.limits().max_buffer_size;
        if needed > limit {
            return Err(ViewError::TooMuch { what: self.what, needed, limit });
        }
        if self.buffer.as_ref().is_none_or(|b| b.size() < needed) {
            let size = (needed + needed / 2).clamp(1024, limit.max(1024)).next_multiple_of(4).min(limit);
            let descriptor =
                wgpu::BufferDescriptor { label: Some(self.what), size, usage: self.usage, mapped_at_creation: false };
            self.buffer = Some(gpu.device.create_buffer(&descriptor));
        }
        if let Some(buffer) = self.buffer.as_ref().filter(|_| needed > 0) {
            gpu.queue.write_buffer(buffer, 0, bytes);
        }
        Ok(())
    }

    /// The buffer, where something was put into it.
    pub fn get(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }
}
