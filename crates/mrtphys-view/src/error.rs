//! What can go wrong with a picture.

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// No graphics driver, not even one in software.
    #[error(
        "no graphics driver was found ({0}); a driver in software needs no graphics card: on Debian and Ubuntu \
         'apt install libvulkan1 mesa-vulkan-drivers'"
    )]
    NoAdapter(String),
    /// The driver refused to start.
    #[error("the graphics driver '{driver}' cannot be used: {why}")]
    NoDevice {
        /// its name
        driver: String,
        /// what it said
        why: String,
    },
    /// A picture of this size cannot be drawn.
    #[error("a picture of {width} x {height} pixels cannot be drawn here: 1 x 1 to {largest} x {largest} can")]
    Size {
        /// pixels
        width: u32,
        /// pixels
        height: u32,
        /// largest width and height \[pixels\]
        largest: u32,
    },
    /// More to draw than fits into a buffer of the driver.
    #[error("{what}: {needed} bytes are more than the {limit} that the graphics driver can hold")]
    TooMuch {
        /// what there is too much of
        what: &'static str,
        /// bytes
        needed: u64,
        /// bytes
        limit: u64,
    },
    /// The driver gave way while drawing.
    #[error("the graphics driver failed: {0}")]
    Driver(String),
    /// A film cannot be made like this.
    #[error("{0}")]
    Film(String),
    /// A file could not be written.
    #[error("{0}")]
    Write(#[from] std::io::Error),
}
