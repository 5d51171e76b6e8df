// Stage refine: moves a pattern that is nearly right until its box-filtered surface matches the map.
//
//     height map + Pattern (within about a texel) --[refine_pattern]--> the same Pattern, in the least-squares place
//
// A sample of a map is the mean of the surface over a texel, so an edge point read off the samples is biased by up to
// 0.06 texel where a wall is sharper than a texel. Only a model that integrates over the texel has no such bias: here
// every texel's mean is computed from the pattern in closed form (a polyline profile swept along a line, integrated
// over a square, is a difference of cubics), and the unknowns of whole paths are solved for at once by a damped
// Gauss-Newton iteration with a robust loss. Stages lead from a model that is rough where features meet, on some of the
// texels, to the exact one: that is asked for last, and only when the map is clean enough to tell.
// Source: DESIGN 3, Fit; surface as in DESIGN 2 and `resolve.hpp`.
#pragma once

#include <burin/image.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

struct RefineOptions {
    int iterations = 12;              // most Gauss-Newton steps of a stage; it stops earlier when little is gained. >= 0
    double max_shift_texels = 2.5;    // no control point ends farther than this from where it began. > 0
    bool positions = true;            // control points, junctions, ends
    bool profiles = true;             // offsets b and heights h of the profiles
    bool levels = true;               // levels of the regions
    // Before the fit: ends of grooves and ridges are drawn out, taken back or joined as the map shows them. This may
    // add a line to a path and take away a small closed step that a drawn-out path explains.
    bool ends = true;
    // Polylines that go round become quadratics before the fit; quadratics that the map shows to be too few for their
    // arc (off by more than 0.012 texels and the noise) are split after it.
    bool elements = true;
    int most_splits = 1 << 30;        // of quadratics; those that leave the map by most come first. >= 0
    bool scales = true;               // width and height scales, of paths that have any other than 1
    // Ends nearer than this to another path's line lie on it and stay on it; metres as a fraction of the larger side,
    // as ResolveOptions::snap. Range [0, 0.01].
    double snap = 1e-4;
    // A groove narrower than this (area over depth) shows the map little but its cross-section's area: its offsets keep
    // their proportions, and its depth keeps near what it was unless crossings and ends tell better. Texels, >= 0.
    double narrow_texels = 1.25;
    // What was done to the heights since the surface was sampled (grain, JPEG), root mean square, map scale; >= 0. Points of
    // profiles that follow nothing greater go. What the heights are rounded to is found by itself.
    double damage = 0.0;
    int threads = 0;                  // 0: as many as the machine has. The result does not depend on it.
};

struct RefineReport {
    double rms_before = 0.0;          // of map minus model over the texels near features, map scale 0..1
    double rms_after = 0.0;
    int iterations = 0;               // steps that were taken
    int unknowns = 0;
    double largest_shift_texels = 0;  // of any control point
};

// What is kept (apart from what `ends` and `elements` do): the number of paths and elements and their kinds; ends that coincide coincide, and neighbours share
// their point bit by bit; an end on another path's line slides along it (T); smooth joints (below
// ResolveOptions::smooth_angle, with a quadratic at one side) stay tangent; collinear neighbours stay collinear; ends
// on the border of a clamped pattern slide along the border; a profile is one for all its paths; symmetric profiles
// stay symmetric, flat facets flat, vertical walls vertical; profiles that were measured with more
// points than their shape has lose some; regions at one level stay at one level, and a step
// profile's last height follows the levels of its two regions.
//
// Requires: map covers [0, size] of the pattern, values as `pattern.hpp` defines them (1 = object surface).
// Ensures: the pattern never fits the map worse than before, in the robust measure over the texels that are asked (else it
// is returned as it came); equal bytes for any number of threads. Heights stay within [lowest, highest]. Paths that a
// lenient `resolve_pattern` drops stay where they are; so does a path that a step would make it drop.
// The fit knows linear scales alone: a pattern with a perturbed path is returned as it came, its report empty.
// Fails with invalid_argument on options out of range or an empty map, and with invalid_input, naming the path, on
// profile indices out of range and on numbers that are not finite; the pattern is then unchanged.
// Where a map does not bend, one texel in four or sixteen speaks for its neighbours.
// Cost: up to 10 microseconds of one core per texel near a feature, all stages together; a fifth of that for plain
// grooves. Steps get fewer as maps get larger. What the map is noisier than is not computed.
Result<RefineReport> refine_pattern(Pattern& pattern, const Image& map, const RefineOptions& options = {});

}  // namespace burin
