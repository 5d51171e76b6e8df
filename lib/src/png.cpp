#include "png.hpp"

#include <zlib.h>

#include <array>
#include <cassert>
#include <cstdlib>
#include <limits>

namespace burin {
namespace {

// Large pictures: level 6 costs a third of level 9 and comes within a percent. Small ones are packed with
// several filters at level 9 and the shortest result is kept; they travel inside models. Of those between, a quick look
// tells which filter that is.
constexpr int kFastLevel = 6, kBestLevel = 9, kTrialLevel = 2;
constexpr std::size_t kSmallPicture = 1u << 20, kTinyPicture = 1u << 18;  // bytes of its rows
constexpr int kAdaptive = -1;                    // the filter is chosen for each row
constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

void append_big_endian(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(std::vector<std::uint8_t>& png, const char (&type)[5], const std::uint8_t* data,
                  std::size_t size) {
    append_big_endian(png, static_cast<std::uint32_t>(size));
    const std::size_t from = png.size();
    png.insert(png.end(), type, type + 4);
    png.insert(png.end(), data, data + size);
    append_big_endian(
        png, static_cast<std::uint32_t>(crc32(0, png.data() + from, static_cast<uInt>(png.size() - from))));
}

int paeth(int a, int b, int c) {
    const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

// One row under one of the five filters of PNG; returns the sum of absolute residuals, the usual guess at its
// size.
std::uint64_t filter_row(int filter, const std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                         std::size_t step, std::uint8_t* out) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const int a = i >= step ? row[i - step] : 0;
        const int b = above != nullptr ? above[i] : 0;
        const int c = i >= step && above != nullptr ? above[i - step] : 0;
        int predicted = 0;
        if (filter == 1) predicted = a;
        if (filter == 2) predicted = b;
        if (filter == 3) predicted = (a + b) / 2;
        if (filter == 4) predicted = paeth(a, b, c);
        out[i] = static_cast<std::uint8_t>(row[i] - predicted);
        sum += out[i] < 128 ? out[i] : 256u - out[i];
    }
    return sum;
}

// Filter type byte and residuals of every row; one filter for all, or the likeliest for each.
std::vector<std::uint8_t> filter_rows(const std::vector<std::uint8_t>& rows, std::size_t row_size,
                                      std::size_t step, int wanted) {
    const std::size_t count = rows.size() / row_size;
    std::vector<std::uint8_t> filtered;
    filtered.reserve(rows.size() + count);
    std::vector<std::uint8_t> best(row_size), trial(row_size);
    for (std::size_t y = 0; y < count; ++y) {
        const std::uint8_t* row = rows.data() + y * row_size;
        const std::uint8_t* above = y > 0 ? row - row_size : nullptr;
        std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
        std::uint8_t chosen = 0;
        for (int filter = 0; filter < 5; ++filter) {
            if (wanted != kAdaptive && filter != wanted) continue;
            const std::uint64_t sum = filter_row(filter, row, above, row_size, step, trial.data());
            if (sum >= least) continue;
            least = sum;
            chosen = static_cast<std::uint8_t>(filter);
            best.swap(trial);
        }
        filtered.push_back(chosen);
        filtered.insert(filtered.end(), best.begin(), best.end());
    }
    return filtered;
}

// A zlib stream in pieces: the one-call interface counts in 32 bits on some systems.
Result<std::vector<std::uint8_t>> deflate_all(const std::vector<std::uint8_t>& input, int level) {
    z_stream stream{};
    if (deflateInit(&stream, level) != Z_OK)
        return Error{ErrorCode::limit_exceeded, "PNG: not enough memory to compress"};
    std::vector<std::uint8_t> output;
    std::vector<std::uint8_t> piece(1u << 18);
    std::size_t given = 0;
    int state = Z_OK;
    while (state != Z_STREAM_END) {
        if (stream.avail_in == 0 && given < input.size()) {
            const std::size_t n = std::min<std::size_t>(input.size() - given, 1u << 30);
            stream.next_in = const_cast<Bytef*>(input.data() + given);
            stream.avail_in = static_cast<uInt>(n);
            given += n;
        }
        stream.next_out = piece.data();
        stream.avail_out = static_cast<uInt>(piece.size());
        state = deflate(&stream, given == input.size() ? Z_FINISH : Z_NO_FLUSH);
        output.insert(output.end(), piece.begin(), piece.end() - stream.avail_out);
    }
    deflateEnd(&stream);
    return output;
}

Result<std::vector<std::uint8_t>> pack_rows(const std::vector<std::uint8_t>& rows, std::size_t row_size,
                                            std::size_t step) {
    if (rows.size() > kSmallPicture)
        return deflate_all(filter_rows(rows, row_size, step, kAdaptive), kFastLevel);
    const int trial_level = rows.size() > kTinyPicture ? kTrialLevel : kBestLevel;
    int best_filter = kAdaptive;
    Result<std::vector<std::uint8_t>> best = deflate_all(filter_rows(rows, row_size, step, kAdaptive), trial_level);
    for (const int filter : {0, 2, 4}) {  // none, above, Paeth
        Result<std::vector<std::uint8_t>> other = deflate_all(filter_rows(rows, row_size, step, filter), trial_level);
        if (best.ok() && other.ok() && other->size() < best->size()) best = std::move(other), best_filter = filter;
    }
    return trial_level == kBestLevel ? std::move(best) : deflate_all(filter_rows(rows, row_size, step, best_filter), kBestLevel);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_png_rows(int width, int height, int channels, int bit_depth,
                                                  const std::vector<std::uint8_t>& rows) {
    constexpr int kMaxSide = 65535;
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        return Error{ErrorCode::invalid_argument, "PNG: size " + std::to_string(width) + "x" +
                                                      std::to_string(height) +
                                                      ", each side must be 1 to 65535"};
    const std::size_t step = static_cast<std::size_t>(channels) * (bit_depth / 8);
    const std::size_t row_size = step * static_cast<std::size_t>(width);
    assert(rows.size() == row_size * static_cast<std::size_t>(height));
    Result<std::vector<std::uint8_t>> data = pack_rows(rows, row_size, step);
    if (!data.ok()) return data;
    // Chunk lengths have 31 bits; cutting the data there is allowed and never needed at our sizes.
    std::vector<std::uint8_t> png(kSignature.begin(), kSignature.end());
    std::vector<std::uint8_t> header;
    append_big_endian(header, static_cast<std::uint32_t>(width));
    append_big_endian(header, static_cast<std::uint32_t>(height));
    constexpr std::uint8_t kColorTypes[] = {0, 0, 4, 2, 6};  // by channel count
    for (const int v : {bit_depth, int{kColorTypes[channels]}, 0, 0, 0})
        header.push_back(static_cast<std::uint8_t>(v));
    append_chunk(png, "IHDR", header.data(), header.size());
    constexpr std::size_t kMaxChunk = 1u << 30;
    for (std::size_t at = 0; at < data->size(); at += kMaxChunk)
        append_chunk(png, "IDAT", data->data() + at, std::min(kMaxChunk, data->size() - at));
    append_chunk(png, "IEND", nullptr, 0);
    return png;
}

}  // namespace burin
