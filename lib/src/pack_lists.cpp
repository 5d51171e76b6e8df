#include "pack_lists.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

namespace burin {
namespace {

using Sequence = std::span<const std::uint32_t>;

bool begins_with(Sequence list, Sequence head) {
    return list.size() >= head.size() && std::equal(head.begin(), head.end(), list.begin());
}

// Places in a sequence that grows, by the value that stands there: a list is searched for only where its first value is.
class Places {
  public:
    explicit Places(std::size_t values) : last_(values, kNone) {}

    void append(const ReferenceList& list) {
        for (const std::uint32_t value : list) {
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
    std::vector<std::uint32_t> sequence_;
    std::vector<std::uint32_t> before_, ends_;  // of each place: the one before it with the same value; where its list ends
    std::vector<std::uint32_t> last_;           // of each value
};

// Distinct lists that are contained in no other, in an order that depends on their contents alone.
std::vector<ReferenceList> maximal_lists(std::vector<ReferenceList> lists, std::size_t values) {
    std::sort(lists.begin(), lists.end(), [](const ReferenceList& a, const ReferenceList& b) {
        return a.size() != b.size() ? a.size() > b.size() : a < b;
    });
    lists.erase(std::unique(lists.begin(), lists.end()), lists.end());
    Places places(values);
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
    Chain(const std::vector<ReferenceList>& sorted, std::size_t values) : lists_(sorted), next_(sorted.size() + 1), first_(values + 1) {
        std::iota(next_.begin(), next_.end(), std::size_t{0});
        for (const ReferenceList& list : lists_) ++first_[list.front() + std::size_t{1}];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
    }

    std::vector<std::uint32_t> join() {
        std::vector<std::uint32_t> sequence;
        for (std::size_t start = 0; start < lists_.size(); ++start) {
            if (unused_from(start) != start) continue;
            append(sequence, start, 0);
            std::size_t next = 0, overlap = 0;
            while ((overlap = best_continuation(sequence, next)) > 0) append(sequence, next, overlap);
        }
        return sequence;
    }

  private:
    void append(std::vector<std::uint32_t>& sequence, std::size_t index, std::size_t overlap) {
        next_[index] = index + 1;
        longest_ = std::max(longest_, lists_[index].size());
        sequence.insert(sequence.end(), lists_[index].begin() + static_cast<std::ptrdiff_t>(overlap),
                        lists_[index].end());
    }

    // Lists that begin with a value.
    auto beginnings_of(std::uint32_t value) const {
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
    std::vector<std::size_t> first_;  // list that begins with a value, or with a larger one
    std::size_t longest_ = 0;
};

// Positions of each value in a sequence, ascending.
class Positions {
  public:
    Positions(Sequence sequence, std::size_t values) : first_(values + 1), positions_(sequence.size()) {
        for (const std::uint32_t value : sequence) ++first_[value + std::size_t{1}];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t i = 0; i < sequence.size(); ++i) positions_[next[sequence[i]]++] = static_cast<std::uint32_t>(i);
    }
    std::span<const std::uint32_t> of(std::uint32_t value) const {
        return std::span(positions_).subspan(first_[value], first_[value + std::size_t{1}] - first_[value]);
    }

  private:
    std::vector<std::uint32_t> first_, positions_;
};

// A list from one of the places on where another may begin inside it.
struct Part {
    std::uint64_t head = 0;  // its first two references, so that few comparisons look at lists
    std::uint32_t list = 0, offset = 0;
};

std::vector<Part> sorted_parts(const std::vector<ReferenceList>& lists, std::uint32_t step) {
    std::vector<Part> parts;
    for (std::uint32_t k = 0; k < lists.size(); ++k)
        for (std::uint32_t at = 0; at < lists[k].size(); at += step) {
            const std::uint64_t second = at + 1 < lists[k].size() ? lists[k][at + 1] + std::uint64_t{1} : 0;
            parts.push_back({std::uint64_t{lists[k][at]} << 32 | second, k, at});
        }
    // A part comes right before those that begin with it. Of equal ones that of the shorter list comes first: it is stored
    // inside the other.
    std::sort(parts.begin(), parts.end(), [&lists](const Part& a, const Part& b) {
        if (a.head != b.head) return a.head < b.head;
        const Sequence p = Sequence(lists[a.list]).subspan(a.offset), q = Sequence(lists[b.list]).subspan(b.offset);
        const auto order = std::lexicographical_compare_three_way(p.begin(), p.end(), q.begin(), q.end());
        if (order != 0) return order < 0;
        return a.offset != b.offset ? a.offset < b.offset : a.list < b.list;
    });
    return parts;
}

// Where each list is stored: in which one, its own where it is not part of another, and at which place in it.
std::vector<Part> find_hosts(const std::vector<ReferenceList>& lists, std::uint32_t step) {
    std::vector<Part> hosts(lists.size());
    for (std::uint32_t k = 0; k < lists.size(); ++k) hosts[k].list = k;
    const std::vector<Part> parts = sorted_parts(lists, step);
    for (std::size_t i = parts.size(); i-- > 1;) {
        const Part &part = parts[i - 1], &next = parts[i];
        if (part.offset != 0 || !begins_with(Sequence(lists[next.list]).subspan(next.offset), lists[part.list])) continue;
        hosts[part.list] = next.offset == 0 ? hosts[next.list] : next;
    }
    // A host may be part of another list, but only of a longer one.
    std::vector<std::vector<std::uint32_t>> by_size;
    for (std::uint32_t k = 0; k < lists.size(); ++k) {
        by_size.resize(std::max(by_size.size(), lists[k].size() + 1));
        by_size[lists[k].size()].push_back(k);
    }
    for (std::size_t size = by_size.size(); size-- > 0;)
        for (const std::uint32_t k : by_size[size]) {
            const Part& host = hosts[k];
            hosts[k] = {0, hosts[host.list].list, hosts[host.list].offset + host.offset};
        }
    return hosts;
}

}  // namespace

StoredLists store_lists(const std::vector<ReferenceList>& lists, std::size_t values) {
    const std::vector<ReferenceList> kept = maximal_lists(lists, values);
    StoredLists stored;
    stored.references = Chain(kept, values).join();
    const Sequence all(stored.references);
    const Positions positions(all, values);
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

StoredLists store_aligned_lists(const std::vector<ReferenceList>& lists, std::uint32_t step) {
    const std::vector<Part> hosts = find_hosts(lists, step);
    StoredLists stored;
    stored.first.assign(lists.size(), 0);
    for (std::uint32_t k = 0; k < lists.size(); ++k) {
        if (hosts[k].list != k || lists[k].empty()) continue;
        stored.first[k] = static_cast<std::uint32_t>(stored.references.size());
        stored.references.insert(stored.references.end(), lists[k].begin(), lists[k].end());
        stored.references.resize((stored.references.size() + step - 1) / step * step, 0);
    }
    for (std::uint32_t k = 0; k < lists.size(); ++k)
        if (hosts[k].list != k) stored.first[k] = stored.first[hosts[k].list] + hosts[k].offset;
    return stored;
}

}  // namespace burin
