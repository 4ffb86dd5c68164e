#version 330 core
// Triangles of the user interface, in logical points from the top left.
uniform vec2 size_points;
layout(location = 0) in vec2 position_points;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
out vec2 fragment_uv;
out vec4 fragment_colour;

void main() {
  fragment_uv = uv;
  fragment_colour = colour;
  gl_Position = vec4(2.0 * position_points.x / size_points.x - 1.0, 1.0 - 2.0 * position_points.y / size_points.y, 0.0, 1.0);
}
