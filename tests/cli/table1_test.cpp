// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/cli/table1.h"
#include "hone/core/error.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <sstream>

namespace hone::cli {
namespace {

Table1Row row(double ratio) {
    Table1Row result;
    result.size = {1920, 1080};
    result.view.wanted_share = 0.05;
    result.f_c = 0.1;
    result.raster_share = 0.2;
    result.ratio = ratio;
    return result;
}

TEST(Table1, HoldsARatioToItsRaysItsRasterImageAndATwentieth) {
    EXPECT_NEAR(row(0).limit(), 0.35, 1e-12);
    Table1 table{{row(0.34)}};
    EXPECT_TRUE(table.allMet());
    table.rows.push_back(row(0.36));
    EXPECT_FALSE(table.allMet());
    std::ostringstream text;
    table.print(text);
    EXPECT_NE(text.str().find("missed"), std::string::npos);
}

// 1920 x 1080 at 7 %: 639 and 243 ms.
TEST(Table1, PutsThePapersRatioBesideItsSizesAndOneSample) {
    EXPECT_NEAR(row(0).paperRatio().value(), 0.380, 0.0005);
    Table1Row other = row(0);
    other.samples = 16;
    EXPECT_FALSE(other.paperRatio());
    other = row(0);
    other.size = {640, 480};
    EXPECT_FALSE(other.paperRatio());
}

TEST(Table1, SaysInJsonWhatTheCommandPromises) {
    const nlohmann::json json = Table1{{row(0.3)}}.json();
    for (const char* key : {"size", "samples", "camera", "error_share", "f_c", "raster_share",
                            "prt_ms", "sir_ms", "ratio", "limit", "paper_ratio"})
        EXPECT_TRUE(json["rows"][0].contains(key)) << key;
    EXPECT_EQ(json["rows"][0]["size"], "1920x1080");
}

TEST(Table1, CountsAPassesTimeWhereItBelongs) {
    EXPECT_EQ(shareOf("raster"), Table1Share::kRaster);
    EXPECT_EQ(shareOf("error.reflection"), Table1Share::kMetric);
    EXPECT_EQ(shareOf("combine"), Table1Share::kMetric);
    EXPECT_EQ(shareOf("sort"), Table1Share::kSort);
    EXPECT_EQ(shareOf("trace"), Table1Share::kRefine);
}

// Straight below its centre an area of 2 x 3 sends what a point of 6 times its radiance does.
TEST(Table1, MakesLightsPointsThatSendAsMuchStraightAhead) {
    Scene scene;
    Light rectangle{}, sphere{}, sun{};
    rectangle.kind = kLightRectangle;
    rectangle.half_u = {1, 0, 0};
    rectangle.half_v = {0, 0, 1.5f};
    rectangle.intensity = vec3(4);
    sphere.kind = kLightSphere;
    sphere.radius = 2;
    sphere.intensity = vec3(1);
    sun.kind = kLightDirectional;
    sun.radius = 0.1f;
    sun.intensity = vec3(3);
    scene.lights = {rectangle, sphere, sun};
    makeLightsPoints(scene);
    EXPECT_EQ(scene.lights[0].kind, kLightPoint);
    EXPECT_NEAR(scene.lights[0].intensity.x, 24.0f, 1e-5f);
    EXPECT_NEAR(scene.lights[1].intensity.x, 4.0f * std::numbers::pi_v<float>, 1e-5f);
    EXPECT_EQ(scene.lights[2].kind, kLightDirectional);
    EXPECT_EQ(scene.lights[2].radius, 0.0f);
    EXPECT_EQ(scene.lights[2].intensity.x, 3.0f);
}

TEST(ViewChoice, OffersTheSamePlacesInsideTheSceneAndAroundItsMirrors) {
    const Scene scene = loadScene("builtin:cornell");
    const std::vector<CameraDesc> views = candidateViews(scene, scene.camera(""), 32);
    const std::vector<CameraDesc> again = candidateViews(scene, scene.camera(""), 32);
    ASSERT_EQ(views.size(), 32u);
    std::set<float> places;
    for (std::size_t i = 0; i < views.size(); ++i) {
        EXPECT_EQ(views[i].position, again[i].position);
        EXPECT_EQ(views[i].fov_y_degrees, scene.camera("").fov_y_degrees);
        EXPECT_NO_THROW((void)makeCamera(views[i]));
        places.insert(views[i].position.x);
    }
    EXPECT_GT(places.size(), 28u);
}

TEST(ViewChoice, TakesTheViewWhoseShareIsNearest) {
    if (const std::string why = whyNoRaster(); !why.empty())
        GTEST_SKIP() << why;
    Session session;
    const Devices devices = session.openDevices("", false);
    const Scene scene = loadScene("builtin:cornell");
    const double shares[] = {0.4, 0.05};
    const std::vector<ChosenView> views =
        chooseViewsByShare(findGraph("sir"), session, devices, scene, scene.camera(""), shares);
    ASSERT_EQ(views.size(), 2u);
    EXPECT_NE(views[0].camera.name, views[1].camera.name);
    EXPECT_GT(views[0].share, views[1].share);
    EXPECT_NEAR(views[1].share, 0.05, 0.04);
}

TEST(ViewChoice, RefusesGraphsThatSayNothingOfErrors) {
    const Session session;
    const Scene scene = loadScene("builtin:cornell");
    try {
        static_cast<void>(
            chooseViewsByShare(findGraph("prt"), session, {}, scene, scene.camera(""), {}));
        FAIL() << "prt.json has no output \"error\"";
    } catch (const GraphError& problem) {
        EXPECT_NE(std::string(problem.what()).find("it has no output \"error\""), std::string::npos)
            << problem.what();
    }
}

TEST(Table1, IsMeasuredByTheCommand) {
    if (const std::string why = whyNoRaster(); !why.empty())
        GTEST_SKIP() << why;
    const CommandRun run = runHone({"bench", "table1", "--scene", "builtin:cornell", "--sizes",
                                    "64x48", "--samples", "1", "--repeats", "1", "--json"});
    const nlohmann::json json = run.json();
    ASSERT_EQ(json["rows"].size(), 4u);
    for (const nlohmann::json& each : json["rows"]) {
        EXPECT_GT(each["prt_ms"], 0.0);
        EXPECT_GE(each["f_c"], 0.0);
        EXPECT_LE(each["f_c"], 1.0);
    }
}

} // namespace
} // namespace hone::cli
