#include "svg_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

#include <polyclipping/clipper.hpp>

#include "resolve_curve.hpp"

namespace burin::svg {
namespace {

using ClipperLib::cInt;
using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

struct PointHash {
    std::size_t operator()(const IntPoint& p) const {
        return std::size_t(std::uint64_t(p.X) * 0x9e3779b97f4a7c15u ^ (std::uint64_t(p.Y) + 0x7f4a7c15u) * 0xc2b2ae3d27d4eb4fu);
    }
};

// A line or quadratic of some outline, and how many chords stand for it.
struct Curve {
    Element element;
    StepSource source;  // of the whole
    int chords = 1;
};

// A corner of a polygon that lies on a curve, at parameter k / chords.
struct Sample {
    std::size_t curve;
    int k;
};

struct Grid {
    Vec2 origin;
    double scale = 1.0;  // steps per metre
    IntPoint of(Vec2 p) const { return {cInt(std::llround((p.x - origin.x) * scale)), cInt(std::llround((p.y - origin.y) * scale))}; }
    Vec2 at(IntPoint p) const { return {origin.x + double(p.X) / scale, origin.y + double(p.Y) / scale}; }
};

class Tracer {
  public:
    Tracer(const std::vector<Region>& regions, const StepOptions& options) : regions_(regions), options_(options) {}

    Result<std::vector<StepRun>> trace() {
        place_grid();
        std::vector<Paths> polygons;
        for (std::size_t i = 0; i < regions_.size(); ++i) polygons.push_back(polygons_of(i));
        paint(polygons);
        if (levels_.size() > 1) share_corners();
        make_edges();
        return make_runs();
    }

  private:
    // 2^29 steps across all outlines: within what Clipper computes in 64 bits.
    void place_grid() {
        Vec2 low{0.0, 0.0}, high = options_.size;
        for (const Region& region : regions_)
            for (const Subpath& subpath : *region.outline)
                for (const Element& e : subpath.elements) {
                    const Box box = curve::control_box(e);
                    low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
                    high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
                }
        grid_.origin = (low + high) * 0.5;
        grid_.scale = double(1 << 29) / std::max(high.x - low.x, high.y - low.y);
    }

    void add_curve(const Element& element, const StepSource& source, Path& polygon) {
        Curve curve{element, source, 1};
        if (element.kind == ElementKind::quadratic) {
            const double bow = length(element.p0 - element.p1 * 2.0 + element.p2) / 4.0;  // of the chord
            curve.chords = std::clamp(int(std::ceil(std::sqrt(bow / options_.tolerance))), 2, 1 << 12);
        }
        const std::size_t index = curves_.size();
        for (int k = 0; k <= curve.chords; ++k) {
            const Vec2 at = k == 0 ? element.p0 : k == curve.chords ? element.p2 : curve::point(element, double(k) / curve.chords);
            const IntPoint p = grid_.of(at);
            samples_[p].push_back({index, k});
            if (k == 0 || k == curve.chords) exact_.emplace(p, at);
            if (k < curve.chords) polygon.push_back(p);
        }
        curves_.push_back(curve);
    }

    // The region by its own rule, outer borders one way round and holes the other.
    Paths polygons_of(std::size_t index) {
        const Region& region = regions_[index];
        Paths drawn;
        for (std::size_t s = 0; s < region.outline->size(); ++s) {
            const Subpath& subpath = (*region.outline)[s];
            if (subpath.elements.empty()) continue;
            Path polygon;
            for (std::size_t e = 0; e < subpath.elements.size(); ++e) add_curve(subpath.elements[e], {index, s, e, 0.0, 1.0}, polygon);
            const Vec2 first = subpath.elements.front().p0, last = subpath.elements.back().p2;
            if (!(first == last)) {
                Element line;
                line.p0 = last, line.p1 = lerp(last, first, 0.5), line.p2 = first;
                add_curve(line, {index, kNone, kNone, 0.0, 1.0}, polygon);
            }
            drawn.push_back(std::move(polygon));
        }
        return united(drawn, region.even_odd ? ClipperLib::pftEvenOdd : ClipperLib::pftNonZero);
    }

    static Paths united(const Paths& paths, ClipperLib::PolyFillType rule) { return combined(paths, {}, ClipperLib::ctUnion, rule); }
    static Paths combined(const Paths& subject, const Paths& clip, ClipperLib::ClipType type, ClipperLib::PolyFillType rule) {
        ClipperLib::Clipper clipper;
        clipper.PreserveCollinear(true);  // chords of a curve that happen to be in line are still corners of it
        clipper.AddPaths(subject, ClipperLib::ptSubject, true);
        clipper.AddPaths(clip, ClipperLib::ptClip, true);
        Paths out;
        clipper.Execute(type, out, rule, rule);
        return out;
    }

    struct Bounds {
        cInt left = 0, top = 0, right = -1, bottom = -1;
        bool meets(const Bounds& b) const { return left <= b.right && b.left <= right && top <= b.bottom && b.top <= bottom; }
    };
    static Bounds bounds_of(const Paths& paths) {
        Bounds out;
        for (const Path& path : paths)
            for (const IntPoint& p : path) {
                if (out.right < out.left) out = {p.X, p.Y, p.X, p.Y};
                out = {std::min(out.left, p.X), std::min(out.top, p.Y), std::max(out.right, p.X), std::max(out.bottom, p.Y)};
            }
        return out;
    }

    // Layers: a region lies one above the highest of those below it that have another level. All of one layer and level are united
    // at once; so drawings with few levels take few unions, however many shapes they have.
    void paint(const std::vector<Paths>& polygons) {
        std::vector<Bounds> bounds;
        for (const Paths& paths : polygons) bounds.push_back(bounds_of(paths));
        std::vector<int> layers(polygons.size(), 0);
        int highest = 0;
        for (std::size_t i = 0; i < polygons.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j)
                if (regions_[j].level != regions_[i].level && layers[j] >= layers[i] && bounds[i].meets(bounds[j])) layers[i] = layers[j] + 1;
            highest = std::max(highest, layers[i]);
        }
        for (int layer = 0; layer <= highest; ++layer) {
            std::map<double, Paths> painted;
            for (std::size_t i = 0; i < polygons.size(); ++i)
                if (layers[i] == layer) painted[regions_[i].level].insert(painted[regions_[i].level].end(), polygons[i].begin(), polygons[i].end());
            for (const auto& [level, paths] : painted) cover(level, united(paths, ClipperLib::pftNonZero));
        }
        std::erase_if(levels_, [](const auto& one) { return one.second.empty(); });
    }

    void cover(double level, const Paths& paths) {
        for (auto& [other, there] : levels_)
            if (other != level && !there.empty()) there = combined(there, paths, ClipperLib::ctDifference, ClipperLib::pftNonZero);
        if (level == 0.0) return;
        Paths& own = levels_[level];
        own = own.empty() ? paths : combined(own, paths, ClipperLib::ctUnion, ClipperLib::pftNonZero);
    }

    // Where regions of different levels meet, each has corners on the common border that the other lacks: crossings that were rounded
    // to the grid. Every corner within two steps of an edge becomes a corner of that edge too, so that common edges are equal.
    void share_corners() {
        std::vector<IntPoint> corners;
        for (const auto& [level, paths] : levels_)
            for (const Path& path : paths) corners.insert(corners.end(), path.begin(), path.end());
        std::sort(corners.begin(), corners.end(), [](const IntPoint& a, const IntPoint& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; });
        corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
        const cInt cell = std::max<cInt>(4, cInt(double(1 << 30) / std::sqrt(double(corners.size()) + 1.0)));
        std::unordered_map<IntPoint, std::vector<IntPoint>, PointHash> cells;
        const auto cell_of = [&](cInt v) { return v >= 0 ? v / cell : -((-v + cell - 1) / cell); };
        for (const IntPoint& p : corners) cells[{cell_of(p.X), cell_of(p.Y)}].push_back(p);
        for (auto& [level, paths] : levels_)
            for (Path& path : paths) {
                Path refined;
                for (std::size_t i = 0; i < path.size(); ++i) {
                    const IntPoint a = path[i], b = path[(i + 1) % path.size()];
                    refined.push_back(a);
                    std::vector<std::pair<double, IntPoint>> on = corners_on(a, b, cells, cell_of);
                    std::sort(on.begin(), on.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
                    for (const auto& [share, p] : on) refined.push_back(p);
                }
                path = std::move(refined);
            }
    }

    template <typename Cells, typename CellOf>
    static std::vector<std::pair<double, IntPoint>> corners_on(IntPoint a, IntPoint b, const Cells& cells, const CellOf& cell_of) {
        std::vector<std::pair<double, IntPoint>> on;
        const double dx = double(b.X - a.X), dy = double(b.Y - a.Y), square = dx * dx + dy * dy;
        const cInt x0 = cell_of(std::min(a.X, b.X) - 2), x1 = cell_of(std::max(a.X, b.X) + 2);
        for (cInt x = x0; x <= x1; ++x)
            for (cInt y = cell_of(std::min(a.Y, b.Y) - 2); y <= cell_of(std::max(a.Y, b.Y) + 2); ++y) {
                const auto found = cells.find({x, y});
                if (found == cells.end()) continue;
                for (const IntPoint& p : found->second) {
                    if (p == a || p == b) continue;
                    const double px = double(p.X - a.X), py = double(p.Y - a.Y), share = (px * dx + py * dy) / square;
                    if (share > 0.0 && share < 1.0 && std::abs(px * dy - py * dx) <= 2.0 * std::sqrt(square)) on.emplace_back(share, p);
                }
            }
        return on;
    }

    struct Edge {
        IntPoint a, b;
        double left = 0.0, right = 0.0;
        bool kept = true;
    };
    struct EdgeHash {
        std::size_t operator()(const std::pair<IntPoint, IntPoint>& e) const { return PointHash{}(e.first) * 31u + PointHash{}(e.second); }
    };

    // A region's ground lies on the right of its borders (b > 0); on the left that of the neighbour, or level 0. Of two regions the
    // higher one keeps the common edge.
    void make_edges() {
        std::unordered_map<std::pair<IntPoint, IntPoint>, double, EdgeHash> levels;
        if (levels_.size() > 1)
            for (const auto& [level, paths] : levels_)
                for (const Path& path : paths)
                    for (std::size_t i = 0; i < path.size(); ++i) levels[{path[i], path[(i + 1) % path.size()]}] = level;
        for (const auto& [level, paths] : levels_)
            for (const Path& path : paths) {
                std::vector<Edge>& contour = contours_.emplace_back();
                for (std::size_t i = 0; i < path.size(); ++i) {
                    Edge edge{path[i], path[(i + 1) % path.size()], 0.0, level, true};
                    if (edge.a == edge.b) continue;
                    if (const auto other = levels.find({edge.b, edge.a}); other != levels.end()) {
                        edge.left = other->second;
                        edge.kept = edge.left < edge.right;
                    }
                    contour.push_back(edge);
                }
            }
    }

    // A piece of a run: part of a curve, or a chord.
    struct Piece {
        IntPoint a, b;
        StepSource source;
        std::size_t curve = kNone;
        double left = 0.0, right = 0.0;
        std::size_t style = 0;
        bool goes_on(const Piece& next) const { return left == next.left && right == next.right && style == next.style; }
    };

    // Which curve the edge is a chord of, and from where to where.
    Piece piece_of(const Edge& edge) const {
        Piece piece{edge.a, edge.b, {}, kNone, edge.left, edge.right, 0};
        double from = 0.0, to = 0.0;
        const auto begin = samples_.find(edge.a), end = samples_.find(edge.b);
        const auto take = [&](std::size_t curve, double a, double b) { piece.curve = curve, from = a, to = b; };
        if (begin != samples_.end() && end != samples_.end())
            for (const Sample& a : begin->second)
                for (const Sample& b : end->second)
                    if (piece.curve == kNone && a.curve == b.curve && std::abs(a.k - b.k) == 1) take(a.curve, a.k, b.k);
        if (begin != samples_.end() && piece.curve == kNone)
            for (const Sample& a : begin->second)
                if (const auto share = share_beside(a, edge.b); share && piece.curve == kNone) take(a.curve, a.k, a.k + *share);
        if (end != samples_.end() && piece.curve == kNone)
            for (const Sample& b : end->second)
                if (const auto share = share_beside(b, edge.a); share && piece.curve == kNone) take(b.curve, b.k + *share, b.k);
        if (piece.curve == kNone) {
            piece.style = regions_.empty() ? 0 : style_of_level(edge.right);
            return piece;
        }
        const Curve& curve = curves_[piece.curve];
        piece.source = curve.source;
        piece.source.from = from / curve.chords, piece.source.to = to / curve.chords;
        piece.style = regions_[curve.source.region].style;
        return piece;
    }

    std::size_t style_of_level(double level) const {
        for (const Region& region : regions_)
            if (region.level == level) return region.style;
        return 0;
    }

    // Chords from the sample's corner, below 0 towards the one before it, where `p` lies on such a chord.
    std::optional<double> share_beside(const Sample& sample, IntPoint p) const {
        const Curve& curve = curves_[sample.curve];
        for (const int step : {1, -1}) {
            const int k = sample.k + step;
            if (k < 0 || k > curve.chords) continue;
            const auto corner = [&](int i) {
                return grid_.of(i == 0 ? curve.element.p0 : i == curve.chords ? curve.element.p2 : curve::point(curve.element, double(i) / curve.chords));
            };
            const IntPoint a = corner(sample.k), b = corner(k);
            const double dx = double(b.X - a.X), dy = double(b.Y - a.Y), px = double(p.X - a.X), py = double(p.Y - a.Y);
            const double square = dx * dx + dy * dy, share = (px * dx + py * dy) / square;
            if (square > 0.0 && share > 0.0 && share <= 1.0 && std::abs(px * dy - py * dx) <= 2.0 * std::sqrt(square)) return step * share;
        }
        return std::nullopt;
    }

    Vec2 place(IntPoint p) const {
        const auto exact = exact_.find(p);
        return exact != exact_.end() ? exact->second : grid_.at(p);
    }

    std::vector<StepRun> make_runs() const {
        std::vector<StepRun> runs;
        for (const std::vector<Edge>& contour : contours_) {
            std::vector<Piece> pieces;
            std::vector<bool> kept;
            for (const Edge& edge : contour) {
                pieces.push_back(piece_of(edge));
                kept.push_back(edge.kept);
            }
            add_runs(pieces, kept, runs);
        }
        return runs;
    }

    // Chords of one curve that follow each other.
    static bool same_curve(const Piece& a, const Piece& b) {
        return a.curve != kNone && a.curve == b.curve && a.source.to == b.source.from && (a.source.to > a.source.from) == (b.source.to > b.source.from);
    }

    void add_runs(const std::vector<Piece>& pieces, const std::vector<bool>& kept, std::vector<StepRun>& runs) const {
        const std::size_t n = pieces.size();
        if (n < 2) return;
        const auto before = [&](std::size_t i) { return (i + n - 1) % n; };
        // Begin where a run must end, else where a curve does.
        std::size_t start = kNone;
        for (std::size_t i = 0; i < n && start == kNone; ++i)
            if (kept[i] && (!kept[before(i)] || !pieces[before(i)].goes_on(pieces[i]))) start = i;
        const bool closed = start == kNone;
        if (closed && !kept[0]) return;
        for (std::size_t i = 0; i < n && start == kNone; ++i)
            if (!same_curve(pieces[before(i)], pieces[i])) start = i;
        if (start == kNone) start = 0;
        std::vector<Piece> run;
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t i = (start + k) % n;
            const bool ends = !run.empty() && (!kept[i] || !run.back().goes_on(pieces[i]));
            if (ends) runs.push_back(run_of(run, false)), run.clear();
            if (!kept[i]) continue;
            if (!run.empty() && same_curve(run.back(), pieces[i])) run.back().b = pieces[i].b, run.back().source.to = pieces[i].source.to;
            else run.push_back(pieces[i]);
        }
        if (!run.empty()) runs.push_back(run_of(run, closed));
    }

    StepRun run_of(const std::vector<Piece>& pieces, bool closed) const {
        StepRun run;
        run.closed = closed;
        run.left = pieces.front().left, run.right = pieces.front().right, run.style = pieces.front().style;
        for (const Piece& piece : pieces) {
            Element e;
            if (piece.curve != kNone) {
                const Element& whole = curves_[piece.curve].element;
                const bool turned = piece.source.to < piece.source.from;
                e = turned ? curve::part(whole, piece.source.to, piece.source.from) : curve::part(whole, piece.source.from, piece.source.to);
            }
            e.p0 = place(piece.a), e.p2 = place(piece.b);
            if (e.kind == ElementKind::line) e.p1 = lerp(e.p0, e.p2, 0.5);
            e.width0 = e.width1 = e.height0 = e.height1 = 1.0;
            run.elements.push_back(e);
            run.sources.push_back(piece.source);
        }
        return run;
    }

    const std::vector<Region>& regions_;
    const StepOptions& options_;
    Grid grid_;
    std::vector<Curve> curves_;
    std::unordered_map<IntPoint, std::vector<Sample>, PointHash> samples_;
    std::unordered_map<IntPoint, Vec2, PointHash> exact_;  // places of ends of curves
    std::map<double, Paths> levels_;
    std::vector<std::vector<Edge>> contours_;
};

}  // namespace

Result<std::vector<StepRun>> trace_steps(const std::vector<Region>& regions, const StepOptions& options) {
    if (regions.empty()) return std::vector<StepRun>{};
    return Tracer(regions, options).trace();
}

}  // namespace burin::svg
