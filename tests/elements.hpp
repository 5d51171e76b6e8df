// Elements by their points, for tests that build patterns.
#pragma once

#include <burin/geometry.hpp>
#include <burin/pattern.hpp>

namespace burin::testing {

inline Element make_line(Vec2 a, Vec2 b) {
    Element e;
    e.p0 = a;
    e.p1 = lerp(a, b, 0.5);
    e.p2 = b;
    return e;
}

inline Element make_arc(Vec2 a, Vec2 control, Vec2 b) {
    Element e = make_line(a, b);
    e.kind = ElementKind::quadratic;
    e.p1 = control;
    return e;
}

}  // namespace burin::testing
