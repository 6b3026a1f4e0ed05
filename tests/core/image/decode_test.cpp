// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/decode.h"

#include "hone/core/error.h"
#include "hone/core/image/exr.h"
#include "hone/core/image/png.h"

#include <cstddef>
#include <cstdio>

#include <gtest/gtest.h>
#include <jpeglib.h>
#include <png.h>

#include <cstdlib>
#include <functional>

namespace hone {
namespace {

using Bytes = std::vector<std::byte>;

/// A PNG of any kind, written with the library itself. `row` gives the packed bytes of row y.
Bytes makePng(uvec2 extent, int color, int depth, bool interlaced,
              const std::function<std::vector<png_byte>(uint)>& row,
              const std::function<void(png_structp, png_infop)>& more = {}) {
    Bytes file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp p, png_bytep from, std::size_t size) {
            auto& to = *static_cast<Bytes*>(png_get_io_ptr(p));
            const auto* bytes = reinterpret_cast<const std::byte*>(from);
            to.insert(to.end(), bytes, bytes + size);
        },
        [](png_structp) {});
    png_set_IHDR(png, info, extent.x, extent.y, depth, color,
                 interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
                 PNG_FILTER_TYPE_BASE);
    if (more)
        more(png, info);
    png_write_info(png, info);
    std::vector<std::vector<png_byte>> rows;
    std::vector<png_bytep> pointers;
    for (uint y = 0; y < extent.y; ++y)
        rows.push_back(row(y));
    for (auto& r : rows)
        pointers.push_back(r.data());
    png_write_image(png, pointers.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

/// A JPEG of one colour; components as the colour space has them.
Bytes makeJpeg(uvec2 extent, J_COLOR_SPACE space, std::vector<JSAMPLE> color,
               bool progressive = false) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &data, &size);
    jpeg.image_width = extent.x;
    jpeg.image_height = extent.y;
    jpeg.input_components = static_cast<int>(color.size());
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row;
    for (uint x = 0; x < extent.x; ++x)
        row.insert(row.end(), color.begin(), color.end());
    JSAMPROW pointer = row.data();
    while (jpeg.next_scanline < extent.y)
        jpeg_write_scanlines(&jpeg, &pointer, 1);
    jpeg_finish_compress(&jpeg);
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    Bytes file(bytes, bytes + size);
    jpeg_destroy_compress(&jpeg);
    std::free(data);
    return file;
}

std::vector<std::uint8_t> pixel(const Image8& image, uint x, uint y) {
    const auto* p = image.rgba.data() + 4 * (std::size_t(y) * image.extent.x + x);
    return {p[0], p[1], p[2], p[3]};
}

using Pixel = std::vector<std::uint8_t>;

std::string messageOf(const Bytes& file) {
    try {
        (void)decodeImage(file, "roof.img");
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(DecodePng, KeepsEightBitColourAndAlpha) {
    const Bytes file = makePng({2, 1}, PNG_COLOR_TYPE_RGBA, 8, false, [](uint) {
        return std::vector<png_byte>{1, 2, 3, 4, 250, 251, 252, 253};
    });
    const Image8 image = decodeImage(file, "a");
    EXPECT_EQ(image.extent, uvec2(2, 1));
    EXPECT_EQ(image.rgba, (Pixel{1, 2, 3, 4, 250, 251, 252, 253}));
}

TEST(DecodePng, MakesOpaqueWhatHasNoAlpha) {
    const Bytes file = makePng({1, 1}, PNG_COLOR_TYPE_RGB, 8, false, [](uint) {
        return std::vector<png_byte>{9, 8, 7};
    });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{9, 8, 7, 255}));
}

TEST(DecodePng, RoundsSixteenBitSamples) {
    // 0x8000 / 257 = 127.5.. -> 128 (32768 * 255 / 65535 = 127.502); 0x00ff -> 0.99 -> 1.
    const Bytes file = makePng({1, 1}, PNG_COLOR_TYPE_RGB, 16, false, [](uint) {
        return std::vector<png_byte>{0x80, 0x00, 0xff, 0xff, 0x00, 0xff};
    });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{128, 255, 1, 255}));
}

TEST(DecodePng, SpreadsOneBitGrey) {
    const Bytes file = makePng({8, 1}, PNG_COLOR_TYPE_GRAY, 1, false,
                               [](uint) { return std::vector<png_byte>{0b10000001}; });
    const Image8 image = decodeImage(file, "a");
    EXPECT_EQ(pixel(image, 0, 0), (Pixel{255, 255, 255, 255}));
    EXPECT_EQ(pixel(image, 1, 0), (Pixel{0, 0, 0, 255}));
    EXPECT_EQ(pixel(image, 7, 0), (Pixel{255, 255, 255, 255}));
}

TEST(DecodePng, KeepsAlphaOfGrey) {
    const Bytes file = makePng({1, 1}, PNG_COLOR_TYPE_GRAY_ALPHA, 8, false, [](uint) {
        return std::vector<png_byte>{40, 50};
    });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{40, 40, 40, 50}));
}

TEST(DecodePng, LooksUpPaletteWithTransparency) {
    const Bytes file = makePng(
        {2, 1}, PNG_COLOR_TYPE_PALETTE, 4, false, [](uint) { return std::vector<png_byte>{0x01}; },
        [](png_structp png, png_infop info) {
            const png_color colors[2] = {{10, 20, 30}, {40, 50, 60}};
            const png_byte alpha[2] = {0, 200};
            png_set_PLTE(png, info, colors, 2);
            png_set_tRNS(png, info, alpha, 2, nullptr);
        });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{10, 20, 30, 0, 40, 50, 60, 200}));
}

TEST(DecodePng, MakesTheKeyColourTransparent) {
    const Bytes file = makePng(
        {2, 1}, PNG_COLOR_TYPE_RGB, 8, false,
        [](uint) { return std::vector<png_byte>{1, 2, 3, 1, 2, 4}; },
        [](png_structp png, png_infop info) {
            png_color_16 key{};
            key.red = 1, key.green = 2, key.blue = 3;
            png_set_tRNS(png, info, nullptr, 0, &key);
        });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{1, 2, 3, 0, 1, 2, 4, 255}));
}

TEST(DecodePng, ReadsInterlacedRows) {
    const Bytes file = makePng({5, 9}, PNG_COLOR_TYPE_GRAY, 8, true, [](uint y) {
        std::vector<png_byte> row;
        for (uint x = 0; x < 5; ++x)
            row.push_back(static_cast<png_byte>(10 * y + x));
        return row;
    });
    const Image8 image = decodeImage(file, "a");
    for (uint y = 0; y < 9; ++y)
        for (uint x = 0; x < 5; ++x)
            EXPECT_EQ(pixel(image, x, y)[0], 10 * y + x);
}

TEST(DecodePng, IgnoresGamma) {
    const Bytes file = makePng(
        {1, 1}, PNG_COLOR_TYPE_GRAY, 8, false, [](uint) { return std::vector<png_byte>{100}; },
        [](png_structp png, png_infop info) { png_set_gAMA_fixed(png, info, 100000); });
    EXPECT_EQ(decodeImage(file, "a").rgba, (Pixel{100, 100, 100, 255}));
}

TEST(DecodePng, RefusesLongSides) {
    const Bytes file = makePng({kMaxImageSide + 1, 1}, PNG_COLOR_TYPE_GRAY, 1, false,
                               [](uint) { return std::vector<png_byte>(kMaxImageSide / 8 + 1); });
    EXPECT_NE(messageOf(file).find("roof.img"), std::string::npos);
    EXPECT_NE(messageOf(file), "no error");
}

TEST(DecodePng, RefusesClaimsThatTheFileCannotHoldWithoutAllocating) {
    Bytes file = makePng({1, 1}, PNG_COLOR_TYPE_RGBA, 8, false,
                         [](uint) { return std::vector<png_byte>(4); });
    // 16384 x 16384 in the header (IHDR data at 16), with its checksum (CRC-32 of type and data).
    const unsigned char claim[13] = {0, 0, 0x40, 0, 0, 0, 0x40, 0, 8, 6, 0, 0, 0};
    std::uint32_t crc = 0xffffffffu;
    const auto feed = [&crc](unsigned char byte) {
        crc ^= byte;
        for (int k = 0; k < 8; ++k)
            crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    };
    for (const char c : {'I', 'H', 'D', 'R'})
        feed(static_cast<unsigned char>(c));
    for (std::size_t i = 0; i < 13; ++i) {
        feed(claim[i]);
        file[16 + i] = std::byte{claim[i]};
    }
    crc = ~crc;
    for (std::size_t i = 0; i < 4; ++i)
        file[29 + i] = static_cast<std::byte>(crc >> (24 - 8 * i));
    EXPECT_NE(messageOf(file).find("too small for its image"), std::string::npos)
        << messageOf(file);
}

TEST(DecodeJpeg, ReadsColour) {
    const Image8 image = decodeImage(makeJpeg({17, 9}, JCS_RGB, {200, 100, 50}), "a");
    EXPECT_EQ(image.extent, uvec2(17, 9));
    // Quality 100 keeps a flat colour to the rounding of YCbCr: at most 2 codes.
    for (uint y = 0; y < 9; ++y)
        for (uint x = 0; x < 17; ++x) {
            EXPECT_NEAR(pixel(image, x, y)[0], 200, 2);
            EXPECT_NEAR(pixel(image, x, y)[1], 100, 2);
            EXPECT_NEAR(pixel(image, x, y)[2], 50, 2);
            EXPECT_EQ(pixel(image, x, y)[3], 255);
        }
}

TEST(DecodeJpeg, ReadsProgressiveGrey) {
    const Image8 image = decodeImage(makeJpeg({8, 8}, JCS_GRAYSCALE, {77}, true), "a");
    EXPECT_NEAR(pixel(image, 3, 3)[0], 77, 1);
    EXPECT_EQ(pixel(image, 3, 3)[0], pixel(image, 3, 3)[2]);
}

TEST(DecodeJpeg, RefusesCmykWithTheCure) {
    const std::string message = messageOf(makeJpeg({8, 8}, JCS_CMYK, {1, 2, 3, 4}));
    EXPECT_NE(message.find("CMYK"), std::string::npos);
    EXPECT_NE(message.find("convert it to RGB"), std::string::npos);
}

TEST(DecodeJpeg, RefusesLongSides) {
    EXPECT_NE(messageOf(makeJpeg({kMaxImageSide + 1, 1}, JCS_GRAYSCALE, {1})).find("16384"),
              std::string::npos);
}

TEST(DecodeImage, RefusesOtherFilesByName) {
    EXPECT_NE(messageOf(Bytes(100, std::byte{'x'})).find("roof.img: is neither PNG nor JPEG"),
              std::string::npos);
    EXPECT_NE(messageOf({}).find("roof.img"), std::string::npos);
}

// --- Damage: an InputError or an image of the right size, never a crash or a leak

void expectErrorOrImage(const std::function<void()>& decode) {
    try {
        decode();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("roof.img"), std::string::npos);
    }
}

void damageEverywhere(const Bytes& file, const std::function<void(const Bytes&)>& decode) {
    for (std::size_t size = 0; size < file.size(); size += 16)
        expectErrorOrImage(
            [&] { decode(Bytes(file.begin(), file.begin() + std::ptrdiff_t(size))); });
    std::uint32_t random = 1;
    for (int round = 0; round < 400; ++round) {
        Bytes damaged = file;
        for (int flips = 0; flips < 3; ++flips) {
            random = random * 1664525u + 1013904223u;
            damaged[(random >> 8) % damaged.size()] ^= static_cast<std::byte>(1u << (random >> 29));
        }
        expectErrorOrImage([&] { decode(damaged); });
    }
}

Bytes noisyPng(bool interlaced) {
    return makePng({31, 17}, PNG_COLOR_TYPE_RGBA, 8, interlaced, [](uint y) {
        std::vector<png_byte> row;
        for (uint i = 0; i < 31 * 4; ++i)
            row.push_back(static_cast<png_byte>((i * 37 + y * 91) ^ (i * y)));
        return row;
    });
}

TEST(DamagedFile, PngGivesErrorOrImage) {
    for (const bool interlaced : {false, true})
        damageEverywhere(noisyPng(interlaced), [](const Bytes& file) {
            const Image8 image = decodeImage(file, "roof.img");
            EXPECT_EQ(image.rgba.size(), 4 * std::size_t(image.extent.x) * image.extent.y);
        });
}

TEST(DamagedFile, JpegGivesErrorOrImage) {
    for (const bool progressive : {false, true})
        damageEverywhere(
            makeJpeg({64, 48}, JCS_RGB, {200, 100, 50}, progressive), [](const Bytes& file) {
                const Image8 image = decodeImage(file, "roof.img");
                EXPECT_EQ(image.rgba.size(), 4 * std::size_t(image.extent.x) * image.extent.y);
            });
}

TEST(DamagedFile, ExrGivesErrorOrImage) {
    LayeredImage source{{19, 40}, {{"error", {"bound", "expect"}, {}}}, {{"graph", "sir"}}};
    for (uint i = 0; i < 19 * 40 * 2; ++i)
        source.layers[0].values.push_back(float(i * i % 977));
    damageEverywhere(encodeExr(source), [](const Bytes& file) {
        const LayeredImage image = decodeExr(file, "roof.img");
        for (const ImageLayer& layer : image.layers)
            EXPECT_EQ(layer.values.size(),
                      std::size_t(image.extent.x) * image.extent.y * layer.channel_names.size());
    });
}

TEST(TruncatedFile, IsAnErrorWherePixelsAreMissing) {
    const Bytes png = noisyPng(false);
    EXPECT_NE(messageOf(Bytes(png.begin(), png.begin() + std::ptrdiff_t(png.size() / 2))),
              "no error");
    const Bytes jpeg = makeJpeg({64, 48}, JCS_RGB, {200, 100, 50});
    EXPECT_NE(messageOf(Bytes(jpeg.begin(), jpeg.end() - 40)), "no error");
}

} // namespace
} // namespace hone
