// SPDX-License-Identifier: Apache-2.0
//
// libpng reports errors by longjmp, which runs no destructors. So everything that owns memory lives
// in a struct outside of the function that calls setjmp, and that function has plain locals only.
#include "hone/core/image/png.h"

#include "hone/core/error.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

namespace hone {
namespace {

/// What both directions keep: the message of the error that ended the work.
struct PngState {
    png_structp png = nullptr;
    png_infop info = nullptr;
    char message[160] = "";
};

void keepMessage(png_structp png, png_const_charp message) {
    auto* state = static_cast<PngState*>(png_get_error_ptr(png));
    std::snprintf(state->message, sizeof state->message, "%s", message);
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

// --- Reading

struct PngReader : PngState {
    std::span<const std::byte> rest;
    std::uint64_t file_size = 0;
    uvec2 extent{0, 0};
    std::vector<png_bytep> rows;
    Image8 image;

    explicit PngReader(std::span<const std::byte> file) : rest(file), file_size(file.size()) {}
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void readBytes(png_structp png, png_bytep to, std::size_t size) {
    auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > reader->rest.size())
        png_error(png, "the file ends too early");
    std::memcpy(to, reader->rest.data(), size);
    reader->rest = reader->rest.subspan(size);
}

/// Allocates the image. An image whose compressed data cannot be in the file is refused before its
/// memory is touched: deflate shrinks at most 1032 times.
void allocateImage(PngReader& reader) {
    const std::uint64_t pixels = std::uint64_t(reader.extent.x) * reader.extent.y;
    if (pixels > kMaxImagePixels)
        png_error(reader.png, "more than 2^28 pixels");
    const std::uint64_t packed =
        std::uint64_t(png_get_rowbytes(reader.png, reader.info)) * reader.extent.y;
    if (packed / 1032 > reader.file_size)
        png_error(reader.png, "the file is too small for its image");
    reader.image.extent = reader.extent;
    reader.image.rgba.resize(4 * pixels);
    reader.rows.resize(reader.extent.y);
    for (std::size_t y = 0; y < reader.rows.size(); ++y)
        reader.rows[y] = reader.image.rgba.data() + 4 * y * reader.extent.x;
}

/// False if an error ended it; reader.message says which.
bool readImage(PngReader& reader) {
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&reader),
                                        keepMessage, ignoreWarning);
    reader.info = reader.png != nullptr ? png_create_info_struct(reader.png) : nullptr;
    if (reader.info == nullptr) {
        std::snprintf(reader.message, sizeof reader.message, "libpng has no memory");
        return false;
    }
    if (setjmp(png_jmpbuf(reader.png)) != 0)
        return false;

    // Bounds first: side lengths, and the size of compressed text and profiles.
    png_set_user_limits(reader.png, kMaxImageSide, kMaxImageSide);
    png_set_chunk_malloc_max(reader.png, 16u << 20);
    png_set_read_fn(reader.png, &reader, readBytes);
    png_read_info(reader.png, reader.info);
    reader.extent = {png_get_image_width(reader.png, reader.info),
                     png_get_image_height(reader.png, reader.info)};

    // Everything becomes RGBA8.
    const bool has_key = png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) != 0;
    const png_byte color = png_get_color_type(reader.png, reader.info);
    allocateImage(reader);
    png_set_expand(reader.png);
    png_set_scale_16(reader.png);
    png_set_gray_to_rgb(reader.png);
    if ((color & PNG_COLOR_MASK_ALPHA) == 0 && !has_key)
        png_set_add_alpha(reader.png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    if (png_get_rowbytes(reader.png, reader.info) != 4 * std::size_t(reader.extent.x))
        png_error(reader.png, "an unknown kind of pixel");
    png_read_image(reader.png, reader.rows.data());
    png_read_end(reader.png, nullptr);
    return true;
}

// --- Writing

struct PngWriter : PngState {
    const Image8& image;
    std::vector<png_text> text;
    std::vector<std::uint8_t> pixels;
    std::vector<png_const_bytep> rows;
    bool has_alpha = false;
    std::vector<std::byte> file;

    explicit PngWriter(const Image8& source) : image(source) {}
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

void writeBytes(png_structp png, png_bytep from, std::size_t size) {
    auto* writer = static_cast<PngWriter*>(png_get_io_ptr(png));
    const auto* bytes = reinterpret_cast<const std::byte*>(from);
    writer->file.insert(writer->file.end(), bytes, bytes + size);
}

void flushNothing(png_structp) {}

bool isAscii(const std::string& text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 128; });
}

void gatherRows(PngWriter& writer) {
    const auto& rgba = writer.image.rgba;
    for (std::size_t i = 3; i < rgba.size() && !writer.has_alpha; i += 4)
        writer.has_alpha = rgba[i] != 255;
    const std::size_t row = std::size_t(writer.image.extent.x) * (writer.has_alpha ? 4 : 3);
    writer.pixels.reserve(row * writer.image.extent.y);
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        for (std::size_t channel = 0; channel < (writer.has_alpha ? 4u : 3u); ++channel)
            writer.pixels.push_back(rgba[i + channel]);
    for (std::size_t y = 0; y < writer.image.extent.y; ++y)
        writer.rows.push_back(writer.pixels.data() + y * row);
}

void gatherText(PngWriter& writer, const ImageText& text) {
    for (const auto& [keyword, value] : text) {
        png_text chunk{};
        chunk.compression = isAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        // libpng does not write through these, its C structs only lack the const.
        chunk.key = const_cast<char*>(keyword.c_str());
        chunk.text = const_cast<char*>(value.c_str());
        if (isAscii(value))
            chunk.text_length = value.size();
        else
            chunk.itxt_length = value.size();
        writer.text.push_back(chunk);
    }
}

bool writeImage(PngWriter& writer) {
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, static_cast<PngState*>(&writer),
                                         keepMessage, ignoreWarning);
    writer.info = writer.png != nullptr ? png_create_info_struct(writer.png) : nullptr;
    if (writer.info == nullptr) {
        std::snprintf(writer.message, sizeof writer.message, "libpng has no memory");
        return false;
    }
    if (setjmp(png_jmpbuf(writer.png)) != 0)
        return false;
    png_set_write_fn(writer.png, &writer, writeBytes, flushNothing);
    png_set_IHDR(writer.png, writer.info, writer.image.extent.x, writer.image.extent.y, 8,
                 writer.has_alpha ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_text(writer.png, writer.info, writer.text.data(), static_cast<int>(writer.text.size()));
    png_write_info(writer.png, writer.info);
    png_write_image(writer.png, const_cast<png_bytepp>(writer.rows.data()));
    png_write_end(writer.png, writer.info);
    return true;
}

} // namespace

bool isPng(std::span<const std::byte> file) {
    return file.size() >= 8 &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) == 0;
}

Image8 decodePng(std::span<const std::byte> file, const std::string& name) {
    PngReader reader(file);
    if (!readImage(reader))
        throw InputError(name + ": cannot be read as PNG: " + reader.message);
    return std::move(reader.image);
}

std::vector<std::byte> encodePng(const Image8& image, const ImageText& text) {
    const std::size_t size = 4 * std::size_t(image.extent.x) * image.extent.y;
    HONE_ASSERT(size > 0 && image.rgba.size() == size, std::to_string(image.rgba.size()));
    PngWriter writer(image);
    gatherRows(writer);
    gatherText(writer, text);
    if (!writeImage(writer))
        throw OutputError(std::string("PNG encoding failed: ") + writer.message);
    return std::move(writer.file);
}

} // namespace hone
