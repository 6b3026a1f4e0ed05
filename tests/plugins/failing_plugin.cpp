// SPDX-License-Identifier: Apache-2.0
//
// A plug-in whose tables are sound and whose trace backends fail, each at another place: its name
// says how.
#include "hone/core/plugin/hone_plugin.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <stdexcept>

struct hone_tracer {
    const hone_host* host;
};

namespace {

hone_status fail(hone_error* error, const char* text, hone_status status = HONE_FAILED) {
    std::strcpy(error->text, text);
    return status;
}

hone_status create(const hone_host* host, hone_tracer** tracer, hone_error*) {
    *tracer = new hone_tracer{host};
    return HONE_OK;
}
void destroy(hone_tracer* tracer) {
    delete tracer;
}
hone_status build(hone_tracer*, const hone_scene*, hone_build_stats*, hone_error*) {
    return HONE_OK;
}
template <uint32_t instance, uint32_t primitive>
hone_status answer(hone_tracer*, const hone_ray*, hone_hit* hits, size_t count, uint32_t,
                   hone_error*) {
    std::fill_n(hits, count, hone_hit{instance, primitive});
    return HONE_OK;
}
template <uint32_t value>
hone_status answer(hone_tracer*, const hone_ray*, uint32_t* occluded, size_t count, uint32_t,
                   hone_error*) {
    std::fill_n(occluded, count, value);
    return HONE_OK;
}

constexpr hone_trace_backend good(const char* name) {
    return {sizeof(hone_trace_backend),
            0,
            name,
            "Fails as its name says.",
            nullptr,
            nullptr,
            create,
            destroy,
            build,
            nullptr,
            answer<HONE_NONE, HONE_NONE>,
            answer<0>};
}

std::array<hone_trace_backend, 20> backends() {
    std::array<hone_trace_backend, 20> all{};
    std::size_t count = 0;
    const auto add = [&](const char* name) -> hone_trace_backend& {
        return all.at(count++) = good(name);
    };
    add("create_fails").create = [](const hone_host*, hone_tracer**, hone_error* error) {
        return fail(error, "no licence server\x1b[31m");
    };
    add("create_has_no_device").create = [](const hone_host*, hone_tracer**, hone_error* error) {
        return fail(error, "plug in the card", HONE_NO_DEVICE);
    };
    add("create_has_no_memory").create = [](const hone_host*, hone_tracer**, hone_error* error) {
        return fail(error, "4 GiB wanted", HONE_OUT_OF_MEMORY);
    };
    add("create_gives_no_reason").create = [](const hone_host*, hone_tracer**, hone_error*) {
        return hone_status{HONE_FAILED};
    };
    add("create_makes_nothing").create = [](const hone_host*, hone_tracer**, hone_error*) {
        return hone_status{HONE_OK};
    };
    add("create_throws").create = [](const hone_host*, hone_tracer**, hone_error*) -> hone_status {
        throw std::runtime_error("lost my keys");
    };
    add("destroy_throws").destroy = [](hone_tracer* tracer) {
        delete tracer;
        throw 1;
    };
    add("build_fails").build = [](hone_tracer*, const hone_scene*, hone_build_stats*,
                                  hone_error* error) { return fail(error, "too many triangles"); };
    add("build_throws").build = [](hone_tracer*, const hone_scene*, hone_build_stats*,
                                   hone_error*) -> hone_status { throw std::bad_alloc(); };
    hone_trace_backend& update = add("update_fails");
    update.update = [](hone_tracer*, const hone_scene*, const uint32_t*, size_t, hone_build_stats*,
                       hone_error* error) { return fail(error, "cannot move"); };
    add("closest_fails").closest = [](hone_tracer*, const hone_ray*, hone_hit*, size_t, uint32_t,
                                      hone_error* error) { return fail(error, "bored"); };
    add("closest_throws").closest = [](hone_tracer*, const hone_ray*, hone_hit*, size_t, uint32_t,
                                       hone_error*) -> hone_status { throw 7; };
    add("closest_ends_oddly").closest = [](hone_tracer*, const hone_ray*, hone_hit*, size_t,
                                           uint32_t, hone_error*) { return hone_status{-77}; };
    add("closest_writes_no_end").closest = [](hone_tracer*, const hone_ray*, hone_hit*, size_t,
                                              uint32_t, hone_error* error) {
        std::memset(error->text, 'x', sizeof error->text);
        return hone_status{HONE_FAILED};
    };
    add("closest_names_no_instance").closest = answer<1'000'000, 0>;
    add("closest_names_no_primitive").closest = answer<0, 1'000'000>;
    add("closest_names_half").closest = answer<HONE_NONE, 0>;
    add("occluded_fails").occluded = [](hone_tracer*, const hone_ray*, uint32_t*, size_t, uint32_t,
                                        hone_error* error) { return fail(error, "too dark"); };
    add("occluded_throws").occluded = [](hone_tracer*, const hone_ray*, uint32_t*, size_t, uint32_t,
                                         hone_error*) -> hone_status {
        throw std::logic_error("dusk");
    };
    add("occluded_says_two").occluded = answer<2>;
    return all;
}

} // namespace

const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {
    static const auto tables = backends();
    static const auto list = [] {
        std::array<const hone_trace_backend*, tables.size()> pointers{};
        for (std::size_t i = 0; i < tables.size(); ++i)
            pointers[i] = &tables[i];
        return pointers;
    }();
    static const hone_plugin plugin{HONE_PLUGIN_MAGIC,
                                    sizeof(hone_plugin),
                                    HONE_PLUGIN_ABI_MAJOR,
                                    HONE_PLUGIN_ABI_MINOR,
                                    HONE_PLUGIN_BUILD,
                                    "failing",
                                    "1.0",
                                    "Apache-2.0",
                                    "Trace backends that fail.",
                                    list.data(),
                                    list.size(),
                                    nullptr,
                                    0,
                                    nullptr,
                                    0};
    return &plugin;
}
