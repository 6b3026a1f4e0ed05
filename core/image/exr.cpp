// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/exr.h"

#include "hone/core/error.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

namespace hone {
namespace {

constexpr std::uint64_t kMaxValues = 1ull << 29;

class MemoryReader : public Imf::IStream {
public:
    explicit MemoryReader(std::span<const std::byte> file) : Imf::IStream("memory"), file_(file) {}
    bool read(char to[], int size) override {
        const auto wanted = static_cast<std::uint64_t>(size);
        if (size < 0 || position_ > file_.size() || wanted > file_.size() - position_)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, file_.data() + position_, wanted);
        position_ += wanted;
        return position_ < file_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

private:
    std::span<const std::byte> file_;
    std::uint64_t position_ = 0;
};

class MemoryWriter : public Imf::OStream {
public:
    explicit MemoryWriter(std::vector<std::byte>& file) : Imf::OStream("memory"), file_(file) {}
    void write(const char from[], int size) override {
        const auto count = static_cast<std::size_t>(size);
        if (position_ + count > file_.size())
            file_.resize(position_ + count);
        std::memcpy(file_.data() + position_, from, count);
        position_ += count;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

private:
    std::vector<std::byte>& file_;
    std::uint64_t position_ = 0;
};

/// Checks the claims of the header before the library allocates by them. Throws runtime_error.
void checkHeader(std::span<const std::byte> file) {
    if (file.size() < 8)
        throw std::runtime_error("the file ends too early");
    int version = 0;
    std::memcpy(&version, file.data() + 4, 4);
    if (Imf::isMultiPart(version) || Imf::isNonImage(version))
        throw std::runtime_error("multi-part and deep files are not read; save one flat part");
    MemoryReader stream(file);
    stream.seekg(8);
    Imf::Header header;
    header.readFrom(stream, version);

    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
        throw std::runtime_error("its sides must be 1 to 16384 pixels");
    std::uint64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw std::runtime_error(std::string("channel ") + c.name() +
                                     " is subsampled; save it at full resolution");
    if (std::uint64_t(width * height) * channels > kMaxValues)
        throw std::runtime_error("it holds more than 2^29 values");
}

std::pair<std::string, std::string> splitName(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? std::pair<std::string, std::string>("", channel)
                                    : std::pair(channel.substr(0, dot), channel.substr(dot + 1));
}

/// Files list channels by the alphabet; people expect R G B A and X Y Z.
void orderChannels(std::vector<std::string>& names) {
    constexpr std::string_view kOrder = "RGBAXYZ";
    std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
        const auto rank = [&](const std::string& name) {
            const std::size_t found = name.size() == 1 ? kOrder.find(name[0]) : kOrder.npos;
            return found == kOrder.npos ? kOrder.size() : found;
        };
        return rank(a) < rank(b);
    });
}

std::string fullName(const ImageLayer& layer, std::size_t channel) {
    return (layer.name.empty() ? "" : layer.name + ".") + layer.channel_names[channel];
}

/// A view of one channel for the library, which addresses pixels by their absolute coordinates.
Imf::Slice sliceOf(const float* values, std::size_t channel, std::size_t channels, uvec2 extent,
                   int left, int top) {
    const std::size_t pixel = channels * sizeof(float);
    // The library takes a mutable pointer for reading and writing alike; encoding only reads.
    char* base = reinterpret_cast<char*>(const_cast<float*>(values + channel));
    const std::ptrdiff_t origin =
        (std::ptrdiff_t(top) * std::ptrdiff_t(extent.x) + left) * std::ptrdiff_t(pixel);
    return {Imf::FLOAT,
            reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(base) -
                                    static_cast<std::uintptr_t>(origin)),
            pixel, pixel * extent.x};
}

LayeredImage read(std::span<const std::byte> file) {
    checkHeader(file);
    MemoryReader stream(file);
    Imf::InputFile input(stream, 0);
    const Imf::Header& header = input.header();
    const Imath::Box2i window = header.dataWindow();

    LayeredImage image;
    image.extent = {static_cast<uint>(window.max.x - window.min.x + 1),
                    static_cast<uint>(window.max.y - window.min.y + 1)};
    for (auto a = header.begin(); a != header.end(); ++a)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
            image.attributes.emplace_back(a.name(), text->value());

    std::map<std::string, std::vector<std::string>> layers;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        const auto [layer, channel] = splitName(c.name());
        layers[layer].push_back(channel);
    }
    Imf::FrameBuffer target;
    for (auto& [name, channels] : layers) {
        orderChannels(channels);
        ImageLayer layer{name, std::move(channels), {}};
        layer.values.resize(std::size_t(image.extent.x) * image.extent.y *
                            layer.channel_names.size());
        image.layers.push_back(std::move(layer));
    }
    for (const ImageLayer& layer : image.layers)
        for (std::size_t c = 0; c < layer.channel_names.size(); ++c)
            target.insert(fullName(layer, c),
                          sliceOf(layer.values.data(), c, layer.channel_names.size(), image.extent,
                                  window.min.x, window.min.y));
    input.setFrameBuffer(target);
    input.readPixels(window.min.y, window.max.y);
    return image;
}

} // namespace

bool isExr(std::span<const std::byte> file) {
    constexpr unsigned char kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
    return file.size() >= 4 && std::memcmp(file.data(), kMagic, 4) == 0;
}

LayeredImage decodeExr(std::span<const std::byte> file, const std::string& name) {
    try {
        return read(file);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw InputError(name + ": cannot be read as OpenEXR: " + error.what());
    }
}

std::vector<std::byte> encodeExr(const LayeredImage& image) {
    const std::size_t pixels = std::size_t(image.extent.x) * image.extent.y;
    HONE_ASSERT(pixels > 0, "an image without pixels");
    Imf::Header header(static_cast<int>(image.extent.x), static_cast<int>(image.extent.y));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, text] : image.attributes) {
        HONE_ASSERT(header.find(name) == header.end(), name);
        header.insert(name, Imf::StringAttribute(text));
    }
    Imf::FrameBuffer source;
    for (const ImageLayer& layer : image.layers) {
        const std::size_t channels = layer.channel_names.size();
        HONE_ASSERT(layer.values.size() == pixels * channels, layer.name);
        for (std::size_t c = 0; c < channels; ++c) {
            const std::string name = fullName(layer, c);
            HONE_ASSERT(header.channels().findChannel(name) == nullptr, name);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            source.insert(name, sliceOf(layer.values.data(), c, channels, image.extent, 0, 0));
        }
    }
    std::vector<std::byte> file;
    try {
        MemoryWriter stream(file);
        Imf::OutputFile output(stream, header, 0);
        output.setFrameBuffer(source);
        output.writePixels(static_cast<int>(image.extent.y));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw OutputError(std::string("OpenEXR encoding failed: ") + error.what());
    }
    return file;
}

} // namespace hone
