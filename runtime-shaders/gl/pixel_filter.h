// How surface.frag filters a pixel: its uniform pixel_filter. Valid C++ and valid GLSL.
//
// RAYS: side x side rays. REGIONS: as a whole, and by rays only where that does not suffice. MARKED: as REGIONS without the
// rays; alpha names the quarters that want them, a bit each. QUARTERS: one ray, at ray_place, where `wanted` has the bit of
// the quarter that it lies in. The last two are one picture in several passes.
#ifndef BURIN_PIXEL_FILTER_H
#define BURIN_PIXEL_FILTER_H

#define FILTER_RAYS 0
#define FILTER_REGIONS 1
#define FILTER_MARKED 2
#define FILTER_QUARTERS 3

#endif
