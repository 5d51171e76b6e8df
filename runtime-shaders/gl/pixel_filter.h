// How surface.frag filters a pixel: its macro PIXEL_FILTER. Valid C++ and valid GLSL.
//
// RAYS: one ray, at ray_place, where `wanted` has the bit of the quarter that it lies in. REGIONS: as a whole, and by side x side
// rays only where that does not suffice. MARKED: as REGIONS without the rays; alpha names the quarters that want them, a bit
// each, for passes with RAYS to fill. Drivers that run both sides of every branch take half the time for two such programs.
#ifndef BURIN_PIXEL_FILTER_H
#define BURIN_PIXEL_FILTER_H

#define FILTER_RAYS 0
#define FILTER_REGIONS 1
#define FILTER_MARKED 2

#endif
