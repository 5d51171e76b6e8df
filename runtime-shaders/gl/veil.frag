// Depth in front of everything for the pixels that a picture wants no further sample of.
uniform highp sampler2D wanted;  // one texel per pixel of the picture: 0 where it wants none
uniform int across;              // texels of the target on each side of a pixel
uniform vec2 first_pixel;        // of the picture, in the target's corner
layout(location = 0) out vec4 color;

void main() {
    if (texelFetch(wanted, ivec2(gl_FragCoord.xy) / across + ivec2(first_pixel), 0).x != 0.0) discard;
    gl_FragDepth = 0.0;
    color = vec4(0.0);
}
