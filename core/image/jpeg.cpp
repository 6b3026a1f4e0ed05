// SPDX-License-Identifier: Apache-2.0
//
// libjpeg reports errors by calling error_exit, which must not return, and damaged data as mere
// warnings. Both leave by longjmp here; as that runs no destructors, everything that owns memory
// lives in a struct outside of the function that calls setjmp.
#include "hone/core/image/jpeg.h"

#include "hone/core/error.h"

// jpeglib.h needs size_t and FILE, and names neither header.
#include <cstddef>
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>

#include <csetjmp>

namespace hone {
namespace {

struct JpegReader {
    jpeg_error_mgr errors{}; // first: the library's pointer to it is a pointer to the whole
    std::jmp_buf failed;
    char message[JMSG_LENGTH_MAX] = "";
    jpeg_decompress_struct jpeg{};
    std::vector<std::uint8_t> row;
    Image8 image;

    JpegReader() = default;
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

[[noreturn]] void leave(j_common_ptr jpeg) {
    auto* reader = reinterpret_cast<JpegReader*>(jpeg->err);
    jpeg->err->format_message(jpeg, reader->message);
    std::longjmp(reader->failed, 1);
}

/// Lost picture data ends the work; oddities that every viewer forgives do not. Level -1: warning.
void judgeMessage(j_common_ptr jpeg, int level) {
    if (level >= 0)
        return;
    const int code = jpeg->err->msg_code;
    if (code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR &&
        code != JWRN_TOO_MUCH_DATA)
        leave(jpeg);
}

[[noreturn]] void leaveWith(JpegReader& reader, const char* message) {
    std::snprintf(reader.message, sizeof reader.message, "%s", message);
    std::longjmp(reader.failed, 1);
}

/// A progressive file may hold any number of scans, each of which costs time for every pixel.
void countScans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > 500)
        leaveWith(*reinterpret_cast<JpegReader*>(jpeg->err), "more than 500 scans");
}

/// Grows with the rows that are really there, so that a small file with a large claim costs little.
void appendRow(JpegReader& reader) {
    for (std::size_t x = 0; x < reader.row.size(); x += 3)
        reader.image.rgba.insert(reader.image.rgba.end(),
                                 {reader.row[x], reader.row[x + 1], reader.row[x + 2], 255});
}

void reserveImage(JpegReader& reader) {
    reader.image.extent = {reader.jpeg.image_width, reader.jpeg.image_height};
    reader.image.rgba.reserve(4 * std::size_t(reader.image.extent.x) * reader.image.extent.y);
    reader.row.resize(3 * std::size_t(reader.image.extent.x));
}

/// False if an error ended it; reader.message says which.
bool readImage(JpegReader& reader, std::span<const std::byte> file, jpeg_progress_mgr& progress) {
    jpeg_decompress_struct& jpeg = reader.jpeg;
    jpeg.err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = leave;
    reader.errors.emit_message = judgeMessage;
    if (setjmp(reader.failed) != 0)
        return false;
    jpeg_create_decompress(&jpeg);
    progress.progress_monitor = countScans;
    jpeg.progress = &progress;
    jpeg.mem->max_memory_to_use = 2l << 30;
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
    jpeg_read_header(&jpeg, TRUE);

    if (jpeg.image_width > kMaxImageSide || jpeg.image_height > kMaxImageSide ||
        std::uint64_t(jpeg.image_width) * jpeg.image_height > kMaxImagePixels)
        leaveWith(reader, "larger than 16384 pixels a side or 2^28 in all");
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK)
        leaveWith(reader, "it is CMYK, made for printing; convert it to RGB");
    jpeg.out_color_space = JCS_RGB;
    jpeg.dct_method = JDCT_ISLOW; // exact integers: the same pixels on every machine
    reserveImage(reader);
    jpeg_start_decompress(&jpeg);
    while (jpeg.output_scanline < jpeg.output_height) {
        JSAMPROW row = reader.row.data();
        jpeg_read_scanlines(&jpeg, &row, 1);
        appendRow(reader);
    }
    jpeg_finish_decompress(&jpeg);
    return true;
}

} // namespace

bool isJpeg(std::span<const std::byte> file) {
    return file.size() >= 3 && file[0] == std::byte{0xff} && file[1] == std::byte{0xd8} &&
           file[2] == std::byte{0xff};
}

Image8 decodeJpeg(std::span<const std::byte> file, const std::string& name) {
    JpegReader reader;
    jpeg_progress_mgr progress{};
    if (!readImage(reader, file, progress))
        throw InputError(name + ": cannot be read as JPEG: " + reader.message);
    return std::move(reader.image);
}

} // namespace hone
