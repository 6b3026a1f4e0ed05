// SPDX-License-Identifier: Apache-2.0
//
// Passes of the C++ layer that tests run: each shows its test what it was given.
#include "hone/core/plugin/hone_pass.hpp"

#include <cmath>
#include <cstring>
#include <string>

namespace {

namespace hp = hone::plugin;

constexpr hone_port_type kTold{.struct_size = sizeof(hone_port_type),
                               .shape = HONE_SHAPE_RECORD,
                               .name = "Told",
                               .doc = "what a pass was told, as floats",
                               .format = "float",
                               .unit = nullptr,
                               .stride = 4,
                               .flags = 0,
                               .min = 0,
                               .max = 0};

std::size_t sixteen(const hone_size_query*) {
    return 16;
}

/// Tells its parameters and what else it was told.
struct Tell {
    enum class Mode { kOne, kTwo, kThree };
    hp::Out<float> told;
    bool flag = true;
    std::uint32_t number = 7;
    float share = 0.25f;
    Mode mode = Mode::kTwo;
    int executions = 0;

    static void declare(hp::Declare<Tell>& pass) {
        pass.called("test.tell", "Tells what it was told");
        pass.out(&Tell::told, "told", kTold, "everything", sixteen);
        pass.param(&Tell::flag, "flag", "a flag");
        pass.param(&Tell::number, "number", "a number", {.min = 1, .max = 9, .unit = "px"});
        pass.param(&Tell::share, "share", "a share", {.min = 0});
        pass.choice(&Tell::mode, "mode", {"one", "two", "three"}, "a choice");
        pass.counter("told.things");
        pass.counter("told.times");
    }
    void execute(const hp::Run& run) {
        const float all[] = {flag ? 1.0f : 0.0f,
                             static_cast<float>(number),
                             share,
                             static_cast<float>(mode),
                             static_cast<float>(run.width()),
                             static_cast<float>(run.height()),
                             static_cast<float>(run.seed()),
                             static_cast<float>(run.iteration()),
                             static_cast<float>(++executions)};
        for (float& value : told)
            value = 0;
        std::copy(std::begin(all), std::end(all), told.begin());
        run.count(0, 9);
        run.count(1, 1);
    }
};

/// sum of weight * plane, plus 100 where the optional plane is there.
struct Mix {
    hp::Many<float> planes;
    hp::In<float> offset;
    hp::Out<float> sum;

    static void declare(hp::Declare<Mix>& pass) {
        pass.called("test.mix", "Adds planes by weight");
        pass.inMany(&Mix::planes, "planes", "Depth", "what is added",
                    {hp::edgeParam("weight", 1, "by which", {.min = 0}),
                     hp::edgeParam("bias", 0, "added on top")});
        pass.inOptional(&Mix::offset, "offset", "Depth", "added once");
        pass.out(&Mix::sum, "sum", "Depth", "the sum");
    }
    void execute(const hp::Run& run) {
        run.forEachPixel([this](int x, int y) {
            float value = offset ? offset(x, y) : 0;
            for (const hp::In<float>& plane : planes)
                value += plane.param(0).f * plane(x, y) + plane.param(1).f;
            sum(x, y) = value;
        });
    }
};

/// Lists the pixels that are nearer than a limit.
struct Near {
    hp::In<float> depth;
    hp::Out<std::uint32_t> pixels;
    float limit = 1;

    static void declare(hp::Declare<Near>& pass) {
        pass.called("test.near", "Lists near pixels");
        pass.in(&Near::depth, "depth", "Depth", "of what");
        pass.out(&Near::pixels, "pixels", "PixelList", "those, ascending",
                 [](const hone_size_query* query) { return query->capacities[0] / 2; });
        pass.param(&Near::limit, "limit", "in metres", {.unit = "m"});
    }
    void execute(const hp::Run&) {
        for (std::uint32_t i = 0; i < depth.size(); ++i)
            if (depth[i] < limit)
                pixels.push(i);
    }
};

/// Adds one to a plane that it takes over.
struct Increase {
    hp::In<float> before;
    hp::Out<float> after;

    static void declare(hp::Declare<Increase>& pass) {
        pass.called("test.increase", "Adds one");
        pass.inOptional(&Increase::before, "before", "Depth", "what begins");
        pass.outInPlace(&Increase::after, "after", "Depth", "before", "one more");
    }
    void execute(const hp::Run&) {
        for (float& value : after)
            value += 1;
    }
};

/// Tells about scene and camera.
struct Look {
    const hone_scene* scene = nullptr;
    const hone_camera* camera = nullptr;
    hp::Out<float> told;

    static void declare(hp::Declare<Look>& pass) {
        pass.called("test.look", "Tells about scene and camera");
        pass.in(&Look::scene, "scene", "the scene");
        pass.in(&Look::camera, "camera", "the camera");
        pass.out(&Look::told, "told", kTold, "everything", sixteen);
    }
    void execute(const hp::Run& run) {
        for (float& value : told)
            value = 0;
        const auto corner = run.host.worldPosition(*scene, 0, 0);
        told[0] = static_cast<float>(scene->instance_count);
        told[1] = static_cast<float>(scene->triangle_count);
        std::copy(corner.begin(), corner.end(), &told[2]);
        std::copy(camera->position, camera->position + 3, &told[5]);
        told[8] = camera->focus;
    }
};

/// Fills its plane a row an execution, until it is through.
struct Patient {
    hp::Out<float> plane;
    std::uint32_t row = 0;

    static void declare(hp::Declare<Patient>& pass) {
        pass.called("test.patient", "Fills a plane, row by row");
        pass.out(&Patient::plane, "plane", "Depth", "the row's number");
    }
    void execute(const hp::Run& run) {
        if (!run.goesOn())
            row = 0;
        for (; static_cast<int>(row) < run.height();) {
            for (int x = 0; x < run.width(); ++x)
                plane(x, static_cast<int>(row)) = static_cast<float>(row);
            ++row;
            if (static_cast<int>(row) < run.height())
                run.pause();
        }
    }
};

using All = hp::Passes<Tell, Mix, Near, Increase, Look, Patient>;

} // namespace

HONE_PASS_PLUGIN(All, {.name = "good_passes",
                       .version = "1.0",
                       .license = "Apache-2.0",
                       .doc = "Passes that say what they were given."})
