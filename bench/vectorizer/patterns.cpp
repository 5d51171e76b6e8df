#include "patterns.hpp"

namespace burin::bench {

const std::vector<Subject>& subjects() {
    static const std::vector<Subject> all{
        {"grid", draw_grid},           {"crossings", draw_crossings},       {"junctions", draw_junctions},
        {"corners", draw_corners},     {"hexagons", draw_hexagons},         {"bricks", draw_bricks},
        {"widths", draw_widths},       {"slots", draw_slots},               {"arcs", draw_arcs},
        {"concentric", draw_concentric}, {"spirals", draw_spirals},         {"scrolls", draw_scrolls},
        {"tapers", draw_tapers},       {"stroke_text", draw_stroke_text},   {"outline_text", draw_outline_text},
        {"discs", draw_discs},         {"plateaus", draw_plateaus},         {"engraved", draw_engraved},
        {"ridges", draw_ridges},       {"tile", draw_tile},
    };
    return all;
}

}  // namespace burin::bench
