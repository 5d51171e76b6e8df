#include "pattern_text.hpp"

namespace burin {

std::string path_data_of(const std::vector<Element>& elements, bool closed) {
    const auto pair_of = [](Vec2 p) { return exact(p.x) + "," + exact(p.y); };
    if (elements.empty()) return "";
    std::string data = "M" + pair_of(elements.front().p0);
    for (const Element& e : elements) {
        data += e.kind == ElementKind::line ? " L" : " Q" + pair_of(e.p1) + " ";
        data += pair_of(e.p2);
    }
    return closed ? data + " Z" : data;
}

}  // namespace burin
