// SPDX-License-Identifier: Apache-2.0
//
// A plug-in with one thing wrong: CMake builds it once for each case. What hone must say of each is
// in tests/support/bad_plugins.cpp.
#include "hone/core/plugin/hone_plugin.h"

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

namespace {

bool is(const char* name) {
    return std::strcmp(HONE_BAD_CASE, name) == 0;
}

hone_status create(const hone_host*, hone_tracer** tracer, hone_error*) {
    static int made;
    *tracer = reinterpret_cast<hone_tracer*>(&made);
    return HONE_OK;
}
void destroy(hone_tracer*) {}
hone_status build(hone_tracer*, const hone_scene*, hone_build_stats*, hone_error*) {
    return HONE_OK;
}
hone_status closest(hone_tracer*, const hone_ray*, hone_hit* hits, size_t count, uint32_t,
                    hone_error*) {
    for (size_t i = 0; i < count; ++i)
        hits[i] = {HONE_NONE, HONE_NONE};
    return HONE_OK;
}
hone_status occluded(hone_tracer*, const hone_ray*, uint32_t* occluded, size_t count, uint32_t,
                     hone_error*) {
    std::memset(occluded, 0, count * sizeof *occluded);
    return HONE_OK;
}

/// Tables as a later minor version would have them: with members that this hone does not know.
struct LaterBackend {
    hone_trace_backend known;
    void (*later)();
};
struct LaterPlugin {
    hone_plugin known;
    void (*later)();
};

const std::string& longText() {
    static const std::string text(2000, 'x');
    return text;
}

} // namespace

#ifdef HONE_BAD_UNDEFINED
extern "C" void hone_nobody_defines_this();
#endif

#ifdef HONE_BAD_NO_ENTRY
#define hone_plugin_entry hone_plugin_entry_by_another_name
extern "C" HONE_PLUGIN_EXPORT const hone_plugin* hone_plugin_entry(uint32_t, uint32_t);
#endif

const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {
#ifdef HONE_BAD_UNDEFINED
    hone_nobody_defines_this();
#endif
    static LaterBackend backend_table, second_table;
    static LaterPlugin plugin_table;
    static const hone_trace_backend* list[2] = {&backend_table.known, &second_table.known};

    hone_trace_backend& backend = backend_table.known;
    backend = {sizeof backend, 0,       "bad", "Sees nothing.", nullptr, nullptr,
               create,         destroy, build, nullptr,         closest, occluded};
    second_table.known = backend;
    second_table.known.name = "bad.second";
    hone_plugin& plugin = plugin_table.known;
    plugin = {HONE_PLUGIN_MAGIC,
              sizeof plugin,
              HONE_PLUGIN_ABI_MAJOR,
              HONE_PLUGIN_ABI_MINOR,
              HONE_PLUGIN_BUILD,
              "bad",
              "1.0",
              "Apache-2.0",
              "A plug-in with one thing wrong.",
              list,
              1,
              nullptr,
              0,
              nullptr,
              0};

    if (is("declines"))
        return nullptr;
    if (is("throws"))
        throw std::runtime_error("the dog ate my \x1b[31mlicence");
    if (is("throws_a_number"))
        throw 42;
    if (is("wrong_magic"))
        plugin.magic = 0x464c457f;
    if (is("newer_major"))
        plugin.abi_major = HONE_PLUGIN_ABI_MAJOR + 1;
    if (is("older_major"))
        plugin.abi_major = HONE_PLUGIN_ABI_MAJOR - 1;
    if (is("newer_minor")) {
        plugin.abi_minor = HONE_PLUGIN_ABI_MINOR + 1;
        plugin.struct_size = sizeof plugin_table;
        backend.struct_size = sizeof backend_table;
        backend.flags = 1u << 31;
    }
    if (is("short_table"))
        plugin.struct_size = offsetof(hone_plugin, port_types) - 1;
    if (is("empty_table"))
        plugin.struct_size = 0;
    if (is("short_backend_table"))
        backend.struct_size = sizeof backend - sizeof(void*);
    if (is("no_name"))
        plugin.name = nullptr;
    if (is("empty_version"))
        plugin.version = "";
    if (is("no_license"))
        plugin.license = nullptr;
    if (is("control_bytes_in_doc"))
        plugin.doc = "\x1b]0;pwned\x07";
    if (is("long_doc"))
        plugin.doc = longText().c_str();
    if (is("control_bytes_in_name"))
        backend.name = "bad\x1b[2J";
    if (is("spaces_in_name"))
        backend.name = "a bad one";
    if (is("long_name"))
        backend.name = longText().c_str() + 1900;
    if (is("called_auto"))
        backend.name = "auto";
    if (is("name_taken"))
        backend.name = "embree";
    if (is("two_of_a_name")) {
        second_table.known.name = backend.name;
        plugin.trace_backend_count = 2;
    }
    if (is("offers_nothing"))
        plugin.trace_backend_count = 0;
    if (is("no_list"))
        plugin.trace_backends = nullptr;
    if (is("no_backend"))
        list[0] = nullptr;
    if (is("a_billion_backends"))
        plugin.trace_backend_count = 1'000'000'000;
    if (is("no_create"))
        backend.create = nullptr;
    if (is("no_destroy"))
        backend.destroy = nullptr;
    if (is("no_build"))
        backend.build = nullptr;
    if (is("no_closest"))
        backend.closest = nullptr;
    if (is("no_occluded"))
        backend.occluded = nullptr;
    if (is("unknown_flags"))
        backend.flags = 1u << 31;
    if (is("passes")) {
        plugin.abi_minor = 0;
        plugin.pass_count = 1;
    }
    if (is("older_minor")) {
        plugin.abi_minor = 0;
        plugin.struct_size = offsetof(hone_plugin, port_types);
        plugin.port_types = reinterpret_cast<const hone_port_type* const*>(list); // not its own
        plugin.port_type_count = 1;
    }
    return &plugin;
}
