#include "pack_lists.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

namespace burin {
namespace {

using Sequence = std::span<const std::uint16_t>;
constexpr std::size_t kValues = std::size_t{1} << 16;  // a reference can have

bool begins_with(Sequence list, Sequence head) {
    return list.size() >= head.size() && std::equal(head.begin(), head.end(), list.begin());
}

// Places in a sequence that grows, by the value that stands there: a list is searched for only where its first value is.
class Places {
  public:
    Places() : last_(kValues, kNone) {}

    void append(const ReferenceList& list) {
        for (const std::uint16_t value : list) {
            before_.push_back(last_[value]);
            last_[value] = static_cast<std::uint32_t>(sequence_.size());
            sequence_.push_back(value);
        }
        ends_.resize(sequence_.size(), static_cast<std::uint32_t>(sequence_.size()));
    }
    // Whether a list is part of one of those appended.
    bool contain(const ReferenceList& list) const {
        const Sequence all(sequence_);
        for (std::uint32_t at = last_[list.front()]; at != kNone; at = before_[at])
            if (begins_with(all.subspan(at, ends_[at] - at), list)) return true;
        return false;
    }

  private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint16_t> sequence_;
    std::vector<std::uint32_t> before_, ends_;  // of each place: the one before it with the same value; where its list ends
    std::vector<std::uint32_t> last_;           // of each value
};

// Distinct lists that are contained in no other, in an order that depends on their contents alone.
std::vector<ReferenceList> maximal_lists(std::vector<ReferenceList> lists) {
    std::sort(lists.begin(), lists.end(), [](const ReferenceList& a, const ReferenceList& b) {
        return a.size() != b.size() ? a.size() > b.size() : a < b;
    });
    lists.erase(std::unique(lists.begin(), lists.end()), lists.end());
    Places places;
    std::vector<ReferenceList> kept;
    for (ReferenceList& list : lists) {
        if (list.empty() || places.contain(list)) continue;
        places.append(list);
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
        for (const ReferenceList& list : lists_) ++first_[list.front() + std::size_t{1}];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
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

    // Lists that begin with a value.
    auto beginnings_of(std::uint16_t value) const {
        const auto place = [this](std::size_t index) { return lists_.begin() + static_cast<std::ptrdiff_t>(index); };
        return std::pair(place(first_[value]), place(first_[value + std::size_t{1}]));
    }

    // Length of the longest end of `sequence` that an unused list begins with; that list in `index`. 0: none.
    std::size_t best_continuation(Sequence sequence, std::size_t& index) {
        for (std::size_t length = std::min(longest_, sequence.size()); length > 0; --length) {
            const Sequence tail = sequence.last(length);
            const auto [low, high] = beginnings_of(tail.front());
            const auto first = std::lower_bound(low, high, tail, [](Sequence list, Sequence wanted) {
                return std::lexicographical_compare(list.begin(), list.end(), wanted.begin(), wanted.end());
            });
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

    const std::vector<ReferenceList>& lists_;
    std::vector<std::size_t> next_;  // itself where unused, else some list after it; one more entry as end
    std::vector<std::size_t> first_ = std::vector<std::size_t>(kValues + 1);  // list that begins with a value, or with a larger one
    std::size_t longest_ = 0;
};

// Positions of each value in a sequence, ascending.
class Positions {
  public:
    explicit Positions(Sequence sequence) : first_(kValues + 1), positions_(sequence.size()) {
        for (const std::uint16_t value : sequence) ++first_[value + std::size_t{1}];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t i = 0; i < sequence.size(); ++i) positions_[next[sequence[i]]++] = static_cast<std::uint32_t>(i);
    }
    std::span<const std::uint32_t> of(std::uint16_t value) const {
        return std::span(positions_).subspan(first_[value], first_[value + std::size_t{1}] - first_[value]);
    }

  private:
    std::vector<std::uint32_t> first_, positions_;
};

}  // namespace

StoredLists store_lists(const std::vector<ReferenceList>& lists) {
    const std::vector<ReferenceList> kept = maximal_lists(lists);
    StoredLists stored;
    stored.references = Chain(kept).join();
    const Sequence all(stored.references);
    const Positions positions(all);
    stored.first.reserve(lists.size());
    for (const ReferenceList& list : lists) {
        if (list.empty()) {
            stored.first.push_back(0);
            continue;
        }
        const std::span<const std::uint32_t> candidates = positions.of(list.front());
        const auto found = std::find_if(candidates.begin(), candidates.end(), [&](std::uint32_t at) { return begins_with(all.subspan(at), list); });
        assert(found != candidates.end());
        stored.first.push_back(*found);
    }
    return stored;
}

}  // namespace burin
