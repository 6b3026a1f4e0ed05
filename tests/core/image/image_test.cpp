// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/image.h"

#include "hone/core/error.h"
#include "hone/core/image/exr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

namespace hone {
namespace {

class ImageFiles : public ::testing::Test {
protected:
    void SetUp() override {
        std::filesystem::remove_all(directory_);
        std::filesystem::create_directories(directory_);
    }
    void TearDown() override { std::filesystem::remove_all(directory_); }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (directory_ / name).string();
    }

private:
    std::filesystem::path directory_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("hone_image_") +
         ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

LayeredImage twoLayers() {
    return {{2, 1},
            {{"color", {"R", "G", "B"}, {1, 2, 3, 4, 5, 6}},
             {"error", {"expect", "bound"}, {0.25f, 0.5f, 1e30f, -0.0f}}},
            {{"graph", "sir.json"}, {"seed", "7"}}};
}

const ImageLayer& layer(const LayeredImage& image, const std::string& name) {
    for (const ImageLayer& l : image.layers)
        if (l.name == name)
            return l;
    throw std::out_of_range(name);
}

TEST_F(ImageFiles, ExrKeepsLayersBitForBit) {
    writeExr(path("a.exr"), twoLayers());
    const LayeredImage read = readExr(path("a.exr"));
    EXPECT_EQ(read.extent, uvec2(2, 1));
    ASSERT_EQ(read.layers.size(), 2u);
    EXPECT_EQ(layer(read, "color").channel_names, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(layer(read, "color").values, (std::vector<float>{1, 2, 3, 4, 5, 6}));
    // Names without an order of their own come back by the alphabet.
    const ImageLayer& error = layer(read, "error");
    ASSERT_EQ(error.channel_names, (std::vector<std::string>{"bound", "expect"}));
    const float expected[] = {0.5f, 0.25f, -0.0f, 1e30f};
    EXPECT_EQ(std::memcmp(error.values.data(), expected, sizeof expected), 0);
}

TEST_F(ImageFiles, ExrKeepsNotANumber) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    writeExr(path("a.exr"), {{2, 1}, {{"", {"Y"}, {nan, infinity}}}, {}});
    const LayeredImage read = readExr(path("a.exr"));
    EXPECT_TRUE(std::isnan(read.layers[0].values[0]));
    EXPECT_EQ(read.layers[0].values[1], infinity);
}

TEST_F(ImageFiles, ExrKeepsAttributes) {
    writeExr(path("a.exr"), twoLayers());
    const auto attributes = readExr(path("a.exr")).attributes;
    EXPECT_EQ(attributes, (decltype(attributes){{"graph", "sir.json"}, {"seed", "7"}}));
}

TEST_F(ImageFiles, ExrChannelNamesGroupInViewers) {
    const std::vector<std::byte> file = encodeExr(twoLayers());
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    for (const char* name : {"color.R", "color.G", "color.B", "error.expect", "error.bound"})
        EXPECT_NE(text.find(name), std::string::npos) << name;
}

TEST_F(ImageFiles, SameImageGivesSameBytes) {
    EXPECT_EQ(encodeExr(twoLayers()), encodeExr(twoLayers()));
    const Image8 image{{1, 1}, {1, 2, 3, 4}};
    EXPECT_EQ(encodePng(image, {{"Seed", "7"}}), encodePng(image, {{"Seed", "7"}}));
}

TEST_F(ImageFiles, ReservedAttributeNameIsAProgrammersMistake) {
    LayeredImage image = twoLayers();
    image.attributes = {{"channels", "mine"}};
    EXPECT_THROW((void)encodeExr(image), std::logic_error);
}

TEST_F(ImageFiles, PngKeepsCodesAndText) {
    const Image8 image{{2, 1}, {1, 2, 3, 255, 250, 251, 252, 255}};
    writePng(path("a.png"), image, {{"Graph", "sir.json"}, {"Author", "J\xc3\xbcrgen"}});
    const std::vector<std::byte> file = readFile(path("a.png"));
    EXPECT_EQ(decodeImage(file, "a").rgba, image.rgba);
    const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
    EXPECT_NE(text.find(std::string("tEXtGraph\0sir.json", 18)), std::string::npos);
    EXPECT_NE(text.find("iTXtAuthor"), std::string::npos);
    EXPECT_NE(text.find("J\xc3\xbcrgen"), std::string::npos);
    EXPECT_NE(text.find("sRGB"), std::string::npos);
}

TEST_F(ImageFiles, PngKeepsAlphaWhereThereIsSome) {
    const Image8 image{{2, 1}, {1, 2, 3, 0, 250, 251, 252, 255}};
    writePng(path("a.png"), image);
    EXPECT_EQ(decodeImage(readFile(path("a.png")), "a").rgba, image.rgba);
}

TEST_F(ImageFiles, RgbComesFromTheColourLayer) {
    writeExr(path("a.exr"), twoLayers());
    const RgbImage image = readRgb(path("a.exr"));
    EXPECT_FALSE(image.is_display);
    EXPECT_EQ(image.pixels, (std::vector<vec3>{{1, 2, 3}, {4, 5, 6}}));
}

TEST_F(ImageFiles, RgbOfAnUnnamedLayerGoesFirst) {
    LayeredImage image = twoLayers();
    image.layers.push_back({"", {"R", "G", "B", "A"}, {7, 8, 9, 1, 10, 11, 12, 1}});
    writeExr(path("a.exr"), image);
    EXPECT_EQ(readRgb(path("a.exr")).pixels[1], vec3(10, 11, 12));
    EXPECT_EQ(readRgb(path("a.exr"), "color").pixels[1], vec3(4, 5, 6));
}

TEST_F(ImageFiles, RgbOfOneChannelIsGrey) {
    writeExr(path("a.exr"), {{1, 1}, {{"depth", {"Z"}, {2.5f}}}, {}});
    EXPECT_EQ(readRgb(path("a.exr")).pixels[0], vec3(2.5f));
}

TEST_F(ImageFiles, MissingLayerIsNamedWithThoseThereAre) {
    writeExr(path("a.exr"), twoLayers());
    try {
        (void)readRgb(path("a.exr"), "colour");
        FAIL();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("\"colour\""), std::string::npos);
        EXPECT_NE(message.find("\"color\", \"error\""), std::string::npos) << message;
    }
}

TEST_F(ImageFiles, RgbOfPngIsDisplayValues) {
    writePng(path("a.png"), {{1, 1}, {0, 51, 255, 255}});
    const RgbImage image = readRgb(path("a.png"));
    EXPECT_TRUE(image.is_display);
    EXPECT_EQ(image.pixels[0], vec3(0, 51.0f / 255.0f, 1));
}

TEST_F(ImageFiles, UnreadableFilesAreErrorsWithTheirPath) {
    EXPECT_THROW((void)readRgb(path("absent.exr")), InputError);
    std::ofstream(path("text.exr")) << "hello";
    EXPECT_THROW((void)readRgb(path("text.exr")), InputError);
    EXPECT_THROW((void)readExr(path("text.exr")), InputError);
    EXPECT_THROW((void)readRgb(path("")), InputError);
}

TEST(Display, EncodesBySrgb) {
    // IEC 61966-2-1: 0.5 -> 0.735357, the linear toe 12.92 x, cut outside, NaN to 0.
    const RgbImage linear{{2, 1}, {{0.5f, 0.001f, 2.0f}, {-1.0f, NAN, 1.0f}}, false};
    const RgbImage display = toDisplay(linear);
    EXPECT_TRUE(display.is_display);
    EXPECT_NEAR(display.pixels[0].x, 0.735357f, 1e-6f);
    EXPECT_NEAR(display.pixels[0].y, 0.01292f, 1e-7f);
    EXPECT_NEAR(display.pixels[0].z, 1.0f, 1e-6f);
    EXPECT_EQ(display.pixels[1].x, 0.0f);
    EXPECT_EQ(display.pixels[1].y, 0.0f);
    EXPECT_EQ(toDisplay(display).pixels, display.pixels);
}

TEST(Display, QuantizesToTheNearestCode) {
    const vec3 pixels[] = {{0.0f, 0.5f, 1.0f}, {-3.0f, 9.0f, NAN}};
    const Image8 image = quantize({2, 1}, pixels);
    EXPECT_EQ(image.rgba, (std::vector<std::uint8_t>{0, 128, 255, 255, 0, 255, 0, 255}));
}

TEST(ChannelNames, AreThoseThatViewersKnow) {
    EXPECT_EQ(usualChannelNames(1), (std::vector<std::string>{"Y"}));
    EXPECT_EQ(usualChannelNames(4), (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_THROW((void)usualChannelNames(5), std::logic_error);
}

} // namespace
} // namespace hone
