#version 330 core
// From the float targets to a picture: background, tint and outline of the selections, highlight. The same
// picture as shaded() in src/app/picture/frame_shading.cpp, with its names.
uniform sampler2D picture;
uniform sampler2D selected;  // rgb: colour of the selection, premultiplied with its share of the pixel
uniform sampler2D marked;    // shares of the pixel: r of selections, g of what is highlighted; b: r * number / 63
uniform vec3 background;
uniform float checker_px;        // side of a checker's squares in place of the background; 0: none
uniform float tint_strength;     // [0, 1]
uniform bool tint_shaded;        // the tint keeps the picture's light and dark
uniform float outline_strength;  // [0, 1]
uniform bool highlighted;
uniform vec3 highlight_colour;

out vec4 pixel;

const int kHighlight = 64;  // label of what is highlighted

// As the masks have it, a pixel is of an object or is not: faint Gaussians of it far away tint nothing.
int label_at(ivec2 p, bool of_highlight) {
  vec4 m = texelFetch(marked, p, 0);
  if (of_highlight) return m.g >= 0.5 ? kHighlight : 0;
  return m.r >= 0.5 ? int(63.0 * m.b / m.r + 0.5) : 0;
}

vec3 hue_at(ivec2 p) {
  float share = texelFetch(marked, p, 0).r;
  return share > 0.0 ? texelFetch(selected, p, 0).rgb / share : vec3(1.0);
}

// What the 5 x 5 pixels around one hold.
struct Around {
  bool any;      // the pixel or a neighbour has a label
  ivec2 owner;   // the pixel, or a neighbour that has one
  float inside;  // share of neighbours with the pixel's label, or with any, [0, 1]
  bool uniform_;  // all neighbours alike
};

Around around(ivec2 p, bool of_highlight) {
  ivec2 low = max(ivec2(0), p - 2), high = min(textureSize(marked, 0) - 1, p + 2);
  int centre = label_at(p, of_highlight);
  Around a = Around(centre != 0, p, 0.0, true);
  int labelled = 0, total = 0, same = 0;
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      int label = label_at(ivec2(x, y), of_highlight);
      ++total;
      if (label == centre) ++same;
      if (label == 0) continue;
      ++labelled;
      if (!a.any) a.owner = ivec2(x, y);
      a.any = true;
    }
  a.uniform_ = same == total;
  a.inside = float(centre != 0 ? same : labelled) / float(total);
  return a;
}

// 1 on the border between inside and outside, falling to 0 about 1.5 px away.
float border(float inside) {
  return clamp(1.0 - abs(inside - 0.5) / 0.32, 0.0, 1.0);
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
  if (!tint_shaded && tint_strength > 0.0)
    colour = mix(colour, hue_at(p), tint_strength * clamp(texelFetch(marked, p, 0).r, 0.0, 1.0));
  if ((tint_shaded && tint_strength > 0.0) || outline_strength > 0.0) {
    Around a = around(p, false);
    vec3 hue = hue_at(a.owner);
    if (tint_shaded) colour = mix(colour, shaded_tint(hue, colour), tint_strength * a.inside);
    if (!a.uniform_)
      colour = mix(colour, mix(hue, vec3(1.0), 0.35), outline_strength * border(a.inside));
  }
  if (highlighted) {
    Around a = around(p, true);
    colour = mix(colour, highlight_colour, a.uniform_ ? 0.14 * a.inside : 0.9 * border(a.inside));
  }
  pixel = vec4(colour, 1.0);
}
