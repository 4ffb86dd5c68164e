#version 330 core
// One Gaussian as a screen-aligned box: the maths of src/scene/raster/splat_math.cpp, with its names.
// Four vertices per Gaussian; the k-th quad drawn is the k-th Gaussian from the back.
uniform usamplerBuffer order;        // back to front: index of the Gaussian
uniform samplerBuffer geometry;      // 3 texels: position, opacity | Sigma xx xy xz yy | Sigma yz zz, -, -
uniform samplerBuffer colours;       // sh_texels texels: f_dc and the SH coefficients, rgb interleaved
uniform samplerBuffer styles;        // SplatStyle: rgb: colour of its selection, a: bits
uniform int sh_degree;
uniform int sh_texels;
uniform mat3 camera_from_world_rotation;
uniform vec3 camera_from_world_translation;
uniform vec3 eye_world;
uniform vec2 focal_px;
uniform vec2 principal_px;
uniform vec2 size_px;
uniform float near_plane;
uniform float far_plane;
uniform float low_pass_px2;
uniform bool antialiased;

const float kAlphaMin = 1.0 / 255.0;
const float kFrustumSlack = 1.3;
const float kShC0 = 0.28209479177387814;

flat out vec3 conic;
flat out vec3 colour;
flat out float opacity;
flat out vec3 selection;
flat out vec3 mark;  // 1 where it belongs to a selection, 1 where it is highlighted, number of the selection
flat out vec2 mean_px;

const float kShC1 = 0.4886025119029199;
const float kShC2[5] = float[](1.0925484305920792, -1.0925484305920792, 0.31539156525252005, -1.0925484305920792,
                               0.5462742152960396);
const float kShC3[7] = float[](-0.5900435899266435, 2.890611442640554, -0.4570457994644658, 0.3731763325901154,
                               -0.4570457994644658, 1.445305721320277, -0.5900435899266435);

// Coefficient k of the three channels, packed three floats after three floats.
vec3 coefficient(int g, int k) {
  int first = g * sh_texels * 4 + 3 * k;
  vec3 value;
  for (int c = 0; c < 3; ++c) value[c] = texelFetch(colours, (first + c) / 4)[(first + c) % 4];
  return value;
}

vec3 sh_colour(int g, vec3 direction_world) {
  vec3 sum = 0.5 + kShC0 * coefficient(g, 0);
  float x = direction_world.x, y = direction_world.y, z = direction_world.z;
  if (sh_degree >= 1)
    sum += -kShC1 * y * coefficient(g, 1) + kShC1 * z * coefficient(g, 2) - kShC1 * x * coefficient(g, 3);
  float xx = x * x, yy = y * y, zz = z * z;
  if (sh_degree >= 2)
    sum += kShC2[0] * x * y * coefficient(g, 4) + kShC2[1] * y * z * coefficient(g, 5) +
           kShC2[2] * (2.0 * zz - xx - yy) * coefficient(g, 6) + kShC2[3] * x * z * coefficient(g, 7) +
           kShC2[4] * (xx - yy) * coefficient(g, 8);
  if (sh_degree >= 3)
    sum += kShC3[0] * y * (3.0 * xx - yy) * coefficient(g, 9) + kShC3[1] * x * y * z * coefficient(g, 10) +
           kShC3[2] * y * (4.0 * zz - xx - yy) * coefficient(g, 11) +
           kShC3[3] * z * (2.0 * zz - 3.0 * xx - 3.0 * yy) * coefficient(g, 12) +
           kShC3[4] * x * (4.0 * zz - xx - yy) * coefficient(g, 13) + kShC3[5] * z * (xx - yy) * coefficient(g, 14) +
           kShC3[6] * x * (xx - 3.0 * yy) * coefficient(g, 15);
  return max(sum, 0.0);
}

vec3 covariance_px2(vec3 point_camera, mat3 sigma_world) {
  float z = point_camera.z;
  vec2 limit = kFrustumSlack * 0.5 * size_px / focal_px;
  vec2 xy = clamp(point_camera.xy / z, -limit, limit) * z;
  vec3 jacobian_u = vec3(focal_px.x / z, 0.0, -focal_px.x * xy.x / (z * z));
  vec3 jacobian_v = vec3(0.0, focal_px.y / z, -focal_px.y * xy.y / (z * z));
  mat3 world_from_camera = transpose(camera_from_world_rotation);
  vec3 u = world_from_camera * jacobian_u, v = world_from_camera * jacobian_v;
  vec3 sigma_u = sigma_world * u, sigma_v = sigma_world * v;
  return vec3(dot(u, sigma_u), dot(u, sigma_v), dot(v, sigma_v));
}

float antialiased_share(vec3 sharp, vec3 blurred) {
  float det_sharp = sharp.x * sharp.z - sharp.y * sharp.y;
  float det_blurred = blurred.x * blurred.z - blurred.y * blurred.y;
  return sqrt(max(det_sharp, 0.0) / det_blurred);
}

void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside: nothing is drawn
  conic = colour = selection = mark = vec3(0.0);
  opacity = 0.0;
  mean_px = vec2(0.0);
  int g = int(texelFetch(order, gl_VertexID / 4).r);
  vec4 style = texelFetch(styles, g);
  int bits = int(255.0 * style.a + 0.5), number = bits >> 2;
  vec4 point = texelFetch(geometry, 3 * g);
  vec4 sigma0 = texelFetch(geometry, 3 * g + 1);
  vec4 sigma1 = texelFetch(geometry, 3 * g + 2);
  vec3 point_camera = camera_from_world_rotation * point.xyz + camera_from_world_translation;
  if ((bits & 1) == 0 || point.w < kAlphaMin || !(point_camera.z >= near_plane) || point_camera.z > far_plane) return;
  mat3 sigma_world = mat3(sigma0.x, sigma0.y, sigma0.z, sigma0.y, sigma0.w, sigma1.x, sigma0.z, sigma1.x, sigma1.y);
  vec3 sharp = covariance_px2(point_camera, sigma_world);
  vec3 s = sharp + vec3(low_pass_px2, 0.0, low_pass_px2);
  float det = s.x * s.z - s.y * s.y;
  if (!(det > 0.0) || isinf(det)) return;
  opacity = antialiased ? point.w * antialiased_share(sharp, s) : point.w;
  if (opacity < kAlphaMin) return;
  mean_px = focal_px * point_camera.xy / point_camera.z + principal_px;
  conic = vec3(s.z, -s.y, s.x) / det;
  vec2 extent_px = sqrt(2.0 * log(opacity / kAlphaMin) * s.xz);
  if (any(lessThan(mean_px + extent_px, vec2(0.0))) || any(greaterThan(mean_px - extent_px, size_px))) return;
  selection = number > 0 ? style.rgb : vec3(0.0);
  mark = vec3(number > 0 ? 1.0 : 0.0, (bits & 2) != 0 ? 1.0 : 0.0, float(number) / 63.0);
  colour = sh_colour(g, normalize(point.xyz - eye_world));
  vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
  vec2 pixel = mean_px + corner * extent_px;
  gl_Position = vec4(2.0 * pixel / size_px - 1.0, 0.0, 1.0);  // row 0 of the target is the picture's top
}
