#version 330 core
uniform sampler2D image;
in vec2 fragment_uv;
in vec4 fragment_colour;
out vec4 pixel;

void main() { pixel = fragment_colour * texture(image, fragment_uv); }
