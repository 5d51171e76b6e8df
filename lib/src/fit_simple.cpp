// Whether a fitted loop is simple. A contour never crosses itself; where its fit does, the ground inside it
// has no meaning.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>

#include <vector>

#include "fit_chain.hpp"

namespace burin::fit {

bool crosses_itself(const Chain& chain) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_2> outline;
    const auto add = [&](Vec2 p) {
        const Kernel::Point_2 next(p.x, p.y);
        if (outline.empty() || next != outline.back()) outline.push_back(next);
    };
    for (long k = 0; k < chain.size(); ++k) {
        const Vec2 a = chain.joint_in(k), v = chain.position(k), b = chain.joint_out(k);
        add(a);
        if (chain.at(k).corner) continue;
        for (const double t : {0.25, 0.5, 0.75, 1.0}) add(lerp(lerp(a, v, t), lerp(v, b, t), t));
    }
    if (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
    return outline.size() >= 3 && !CGAL::is_simple_2(outline.begin(), outline.end(), Kernel());
}

}  // namespace burin::fit
