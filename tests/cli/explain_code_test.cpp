// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

TEST(ExplainCode, SaysWhatItMeansAndShowsTheCure) {
    const CommandRun run = runHone({"explain", "E0301"});
    EXPECT_EQ(run.code, kOk);
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(run.out,
              "error E0301: there is no such pass type\n"
              "\n"
              "  hone passes lists the types that this program knows. A type may also come from\n"
              "  a plug-in that was not loaded.\n"
              "\n"
              "  wrong\n"
              "      { \"type\": \"eror.shadow\" }\n"
              "\n"
              "  right\n"
              "      { \"type\": \"error.shadow\" }\n");
}

TEST(ExplainCode, TakesTheCodeAsPeopleWriteIt) {
    const std::string text = runHone({"explain", "W0801"}).out;
    EXPECT_TRUE(text.starts_with("warning W0801: ")) << text;
    EXPECT_EQ(runHone({"explain", "w0801"}).out, text);
    EXPECT_EQ(runHone({"explain", "w801"}).out, text);
}

TEST(ExplainCode, UnknownCodeEndsWith2AndTheNearest) {
    const CommandRun run = runHone({"explain", "E0319"});
    EXPECT_EQ(run.code, kUsage);
    EXPECT_EQ(run.out, "");
    EXPECT_NE(run.err.find("there is no code \"E0319\"; did you mean E0309 (a plug-in does not "
                           "have what the graph takes from it)?"),
              std::string::npos)
        << run.err;
}

TEST(ExplainCode, WithoutACodeListsAll) {
    const CommandRun run = runHone({"explain"});
    EXPECT_EQ(run.code, kOk);
    EXPECT_TRUE(run.out.starts_with("E0101  the file is not valid JSON\n")) << run.out;
    EXPECT_NE(run.out.find("\nE0405  passes wait for each other\n"), std::string::npos);
    EXPECT_GE(runHone({"explain", "--json"}).json()["codes"].size(), 44u);
}

TEST(ExplainCode, AnswersAsJson) {
    const nlohmann::json code = runHone({"explain", "E0502", "--json"}).json();
    EXPECT_EQ(code["code"], "E0502");
    EXPECT_EQ(code["severity"], "error");
    EXPECT_EQ(code["title"], "a parameter's value is of the wrong type");
    EXPECT_EQ(code["wrong"], R"("params": { "batch": "64" })");
    EXPECT_EQ(code["right"], R"("params": { "batch": 64 })");
}

} // namespace
} // namespace hone::cli
