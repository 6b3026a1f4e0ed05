// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/trace_backend.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hone {

/// What a recorder writes down (trace_recorder.h) and a replay asks again.
enum class JobKind : std::uint32_t { kBuild = 1, kUpdate, kClosest, kOccluded, kEnd };

/// Where an instance was put; layout of the file.
struct MovedInstance {
    uint instance;
    mat4x3 to_world;
};
static_assert(sizeof(MovedInstance) == 52);

/// One call of a trace backend. Only the members of its kind are filled.
struct RecordedJob {
    JobKind kind = JobKind::kBuild;
    uint tracer = 0; ///< the backends of a run are numbered in the order in which they were made
    // kBuild
    std::string backend = {}; ///< TraceCaps::name
    std::string scene = {};   ///< Scene::name
    std::uint64_t scene_hash = 0;
    // kUpdate
    std::vector<MovedInstance> moved = {};
    // kClosest, kOccluded
    Coherence coherence = Coherence::kIncoherent;
    TraceOptions options = {};
    std::vector<Ray> rays = {};
    std::vector<Hit> hits = {};
    std::vector<uint> occluded = {};
};

struct TraceRecording {
    std::vector<RecordedJob> jobs;
    bool is_cut = false; ///< the recorder stopped at its limit: the run went on
};

/// The file, whole. Throws InputError, which says at which byte, for a file that is no recording,
/// of another version, cut short or changed; never asks for more memory than the file has bytes.
[[nodiscard]] TraceRecording readTraceRecording(const std::string& path);

/// A number that differs where two scenes answer rays differently: of geometry, placement, alpha.
[[nodiscard]] std::uint64_t traceHash(const Scene& scene);

/// The file's layout: a header, then chunks of a header and as many bytes as it says, the last of
/// kind kEnd. Numbers are little-endian; lists lie one after another in the layout of ray.glsl.h.
namespace trace_file {

inline constexpr char kMagic[8] = {'h', 'o', 'n', 'e', 'r', 'a', 'y', '\n'};
inline constexpr std::uint32_t kVersion = 1;

struct Header {
    char magic[8];
    std::uint32_t version;
    std::uint32_t ray_bytes; ///< sizeof(Ray)
};

inline constexpr std::uint32_t kCoherentFlag = 1, kExactFlag = 2, kCutFlag = 4;

struct ChunkHeader {
    JobKind kind = JobKind::kEnd;
    std::uint32_t flags = 0;
    std::uint32_t tracer = 0;
    std::uint32_t zero = 0;
    std::uint64_t count = 0; ///< of rays or moved instances
    std::uint64_t bytes = 0; ///< that follow
    std::uint64_t checksum = 0;
};
static_assert(sizeof(Header) == 16 && sizeof(ChunkHeader) == 40);

/// Of the bytes that follow, and of the chunk's other members.
[[nodiscard]] std::uint64_t checksum(const ChunkHeader& header,
                                     std::span<const std::span<const std::byte>> parts);

} // namespace trace_file
} // namespace hone
