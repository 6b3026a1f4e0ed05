// SPDX-License-Identifier: Apache-2.0
//
// hone_plugin.hpp: what it makes of classes, asked as hone asks it.
#include "hone/core/plugin/hone_plugin.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <vector>

namespace hone::test {
namespace {

using plugin::Border;
using plugin::Host;
using plugin::NoDevice;

constexpr plugin::About kAbout{
    .name = "test", .version = "1.0", .license = "MIT", .doc = "A test.", .flags = 0};

/// Bodies run one after another, in ranges of at most the grain.
void serialFor(const hone_host*, std::size_t count, std::size_t grain,
               void (*body)(void*, std::size_t, std::size_t), void* context) {
    for (std::size_t begin = 0; begin < count; begin += grain)
        body(context, begin, std::min(count, begin + grain));
}

hone_host makeHost() {
    hone_host host{};
    host.struct_size = sizeof host;
    host.parallel_for = serialFor;
    return host;
}

/// A tracer whose every function does what the test says.
struct Scripted {
    static inline std::function<void()> on_create, on_build, on_query;
    explicit Scripted(Host) {
        if (on_create)
            on_create();
    }
    void build(const hone_scene&) {
        if (on_build)
            on_build();
    }
    hone_hit closest(const hone_ray& ray) const {
        if (on_query)
            on_query();
        return {static_cast<std::uint32_t>(ray.origin[0]), 0};
    }
    bool occluded(const hone_ray& ray) const { return closest(ray).instance == 1; }
};

/// Takes lists, follows moves, counts what it built.
struct Listed {
    explicit Listed(Host) {}
    void build(const hone_scene&, hone_build_stats& stats) { stats.bytes = 99; }
    void update(const hone_scene&, std::span<const std::uint32_t> the_moved) {
        moved.assign(the_moved.begin(), the_moved.end());
    }
    void closest(std::span<const hone_ray> rays, std::span<hone_hit> hits, std::uint32_t flags) {
        for (std::size_t i = 0; i < rays.size(); ++i)
            hits[i] = {moved.empty() ? 0 : moved[0], flags};
    }
    void occluded(std::span<const hone_ray>, std::span<std::uint32_t> answers, std::uint32_t) {
        for (std::uint32_t& answer : answers)
            answer = 1;
    }
    std::vector<std::uint32_t> moved;
};

class CppLayer : public testing::Test {
protected:
    void TearDown() override {
        Scripted::on_create = Scripted::on_build = Scripted::on_query = nullptr;
    }

    /// The status of creating, building and asking a scripted tracer; its reason is in error_.
    hone_status use() {
        hone_tracer* tracer = nullptr;
        error_ = {};
        const hone_host host = makeHost();
        hone_status status = table_.create(&host, &tracer, &error_);
        if (status != HONE_OK)
            return status;
        const hone_scene scene{};
        hone_build_stats stats{};
        status = table_.build(tracer, &scene, &stats, &error_);
        const hone_ray ray{{1, 0, 0}, 0, {0, 0, 1}, 1};
        hone_hit hit{};
        if (status == HONE_OK)
            status = table_.closest(tracer, &ray, &hit, 1, 0, &error_);
        table_.destroy(tracer);
        return status;
    }

    const hone_trace_backend table_ = Border<Scripted>::table(kAbout);
    hone_error error_{};
};

TEST_F(CppLayer, SaysWhatTheClassIs) {
    EXPECT_STREQ(table_.name, "test");
    EXPECT_EQ(table_.flags, 0u);
    EXPECT_EQ(table_.update, nullptr);
    EXPECT_EQ(Border<Listed>::table(kAbout).flags, HONE_TRACE_UPDATES);
    EXPECT_NE(Border<Listed>::table(kAbout).update, nullptr);
    EXPECT_EQ(use(), HONE_OK);
}

TEST_F(CppLayer, TurnsExceptionsIntoStatusAndReason) {
    for (std::function<void()>* place :
         {&Scripted::on_create, &Scripted::on_build, &Scripted::on_query}) {
        *place = [] { throw std::runtime_error("of no use"); };
        EXPECT_EQ(use(), HONE_FAILED);
        EXPECT_STREQ(error_.text, "of no use");
        *place = [] { throw NoDevice("no card"); };
        EXPECT_EQ(use(), HONE_NO_DEVICE);
        EXPECT_STREQ(error_.text, "no card");
        *place = [] { throw std::bad_alloc(); };
        EXPECT_EQ(use(), HONE_OUT_OF_MEMORY);
        *place = [] { throw 5; };
        EXPECT_EQ(use(), HONE_FAILED);
        EXPECT_NE(error_.text[0], '\0');
        *place = nullptr;
    }
}

TEST_F(CppLayer, CutsALongReason) {
    Scripted::on_build = [] { throw std::runtime_error(std::string(5000, 'x')); };
    EXPECT_EQ(use(), HONE_FAILED);
    EXPECT_EQ(std::strlen(error_.text), sizeof error_.text - 1);
}

// 1000 rays are several ranges; a bad one gets its miss without a question.
TEST_F(CppLayer, AsksRayByRayAndOnlyWhatCanHit) {
    const hone_host host = makeHost();
    hone_tracer* tracer = nullptr;
    ASSERT_EQ(table_.create(&host, &tracer, &error_), HONE_OK);
    std::size_t asked = 0;
    Scripted::on_query = [&] { ++asked; };
    std::vector<hone_ray> rays(1000, {{1, 0, 0}, 0, {0, 0, 1}, 1});
    rays[10].direction[2] = 0;
    rays[11].origin[1] = std::numeric_limits<float>::quiet_NaN();
    rays[12].tmin = 2;
    rays[13].direction[0] = 2e18f;
    rays[14].tmax = -1;
    rays[15].tmax = std::numeric_limits<float>::quiet_NaN();
    std::vector<hone_hit> hits(rays.size());
    std::vector<std::uint32_t> occluded(rays.size(), 7);
    ASSERT_EQ(table_.closest(tracer, rays.data(), hits.data(), rays.size(), 0, &error_), HONE_OK);
    ASSERT_EQ(table_.occluded(tracer, rays.data(), occluded.data(), rays.size(), 0, &error_),
              HONE_OK);
    table_.destroy(tracer);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool is_bad = i >= 10 && i <= 15;
        EXPECT_EQ(hits[i].instance, is_bad ? HONE_NONE : 1u) << i;
        EXPECT_EQ(occluded[i], is_bad ? 0u : 1u) << i;
    }
    EXPECT_EQ(asked, 2u * 994u);
}

TEST_F(CppLayer, HandsListsAndMovesToAClassThatTakesThem) {
    const hone_trace_backend table = Border<Listed>::table(kAbout);
    const hone_host host = makeHost();
    hone_tracer* tracer = nullptr;
    ASSERT_EQ(table.create(&host, &tracer, &error_), HONE_OK);
    const hone_scene scene{};
    hone_build_stats stats{};
    EXPECT_EQ(table.build(tracer, &scene, &stats, &error_), HONE_OK);
    EXPECT_EQ(stats.bytes, 99u);
    const std::uint32_t moved[] = {3, 5};
    EXPECT_EQ(table.update(tracer, &scene, moved, 2, &stats, &error_), HONE_OK);
    const hone_ray ray{};
    hone_hit hit{};
    std::uint32_t occluded = 0;
    EXPECT_EQ(table.closest(tracer, &ray, &hit, 1, HONE_QUERY_EXACT, &error_), HONE_OK);
    EXPECT_EQ(table.occluded(tracer, &ray, &occluded, 1, 0, &error_), HONE_OK);
    table.destroy(tracer);
    EXPECT_EQ(hit.instance, 3u);
    EXPECT_EQ(hit.primitive, HONE_QUERY_EXACT);
    EXPECT_EQ(occluded, 1u);
}

} // namespace
} // namespace hone::test
