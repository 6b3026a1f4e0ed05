// SPDX-License-Identifier: Apache-2.0
//
// A plug-in that offers a pass and has one thing wrong: what, the variable HONE_BAD_PASS says. What
// hone must say of each is in tests/support/bad_plugins.cpp. Without the variable nothing is wrong.
#include "hone/core/plugin/hone_pass.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace {

bool is(const char* name) {
    const char* wanted = std::getenv("HONE_BAD_PASS");
    return wanted != nullptr && std::strcmp(wanted, name) == 0;
}

hone_status create(const hone_host*, hone_pass** pass, hone_error*) {
    static int made;
    *pass = reinterpret_cast<hone_pass*>(&made);
    return HONE_OK;
}
void destroy(hone_pass*) {}
hone_status execute(hone_pass*, const hone_host*, const hone_run* run, hone_error*) {
    for (size_t i = 0; i < run->output_count; ++i)
        std::memset(run->outputs[i]->data, 0, run->outputs[i]->capacity * 4);
    return HONE_OK;
}
size_t size(const hone_size_query*) {
    return 1;
}

hone_port port(const char* name, const char* type, uint32_t stride) {
    return {sizeof(hone_port), 0, name, type, "A port.", stride, 0, nullptr, nullptr, nullptr};
}
hone_param param(const char* name, uint32_t type) {
    return {sizeof(hone_param), type, name, "A parameter.", nullptr, 0, 0, 0, 0, 0, nullptr};
}
hone_port_type portType(const char* name) {
    return {
        sizeof(hone_port_type), HONE_SHAPE_PLANE, name, "A type.", nullptr, nullptr, 4, 0, 0, 0};
}

/// Everything that a case may spoil. Good as it is made: one input, one output of a type of its
/// own, one parameter of each type.
struct Tables {
    hone_port inputs[2] = {port("depth", "Depth", 4), port("more", "Depth", 4)};
    hone_port outputs[2] = {port("result", "Badness", 4), port("more", "Depth", 4)};
    hone_param params[4] = {param("flag", HONE_PARAM_BOOL), param("number", HONE_PARAM_UINT),
                            param("share", HONE_PARAM_FLOAT), param("mode", HONE_PARAM_ENUM)};
    hone_port_type types[2] = {portType("Badness"), portType("Goodness")};
    hone_pass_type passes[2]{};
    hone_plugin plugin{};

    const char* choices[2] = {"one", "two"};
    const char* counters[1] = {"things"};
    const hone_port* input_list[2] = {&inputs[0], &inputs[1]};
    const hone_port* output_list[2] = {&outputs[0], &outputs[1]};
    const hone_param* param_list[4] = {&params[0], &params[1], &params[2], &params[3]};
    const hone_port_type* type_list[2] = {&types[0], &types[1]};
    const hone_pass_type* pass_list[2] = {&passes[0], &passes[1]};

    Tables() {
        params[3].choices = choices;
        params[3].choice_count = 2;
        passes[0] = {sizeof(hone_pass_type),
                     0,
                     "bad.pass",
                     "Does little.",
                     input_list,
                     1,
                     output_list,
                     1,
                     param_list,
                     4,
                     counters,
                     1,
                     create,
                     destroy,
                     execute};
        passes[1] = passes[0];
        passes[1].name = "bad.second";
        plugin = {HONE_PLUGIN_MAGIC,
                  sizeof plugin,
                  HONE_PLUGIN_ABI_MAJOR,
                  HONE_PLUGIN_ABI_MINOR,
                  HONE_PLUGIN_BUILD,
                  "bad",
                  "1.0",
                  "Apache-2.0",
                  "A plug-in with one thing wrong.",
                  nullptr,
                  0,
                  pass_list,
                  1,
                  type_list,
                  1};
    }
};

void spoilPass(Tables& t) {
    hone_pass_type& pass = t.passes[0];
    if (is("a_billion_passes"))
        t.plugin.pass_count = 1'000'000'000;
    if (is("no_list_of_passes"))
        t.plugin.passes = nullptr;
    if (is("no_pass"))
        t.pass_list[0] = nullptr;
    if (is("two_passes_of_a_name")) {
        t.passes[1].name = "bad.pass";
        t.plugin.pass_count = 2;
    }
    if (is("second_pass_is_bad")) {
        t.passes[1].execute = nullptr;
        t.plugin.pass_count = 2;
    }
    if (is("short_pass"))
        pass.struct_size = sizeof pass - sizeof(void*);
    if (is("pass_without_name"))
        pass.name = nullptr;
    if (is("pass_name_with_control_bytes"))
        pass.name = "bad\x1b[2J";
    if (is("pass_name_with_capitals"))
        pass.name = "Bad";
    if (is("pass_called_glsl"))
        pass.name = "glsl";
    if (is("pass_name_taken"))
        pass.name = "sort";
    if (is("pass_without_doc"))
        pass.doc = "";
    if (is("pass_with_unknown_flags"))
        pass.flags = 1;
    if (is("no_execute"))
        pass.execute = nullptr;
    if (is("no_destroy"))
        pass.destroy = nullptr;
    if (is("no_create"))
        pass.create = nullptr;
    if (is("no_output"))
        pass.output_count = 0;
    if (is("no_list_of_inputs"))
        pass.inputs = nullptr;
    if (is("no_input"))
        t.input_list[0] = nullptr;
    if (is("a_million_inputs"))
        pass.input_count = 1'000'000;
    if (is("no_counter"))
        t.counters[0] = nullptr;
    if (is("counter_with_spaces"))
        t.counters[0] = "all things";
}

void spoilPort(Tables& t) {
    hone_port& in = t.inputs[0];
    hone_port& out = t.outputs[0];
    if (is("short_port"))
        in.struct_size = 8;
    if (is("port_name_with_dot"))
        in.name = "depth.of";
    if (is("port_without_doc"))
        in.doc = nullptr;
    if (is("two_inputs_of_a_name")) {
        t.inputs[1].name = in.name;
        t.passes[0].input_count = 2;
    }
    if (is("two_outputs_of_a_name")) {
        t.outputs[1].name = out.name;
        t.passes[0].output_count = 2;
    }
    if (is("unknown_type"))
        in.type = "Depht";
    if (is("wrong_stride"))
        in.stride = 8;
    if (is("zero_stride"))
        in.stride = 0;
    if (is("curve"))
        in = port("curve", "Curve", 0);
    if (is("output_of_a_scene"))
        out = port("scene", "Scene", 0);
    if (is("input_with_unknown_flags"))
        in.flags = 1u << 20;
    if (is("optional_output"))
        out.flags = HONE_PORT_OPTIONAL;
    if (is("input_with_size"))
        in.size = size;
    if (is("in_place_of_nothing"))
        out.in_place_of = "dept";
    if (is("in_place_of_another_type"))
        out.in_place_of = "depth";
    if (is("in_place_of_several")) {
        in.flags = HONE_PORT_VARIADIC;
        t.outputs[0] = port("result", "Depth", 4);
        out.in_place_of = "depth";
    }
    if (is("in_place_twice")) {
        t.outputs[0] = port("result", "Depth", 4);
        t.outputs[0].in_place_of = t.outputs[1].in_place_of = "depth";
        t.passes[0].output_count = 2;
    }
    if (is("list_without_size"))
        out = port("result", "PixelList", 4);
    if (is("hits_without_scene"))
        out = port("result", "Hits", 8);
    if (is("parameters_of_a_single_edge")) {
        in.params = t.param_list;
        in.param_count = 1;
    }
    if (is("edge_parameter_called_from")) {
        in.flags = HONE_PORT_VARIADIC;
        in.params = &t.param_list[2];
        in.param_count = 1;
        t.params[2].name = "from";
        t.passes[0].param_count = 0;
    }
}

void spoilParam(Tables& t) {
    hone_param& number = t.params[1];
    hone_param& share = t.params[2];
    hone_param& mode = t.params[3];
    if (is("short_param"))
        number.struct_size = 0;
    if (is("unknown_param_type"))
        number.type = 4;
    if (is("param_doc_with_control_bytes"))
        number.doc = "\x1b]0;pwned\x07";
    if (is("two_params_of_a_name"))
        number.name = "share";
    if (is("range_upside_down")) {
        share.min = 2;
        share.max = 1;
        share.flags = HONE_HAS_MIN | HONE_HAS_MAX;
    }
    if (is("range_of_nan")) {
        share.min = std::nan("");
        share.flags = HONE_HAS_MIN;
    }
    if (is("default_outside")) {
        share.max = -1;
        share.flags = HONE_HAS_MAX;
    }
    if (is("default_of_nan"))
        share.fallback = std::nan("");
    if (is("default_not_whole"))
        number.fallback = 1.5;
    if (is("default_negative"))
        number.fallback = -1;
    if (is("flag_of_two"))
        t.params[0].fallback = 2;
    if (is("flag_with_range"))
        t.params[0].flags = HONE_HAS_MIN;
    if (is("number_with_choices"))
        number.choice_count = 1;
    if (is("no_choices"))
        mode.choice_count = 0;
    if (is("no_list_of_choices"))
        mode.choices = nullptr;
    if (is("choice_with_spaces"))
        t.choices[0] = "number one";
    if (is("two_choices_of_a_name"))
        t.choices[1] = "one";
    if (is("default_beyond_choices"))
        mode.fallback = 2;
}

void spoilType(Tables& t) {
    hone_port_type& type = t.types[0];
    if (is("short_type"))
        type.struct_size = sizeof type - 8;
    if (is("no_list_of_types"))
        t.plugin.port_types = nullptr;
    if (is("type_in_small_letters"))
        type.name = "badness";
    if (is("type_of_no_bytes"))
        type.stride = 0;
    if (is("type_of_odd_bytes"))
        type.stride = 6;
    if (is("type_of_many_bytes"))
        type.stride = 4096;
    if (is("type_of_no_shape"))
        type.shape = 3;
    if (is("type_of_no_format"))
        type.format = "half";
    if (is("type_of_another_format"))
        type.format = "vec3";
    if (is("range_without_format")) {
        type.flags = HONE_HAS_MIN;
    }
    if (is("type_range_upside_down")) {
        type.format = "float";
        type.flags = HONE_HAS_MIN | HONE_HAS_MAX;
        type.min = 1;
    }
    if (is("two_types_of_a_name")) {
        t.types[1].name = type.name;
        t.plugin.port_type_count = 2;
    }
    if (is("hones_type_otherwise"))
        type.name = "Radiance";
}

} // namespace

const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {
    static Tables tables;
    spoilPass(tables);
    spoilPort(tables);
    spoilParam(tables);
    spoilType(tables);
    if (is("nothing"))
        tables.plugin.pass_count = 0;
    return &tables.plugin;
}
