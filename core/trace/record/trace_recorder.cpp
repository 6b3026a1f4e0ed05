// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/record/trace_recorder.h"

#include "hone/core/error.h"
#include "hone/core/log.h"

#include <cstring>
#include <filesystem>
#include <system_error>

namespace hone {

using trace_file::ChunkHeader;

namespace {

std::uint32_t flagsOf(Coherence coherence, const TraceOptions& options) {
    return (coherence == Coherence::kCoherent ? trace_file::kCoherentFlag : 0u) |
           (options.exact ? trace_file::kExactFlag : 0u);
}

} // namespace

TraceRecorder::TraceRecorder(std::string path, std::uint64_t limit)
    : path_(std::move(path)), limit_(limit) {
    std::error_code error;
    if (std::filesystem::exists(path_, error) && !std::filesystem::is_regular_file(path_, error))
        throw OutputError(path_ + ": is no plain file; name a file to record to");
    file_.open(path_ + ".part", std::ios::binary | std::ios::trunc);
    if (!file_)
        throw OutputError(path_ + ".part: cannot create this file to record to");
    trace_file::Header header{
        .magic = {}, .version = trace_file::kVersion, .ray_bytes = sizeof(Ray)};
    std::memcpy(header.magic, trace_file::kMagic, sizeof header.magic);
    write(std::as_bytes(std::span(&header, 1)));
}

TraceRecorder::~TraceRecorder() {
    if (is_finished_)
        return;
    // The run failed: what it asked until then is what someone will want to look at.
    try {
        finish();
    } catch (const OutputError& problem) {
        logger().warn("{}", problem.what());
        std::error_code ignored;
        std::filesystem::remove(path_ + ".part", ignored);
    }
}

void TraceRecorder::write(std::span<const std::byte> bytes) {
    file_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
    bytes_ += bytes.size();
}

void TraceRecorder::add(ChunkHeader header, std::span<const std::byte> first,
                        std::span<const std::byte> second) {
    if (is_cut_ || has_failed_)
        return;
    header.bytes = first.size() + second.size();
    // Room for the end must stay.
    if (bytes_ + 2 * sizeof(ChunkHeader) + header.bytes > limit_) {
        is_cut_ = true;
        logger().warn("{}: the recording reached its limit of {} bytes and ends here; the run goes "
                      "on (--record-limit raises it)",
                      path_, limit_);
        return;
    }
    const std::span<const std::byte> parts[] = {first, second};
    header.checksum = trace_file::checksum(header, parts);
    write(std::as_bytes(std::span(&header, 1)));
    for (const auto& part : parts)
        if (!part.empty())
            write(part);
    if (!file_) {
        has_failed_ = true;
        logger().warn("{}: cannot record further; the run goes on", path_);
    }
}

void TraceRecorder::addBuild(uint tracer, const std::string& backend, const Scene& scene) {
    std::string bytes;
    const auto append = [&](const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    };
    for (const std::string* text : {&backend, &scene.name}) {
        const auto length = static_cast<std::uint32_t>(text->size());
        append(&length, sizeof length);
        append(text->data(), text->size());
    }
    const std::uint64_t hash = traceHash(scene);
    append(&hash, sizeof hash);
    add({.kind = JobKind::kBuild, .tracer = tracer}, std::as_bytes(std::span(bytes)), {});
}

void TraceRecorder::addUpdate(uint tracer, std::span<const MovedInstance> moved) {
    add({.kind = JobKind::kUpdate, .tracer = tracer, .count = moved.size()}, std::as_bytes(moved),
        {});
}

void TraceRecorder::addClosest(uint tracer, std::span<const Ray> rays, std::span<const Hit> hits,
                               Coherence coherence, const TraceOptions& options) {
    add({.kind = JobKind::kClosest,
         .flags = flagsOf(coherence, options),
         .tracer = tracer,
         .count = rays.size()},
        std::as_bytes(rays), std::as_bytes(hits));
}

void TraceRecorder::addOccluded(uint tracer, std::span<const Ray> rays,
                                std::span<const uint> occluded, Coherence coherence,
                                const TraceOptions& options) {
    add({.kind = JobKind::kOccluded,
         .flags = flagsOf(coherence, options),
         .tracer = tracer,
         .count = rays.size()},
        std::as_bytes(rays), std::as_bytes(occluded));
}

void TraceRecorder::finish() {
    ChunkHeader end{.kind = JobKind::kEnd, .flags = is_cut_ ? trace_file::kCutFlag : 0u};
    const std::span<const std::byte> nothing[] = {{}};
    end.checksum = trace_file::checksum(end, nothing);
    write(std::as_bytes(std::span(&end, 1)));
    file_.close();
    if (has_failed_ || !file_)
        throw OutputError(path_ + ": the recording could not be written");
    std::error_code error;
    std::filesystem::rename(path_ + ".part", path_, error);
    if (error)
        throw OutputError(path_ +
                          ": cannot rename the finished recording to it: " + error.message());
    is_finished_ = true;
}

namespace {

class RecordBackend final : public TraceBackend {
public:
    RecordBackend(std::unique_ptr<TraceBackend> inner, TraceRecorder& recorder)
        : inner_(std::move(inner)), recorder_(recorder), number_(recorder.addTracer()) {}

    TraceCaps caps() const override { return inner_->caps(); }
    std::size_t copiedBytes() const override { return inner_->copiedBytes(); }

    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        scene_ = &scene;
        const BuildStats stats = inner_->build(scene, shared);
        recorder_.addBuild(number_, inner_->caps().name, scene);
        return stats;
    }

    BuildStats update(std::span<const uint> moved) override {
        const BuildStats stats = inner_->update(moved);
        std::vector<MovedInstance> places;
        for (const uint instance : moved)
            places.push_back({instance, scene_->instances[instance].to_world});
        recorder_.addUpdate(number_, places);
        return stats;
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        inner_->closest(rays, hits, coherence, options);
        recorder_.addClosest(number_, rays, hits, coherence, options);
    }

    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        inner_->occluded(rays, occluded, coherence, options);
        recorder_.addOccluded(number_, rays, occluded, coherence, options);
    }

private:
    std::unique_ptr<TraceBackend> inner_;
    TraceRecorder& recorder_;
    uint number_;
    const Scene* scene_ = nullptr;
};

} // namespace

std::unique_ptr<TraceBackend> makeRecordBackend(std::unique_ptr<TraceBackend> inner,
                                                TraceRecorder& recorder) {
    return std::make_unique<RecordBackend>(std::move(inner), recorder);
}

} // namespace hone
