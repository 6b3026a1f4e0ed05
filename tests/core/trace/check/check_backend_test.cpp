// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/check_backend.h"

#include "hone/backends/brute/brute_backend.h"
#include "hone/core/error.h"
#include "hone/core/trace/null_backend.h"
#include "hone/tests/support/scene_builder.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace hone {
namespace {

using test::plainMaterial;
using test::SceneBuilder;

/// What a tracer that breaks its promises does to the answers of one that keeps them.
struct Faults {
    std::function<void(std::span<const Ray>, std::span<Hit>, Coherence, const TraceOptions&)>
        hits{};
    std::function<void(std::span<const Ray>, std::span<uint>)> occluded{};
    TraceCaps caps{.name = "faulty", .version = "1", .runs_on = "host", .always_exact = true};
};

class FaultyBackend final : public TraceBackend {
public:
    explicit FaultyBackend(Faults faults)
        : inner_(makeBruteBackend()), faults_(std::move(faults)) {}
    TraceCaps caps() const override { return faults_.caps; }
    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        return inner_->build(scene, shared);
    }
    BuildStats update(std::span<const uint> moved) override { return inner_->update(moved); }
    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        std::vector<Hit> answers(hits.begin(), hits.end());
        inner_->closest(rays, answers, coherence, options);
        const std::vector<Hit> unwritten(hits.begin(), hits.end());
        std::ranges::copy(answers, hits.begin());
        if (faults_.hits)
            faults_.hits(rays, hits, coherence, options);
        for (std::size_t i = 0; i < hits.size(); ++i)
            if (hits[i].instance == 777) // "forget to write"
                hits[i] = unwritten[i];
    }
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        inner_->occluded(rays, occluded, coherence, options);
        if (faults_.occluded)
            faults_.occluded(rays, occluded);
    }

private:
    std::unique_ptr<TraceBackend> inner_;
    Faults faults_;
};

/// A triangle at z = 0 over one at z = -1, twice over: x from 0 and from 5.
Scene scene(uint flags = 0) {
    SceneBuilder builder;
    const uint material = builder.addMaterial(plainMaterial(flags));
    for (const float x : {0.0f, 5.0f})
        for (const float z : {0.0f, -1.0f})
            builder.add(std::vector<vec3>{{x, 0, z}, {x + 1, 0, z}, {x, 1, z}},
                        std::vector<uvec3>{{0, 1, 2}}, material);
    return builder.finish();
}

std::vector<Ray> raysAt(const std::vector<vec2>& points) {
    std::vector<Ray> rays;
    for (const vec2 p : points)
        rays.push_back({{p.x, p.y, 1}, 0, {0, 0, -1}, 1e30f});
    return rays;
}

/// Checks one list of closest hits and one of occlusion; returns why the check failed, or "".
std::string check(TraceBackend& checked, const Scene& of, const std::vector<Ray>& rays) {
    try {
        checked.build(of);
        std::vector<Hit> hits(rays.size());
        checked.closest(rays, hits, Coherence::kIncoherent, {});
        std::vector<uint> occluded(rays.size());
        checked.occluded(rays, occluded, Coherence::kIncoherent, {});
        return "";
    } catch (const CheckFailed& problem) {
        return problem.what();
    }
}

std::string check(Faults faults, const std::vector<Ray>& rays, CheckReport* report = nullptr) {
    const Scene of = scene();
    return check(
        *makeCheckBackend(std::make_unique<FaultyBackend>(std::move(faults)), nullptr, report), of,
        rays);
}

std::string compare(Faults faults, const std::vector<Ray>& rays, CheckReport* report = nullptr) {
    const Scene of = scene();
    return check(*makeCheckBackend(makeBruteBackend(),
                                   std::make_unique<FaultyBackend>(std::move(faults)), report),
                 of, rays);
}

const std::vector<Ray> kSome = raysAt({{0.25f, 0.25f}, {0.75f, 0.75f}, {5.25f, 0.25f}});

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(CheckBackend, AnswersAsTheCheckedOneAndCounts) {
    const Scene of = scene();
    CheckReport report;
    const auto checked = makeCheckBackend(makeBruteBackend(), nullptr, &report);
    EXPECT_EQ(checked->caps().name, "check(brute)");
    checked->build(of);
    std::vector<Hit> hits(3);
    checked->closest(kSome, hits, Coherence::kCoherent, {});
    EXPECT_EQ(hits[0].instance, 0u);
    EXPECT_EQ(hits[1].instance, kNone);
    EXPECT_EQ(hits[2].instance, 2u);
    std::vector<uint> occluded(3);
    checked->occluded(kSome, occluded, Coherence::kCoherent, {});
    EXPECT_EQ(occluded, (std::vector<uint>{1, 0, 1}));
    EXPECT_EQ(report.closest.lists, 1u);
    EXPECT_EQ(report.closest.rays, 3u);
    EXPECT_EQ(report.closest.judged, 3u);
    EXPECT_EQ(report.occluded.rays, 3u);
    EXPECT_EQ(report.closest.differing, 0u);
}

TEST(CheckBackend, FindsNothingInEqualBackends) {
    const Scene of = scene();
    CheckReport report;
    const auto checked = makeCheckBackend(makeBruteBackend(), makeBruteBackend(), &report);
    EXPECT_EQ(checked->caps().name, "check(brute,brute)");
    EXPECT_EQ(check(*checked, of, kSome), "");
    EXPECT_EQ(check(*checked, of, {}), "") << "an empty list";
    EXPECT_EQ(report.closest.differing, 0u);
}

TEST(CheckBackend, NamesTheRayBothAnswersAndWhoIsWrong) {
    CheckReport report;
    const std::string message = compare({.hits =
                                             [](auto, std::span<Hit> hits, auto, auto) {
                                                 for (Hit& hit : hits)
                                                     hit = hit.instance == 2 ? Hit{3, 0} : hit;
                                             }},
                                        kSome, &report);
    EXPECT_TRUE(contains(message, "check(brute,faulty): closest hit 2 of 3, scene \"test\""))
        << message;
    EXPECT_TRUE(contains(message, "brute: instance 2 \"instance 2\", primitive 0 at t = 1\n"));
    EXPECT_TRUE(
        contains(message, "faulty: instance 3 \"instance 3\", primitive 0 at t = 2  <- wrong"));
    EXPECT_TRUE(contains(message, "origin (5.25, 0.25, 1), direction (0, 0, -1), tmin 0"));
    EXPECT_EQ(report.closest.differing, 1u);
    EXPECT_EQ(report.closest.unexplained, 1u);
}

TEST(CheckBackend, NamesAWrongOcclusion) {
    const std::string message =
        compare({.occluded = [](auto, std::span<uint> occluded) { occluded[0] = 0; }}, kSome);
    EXPECT_TRUE(contains(message, "occlusion 0 of 3")) << message;
    EXPECT_TRUE(contains(message, "brute: occluded\n"));
    EXPECT_TRUE(contains(message, "faulty: free  <- wrong"));
}

TEST(CheckBackend, ForgivesAndCountsWhatRoundingExplains) {
    // On the outline of the upper triangle, where the lower one is seen as well.
    CheckReport report;
    const auto miss_the_edge = [](auto, std::span<Hit> hits, auto, auto) { hits[0] = Hit{1, 0}; };
    EXPECT_EQ(compare({.hits = miss_the_edge}, raysAt({{0.5f, 1e-8f}}), &report), "");
    EXPECT_EQ(report.closest.differing, 1u);
    EXPECT_EQ(report.closest.silhouettes, 1u);
    EXPECT_EQ(report.closest.unexplained, 0u);
}

TEST(CheckBackend, FindsAWrongAnswerWithoutASecondOpinion) {
    const std::string message = check({.hits =
                                           [](auto, std::span<Hit> hits, auto, auto) {
                                               for (Hit& hit : hits)
                                                   hit = hit.instance == 0 ? Hit{1, 0} : hit;
                                           }},
                                      kSome);
    EXPECT_TRUE(contains(message, "\"faulty\" is wrong: it answers instance 1")) << message;
    EXPECT_TRUE(contains(message, "the ray surely meets instance 0"));
}

TEST(CheckBackend, FindsAnswersThatWereNotWritten) {
    const std::string message = check({.hits =
                                           [](auto, std::span<Hit> hits, auto, auto) {
                                               hits[1] = Hit{777, 0};
                                           }},
                                      kSome);
    EXPECT_TRUE(contains(message, "closest hit 1 of 3")) << message;
    EXPECT_TRUE(contains(message, "left its answer unwritten"));
}

TEST(CheckBackend, FindsAnswersThatNameNothing) {
    for (const Hit wrong : {Hit{4, 0}, Hit{0, 1}, Hit{0, kNone}, Hit{kNone, 0}})
        EXPECT_TRUE(contains(
            check({.hits = [&](auto, std::span<Hit> hits, auto, auto) { hits[0] = wrong; }}, kSome),
            "answers what is not there"));
    EXPECT_TRUE(contains(
        check({.occluded = [](auto, std::span<uint> occluded) { occluded[2] = 2; }}, kSome),
        "answers what is not there: 2"));
}

TEST(CheckBackend, FindsAnswersThatDependOnCoherenceOrCompany) {
    const std::vector<Ray> outline = raysAt({{0.5f, 1e-8f}}); // both answers are right
    const auto by_coherence = [](auto, std::span<Hit> hits, Coherence coherence, auto) {
        hits[0] = Hit{coherence == Coherence::kCoherent ? 1u : 0u, 0};
    };
    EXPECT_TRUE(contains(check({.hits = by_coherence}, outline), "in an incoherent list"));
    const auto by_exactness = [](auto, std::span<Hit> hits, auto, const TraceOptions& options) {
        hits[0] = Hit{options.exact ? 1u : 0u, 0};
    };
    EXPECT_TRUE(contains(check({.hits = by_exactness}, outline), "in other company"));
    Faults honest{.hits = by_exactness};
    honest.caps.always_exact = false;
    EXPECT_EQ(check(honest, outline), "");
}

TEST(CheckBackend, FindsMasksThatCapsDoNotPromise) {
    Faults faults;
    faults.caps.masked = false;
    const Scene masked = scene(kMaterialMasked);
    const auto checked =
        makeCheckBackend(makeBruteBackend(), std::make_unique<FaultyBackend>(faults), nullptr);
    EXPECT_TRUE(contains(check(*checked, masked, kSome), "masked materials, which \"faulty\""));
    EXPECT_EQ(check(*checked, scene(), kSome), "");
}

TEST(CheckBackend, FindsListsOfUnequalLengthAndQueriesWithoutAScene) {
    const auto checked = makeCheckBackend(makeBruteBackend(), nullptr, nullptr);
    std::vector<Hit> hits(2);
    EXPECT_THROW(checked->closest(kSome, hits, Coherence::kCoherent, {}), CheckFailed);
    hits.resize(3);
    EXPECT_THROW(checked->closest(kSome, hits, Coherence::kCoherent, {}), CheckFailed);
    EXPECT_THROW(checked->update({}), CheckFailed);
}

TEST(CheckBackend, FollowsMovedInstancesAndFindsUnannouncedOnes) {
    Scene of = scene();
    const auto checked = makeCheckBackend(makeBruteBackend(), makeBruteBackend(), nullptr);
    checked->build(of);
    mat4x3 aside(1);
    aside[3] = vec3(20, 0, 0);
    moveInstance(of, 0, aside);
    std::vector<Hit> hits(3);
    EXPECT_THROW(checked->closest(kSome, hits, Coherence::kCoherent, {}), CheckFailed);
    const uint moved[] = {0};
    checked->update(moved);
    checked->closest(kSome, hits, Coherence::kCoherent, {});
    EXPECT_EQ(hits[0].instance, 1u);
    const uint wrong[] = {0, 0};
    EXPECT_THROW(checked->update(wrong), CheckFailed);
    const uint absent[] = {4};
    EXPECT_THROW(checked->update(absent), CheckFailed);
}

TEST(CheckBackend, CountsRaysThatAreNotFinite) {
    std::vector<Ray> rays = kSome;
    rays[0].direction.x = std::numeric_limits<float>::quiet_NaN();
    rays[1].origin.y = std::numeric_limits<float>::infinity();
    rays[2].tmax = std::numeric_limits<float>::infinity();
    CheckReport report;
    EXPECT_EQ(check(Faults{}, rays, &report), "");
    EXPECT_EQ(report.spoiled_rays, 4u); // of closest hits and of occlusion
}

TEST(NullBackend, SeesNothing) {
    const auto null = makeNullBackend();
    null->build(scene());
    std::vector<Hit> hits(3);
    null->closest(kSome, hits, Coherence::kCoherent, {});
    for (const Hit& hit : hits)
        EXPECT_TRUE(hit.instance == kNone && hit.primitive == kNone);
    std::vector<uint> occluded(3, 7);
    null->occluded(kSome, occluded, Coherence::kCoherent, {});
    EXPECT_EQ(occluded, (std::vector<uint>{0, 0, 0}));
}

TEST(NullBackend, FailsACheck) {
    const Scene of = scene();
    const auto checked = makeCheckBackend(makeNullBackend(), nullptr, nullptr);
    EXPECT_TRUE(contains(check(*checked, of, kSome), "\"null\" is wrong: it answers nothing"));
}

} // namespace
} // namespace hone
