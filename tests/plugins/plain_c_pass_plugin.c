// SPDX-License-Identifier: Apache-2.0
/*
 * A pass in plain C99, which proves that the border needs nothing else: it scales depth, and brings
 * a type of its own.
 */
#include "hone_pass.h"

static void scale_range(void* context, size_t begin, size_t end) {
    const hone_run* run = context;
    const float* depth = run->inputs[0]->data;
    float* scaled = run->outputs[0]->data;
    size_t i;
    for (i = begin; i < end; ++i)
        scaled[i] = depth[i] * run->params[0].f;
}

static hone_status execute(hone_pass* pass, const hone_host* host, const hone_run* run,
                           hone_error* error) {
    (void)pass;
    (void)error;
    host->parallel_for(host, run->outputs[0]->count, 3, scale_range, (void*)run);
    return HONE_OK;
}

static const hone_port_type scaled_depth = {.struct_size = sizeof scaled_depth,
                                            .shape = HONE_SHAPE_PLANE,
                                            .name = "ScaledDepth",
                                            .doc = "depth by a factor",
                                            .format = "float",
                                            .unit = "m",
                                            .stride = 4,
                                            .flags = HONE_HAS_MIN};
static const hone_port depth = {.struct_size = sizeof depth,
                                .name = "depth",
                                .type = "Depth",
                                .doc = "view depth",
                                .stride = 4};
static const hone_port scaled = {.struct_size = sizeof scaled,
                                 .name = "scaled",
                                 .type = "ScaledDepth",
                                 .doc = "depth by the factor",
                                 .stride = 4};
static const hone_param factor = {.struct_size = sizeof factor,
                                  .type = HONE_PARAM_FLOAT,
                                  .name = "factor",
                                  .doc = "by which depth is multiplied",
                                  .fallback = 2};

static const hone_port* const inputs[] = {&depth};
static const hone_port* const outputs[] = {&scaled};
static const hone_param* const params[] = {&factor};
static const hone_pass_type scale = {.struct_size = sizeof scale,
                                     .name = "plain_c.scale",
                                     .doc = "Scales depth",
                                     .inputs = inputs,
                                     .input_count = 1,
                                     .outputs = outputs,
                                     .output_count = 1,
                                     .params = params,
                                     .param_count = 1,
                                     .execute = execute};

static const hone_pass_type* const passes[] = {&scale};
static const hone_port_type* const types[] = {&scaled_depth};
static const hone_plugin plugin = {.magic = HONE_PLUGIN_MAGIC,
                                   .struct_size = sizeof plugin,
                                   .abi_major = HONE_PLUGIN_ABI_MAJOR,
                                   .abi_minor = HONE_PLUGIN_ABI_MINOR,
                                   .build = HONE_PLUGIN_BUILD,
                                   .name = "plain_c_pass",
                                   .version = "1.0",
                                   .license = "Apache-2.0",
                                   .doc = "A pass in plain C.",
                                   .passes = passes,
                                   .pass_count = 1,
                                   .port_types = types,
                                   .port_type_count = 1};

const hone_plugin* hone_plugin_entry(uint32_t abi_major, uint32_t abi_minor) {
    return abi_major == HONE_PLUGIN_ABI_MAJOR && abi_minor >= 1 ? &plugin : NULL;
}
