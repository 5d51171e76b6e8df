// Strokes to a pattern: traced over the triangles, cut into the charts' pieces, fitted, with the widths that the stretch needs.
#include <burin/strokes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "stroke_echoes.hpp"
#include "stroke_paths.hpp"
#include "svg_meaning.hpp"

namespace burin {
namespace {

using namespace stroking;

// Scales lie in [0, 4) in steps of 1 / 16384: at this one a step is 1 % of the width.
constexpr double kLeastScale = 1.0 / 128.0, kMostScale = 3.9;
constexpr std::size_t kMostNotes = 16;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string place_text(Point3 p) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.4g, %.4g, %.4g)", p.x, p.y, p.z);
    return text;
}

std::string stroke_text(const Stroke& stroke, std::size_t index) {
    return "stroke " + std::to_string(index + 1) + (stroke.name.empty() ? "" : " '" + stroke.name + "'");
}

Status check_options(const StrokeOptions& options) {
    const auto check = [](const char* name, double value) -> Status {
        if (value >= 0.0 && std::isfinite(value)) return Done{};
        return Error{ErrorCode::invalid_argument, std::string("strokes: ") + name + " is " + number(value) + " m; 0 or more works"};
    };
    for (const auto& [name, value] : {std::pair{"width", options.width}, {"height", options.height}, {"max_distance", options.max_distance}, {"tolerance", options.tolerance}})
        if (const Status status = check(name, value); !status) return status;
    return Done{};
}

Status check_stroke(const Stroke& stroke, std::size_t index) {
    const std::string name = stroke_text(stroke, index);
    if (stroke.points.size() < (stroke.closed ? 3u : 2u))
        return Error{ErrorCode::invalid_input, name + " has " + std::to_string(stroke.points.size()) + " points; a line needs 2, a closed one 3"};
    for (std::size_t i = 0; i < stroke.points.size(); ++i)
        if (const Point3 p = stroke.points[i]; !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return Error{ErrorCode::invalid_input, name + ": point " + std::to_string(i + 1) + " is not finite"};
    return Done{};
}

// Where the needed width is least and greatest.
struct WidthRange {
    double least = 1e300, most = 0.0;
    Point3 at_least, at_most;

    void take(const Piece& piece) {
        for (const PiecePoint& point : piece.points) {
            if (point.width < least) least = point.width, at_least = point.place;
            if (point.width > most) most = point.width, at_most = point.place;
        }
    }
    // What scales multiply. In the middle, unless that would not let the greatest through.
    double base() const { return std::max(std::sqrt(least * most), most / kMostScale); }
};

// All strokes on one surface.
class Projector {
  public:
    // Requires: options without a 0 that stands for the usual.
    Projector(const Surface& surface, std::span<const Stroke> strokes, const StrokeOptions& options)
        : surface_(surface), strokes_(strokes), options_(options), echoes_(surface) {
        trace_.max_distance = options.max_distance;
        piece_.width = options.width;
        piece_.spacing = options.width / 8.0;
        piece_.open_caps = options.cap == CapKind::hip || options.cap == CapKind::round;
        trace_.fine = 0.5 * piece_.spacing;
    }

    Result<ProjectedStrokes> run() {
        for (std::size_t i = 0; i < strokes_.size(); ++i)
            if (const Status status = add(i); !status) return status.error();
        if (const Status status = check_widths(); !status) return status.error();
        if (const Status status = make_pattern(); !status) return status.error();
        if (notes_ > kMostNotes) out_.notes.push_back("and " + std::to_string(notes_ - kMostNotes) + " more notes like these");
        return std::move(out_);
    }

  private:
    void note(const std::string& text) {
        if (++notes_ <= kMostNotes) out_.notes.push_back(text);
    }

    Status add(std::size_t index) {
        const Stroke& stroke = strokes_[index];
        if (const Status status = check_stroke(stroke, index); !status) return status.error();
        const std::string name = stroke_text(stroke, index);
        const auto traces = trace_stroke(surface_, stroke, name, trace_, out_.stats.farthest);
        if (!traces) return traces.error();
        ++out_.stats.strokes;
        double lost = 0.0;
        std::optional<Point3> echo;
        for (const Trace& trace : *traces) {
            if (trace.gaps > 0) note(name + " is parted at " + place_text(trace.points.front()) + ", where the surface is missing");
            const Pieces pieces = pieces_of(surface_, trace, piece_);
            out_.stats.length += pieces.length, out_.stats.borders += pieces.borders;
            lost += pieces.lost;
            for (const Piece& piece : pieces.pieces) {
                range_.take(piece);
                if (!echo) echo = echoes_.find(piece, options_.width);
                pieces_.push_back(piece);
            }
        }
        if (lost > 0.0) note(name + " runs over triangles without area in uv for " + number(lost) + " m, where no pattern shows");
        if (echo) note(name + " also shows at " + place_text(*echo) + ", a place with the same texture coordinates, or beside a chart's border in them");
        return Done{};
    }

    Status check_widths() const {
        if (pieces_.empty()) return Error{ErrorCode::invalid_input, "no stroke shows: the triangles under them have no area in uv, or they have no length"};
        if (range_.least >= kLeastScale * range_.base()) return Done{};
        return Error{ErrorCode::invalid_input, "the texture coordinates are stretched so differently that one width needs scales from 1 at " +
                                                   place_text(range_.at_least) + " to " + number(range_.most / range_.least) + " at " +
                                                   place_text(range_.at_most) + "; " + number(kMostScale / kLeastScale) + " is the most that works"};
    }

    Status make_pattern() {
        Pattern& pattern = out_.pattern;
        pattern.size = surface_.pattern_size();
        pattern.depth = options_.height;
        pattern.base_offset = options_.ridge ? options_.height : 0.0;
        pattern.wrap = surface_.repeats() ? Wrap::repeat : Wrap::clamp;
        const auto profile = make_profile(options_.profile, range_.base(), options_.ridge ? options_.height : -options_.height);
        if (!profile) return profile.error();
        pattern.profiles = {*profile};
        for (const Piece& piece : pieces_) {
            auto path = path_of(piece, {options_.width, piece_.spacing, options_.tolerance, range_.base()});
            if (!path) return path.error();
            path->join = options_.join;
            path->start_cap = piece.starts ? options_.cap : CapKind::butt;
            path->end_cap = piece.ends ? options_.cap : CapKind::butt;
            pattern.paths.push_back(std::move(*path));
        }
        out_.stats.pieces = static_cast<int>(pieces_.size());
        return Done{};
    }

    const Surface& surface_;
    std::span<const Stroke> strokes_;
    StrokeOptions options_;
    EchoFinder echoes_;
    TraceOptions trace_;
    PieceOptions piece_;
    WidthRange range_;
    std::vector<Piece> pieces_;
    std::size_t notes_ = 0;
    ProjectedStrokes out_;
};

StrokeOptions with_usual(StrokeOptions options, double size) {
    if (options.width == 0.0) options.width = size / 200.0;
    if (options.height == 0.0) options.height = 0.5 * options.width;
    if (options.max_distance == 0.0) options.max_distance = 0.05 * size;
    if (options.tolerance == 0.0) options.tolerance = std::min(size / 4000.0, options.width / 100.0);
    return options;
}

}  // namespace

Status mean_strokes(std::string_view text, StrokeOptions& options) {
    const auto meaning = svg::parse_meaning(text);
    if (!meaning) return meaning.error();
    if (meaning->kind != svg::Kind::groove && meaning->kind != svg::Kind::ridge)
        return Error{ErrorCode::invalid_argument, "'" + std::string(text) + "': strokes on an object are groove or ridge"};
    options.ridge = meaning->kind == svg::Kind::ridge;
    options.profile = meaning->profile.value_or(ProfileSpec{});
    options.height = meaning->height, options.width = meaning->width;
    return Done{};
}

Result<ProjectedStrokes> project_strokes(const Model& model, std::span<const Stroke> strokes, const StrokeOptions& options) {
    if (const Status status = check_options(options); !status) return status.error();
    if (strokes.empty()) return Error{ErrorCode::invalid_input, "there is no stroke"};
    const auto target = find_material(model, options.attach);
    if (!target) return target.error();
    const Surface surface(model, options.attach, *target);
    return Projector(surface, strokes, with_usual(options, surface.size())).run();
}

}  // namespace burin
