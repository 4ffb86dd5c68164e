#version 330 core
// From the float target to a picture: background, tint of the selection, its outline.
uniform sampler2D picture;
uniform sampler2D selected;
uniform vec3 background;
uniform float checker_px;        // side of a checker's squares in place of the background; 0: none
uniform float tint_strength;     // [0, 1]
uniform bool tint_shaded;        // the tint keeps the picture's light and dark
uniform float outline_strength;  // [0, 1]

out vec4 pixel;

float strength(ivec2 p) {
  vec3 s = texelFetch(selected, clamp(p, ivec2(0), textureSize(selected, 0) - 1), 0).rgb;
  return max(s.r, max(s.g, s.b));
}

// The hue as bright as the picture, but never dark: an orange tint on blue is orange, not brown.
vec3 shaded_tint(vec3 hue, vec3 colour) {
  return hue * (0.7 + 0.5 * dot(colour, vec3(0.299, 0.587, 0.114)));
}

// As checker_colour() has it.
vec3 behind(ivec2 p) {
  if (checker_px == 0.0) return background;
  ivec2 square = ivec2((vec2(p) + 0.5) / checker_px);
  return vec3((square.x + square.y) % 2 == 0 ? 0.62 : 0.42);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 premultiplied = texelFetch(picture, p, 0);
  vec3 colour = premultiplied.rgb + (1.0 - premultiplied.a) * behind(p);
  vec3 selection = texelFetch(selected, p, 0).rgb;
  float here = strength(p);
  vec3 hue = here > 0.0 ? selection / here : vec3(1.0);
  // As the masks have it, a pixel is of the object or is not: faint Gaussians of it far away tint nothing.
  float share = tint_shaded ? smoothstep(0.4, 0.6, here) : clamp(here, 0.0, 1.0);
  colour = mix(colour, tint_shaded ? shaded_tint(hue, colour) : hue, tint_strength * share);
  float inside = step(0.5, here), border = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) border = max(border, abs(inside - step(0.5, strength(p + ivec2(x, y)))));
  vec3 line = here >= 0.5 ? hue : vec3(0.0);
  pixel = vec4(mix(colour, line, outline_strength * border), 1.0);
}
