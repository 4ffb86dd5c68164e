#version 330 core
// alpha(p) = min(0.99, opacity exp(-1/2 d^T Sigma2^-1 d)); premultiplied, blended back to front.
flat in vec3 conic;
flat in vec3 colour;
flat in float opacity;
flat in vec3 selection;
flat in vec3 mark;
flat in vec2 mean_px;

layout(location = 0) out vec4 picture;
layout(location = 1) out vec4 selected;
layout(location = 2) out vec4 marked;

const float kAlphaMin = 1.0 / 255.0;
const float kAlphaMax = 0.99;

void main() {
  vec2 d = gl_FragCoord.xy - mean_px;
  float power = -0.5 * (conic.x * d.x * d.x + 2.0 * conic.y * d.x * d.y + conic.z * d.y * d.y);
  float alpha = min(kAlphaMax, opacity * exp(power));
  if (alpha < kAlphaMin) discard;
  picture = vec4(colour * alpha, alpha);
  selected = vec4(selection * alpha, alpha);
  marked = vec4(mark * alpha, alpha);
}
