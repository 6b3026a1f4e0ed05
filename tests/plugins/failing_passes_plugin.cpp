// SPDX-License-Identifier: Apache-2.0
//
// A plug-in whose tables are sound and whose passes fail, each at another place: its name says how.
#include "hone/core/plugin/hone_pass.h"

#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

hone_status fail(hone_error* error, const char* text, hone_status status = HONE_FAILED) {
    std::strcpy(error->text, text);
    return status;
}

hone_status create(const hone_host*, hone_pass** pass, hone_error*) {
    *pass = reinterpret_cast<hone_pass*>(new int);
    return HONE_OK;
}
void destroy(hone_pass* pass) {
    delete reinterpret_cast<int*>(pass);
}
/// Writes zeros.
hone_status execute(hone_pass*, const hone_host*, const hone_run* run, hone_error*) {
    for (size_t i = 0; i < run->output_count; ++i)
        std::memset(run->outputs[i]->data, 0, run->outputs[i]->capacity * 4);
    return HONE_OK;
}

/// Writes zeros, but for one number.
template <int index> hone_status writeOne(const hone_run* run, float value) {
    (void)execute(nullptr, nullptr, run, nullptr);
    static_cast<float*>(run->outputs[0]->data)[index] = value;
    return HONE_OK;
}
/// Lists one element of these words.
template <size_t words>
hone_status listOne(const hone_run* run, const std::array<uint32_t, words>& element) {
    std::memcpy(run->outputs[0]->data, element.data(), sizeof element);
    run->outputs[0]->count = 1;
    return HONE_OK;
}

hone_port port(const char* name, const char* type, uint32_t stride) {
    return {sizeof(hone_port), 0, name, type, "A port.", stride, 0, nullptr, nullptr, nullptr};
}

/// A pass type and what it points to.
struct Type {
    hone_port output;
    hone_port scene = port("scene", "Scene", 0);
    const hone_port* outputs[1] = {&output};
    const hone_port* inputs[1] = {&scene};
    hone_pass_type table;

    Type(const char* name, const char* type, uint32_t stride)
        : output(port("result", type, stride)), table{sizeof table, 0,
                                                      name,         "Fails as its name says.",
                                                      inputs,       0,
                                                      outputs,      1,
                                                      nullptr,      0,
                                                      nullptr,      0,
                                                      create,       destroy,
                                                      execute} {}
    Type(const Type&) = delete;
    Type& operator=(const Type&) = delete;
};

struct AllTypes {
    std::deque<Type> types;
    std::vector<const hone_pass_type*> list;

    hone_pass_type& add(const char* name, const char* type = "Error", uint32_t stride = 8) {
        hone_pass_type& table = types.emplace_back(name, type, stride).table;
        list.push_back(&table);
        return table;
    }
    hone_pass_type& addList(const char* name, const char* type, uint32_t stride,
                            size_t (*size)(const hone_size_query*)) {
        hone_pass_type& table = add(name, type, stride);
        types.back().output.size = size;
        return table;
    }
    AllTypes();
};

#define EXECUTE                                                                                    \
    [](hone_pass*, const hone_host*, [[maybe_unused]] const hone_run* run,                         \
       [[maybe_unused]] hone_error* error) -> hone_status

AllTypes::AllTypes() {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto four = [](const hone_size_query*) { return size_t{4}; };

    add("create_fails").create = [](const hone_host*, hone_pass**, hone_error* error) {
        return fail(error, "no licence server\x1b[31m");
    };
    add("create_has_no_device").create = [](const hone_host*, hone_pass**, hone_error* error) {
        return fail(error, "plug in the card", HONE_NO_DEVICE);
    };
    add("create_has_no_memory").create = [](const hone_host*, hone_pass**, hone_error* error) {
        return fail(error, "4 GiB wanted", HONE_OUT_OF_MEMORY);
    };
    add("create_makes_nothing").create = [](const hone_host*, hone_pass**, hone_error*) {
        return hone_status{HONE_OK};
    };
    add("create_throws").create = [](const hone_host*, hone_pass**, hone_error*) -> hone_status {
        throw std::runtime_error("lost my keys");
    };
    add("create_throws_a_number").create = [](const hone_host*, hone_pass**,
                                              hone_error*) -> hone_status { throw 3; };
    add("create_throws_bad_alloc").create =
        [](const hone_host*, hone_pass**, hone_error*) -> hone_status { throw std::bad_alloc(); };
    add("destroy_throws").destroy = [](hone_pass* pass) {
        destroy(pass);
        throw 1;
    };
    hone_pass_type& keeps_nothing = add("keeps_nothing"); // no failure
    keeps_nothing.create = nullptr;
    keeps_nothing.destroy = nullptr;

    add("execute_fails").execute = EXECUTE {
        return fail(error, "bored\x07");
    };
    add("execute_gives_no_reason").execute = EXECUTE {

        return HONE_FAILED;
    };
    add("execute_throws").execute = EXECUTE {

        throw std::logic_error("dusk");
    };
    add("execute_throws_a_number").execute = EXECUTE {

        throw 7;
    };
    add("execute_throws_bad_alloc").execute = EXECUTE {

        throw std::bad_alloc();
    };
    add("execute_ends_oddly").execute = EXECUTE {

        return hone_status{-77};
    };
    add("execute_writes_no_end").execute = EXECUTE {
        std::memset(error->text, 'x', sizeof error->text);
        return hone_status{HONE_FAILED};
    };
    add("execute_has_no_device").execute = EXECUTE {
        return fail(error, "it fell out", HONE_NO_DEVICE);
    };
    add("execute_has_no_memory").execute = EXECUTE {
        return fail(error, "all gone", HONE_OUT_OF_MEMORY);
    };
    add("execute_gives_up").execute = EXECUTE {

        return hone_status{HONE_INTERRUPTED};
    };
    add("execute_counts_the_unknown").execute = EXECUTE {
        run->count(run, 5, 1);
        return execute(nullptr, nullptr, run, nullptr);
    };

    add("writes_nan").execute = EXECUTE {
        return writeOne<5>(run, kNaN);
    };
    add("writes_infinity").execute = EXECUTE {
        return writeOne<0>(run, kInfinity);
    };
    add("writes_less_than_nothing").execute = EXECUTE {
        return writeOne<1>(run, -0.5f);
    };
    add("writes_more_than_white", "Display", 12).execute = EXECUTE {
        return writeOne<3>(run, 1.5f);
    };
    addList("lists_no_pixel", "PixelList", 4, four).execute = EXECUTE {
        return listOne<1>(run, {run->width * run->height});
    };
    addList("requests_no_pixel", "RequestList", 12, four).execute = EXECUTE {
        return listOne<3>(run, {1'000'000, 0, 1});
    };
    addList("samples_no_pixel", "Samples", 16, four).execute = EXECUTE {
        return listOne<4>(run, {0, 0, 0, 1'000'000});
    };
    addList("lists_too_much", "PixelList", 4, four).execute = EXECUTE {
        run->outputs[0]->count = 5;
        return hone_status{HONE_OK};
    };
    addList("size_throws", "PixelList", 4,
            [](const hone_size_query*) -> size_t { throw std::runtime_error("cannot count"); });
    addList("size_is_huge", "PixelList", 4, [](const hone_size_query*) { return ~size_t{0}; });
    hone_pass_type& sees_no_instance = add("sees_no_instance", "Hits", 8);
    sees_no_instance.input_count = 1;
    sees_no_instance.execute = EXECUTE {
        std::memset(run->outputs[0]->data, 0xff, run->outputs[0]->capacity * 8); // nothing
        static_cast<hone_hit*>(run->outputs[0]->data)[1] = {1'000'000, 0};
        return hone_status{HONE_OK};
    };
}

} // namespace

const hone_plugin* hone_plugin_entry(uint32_t, uint32_t) {
    static const AllTypes all;
    static const hone_plugin plugin{HONE_PLUGIN_MAGIC,
                                    sizeof(hone_plugin),
                                    HONE_PLUGIN_ABI_MAJOR,
                                    HONE_PLUGIN_ABI_MINOR,
                                    HONE_PLUGIN_BUILD,
                                    "failing_passes",
                                    "1.0",
                                    "Apache-2.0",
                                    "Passes that fail.",
                                    nullptr,
                                    0,
                                    all.list.data(),
                                    all.list.size(),
                                    nullptr,
                                    0};
    return &plugin;
}
