// Stage read: decodes a displacement map made by someone else into heights between 0 and 1.
//
//     file --[read_height_map]--> HeightMap --[vectorize_map]--> Pattern
//
// What is read: PNG (1 to 16 bits; grey, palette, RGB, with or without alpha; interlaced), JPEG (baseline,
// progressive, arithmetic), TIFF (8, 16, 32 bit integer, half, float, double; strips, tiles; BigTIFF) and
// OpenEXR (half, float, uint; flat single-part). The first bytes of the file decide, never its name. The
// values are taken as they are stored: no colour management, no gamma, no premultiplication, no rotation by
// metadata.
//
// Input is not trusted. Before the decoder (OpenImageIO) sees a file, its container is walked here: sizes,
// chunk checksums and offsets are checked, the texel count is compared with the limit and with what so many
// bytes can hold, and metadata that heights do not need is left out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/result.hpp>

namespace burin {

// What white means in the file.
enum class Polarity {
    height,  // white is the object surface
    depth,   // white is the deepest point; inverted on reading
};

enum class Channel {
    // The only channel; red when red, green and blue are equal everywhere; luma (0.299, 0.587, 0.114, the
    // weights
    // that JPEG stores) when they differ a little; their mean when they differ by more than 1/16 of the range
    // on the
    // average, with a note; alpha only when nothing else varies, with a note.
    automatic,
    red,
    green,
    blue,
    alpha,
    luminance,  // luma as above
};

struct HeightMapOptions {
    Polarity polarity = Polarity::height;
    Channel channel = Channel::automatic;
    std::uint64_t max_texels = 16384ull * 16384ull;            // [1, 2^32)
    std::uint64_t max_file_bytes = 2ull * 1024 * 1024 * 1024;  // the file as stored
    int threads = 0;  // for decoding; 0: as many as there are. Never changes a value
};

struct HeightMap {
    Image image;        // values in [0, 1], 1 = object surface, every one finite; polarity already applied
    int bit_depth = 8;  // of one channel in the file: 1, 2, 4, 8, 16, 32, 64
    bool is_float = false;  // the file stores floating point numbers
    bool lossy = false;     // JPEG, or lossy compression inside TIFF or OpenEXR
    std::string format;     // "PNG", "JPEG", "TIFF", "OpenEXR"
    int channels = 1;       // stored in the file
    std::string channel;    // which was read: "grey", "red", "luma", "mean", "alpha", or the name in the file
    // File values that became 0 and 1 (before polarity). Integer maps: 0 and 1, the whole range of the type.
    // Floats within [0, 1] are kept as they are; others are stretched so that the least becomes 0 and the
    // greatest 1 (a constant becomes 1), and signed integers likewise.
    float source_low = 0.0f;
    float source_high = 1.0f;
    bool constant = false;           // every texel has the same value
    std::vector<std::string> notes;  // what a user should know: one line each, no full stop
};

// Requires: `path` names a regular file. Ensures: equal input gives equal values, whatever `threads`.
// Fails with io_failed (cannot be opened or read), unsupported (not one of the four formats, or a variant
// that is not promised, named), limit_exceeded (a limit of the options, named), invalid_input (damaged: what
// and where; a float map with a value that is not finite: which texel). Cost: one decode (two when the
// channels differ strongly or only alpha varies); memory: the file, four bytes per texel, and a band of the
// file's own texels (all of them for interlaced PNG and progressive JPEG).
Result<HeightMap> read_height_map(const std::string& path, const HeightMapOptions& options = {});

}  // namespace burin
