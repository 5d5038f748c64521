// What a job is: one sample of one pixel; and what its ray met.
const float hitSky = 0.0, hitObject = 1.0, hitGround = 2.0;

/// Where sample `job.y` of the pixel lies: the R2 sequence (Roberts 2018), whose first point is the centre.
vec2 samplePosition(uvec2 job) {
    vec2 corner = vec2(float(job.x & 0xffffu), float(job.x >> 16));
    return corner + fract(vec2(0.5) + float(job.y) * vec2(0.7548776662, 0.5698402910));
}
