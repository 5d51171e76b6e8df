#include "svg_regions.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include <polyclipping/clipper.hpp>

#include "parallel.hpp"
#include "resolve_chords.hpp"
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
    IntPoint at;
    std::size_t curve;
    int k;
};

bool before(const IntPoint& a, const IntPoint& b) { return a.X != b.X ? a.X < b.X : a.Y < b.Y; }

struct Grid {
    Vec2 origin;
    double scale = 1.0;  // steps per metre
    IntPoint of(Vec2 p) const { return {cInt(std::llround((p.x - origin.x) * scale)), cInt(std::llround((p.y - origin.y) * scale))}; }
    Vec2 at(IntPoint p) const { return {origin.x + double(p.X) / scale, origin.y + double(p.Y) / scale}; }
};

// Regions that lie on one another, or on others that do; none outside of them does.
class Cluster {
  public:
    Cluster(const std::vector<Region>& regions, std::vector<std::size_t> members, const Grid& grid, double tolerance)
        : regions_(regions), members_(std::move(members)), grid_(grid), tolerance_(tolerance) {}

    std::vector<StepRun> trace() {
        std::vector<Paths> polygons;
        for (const std::size_t region : members_) polygons.push_back(polygons_of(region));
        std::sort(samples_.begin(), samples_.end(), [](const Sample& p, const Sample& q) {
            return p.at != q.at ? before(p.at, q.at) : p.curve != q.curve ? p.curve < q.curve : p.k < q.k;
        });
        paint(polygons);
        if (levels_.size() > 1) share_corners();
        for (auto& [level, paths] : levels_)
            for (Path& path : paths) remove_spikes(path);
        make_edges();
        return make_runs();
    }

  private:
    void add_curve(const Element& element, const StepSource& source, Path& polygon) {
        Curve curve{element, source, 1};
        if (element.kind == ElementKind::quadratic) {
            const double bow = length(element.p0 - element.p1 * 2.0 + element.p2) / 4.0;  // of the chord
            curve.chords = std::clamp(int(std::ceil(std::sqrt(bow / tolerance_))), 2, 1 << 12);
        }
        const std::size_t index = curves_.size();
        for (int k = 0; k <= curve.chords; ++k) {
            const Vec2 at = k == 0 ? element.p0 : k == curve.chords ? element.p2 : curve::point(element, double(k) / curve.chords);
            const IntPoint p = grid_.of(at);
            samples_.push_back({p, index, k});
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
        clipper.StrictlySimple(true);     // borders that meet at a corner do not cross there
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
                if (level_of(j) != level_of(i) && layers[j] >= layers[i] && bounds[i].meets(bounds[j])) layers[i] = layers[j] + 1;
            highest = std::max(highest, layers[i]);
        }
        for (int layer = 0; layer <= highest; ++layer) {
            std::map<double, Paths> painted;
            for (std::size_t i = 0; i < polygons.size(); ++i)
                if (layers[i] == layer) painted[level_of(i)].insert(painted[level_of(i)].end(), polygons[i].begin(), polygons[i].end());
            for (const auto& [level, paths] : painted) cover(level, united(paths, ClipperLib::pftNonZero));
        }
        std::erase_if(levels_, [](const auto& one) { return one.second.empty(); });
    }

    double level_of(std::size_t member) const { return regions_[members_[member]].level; }

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

    // Corners where a border turns back on itself, by less than anybody sees: what rounding leaves where outlines nearly coincide.
    void remove_spikes(Path& path) const {
        const double small = 0.4 * tolerance_ * grid_.scale;
        Path kept;
        const auto is_spike = [&](const IntPoint& a, const IntPoint& b, const IntPoint& c) {
            if (a == b || b == c || a == c) return true;
            const double ux = double(b.X - a.X), uy = double(b.Y - a.Y), vx = double(c.X - b.X), vy = double(c.Y - b.Y);
            const double u = std::hypot(ux, uy), v = std::hypot(vx, vy);
            return std::min(u, v) < small && ux * vx + uy * vy < -0.85 * u * v;
        };
        for (const IntPoint& p : path) {
            while (kept.size() >= 2 && is_spike(kept[kept.size() - 2], kept.back(), p)) kept.pop_back();
            if (kept.empty() || kept.back() != p) kept.push_back(p);
        }
        // Round the seam.
        std::size_t begin = 0;
        for (bool changed = true; changed && kept.size() - begin > 2;) {
            changed = false;
            if (is_spike(kept[kept.size() - 2], kept.back(), kept[begin])) kept.pop_back(), changed = true;
            else if (is_spike(kept.back(), kept[begin], kept[begin + 1])) ++begin, changed = true;
        }
        path.assign(kept.begin() + std::ptrdiff_t(begin), kept.end());
        if (path.size() < 3) path.clear();
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
        std::vector<IntPoint> corners{};  // of the polygon, between a and b
        bool straight = false;            // drawn by its chords
        bool goes_on(const Piece& next) const { return left == next.left && right == next.right && style == next.style; }
    };

    // Which curve the edge is a chord of, and from where to where.
    Piece piece_of(const Edge& edge) const {
        Piece piece{edge.a, edge.b, {}, kNone, edge.left, edge.right, 0};
        double from = 0.0, to = 0.0;
        const auto begin = samples_at(edge.a), end = samples_at(edge.b);
        const auto take = [&](std::size_t curve, double a, double b) { piece.curve = curve, from = a, to = b; };
        for (const Sample& a : begin)
            for (const Sample& b : end)
                if (piece.curve == kNone && a.curve == b.curve && std::abs(a.k - b.k) == 1) take(a.curve, a.k, b.k);
        for (const Sample& a : begin)
            if (piece.curve == kNone)
                if (const auto share = share_beside(a, edge.b)) take(a.curve, a.k, a.k + *share);
        for (const Sample& b : end)
            if (piece.curve == kNone)
                if (const auto share = share_beside(b, edge.a)) take(b.curve, b.k + *share, b.k);
        if (piece.curve == kNone) {
            piece.style = style_of_level(edge.right);
            return piece;
        }
        const Curve& curve = curves_[piece.curve];
        piece.source = curve.source;
        piece.source.from = from / curve.chords, piece.source.to = to / curve.chords;
        piece.style = regions_[curve.source.region].style;
        return piece;
    }

    std::size_t style_of_level(double level) const {
        for (const std::size_t member : members_)
            if (regions_[member].level == level) return regions_[member].style;
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

    std::span<const Sample> samples_at(IntPoint p) const {
        const auto begin = std::lower_bound(samples_.begin(), samples_.end(), p, [](const Sample& a, const IntPoint& b) { return before(a.at, b); });
        auto end = begin;
        while (end != samples_.end() && end->at == p) ++end;
        return {begin, end};
    }

    // Ends of curves are where they were drawn; corners that arose on the way lie on the grid.
    Vec2 place(IntPoint p) const {
        for (const Sample& sample : samples_at(p)) {
            const Curve& curve = curves_[sample.curve];
            if (sample.k == 0) return curve.element.p0;
            if (sample.k == curve.chords) return curve.element.p2;
        }
        if (const auto found = crossings_.find(p); found != crossings_.end()) return found->second;
        return grid_.at(p);
    }

    std::vector<StepRun> make_runs() {
        std::vector<std::vector<Piece>> pieces(contours_.size());
        for (std::size_t c = 0; c < contours_.size(); ++c) {
            for (const Edge& edge : contours_[c]) pieces[c].push_back(piece_of(edge));
            for (std::size_t i = 0; i < pieces[c].size(); ++i) meet(pieces[c][i], pieces[c][(i + 1) % pieces[c].size()]);
        }
        while (undo_turned(pieces)) {}
        for (std::size_t c = 0; c < contours_.size(); ++c) {
            std::vector<bool> kept;
            for (const Edge& edge : contours_[c]) kept.push_back(edge.kept);
            add_runs(pieces[c], kept);
        }
        std::vector<StepRun> runs;
        for (int round = 0; round < 8; ++round) {
            runs.clear();
            for (const PieceRun& run : runs_) runs.push_back(run_of(run));
            if (!straighten(runs)) break;
        }
        return runs;
    }

    // Polygons never cross, but curves that nearly touch may, by less than the tolerance: those are drawn by their chords.
    // Whether there were any.
    bool straighten(const std::vector<StepRun>& runs) {
        std::vector<resolving::Chord> chords;
        std::vector<std::size_t> first;
        for (std::size_t r = 0; r < runs.size(); ++r) {
            first.push_back(chords.size());
            for (std::size_t i = 0; i < runs[r].elements.size(); ++i) {
                const Element& e = runs[r].elements[i];
                const int count = curve::chord_count(e, tolerance_);
                for (int k = 0; k < count; ++k)
                    chords.push_back({k == 0 ? e.p0 : curve::point(e, double(k) / count), k + 1 == count ? e.p2 : curve::point(e, double(k + 1) / count),
                                      0.0, 1.0, std::uint32_t(r), std::uint32_t(i)});
            }
        }
        if (chords.empty()) return false;
        const Vec2 size{double(1 << 29) / grid_.scale, double(1 << 29) / grid_.scale};
        const resolving::ChordIndex index(std::move(chords), size, false);
        const auto crossings = resolving::find_crossings(index, [](const resolving::Chord& a, const resolving::Chord& b, resolving::Shift) {
            return !(a.b == b.a || b.b == a.a || a.a == b.a || a.b == b.b);
        });
        bool changed = false;
        for (const resolving::ChordCrossing& crossing : crossings)
            for (const std::uint32_t c : {crossing.first, crossing.second}) {
                const resolving::Chord& chord = index.chords()[c];
                Piece& piece = runs_[chord.path].pieces[runs[chord.path].pieces[chord.element]];
                changed = changed || !piece.straight;
                piece.straight = true;
            }
        return changed;
    }

    // A crossing that moved so far that a piece beside it would run backwards, or be nothing, stays where the chords have it.
    bool undo_turned(std::vector<std::vector<Piece>>& pieces) {
        bool undone = false;
        for (std::vector<Piece>& contour : pieces)
            for (Piece& piece : contour) {
                const bool moved = crossings_.contains(piece.a) || crossings_.contains(piece.b);
                if (!moved || dot(place(piece.b) - place(piece.a), grid_.at(piece.b) - grid_.at(piece.a)) > 0.0) continue;
                crossings_.erase(piece.a);
                crossings_.erase(piece.b);
                piece.curve = kNone;
                undone = true;
            }
        return undone;
    }

    // Where chords of two curves cross the curves themselves cross nearby: there they are cut, or they would cross once more.
    void meet(Piece& one, Piece& next) {
        if (one.curve == kNone || next.curve == kNone || one.curve == next.curve || !samples_at(one.b).empty()) return;
        const Element &a = curves_[one.curve].element, &b = curves_[next.curve].element;
        double s = one.source.to, t = next.source.from;
        for (int round = 0; round < 8; ++round) {
            const Vec2 apart = curve::point(b, t) - curve::point(a, s), u = curve::derivative(a, s), v = curve::derivative(b, t);
            const double det = cross(u, v);
            if (std::abs(det) < 1e-3 * length(u) * length(v)) return;
            s += cross(apart, v) / det, t += cross(apart, u) / det;
            if (!(s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)) return;
        }
        const Vec2 at = curve::point(a, s);
        if (length(at - grid_.at(one.b)) > 4.0 * tolerance_ || length(at - curve::point(b, t)) > 1e-3 * tolerance_) return;
        one.source.to = s, next.source.from = t;
        crossings_.emplace(one.b, at);
    }

    // Chords of one curve that follow each other.
    static bool same_curve(const Piece& a, const Piece& b) {
        return a.curve != kNone && a.curve == b.curve && a.source.to == b.source.from && (a.source.to > a.source.from) == (b.source.to > b.source.from);
    }

    struct PieceRun {
        std::vector<Piece> pieces;
        bool closed = false;
    };

    void add_runs(const std::vector<Piece>& pieces, const std::vector<bool>& kept) {
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
        PieceRun run;
        for (std::size_t k = 0; k < n; ++k) {
            const Piece& piece = pieces[(start + k) % n];
            const bool shown = kept[(start + k) % n];
            if (!run.pieces.empty() && (!shown || !run.pieces.back().goes_on(piece))) runs_.push_back(std::exchange(run, {}));
            if (!shown) continue;
            if (!run.pieces.empty() && same_curve(run.pieces.back(), piece)) {
                Piece& whole = run.pieces.back();
                whole.corners.push_back(whole.b);
                whole.b = piece.b, whole.source.to = piece.source.to;
            } else {
                run.pieces.push_back(piece);
            }
        }
        run.closed = closed;
        if (!run.pieces.empty()) runs_.push_back(std::move(run));
    }

    StepRun run_of(const PieceRun& from) const {
        StepRun run;
        run.closed = from.closed;
        run.left = from.pieces.front().left, run.right = from.pieces.front().right, run.style = from.pieces.front().style;
        const auto add = [&](Element e, std::size_t piece, const StepSource& source) {
            if (e.kind == ElementKind::line) e.p1 = lerp(e.p0, e.p2, 0.5);
            e.width0 = e.width1 = e.height0 = e.height1 = 1.0;
            run.elements.push_back(e);
            run.sources.push_back(source);
            run.pieces.push_back(piece);
        };
        for (std::size_t i = 0; i < from.pieces.size(); ++i) {
            const Piece& piece = from.pieces[i];
            Element e;
            if (piece.curve != kNone && !piece.straight) {
                const Element& whole = curves_[piece.curve].element;
                const bool turned = piece.source.to < piece.source.from;
                e = turned ? curve::part(whole, piece.source.to, piece.source.from) : curve::part(whole, piece.source.from, piece.source.to);
                e.p0 = place(piece.a), e.p2 = place(piece.b);
                add(e, i, piece.source);
                continue;
            }
            IntPoint at = piece.a;
            const StepSource source = curves_.empty() || piece.corners.empty() ? piece.source : StepSource{piece.source.region};
            for (std::size_t k = 0; k <= piece.corners.size(); ++k) {
                const IntPoint next = k < piece.corners.size() ? piece.corners[k] : piece.b;
                e.p0 = place(at), e.p2 = place(next);
                add(e, i, source);
                at = next;
            }
        }
        return run;
    }

    const std::vector<Region>& regions_;
    std::vector<std::size_t> members_;  // in the order they are painted
    Grid grid_;
    double tolerance_;
    std::vector<Curve> curves_;
    std::vector<Sample> samples_;  // by place
    std::map<double, Paths> levels_;
    std::vector<std::vector<Edge>> contours_;
    std::vector<PieceRun> runs_;
    std::unordered_map<IntPoint, Vec2, PointHash> crossings_;  // where curves cross whose chords do at a corner
};

Box box_of(const Region& region) {
    Box out;
    for (const Subpath& subpath : *region.outline)
        for (const Element& e : subpath.elements) {
            const Box box = curve::control_box(e);
            out.low = {std::min(out.low.x, box.low.x), std::min(out.low.y, box.low.y)};
            out.high = {std::max(out.high.x, box.high.x), std::max(out.high.y, box.high.y)};
        }
    return out;
}

// 2^29 steps across all outlines: within what Clipper computes in 64 bits.
Grid grid_over(const std::vector<Box>& boxes, Vec2 size) {
    Vec2 low{0.0, 0.0}, high = size;
    for (const Box& box : boxes) {
        low = {std::min(low.x, box.low.x), std::min(low.y, box.low.y)};
        high = {std::max(high.x, box.high.x), std::max(high.y, box.high.y)};
    }
    return {(low + high) * 0.5, double(1 << 29) / std::max(high.x - low.x, high.y - low.y)};
}

// Members of each cluster, in order: regions whose boxes meet, found from left to right.
std::vector<std::vector<std::size_t>> clusters_of(const std::vector<Box>& boxes, double margin) {
    std::vector<std::size_t> leader(boxes.size()), order;
    std::iota(leader.begin(), leader.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (leader[i] != i) i = leader[i] = leader[leader[i]];
        return i;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].low.x <= boxes[i].high.x) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return boxes[i].low.x < boxes[j].low.x; });
    std::vector<std::size_t> active;
    for (const std::size_t i : order) {
        std::erase_if(active, [&](std::size_t j) { return boxes[j].high.x + margin < boxes[i].low.x; });
        for (const std::size_t j : active)
            if (boxes[j].low.y <= boxes[i].high.y + margin && boxes[i].low.y <= boxes[j].high.y + margin) {
                const std::size_t a = find(i), b = find(j);
                leader[std::max(a, b)] = std::min(a, b);
            }
        active.push_back(i);
    }
    std::map<std::size_t, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].low.x <= boxes[i].high.x) members[find(i)].push_back(i);
    std::vector<std::vector<std::size_t>> out;
    for (auto& [first, list] : members) out.push_back(std::move(list));
    return out;
}

}  // namespace

std::vector<StepRun> trace_steps(const std::vector<Region>& regions, const StepOptions& options) {
    std::vector<Box> boxes;
    for (const Region& region : regions) boxes.push_back(box_of(region));
    const Grid grid = grid_over(boxes, options.size);
    const auto clusters = clusters_of(boxes, 4.0 / grid.scale);
    std::vector<std::vector<StepRun>> traced(clusters.size());
    for_each_piece(clusters.size(), options.threads, [&](std::size_t i) { traced[i] = Cluster(regions, clusters[i], grid, options.tolerance).trace(); });
    std::vector<StepRun> runs;
    for (auto& list : traced) runs.insert(runs.end(), std::make_move_iterator(list.begin()), std::make_move_iterator(list.end()));
    return runs;
}

}  // namespace burin::svg
