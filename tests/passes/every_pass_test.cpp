// SPDX-License-Identifier: Apache-2.0
//
// What every pass must do, tested from its declaration alone: cases for each size, content, list,
// choice and limit that its ports and parameters allow. Meaning is tested in each pass's folder.
#include "hone/backends/embree/embree_backend.h"
#include "hone/core/scene/builtin_scenes.h"
#include "hone/tests/support/each_build.h"
#include "hone/tests/support/port_values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>

namespace hone {
namespace {

using namespace test;

struct PassCase {
    std::string name;
    const PassType* type;
    Build build;
    Content content = Content::kRandom;
    Fill fill = Fill::kSome;
    uvec2 extent{7, 5};
    std::string scene = "cornell";
    bool has_lens = true;
    std::vector<std::string> optionals{}; ///< that are connected
    std::map<std::string, ParamValue> params{};

    friend void PrintTo(const PassCase& each, std::ostream* out) { *out << each.name; }
};

/// What a pass needs in order to be small, or to agree with what is fed to it.
const std::map<std::string, std::map<std::string, ParamValue>> kSetup{
    {"environment_probe", {{"size", 8u}}},
    {"error.self_occlusion", {{"backend", std::string("embree")}, {"rays", 4u}}},
    {"raster", {{"backend", std::string("embree")}}},
    {"shadow_map", {{"size", kMapSize}}},
    {"shadow_range", {{"size", kMapSize}}},
    {"trace", {{"backend", std::string("embree")}}},
};

/// Numbers that are not tried up to the greatest that is allowed: memory or time would not do.
const std::map<std::string, uint> kGreatest{
    {"environment_probe.size", 64}, {"error.self_occlusion.rays", 64},
    {"shadow_map.size", 64},        {"shadow_range.size", kMapSize},
    {"trace.samples", 4},
};

/// Combinations that a pass refuses, by case, and what it says.
const std::map<std::string, std::string> kRefusals{
    {"request_OptionalOnly_counts", "connect the carried accumulation"},
};

/// Passes whose floats are others on a device, by kRelative or kAbsolute at most: Vulkan leaves the
/// rounding of divisions, roots and powers, and whether a product and a sum are rounded once or
/// twice, to the device. All others give the same, up to the sign of 0.
constexpr std::string_view kRoundedPasses[] = {"depth_of_field",  "environment_probe",
                                               "error.propagate", "error.shadow",
                                               "measure.error",   "raster",
                                               "tonemap",         "trace"};
constexpr float kRelative = 4e-6f, kAbsolute = 1e-6f;

bool rasterises(const PassType& type) {
    return type.name == "environment_probe" || type.name == "raster" || type.name == "shadow_map";
}

const PassRegistry& registry() {
    static const PassRegistry all = [] {
        PassRegistry passes;
        registerPasses(passes);
        return passes;
    }();
    return all;
}

const Scene& sceneOf(const std::string& name) {
    static std::map<std::string, Scene> scenes;
    const auto found = scenes.find(name);
    return found != scenes.end() ? found->second
                                 : scenes.emplace(name, makeBuiltinScene(name)).first->second;
}

bool has(const PassType& type, Shape shape) {
    return std::ranges::any_of(type.inputs,
                               [&](const InPort& port) { return port.type.shape == shape; });
}

/// The values other than the default that are worth a case, by how they are called.
std::vector<std::pair<std::string, ParamValue>> valuesToTry(const PassType& type,
                                                            const ParamDecl& decl) {
    if (decl.from_trace_backends)
        return {};
    if (decl.type == ParamType::kBool)
        return {{"flipped", !std::get<bool>(decl.fallback)}};
    if (decl.type == ParamType::kEnum) {
        std::vector<std::pair<std::string, ParamValue>> choices;
        for (const std::string& choice : decl.choices)
            if (ParamValue(choice) != decl.fallback)
                choices.emplace_back(choice, choice);
        return choices;
    }
    const auto limit = kGreatest.find(type.name + "." + decl.name);
    if (decl.type == ParamType::kUint) {
        const double most = decl.max.value_or(std::numeric_limits<uint>::max());
        return {{"least", static_cast<uint>(decl.min.value_or(0))},
                {"most", limit != kGreatest.end() ? limit->second : static_cast<uint>(most)}};
    }
    constexpr float kMost = std::numeric_limits<float>::max();
    return {{"least", static_cast<float>(decl.min.value_or(-kMost))},
            {"most", static_cast<float>(decl.max.value_or(kMost))}};
}

void addCases(const PassType& type, Build build, std::vector<PassCase>& cases) {
    PassCase usual{.name = type.name + "_", .type = &type, .build = build};
    std::ranges::replace(usual.name, '.', '_');
    if (const auto setup = kSetup.find(type.name); setup != kSetup.end())
        usual.params = setup->second;
    for (const InPort& port : type.inputs)
        if (port.optional)
            usual.optionals.push_back(port.name);
    const auto add = [&](const std::string& name) -> PassCase& {
        PassCase& added = cases.emplace_back(usual);
        added.name += name;
        return added;
    };

    for (const uvec2 size : {uvec2(1, 1), uvec2(7, 5), uvec2(1, 9), uvec2(9, 1), uvec2(33, 2)})
        add("Size" + std::to_string(size.x) + "x" + std::to_string(size.y)).extent = size;
    add("Zeros").content = Content::kZeros;
    add("Extremes").content = Content::kExtremes;
    add("Hostile").content = Content::kHostile;
    if (has(type, Shape::kList) ||
        std::ranges::any_of(type.inputs, [](const InPort& port) { return port.variadic; })) {
        add("ListsEmpty").fill = Fill::kEmpty;
        add("ListsFull").fill = Fill::kFull;
    }
    if (!usual.optionals.empty())
        add("OptionalNone").optionals.clear();
    for (const std::string& port : usual.optionals)
        add("OptionalOnly_" + port).optionals = {port};
    if (has(type, Shape::kCamera))
        add("Pinhole").has_lens = false;
    if (has(type, Shape::kScene))
        for (const char* scene :
             {"empty", "alpha_quad", "two_sided", "straight_edge", "planar_mirror"})
            add(std::string("Scene_") + scene).scene = scene;
    for (const ParamDecl& decl : type.params)
        for (const auto& [name, value] : valuesToTry(type, decl)) {
            add(decl.name + "_" + name).params[decl.name] = value;
            // Where failed metrics meet each mode, and great numbers great parameters.
            const bool is_enum = decl.type == ParamType::kEnum;
            PassCase& harder = add((is_enum ? "Hostile_" : "Extreme_") + decl.name + "_" + name);
            harder.params[decl.name] = value;
            harder.content = is_enum ? Content::kHostile : Content::kExtremes;
        }
}

std::vector<PassCase> casesOf(Build build) {
    std::vector<PassCase> cases;
    for (const PassType& type : registry().all())
        if (build == Build::kHost || type.domain != Domain::kHost)
            addCases(type, build, cases);
    return cases;
}

Frame frameOf(const PassCase& each) {
    const Scene& scene = sceneOf(each.scene);
    Frame frame{.scene = &scene, .extent = each.extent, .content = each.content};
    frame.fill = each.fill;
    frame.has_tiny = each.build == Build::kHost; // devices may take them for 0
    CameraDesc camera = scene.camera("");
    if (each.has_lens) {
        camera.focus = 0.7f * glm::distance(camera.position, camera.target);
        camera.aperture = 0.2f * camera.focus;
    }
    frame.camera = makeCamera(camera);
    return frame;
}

bool isConnected(const PassCase& each, const std::string& input) {
    return !each.type->findIn(input)->optional || std::ranges::count(each.optionals, input) > 0;
}

/// The valid bytes of each output.
using Outputs = std::map<std::string, std::vector<std::byte>>;

Outputs outputsOf(const PassRun& run, const PassType& type) {
    Outputs outputs;
    for (const OutPort& port : type.outputs) {
        const Value& value = run.value(port.name);
        const std::size_t bytes = std::size_t{value.count} * port.type.stride;
        outputs[port.name].assign(value.buffer.data, value.buffer.data + bytes);
    }
    return outputs;
}

class EveryPass : public VulkanTest, public testing::WithParamInterface<PassCase> {
protected:
    void SetUp() override {
        if (GetParam().build == Build::kDevice || rasterises(*GetParam().type))
            VulkanTest::SetUp();
    }

    static PassRun passOn(Build build) {
        const PassType& type = *GetParam().type;
        if (build == Build::kHost && !rasterises(type))
            return PassRun(type);
        return PassRun(type, device(), build == Build::kHost);
    }

    /// Sets all up but does not execute.
    static void prepare(PassRun& run, const Frame& frame) {
        const PassCase& each = GetParam();
        run.extent(frame.extent).seed(7).iteration(1).tracers(backends());
        if (has(*each.type, Shape::kScene))
            run.scene(*frame.scene);
        run.camera(frame.camera);
        for (const auto& [name, value] : each.params)
            run.param(name, value);
        for (const InPort& port : each.type->inputs) {
            if (!isConnected(each, port.name) || port.type.stride == 0)
                continue;
            const uint edges = !port.variadic               ? 1
                               : frame.fill == Fill::kEmpty ? 1
                               : frame.fill == Fill::kSome  ? 3
                                                            : uint{InPort::kMaxEdges};
            for (uint edge = 0; edge < edges; ++edge)
                feedPort(run, port, frame, edge);
        }
    }
    static const TraceBackendRegistry& backends() {
        static const TraceBackendRegistry embree = [] {
            TraceBackendRegistry registry;
            registry.add("embree", "Embree", [](const Devices&) { return makeEmbreeBackend(); });
            return registry;
        }();
        return embree;
    }

    static Outputs executed(Build build, const Frame& frame) {
        PassRun run = passOn(build);
        prepare(run, frame);
        return outputsOf(run.execute(), *GetParam().type);
    }
};

float numberAt(const std::vector<std::byte>& bytes, std::size_t index) {
    float number = 0;
    std::memcpy(&number, &bytes[index * sizeof(float)], sizeof(float));
    return number;
}

void expectNear(const Outputs& host, const Outputs& device, const PassType& type) {
    const bool is_rounded = std::ranges::count(kRoundedPasses, type.name) > 0;
    for (const auto& [port, on_host] : host) {
        ASSERT_EQ(on_host.size(), device.at(port).size()) << port;
        for (std::size_t i = 0; i < on_host.size() / sizeof(float); ++i) {
            const float a = numberAt(on_host, i), b = numberAt(device.at(port), i);
            const bool is_same = a == b || std::bit_cast<uint>(a) == std::bit_cast<uint>(b) ||
                                 (std::isnan(a) && std::isnan(b));
            const bool is_near =
                is_rounded && std::abs(a - b) <= kAbsolute + kRelative * std::abs(a);
            ASSERT_TRUE(is_same || is_near) << "number " << i << " of " << port << " is " << a
                                            << " on the host and " << b << " on the device";
        }
    }
}

/// What is rounded otherwise may be smaller by that.
void expectNotSmaller(const Outputs& greater, const Outputs& less, const PassType& type) {
    for (const OutPort& port : type.outputs) {
        const std::size_t numbers =
            port.type == types::kError ? less.at(port.name).size() / sizeof(float) : 0;
        for (std::size_t i = 0; i < numbers; ++i) {
            const float before = numberAt(less.at(port.name), i);
            ASSERT_GE(numberAt(greater.at(port.name), i), before - 1e-6f * before)
                << "number " << i << " of " << port.name << " became smaller";
        }
    }
}

TEST_P(EveryPass, KeepsItsContract) {
    const PassCase& each = GetParam();
    const Frame frame = frameOf(each);

    PassRun run = passOn(each.build);
    prepare(run, frame);
    if (const auto refusal = kRefusals.find(each.name); refusal != kRefusals.end()) {
        try {
            run.execute();
            ADD_FAILURE() << "is not refused";
        } catch (const GraphError& error) {
            EXPECT_NE(std::string(error.what()).find(refusal->second), std::string::npos)
                << error.what();
        }
        return;
    }
    run.execute();
    for (const OutPort& port : each.type->outputs)
        if (const std::string problem = problemOf(run.value(port.name), frame); !problem.empty())
            ADD_FAILURE() << port.name << ": " << problem;
    const Outputs outputs = outputsOf(run, *each.type);

    PassRun on_old_memory = passOn(each.build);
    prepare(on_old_memory, frame);
    on_old_memory.dirtyOutputs().execute();
    EXPECT_TRUE(outputsOf(on_old_memory, *each.type) == outputs)
        << "a second run, in memory that was used before, gives something else";
    if (std::ranges::all_of(each.type->outputs,
                            [](const OutPort& port) { return port.in_place_of.empty(); })) {
        run.execute();
        EXPECT_TRUE(outputsOf(run, *each.type) == outputs) << "executed again, it does not repeat";
    }
    for (const OutPort& port : each.type->outputs)
        if (!port.in_place_of.empty() && !isConnected(each, port.in_place_of)) {
            PassRun on_zeros = passOn(each.build);
            prepare(on_zeros, frame);
            on_zeros.bytes(port.in_place_of, std::vector<std::byte>(outputs.at(port.name).size()));
            EXPECT_TRUE(outputsOf(on_zeros.execute(), *each.type) == outputs)
                << port.in_place_of << ": zeros are not the same as nothing";
        }
    if (each.build == Build::kDevice)
        expectNear(executed(Build::kHost, frame), outputs, *each.type);
}

TEST(EveryRasterisingPass, SaysThatThereIsNoDevice) {
    for (const char* name : {"environment_probe", "raster", "shadow_map"}) {
        const Scene& scene = sceneOf("cornell");
        PassRun run(*registry().find(name));
        run.extent({7, 5}).scene(scene).camera(makeCamera(scene.camera("")));
        try {
            run.execute();
            ADD_FAILURE() << name << " drew without a device";
        } catch (const DeviceError& error) {
            EXPECT_NE(std::string(error.what()).find("there is no Vulkan device"),
                      std::string::npos)
                << error.what();
        }
    }
}

/// With the cases of passes that promise something.
class EveryPromise : public EveryPass {};

TEST_P(EveryPromise, IsKept) {
    const PassCase& each = GetParam();
    const Frame frame = frameOf(each);
    const Outputs outputs = executed(each.build, frame);
    for (const Promise promise : each.type->promised) {
        Frame other = frame;
        if (promise == Promise::kPixelwise) {
            other.is_reversed = true;
            for (const auto& [port, turned] : executed(each.build, other))
                EXPECT_TRUE(reversed(turned, each.type->findOut(port)->type.stride) ==
                            outputs.at(port))
                    << port << " of the same pixels in another order is something else";
        } else {
            other.has_greater_errors = true;
            expectNotSmaller(executed(each.build, other), outputs, *each.type);
        }
    }
}

std::vector<PassCase> promisedCasesOf(Build build) {
    std::vector<PassCase> cases = casesOf(build);
    std::erase_if(cases, [](const PassCase& each) { return each.type->promised.empty(); });
    return cases;
}

const auto kNameOf = [](const auto& each) { return each.param.name; };
INSTANTIATE_TEST_SUITE_P(OnHost, EveryPass, testing::ValuesIn(casesOf(Build::kHost)), kNameOf);
INSTANTIATE_TEST_SUITE_P(OnDevice, EveryPass, testing::ValuesIn(casesOf(Build::kDevice)), kNameOf);
INSTANTIATE_TEST_SUITE_P(OnHost, EveryPromise, testing::ValuesIn(promisedCasesOf(Build::kHost)),
                         kNameOf);
INSTANTIATE_TEST_SUITE_P(OnDevice, EveryPromise, testing::ValuesIn(promisedCasesOf(Build::kDevice)),
                         kNameOf);

} // namespace
} // namespace hone
