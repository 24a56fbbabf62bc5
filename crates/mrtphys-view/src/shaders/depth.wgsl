// What the first lamp sees.

@vertex
fn shadow_corner(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) place: vec4<f32>,
    @location(3) rotation: vec4<f32>,
) -> @builtin(position) vec4<f32> {
    return picture.shadow * vec4<f32>(place.xyz + place.w * rotate(rotation, position), 1.0);
}
