// OpenImageIO over bytes that inspect_image has walked, for the sources of this library only.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "container.hpp"

namespace burin {

// Decoder and the memory it reads from; the proxy outlives the input.
struct Decoder {
    explicit Decoder(const Container& c) : container(c), proxy(c.bytes.data(), c.bytes.size()) {}
    const Container& container;
    OIIO::Filesystem::IOMemReader proxy;
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
};

// Values come as they are stored. Fails with unavailable (no such reader) and invalid_input (damaged, or of another size
// than the header said).
Status open_decoder(Decoder& decoder, int threads);

// The decoder's own words, on one line.
Error decoder_error(const Container& container, std::string message);

}  // namespace burin
