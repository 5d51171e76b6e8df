// Joins strands at nodes: a line that crosses another stays one chain, the rest become corners, T ends or stars.
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace burin::vectorizing {
namespace {

// One end of a strand at a node, in the node's frame (its position is the origin).
struct Arm {
    int strand = 0;
    int end = 0;       // 0 front, 1 back
    Vec2 foot;         // a point of the fitted end line, near the node
    Vec2 direction;    // unit, towards the node
    TailCurve tail;    // the way from the strand's last point towards the node
    double half_width = 0.0, contrast = 0.0;
    int partner = -1;  // index of the arm that continues it
    bool cornered = false;
    bool tied = false;
    Vec2 target;       // where the chain ends, or the corner, in the node's frame
    EndTie tie = EndTie::node;
};

struct Joint {
    std::vector<Arm> arms;
};

// Total least squares line through the strand's points nearest to the given end.
Arm make_arm(const Strand& strand, int index, int end, const SkeletonNode& node, const Lattice& lattice) {
    Arm arm;
    arm.strand = index;
    arm.end = end;
    arm.half_width = strand.half_width;
    arm.contrast = strand.contrast;
    const std::vector<Vec2>& source = strand.points.size() >= 2 ? strand.points : strand.texels;
    const double span = std::max(6.0, 4.0 * strand.half_width);
    std::vector<Vec2> near;
    const std::size_t n = source.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 p = source[end == 0 ? k : n - 1 - k];
        // Points were dropped around corners and other nodes: what lies behind such a gap has another direction.
        if (near.size() >= 2 && length(p - near.back()) > 2.5) break;
        if (near.size() >= 3 && length(p - near.front()) > span) break;
        near.push_back(p);
    }
    auto [mean, direction] = fit_line(near);
    const Vec2 shift = lattice.shift_to(near.front(), node.position);
    const Vec2 foot = mean + shift - node.position;
    Vec2 outward = near.size() > 1 ? near.front() - near.back() : -foot;
    if (dot(outward, outward) == 0.0) outward = -foot;
    if (dot(direction, outward) < 0.0) direction = -direction;
    arm.direction = near.size() > 1 ? direction : unit(-foot);
    arm.foot = foot;
    if (near.size() > 1 && near.front() != near.back()) {
        arm.tail = fit_tail(near, arm.half_width);
        arm.tail.origin = arm.tail.origin + shift - node.position;
    }
    return arm;
}

bool intersect(const Arm& a, const Arm& b, Vec2& point) {
    const double d = cross(a.direction, b.direction);
    if (std::fabs(d) < 0.08) return false;
    const double s = cross(b.foot - a.foot, b.direction) / d;
    point = a.foot + a.direction * s;
    return true;
}

bool look_alike(const Arm& a, const Arm& b) {
    const double width_ratio = (std::max(a.half_width, b.half_width) + 0.5) / (std::min(a.half_width, b.half_width) + 0.5);
    const double contrast_ratio = std::max(a.contrast, b.contrast) / std::max(1e-6, std::min(a.contrast, b.contrast));
    return width_ratio <= 1.6 && contrast_ratio <= 2.0;
}

constexpr double kNoContinuation = 2.0;

// Turning angle plus offset.
double straight_cost(const Arm& a, const Arm& b) {
    constexpr double kMostTurn = 0.5;
    const double turn = std::fabs(turn_between(a.direction, -b.direction));
    const Vec2 between = b.foot - a.foot;
    const double offset = std::max(std::fabs(cross(a.direction, between)), std::fabs(cross(b.direction, between)));
    const double allowed = 0.35 * std::max(a.half_width, b.half_width) + 0.6 + 0.12 * length(between);
    return turn > kMostTurn || offset > allowed ? kNoContinuation : 0.5 * turn / kMostTurn + 0.5 * offset / allowed;
}

// What a curve in between leaves over that bends as the arms do: an arc, or an arc and a straight line that it leads into.
double bent_cost(const Arm& a, const Arm& b) {
    constexpr double kStraight = 1e-6, kMostRatio = 2.0;  // fit_tail makes what is straight exactly so
    constexpr double kMostTurn = 1.5, kMostTurnToLine = 0.8, kMostDifference = 0.3;
    const double bend = a.tail.curvature, other = -b.tail.curvature;
    const bool to_line = (std::fabs(bend) < kStraight) != (std::fabs(other) < kStraight);
    const bool is_arc = bend * other > 0.0 && std::fabs(bend) < kMostRatio * std::fabs(other) && std::fabs(other) < kMostRatio * std::fabs(bend);
    const Vec2 between = b.tail.origin - a.tail.origin;
    if ((!is_arc && !to_line) || dot(a.tail.along, between) <= 0.0) return kNoContinuation;
    const double start = turn_between(a.tail.along, between), turn = start + turn_between(between, -b.tail.along);
    const double arc = length(between) * (to_line ? bend + other : 0.5 * (bend + other));  // if it bends all the way
    const double bent = to_line ? std::clamp(turn / arc, 0.0, 1.0) : 1.0;                  // share of the way
    // The chord leads into the mean direction of the curve.
    const double uneven = 2.0 * std::fabs(start - turn * (std::fabs(other) < kStraight ? 1.0 - 0.5 * bent : 0.5 * bent));
    const double difference = std::fabs(turn - arc * bent);
    if (std::fabs(turn) > (to_line ? kMostTurnToLine : kMostTurn) || std::max(uneven, difference) > kMostDifference) return kNoContinuation;
    return 0.5 * (uneven + difference) / kMostDifference;
}

// How badly two arms continue each other; above 1 they do not.
double continuation_cost(const Arm& a, const Arm& b) {
    return look_alike(a, b) ? std::min(straight_cost(a, b), bent_cost(a, b)) : kNoContinuation;
}

void pair_through(Joint& joint) {
    struct Candidate {
        double cost;
        int a, b;
    };
    std::vector<Candidate> candidates;
    for (int a = 0; a < static_cast<int>(joint.arms.size()); ++a)
        for (int b = a + 1; b < static_cast<int>(joint.arms.size()); ++b) {
            const double cost = continuation_cost(joint.arms[a], joint.arms[b]);
            if (cost <= 1.0) candidates.push_back({cost, a, b});
        }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& p, const Candidate& q) { return p.cost < q.cost; });
    for (const Candidate& c : candidates)
        if (joint.arms[c.a].partner < 0 && joint.arms[c.b].partner < 0) {
            joint.arms[c.a].partner = c.b;
            joint.arms[c.b].partner = c.a;
        }
}

// A free arm runs into the nearest line that goes through the node.
bool tie_to_through(Joint& joint, Arm& arm, double radius) {
    double nearest = 4.0 * radius + 4.0;
    bool found = false;
    for (const Arm& through : joint.arms) {
        Vec2 point;
        if (through.partner < 0 || through.cornered || !intersect(arm, through, point)) continue;
        if (length(point) < nearest) {
            nearest = length(point);
            arm.target = point;
            found = true;
        }
    }
    arm.tie = EndTie::chain;
    arm.tied = found;
    return found;
}

// Where two arms that run into the same line meet before it, the one with the longer way left ends on the other.
void tie_to_tied(Joint& joint, double radius) {
    for (Arm& arm : joint.arms)
        for (const Arm& other : joint.arms) {
            Vec2 point;
            const bool both_tied = arm.tied && other.tied && arm.tie == EndTie::chain && other.tie == EndTie::chain;
            if (&arm == &other || !both_tied || !intersect(arm, other, point)) continue;
            const double left = dot(arm.target - point, arm.direction), others = dot(other.target - point, other.direction);
            if (left > radius + 1.0 && others > -1.0 && left > others) arm.target = point;
        }
}

void tie_rest(Joint& joint, double radius) {
    std::vector<Arm*> open;
    for (Arm& arm : joint.arms)
        if (arm.partner < 0 && !tie_to_through(joint, arm, radius)) open.push_back(&arm);
    tie_to_tied(joint, radius);
    if (open.empty()) return;
    const double limit = 4.0 * radius + 4.0;
    if (open.size() == 2) {
        Vec2 point;
        if (intersect(*open[0], *open[1], point) && length(point) < limit) {
            for (Arm* arm : open) {
                arm->cornered = true;
                arm->target = point;
            }
            open[0]->partner = static_cast<int>(open[1] - joint.arms.data());
            open[1]->partner = static_cast<int>(open[0] - joint.arms.data());
            return;
        }
    }
    if (open.size() == 1) {  // nothing else is here: a free end after all
        open[0]->tie = EndTie::free;
        return;
    }
    // Star: the point nearest to all end lines.
    double a = 0, b = 0, c = 0, u = 0, v = 0;
    for (const Arm* arm : open) {
        const Vec2 n = normal_of(arm->direction);
        const double d = dot(n, arm->foot);
        a += n.x * n.x;
        b += n.x * n.y;
        c += n.y * n.y;
        u += n.x * d;
        v += n.y * d;
    }
    const double det = a * c - b * b;
    Vec2 star;
    if (std::fabs(det) > 0.05) star = {(c * u - b * v) / det, (a * v - b * u) / det};
    if (length(star) > limit) star = {};
    for (Arm* arm : open) {
        arm->tie = EndTie::node;
        arm->tied = true;
        arm->target = star;
    }
}

struct Graph {
    const Skeleton& skeleton;
    const Lattice& lattice;
    std::vector<Joint> joints;                     // per node
    std::vector<std::array<std::array<int, 2>, 2>> arm_of;  // strand, end -> (node, arm)
};

Graph make_graph(const Skeleton& skeleton, const Lattice& lattice) {
    Graph graph{skeleton, lattice, std::vector<Joint>(skeleton.nodes.size()), {}};
    graph.arm_of.assign(skeleton.strands.size(), {{{-1, -1}, {-1, -1}}});
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s) {
        const Strand& strand = skeleton.strands[s];
        if (strand.gone || strand.loop) continue;
        for (int end = 0; end < 2; ++end) {
            const int n = strand.node[end];
            if (n < 0) continue;
            graph.arm_of[s][end] = {n, static_cast<int>(graph.joints[n].arms.size())};
            graph.joints[n].arms.push_back(make_arm(strand, static_cast<int>(s), end, skeleton.nodes[n], lattice));
        }
    }
    for (std::size_t n = 0; n < graph.joints.size(); ++n) {
        pair_through(graph.joints[n]);
        tie_rest(graph.joints[n], skeleton.nodes[n].radius);
    }
    return graph;
}

using Touching = std::vector<std::vector<std::pair<int, int>>>;  // per node: strand, end

Touching strands_at_nodes(const Skeleton& skeleton) {
    Touching touching(skeleton.nodes.size());
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s) {
        const Strand& strand = skeleton.strands[s];
        for (int end = 0; end < 2 && !strand.gone && !strand.loop; ++end)
            if (strand.node[end] >= 0) touching[strand.node[end]].push_back({static_cast<int>(s), end});
    }
    return touching;
}

// Lines that cross at a small angle run as one for a while: two forks with a common stem. Where each prong of the one
// continues a prong of the other, the stem goes, and the forks become one node.
void contract_stems(Skeleton& skeleton, const Lattice& lattice) {
    constexpr double kLongestStem = 14.0;  // in radii of the node
    constexpr double kMostCost = 0.6;      // less than where lines cross openly: K and X have stems too
    Touching touching = strands_at_nodes(skeleton);
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s) {
        Strand& stem = skeleton.strands[s];
        const int a = stem.node[0], b = stem.node[1];
        if (stem.gone || stem.loop || a < 0 || b < 0 || a == b || touching[a].size() != 3 || touching[b].size() != 3) continue;
        const double radius = std::max(skeleton.nodes[a].radius, skeleton.nodes[b].radius);
        if (static_cast<double>(stem.texels.size()) > kLongestStem * radius) continue;
        std::vector<Arm> prongs;  // two of a, two of b, all seen from a
        for (const int node : {a, b})
            for (const auto& [strand, end] : touching[node])
                if (strand != static_cast<int>(s))
                    prongs.push_back(make_arm(skeleton.strands[strand], strand, end, skeleton.nodes[a], lattice));
        if (prongs.size() != 4) continue;
        const auto both = [&](int first, int second) {
            return std::max(continuation_cost(prongs[0], prongs[first]), continuation_cost(prongs[1], prongs[second]));
        };
        if (std::min(both(2, 3), both(3, 2)) > kMostCost) continue;
        stem.gone = true;
        SkeletonNode& node = skeleton.nodes[a];
        const Vec2 other = skeleton.nodes[b].position + lattice.shift_to(skeleton.nodes[b].position, node.position);
        node.radius = std::max(radius, 0.5 * length(other - node.position));
        node.position = lerp(node.position, other, 0.5);
        for (const auto& [strand, end] : touching[b]) skeleton.strands[strand].node[end] = a;
        touching[a].clear(), touching[b].clear();
    }
}

// The skeleton of two lines that meet at an acute angle leads on into the tip of their corner; such a strand is no line.
void drop_tips(Skeleton& skeleton, const Lattice& lattice) {
    // Radians between the lines; at less, the tip may well be one of them that goes on.
    constexpr double kLeastAngle = 0.35, kWidestAngle = 1.4;
    const Touching touching = strands_at_nodes(skeleton);
    for (std::size_t n = 0; n < touching.size(); ++n) {
        if (touching[n].size() != 3) continue;
        const SkeletonNode& node = skeleton.nodes[n];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [index, end] = touching[n][k];
            Strand& tip = skeleton.strands[index];
            if (tip.gone || tip.node[1 - end] >= 0) continue;
            const auto [first, first_end] = touching[n][(k + 1) % 3];
            const auto [second, second_end] = touching[n][(k + 2) % 3];
            if (first == second) continue;
            const Arm a = make_arm(skeleton.strands[first], first, first_end, node, lattice);
            const Arm b = make_arm(skeleton.strands[second], second, second_end, node, lattice);
            const double angle = std::acos(std::clamp(dot(a.direction, b.direction), -1.0, 1.0));
            const double half_width = std::max(a.half_width, b.half_width);
            const double longest = 2.0 * half_width / std::max(0.1, std::sin(0.5 * angle)) + 2.0;
            Vec2 corner;
            if (angle < kLeastAngle || angle > kWidestAngle || !intersect(a, b, corner) || static_cast<double>(tip.texels.size()) > longest) continue;
            const Vec2 free_end = end == 0 ? tip.texels.back() : tip.texels.front();
            const Vec2 way = free_end + lattice.shift_to(free_end, node.position) - node.position;
            if (length(way) > 0.0 && dot(unit(way), unit(a.direction + b.direction)) > 0.8) tip.gone = true;
        }
    }
}

const Arm* arm_at(const Graph& graph, int strand, int end) {
    const auto [n, k] = graph.arm_of[strand][end];
    return n < 0 ? nullptr : &graph.joints[n].arms[k];
}

// A fixed end or corner that is nearer than the points kept would make the chain turn back: such points go.
void drop_behind(std::vector<Vec2>& points, Vec2 target, Vec2 direction) {
    while (points.size() > 2 && dot(points.back() - target, direction) > -0.5) points.pop_back();
}

void append_strand(std::vector<Vec2>& chain, const Strand& strand, bool reversed, const Lattice& lattice,
                   Vec2 entry, bool has_entry) {
    std::vector<Vec2> points = strand.points;
    if (reversed) std::reverse(points.begin(), points.end());
    if (points.empty()) return;
    const Vec2 anchor = has_entry ? entry : chain.empty() ? points.front() : chain.back();
    const Vec2 shift = lattice.shift_to(points.front(), anchor);
    for (const Vec2 p : points) chain.push_back(p + shift);
}

struct Builder {
    const Graph& graph;
    std::vector<std::uint8_t> used;

    // Follows partners from `strand`, entered at `entry_end`, and returns the chain.
    Chain follow(int strand, int entry_end, ChainKind kind) {
        Chain chain;
        chain.kind = kind;
        double weight = 0.0;
        int s = strand, entry = entry_end;
        const Arm* first = arm_at(graph, s, entry);
        if (first && first->partner < 0 && first->tied) begin_at(chain, *first);
        bool have_corner = false;
        Vec2 corner;
        for (;;) {
            const Strand& current = graph.skeleton.strands[s];
            used[s] = 1;
            if (have_corner) chain.points.push_back(corner);
            append_strand(chain.points, current, entry == 1, graph.lattice, corner, have_corner);
            const double w = std::max<double>(1.0, static_cast<double>(current.points.size()));
            chain.half_width += w * current.half_width;
            chain.contrast += w * current.contrast;
            weight += w;
            const Arm* arm = arm_at(graph, s, 1 - entry);
            if (!arm) {
                chain.end_tie = EndTie::free;
                break;
            }
            if (arm->partner < 0) {
                finish_at(chain, *arm);
                break;
            }
            const int node = graph.arm_of[s][1 - entry][0];
            const Arm& next = graph.joints[node].arms[arm->partner];
            have_corner = arm->cornered;
            if (have_corner) {
                corner = place(chain, *arm, node);
                drop_behind(chain.points, corner, arm->direction);
            }
            if (used[next.strand]) {
                chain.closed = true;
                if (have_corner) chain.points.push_back(corner);
                break;
            }
            s = next.strand;
            entry = next.end;
        }
        chain.half_width /= weight;
        chain.contrast /= weight;
        return chain;
    }

    Vec2 place(const Chain& chain, const Arm& arm, int node) const {
        const Vec2 p = graph.skeleton.nodes[node].position + arm.target;
        return chain.points.empty() ? p : p + graph.lattice.shift_to(p, chain.points.back());
    }
    void begin_at(Chain& chain, const Arm& arm) {
        const int node = graph.arm_of[arm.strand][arm.end][0];
        chain.points.push_back(graph.skeleton.nodes[node].position + arm.target);
        chain.start_tie = arm.tie;
    }
    void finish_at(Chain& chain, const Arm& arm) {
        if (!arm.tied) {
            chain.end_tie = EndTie::free;
            return;
        }
        const int node = graph.arm_of[arm.strand][arm.end][0];
        const Vec2 p = place(chain, arm, node);
        drop_behind(chain.points, p, arm.direction);
        chain.points.push_back(p);
        chain.end_tie = arm.tie;
    }
};

}  // namespace

std::vector<Chain> join_strands(Skeleton& skeleton, const Image& response, const Lattice& lattice, ChainKind kind) {
    contract_stems(skeleton, lattice);
    drop_tips(skeleton, lattice);
    const Graph graph = make_graph(skeleton, lattice);
    Builder builder{graph, std::vector<std::uint8_t>(skeleton.strands.size(), 0)};
    std::vector<Chain> chains;
    const auto add = [&](Chain chain) {
        if (chain.points.size() >= 2) chains.push_back(std::move(chain));
    };
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s) {  // chains with two ends, from either end
        const Strand& strand = skeleton.strands[s];
        if (strand.gone || strand.loop || builder.used[s]) continue;
        for (int end = 0; end < 2; ++end) {
            const Arm* arm = arm_at(graph, static_cast<int>(s), end);
            if (arm && arm->partner >= 0) continue;
            add(builder.follow(static_cast<int>(s), end, kind));
            break;
        }
    }
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s) {  // what is left closes on itself
        const Strand& strand = skeleton.strands[s];
        if (strand.gone || builder.used[s]) continue;
        if (!strand.loop) {
            add(builder.follow(static_cast<int>(s), 0, kind));
            continue;
        }
        Chain chain;
        chain.kind = kind;
        chain.closed = true;
        chain.points = strand.points;
        chain.half_width = strand.half_width;
        chain.contrast = strand.contrast;
        add(std::move(chain));
    }
    for (Chain& chain : chains) {
        if (chain.closed) chain.winding = lattice.shift_to(chain.points.front() - chain.points.back(), {0.0, 0.0});
        sharpen_corners(chain);
        settle_ends(chain, response, lattice);
    }
    return chains;
}

}  // namespace burin::vectorizing
