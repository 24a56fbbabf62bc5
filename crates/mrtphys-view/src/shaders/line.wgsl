// Lines of the same width at any distance, with round ends; a line of no length is a dot. Edges are smoothed by opacity.

struct Stroke {
    @builtin(position) clip: vec4<f32>,
    @location(0) color: vec4<f32>,
    // in pixels: from the middle of the line, across and along
    @location(1) across: f32,
    @location(2) along: f32,
    @location(3) @interpolate(flat) half_length: f32,
    @location(4) @interpolate(flat) half_width: f32,
}

// Corner `number` (0 to 3) of the stroke between two points.
fn stroke(number: u32, start: vec3<f32>, end: vec3<f32>, width: f32, color: vec4<f32>, nearer: f32) -> Stroke {
    var a = picture.projection * vec4<f32>(start, 1.0);
    var b = picture.projection * vec4<f32>(end, 1.0);
    var out: Stroke;
    // Cut off what is behind the near plane: depth z is constant there, distance w is not.
    let near = a.z;
    if a.w < near && b.w < near {
        out.clip = vec4<f32>(2.0, 2.0, 2.0, 1.0);
        return out;
    }
    if a.w < near {
        a = mix(a, b, (near - a.w) / (b.w - a.w));
    } else if b.w < near {
        b = mix(b, a, (near - b.w) / (a.w - b.w));
    }
    let half_size = 0.5 * picture.size.xy;
    let pa = a.xy / a.w * half_size;
    let pb = b.xy / b.w * half_size;
    let length = distance(pa, pb);
    let along = select(vec2<f32>(1.0, 0.0), (pb - pa) / max(length, 1e-6), length > 1e-6);
    let across = vec2<f32>(-along.y, along.x);
    // A line thinner than a pixel is a pixel wide and fainter.
    let drawn = max(width, 1.0);
    let faint = width / drawn;
    let margin = 0.5 * drawn + 1.0;
    let far_end = (number & 1u) == 1u;
    let side = select(-1.0, 1.0, (number & 2u) == 2u);
    let tip = select(-1.0, 1.0, far_end);
    let from_pixel = select(pa, pb, far_end) + (along * tip + across * side) * margin;
    let w = select(a.w, b.w, far_end);
    // Divided here: what follows is then interpolated along the picture, not along the line.
    out.clip = vec4<f32>(from_pixel / half_size, near / w * nearer, 1.0);
    out.color = vec4<f32>(color.rgb, color.a * faint);
    out.across = side * margin;
    out.along = tip * (0.5 * length + margin);
    out.half_length = 0.5 * length;
    out.half_width = 0.5 * drawn;
    return out;
}

@fragment
fn ink(in: Stroke) -> @location(0) vec4<f32> {
    let beyond = max(abs(in.along) - in.half_length, 0.0);
    let off = length(vec2<f32>(in.across, beyond));
    let cover = clamp(in.half_width + 0.5 - off, 0.0, 1.0);
    if cover <= 0.0 {
        discard;
    }
    return vec4<f32>(in.color.rgb, in.color.a * cover);
}

// Where an outlined body's edges are: a plate seen from its edge has nothing else.
@fragment
fn covered(in: Stroke) -> @location(0) vec4<f32> {
    if length(vec2<f32>(in.across, max(abs(in.along) - in.half_length, 0.0))) > 0.75 {
        discard;
    }
    return vec4<f32>(1.0);
}

@vertex
fn line(
    @builtin(vertex_index) number: u32,
    @location(0) start: vec4<f32>, // and width
    @location(1) end: vec3<f32>,
    @location(2) color: vec4<f32>,
) -> Stroke {
    return stroke(number, start.xyz, end, start.w, vec4<f32>(to_light(color.rgb), color.a), 1.0004);
}

fn brightness(c: vec3<f32>) -> f32 {
    return dot(c, vec3<f32>(0.2126, 0.7152, 0.0722));
}

// An edge of a body.
@vertex
fn edge(
    @location(0) start: vec3<f32>,
    @location(1) end: vec3<f32>,
    @location(5) number: u32,
    @location(2) place: vec4<f32>,
    @location(3) rotation: vec4<f32>,
    @location(4) color: vec4<f32>,
) -> Stroke {
    let a = place.xyz + place.w * rotate(rotation, start);
    let b = place.xyz + place.w * rotate(rotation, end);
    let light = to_light(color.rgb);
    // Colors close to the paper's are inked: white on white would not be seen.
    let contrast = abs(sqrt(brightness(light)) - sqrt(brightness(picture.paper.rgb)));
    let rgb = mix(light, picture.ink.rgb, 0.10 + 0.55 * (1.0 - smoothstep(0.05, 0.5, contrast)));
    return stroke(number, a, b, picture.size.z, vec4<f32>(rgb, color.a), 1.0004);
}
