// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/test_passes.h"

#include "hone/core/device/host_kernel.h"
#include "hone/core/device/kernel.glsl.h"

#include <algorithm>

namespace hone {
namespace {

struct ErrorA : HostKernel {
    using HostKernel::HostKernel;
    struct Params {
        float scale;
    };
    HONE_PARAMS(Params)
    HONE_WRITE(vec2, error)
    void kernel(uint index) { error[index] = vec2(params.scale * static_cast<float>(index + 1u)); }
};
constexpr Kernel kErrorA = makeKernel<ErrorA>("error_a", {});

struct Add : HostKernel {
    using HostKernel::HostKernel;
    struct Params {
        float amount;
    };
    HONE_PARAMS(Params)
    HONE_READ(vec3, color)
    HONE_WRITE(vec3, result)
    void kernel(uint index) { result[index] = color[index] + params.amount; }
};
constexpr Kernel kAdd = makeKernel<Add>("add", {});

struct Bump : HostKernel {
    using HostKernel::HostKernel;
    struct Params {
        uint unused;
    };
    HONE_WRITE(vec3, result)
    void kernel(uint index) { result[index] = result[index] + 1.0f; }
};
constexpr Kernel kBump = makeKernel<Bump>("bump", {});

struct Mix : HostKernel {
    using HostKernel::HostKernel;
    struct Params {
        uint unused;
    };
    HONE_READ(vec3, a)
    HONE_READ(vec3, b)
    HONE_WRITE(vec3, color)
    void kernel(uint index) { color[index] = a[index] + b[index]; }
};
constexpr Kernel kMix = makeKernel<Mix>("mix", {});

struct Raster final : RenderPass {
    void execute(PassContext& context) override {
        std::ranges::fill(context.out("color").as<vec3>(), vec3(context.camera().position.x));
        std::ranges::fill(context.out("depth").as<float>(), 1.0f);
    }
};

struct Combine final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<vec2> result = context.out("error").as<vec2>();
        std::ranges::fill(result, vec2(0.0f));
        for (uint k = 0; k < context.edges("errors"); ++k) {
            const float weight = std::get<float>(context.edgeParam("errors", k, "weight"));
            const std::span<vec2> error = context.in("errors", k).as<vec2>();
            for (std::size_t i = 0; i < result.size(); ++i)
                result[i] = context.params->choice("mode") == 0
                                ? result[i] + weight * error[i]
                                : glm::max(result[i], weight * error[i]);
        }
    }
};

struct Sort final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<uint> order = context.out("order").as<uint>();
        for (std::size_t i = 0; i < order.size(); ++i)
            order[i] = static_cast<uint>(order.size() - 1 - i);
        context.out("cursor").as<uint>()[0] = 0;
    }
};

struct Request final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<uint> order = context.in("order").as<uint>();
        Value& requests = context.out("requests");
        uint& cursor = context.out("state").as<uint>()[0];
        const uint left = static_cast<uint>(order.size()) - cursor;
        requests.count = std::min(context.param<uint>("batch"), left);
        for (uint i = 0; i < requests.count; ++i)
            requests.as<uvec3>()[i] = uvec3(order[cursor + i], 0, 1);
        cursor += requests.count;
        context.counters->add("pixels", requests.count);
    }
};

struct Trace final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<uvec3> requests = context.in("requests").as<uvec3>();
        Value& samples = context.out("samples");
        samples.count = static_cast<uint>(requests.size());
        for (std::size_t i = 0; i < requests.size(); ++i)
            samples.as<vec4>()[i] = vec4(static_cast<float>(requests[i].x), 0.0f, 0.0f,
                                         glm::uintBitsToFloat(requests[i].x));
        context.counters->add("rays.primary", samples.count);
    }
};

struct Blend final : RenderPass {
    void execute(PassContext& context) override {
        const std::span<vec3> image = context.out("image").as<vec3>();
        for (const vec4& sample : context.in("samples").as<vec4>())
            image[glm::floatBitsToUint(sample.w)] = vec3(sample.x);
    }
};

struct Draw final : RenderPass {
    void execute(PassContext& context) override {
        context.device->beginRaster({.extent = context.extent});
        context.device->endRaster();
        context.device->copyImage(ImageHandle::kNone, context.out("depth").buffer);
    }
};

std::size_t onePerPixel(const SizeQuery& query) {
    return std::size_t{query.extent.x} * query.extent.y;
}
std::size_t one(const SizeQuery&) {
    return 1;
}
std::size_t oneBatch(const SizeQuery& query) {
    return query.params.get<uint>("batch");
}
std::size_t onePerRequest(const SizeQuery& query) {
    return query.input("requests");
}

ParamDecl weight() {
    ParamDecl decl;
    decl.name = "weight";
    decl.fallback = 1.0f;
    decl.min = 0;
    return decl;
}

class Brightest final : public RenderPass {
    void execute(PassContext& context) override {
        float greatest = 0;
        for (const vec3& color : context.in("color").as<vec3>())
            greatest = std::max(greatest, color.x);
        context.out("value").as<float>().front() = greatest;
    }
};

/// A compiler of one language: "bad" in line N is wrong, anything else is the pass "add".
ShaderPass compileShader(const PassRegistry& passes, const std::string& text) {
    if (const std::size_t bad = text.find("bad"); bad != std::string::npos) {
        const auto begin = text.begin();
        const auto at = begin + static_cast<std::ptrdiff_t>(bad);
        const std::size_t line = 1 + static_cast<std::size_t>(std::count(begin, at, '\n'));
        return {.type = {},
                .problems = {{.line = line,
                              .column = 3,
                              .length = 3,
                              .message = "this is bad",
                              .hint = "write something good"}}};
    }
    return {.type = *passes.find("add"), .problems = {}};
}

} // namespace

TestCatalog::TestCatalog() {
    passes.add(PassType("raster", "Draws")
                   .in("scene", types::kScene, "what")
                   .in("camera", types::kCamera, "from where")
                   .out("color", types::kRadiance, "the camera's x")
                   .out("depth", types::kDepth, "1")
                   .implementedBy<Raster>(Domain::kHost));
    passes.add(PassType("error.a", "Estimates")
                   .in("depth", types::kDepth, "depth")
                   .inOptional("color", types::kRadiance, "colour")
                   .out("error", types::kError, "scale * (pixel + 1)")
                   .param("scale", 1.0f, {.min = 0, .max = 10}, "factor")
                   .into(offsetof(ErrorA::Params, scale))
                   .kernel(kErrorA, "error"));
    passes.add(PassType("combine", "Joins errors")
                   .inMany("errors", types::kError, "errors", {weight()})
                   .out("error", types::kError, "joined")
                   .param("mode", {"linear", "max"}, "how")
                   .implementedBy<Combine>(Domain::kHost));
    passes.add(PassType("sort", "Orders pixels")
                   .in("error", types::kError, "error")
                   .out("order", types::kPixelList, "last first", onePerPixel)
                   .out("cursor", types::kCursor, "0", one)
                   .implementedBy<Sort>(Domain::kHost));
    passes.add(PassType("request", "Takes the next of the order")
                   .in("order", types::kPixelList, "order")
                   .in("state", types::kCursor, "how far")
                   .out("requests", types::kRequestList, "the next", oneBatch)
                   .outInPlace("state", types::kCursor, "state", "advanced")
                   .param("batch", 4u, {.min = 1, .max = {}}, "how many")
                   .implementedBy<Request>(Domain::kHost));
    passes.add(PassType("trace", "Answers requests")
                   .in("requests", types::kRequestList, "requests")
                   .inOptional("scene", types::kScene, "what")
                   .out("samples", types::kSamples, "radiance = pixel", onePerRequest)
                   .backendParam("backend", "who")
                   .param("exact", false, "each ray alone")
                   .implementedBy<Trace>(Domain::kHost));
    passes.add(PassType("blend", "Writes samples into an image")
                   .in("image", types::kRadiance, "image")
                   .in("samples", types::kSamples, "samples")
                   .outInPlace("image", types::kRadiance, "image", "updated")
                   .implementedBy<Blend>(Domain::kHost));
    passes.add(PassType("add", "Adds a number")
                   .in("color", types::kRadiance, "colour")
                   .out("result", types::kRadiance, "color + amount")
                   .param("amount", 1.0f, {}, "what to add")
                   .into(offsetof(Add::Params, amount))
                   .kernel(kAdd, "result"));
    passes.add(PassType("bump", "Adds 1 in place")
                   .in("color", types::kRadiance, "colour")
                   .outInPlace("result", types::kRadiance, "color", "color + 1")
                   .kernel(kBump, "result"));
    PassType mix = PassType("mix", "Adds two colours")
                       .in("a", types::kRadiance, "colour")
                       .in("b", types::kRadiance, "colour")
                       .out("color", types::kRadiance, "a + b")
                       .kernel(kMix, "color");
    mix.plugin = "mixer";
    passes.add(std::move(mix));
    passes.add(PassType("brightest", "Finds the greatest x")
                   .in("color", types::kRadiance, "colour")
                   .out("value", types::kScalar, "its greatest x", one)
                   .implementedBy<Brightest>(Domain::kHost));
    passes.add(PassType("draw", "Rasterises")
                   .in("camera", types::kCamera, "from where")
                   .out("depth", types::kDepth, "depth")
                   .implementedBy<Draw>(Domain::kDevice));
    shaders = [this](const std::string&, const std::string& text) {
        return compileShader(passes, text);
    };
    backends.add("embree", "never made", nullptr);
    backends.add("brute", "never made", nullptr);
}

} // namespace hone
