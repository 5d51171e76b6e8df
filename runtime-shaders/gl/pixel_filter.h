// How surface.frag filters a pixel: its macro PIXEL_FILTER. Valid C++ and valid GLSL.
//
// RAYS: one ray through the middle. REGIONS: areas, and side x side rays where these do not suffice. MARKED: as REGIONS without the
// rays; alpha is 1 where they are wanted and 2 where all of them are, for passes with RAYS to fill. Drivers that run both sides of
// every branch take half the time for two such programs.
#ifndef BURIN_PIXEL_FILTER_H
#define BURIN_PIXEL_FILTER_H

#define FILTER_RAYS 0
#define FILTER_REGIONS 1
#define FILTER_MARKED 2

// Rays of a pixel of side x side cells, from 4 on, may be moved within them (gl/sample_places.hpp): by so much, in cells, for the line of
// cells that each lies in, rows for columns. The odd lines come first, so that neighbours lie apart.
#define LEAST_MOVED_SIDE 4
#define MOVED_TURN(line, side) ((line) < (side) / 2 ? 2 * (line) + 1 : 2 * ((line) - (side) / 2))

#endif
