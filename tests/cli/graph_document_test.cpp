// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/graph_document.h"
#include "hone/core/error.h"
#include "hone/core/graph/diagnostics.h"
#include "hone/tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

using test::TemporaryFolder;

std::string refusalOf(const std::string& path) {
    try {
        (void)readGraphDocument(path);
    } catch (const GraphError& error) {
        return error.what();
    }
    return "";
}

// Those that every command gives for a graph that cannot be read.
TEST(GraphDocument, RefusesWhatTheGraphReaderRefusesInItsWords) {
    const TemporaryFolder folder;
    for (const auto& [path, code] :
         {std::pair(std::string("/dev/zero"), "E0104"),
          {folder.path("absent.json"), "E0106"},
          {folder.write("empty.json", ""), "E0101"},
          {folder.write("broken.json", "{ \"hone\": 2,"), "E0101"},
          {folder.write("deep.json", std::string(65, '[')), "E0103"},
          {folder.write("twice.json", R"({ "hone": 2, "hone": 2 })"), "E0102"},
          {folder.write("newer.json", R"({ "hone": 99 })"), "E0204"},
          {folder.write("passes.json", R"({ "hone": 2, "passes": [] })"), "E0202"}}) {
        std::vector<Diagnostic> diagnostics;
        (void)parseGraphFile(path, diagnostics);
        EXPECT_NE(refusalOf(path).find(code), std::string::npos) << path;
        EXPECT_EQ(refusalOf(path), format(diagnostics)) << path;
    }
}

TEST(GraphDocument, IsOfThePresentVersion) {
    const TemporaryFolder folder;
    const GraphDocument document = readGraphDocument(folder.write("old.json", R"({
        "hone": 1, // a comment
        "passes": { "error": { "type": "difference", "in": {} } }, "outputs": {} })"));
    EXPECT_EQ(document.json["hone"], kGraphVersion);
    EXPECT_EQ(document.json["passes"]["error"]["type"], "measure.error");
}

TEST(GraphDocument, KnowsAFileBesideItByItsNameThere) {
    const TemporaryFolder folder;
    const auto fileOf = [&](const std::string& pass) {
        return readGraphDocument(folder.write("whole.json", R"({ "hone": 2, "passes": { "part": )" +
                                                                pass + R"( }, "outputs": {} })"))
            .fileBeside();
    };
    (void)folder.write("part.json", R"({ "hone": 2, "passes": {}, "outputs": {} })");
    (void)folder.write("edges.comp", "void main() {}");
    EXPECT_EQ(fileOf(R"({ "type": "raster" })"), "");
    EXPECT_EQ(fileOf(R"({ "graph": "part.json" })"), "part.json");
    EXPECT_EQ(fileOf(R"({ "type": "glsl", "shader": "edges.comp" })"), "edges.comp");
}

} // namespace
} // namespace hone::cli
