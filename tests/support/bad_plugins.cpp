// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/bad_plugins.h"

namespace hone::test {

std::span<const BadPlugin> badPlugins() {
    static constexpr BadPlugin kAll[] = {
        {"no_entry", "exports no hone_plugin_entry"},
        {"undefined", "undefined symbol: hone_nobody_defines_this"},
        {"declines", "declines to work with this hone (plug-in ABI 1.0)"},
        {"throws", "its entry threw an exception: the dog ate my ?[31mlicence"},
        {"throws_a_number", "its entry threw something that is no std::exception"},
        {"wrong_magic", "wrong magic number"},
        {"newer_major", "speaks plug-in ABI 2.0, this hone 1.0: it needs a newer hone"},
        {"older_major",
         "speaks plug-in ABI 0.0, this hone 1.0: build it anew with this hone's headers"},
        {"short_table", "its table is short: struct_size is 87, at least 88 is expected"},
        {"empty_table", "its table is short: struct_size is 0"},
        {"short_backend_table", "the table of its trace backend 0 is short: struct_size is 80"},
        {"no_name", "its name is missing (NULL)"},
        {"empty_version", "its version is empty"},
        {"no_license", "its license is missing (NULL)"},
        {"control_bytes_in_doc", "its doc has control bytes: \"?]0;pwned?\""},
        {"long_doc", "its doc is longer than 1024 bytes"},
        {"control_bytes_in_name", "the name of its trace backend 0 has control bytes: \"bad?[2J\""},
        {"spaces_in_name", "the name of its trace backend 0 \"a bad one\" is no name"},
        {"long_name", "xxx\" is no name: use a-z, 0-9, _ and ., a letter first, at most 64 bytes"},
        {"called_auto", "the name of its trace backend 0 \"auto\" is no name"},
        {"name_taken", "its trace backend \"embree\" has the name of another"},
        {"two_of_a_name", "offers two trace backends called \"bad\""},
        {"offers_nothing", "offers no trace backend"},
        {"no_list", "its list of trace backends is missing (NULL)"},
        {"no_backend", "its trace backend 0 is missing (NULL)"},
        {"a_billion_backends", "says that it offers 1000000000 trace backends"},
        {"no_create", "its trace backend \"bad\": create is missing (NULL)"},
        {"no_destroy", "its trace backend \"bad\": destroy is missing (NULL)"},
        {"no_build", "its trace backend \"bad\": build is missing (NULL)"},
        {"no_closest", "its trace backend \"bad\": closest is missing (NULL)"},
        {"no_occluded", "its trace backend \"bad\": occluded is missing (NULL)"},
        {"unknown_flags", "its trace backend \"bad\": flags has bits that mean nothing"},
        {"passes", "offers passes, which plug-in ABI 1.0 does not have"},
    };
    return kAll;
}

} // namespace hone::test
