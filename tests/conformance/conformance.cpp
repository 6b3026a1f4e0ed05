// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance.h"

#include "hone/core/error.h"

#include <algorithm>
#include <ostream>

namespace hone {

void PrintTo(const Hit& hit, std::ostream* out) {
    if (hit.instance == kNone)
        *out << "miss";
    else
        *out << "instance " << hit.instance << " primitive " << hit.primitive;
}

} // namespace hone

namespace hone::test {
namespace {

std::vector<TracerUnderTest>& tracers() {
    static std::vector<TracerUnderTest> list;
    return list;
}

} // namespace

void PrintTo(const TracerUnderTest& tracer, std::ostream* out) {
    *out << tracer.name;
}

void addTracer(TracerUnderTest tracer) {
    tracers().push_back(std::move(tracer));
}

void TracerConformance::SetUp() {
    try {
        tracer_ = GetParam().make();
    } catch (const DeviceError& problem) {
        GTEST_SKIP() << problem.what();
    }
}

void TracerConformance::build(Scene scene) {
    scene_ = std::move(scene);
    tracer_->build(scene_);
}

void TracerConformance::move(uint instance, const mat4x3& place) {
    moveInstance(scene_, instance, place);
    tracer_->update({&instance, 1});
}

std::vector<Hit> TracerConformance::closestOf(std::span<const Ray> rays, const Mode& mode) const {
    std::vector<Hit> hits(rays.size(), Hit{12345, 67890}); // which no test expects
    tracer_->closest(rays, hits, mode.coherence, mode.options);
    return hits;
}

std::vector<uint> TracerConformance::occludedOf(std::span<const Ray> rays, const Mode& mode) const {
    std::vector<uint> occluded(rays.size(), 12345u);
    tracer_->occluded(rays, occluded, mode.coherence, mode.options);
    return occluded;
}

std::vector<Hit> TracerConformance::closestInAllModes(const Ray& ray) const {
    std::vector<Hit> hits;
    for (const Mode& mode : kModes)
        hits.push_back(closestOf({&ray, 1}, mode).front());
    return hits;
}

Hit TracerConformance::closest(const Ray& ray) const {
    const std::vector<Hit> hits = closestInAllModes(ray);
    for (const Hit& hit : hits)
        EXPECT_EQ(hit, hits.front()) << "the answer depends on coherence or exactness";
    return hits.front();
}

bool TracerConformance::occluded(const Ray& ray) const {
    std::vector<uint> answers;
    for (const Mode& mode : kModes)
        answers.push_back(occludedOf({&ray, 1}, mode).front());
    for (const uint answer : answers)
        EXPECT_EQ(answer, answers.front()) << "the answer depends on coherence or exactness";
    EXPECT_LE(answers.front(), 1u);
    return answers.front() == 1;
}

// A program may link the suite and run it only when asked to.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(TracerConformance);
INSTANTIATE_TEST_SUITE_P(All, TracerConformance, testing::ValuesIn(tracers()),
                         [](const testing::TestParamInfo<TracerUnderTest>& tested) {
                             return tested.param.name;
                         });

} // namespace hone::test
