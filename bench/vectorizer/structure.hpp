// How much of an authored pattern's structure a recovered one has: its paths, ends and junctions.
#pragma once

#include <array>
#include <vector>

#include <burin/pattern.hpp>

namespace burin::bench {

struct Tally {
    int authored = 0, recovered = 0, matched = 0;
};

enum class NodeKind { end, corner, tee, cross, wye, star };  // star: any other meeting of three or more
inline constexpr int kNodeKinds = 6;

// What one pattern has and the other has not.
struct Miss {
    bool authored = true;      // false: recovered, and not authored
    bool path = true;          // its middle; else a node of `kind`
    NodeKind kind = NodeKind::end;
    Vec2 place;
};

struct StructureScore {
    Tally paths;
    std::array<Tally, kNodeKinds> nodes;  // by NodeKind
    std::vector<Miss> misses;

    Tally ends() const { return nodes[0]; }
    Tally junctions() const;  // all other kinds
    // 100 (matched - false) / authored, 0 at least. Counted are paths, ends and junctions alike; false is what was
    // recovered and matches nothing.
    double percent() const;
};

// A node is where paths end, meet, cross or turn by more than 20 degrees. Its kind follows from the arms that leave it
// and from which of them lie opposite each other (within 20 degrees): one arm is an end; two that do not, a corner;
// three, a tee when two do and a wye otherwise; four, a cross when they do in pairs; all else is a star. How the arms are
// distributed over paths does not matter, except that it decides which paths there are: a path goes on through a node
// where its two arms lie opposite, and at a corner; at any other node it is cut.
//
// An authored path is matched by a recovered one of the same class (step or not) when 95 % of the length of each lies
// within 0.5 texel of the other. An end is matched by an end within 1 texel, any other node by one of the same kind
// within 2 texels. Each serves once.
//
// A straight stroke of 10 texels or more that meets nothing may as well be recovered as the outline of its walls: where it
// is missed, the better score counts. So may a dot or slot, a straight stroke with round ends, stand for the outline of its
// walls, where all of them do.
//
// Both patterns cover one tile of texels x texels; when they repeat, places are compared across the border.
// Cost: some microseconds per texel of path, and the square of the number of nodes.
StructureScore compare_structure(const Pattern& authored, const Pattern& recovered, int texels);

}  // namespace burin::bench
