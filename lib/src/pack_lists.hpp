// Storing many lists of references in few: equal ones once, contained ones inside others, and ends that
// continue another list's end overlapping it. Private to stage pack.
#pragma once

#include <cstdint>
#include <vector>

namespace burin {

using ReferenceList = std::vector<std::uint32_t>;  // ascending

struct StoredLists {
    std::vector<std::uint32_t> references;  // one sequence that contains every list as a contiguous run
    std::vector<std::uint32_t> first;       // where each list of the input begins; 0 for an empty one
};

// Requires: references below `values`. Deterministic. Cost: about linear in `values` and the sum of the lengths, times how
// often one reference occurs in distinct lists.
StoredLists store_lists(const std::vector<ReferenceList>& lists, std::size_t values);

// The same where every list begins at a multiple of `step` and 0 fills up to the next one: equal lists are stored once, and
// those that a longer list contains at such a place inside it; none overlap otherwise. In the order of the input, so that
// lists of neighbouring cells are neighbours. Cost: n log n in the sum of the lengths.
StoredLists store_aligned_lists(const std::vector<ReferenceList>& lists, std::uint32_t step);

}  // namespace burin
