// SPDX-License-Identifier: Apache-2.0
//
// The keys that --json promises.
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

void expectKeys(const nlohmann::json& object, std::initializer_list<const char*> keys) {
    ASSERT_TRUE(object.is_object()) << object;
    for (const char* key : keys)
        EXPECT_TRUE(object.contains(key)) << key << " in " << object.dump(2);
}

TEST(Json, CheckListsNothingForAGoodGraph) {
    const CommandRun run = runHone({"check", "prt", "--json"});
    EXPECT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(run.json(), nlohmann::json::parse(R"({"diagnostics": []})"));
}

TEST(Json, CheckListsEveryProblemWithItsPlace) {
    const TemporaryFolder folder;
    const std::string graph = folder.write("bad.json", R"({
  "hone": 1,
  "name": "bad",
  "inputs": { "scene": "scene" },
  "passes": { "one": { "type": "sorrt" }, "two": { "type": "trase" } },
  "outputs": { "order": "one.order" }
}
)");
    const CommandRun run = runHone({"check", graph, "--json"});
    EXPECT_EQ(run.code, kBadInput);
    const nlohmann::json diagnostics = run.json()["diagnostics"];
    ASSERT_GE(diagnostics.size(), 2u);
    for (const nlohmann::json& diagnostic : diagnostics) {
        expectKeys(diagnostic, {"code", "severity", "file", "line", "column", "length", "pointer",
                                "message", "hint", "notes"});
        EXPECT_EQ(diagnostic["file"], graph);
    }
    EXPECT_EQ(diagnostics[0]["line"], 5);
    EXPECT_EQ(diagnostics[0]["column"], 32);
    EXPECT_EQ(diagnostics[0]["length"], 7); // "sorrt" with its quotes
    EXPECT_EQ(diagnostics[0]["severity"], "error");
    EXPECT_EQ(diagnostics[0]["pointer"].get<std::string>().find("/passes/one"), 0u);
}

TEST(Json, CheckTellsTheOtherPlaces) {
    const TemporaryFolder folder;
    const std::string graph = folder.write("twice.json", "{ \"hone\": 1,\n  \"hone\": 1 }");
    const nlohmann::json diagnostics = runHone({"check", graph, "--json"}).json()["diagnostics"];
    ASSERT_FALSE(diagnostics.empty());
    const auto twice =
        std::ranges::find_if(diagnostics, [](const auto& d) { return d["code"] == "E0102"; });
    ASSERT_NE(twice, diagnostics.end());
    EXPECT_EQ((*twice)["line"], 2);
    EXPECT_EQ(
        (*twice)["notes"],
        nlohmann::json::array(
            {{{"file", graph}, {"line", 1}, {"column", 3}, {"message", "the first is here"}}}));
}

TEST(Json, PassesDescribesPortsAndParameters) {
    const nlohmann::json all = runHone({"passes", "--json"}).json()["passes"];
    std::vector<std::string> names;
    for (const nlohmann::json& pass : all) {
        expectKeys(pass, {"name", "doc", "inputs", "outputs", "params"});
        names.push_back(pass["name"]);
        for (const nlohmann::json& port : pass["inputs"])
            expectKeys(port, {"name", "type", "optional", "variadic", "doc"});
        for (const nlohmann::json& port : pass["outputs"])
            expectKeys(port, {"name", "type", "doc"});
        for (const nlohmann::json& param : pass["params"])
            expectKeys(param, {"name", "type", "range", "default", "doc"});
    }
    EXPECT_TRUE(std::ranges::is_sorted(names));
    for (const char* name : {"accumulate", "blend", "combine", "error.reflection", "error.kbm10",
                             "raster", "request", "sort", "tonemap", "trace"})
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;

    const nlohmann::json sort = runHone({"passes", "sort", "--json"}).json();
    EXPECT_EQ(sort["name"], "sort");
    EXPECT_EQ(sort["inputs"][0]["type"], "Error");
    EXPECT_EQ(sort["params"][0]["range"], "select | radix");
}

TEST(Json, RenderReportsWhatItDid) {
    const TemporaryFolder folder;
    const CommandRun run =
        runHone({"render", "prt", "--scene", "builtin:cornell", "--size", "64x48", "--set",
                 "batch=1024", "--seed", "7", "-o", folder.path("out"), "--json"});
    ASSERT_EQ(run.code, kOk) << run.err;
    const nlohmann::json report = run.json();
    expectKeys(report, {"graph", "scene", "size", "device", "backend", "backend_reason", "seed",
                        "passes", "frame_ms", "error_pixels", "error_share", "rays", "iterations",
                        "stop", "outputs"});
    EXPECT_EQ(report["graph"], "prt");
    EXPECT_EQ(report["scene"], "builtin:cornell");
    EXPECT_EQ(report["size"], nlohmann::json({64, 48}));
    EXPECT_EQ(report["seed"], 7);
    EXPECT_NE(report["backend"], "auto");
    EXPECT_NE(report["backend_reason"], "");
    // 64 * 48 = 3072 pixels: three batches of 1024 and one that finds nothing left.
    EXPECT_EQ(report["rays"]["primary"], 3072);
    EXPECT_EQ(report["stop"], "empty");
    for (const nlohmann::json& pass : report["passes"])
        expectKeys(pass, {"name", "type", "ms", "runs"});
    ASSERT_FALSE(report["outputs"].empty());
    for (const nlohmann::json& path : report["outputs"])
        EXPECT_TRUE(std::filesystem::is_regular_file(path.get<std::string>())) << path;
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("out/prt.exr")));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("out/color.png")));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("out/curve.csv")));
}

TEST(Json, CompareMeasuresAndEndsWith1PastItsLimit) {
    const TemporaryFolder folder;
    std::vector<std::string> images;
    for (const char* seed : {"1", "2"}) {
        const std::string out = folder.path(std::string("seed") + seed);
        ASSERT_EQ(runHone({"render", "prt", "--scene", "builtin:cornell", "--size", "64x48",
                           "--seed", seed, "-q", "-o", out})
                      .code,
                  kOk);
        images.push_back(out + "/prt.exr");
    }
    const CommandRun same = runHone({"compare", images[0], images[0], "--max-differing-bits", "0",
                                     "--max-difference", "0", "--json"});
    EXPECT_EQ(same.code, kOk) << same.err;
    EXPECT_EQ(same.json()["mse"], 0.0);
    EXPECT_EQ(same.json()["differing_pixels"], 0);
    EXPECT_TRUE(same.json()["psnr"].is_null()); // infinite
    EXPECT_EQ(same.json()["flip"], 0.0);
    expectKeys(same.json()["flip_exposures"], {"count", "first", "last"});

    // Another seed places soft shadows' samples elsewhere.
    const CommandRun other =
        runHone({"compare", images[0], images[1], "--max-differing-bits", "0", "--heat-map",
                 folder.path("heat.png"), "--flip-map", folder.path("flip.png"), "--json"});
    EXPECT_EQ(other.code, kTargetNotMet);
    expectKeys(other.json(), {"mse", "rmse", "psnr", "ssim", "flip", "flip_exposures", "max",
                              "differing_pixels", "differing_bits"});
    EXPECT_GT(other.json()["differing_pixels"], 0);
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("heat.png")));
    EXPECT_TRUE(std::filesystem::is_regular_file(folder.path("flip.png")));
    const std::string display = folder.path("heat.png"); // LDR-FLIP
    EXPECT_TRUE(
        runHone({"compare", display, display, "--json"}).json()["flip_exposures"].is_null());
    // Noise is seen better from nearer by.
    EXPECT_GT(other.json()["flip"], 0.0);
    EXPECT_GT(runHone({"compare", images[0], images[1], "--ppd", "20", "--json"}).json()["flip"],
              other.json()["flip"]);
    const std::string most = std::to_string(other.json()["max"].get<double>() / 2);
    EXPECT_EQ(runHone({"compare", images[0], images[1], "--max-difference", most}).code,
              kTargetNotMet);
    EXPECT_EQ(runHone({"compare", images[0], images[1]}).code, kOk);

    EXPECT_EQ(runHone({"compare", images[0], folder.path("absent.exr")}).code, kBadInput);
    EXPECT_EQ(runHone({"compare", images[0], folder.write("text.png", "no picture")}).code,
              kBadInput);
}

TEST(Json, DoctorAnswersWithoutADevice) {
    const CommandRun run = runHone({"doctor", "--json"});
    EXPECT_TRUE(run.json().is_object());
}

} // namespace
} // namespace hone::cli
