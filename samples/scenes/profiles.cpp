// Cross-sections.
#include <cmath>

#include "drawing.hpp"

namespace burin::scenes {

Profile vee(double half, double deep) { return {{{-half, 0}, {0, -deep}, {half, 0}}, {}}; }

Profile trough(double half, double floor, double deep) {
    return {{{-half, 0}, {-floor, -deep}, {floor, -deep}, {half, 0}}, {}};
}

Profile ridge(double half, double top, double high) { return trough(half, top, -high); }

Profile round_groove(double half, double deep, int facets) {
    Profile profile;
    for (int i = 0; i <= facets; ++i) {
        const double b = 2.0 * i / facets - 1.0;
        profile.points.push_back({b * half, -deep * (1.0 - b * b)});
    }
    return profile;
}

Profile lipped(double half, double deep, double lip) {
    return {{{-half, 0}, {-0.7 * half, lip}, {0, -deep}, {0.7 * half, lip}, {half, 0}}, {}};
}

Profile scratch(double half, double deep, double lip) {
    return {{{-half, 0}, {-0.72 * half, lip}, {-0.34 * half, -0.75 * deep}, {-0.1 * half, -deep}, {0.25 * half, -0.55 * deep},
             {0.6 * half, 0.8 * lip}, {half, 0}}, {}};
}

Profile rail(double foot, double head, double high) {
    const double under = 0.5 * high;
    return {{{-foot, 0}, {-foot, under}, {-head, under}, {-head, high}, {head, high}, {head, under}, {foot, under}, {foot, 0}},
            {}};
}

Profile undercut(double mouth, double floor, double deep) {
    return {{{-mouth, 0}, {-floor, -deep}, {floor, -deep}, {mouth, 0}}, std::vector<FacetClass>(3, FacetClass::internal)};
}

Profile rise(double half, double high) { return {{{-half, 0}, {0, 0.5 * high}, {half, high}}, {}}; }

Profile moulding(double half, double high) {
    return {{{-half, 0}, {-0.5 * half, 0.18 * high}, {0, 0.25 * high}, {0.3 * half, 0.85 * high}, {half, high}}, {}};
}

}  // namespace burin::scenes
