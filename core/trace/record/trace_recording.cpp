// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/record/trace_recording.h"

#include "hone/core/error.h"

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace hone {

static_assert(std::endian::native == std::endian::little, "recordings are little-endian");

namespace {

/// Mixes bytes into a hash, eight at a time (the multiply and shift of MurmurHash's finaliser).
std::uint64_t mixBytes(std::uint64_t hash, std::span<const std::byte> bytes) {
    const auto mix = [&hash](std::uint64_t word) {
        hash = (hash ^ word) * 0xff51afd7ed558ccdull;
        hash ^= hash >> 32;
    };
    while (bytes.size() >= sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data(), sizeof word);
        mix(word);
        bytes = bytes.subspan(sizeof word);
    }
    std::uint64_t rest = bytes.size(); // so that trailing zeros count
    if (!bytes.empty())
        std::memcpy(reinterpret_cast<char*>(&rest) + 1, bytes.data(), bytes.size());
    mix(rest);
    return hash;
}

/// Reads a file from the front, and knows where it is.
class Reader {
public:
    explicit Reader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
        std::error_code error;
        if (std::filesystem::is_regular_file(path, error))
            left_ = std::filesystem::file_size(path, error);
        if (!file_ || error || !std::filesystem::is_regular_file(path, error))
            throw InputError(path + ": cannot read this file");
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(path_ + ": at byte " + std::to_string(at_) + ": " + what);
    }
    [[nodiscard]] std::uint64_t left() const { return left_; }

    void read(std::span<std::byte> bytes) {
        if (bytes.size() > left_)
            fail("the file is cut short");
        file_.read(reinterpret_cast<char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
        if (!file_)
            fail("cannot read on");
        at_ += bytes.size();
        left_ -= bytes.size();
    }
    template <class T> T record() {
        T value;
        read(std::as_writable_bytes(std::span(&value, 1)));
        return value;
    }
    template <class T> std::vector<T> list(std::uint64_t count) {
        if (count > left_ / sizeof(T))
            fail("the file is cut short");
        std::vector<T> values(count);
        read(std::as_writable_bytes(std::span(values)));
        return values;
    }

private:
    std::string path_;
    std::ifstream file_;
    std::uint64_t at_ = 0, left_ = 0;
};

/// Takes what a build says apart: two texts with their lengths before them, and the scene's hash.
void readBuild(RecordedJob& job, std::span<const std::byte> bytes, const Reader& reader) {
    const auto take = [&](void* to, std::size_t count) {
        if (count > bytes.size())
            reader.fail("a build's names do not fit into it");
        if (count > 0)
            std::memcpy(to, bytes.data(), count);
        bytes = bytes.subspan(count);
    };
    for (std::string* text : {&job.backend, &job.scene}) {
        std::uint32_t length = 0;
        take(&length, sizeof length);
        if (length > bytes.size())
            reader.fail("a build's names do not fit into it");
        text->resize(length);
        take(text->data(), length);
    }
    take(&job.scene_hash, sizeof job.scene_hash);
    if (!bytes.empty())
        reader.fail("a build says more than it should");
}

} // namespace

namespace trace_file {

std::uint64_t checksum(const ChunkHeader& header,
                       std::span<const std::span<const std::byte>> parts) {
    ChunkHeader plain = header;
    plain.checksum = 0;
    std::uint64_t hash = mixBytes(1, std::as_bytes(std::span(&plain, 1)));
    for (const std::span<const std::byte> part : parts)
        if (!part.empty())
            hash = mixBytes(hash, part);
    return hash;
}

} // namespace trace_file

TraceRecording readTraceRecording(const std::string& path) {
    using namespace trace_file;
    Reader reader(path);
    if (reader.left() < sizeof(Header))
        reader.fail("this is no recording of rays: it is too short");
    const auto file_header = reader.record<Header>();
    if (std::memcmp(file_header.magic, kMagic, sizeof kMagic) != 0)
        reader.fail("this is no recording of rays (hone render --record makes them)");
    if (file_header.version != kVersion || file_header.ray_bytes != sizeof(Ray))
        reader.fail("recorded by another version of hone: format " +
                    std::to_string(file_header.version) + ", expected " + std::to_string(kVersion));

    TraceRecording recording;
    for (;;) {
        const auto header = reader.record<ChunkHeader>();
        if (header.bytes > reader.left())
            reader.fail("the file is cut short: " + std::to_string(header.bytes) +
                        " bytes should follow, " + std::to_string(reader.left()) + " do");
        // How many bytes each element takes; 0: the count must be 0.
        const auto require_size = [&](std::uint64_t element) {
            if (element == 0 ? header.count != 0
                             : header.count > header.bytes / element ||
                                   header.count * element != header.bytes)
                reader.fail("a chunk's count and size do not fit each other");
        };
        RecordedJob job{.kind = header.kind, .tracer = header.tracer};
        job.coherence =
            (header.flags & kCoherentFlag) != 0 ? Coherence::kCoherent : Coherence::kIncoherent;
        job.options.exact = (header.flags & kExactFlag) != 0;
        std::vector<std::byte> text;
        std::uint64_t found = 0;
        const auto sum = [&](auto... parts) {
            const std::span<const std::byte> all[] = {std::as_bytes(std::span(parts))...};
            found = checksum(header, all);
        };
        switch (header.kind) {
        case JobKind::kBuild:
            require_size(0);
            text = reader.list<std::byte>(header.bytes);
            sum(std::span<const std::byte>(text));
            break;
        case JobKind::kUpdate:
            require_size(sizeof(MovedInstance));
            job.moved = reader.list<MovedInstance>(header.count);
            sum(std::span<const MovedInstance>(job.moved));
            break;
        case JobKind::kClosest:
            require_size(sizeof(Ray) + sizeof(Hit));
            job.rays = reader.list<Ray>(header.count);
            job.hits = reader.list<Hit>(header.count);
            sum(std::span<const Ray>(job.rays), std::span<const Hit>(job.hits));
            break;
        case JobKind::kOccluded:
            require_size(sizeof(Ray) + sizeof(uint));
            job.rays = reader.list<Ray>(header.count);
            job.occluded = reader.list<uint>(header.count);
            sum(std::span<const Ray>(job.rays), std::span<const uint>(job.occluded));
            break;
        case JobKind::kEnd:
            require_size(0);
            sum(std::span<const std::byte>());
            break;
        default:
            reader.fail("a chunk of the unknown kind " +
                        std::to_string(static_cast<std::uint32_t>(header.kind)));
        }
        if (found != header.checksum)
            reader.fail("the bytes before it were changed: their checksum differs");
        if (header.kind == JobKind::kEnd) {
            if (header.bytes != 0 || reader.left() != 0)
                reader.fail("something follows the recording's end");
            recording.is_cut = (header.flags & kCutFlag) != 0;
            return recording;
        }
        if (header.kind == JobKind::kBuild)
            readBuild(job, text, reader);
        recording.jobs.push_back(std::move(job));
    }
}

std::uint64_t traceHash(const Scene& scene) {
    std::uint64_t hash = 2;
    const auto mix = [&](const auto& array) {
        hash = mixBytes(hash, std::as_bytes(std::span(array)));
    };
    mix(scene.positions);
    mix(scene.uvs);
    mix(scene.triangles);
    mix(scene.meshes);
    mix(scene.instances);
    mix(scene.materials);
    mix(scene.textures);
    mix(scene.texels);
    return hash;
}

} // namespace hone
