#include "pack_levels.hpp"

#include <algorithm>
#include <cassert>

#include <burin/format/texels.hpp>

namespace burin {

LevelCodes::LevelCodes(std::vector<double> units, double same) {
    std::sort(units.begin(), units.end());
    for (std::size_t begin = 0, end = 0; begin < units.size(); begin = end) {
        while (end < units.size() && units[end] - units[begin] <= same) ++end;
        const double middle = std::clamp(0.5 * (units[begin] + units[end - 1]), 0.0, 1.0);
        std::uint32_t code = 0;
        [[maybe_unused]] const bool encoded = encode_unorm16(middle, code);
        assert(encoded);
        low_.push_back(units[begin]);
        code_.push_back(code);
    }
}

std::uint32_t LevelCodes::code(double unit) const {
    const auto above = std::upper_bound(low_.begin(), low_.end(), unit);
    assert(above != low_.begin());
    return code_[static_cast<std::size_t>(above - low_.begin()) - 1];
}

}  // namespace burin
