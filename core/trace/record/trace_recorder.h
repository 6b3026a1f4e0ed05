// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/trace/record/trace_recording.h"

#include <fstream>
#include <memory>
#include <string>

namespace hone {

/// Writes what trace backends are asked and answer to a file, for readTraceRecording().
///
/// The file has another name (path + ".part") until finish(). A run is worth more than its
/// recording: past the limit, and when the disk is full, recording stops and the run goes on.
class TraceRecorder {
public:
    /// `limit`: bytes that the file may have. Throws OutputError if the file cannot be made.
    TraceRecorder(std::string path, std::uint64_t limit);
    TraceRecorder(const TraceRecorder&) = delete;
    TraceRecorder& operator=(const TraceRecorder&) = delete;
    /// Finishes the file, unless that was done: the recording of a run that failed is kept.
    ~TraceRecorder();

    /// The number of a backend that is to be recorded.
    [[nodiscard]] uint addTracer() { return tracers_++; }
    /// Lists of a job are written as they are; see RecordedJob.
    void addBuild(uint tracer, const std::string& backend, const Scene& scene);
    void addUpdate(uint tracer, std::span<const MovedInstance> moved);
    void addClosest(uint tracer, std::span<const Ray> rays, std::span<const Hit> hits,
                    Coherence coherence, const TraceOptions& options);
    void addOccluded(uint tracer, std::span<const Ray> rays, std::span<const uint> occluded,
                     Coherence coherence, const TraceOptions& options);

    /// Ends the file and gives it its name. Throws OutputError if anything could not be written.
    void finish();

    [[nodiscard]] bool isCut() const { return is_cut_; }
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

private:
    void add(trace_file::ChunkHeader header, std::span<const std::byte> first,
             std::span<const std::byte> second);
    void write(std::span<const std::byte> bytes);

    std::string path_;
    std::ofstream file_;
    std::uint64_t limit_;
    std::uint64_t bytes_ = 0;
    uint tracers_ = 0;
    bool is_cut_ = false;
    bool has_failed_ = false;
    bool is_finished_ = false;
};

/// A backend that answers as `inner` does and records it. `recorder` must outlive it.
[[nodiscard]] std::unique_ptr<TraceBackend> makeRecordBackend(std::unique_ptr<TraceBackend> inner,
                                                              TraceRecorder& recorder);

} // namespace hone
