#include <burin/heightmap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include <burin/image_io.hpp>

#include "decoder.hpp"

namespace burin {
namespace {

// Rows decoded at a time: enough for the decoder's threads, little beside the picture.
constexpr int kBandRows = 64;
// Colors that differ by more than this part of the range, on the average, are no tinted grey.
constexpr double kStrongDifference = 1.0 / 16.0;
constexpr std::array<float, 3> kLuma{0.299f, 0.587f, 0.114f};

// How one value is made of a texel's channels.
enum class Mix { single, luma, mean };

// Places of the channels in a texel; -1 where there is none.
struct Layout {
    int count = 1;
    std::array<int, 3> rgb{-1, -1, -1};
    int alpha = -1;
    int grey = -1;  // the only channel besides alpha
    std::vector<std::string> names;
    bool has_rgb() const { return rgb[0] >= 0; }
};

struct Selection {
    Mix mix = Mix::single;
    int channel = 0;
    std::string name;
};

// Gathered while decoding; what the automatic choice rests on.
struct Statistics {
    float low = std::numeric_limits<float>::infinity();
    float high = -std::numeric_limits<float>::infinity();
    double difference = 0.0;  // sum over the texels of the largest less the least of red, green, blue
    bool colored = false;     // some texel's red, green and blue differ
    float alpha_low = std::numeric_limits<float>::infinity();
    float alpha_high = -std::numeric_limits<float>::infinity();
    std::optional<std::size_t> not_finite;  // first such texel
};

Layout layout_of(const OIIO::ImageSpec& spec) {
    Layout layout;
    layout.count = spec.nchannels;
    layout.names = spec.channelnames;
    layout.names.resize(static_cast<std::size_t>(spec.nchannels));
    const auto find = [&](const char* name) {
        const auto at = std::find(layout.names.begin(), layout.names.end(), name);
        return at == layout.names.end() ? -1 : static_cast<int>(at - layout.names.begin());
    };
    layout.rgb = {find("R"), find("G"), find("B")};
    if (layout.rgb[1] < 0 || layout.rgb[2] < 0) layout.rgb[0] = -1;
    layout.alpha =
        spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels ? spec.alpha_channel : find("A");
    const int others = layout.count - (layout.alpha >= 0 ? 1 : 0);
    if (others == 1) layout.grey = layout.alpha == 0 ? 1 : 0;
    if (layout.count == 1) {  // even when the file calls it alpha
        layout.grey = 0;
        layout.alpha = -1;
    }
    return layout;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (name.empty() ? "?" : name);
    return text;
}

std::string grey_name(const Layout& layout) {
    const std::string& name = layout.names[static_cast<std::size_t>(layout.grey)];
    return name.empty() || name == "Y" || name == "I" ? "grey" : name;
}

Result<Selection> select_channel(const Layout& layout, Channel wanted) {
    if (wanted == Channel::alpha) {
        if (layout.alpha < 0)
            return Error{ErrorCode::invalid_argument,
                         "there is no alpha channel; the file has " + joined(layout.names)};
        return Selection{Mix::single, layout.alpha, "alpha"};
    }
    if (layout.grey >= 0) return Selection{Mix::single, layout.grey, grey_name(layout)};
    if (!layout.has_rgb())
        return not_promised("its channels " + joined(layout.names) +
                            " leave the choice open; save one channel, or red, green and blue");
    constexpr std::array<const char*, 3> kNames{"red", "green", "blue"};
    for (std::size_t i = 0; i < 3; ++i)
        if (wanted == std::array{Channel::red, Channel::green, Channel::blue}[i])
            return Selection{Mix::single, layout.rgb[i], kNames[i]};
    return Selection{Mix::luma, layout.rgb[0], "luma"};
}

float mix_texel(const float* texel, const Layout& layout, const Selection& selection,
                Statistics& statistics) {
    if (selection.mix == Mix::single) return texel[selection.channel];
    const float r = texel[layout.rgb[0]], g = texel[layout.rgb[1]], b = texel[layout.rgb[2]];
    if (r == g && g == b) return r;  // exactly, where a weighted sum would round
    statistics.colored = true;
    statistics.difference += std::max({r, g, b}) - std::min({r, g, b});
    return selection.mix == Mix::mean ? (r + g + b) / 3.0f : kLuma[0] * r + kLuma[1] * g + kLuma[2] * b;
}

void take_texels(const float* band, std::size_t first, std::size_t count, const Layout& layout,
                 const Selection& selection, Image& image, Statistics& statistics) {
    for (std::size_t i = 0; i < count; ++i) {
        const float* texel = band + i * static_cast<std::size_t>(layout.count);
        const float value = mix_texel(texel, layout, selection, statistics);
        if (!std::isfinite(value)) {
            if (!statistics.not_finite.has_value()) statistics.not_finite = first + i;
            continue;
        }
        statistics.low = std::min(statistics.low, value);
        statistics.high = std::max(statistics.high, value);
        if (layout.alpha >= 0) {
            statistics.alpha_low = std::min(statistics.alpha_low, texel[layout.alpha]);
            statistics.alpha_high = std::max(statistics.alpha_high, texel[layout.alpha]);
        }
        image.texels[first + i] = value;
    }
}

int band_rows(const Container& container, const OIIO::ImageSpec& spec) {
    if (spec.tile_width > 0) return std::max(1, spec.tile_height);
    const std::uint64_t unit =
        std::min<std::uint64_t>(container.band_rows, static_cast<std::uint64_t>(spec.height));
    return static_cast<int>((kBandRows + unit - 1) / unit * unit);
}

// Decodes the whole picture once, band by band.
Result<Statistics> decode(const Container& container, Channel wanted, std::optional<Selection> fixed,
                          int threads, Image& image, Layout& layout, Selection& selection) {
    Decoder decoder(container);
    if (Status status = open_decoder(decoder, threads); !status.ok()) return status.error();
    const OIIO::ImageSpec& spec = decoder.spec;
    layout = layout_of(spec);
    Result<Selection> chosen = fixed.has_value() ? Result<Selection>(*fixed) : select_channel(layout, wanted);
    if (!chosen.ok()) return chosen.error();
    selection = *chosen;
    if (image.texels.empty()) image = Image(spec.width, spec.height);
    const int rows = band_rows(container, spec);
    const auto row_values = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels);
    std::vector<float> band(row_values * static_cast<std::size_t>(std::min(rows, spec.height)));
    Statistics statistics;
    for (int y = 0; y < spec.height; y += rows) {
        const int end = std::min(spec.height, y + rows);
        const bool good =
            spec.tile_width > 0
                ? decoder.input->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + end,
                                            spec.z, spec.z + 1, 0, spec.nchannels, OIIO::TypeDesc::FLOAT,
                                            band.data())
                : decoder.input->read_scanlines(0, 0, spec.y + y, spec.y + end, spec.z, 0, spec.nchannels,
                                                OIIO::TypeDesc::FLOAT, band.data());
        if (!good) return decoder_error(container, decoder.input->geterror());
        take_texels(band.data(), static_cast<std::size_t>(y) * static_cast<std::size_t>(spec.width),
                    static_cast<std::size_t>(end - y) * static_cast<std::size_t>(spec.width), layout,
                    selection, image, statistics);
    }
    // Some decoders fill what is missing with grey and only complain.
    if (decoder.input->has_error()) return decoder_error(container, decoder.input->geterror());
    return statistics;
}

Error not_finite_error(const Container& container, const Image& image, std::size_t texel) {
    return damaged(container.format + ": the value of texel (" +
                   std::to_string(texel % static_cast<std::size_t>(image.width)) + ", " +
                   std::to_string(texel / static_cast<std::size_t>(image.width)) +
                   ") is not a finite number; fill such texels before converting");
}

// The automatic choice, once the colors are known: another mix than the first one, or nothing.
std::optional<Selection> better_selection(const Layout& layout, const Statistics& statistics,
                                          std::size_t texels, Selection& selection,
                                          std::vector<std::string>& notes) {
    const bool constant = statistics.low == statistics.high;
    if (constant && !statistics.colored && layout.alpha >= 0 &&
        statistics.alpha_low < statistics.alpha_high) {
        notes.push_back("the colors are the same everywhere, so the alpha channel is taken as height");
        return Selection{Mix::single, layout.alpha, "alpha"};
    }
    if (selection.mix != Mix::luma) return std::nullopt;
    if (!statistics.colored) {
        selection.name = "red";
        return std::nullopt;
    }
    const double range = std::max(1.0, static_cast<double>(statistics.high) - statistics.low);
    if (statistics.difference / static_cast<double>(texels) <= kStrongDifference * range) return std::nullopt;
    notes.push_back(
        "red, green and blue differ strongly, so their mean is taken; choose one of them if each holds a map "
        "of its own");
    return Selection{Mix::mean, layout.rgb[0], "mean"};
}

void note_alpha(const Layout& layout, const Statistics& statistics, HeightMap& map) {
    if (layout.alpha >= 0 && map.channel != "alpha" && statistics.alpha_low < statistics.alpha_high)
        map.notes.push_back("the alpha channel varies and is not used");
}

std::string number_text(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", static_cast<double>(value));
    return text;
}

// Heights to [0, 1] and the polarity; in place.
void normalise(const Statistics& statistics, Polarity polarity, HeightMap& map) {
    std::vector<float>& texels = map.image.texels;
    map.constant = statistics.low == statistics.high;
    if (statistics.low < 0.0f || statistics.high > 1.0f) {
        map.source_low = statistics.low;
        map.source_high = statistics.high;
        map.notes.push_back("values run from " + number_text(statistics.low) + " to " +
                            number_text(statistics.high) + "; this range is mapped to 0..1");
        // In double: the range of two floats may not fit into one.
        const double low = statistics.low, range = static_cast<double>(statistics.high) - low;
        for (float& v : texels) v = range > 0.0 ? static_cast<float>((v - low) / range) : 1.0f;
    }
    if (polarity == Polarity::depth)
        for (float& v : texels) v = 1.0f - v;
}

Result<HeightMap> read_contained(const Container& container, const HeightMapOptions& options) {
    HeightMap map;
    Layout layout;
    Selection selection;
    Result<Statistics> statistics =
        decode(container, options.channel, std::nullopt, options.threads, map.image, layout, selection);
    if (!statistics.ok()) return statistics.error();
    if (options.channel == Channel::automatic && !statistics->not_finite.has_value()) {
        const auto better =
            better_selection(layout, *statistics, map.image.texels.size(), selection, map.notes);
        if (better.has_value())
            statistics =
                decode(container, options.channel, better, options.threads, map.image, layout, selection);
        if (!statistics.ok()) return statistics.error();
    }
    if (statistics->not_finite.has_value())
        return not_finite_error(container, map.image, *statistics->not_finite);
    map.bit_depth = container.bit_depth;
    map.is_float = container.is_float;
    map.lossy = container.lossy;
    map.format = container.format;
    map.channels = container.channels;
    map.channel = selection.name;
    note_alpha(layout, *statistics, map);
    normalise(*statistics, options.polarity, map);
    return map;
}

}  // namespace

Result<HeightMap> read_height_map(const std::string& path, const HeightMapOptions& options) {
    if (options.max_texels < 1 || options.max_texels >= 1ull << 32)
        return Error{ErrorCode::invalid_argument,
                     "max_texels is " + std::to_string(options.max_texels) + ", it must lie in [1, 2^32)"};
    Result<std::vector<std::uint8_t>> file = read_file(path, options.max_file_bytes);
    if (!file.ok()) return file.error();
    const auto named = [&](const Error& error) {
        return Error{error.code, "cannot read height map '" + path + "': " + error.message};
    };
    Result<Container> container = inspect_image(std::move(*file), options.max_texels);
    if (!container.ok()) return named(container.error());
    // Decoders may throw; nothing of that leaves this library.
    try {
        Result<HeightMap> map = read_contained(*container, options);
        if (!map.ok()) return named(map.error());
        return map;
    } catch (const std::bad_alloc&) {
        return named(Error{ErrorCode::limit_exceeded, "there is not enough memory for it"});
    } catch (const std::exception& problem) {
        return named(decoder_error(*container, problem.what()));
    }
}

}  // namespace burin
