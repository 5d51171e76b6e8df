#include "decoder.hpp"

#include <burin/image_io.hpp>

namespace burin {
namespace {

std::string size_text(std::int64_t w, std::int64_t h) { return std::to_string(w) + "x" + std::to_string(h); }

// Four channels from what the file has: grey stands for all colours.
void fill_texels(const std::vector<std::uint8_t>& values, int channels, RgbaImage& picture) {
    const auto count = static_cast<std::size_t>(channels);
    const std::size_t colors = count < 3 ? 1 : 3;
    for (std::size_t i = 0; i < picture.texels.size() / 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) picture.texels[4 * i + k] = values[i * count + (colors == 1 ? 0 : k)];
        picture.texels[4 * i + 3] = count > colors ? values[i * count + colors] : 255;
    }
}

Result<RgbaImage> decode_contained(const Container& container) {
    Decoder decoder(container);
    if (Status status = open_decoder(decoder, 1); !status.ok()) return status.error();
    const OIIO::ImageSpec& spec = decoder.spec;
    if (spec.nchannels > 4) return damaged(container.format + ": " + std::to_string(spec.nchannels) + " channels are no picture");
    RgbaImage picture{spec.width, spec.height, {}};
    const std::size_t texels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    std::vector<std::uint8_t> values(texels * static_cast<std::size_t>(spec.nchannels));
    if (!decoder.input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, values.data()) || decoder.input->has_error())
        return decoder_error(container, decoder.input->geterror());
    picture.texels.resize(texels * 4);
    fill_texels(values, spec.nchannels, picture);
    return picture;
}

}  // namespace

Error decoder_error(const Container& container, std::string message) {
    for (char& c : message)
        if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    while (!message.empty() && (message.back() == ' ' || message.back() == '.')) message.pop_back();
    if (message.empty()) message = "the picture data is damaged";
    return damaged(container.format + ": " + message);
}

Status open_decoder(Decoder& decoder, int threads) {
    const Container& c = decoder.container;
    decoder.input = OIIO::ImageInput::create(c.plugin);
    if (decoder.input == nullptr)
        return Error{ErrorCode::unavailable, "this OpenImageIO has no reader for " + c.format};
    decoder.input->threads(threads);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);  // values as they are stored
    if (!decoder.input->set_ioproxy(&decoder.proxy))
        return Error{ErrorCode::unavailable, "this OpenImageIO reads " + c.format + " from files only"};
    if (!decoder.input->open(std::string("memory") + c.suffix, decoder.spec, config))
        return decoder_error(c, decoder.input->geterror());
    const OIIO::ImageSpec& spec = decoder.spec;
    if (static_cast<std::uint64_t>(spec.width) != c.width ||
        static_cast<std::uint64_t>(spec.height) != c.height || spec.nchannels < 1 || spec.depth > 1 ||
        spec.deep)
        return damaged(c.format + ": the decoder sees " + size_text(spec.width, spec.height) + " texels of " +
                       std::to_string(spec.nchannels) + " channels, the header said " +
                       size_text(static_cast<std::int64_t>(c.width), static_cast<std::int64_t>(c.height)));
    return Done{};
}

Result<RgbaImage> decode_picture(std::vector<std::uint8_t> bytes, std::uint64_t max_texels) {
    Result<Container> container = inspect_image(std::move(bytes), max_texels);
    if (!container.ok()) return container.error();
    if (container->format != "PNG" && container->format != "JPEG")
        return Error{ErrorCode::unsupported, "the picture is " + container->format + "; PNG and JPEG work"};
    // Decoders may throw; nothing of that leaves this library.
    try {
        return decode_contained(*container);
    } catch (const std::exception& problem) {
        return decoder_error(*container, problem.what());
    }
}

}  // namespace burin
