// A pattern as the measure of structure sees it: sampled strands between nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include <burin/pattern.hpp>

#include "structure.hpp"

namespace burin::bench {

// Differences of places on a sheet that may repeat.
struct Sheet {
    double side = 512.0;
    bool repeats = false;

    Vec2 from_to(Vec2 a, Vec2 b) const;  // the shortest way
    double distance(Vec2 a, Vec2 b) const { return length(from_to(a, b)); }
};

// Points in order, at most kSpacing texels apart; of a closed strand the last is not the first again.
struct Strand {
    static constexpr double kSpacing = 0.25;
    std::vector<Vec2> points;
    bool closed = false;
    bool step = false;
};

struct Node {
    NodeKind kind = NodeKind::end;
    Vec2 place;
};

struct Skeleton {
    std::vector<Strand> strands;
    std::vector<Node> nodes;
};

// Which samples lie near a place.
class SampleIndex {
  public:
    struct Sample {
        std::uint32_t strand, point;
    };
    SampleIndex(const std::vector<Strand>& strands, const Sheet& sheet);
    // All samples within `radius` <= 2 texels.
    std::vector<Sample> near(Vec2 place, double radius) const;
    const std::vector<Strand>& strands() const { return strands_; }
    const Sheet& sheet() const { return sheet_; }

  private:
    std::int64_t cell_of(int x, int y) const;

    const std::vector<Strand>& strands_;
    Sheet sheet_;
    int cells_;
    std::unordered_map<std::int64_t, std::vector<Sample>> samples_;
};

// Nodes found, and paths cut where structure.hpp says.
Skeleton skeleton_of(const Pattern& pattern, const Sheet& sheet);

}  // namespace burin::bench
