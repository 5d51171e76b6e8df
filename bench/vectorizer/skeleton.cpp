#include "skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <burin/fit.hpp>

namespace burin::bench {
namespace {

constexpr double kCell = 2.0;          // of the sample index, texels
constexpr double kTogether = 1.5;      // places so near each other are one node
constexpr double kThrough = 1.0;       // a strand so near a node goes through it
constexpr double kArm = 2.5;           // where an arm's direction is taken
constexpr double kStraight = 0.35;     // two arms that miss being opposite by less go straight on: 20 degrees
constexpr double kKink = 0.2;          // joints that turn by less are no corner, whatever their arms
constexpr double kPi = 3.14159265358979323846;

Vec2 tangent(const Element& e, bool at_end) {
    if (e.kind == ElementKind::line) return unit(e.p2 - e.p0);
    return unit(at_end ? e.p2 - e.p1 : e.p1 - e.p0);
}

double turn(Vec2 a, Vec2 b) { return std::abs(std::atan2(cross(a, b), dot(a, b))); }

Strand sampled(const Path& path, const Profile& profile, double scale) {
    Strand strand;
    strand.closed = path.closed;
    strand.step = std::abs(profile.points.back().h - profile.points.front().h) > 0.0;
    for (const Element& e : path.elements) {
        double chords = 0.0;
        for (int k = 0; k < 8; ++k) chords += length(point_at(e, (k + 1) / 8.0) - point_at(e, k / 8.0));
        // Quadratics run unevenly: twice the samples of their mean speed.
        const int count = std::max(1, static_cast<int>(std::ceil(2.0 * chords * scale / Strand::kSpacing)));
        for (int k = 0; k < count; ++k) strand.points.push_back(point_at(e, double(k) / count) * scale);
    }
    if (!path.closed) strand.points.push_back(path.elements.back().p2 * scale);
    return strand;
}

// The runs of a strand's points that lie on the sheet: outside it nothing acts. Where a run leaves the sheet it ends on
// the border.
void add_inside(const Strand& strand, double side, std::vector<Strand>& out) {
    const auto inside = [side](Vec2 p) { return p.x >= 0.0 && p.x <= side && p.y >= 0.0 && p.y <= side; };
    const auto on_sheet = [side](Vec2 p) { return Vec2{std::clamp(p.x, 0.0, side), std::clamp(p.y, 0.0, side)}; };
    if (std::all_of(strand.points.begin(), strand.points.end(), inside)) return out.push_back(strand);
    // A closed strand is walked from a point outside on, so that no run goes over its first point.
    std::vector<Vec2> points = strand.points;
    if (strand.closed) {
        std::rotate(points.begin(), std::find_if_not(points.begin(), points.end(), inside), points.end());
        points.push_back(points.front());
    }
    Strand run{{}, false, strand.step};
    const auto finish = [&] {
        if (run.points.size() > 1) out.push_back(run);
        run.points.clear();
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool here = inside(points[i]);
        const bool neighbour = (i > 0 && inside(points[i - 1])) || (i + 1 < points.size() && inside(points[i + 1]));
        if (here || neighbour) run.points.push_back(on_sheet(points[i]));
        if (!here && i > 0 && inside(points[i - 1])) finish(), run.points = {on_sheet(points[i])};
        if (!here && !neighbour) run.points.clear();
    }
    finish();
}

// Joints of one path that turn.
void add_kinks(const Path& path, double scale, std::vector<Vec2>& places) {
    const std::size_t count = path.elements.size();
    for (std::size_t i = path.closed ? 0 : 1; i < count; ++i) {
        const Element& before = path.elements[(i + count - 1) % count];
        const Element& after = path.elements[i];
        if (turn(tangent(before, true), tangent(after, false)) > kKink) places.push_back(after.p0 * scale);
    }
}

// Where segments of the samples cross: each segment against those that begin near it.
void add_crossings(const SampleIndex& index, std::vector<Vec2>& places) {
    const std::vector<Strand>& strands = index.strands();
    const auto segment = [&](std::size_t s, std::size_t i, Vec2& a, Vec2& d) {
        const Strand& strand = strands[s];
        if (i + 1 == strand.points.size() && !strand.closed) return false;
        a = strand.points[i];
        d = index.sheet().from_to(a, strand.points[(i + 1) % strand.points.size()]);
        return true;
    };
    for (std::size_t s = 0; s < strands.size(); ++s) {
        for (std::size_t i = 0; i < strands[s].points.size(); ++i) {
            Vec2 a, d;
            if (!segment(s, i, a, d)) continue;
            for (const auto& other : index.near(a, 2.0 * Strand::kSpacing)) {
                if (std::pair{std::size_t{other.strand}, std::size_t{other.point}} <= std::pair{s, i}) continue;
                const std::size_t apart = other.point > i ? other.point - i : i - other.point;
                const bool neighbours = other.strand == s && (apart < 2 || apart + 2 > strands[s].points.size());
                Vec2 b, e;
                if (neighbours || !segment(other.strand, other.point, b, e)) continue;
                const Vec2 way = index.sheet().from_to(a, b);
                const double area = cross(d, e);
                if (area == 0.0) continue;
                const double along = cross(way, e) / area, along_other = cross(way, d) / area;
                if (along >= 0.0 && along < 1.0 && along_other >= 0.0 && along_other < 1.0) places.push_back(a + d * along);
            }
        }
    }
}

// Means of groups of places that hang together.
std::vector<Vec2> merged(const std::vector<Vec2>& places, const Sheet& sheet) {
    std::vector<std::size_t> group(places.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (group[i] != i) i = group[i] = group[group[i]];
        return i;
    };
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (sheet.distance(places[i], places[j]) < kTogether) group[root(i)] = root(j);
    std::vector<Vec2> sums(places.size());
    std::vector<int> counts(places.size(), 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::size_t r = root(i);
        sums[r] = sums[r] + sheet.from_to(places[r], places[i]);
        ++counts[r];
    }
    std::vector<Vec2> means;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (counts[i] > 0) means.push_back(places[i] + sums[i] * (1.0 / counts[i]));
    return means;
}

// A strand at a node: its nearest sample and the arms it sends out.
struct Visit {
    std::uint32_t strand, point;
    int arms[2] = {-1, -1};  // indices of arms; -1: it ends here
};

// The first sample at least kArm away from the node, walking from a point forward or backward.
bool arm_from(const Strand& strand, const Sheet& sheet, std::size_t point, bool forward, Vec2 node, Vec2& direction) {
    const std::size_t count = strand.points.size();
    for (std::size_t walked = 1; walked < count; ++walked) {
        if (!strand.closed && (forward ? point + walked >= count : walked > point)) return false;
        const std::size_t at = forward ? (point + walked) % count : (point + count - walked) % count;
        const Vec2 way = sheet.from_to(node, strand.points[at]);
        if (length(way) >= kArm) return direction = unit(way), true;
    }
    return false;
}

// Strands through a node: the nearest sample of each run of samples that lies near it.
std::vector<Visit> visits_at(const SampleIndex& index, Vec2 node) {
    auto near = index.near(node, kThrough);
    std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
        return std::pair{a.strand, a.point} < std::pair{b.strand, b.point};
    });
    const auto distance = [&](const SampleIndex::Sample& s) {
        return index.sheet().distance(node, index.strands()[s.strand].points[s.point]);
    };
    std::vector<Visit> visits;
    for (std::size_t i = 0; i < near.size();) {
        std::size_t end = i + 1;
        while (end < near.size() && near[end].strand == near[i].strand && near[end].point == near[end - 1].point + 1) ++end;
        const auto best = *std::min_element(near.begin() + i, near.begin() + end, [&](const auto& a, const auto& b) {
            return distance(a) < distance(b);
        });
        // The run of a closed strand may go on over its first sample.
        const std::size_t last = index.strands()[best.strand].points.size() - 1;
        const bool wraps = index.strands()[best.strand].closed && near[end - 1].point == last && !visits.empty();
        const auto first = std::find_if(visits.begin(), visits.end(), [&](const Visit& v) { return v.strand == best.strand; });
        const bool known = wraps && first != visits.end() &&
                           std::any_of(near.begin(), near.end(), [&](const auto& s) { return s.strand == best.strand && s.point == 0; });
        if (!known) visits.push_back({best.strand, best.point, {-1, -1}});
        i = end;
    }
    return visits;
}

// Which arms lie opposite each other: the straightest pairs first. Of an arm without partner: -1.
std::vector<int> partners_of(const std::vector<Vec2>& arms) {
    std::vector<int> partner(arms.size(), -1);
    for (;;) {
        double best = kStraight;
        std::size_t a = 0, b = 0;
        for (std::size_t i = 0; i < arms.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (const double miss = kPi - turn(arms[i], arms[j]); partner[i] < 0 && partner[j] < 0 && miss < best)
                    best = miss, a = i, b = j;
        if (a == b) return partner;
        partner[a] = static_cast<int>(b), partner[b] = static_cast<int>(a);
    }
}

NodeKind kind_of(std::size_t arms, std::size_t pairs) {
    if (arms <= 1) return NodeKind::end;
    if (arms == 2) return NodeKind::corner;
    if (arms == 3) return pairs > 0 ? NodeKind::tee : NodeKind::wye;
    return arms == 4 && pairs == 2 ? NodeKind::cross : NodeKind::star;
}

class Builder {
  public:
    Builder(const Pattern& pattern, const Sheet& sheet) : sheet_(sheet) {
        const double scale = sheet.side / pattern.size.x;
        for (const Path& path : pattern.paths) {
            if (path.elements.empty()) continue;
            add_kinks(path, scale, places_);
            const Strand strand = sampled(path, pattern.profiles[path.profile], scale);
            sheet.repeats ? strands_.push_back(strand) : add_inside(strand, sheet.side, strands_);
        }
        for (const Strand& strand : strands_)
            if (!strand.closed) places_.insert(places_.end(), {strand.points.front(), strand.points.back()});
    }

    Skeleton build() {
        const SampleIndex index(strands_, sheet_);
        add_crossings(index, places_);
        cuts_.assign(strands_.size(), {});
        for (const Vec2 place : merged(places_, sheet_)) add_node(index, place);
        Skeleton out;
        out.nodes = std::move(nodes_);
        for (std::size_t s = 0; s < strands_.size(); ++s) cut(strands_[s], cuts_[s], out.strands);
        return out;
    }

  private:
    void add_node(const SampleIndex& index, Vec2 place) {
        std::vector<Visit> visits = visits_at(index, place);
        if (visits.empty()) return;  // outside the sheet
        std::vector<Vec2> arms;
        for (Visit& visit : visits) {
            for (const int forward : {0, 1}) {
                Vec2 direction;
                if (!arm_from(strands_[visit.strand], sheet_, visit.point, forward == 1, place, direction)) continue;
                visit.arms[forward] = static_cast<int>(arms.size());
                arms.push_back(direction);
            }
        }
        const std::vector<int> partner = partners_of(arms);
        const std::size_t pairs = (arms.size() - std::count(partner.begin(), partner.end(), -1)) / 2;
        if (arms.size() == 2 && pairs == 1) return;  // one strand goes straight on
        nodes_.push_back({kind_of(arms.size(), pairs), place});
        if (arms.size() < 3) return;
        for (const Visit& v : visits)
            if (v.arms[0] >= 0 && v.arms[1] >= 0 && partner[v.arms[0]] != v.arms[1]) cuts_[v.strand].push_back(v.point);
    }

    static void cut(const Strand& strand, std::vector<std::size_t> cuts, std::vector<Strand>& out) {
        std::sort(cuts.begin(), cuts.end());
        cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
        if (cuts.empty()) return out.push_back(strand);
        const std::size_t count = strand.points.size();
        std::vector<std::pair<std::size_t, std::size_t>> pieces;  // first and last point, the last counted on beyond count
        for (std::size_t i = 0; i + 1 < cuts.size(); ++i) pieces.push_back({cuts[i], cuts[i + 1]});
        if (strand.closed) {
            pieces.push_back({cuts.back(), cuts.front() + count});
        } else {
            pieces.push_back({0, cuts.front()});
            pieces.push_back({cuts.back(), count - 1});
        }
        for (const auto& [first, last] : pieces) {
            Strand piece;
            piece.step = strand.step;
            for (std::size_t i = first; i <= last; ++i) piece.points.push_back(strand.points[i % count]);
            out.push_back(std::move(piece));
        }
    }

    Sheet sheet_;
    std::vector<Strand> strands_;
    std::vector<Vec2> places_;
    std::vector<Node> nodes_;
    std::vector<std::vector<std::size_t>> cuts_;
};

}  // namespace

Vec2 Sheet::from_to(Vec2 a, Vec2 b) const {
    Vec2 d = b - a;
    if (repeats) d = {d.x - side * std::round(d.x / side), d.y - side * std::round(d.y / side)};
    return d;
}

SampleIndex::SampleIndex(const std::vector<Strand>& strands, const Sheet& sheet)
    : strands_(strands), sheet_(sheet), cells_(static_cast<int>(sheet.side / kCell)) {
    for (std::size_t s = 0; s < strands.size(); ++s)
        for (std::size_t i = 0; i < strands[s].points.size(); ++i) {
            const Vec2 p = strands[s].points[i];
            samples_[cell_of(static_cast<int>(std::floor(p.x / kCell)), static_cast<int>(std::floor(p.y / kCell)))].push_back(
                {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(i)});
        }
}

std::int64_t SampleIndex::cell_of(int x, int y) const {
    if (sheet_.repeats) x = ((x % cells_) + cells_) % cells_, y = ((y % cells_) + cells_) % cells_;
    return (static_cast<std::int64_t>(y) << 32) ^ static_cast<std::uint32_t>(x);
}

std::vector<SampleIndex::Sample> SampleIndex::near(Vec2 place, double radius) const {
    std::vector<Sample> found;
    const int cx = static_cast<int>(std::floor(place.x / kCell)), cy = static_cast<int>(std::floor(place.y / kCell));
    for (int y = cy - 1; y <= cy + 1; ++y)
        for (int x = cx - 1; x <= cx + 1; ++x)
            if (const auto cell = samples_.find(cell_of(x, y)); cell != samples_.end())
                for (const Sample& s : cell->second)
                    if (sheet_.distance(place, strands_[s.strand].points[s.point]) <= radius) found.push_back(s);
    return found;
}

Skeleton skeleton_of(const Pattern& pattern, const Sheet& sheet) { return Builder(pattern, sheet).build(); }

}  // namespace burin::bench
