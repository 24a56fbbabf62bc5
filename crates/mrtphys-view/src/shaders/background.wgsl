// From the sky at the upper edge to the base at the lower.

struct Sky {
    @builtin(position) clip: vec4<f32>,
    @location(0) height: f32,
}

@vertex
fn everywhere(@builtin(vertex_index) number: u32) -> Sky {
    let x = f32(number & 1u) * 4.0 - 1.0;
    let y = f32(number >> 1u) * 4.0 - 1.0;
    var out: Sky;
    out.clip = vec4<f32>(x, y, 0.0, 1.0);
    out.height = 0.5 + 0.5 * y;
    return out;
}

@fragment
fn sky(in: Sky) -> @location(0) vec4<f32> {
    let color = mix(picture.base.rgb, picture.sky.rgb, smoothstep(0.0, 1.0, in.height));
    return vec4<f32>(color, 1.0);
}
