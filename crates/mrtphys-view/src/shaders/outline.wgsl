// The outline of what a mask covers, in two passes: first each pixel's distance from the mask along its row, then from those
// the distance in the plane.

@group(1) @binding(0) var mask: texture_2d<f32>;

// Distances are stored in 255ths, up to this many pixels.
const FARTHEST = 255;

@vertex
fn everywhere(@builtin(vertex_index) number: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(number & 1u) * 4.0 - 1.0, f32(number >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn value(at: vec2<i32>) -> f32 {
    let last = vec2<i32>(textureDimensions(mask)) - 1;
    if any(at < vec2<i32>(0)) || any(at > last) {
        return -1.0;
    }
    return textureLoad(mask, at, 0).r;
}

// Width of the outline [pixels].
fn reach() -> f32 {
    return 4.2 * picture.size.z;
}

@fragment
fn along_row(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(place.xy);
    let most = min(i32(ceil(reach())) + 1, FARTHEST);
    var nearest = FARTHEST;
    for (var x = -most; x <= most; x++) {
        if value(at + vec2<i32>(x, 0)) > 0.5 {
            nearest = min(nearest, abs(x));
        }
    }
    return vec4<f32>(f32(nearest) / 255.0);
}

@fragment
fn outline(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(place.xy);
    let most = min(i32(ceil(reach())) + 1, FARTHEST);
    var nearest = 1e9;
    for (var y = -most; y <= most; y++) {
        let v = value(at + vec2<i32>(0, y));
        if v >= 0.0 {
            let x = round(v * 255.0);
            nearest = min(nearest, x * x + f32(y * y));
        }
    }
    // From the edge of the nearest covered pixel.
    let distance = sqrt(nearest) - 0.5;
    if distance < 0.0 || distance > reach() + 0.5 {
        discard;
    }
    // The accent between two bands of the paper's color: it stands out from any body and any background.
    let band = reach() * vec2<f32>(0.16, 0.78);
    let accent = clamp(distance - band.x + 0.5, 0.0, 1.0) * clamp(band.y - distance + 0.5, 0.0, 1.0);
    let cover = clamp(reach() - distance + 0.5, 0.0, 1.0);
    return vec4<f32>(mix(picture.paper.rgb, picture.accent.rgb, accent), cover * mix(0.85, 1.0, accent));
}
