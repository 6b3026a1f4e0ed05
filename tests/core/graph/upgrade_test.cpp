// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/upgrade.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

UpgradedText upgraded(const std::string& text, std::vector<Diagnostic>& diagnostics) {
    const SourceText source("old.json", text);
    return upgradeText(source, diagnostics);
}

TEST(Upgrade, RenamesPassesAndKeepsCommentsAndLayout) {
    std::vector<Diagnostic> diagnostics;
    const UpgradedText result = upgraded(
        "{ // old\n"
        "  \"hone\":1, \"passes\": {\n"
        "    \"d\": {\"type\" : \"difference\"}, /* kept */\n"
        "    \"s\": { \"type\": \"error.shadow\", \"in\": {} },\n"
        "    \"l\": { \"loop\": { \"passes\": { \"d\": { \"type\": \"difference\" } } } },\n"
        "    \"n\": { \"type\": \"error.shadow\", \"in\": { \"shadow_ranges\": \"r.ranges\" } }\n"
        "  } }\n",
        diagnostics);
    EXPECT_TRUE(diagnostics.empty()) << format(diagnostics);
    ASSERT_TRUE(result.is_valid);
    EXPECT_EQ(
        result.text,
        "{ // old\n"
        "  \"hone\":2, \"passes\": {\n"
        "    \"d\": {\"type\" : \"measure.error\"}, /* kept */\n"
        "    \"s\": { \"type\": \"error.kbm10\", \"in\": {} },\n"
        "    \"l\": { \"loop\": { \"passes\": { \"d\": { \"type\": \"measure.error\" } } } },\n"
        "    \"n\": { \"type\": \"error.shadow\", \"in\": { \"shadow_ranges\": \"r.ranges\" } }\n"
        "  } }\n");
    EXPECT_EQ(result.edits.size(), 4u);
    EXPECT_EQ(result.edits[1].place.pointer, "/passes/d/type");
}

TEST(Upgrade, LeavesAGraphOfThisVersionAlone) {
    std::vector<Diagnostic> diagnostics;
    const std::string text = "{ \"hone\": 2, \"passes\": { \"d\": { \"type\": \"difference\" } } }";
    const UpgradedText result = upgraded(text, diagnostics);
    EXPECT_TRUE(result.edits.empty());
    EXPECT_EQ(result.text, text);
}

TEST(Upgrade, IsDoneAfterOneRound) {
    std::vector<Diagnostic> diagnostics;
    const std::string once =
        upgraded("{ \"hone\": 1, \"passes\": { \"d\": { \"type\": \"difference\" } } }",
                 diagnostics)
            .text;
    EXPECT_TRUE(upgraded(once, diagnostics).edits.empty());
}

TEST(Upgrade, RefusesWhatItCannotRead) {
    for (const char* text :
         {"", "[]", "{ \"hone\": 99 }", "{ \"hone\": \"1\" }", "{ \"hone\": 1"}) {
        std::vector<Diagnostic> diagnostics;
        EXPECT_FALSE(upgraded(text, diagnostics).is_valid) << text;
        EXPECT_EQ(diagnostics.size(), 1u) << text;
    }
    std::vector<Diagnostic> diagnostics;
    EXPECT_TRUE(upgraded("{ \"hone\": 1, \"passes\": [ 3 ] }", diagnostics).is_valid)
        << "what is wrong in it is for check to say";
}

} // namespace
} // namespace hone
