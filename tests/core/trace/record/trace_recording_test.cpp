// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/record/trace_recording.h"

#include "hone/backends/brute/brute_backend.h"
#include "hone/core/error.h"
#include "hone/core/trace/record/trace_recorder.h"
#include "hone/tests/support/scene_builder.h"
#include "hone/tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace hone {
namespace {

/// One triangle at z = 0.
Scene oneTriangle() {
    test::SceneBuilder builder;
    builder.add(std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<uvec3>{{0, 1, 2}},
                builder.addMaterial(test::plainMaterial()));
    return builder.finish();
}

const std::vector<Ray> kRays{{{0.25f, 0.25f, 1}, 0, {0, 0, -1}, 1e30f},
                             {{2, 2, 1}, 0.5f, {0, 0, -1}, 7}};

/// Builds, asks both kinds, moves the triangle away, asks again, and asks nothing.
void recordSome(const std::string& path, std::uint64_t limit = 1 << 20) {
    Scene scene = oneTriangle();
    TraceRecorder recorder(path, limit);
    const auto backend = makeRecordBackend(makeBruteBackend(), recorder);
    backend->build(scene);
    std::vector<Hit> hits(2);
    std::vector<uint> occluded(2);
    backend->closest(kRays, hits, Coherence::kCoherent, {});
    backend->occluded(kRays, occluded, Coherence::kIncoherent, {.exact = true});
    mat4x3 aside(1);
    aside[3] = vec3(2, 2, 0);
    moveInstance(scene, 0, aside);
    const uint moved[] = {0};
    backend->update(moved);
    backend->closest(kRays, hits, Coherence::kIncoherent, {});
    backend->closest({}, {}, Coherence::kIncoherent, {});
    recorder.finish();
}

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(TraceRecording, ReadsWhatWasRecorded) {
    const test::TemporaryFolder folder;
    recordSome(folder.path("rays"));
    const TraceRecording recording = readTraceRecording(folder.path("rays"));
    EXPECT_FALSE(recording.is_cut);
    ASSERT_EQ(recording.jobs.size(), 6u);
    EXPECT_EQ(recording.jobs[0].kind, JobKind::kBuild);
    EXPECT_EQ(recording.jobs[0].backend, "brute");
    EXPECT_EQ(recording.jobs[0].scene, "test");
    EXPECT_EQ(recording.jobs[0].scene_hash, traceHash(oneTriangle()));
    const RecordedJob& closest = recording.jobs[1];
    EXPECT_EQ(closest.kind, JobKind::kClosest);
    EXPECT_EQ(closest.coherence, Coherence::kCoherent);
    EXPECT_FALSE(closest.options.exact);
    ASSERT_EQ(closest.rays.size(), 2u);
    EXPECT_EQ(closest.rays[1].tmin, 0.5f);
    EXPECT_EQ(closest.rays[1].tmax, 7.0f);
    EXPECT_EQ(closest.hits[0].instance, 0u);
    EXPECT_EQ(closest.hits[1].instance, kNone);
    EXPECT_EQ(recording.jobs[2].kind, JobKind::kOccluded);
    EXPECT_TRUE(recording.jobs[2].options.exact);
    EXPECT_EQ(recording.jobs[2].occluded, (std::vector<uint>{1, 0}));
    ASSERT_EQ(recording.jobs[3].moved.size(), 1u);
    EXPECT_EQ(recording.jobs[3].moved[0].to_world[3], vec3(2, 2, 0));
    EXPECT_EQ(recording.jobs[4].hits[0].instance, kNone);
    EXPECT_TRUE(recording.jobs[5].rays.empty());
}

TEST(TraceRecording, RefusesEveryTruncation) {
    const test::TemporaryFolder folder;
    recordSome(folder.path("rays"));
    const std::string whole = bytesOf(folder.path("rays"));
    ASSERT_GT(whole.size(), 400u);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_THROW(std::ignore = readTraceRecording(folder.write("cut", whole.substr(0, length))),
                     InputError)
            << length << " bytes";
    EXPECT_THROW(std::ignore = readTraceRecording(folder.write("more", whole + "x")), InputError);
}

// Whatever bit is wrong: in a size, which would ask for exabytes, in a ray, in a checksum.
TEST(TraceRecording, RefusesEveryChangedByte) {
    const test::TemporaryFolder folder;
    recordSome(folder.path("rays"));
    const std::string whole = bytesOf(folder.path("rays"));
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string changed = whole;
        changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 0x80 : 0x01));
        EXPECT_THROW(std::ignore = readTraceRecording(folder.write("changed", changed)), InputError)
            << "byte " << i;
    }
}

TEST(TraceRecording, SaysWhatIsWrongWithAFile) {
    const test::TemporaryFolder folder;
    const auto complaint = [&](const std::string& path) -> std::string {
        try {
            std::ignore = readTraceRecording(path);
            return "";
        } catch (const InputError& problem) {
            return problem.what();
        }
    };
    EXPECT_NE(complaint(folder.path("absent")).find("cannot read"), std::string::npos);
    EXPECT_NE(complaint(folder.path()).find("cannot read"), std::string::npos);
    EXPECT_NE(complaint(folder.write("text", std::string(99, 'x'))).find("no recording"),
              std::string::npos);
    recordSome(folder.path("rays"));
    std::string other = bytesOf(folder.path("rays"));
    other[8] = 9;
    EXPECT_NE(complaint(folder.write("other", other)).find("format 9, expected 1"),
              std::string::npos);
}

TEST(TraceRecorder, StopsAtItsLimitAndLosesNothingBefore) {
    const test::TemporaryFolder folder;
    recordSome(folder.path("rays"), 400);
    const TraceRecording recording = readTraceRecording(folder.path("rays"));
    EXPECT_TRUE(recording.is_cut);
    EXPECT_GE(recording.jobs.size(), 2u);
    EXPECT_LT(recording.jobs.size(), 6u);
    EXPECT_LE(std::filesystem::file_size(folder.path("rays")), 400u);
}

TEST(TraceRecorder, KeepsWhatARunThatFailedAsked) {
    const test::TemporaryFolder folder;
    const Scene scene = oneTriangle();
    {
        TraceRecorder recorder(folder.path("rays"), 1 << 20);
        const auto backend = makeRecordBackend(makeBruteBackend(), recorder);
        backend->build(scene);
    }
    EXPECT_EQ(readTraceRecording(folder.path("rays")).jobs.size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder.path("rays.part")));
}

TEST(TraceRecorder, RefusesAPathThatIsNoFile) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(TraceRecorder(folder.path(), 1000), OutputError);
    EXPECT_THROW(TraceRecorder(folder.path("absent/rays"), 1000), OutputError);
}

TEST(TraceRecorder, TellsScenesApart) {
    Scene scene = oneTriangle();
    const std::uint64_t hash = traceHash(scene);
    EXPECT_EQ(traceHash(oneTriangle()), hash);
    scene.positions[1].x += 1e-6f;
    EXPECT_NE(traceHash(scene), hash);
}

} // namespace
} // namespace hone
