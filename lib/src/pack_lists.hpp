// Storing many lists of references in few: equal ones once, contained ones inside others, and ends that
// continue another list's end overlapping it. Private to stage pack.
#pragma once

#include <cstdint>
#include <vector>

namespace burin {

using ReferenceList = std::vector<std::uint16_t>;

struct StoredLists {
    std::vector<std::uint16_t> references;  // one sequence that contains every list as a contiguous run
    std::vector<std::uint32_t> first;       // where each list of the input begins; 0 for an empty one
};

// Deterministic. Cost: about linear in the sum of the lengths, times how often one reference occurs in
// distinct lists.
StoredLists store_lists(const std::vector<ReferenceList>& lists);

}  // namespace burin
