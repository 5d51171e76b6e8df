#include "pack_lists.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <unordered_map>

namespace burin {
namespace {

// Where each reference value occurs, so that a list is searched for only where its first value stands.
struct Occurrence {
    std::uint32_t list, position;
};

bool run_at(const std::vector<std::uint16_t>& sequence, std::size_t position, const ReferenceList& list) {
    return position + list.size() <= sequence.size() &&
           std::equal(list.begin(), list.end(), sequence.begin() + static_cast<std::ptrdiff_t>(position));
}

// Distinct lists that are contained in no other, in an order that depends on their contents alone.
std::vector<ReferenceList> maximal_lists(std::vector<ReferenceList> lists) {
    std::sort(lists.begin(), lists.end(), [](const ReferenceList& a, const ReferenceList& b) {
        return a.size() != b.size() ? a.size() > b.size() : a < b;
    });
    lists.erase(std::unique(lists.begin(), lists.end()), lists.end());
    std::unordered_map<std::uint16_t, std::vector<Occurrence>> occurrences;
    std::vector<ReferenceList> kept;
    for (ReferenceList& list : lists) {
        if (list.empty()) continue;
        const auto found = occurrences.find(list.front());
        const bool contained =
            found != occurrences.end() &&
            std::any_of(found->second.begin(), found->second.end(),
                        [&](const Occurrence& o) { return run_at(kept[o.list], o.position, list); });
        if (contained) continue;
        for (std::size_t i = 0; i < list.size(); ++i) {
            occurrences[list[i]].push_back(
                {static_cast<std::uint32_t>(kept.size()), static_cast<std::uint32_t>(i)});
        }
        kept.push_back(std::move(list));
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

// Greedy chain: after each list the one that shares the most references with its end, found among the lists
// whose beginnings are in sorted order, so that those with a given beginning are neighbours.
class Chain {
  public:
    explicit Chain(const std::vector<ReferenceList>& sorted) : lists_(sorted), next_(sorted.size() + 1) {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
    }

    std::vector<std::uint16_t> join() {
        std::vector<std::uint16_t> sequence;
        for (std::size_t start = 0; start < lists_.size(); ++start) {
            if (unused_from(start) != start) continue;
            append(sequence, start, 0);
            std::size_t next = 0, overlap = 0;
            while ((overlap = best_continuation(sequence, next)) > 0) append(sequence, next, overlap);
        }
        return sequence;
    }

  private:
    void append(std::vector<std::uint16_t>& sequence, std::size_t index, std::size_t overlap) {
        next_[index] = index + 1;
        longest_ = std::max(longest_, lists_[index].size());
        sequence.insert(sequence.end(), lists_[index].begin() + static_cast<std::ptrdiff_t>(overlap),
                        lists_[index].end());
    }

    // Length of the longest end of `sequence` that an unused list begins with; that list in `index`. 0: none.
    std::size_t best_continuation(const std::vector<std::uint16_t>& sequence, std::size_t& index) {
        for (std::size_t length = std::min(longest_, sequence.size()); length > 0; --length) {
            const ReferenceList tail(sequence.end() - static_cast<std::ptrdiff_t>(length), sequence.end());
            const auto first = std::lower_bound(lists_.begin(), lists_.end(), tail);
            const std::size_t at = unused_from(static_cast<std::size_t>(first - lists_.begin()));
            if (at == lists_.size() || !begins_with(lists_[at], tail)) continue;
            index = at;
            return length;
        }
        return 0;
    }

    // First unused list at or after `index`; shortens the way for the next question.
    std::size_t unused_from(std::size_t index) {
        while (next_[index] != index) index = next_[index] = next_[next_[index]];
        return index;
    }

    static bool begins_with(const ReferenceList& list, const ReferenceList& head) {
        return list.size() >= head.size() && std::equal(head.begin(), head.end(), list.begin());
    }

    const std::vector<ReferenceList>& lists_;
    std::vector<std::size_t> next_;  // itself where unused, else some list after it; one more entry as end
    std::size_t longest_ = 0;
};

}  // namespace

StoredLists store_lists(const std::vector<ReferenceList>& lists) {
    const std::vector<ReferenceList> kept = maximal_lists(lists);
    StoredLists stored;
    stored.references = Chain(kept).join();
    std::unordered_map<std::uint16_t, std::vector<std::uint32_t>> positions;
    for (std::size_t i = 0; i < stored.references.size(); ++i) {
        positions[stored.references[i]].push_back(static_cast<std::uint32_t>(i));
    }
    std::map<ReferenceList, std::uint32_t> known;
    for (const ReferenceList& list : lists) {
        const auto [entry, inserted] = known.try_emplace(list, 0);
        if (inserted && !list.empty()) {
            const std::vector<std::uint32_t>& candidates = positions[list.front()];
            const auto found = std::find_if(candidates.begin(), candidates.end(), [&](std::uint32_t at) {
                return run_at(stored.references, at, list);
            });
            assert(found != candidates.end());
            entry->second = *found;
        }
        stored.first.push_back(entry->second);
    }
    return stored;
}

}  // namespace burin
