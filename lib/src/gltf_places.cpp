#include "gltf_places.hpp"

#include <algorithm>

namespace burin {
namespace {

constexpr std::uint64_t kNone = ~std::uint64_t{0};  // no place
constexpr std::uint64_t kShift = 16;                // the widest alignment that views have here

std::uint64_t rounded_up(std::uint64_t value) { return (value + kShift - 1) / kShift * kShift; }

// Whether a member of that name holds that number, at any depth.
bool mentions(const Json& json, const char* key, std::uint64_t number) {
    if (json.is_object()) {
        if (const Json* value = find_member(json, key); value != nullptr && *value == number) return true;
    } else if (!json.is_array()) {
        return false;
    }
    return std::any_of(json.begin(), json.end(),
                       [&](const Json& item) { return mentions(item, key, number); });
}

// Whether a primitive still has an attribute in that accessor. Accessors are released that only attributes refer to.
bool is_attribute(const Json& document, std::uint64_t accessor) {
    for (const Json& mesh : array_of(document, "meshes"))
        for (const Json& primitive : array_of(mesh, "primitives"))
            if (const Json* attributes = find_member(primitive, "attributes"); attributes != nullptr)
                for (const Json& value : *attributes)
                    if (value == accessor) return true;
    return false;
}

ByteRange range_of(const Json& view) {
    const std::uint64_t begin = unsigned_or(view, "byteOffset", 0);
    return {begin, begin + unsigned_or(view, "byteLength", 0)};
}

// Each with the padding behind it, neighbours joined, in order, without those that a view still covers.
std::vector<ByteRange> joined(std::vector<ByteRange> dropped, const Json& views, std::uint64_t size) {
    std::sort(dropped.begin(), dropped.end(), [](ByteRange a, ByteRange b) { return a.begin < b.begin; });
    std::vector<ByteRange> out;
    for (ByteRange range : dropped) {
        std::uint64_t next = std::min(size, rounded_up(range.end));
        bool covered = false;
        for (const Json& view : views) {
            const ByteRange live = range_of(view);
            covered = covered || (live.begin < range.end && range.begin < live.end);
            if (live.begin >= range.end) next = std::min(next, live.begin);
        }
        if (covered) continue;
        if (!out.empty() && range.begin <= out.back().end)
            out.back().end = std::max(out.back().end, next);
        else
            out.push_back({range.begin, next});
    }
    return out;
}

}  // namespace

bool Places::is_used(const std::string& array, std::uint64_t index) const {
    if (array == "textures") return mentions(document_, "index", index);
    if (array == "images") return mentions(array_of(document_, "textures"), "source", index);
    if (array == "samplers") return mentions(array_of(document_, "textures"), "sampler", index);
    if (array == "accessors") return is_attribute(document_, index);
    return mentions(document_, "bufferView", index);
}

void Places::release(const char* array, std::uint64_t index) {
    if (index >= array_of(document_, array).size() || is_used(array, index)) return;
    free_[array].insert(index);
    if (std::string_view(array) != "textures") return;
    // At once, so that the next texture may have it.
    Json& texture = document_[array][index];
    const std::uint64_t sampler = unsigned_or(texture, "sampler", kNone);
    texture.erase("sampler");
    release("samplers", sampler);
}

void Places::vacate(const std::string& array, const Json& old) {
    if (array == "textures") release("images", unsigned_or(old, "source", kNone));
    if (array == "accessors") release("bufferViews", unsigned_or(old, "bufferView", kNone));
    if (array == "images") release("bufferViews", unsigned_or(old, "bufferView", kNone));
    if (array == "bufferViews") dropped_.push_back(range_of(old));
}

bool Places::has_released(const char* array) const {
    const auto found = free_.find(array);
    return found != free_.end() && !found->second.empty();
}

std::size_t Places::take(const char* array) {
    Json& list = document_[array];
    if (!list.is_array()) list = Json::array();
    std::set<std::size_t>& free = free_[array];
    if (free.empty()) {
        list.push_back(nullptr);
        return list.size() - 1;
    }
    const std::size_t index = *free.begin();
    free.erase(free.begin());
    Json old = nullptr;
    std::swap(old, list[index]);
    vacate(array, old);
    return index;
}

void Places::trim() {
    for (const char* array : {"accessors", "textures", "samplers", "images", "bufferViews"}) {
        if (!document_.contains(array)) continue;
        Json& list = document_[array];
        while (!list.empty() && free_[array].erase(list.size() - 1) > 0) {
            const Json old = list.back();
            list.erase(list.size() - 1);
            vacate(array, old);
        }
        if (list.empty()) document_.erase(array);
    }
}

void cut_bytes(std::vector<std::uint8_t>& binary, Json& views, const std::vector<ByteRange>& dropped) {
    std::vector<ByteRange> ranges = joined(dropped, views, binary.size());
    for (auto range = ranges.rbegin(); range != ranges.rend(); ++range) {
        const bool last = range->end == binary.size();
        const std::uint64_t length = range->end - range->begin,
                            cut = last ? length : length / kShift * kShift;
        const auto begin = binary.begin() + static_cast<std::ptrdiff_t>(range->begin);
        const auto end = begin + static_cast<std::ptrdiff_t>(length);
        std::fill(begin, end, std::uint8_t{0});
        binary.erase(begin, begin + static_cast<std::ptrdiff_t>(cut));
        for (Json& view : views)
            if (const ByteRange live = range_of(view); live.begin >= range->end)
                view["byteOffset"] = live.begin - cut;
    }
}

}  // namespace burin
