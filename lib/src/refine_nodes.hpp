// Where a pattern's points may move: its nodes. A node is free; or lies between two other nodes (a smooth joint on its
// tangent polygon, a joint of collinear lines); or on an element (the end of a T). Points that coincide are one node.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <burin/pattern.hpp>

namespace burin::refinement {

struct PointTerm {
    int unknown = 0;
    Vec2 direction;  // derivative of the point by the unknown
};

struct NodeUse {
    int node = -1;
    Vec2 offset;  // the point is the node's position plus whole tiles
};

struct Node {
    enum class Kind : std::uint8_t { free, between, on_element };
    Kind kind = Kind::free;
    Vec2 position;
    Vec2 origin;                  // where it began
    bool moves_x = true, moves_y = true;
    int unknown = -1;             // the first of its unknowns; -1: held
    NodeUse a, b;                 // between these; offsets relative to this node
    int path = -1, element = -1;  // on this element
    Vec2 element_offset;          // added to the element's points
    double at = 0.0;              // place between a and b, or the element's curve parameter
    double slid = 0.0;            // texels from where it began along its guide
    double most_slide = 0.0;      // texels
};

class Nodes {
  public:
    // Numbers unknowns from `first_unknown` on, unless `hold`.
    Nodes(const Pattern& pattern, double snap, bool hold, int first_unknown);

    int unknown_count() const { return unknowns_; }
    double largest_shift() const;

    void move(const std::vector<double>& step, double most_shift);
    // Writes the points of all elements.
    void write(Pattern& pattern) const;

    // Derivative of an element's point (0, 1, 2) by the unknowns.
    std::vector<PointTerm> terms(int path, int element, int point) const;

  private:
    friend class NodeBuilder;
    using ElementNodes = std::array<NodeUse, 3>;

    Vec2 place(int node, int depth) const;
    // The three points of an element; a line's middle one is not used.
    std::array<Vec2, 3> points(int path, int element, int depth) const;
    Vec2 guide(const Node& node, int depth) const;  // derivative of the node's position by `at`
    void add_terms(int node, double factor, int depth, std::vector<PointTerm>& out) const;

    std::vector<Node> nodes_;
    std::vector<std::vector<ElementNodes>> elements_;   // by path; a line has no middle node
    int unknowns_ = 0;
};

}  // namespace burin::refinement
