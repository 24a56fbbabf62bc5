//! The `mrtphys` program.

mod cli;
mod choices;
mod exit;
mod interrupt;

mod setup;
mod plan;
mod run;
mod progress;

mod output;
mod binary;
mod cast;
mod report;
mod json;
mod events;
mod trajectory;
mod summary;

mod render_args;
#[cfg(feature = "view")]
mod render;
#[cfg(not(feature = "view"))]
#[path = "render_none.rs"]
mod render;

#[cfg(feature = "testbed")]
mod testbed;
#[cfg(not(feature = "testbed"))]
#[path = "testbed_none.rs"]
mod testbed;

mod check;
mod list;
mod bench;
mod experiment;

fn main() -> std::process::ExitCode {
    keep_wayland_out();
    cli::main()
}

/// Mesa's Vulkan layer `VK_LAYER_MESA_device_select` looks for a Wayland display whenever devices are listed, and libwayland
/// then complains on stderr where `XDG_RUNTIME_DIR` is missing. Without that variable there is no such display, and nothing to
/// select by it: the layer is kept away, unless the user has said something about it.
fn keep_wayland_out() {
    const LAYER: &str = "NODEVICE_SELECT";
    let unset = |name: &str| std::env::var_os(name).is_none();
    if cfg!(target_os = "linux") && unset("XDG_RUNTIME_DIR") && unset(LAYER) {
        // SAFETY: this is the first thing that the program does: no other thread runs that could read the environment.
        unsafe { std::env::set_var(LAYER, "1") };
    }
}
