// Bodies: flat, Gouraud, Phong, and the plain faces of hidden-line drawings.

struct Corner {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // of the body
    @location(2) place: vec4<f32>, // position, scale
    @location(3) rotation: vec4<f32>,
    @location(4) color: vec4<f32>,
    @location(6) marks: f32,
}

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
    @location(3) on_body: vec4<f32>, // in the body's own axes; and 1 where it bears marks
}

fn placed(in: Corner) -> Surface {
    var out: Surface;
    out.position = in.place.xyz + in.place.w * rotate(in.rotation, in.position);
    out.normal = rotate(in.rotation, in.normal);
    out.clip = picture.projection * vec4<f32>(out.position, 1.0);
    out.color = vec4<f32>(to_light(in.color.rgb), in.color.a);
    out.on_body = vec4<f32>(in.position, in.marks);
    return out;
}

// How bright a sphere is at a place for its marks, by which one sees it spin: three great circles, one of them wider, and
// octants by turns a little darker. They fade where the sphere is small in the picture.
fn mark(on_body: vec4<f32>) -> f32 {
    let p = normalize(on_body.xyz);
    let pixel = max(fwidth(p), vec3<f32>(1e-6));
    let width = vec3<f32>(0.022, 0.022, 0.055);
    let lines = clamp((width - abs(p)) / pixel + 0.5, vec3<f32>(0.0), vec3<f32>(1.0));
    let line = max(lines.x, max(lines.y, lines.z));
    let side = clamp(p / pixel, vec3<f32>(-1.0), vec3<f32>(1.0));
    let octant = side.x * side.y * side.z;
    let size = max(pixel.x, max(pixel.y, pixel.z));
    let seen = on_body.w * (1.0 - smoothstep(0.06, 0.2, size));
    return 1.0 - seen * (0.45 * line + 0.11 * (1.0 + octant) * (1.0 - line));
}

@vertex
fn corner(in: Corner) -> Surface {
    return placed(in);
}

fn shaded(position: vec3<f32>, normal: vec3<f32>, color: vec4<f32>) -> vec4<f32> {
    let toward_eye = normalize(picture.eye.xyz - position);
    var light = vec4<f32>(ambient(normal), 0.0);
    for (var i = 0u; i < u32(picture.counts.x); i++) {
        var one = from_lamp(i, normal, toward_eye);
        if i == 0u && one.r > 0.0 {
            one *= lit(position, normal);
        }
        light += one;
    }
    // The sky is seen in what is seen at a flat angle (Schlick 1994).
    let grazing = pow(1.0 - max(dot(normal, toward_eye), 0.0), 5.0) * 0.10;
    let sky = select(0.0, grazing, shines()) * max(0.0, 0.5 + 0.5 * dot(normal, picture.up.xyz));
    return vec4<f32>(color.rgb * light.rgb + vec3<f32>(light.a + sky), color.a);
}

@fragment
fn phong(in: Surface) -> @location(0) vec4<f32> {
    let color = vec4<f32>(in.color.rgb * mark(in.on_body), in.color.a);
    return shaded(in.position, normalize(in.normal), color);
}

@fragment
fn flat_shaded(in: Surface) -> @location(0) vec4<f32> {
    // The normal of the triangle itself, towards the eye.
    let across = cross(dpdx(in.position), dpdy(in.position));
    let n = normalize(across);
    let toward_eye = picture.eye.xyz - in.position;
    let color = vec4<f32>(in.color.rgb * mark(in.on_body), in.color.a);
    return shaded(in.position, select(-n, n, dot(n, toward_eye) > 0.0), color);
}

@fragment
fn plain(in: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(picture.paper.rgb, 1.0);
}

// Where an outlined body is.
@fragment
fn covered(in: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(1.0);
}

struct Interpolated {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,  // without the first lamp
    @location(3) direct: vec4<f32>, // of the first lamp, which a shadow may take away
    @location(4) on_body: vec4<f32>,
}

@vertex
fn gouraud_corner(in: Corner) -> Interpolated {
    let s = placed(in);
    let toward_eye = normalize(picture.eye.xyz - s.position);
    var light = vec4<f32>(ambient(s.normal), 0.0);
    for (var i = 1u; i < u32(picture.counts.x); i++) {
        light += from_lamp(i, s.normal, toward_eye);
    }
    var first = vec4<f32>(0.0);
    if picture.counts.x > 0.5 {
        first = from_lamp(0u, s.normal, toward_eye);
    }
    var out: Interpolated;
    out.clip = s.clip;
    out.position = s.position;
    out.normal = s.normal;
    out.color = vec4<f32>(s.color.rgb * light.rgb + vec3<f32>(light.a), s.color.a);
    out.on_body = s.on_body;
    out.direct = vec4<f32>(s.color.rgb * first.rgb + vec3<f32>(first.a), 0.0);
    return out;
}

@fragment
fn gouraud(in: Interpolated) -> @location(0) vec4<f32> {
    let color = in.color + in.direct * lit(in.position, normalize(in.normal));
    return vec4<f32>(color.rgb * mark(in.on_body), color.a);
}
