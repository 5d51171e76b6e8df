// Codes of ground levels: values that mean the same level get the same code. Private to stage pack.
#pragma once

#include <cstdint>
#include <vector>

namespace burin {

class LevelCodes {
  public:
    // `units`: every level of the pattern as value of the height range. Values within `same` of the lowest of
    // their group are one level; its code is that of the group's middle.
    LevelCodes(std::vector<double> units, double same);

    // Requires: `unit` was among those given and is in [0, 1] up to 1e-6.
    std::uint32_t code(double unit) const;

  private:
    std::vector<double> low_;  // lowest value of each group, growing
    std::vector<std::uint32_t> code_;
};

}  // namespace burin
