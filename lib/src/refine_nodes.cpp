#include "refine_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <burin/resolve.hpp>

namespace burin::refinement {
namespace {

constexpr double kSamePoint = 1e-5;      // texels
constexpr double kCollinearAngle = 1e-4; // radians between lines that are one straight line
constexpr int kDeepest = 8;              // ends on elements whose ends lie on elements ...; stops at cycles
constexpr double kBucket = 32.0;         // texels

Vec2 bernstein_point(const std::array<Vec2, 3>& p, bool line, double s) {
    return line ? lerp(p[0], p[2], s) : lerp(lerp(p[0], p[1], s), lerp(p[1], p[2], s), s);
}

Vec2 bernstein_tangent(const std::array<Vec2, 3>& p, bool line, double s) {
    return line ? p[2] - p[0] : 2.0 * lerp(p[1] - p[0], p[2] - p[1], s);
}

std::array<double, 3> bernstein_weights(bool line, double s) {
    if (line) return {1.0 - s, 0.0, s};
    return {(1.0 - s) * (1.0 - s), 2.0 * s * (1.0 - s), s * s};
}

Vec2 start_tangent(const Element& e) {
    return unit(e.kind == ElementKind::line || e.p1 == e.p0 ? e.p2 - e.p0 : e.p1 - e.p0);
}
Vec2 end_tangent(const Element& e) {
    return unit(e.kind == ElementKind::line || e.p1 == e.p2 ? e.p2 - e.p0 : e.p2 - e.p1);
}
double chord(const Element& e) { return length(e.p2 - e.p0); }

// Nearest curve parameter in [0, 1], and the distance.
std::pair<double, double> nearest_on(const Element& e, Vec2 p) {
    const std::array<Vec2, 3> points{e.p0, e.p1, e.p2};
    const bool line = e.kind == ElementKind::line;
    double best = 0.0, distance = 1e300;
    const int samples = line ? 1 : 16;
    for (int i = 0; i <= samples; ++i) {
        const double d = length(bernstein_point(points, line, double(i) / samples) - p);
        if (d < distance) distance = d, best = double(i) / samples;
    }
    for (int i = 0; i < 20; ++i) {
        const Vec2 tangent = bernstein_tangent(points, line, best);
        const double square = dot(tangent, tangent);
        if (square <= 0.0) break;
        best = std::clamp(best + dot(p - bernstein_point(points, line, best), tangent) / square, 0.0, 1.0);
    }
    return {best, length(bernstein_point(points, line, best) - p)};
}

}  // namespace

// Builds the nodes of a pattern.
class NodeBuilder {
  public:
    NodeBuilder(Nodes& out, const Pattern& pattern, double snap) : out_(out), pattern_(pattern), snap_(snap) {}

    void build() {
        for (std::size_t path = 0; path < pattern_.paths.size(); ++path) add_points(static_cast<int>(path));
        for (std::size_t path = 0; path < pattern_.paths.size(); ++path) tie_joints(static_cast<int>(path));
        fill_buckets();
        for (std::size_t path = 0; path < pattern_.paths.size(); ++path) {
            if (pattern_.paths[path].closed || pattern_.paths[path].elements.empty() || is_dot(path)) continue;
            attach_end(static_cast<int>(path), true);
            attach_end(static_cast<int>(path), false);
        }
    }

  private:

    bool repeats() const { return pattern_.wrap == Wrap::repeat; }

    Vec2 tile_of(Vec2 p) const {
        if (!repeats()) return {};
        return {std::floor((p.x + kSamePoint) / pattern_.size.x) * pattern_.size.x,
                std::floor((p.y + kSamePoint) / pattern_.size.y) * pattern_.size.y};
    }

    int new_node(Vec2 p) {
        Node node;
        node.position = node.origin = p;
        out_.nodes_.push_back(node);
        interior_.push_back(0);
        return static_cast<int>(out_.nodes_.size()) - 1;
    }

    // The node at p, welded to one that is there.
    NodeUse vertex(Vec2 p) {
        const Vec2 offset = tile_of(p);
        const Vec2 q = p - offset;
        const auto key = [](double x) { return static_cast<long long>(std::floor(x / (4.0 * kSamePoint))); };
        const long long kx = key(q.x), ky = key(q.y);
        for (long long y = ky - 1; y <= ky + 1; ++y) {
            for (long long x = kx - 1; x <= kx + 1; ++x) {
                const auto found = by_place_.find({x, y});
                if (found != by_place_.end() && length(out_.nodes_[found->second].position - q) < kSamePoint)
                    return {found->second, offset};
            }
        }
        const int node = new_node(q);
        by_place_[{kx, ky}] = node;
        return {node, offset};
    }

    // As resolve.hpp says: it meets nothing. It is moved as a whole, or its ends would run into each other.
    bool is_dot(std::size_t path) const {
        const Path& p = pattern_.paths[path];
        return !p.closed && p.elements.size() == 1 && p.elements[0].kind == ElementKind::line &&
               chord(p.elements[0]) <= 2.0 * snap_;
    }

    void add_dot(int path) {
        const Element& e = pattern_.paths[path].elements[0];
        const Vec2 offset = tile_of(e.p0);
        const int node = new_node(e.p0 - offset);
        out_.elements_.push_back({{NodeUse{node, offset}, NodeUse{}, NodeUse{node, offset + (e.p2 - e.p0)}}});
    }

    void add_points(int path) {
        if (is_dot(static_cast<std::size_t>(path))) return add_dot(path);
        const std::vector<Element>& elements = pattern_.paths[path].elements;
        std::vector<Nodes::ElementNodes> uses(elements.size());
        for (std::size_t i = 0; i < elements.size(); ++i) {
            uses[i][0] = i > 0 ? uses[i - 1][2] : vertex(elements[i].p0);
            if (elements[i].kind == ElementKind::quadratic) uses[i][1] = {new_node(elements[i].p1), {}};
            uses[i][2] = vertex(elements[i].p2);
            if (i > 0) interior_[uses[i][0].node] = 1;
        }
        if (pattern_.paths[path].closed && !uses.empty()) interior_[uses[0][0].node] = 1;
        out_.elements_.push_back(std::move(uses));
    }

    // Whether the joint before element i is one of a straight line or of a smooth curve.
    bool is_smooth(int path, std::size_t i) const {
        const Path& p = pattern_.paths[path];
        if (i == 0 && !p.closed) return false;
        const Element& before = p.elements[(i + p.elements.size() - 1) % p.elements.size()];
        const Element& after = p.elements[i % p.elements.size()];
        const Vec2 in = end_tangent(before), out = start_tangent(after);
        const double angle = std::atan2(std::abs(cross(in, out)), dot(in, out));
        const bool lines = before.kind == ElementKind::line && after.kind == ElementKind::line;
        return angle < (lines ? kCollinearAngle : ResolveOptions{}.smooth_angle);
    }

    // The corner of the tangent polygon before (direction -1) or after (+1) joint i, in the joint's own tile.
    NodeUse polygon_corner(int path, std::size_t joint, int direction) const {
        const std::vector<Nodes::ElementNodes>& uses = out_.elements_[path];
        const std::vector<Element>& elements = pattern_.paths[path].elements;
        const std::size_t count = elements.size();
        const Vec2 turn = pattern_.paths[path].closed ? elements.back().p2 - elements.front().p0 : Vec2{};
        std::size_t i = joint;
        Vec2 offset;
        for (std::size_t steps = 0; steps < count; ++steps) {
            if (direction < 0 && i == 0) offset = offset - rounded_to_tile(turn), i = count;
            const std::size_t element = direction < 0 ? i - 1 : i;
            const bool line = elements[element].kind == ElementKind::line;
            const NodeUse& use = uses[element][line ? (direction < 0 ? 0 : 2) : 1];
            i = direction < 0 ? i - 1 : i + 1;
            const bool at_end = !pattern_.paths[path].closed && i == count;
            if (!line || at_end || !is_smooth(path, i)) return {use.node, use.offset + offset};
            if (direction > 0 && i == count) offset = offset + rounded_to_tile(turn), i = 0;
        }
        return {};
    }

    Vec2 rounded_to_tile(Vec2 p) const {
        if (!repeats()) return {};
        return {std::round(p.x / pattern_.size.x) * pattern_.size.x, std::round(p.y / pattern_.size.y) * pattern_.size.y};
    }

    void tie_joints(int path) {
        const std::vector<Element>& elements = pattern_.paths[path].elements;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (!is_smooth(path, i)) continue;
            const NodeUse own = out_.elements_[path][i][0];
            const NodeUse a = polygon_corner(path, i, -1), b = polygon_corner(path, i, +1);
            if (a.node < 0 || b.node < 0 || out_.nodes_[own.node].kind != Node::Kind::free) continue;
            const Vec2 from = out_.nodes_[a.node].position + a.offset - own.offset;
            const Vec2 to = out_.nodes_[b.node].position + b.offset - own.offset;
            if (length(to - from) < 1e-3 || a.node == own.node || b.node == own.node) continue;
            Node& node = out_.nodes_[own.node];
            node.kind = Node::Kind::between;
            node.a = {a.node, a.offset - own.offset};
            node.b = {b.node, b.offset - own.offset};
            node.at = std::clamp(dot(node.position - from, to - from) / dot(to - from, to - from), 0.0, 1.0);
            const Element& before = elements[(i + elements.size() - 1) % elements.size()];
            node.most_slide = 0.2 * std::min(chord(before), chord(elements[i]));
        }
    }

    void fill_buckets() {
        for (std::size_t path = 0; path < pattern_.paths.size(); ++path) {
            if (is_dot(path)) continue;
            const std::vector<Element>& elements = pattern_.paths[path].elements;
            for (std::size_t i = 0; i < elements.size(); ++i) {
                const Element& e = elements[i];
                const Vec2 middle = e.kind == ElementKind::line ? e.p0 : e.p1;
                const double x0 = std::min({e.p0.x, middle.x, e.p2.x}) - snap_, x1 = std::max({e.p0.x, middle.x, e.p2.x}) + snap_;
                const double y0 = std::min({e.p0.y, middle.y, e.p2.y}) - snap_, y1 = std::max({e.p0.y, middle.y, e.p2.y}) + snap_;
                for (int y = bucket(y0); y <= bucket(y1); ++y)
                    for (int x = bucket(x0); x <= bucket(x1); ++x)
                        buckets_[{x, y}].push_back({static_cast<int>(path), static_cast<int>(i)});
            }
        }
    }

    static int bucket(double x) { return static_cast<int>(std::floor(x / kBucket)); }

    void attach_end(int path, bool at_start) {
        const std::size_t own_element = at_start ? 0 : pattern_.paths[path].elements.size() - 1;
        const NodeUse use = out_.elements_[path][own_element][at_start ? 0 : 2];
        Node& node = out_.nodes_[use.node];
        if (node.kind != Node::Kind::free || interior_[use.node]) return;
        double nearest = snap_;
        const int span = repeats() ? 1 : 0;
        for (int j = -span; j <= span; ++j) {
            for (int i = -span; i <= span; ++i) {
                const Vec2 offset{i * pattern_.size.x, j * pattern_.size.y};
                const Vec2 p = node.position - offset;
                const auto found = buckets_.find({bucket(p.x), bucket(p.y)});
                if (found == buckets_.end()) continue;
                for (const auto& [other, index] : found->second)
                    try_element(use.node, other, index, offset, nearest);
            }
        }
        if (node.kind == Node::Kind::free && !repeats()) hold_on_border(node);
    }

    void try_element(int index, int path, int element, Vec2 offset, double& nearest) {
        Node& node = out_.nodes_[index];
        const Nodes::ElementNodes& uses = out_.elements_[path][element];
        if (uses[0].node == index || uses[2].node == index) return;
        const Element& e = pattern_.paths[path].elements[element];
        const auto [parameter, distance] = nearest_on(e, node.position - offset);
        if (distance >= nearest) return;
        nearest = distance;
        node.kind = Node::Kind::on_element;
        node.path = path;
        node.element = element;
        node.element_offset = offset;
        node.at = parameter;
        node.most_slide = 0.4 * chord(e);
    }

    void hold_on_border(Node& node) const {
        const auto on = [](double x, double size) { return std::abs(x) < 1e-3 || std::abs(x - size) < 1e-3; };
        node.moves_x = !on(node.position.x, pattern_.size.x);
        node.moves_y = !on(node.position.y, pattern_.size.y);
    }

    Nodes& out_;
    const Pattern& pattern_;
    const double snap_;
    std::map<std::pair<long long, long long>, int> by_place_;
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> buckets_;
    std::vector<char> interior_;  // by node: a path runs through it
};

Nodes::Nodes(const Pattern& pattern, double snap, bool hold, int first_unknown) {
    NodeBuilder(*this, pattern, snap).build();
    if (hold) return;
    for (Node& node : nodes_) {
        const int degrees = node.kind == Node::Kind::free ? int(node.moves_x) + int(node.moves_y) : 1;
        if (degrees == 0) continue;
        node.unknown = first_unknown + unknowns_;
        unknowns_ += degrees;
    }
}

std::array<Vec2, 3> Nodes::points(int path, int element, int depth) const {
    std::array<Vec2, 3> out{};
    for (int k = 0; k < 3; ++k) {
        const NodeUse& use = elements_[path][element][k];
        if (use.node >= 0) out[k] = place(use.node, depth) + use.offset;
    }
    return out;
}

Vec2 Nodes::place(int index, int depth) const {
    const Node& node = nodes_[index];
    if (node.kind == Node::Kind::free || depth >= kDeepest) return node.position;
    if (node.kind == Node::Kind::between)
        return lerp(place(node.a.node, depth + 1) + node.a.offset, place(node.b.node, depth + 1) + node.b.offset, node.at);
    const bool line = elements_[node.path][node.element][1].node < 0;
    return bernstein_point(points(node.path, node.element, depth + 1), line, node.at) + node.element_offset;
}

Vec2 Nodes::guide(const Node& node, int depth) const {
    if (node.kind == Node::Kind::between)
        return place(node.b.node, depth + 1) + node.b.offset - place(node.a.node, depth + 1) - node.a.offset;
    const bool line = elements_[node.path][node.element][1].node < 0;
    return bernstein_tangent(points(node.path, node.element, depth + 1), line, node.at);
}

void Nodes::add_terms(int index, double factor, int depth, std::vector<PointTerm>& out) const {
    const Node& node = nodes_[index];
    if (std::abs(factor) < 1e-12) return;
    if (node.kind == Node::Kind::free) {
        int unknown = node.unknown;
        if (unknown < 0) return;
        if (node.moves_x) out.push_back({unknown++, {factor, 0.0}});
        if (node.moves_y) out.push_back({unknown, {0.0, factor}});
        return;
    }
    if (depth >= kDeepest) return;
    if (node.unknown >= 0) out.push_back({node.unknown, unit(guide(node, depth)) * factor});
    if (node.kind == Node::Kind::between) {
        add_terms(node.a.node, factor * (1.0 - node.at), depth + 1, out);
        add_terms(node.b.node, factor * node.at, depth + 1, out);
        return;
    }
    const ElementNodes& uses = elements_[node.path][node.element];
    const std::array<double, 3> weights = bernstein_weights(uses[1].node < 0, node.at);
    for (int k = 0; k < 3; ++k)
        if (uses[k].node >= 0) add_terms(uses[k].node, factor * weights[k], depth + 1, out);
}

std::vector<PointTerm> Nodes::terms(int path, int element, int point) const {
    std::vector<PointTerm> out;
    const NodeUse& use = elements_[path][element][point];
    if (use.node >= 0) add_terms(use.node, 1.0, 0, out);
    return out;
}

void Nodes::move(const std::vector<double>& step, double most_shift) {
    // Guides are taken before anything moves: they are what the step was computed with.
    std::vector<double> guide_lengths(nodes_.size(), 1.0);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (nodes_[i].kind != Node::Kind::free) guide_lengths[i] = std::max(1e-6, length(guide(nodes_[i], 0)));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        if (node.unknown < 0) continue;
        if (node.kind == Node::Kind::free) {
            int unknown = node.unknown;
            Vec2 shift = node.position - node.origin;
            if (node.moves_x) shift.x += step[unknown++];
            if (node.moves_y) shift.y += step[unknown];
            const double far = length(shift);
            if (far > most_shift) shift = shift * (most_shift / far);
            node.position = node.origin + shift;
            continue;
        }
        const double most = std::min(most_shift, node.most_slide);
        const double slid = std::clamp(node.slid + step[node.unknown], -most, most);
        node.at = std::clamp(node.at + (slid - node.slid) / guide_lengths[i], 1e-4, 1.0 - 1e-4);
        node.slid = slid;
    }
}

void Nodes::write(Pattern& pattern) const {
    std::vector<Vec2> places(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) places[i] = place(static_cast<int>(i), 0);
    for (std::size_t path = 0; path < elements_.size(); ++path) {
        for (std::size_t i = 0; i < elements_[path].size(); ++i) {
            const ElementNodes& uses = elements_[path][i];
            Element& e = pattern.paths[path].elements[i];
            e.p0 = places[uses[0].node] + uses[0].offset;
            if (uses[1].node >= 0) e.p1 = places[uses[1].node] + uses[1].offset;
            e.p2 = places[uses[2].node] + uses[2].offset;
        }
    }
}

double Nodes::largest_shift() const {
    double largest = 0.0;
    for (const Node& node : nodes_)
        if (node.kind == Node::Kind::free) largest = std::max(largest, length(node.position - node.origin));
    return largest;
}

}  // namespace burin::refinement
