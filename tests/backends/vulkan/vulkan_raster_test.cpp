// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/vulkan_fixture.h"

#include "hone/core/error.h"

#include "hone_spirv/triangles_frag.h"
#include "hone_spirv/triangles_vert.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace hone {
namespace {

constexpr uint kNone = ~0u;

/// Draws triangles given in pixels into an image of kRg32Uint (label of the instance, primitive)
/// and a depth image, and reads both back.
class VulkanRaster : public VulkanTest {
protected:
    void SetUp() override {
        VulkanTest::SetUp();
        if (IsSkipped())
            return;
        pipeline_ = device().createRasterPipeline({.name = "triangles",
                                                   .vertex_spirv = spirv::triangles_vert,
                                                   .fragment_spirv = spirv::triangles_frag,
                                                   .has_color = true});
        labels_ = device().createBuffer(16 * sizeof(uint), "labels");
        std::iota(labels_.as<uint>().begin(), labels_.as<uint>().end(), 100u);
        resize({8, 8});
    }

    void TearDown() override {
        if (!IsSkipped()) {
            device().destroy(pipeline_);
            device().destroy(target_.color);
            device().destroy(target_.depth);
            labels_ = {};
            vertices_ = {};
            indices_ = {};
            draws_ = {};
            hits_ = {};
            depths_ = {};
        }
        VulkanTest::TearDown();
    }

    void resize(uvec2 extent) {
        device().destroy(target_.color);
        device().destroy(target_.depth);
        target_ = {};
        target_.extent = extent;
        target_.color = device().createImage({extent, ImageFormat::kRg32Uint, "hits"});
        target_.depth = device().createImage({extent, ImageFormat::kDepth32, "depth"});
        hits_ = device().createBuffer(sizeof(uvec2) * extent.x * extent.y, "hits");
        depths_ = device().createBuffer(sizeof(float) * extent.x * extent.y, "depths");
    }

    /// Corners in pixels (x right, y down) and depth (1 near, 0 far).
    void setCorners(const std::vector<vec3>& corners) {
        vertices_ = device().createBuffer(corners.size() * sizeof(vec3), "vertices");
        indices_ = device().createBuffer(corners.size() * sizeof(uint), "indices");
        for (std::size_t i = 0; i < corners.size(); ++i)
            vertices_.as<vec3>()[i] = vec3(
                2.0f * corners[i].x / static_cast<float>(target_.extent.x) - 1.0f,
                2.0f * corners[i].y / static_cast<float>(target_.extent.y) - 1.0f, corners[i].z);
        std::iota(indices_.as<uint>().begin(), indices_.as<uint>().end(), 0u);
        setDraws({{.index_count = static_cast<uint>(corners.size())}});
    }

    void setDraws(const std::vector<DrawIndexed>& draws) {
        draws_ = device().createBuffer(draws.size() * sizeof(DrawIndexed), "draws");
        std::ranges::copy(draws, draws_.as<DrawIndexed>().begin());
    }

    /// One raster, `move` in clip space.
    void draw(CullMode cull = CullMode::kNone, vec2 move = vec2(0)) {
        Arguments arguments;
        arguments.bind("positions", vertices_.view());
        arguments.bind("labels", labels_.view());
        encoder().beginScope("triangles");
        encoder().beginRaster(target_);
        encoder().drawIndexed(pipeline_, cull, arguments, std::as_bytes(std::span(&move, 1)),
                              indices_.view(), draws_.view());
        encoder().endRaster();
        encoder().copyImage(target_.color, hits_.view());
        encoder().copyImage(target_.depth, depths_.view());
        encoder().endScope();
        encoder().finish();
    }

    [[nodiscard]] uvec2 hit(uint x, uint y) const {
        return hits_.as<uvec2>()[y * target_.extent.x + x];
    }
    [[nodiscard]] float depth(uint x, uint y) const {
        return depths_.as<float>()[y * target_.extent.x + x];
    }
    [[nodiscard]] std::ptrdiff_t covered() const {
        return std::ranges::count_if(hits_.as<uvec2>(),
                                     [](uvec2 pixel) { return pixel.x != kNone; });
    }

    RasterTarget target_;
    PipelineHandle pipeline_ = PipelineHandle::kNone;
    Buffer labels_, vertices_, indices_, draws_, hits_, depths_;
};

/// A rectangle of pixels as two triangles that turn counter-clockwise in the picture.
std::vector<vec3> rectangle(float left, float top, float right, float bottom, float depth) {
    return {{left, top, depth},     {left, bottom, depth}, {right, bottom, depth},
            {right, bottom, depth}, {right, top, depth},   {left, top, depth}};
}

std::vector<vec3> operator+(std::vector<vec3> first, const std::vector<vec3>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

TEST_F(VulkanRaster, OneLargeTriangleCoversEveryPixel) {
    setCorners({{0, 0, 0.5f}, {0, 16, 0.5f}, {16, 0, 0.5f}});
    draw();
    EXPECT_EQ(covered(), 64);
    EXPECT_EQ(hit(7, 7), uvec2(100, 0));
    EXPECT_TRUE(std::ranges::all_of(depths_.as<float>(), [](float z) { return z == 0.5f; }));
}

TEST_F(VulkanRaster, ClearsToNoHitInfinitelyFar) {
    setCorners({{0, 0, 0.5f}, {0, 0, 0.5f}, {0, 0, 0.5f}});
    draw();
    EXPECT_EQ(covered(), 0);
    EXPECT_EQ(hit(3, 3), uvec2(kNone, kNone));
    EXPECT_TRUE(std::ranges::all_of(depths_.as<float>(), [](float z) { return z == 0.0f; }));
}

// Of the 64 pixel centres, 8 lie exactly on the diagonal from (8,0) to (0,8). It is the lower right
// side of the first triangle, which does not own it, and the left side of the second, which does:
// (64 - 8) / 2 = 28 and 28 + 8 = 36.
TEST_F(VulkanRaster, GivesCentresOnAnEdgeToTheTriangleOnItsRight) {
    setCorners({{0, 0, 0.5f}, {0, 8, 0.5f}, {8, 0, 0.5f}});
    draw();
    EXPECT_EQ(covered(), 28);
    EXPECT_NE(hit(6, 0).x, kNone);
    EXPECT_EQ(hit(7, 0).x, kNone);

    setCorners({{8, 0, 0.5f}, {0, 8, 0.5f}, {8, 8, 0.5f}});
    draw();
    EXPECT_EQ(covered(), 36);
    EXPECT_NE(hit(7, 0).x, kNone);
}

TEST_F(VulkanRaster, ShowsTheGreatestDepthWhateverTheOrder) {
    setCorners(rectangle(0, 0, 8, 8, 0.25f) + rectangle(0, 0, 8, 8, 0.75f) +
               rectangle(0, 0, 8, 8, 0.5f));
    draw();
    // Primitives 2 and 3 are the middle rectangle's: 2 left below the diagonal, 3 right above it.
    EXPECT_EQ(hit(0, 7), uvec2(100, 2));
    EXPECT_EQ(hit(7, 0), uvec2(100, 3));
    EXPECT_EQ(depth(4, 4), 0.75f);
}

TEST_F(VulkanRaster, ShowsTheFirstOfEqualDepths) {
    setCorners(rectangle(0, 0, 8, 8, 0.5f) + rectangle(0, 0, 8, 8, 0.5f));
    draw();
    EXPECT_EQ(hit(0, 7), uvec2(100, 0));
    EXPECT_EQ(hit(7, 0), uvec2(100, 1));
}

// Row 0 is on top: down, then right, turns counter-clockwise for who looks at the picture.
TEST_F(VulkanRaster, CullsWhatTurnsClockwiseInThePicture) {
    const vec3 a(0, 0, 0.5f), b(0, 8, 0.5f), c(8, 8, 0.5f);
    setCorners({a, b, c});
    draw(CullMode::kBack);
    const std::ptrdiff_t counter_clockwise = covered();
    EXPECT_GT(counter_clockwise, 0);

    setCorners({a, c, b});
    draw(CullMode::kBack);
    EXPECT_EQ(covered(), 0);
    draw(CullMode::kNone);
    EXPECT_EQ(covered(), counter_clockwise);
}

TEST_F(VulkanRaster, NumbersInstancesFromTheDrawsFirstInstance) {
    setCorners(rectangle(0, 0, 8, 8, 0.5f));
    setDraws({{.index_count = 6, .first_instance = 5}});
    draw();
    EXPECT_EQ(hit(4, 4).x, 105u);
}

TEST_F(VulkanRaster, DrawsEveryEntryAndCountsPrimitivesAnewInEach) {
    setCorners(rectangle(0, 0, 4, 4, 0.5f) + rectangle(4, 0, 8, 4, 0.5f) +
               rectangle(0, 4, 4, 8, 0.5f) + rectangle(4, 4, 8, 8, 0.5f));
    setDraws({{.index_count = 6, .first_instance = 1},
              {.index_count = 0, .first_instance = 9},
              {.index_count = 6, .first_index = 6, .first_instance = 2},
              {.index_count = 6, .vertex_offset = 12, .first_instance = 3},
              {.index_count = 6, .instance_count = 0, .first_index = 18, .first_instance = 4}});
    draw();
    EXPECT_EQ(hit(0, 3), uvec2(101, 0));
    EXPECT_EQ(hit(3, 0), uvec2(101, 1));
    EXPECT_EQ(hit(4, 3), uvec2(102, 0));
    EXPECT_EQ(hit(0, 7), uvec2(103, 0));
    EXPECT_EQ(hit(7, 7).x, kNone) << "an entry of no instances draws nothing";
    EXPECT_EQ(covered(), 48);
}

TEST_F(VulkanRaster, PassesParametersToTheShaders) {
    setCorners(rectangle(0, 0, 8, 8, 0.5f));
    draw(CullMode::kNone, vec2(0.5f, 0)); // a quarter of the width to the right
    EXPECT_EQ(covered(), 48);
    EXPECT_EQ(hit(1, 4).x, kNone);
    EXPECT_NE(hit(2, 4).x, kNone);
}

TEST_F(VulkanRaster, CopiesRowsTightlyTopRowFirst) {
    resize({5, 3});
    setCorners(rectangle(3, 1, 4, 2, 0.5f));
    draw();
    for (uint i = 0; i < 15; ++i) {
        EXPECT_EQ(hits_.as<uvec2>()[i].x, i == 8 ? 100u : kNone) << i;
        EXPECT_EQ(depths_.as<float>()[i], i == 8 ? 0.5f : 0.0f) << i;
    }
}

TEST_F(VulkanRaster, DrawsDepthAlone) {
    const PipelineHandle depth_only = device().createRasterPipeline(
        {.name = "depth only", .vertex_spirv = spirv::triangles_vert, .fragment_spirv = {}});
    setCorners(rectangle(0, 0, 4, 8, 0.25f));
    Arguments arguments;
    arguments.bind("positions", vertices_.view());
    const vec2 move(0);
    RasterTarget target = target_;
    target.color = ImageHandle::kNone;
    encoder().beginRaster(target);
    encoder().drawIndexed(depth_only, CullMode::kBack, arguments,
                          std::as_bytes(std::span(&move, 1)), indices_.view(), draws_.view());
    encoder().endRaster();
    encoder().copyImage(target.depth, depths_.view());
    device().destroy(depth_only); // what is recorded may still use it
    encoder().finish();
    EXPECT_EQ(depth(3, 7), 0.25f);
    EXPECT_EQ(depth(4, 7), 0.0f);
}

TEST_F(VulkanRaster, TakesDrawsThatEarlierWorkWrote) {
    setCorners(rectangle(0, 0, 8, 8, 0.5f));
    const Buffer source = std::move(draws_);
    setDraws({DrawIndexed{}});
    encoder().copy(source.view(), draws_.view());
    draw();
    EXPECT_EQ(covered(), 64);
}

TEST_F(VulkanRaster, DrawsIntoTheSameTargetAgain) {
    setCorners(rectangle(0, 0, 8, 8, 0.75f));
    draw();
    setCorners(rectangle(0, 0, 4, 4, 0.25f));
    draw();
    EXPECT_EQ(covered(), 16) << "the target is cleared each time";
    EXPECT_EQ(depth(0, 0), 0.25f);
}

TEST_F(VulkanRaster, RefusesImagesLargerThanTheDeviceOffers) {
    try {
        static_cast<void>(
            device().createImage({uvec2(1u << 30, 1), ImageFormat::kDepth32, "wide"}));
        FAIL() << "no device has such images";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("wide"), std::string::npos) << error.what();
    }
}

TEST_F(VulkanRaster, RefusesOperationsWithinARaster) {
    encoder().beginRaster(target_);
    EXPECT_THROW(encoder().fill(hits_.view(), 0), std::logic_error);
    EXPECT_THROW(encoder().finish(), std::logic_error);
    encoder().endRaster();
    encoder().finish();
}

} // namespace
} // namespace hone
