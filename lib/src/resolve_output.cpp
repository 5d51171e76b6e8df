// The last step: elements cut to what the grid and the texels can hold, moved into the tile, with numbered
// styles.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "layout.h"
#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

// How far from the element's arc it may act, beyond an end included.
double end_reach(const ElementEnd& end, Vec2 tangent, double half_width) {
    const Vec2 clip = {std::cos(end.clip_angle), std::sin(end.clip_angle)};
    if (end.priority == Priority::none) return half_width;
    if (end.priority == Priority::both) {
        if (!end.clips_both()) return std::sqrt(2.0) * half_width;
        // The clip line leaves the strip at half_width / sin of the angle between line and tangent.
        return half_width / std::max(std::abs(cross(tangent, clip)), 0.1);
    }
    const double cosine = std::max(std::abs(dot(normal_of(tangent), clip)), 0.05);
    return end.shape == static_cast<std::uint8_t>(CornerShape::mitre) ? half_width / cosine : half_width;
}

double reach_of(const WorkPath& path, std::size_t i) {
    const Element& e = path.elements[i];
    const double half_width = path.reach * std::max(e.width0, e.width1);
    return std::max(end_reach(path.starts[i], curve::tangent(e, 0.0), half_width),
                    end_reach(path.ends[i], curve::tangent(e, 1.0), half_width));
}

struct Piece {
    Element element;
    ElementEnd start, end;
};

class Assembler {
  public:
    explicit Assembler(Work& work) : work_(work) {
        out_.size = work.pattern.size;
        out_.depth = work.pattern.depth;
        out_.base_offset = work.pattern.base_offset;
        out_.wrap = work.pattern.wrap;
        out_.outer_level = work.pattern.outer_level;
        out_.profiles = work.profiles;
        out_.materials = work.pattern.materials;
        out_.functions = work.functions;
    }

    Result<ResolvedPattern> run() {
        for (WorkPath& path : work_.paths) {
            const std::size_t before = out_.elements.size();
            const Status status = add_path(path);
            if (status.ok()) continue;
            if (!tolerate(work_, status.error().message)) return status.error();
            out_.elements.resize(before);
        }
        if (out_.styles.size() > BURIN_MAX_STYLES)
            return Error{ErrorCode::limit_exceeded, std::to_string(out_.styles.size()) +
                                                        " combinations of profile, material and level; " +
                                                        std::to_string(BURIN_MAX_STYLES) + " are allowed"};
        out_.junctions = std::move(work_.junctions);
        out_.stats = work_.stats;
        return std::move(out_);
    }

  private:
    Status add_path(const WorkPath& path) {
        for (std::size_t i = 0; i < path.elements.size(); ++i) {
            const double reach = reach_of(path, i);
            const Vec2 size = work_.pattern.size;
            if (work_.repeats() && reach > 0.4 * std::min(size.x, size.y))
                return Error{ErrorCode::limit_exceeded,
                             path_text(path.source, path.elements[i].p0) + " acts " + std::to_string(reach) +
                                 " m to the side; in a repeating pattern it may act up to 0.4 of the tile"};
            const std::uint32_t style = style_of(path, path.levels[i]);
            const Status status =
                add_pieces({path.elements[i], path.starts[i], path.ends[i]}, reach, style, path, 0);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    // Halves a piece until it fits; smooth joints between.
    Status add_pieces(const Piece& piece, double reach, std::uint32_t style, const WorkPath& path,
                      int depth) {
        if (!work_.repeats() && is_outside(piece.element, reach)) return Done{};
        Element moved = piece.element;
        if (work_.repeats()) moved = curve::translated(moved, wrapped(work_, moved.p0) - moved.p0);
        if (work_.repeats() ? fits_tile(moved, reach) : fits_range(moved)) {
            if (work_.repeats()) moved.p0 = wrapped(work_, piece.element.p0);
            ResolvedElement resolved{moved, piece.start, piece.end, style, path.source, path.function};
            out_.elements.push_back(resolved);
            return Done{};
        }
        if (depth > 24)
            return Error{ErrorCode::limit_exceeded,
                         path_text(path.source, piece.element.p0) +
                             " cannot be cut into pieces that lie within half a tile of the map"};
        const Vec2 across = normal_of(curve::tangent(piece.element, 0.5));
        const ElementEnd joint{Priority::both, static_cast<std::uint8_t>(EndShape::clip), line_angle(across)};
        const Status first = add_pieces({curve::part(piece.element, 0.0, 0.5), piece.start, joint}, reach,
                                        style, path, depth + 1);
        if (!first.ok()) return first;
        return add_pieces({curve::part(piece.element, 0.5, 1.0), joint, piece.end}, reach, style, path,
                          depth + 1);
    }

    bool is_outside(const Element& e, double reach) const {
        const Box box = curve::control_box(e);
        const Vec2 size = work_.pattern.size;
        return box.high.x < -reach || box.high.y < -reach || box.low.x > size.x + reach ||
               box.low.y > size.y + reach;
    }

    // What texels hold, the last code included: a point a hair's breadth before 1.5 would round to one that is none.
    bool fits_range(const Element& e) const {
        constexpr double kLast = 1.5 - 1.0 / BURIN_COORDINATE_STEPS;
        const Box box = curve::control_box(e);
        const Vec2 size = work_.pattern.size;
        return box.low.x >= -0.5 * size.x && box.low.y >= -0.5 * size.y && box.high.x <= kLast * size.x &&
               box.high.y <= kLast * size.y;
    }

    // Within range, and all of the strip nearer than 0.45 tile to the chord's midpoint.
    bool fits_tile(const Element& e, double reach) const {
        const Box box = curve::control_box(e);
        const Vec2 middle = lerp(e.p0, e.p2, 0.5), size = work_.pattern.size;
        const double half_x = std::max(middle.x - box.low.x, box.high.x - middle.x) + reach;
        const double half_y = std::max(middle.y - box.low.y, box.high.y - middle.y) + reach;
        return fits_range(e) && half_x <= 0.45 * size.x && half_y <= 0.45 * size.y;
    }

    std::uint32_t style_of(const WorkPath& path, double level) {
        const auto key = std::tuple(path.profile, path.material, level);
        const auto [at, added] = styles_.try_emplace(key, static_cast<std::uint32_t>(out_.styles.size()));
        if (added) out_.styles.push_back({path.profile, path.material, level, path.step});
        return at->second;
    }

    Work& work_;
    ResolvedPattern out_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, double>, std::uint32_t> styles_;
};

}  // namespace

Result<ResolvedPattern> assemble(Work& work) { return Assembler(work).run(); }

}  // namespace burin::resolving
