// Places in the arrays of a glTF document that a replaced pattern leaves. For the sources of this library
// only.
//
// An index of glTF is a place in an array, and extensions that burin does not know may hold one, so nothing
// is ever renumbered: places are filled again, and taken away where they are the last of their array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gltf_document.hpp"

namespace burin {

struct ByteRange {
    std::uint64_t begin = 0, end = 0;
};

class Places {
  public:
    explicit Places(Json& document) : document_(document) {}

    // Says that a texture, image, sampler, view, or accessor of an attribute, is not needed any more. Nothing happens where something
    // else still refers to it, or where there is no such place.
    void release(const char* array, std::uint64_t index);

    // A place for a new item, which is null until the caller sets it: a released one, else one at the end.
    // What a released texture or image referred to is released with it.
    std::size_t take(const char* array);

    bool has_released(const char* array) const;

    // Takes away released places at the ends of arrays, and arrays that are empty then.
    void trim();

    // Bytes of the views that were taken again or away.
    const std::vector<ByteRange>& dropped() const { return dropped_; }

  private:
    bool is_used(const std::string& array, std::uint64_t index) const;
    void vacate(const std::string& array, const Json& old);

    Json& document_;
    std::map<std::string, std::set<std::size_t>> free_;
    std::vector<ByteRange> dropped_;
};

// Takes the ranges out of the binary chunk and moves the views behind them, all of buffer 0, by multiples of
// 16 bytes. What any view still covers stays.
void cut_bytes(std::vector<std::uint8_t>& binary, Json& views, const std::vector<ByteRange>& dropped);

}  // namespace burin
