// Boundaries, and the faces of translucent boxes.

struct Face {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
    @location(3) on_face: vec2<f32>, // -1 to 1 from edge to edge
    @location(4) grid: vec2<f32>,    // in widths of the grid
    @location(5) @interpolate(flat) kind: vec2<f32>, // 1: fades out; 1: takes shadows
}

@vertex
fn wall(
    @builtin(vertex_index) number: u32,
    @location(0) p0: vec4<f32>, // and 1: fades out
    @location(1) p1: vec4<f32>, // and 1: takes shadows
    @location(2) p2: vec4<f32>, // and the width of the grid
    @location(3) p3: vec4<f32>,
    @location(4) color: vec4<f32>,
) -> Face {
    let right = (number & 1u) == 1u;
    let top = (number & 2u) == 2u;
    let at = select(select(p0.xyz, p1.xyz, right), select(p3.xyz, p2.xyz, right), top);
    let u = normalize(p1.xyz - p0.xyz);
    let n = normalize(cross(p1.xyz - p0.xyz, p2.xyz - p0.xyz));
    let middle = 0.5 * (p0.xyz + p2.xyz);
    let d = at - middle;
    var out: Face;
    out.position = at;
    out.normal = n;
    out.clip = picture.projection * vec4<f32>(at, 1.0);
    out.color = vec4<f32>(to_light(color.rgb), color.a);
    out.on_face = vec2<f32>(select(-1.0, 1.0, right), select(-1.0, 1.0, top));
    out.grid = vec2<f32>(dot(d, u), dot(d, cross(n, u))) / max(p2.w, 1e-20);
    out.kind = vec2<f32>(p0.w, p1.w);
    return out;
}

@fragment
fn face(in: Face) -> @location(0) vec4<f32> {
    var color = in.color;
    // Lines of the grid, a pixel wide, fainter where they crowd.
    let step = max(fwidth(in.grid), vec2<f32>(1e-6));
    let off = abs(fract(in.grid - 0.5) - 0.5) / step;
    let line = clamp(1.0 - min(off.x, off.y), 0.0, 1.0) * clamp(0.5 / max(step.x, step.y) - 1.0, 0.0, 1.0);
    if in.kind.x > 0.5 {
        let fade = 1.0 - smoothstep(0.35, 1.0, length(in.on_face));
        color = vec4<f32>(mix(color.rgb, picture.ink.rgb, 0.34 * line), color.a * fade);
        color.a = max(color.a, 0.45 * line * fade);
    }
    if in.kind.y > 0.5 {
        let facing = dot(in.normal, picture.lamps[0].direction.xyz);
        // A little light and shade, so that the floor and the walls are told apart.
        color = vec4<f32>(color.rgb * select(0.80 + 0.22 * max(facing, 0.0), 0.93, picture.counts.w < LAMBERT), color.a);
        let shade = (1.0 - lit(in.position, in.normal)) * smoothstep(0.0, 0.35, facing);
        let dark = 0.42 * shade * select(1.0, 1.0 - smoothstep(0.35, 1.0, length(in.on_face)), in.kind.x > 0.5);
        // A shadow is seen even on a face that is hardly there.
        let a = 1.0 - (1.0 - color.a) * (1.0 - dark);
        color = vec4<f32>(color.rgb * color.a * (1.0 - dark) / max(a, 1e-4), a);
    }
    return color;
}
