// How much of the first lamp reaches a point.

@group(1) @binding(0) var shadow_map: texture_depth_2d;
@group(1) @binding(1) var shadow_sampler: sampler_comparison;

fn lit(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    if picture.counts.y < 0.5 {
        return 1.0;
    }
    // Off the surface by the slant of a texel, so that no surface shades itself.
    let slant = 1.0 - max(dot(normal, picture.lamps[0].direction.xyz), 0.0);
    let off = position + normal * picture.size.w * (0.7 + 1.8 * slant);
    let at = picture.shadow * vec4<f32>(off, 1.0);
    let uv = vec2<f32>(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y);
    let texel = picture.counts.z;
    // What is behind all bodies is in their shadow as well: the map holds no such depth, but who is before it.
    let depth = min(at.z, 1.0);
    // Four taps of the sampler's own four: a soft edge about three texels wide.
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let d = vec2<f32>(f32(i & 1) - 0.5, f32(i >> 1) - 0.5) * 1.5;
        sum += textureSampleCompareLevel(shadow_map, shadow_sampler, uv + d * texel, depth);
    }
    let inside = all(uv >= vec2<f32>(0.0)) && all(uv <= vec2<f32>(1.0)) && at.z >= 0.0;
    return select(1.0, sum * 0.25, inside);
}
