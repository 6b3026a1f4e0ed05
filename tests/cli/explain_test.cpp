// SPDX-License-Identifier: Apache-2.0
//
// hone compare --explain: why images of two backends differ.
#include "hone/cli/commands.h"
#include "hone/core/image/image.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

/// Renders the Cornell box and returns the image's path.
std::string render(const TemporaryFolder& folder, const std::string& backend,
                   const std::string& seed = "0") {
    const std::string out = folder.path(backend + seed);
    const CommandRun run =
        runHone({"render", "prt", "--scene", "builtin:cornell", "--size", "24x16", "--device",
                 "none", "--seed", seed, "--set", "backend=" + backend, "-o", out, "--quiet"});
    EXPECT_EQ(run.code, kOk) << run.err;
    return out + "/prt.exr";
}

TEST(CompareExplain, FindsNothingToExplainInEqualImages) {
    const TemporaryFolder folder;
    const CommandRun run = runHone(
        {"compare", render(folder, "embree"), render(folder, "brute"), "--explain", "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_TRUE(run.json()["explained"]["pixels"].empty());
}

TEST(CompareExplain, FailsWhereNoRayExplainsAPixel) {
    const TemporaryFolder folder;
    const std::string a = render(folder, "embree");
    const std::string b = render(folder, "brute");
    LayeredImage altered = readExr(b);
    for (ImageLayer& layer : altered.layers)
        if (layer.name == "color")
            layer.values[3 * (5 * 24 + 7)] += 0.25f;
    writeExr(b, altered);
    const CommandRun run = runHone({"compare", a, b, "--explain", "--json"});
    EXPECT_EQ(run.code, kTargetNotMet) << run.err;
    const nlohmann::json explained = run.json()["explained"];
    EXPECT_EQ(explained["unexplained"], 1);
    ASSERT_EQ(explained["pixels"].size(), 1u);
    EXPECT_EQ(explained["pixels"][0]["x"], 7);
    EXPECT_EQ(explained["pixels"][0]["y"], 5);
}

TEST(CompareExplain, RefusesImagesThatWereMadeDifferently) {
    const TemporaryFolder folder;
    const CommandRun run =
        runHone({"compare", render(folder, "embree"), render(folder, "embree", "1"), "--explain"});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("hone.seed"), std::string::npos) << run.err;
}

TEST(CompareExplain, RefusesImagesThatDoNotSayHowTheyWereMade) {
    const TemporaryFolder folder;
    const std::string a = render(folder, "embree");
    LayeredImage nameless = readExr(a);
    nameless.attributes.clear();
    writeExr(folder.path("nameless.exr"), nameless);
    const CommandRun run = runHone({"compare", a, folder.path("nameless.exr"), "--explain"});
    EXPECT_EQ(run.code, kBadInput);
    EXPECT_NE(run.err.find("nameless.exr: does not say"), std::string::npos) << run.err;
}

} // namespace
} // namespace hone::cli
