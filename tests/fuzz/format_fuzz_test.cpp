// Damaged files through the validator, the extension's reader and unpacking: any answer will do, but one must
// come. Run it with -DBURIN_SANITIZE=address,undefined to see accesses that happen to do no harm.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include <burin/format/validate.hpp>
#include <burin/pack.hpp>

#include "../unit/sample_file.hpp"

namespace burin {
namespace {

using Bytes = std::vector<std::uint8_t>;

class FormatFuzz : public testing::Test {
  protected:
    void SetUp() override {
        const std::uint32_t seed = std::random_device{}();
        std::printf("seed %u\n", seed);
        random_.seed(seed);
    }
    std::uint32_t below(std::size_t limit) {
        return static_cast<std::uint32_t>(std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_));
    }
    // One to eight changes: a bit, a byte, a word of extreme value, a cut, a run copied elsewhere.
    void damage(Bytes& bytes) {
        for (std::uint32_t changes = 1 + below(8); changes > 0 && bytes.size() > 8; --changes) {
            const std::size_t at = below(bytes.size() - 4);
            switch (below(12)) {
                case 0:
                    bytes.resize(bytes.size() - below(std::min<std::size_t>(bytes.size() - 8, 64)));
                    break;
                case 1:
                    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = 0xFF;
                    break;
                case 2:
                    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = 0;
                    break;
                case 3:
                    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = bytes[below(bytes.size())];
                    break;
                case 4:
                case 5:
                    bytes[at] = static_cast<std::uint8_t>(random_());
                    break;
                default:
                    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1u << below(8));
            }
        }
    }
    void damage(std::vector<std::uint32_t>& words) {
        Bytes bytes = bytes_from_words(words);
        const std::size_t size = bytes.size();
        damage(bytes);
        bytes.resize(size, 0);
        words = words_from_bytes(bytes);
    }

    std::mt19937 random_;
};

TEST_F(FormatFuzz, ValidatorAnswersOnDamagedFiles) {
    const test::SampleFile file = test::make_sample_file();
    const Bytes glb = test::make_glb(test::make_document(file), test::make_bin(file));
    const std::string text = test::make_document(file).dump();
    std::size_t invalid = 0;
    for (int k = 0; k < 6000; ++k) {
        Bytes bytes = k % 3 == 0 ? Bytes(text.begin(), text.end()) : glb;
        damage(bytes);
        std::size_t issues = 0;
        validate_glb(bytes, [&issues](const Issue&) { ++issues; });
        invalid += issues > 0 ? 1 : 0;
    }
    EXPECT_GT(invalid, 4000u);
}

TEST_F(FormatFuzz, UnpackAnswersOnDamagedTextures) {
    const test::SampleFile file = test::make_sample_file();
    std::size_t accepted = 0;
    for (int k = 0; k < 20000; ++k) {
        PackedTextures textures = file.textures;
        PathDetail detail = file.detail;
        damage(k % 2 == 0 ? textures.grid : textures.data);
        if (k % 16 == 0) {
            textures.sections.element_texels += below(5) - 2;
            detail.sections = textures.sections;
        }
        if (k % 50 == 0) textures.grid.resize(below(textures.grid.size()));
        const Result<UnpackedPattern> back = unpack_textures(textures, detail);
        if (!back.ok()) continue;
        ++accepted;
        // What was accepted can be packed again.
        const Result<PackedTextures> again = pack_textures(back->pattern, back->grid);
        if (again.ok()) {
            EXPECT_LE(again->grid.size(), textures.grid.size());
        }
    }
    EXPECT_GT(accepted, 50u);
}

TEST_F(FormatFuzz, ExtensionReaderAnswersOnDamagedText) {
    const std::string text = write_extension(test::make_sample_file().detail);
    for (int k = 0; k < 20000; ++k) {
        Bytes bytes(text.begin(), text.end());
        damage(bytes);
        const Result<PathDetail> read =
            parse_extension(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        if (read.ok()) {
            EXPECT_GT(read->depth, 0.0);
            EXPECT_LE(read->sections.end(), static_cast<std::uint32_t>(read->data_width * read->data_height));
        }
    }
}

}  // namespace
}  // namespace burin
