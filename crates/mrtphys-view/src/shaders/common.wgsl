// What all shaders share. Coordinates are the frame's drawing coordinates; colors are light (linear), not sRGB.

struct Lamp {
    direction: vec4<f32>, // toward the light, unit
    color: vec4<f32>,
}

struct Picture {
    projection: mat4x4<f32>,
    shadow: mat4x4<f32>,  // drawing coordinates -> the shadow map's clip coordinates
    eye: vec4<f32>,
    up: vec4<f32>,
    size: vec4<f32>,      // width, height [pixels], width of lines [pixels], size of a shadow texel in drawing units
    counts: vec4<f32>,    // lamps, 1 with shadows, 1/size of the shadow map [texels], lighting equation
    sky: vec4<f32>,
    base: vec4<f32>,
    ink: vec4<f32>,
    paper: vec4<f32>,
    accent: vec4<f32>,
    lamps: array<Lamp, 4>,
}

@group(0) @binding(0) var<uniform> picture: Picture;

fn rotate(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

fn to_light(srgb: vec3<f32>) -> vec3<f32> {
    let low = srgb / 12.92;
    let high = pow((srgb + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, low, srgb <= vec3<f32>(0.04045));
}

// The lighting equation's numbers, as `Illumination` has them.
const LAMBERT = 1.0;
const PHONG = 2.0;

// Light from above and from below, without a source. Alone it is stronger: no lamp adds to it.
fn ambient(normal: vec3<f32>) -> vec3<f32> {
    let above = vec3<f32>(0.40, 0.43, 0.47);
    let below = vec3<f32>(0.17, 0.16, 0.15);
    let alone = select(1.0, 1.9, picture.counts.w < LAMBERT);
    return mix(below, above, 0.5 + 0.5 * dot(normal, picture.up.xyz)) * alone;
}

// Whether surfaces have highlights.
fn shines() -> bool {
    return picture.counts.w >= PHONG;
}

// Diffuse (Lambert) in rgb, highlight in a, of lamp i.
fn from_lamp(i: u32, normal: vec3<f32>, toward_eye: vec3<f32>) -> vec4<f32> {
    let lamp = picture.lamps[i];
    let facing = dot(normal, lamp.direction.xyz);
    let diffuse = max(facing, 0.0);
    var shine = 0.0;
    if picture.counts.w > PHONG {
        // Blinn 1977: the normal against half-way between lamp and eye.
        let middle = normalize(lamp.direction.xyz + toward_eye);
        shine = pow(max(dot(normal, middle), 0.0), 48.0);
    } else if shines() {
        // Phong 1975: the eye against the mirrored ray, at twice the angle: a quarter of the exponent is as sharp.
        let mirrored = 2.0 * facing * normal - lamp.direction.xyz;
        shine = pow(max(dot(mirrored, toward_eye), 0.0), 12.0);
    }
    shine *= smoothstep(0.0, 0.2, facing);
    return vec4<f32>(lamp.color.rgb * diffuse, shine * 0.22 * lamp.color.g);
}
