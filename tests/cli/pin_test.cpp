// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/cli/pin.h"
#include "hone/core/image/image.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace hone::cli {
namespace {

TEST(ParsePin, ReadsValueIterationAndFile) {
    const PinRequest last = parsePin("raster.color=a=b.exr");
    EXPECT_EQ(last.value, "raster.color");
    EXPECT_FALSE(last.iteration);
    EXPECT_EQ(last.path, "a=b.exr");
    const PinRequest third = parsePin("refine.trace.samples@3=out/x.csv");
    EXPECT_EQ(third.value, "refine.trace.samples");
    EXPECT_EQ(third.iteration, 3u);
    EXPECT_EQ(third.path, "out/x.csv");
}

TEST(ParsePin, RefusesWhatItCannotRead) {
    for (const char* text : {"", "raster.color", "=x.exr", "raster.color=", "a.b@=x.exr",
                             "a.b@0=x.exr", "a.b@-1=x.exr", "a.b@2x=x.exr", "a.b@9999999999=x.exr"})
        EXPECT_THROW(std::ignore = parsePin(text), std::invalid_argument) << text;
}

std::vector<std::string> linesOf(const std::string& path) {
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
        lines.push_back(line);
    return lines;
}

// A graph that needs no Vulkan device: everything in tile order, 4 pixels at a time, so that the
// requests of each iteration are known.
class Pin : public testing::Test {
protected:
    CommandRun render(std::vector<std::string> more) {
        std::vector<std::string> arguments{
            "render",  "prt", "--scene",          "builtin:cornell", "--size", "4x4", "--set",
            "batch=4", "-o",  folder.path("out"), "--device",        "none",   "-q"};
        for (std::string& argument : more)
            arguments.push_back(std::move(argument));
        return runHone(arguments);
    }
    TemporaryFolder folder;
};

TEST_F(Pin, SavesAListOfOneIteration) {
    const CommandRun run =
        render({"--pin", "refine.request.requests@2=" + folder.path("new/requests.csv")});
    ASSERT_EQ(run.code, kOk) << run.err;
    // Morton order of a tile: the second four pixels are the upper right ones.
    EXPECT_EQ(linesOf(folder.path("new/requests.csv")),
              (std::vector<std::string>{"pixel,first_sample,samples", "2,0,1", "3,0,1", "6,0,1",
                                        "7,0,1"}));
}

TEST_F(Pin, SavesAPlaneBesideTheOutputsAndAsItIsInThem) {
    const CommandRun run = render({"--pin", "refine.blend.image=" + folder.path("image.exr")});
    ASSERT_EQ(run.code, kOk) << run.err;
    const RgbImage pinned = readRgb(folder.path("image.exr"));
    const RgbImage output = readRgb(folder.path("out/prt.exr"), "color");
    EXPECT_EQ(pinned.extent, uvec2(4, 4));
    EXPECT_EQ(pinned.pixels, output.pixels);
}

TEST_F(Pin, KnowsHowManySamplesAPixelHasAfterEachIteration) {
    const CommandRun run =
        render({"--pin", "refine.accumulate.accumulation@1=" + folder.path("sums.exr")});
    ASSERT_EQ(run.code, kOk) << run.err;
    const LayeredImage image = readExr(folder.path("sums.exr"));
    ASSERT_EQ(image.layers.size(), 1u);
    // Channels come back by name: B, G, R, samples.
    const ImageLayer& layer = image.layers[0];
    const auto samples = static_cast<std::size_t>(
        std::ranges::find(layer.channel_names, "samples") - layer.channel_names.begin());
    ASSERT_LT(samples, 4u);
    for (const std::size_t pixel : {0u, 1u, 4u, 5u})
        EXPECT_EQ(layer.values[4 * pixel + samples], 1.0f);
    EXPECT_EQ(layer.values[4 * 15 + samples], 0.0f);
}

TEST_F(Pin, KeepsTheLastListThatHadElements) {
    const CommandRun run = render({"--pin", "refine.request.requests=" + folder.path("last.csv"),
                                   "--pin", "refine.stats=" + folder.path("curve.csv")});
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_EQ(linesOf(folder.path("last.csv")).size(), 5u);
    EXPECT_EQ(linesOf(folder.path("curve.csv")).size(), 5u); // four iterations of four pixels
}

TEST_F(Pin, SaysAllThatIsWrongBeforeAnythingRuns) {
    const std::string exr = "=" + folder.path("x.exr");
    const CommandRun run =
        render({"--pin", "refine.blend.imag" + exr, "--pin", "refine.request.requests" + exr,
                "--pin", "refine.image@2" + exr, "--pin", "$scene" + exr});
    EXPECT_EQ(run.code, kBadInput);
    for (const char* text :
         {"did you mean \"refine.blend.image\"?", "type RequestList is written as a table",
          "pin what becomes it: refine.blend.image@2", "$scene: this is an input of the graph"})
        EXPECT_NE(run.err.find(text), std::string::npos) << text << "\n" << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/prt.exr")));
}

TEST_F(Pin, SaysWhatWasNeverMade) {
    const CommandRun run = render({"--pin", "refine.blend.image@9=" + folder.path("x.exr")});
    EXPECT_EQ(run.code, kNotWritten);
    EXPECT_NE(run.err.find("is not written: refine.blend last ran in iteration 5"),
              std::string::npos)
        << run.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/prt.exr")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("x.exr")));
}

TEST_F(Pin, RefusesAFileThatCannotBeWrittenBeforeRendering) {
    const CommandRun run = render({"--pin", "refine.blend.image=/proc/x.exr"});
    EXPECT_EQ(run.code, kNotWritten);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/prt.exr")));
}

TEST_F(Pin, NumbersTheFilesOfFrames) {
    const CommandRun run =
        render({"--frames", "2", "--pin", "refine.blend.image=" + folder.path("image.exr")});
    ASSERT_EQ(run.code, kOk) << run.err;
    EXPECT_TRUE(std::filesystem::exists(folder.path("image.0000.exr")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("image.0001.exr")));
}

} // namespace
} // namespace hone::cli
