// SPDX-License-Identifier: Apache-2.0
//
// The order of dependence between rooms, read from the include lines, and the house rules that a
// scan can check.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace hone {
namespace {

namespace fs = std::filesystem;

struct Include {
    std::string file; ///< relative to the source tree
    std::size_t line = 0;
    std::string target; ///< as written
};

std::vector<fs::path> sources() {
    std::vector<fs::path> found;
    for (const char* room : {"core", "passes", "backends", "cli", "examples"})
        for (const fs::directory_entry& entry :
             fs::recursive_directory_iterator(fs::path(HONE_SOURCE_DIR) / room))
            if (entry.is_regular_file() &&
                (entry.path().extension() == ".h" || entry.path().extension() == ".cpp"))
                found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
}

std::vector<Include> includes() {
    static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<Include> found;
    for (const fs::path& path : sources()) {
        std::ifstream file(path);
        std::string text;
        for (std::size_t line = 1; std::getline(file, text); ++line)
            if (std::smatch match; std::regex_search(text, match, pattern))
                found.push_back(
                    {fs::relative(path, HONE_SOURCE_DIR).generic_string(), line, match[1]});
    }
    return found;
}

/// "passes/error/shadow/x.cpp" is in room "passes", sub-room "error/shadow".
std::string roomOf(const std::string& path) {
    return path.substr(0, path.find('/'));
}

std::string subRoomOf(const std::string& path) {
    const std::string rest = path.substr(path.find('/') + 1);
    const std::size_t last = rest.rfind('/');
    return last == std::string::npos ? "" : rest.substr(0, last);
}

/// Why an include of one part of hone by another is not allowed; "" if it is.
std::string objection(const std::string& file, const std::string& target) {
    const std::string from = roomOf(file), to = roomOf(target);
    if (from == "core" && to != "core")
        return "core includes only itself";
    if (from == "passes" && to == "backends")
        return "a pass never includes a backend";
    if (from == "passes" && to == "passes") {
        const std::string mine = subRoomOf(file), other = subRoomOf(target);
        if (!mine.empty() && !other.empty() && other != mine && other != "shading")
            return "a pass never includes another pass";
    }
    if (from == "backends") {
        if (to == "passes" || to == "cli")
            return "a backend never includes a pass";
        const bool is_list = subRoomOf(file).empty(); // backends.cpp names them all
        if (to == "backends" && !is_list && subRoomOf(target) != subRoomOf(file))
            return "a backend never includes another backend";
    }
    if (from != "cli" && to == "cli")
        return "cli sits on top";
    return "";
}

TEST(Architecture, RoomsIncludeOnlyWhatIsBelowThem) {
    for (const Include& include : includes()) {
        if (!include.target.starts_with("hone/"))
            continue;
        EXPECT_EQ(objection(include.file, include.target.substr(5)), "")
            << include.file << ":" << include.line << " includes " << include.target;
    }
}

TEST(Architecture, SourcesIncludeTheirOwnHeaderFirst) {
    // So that it compiles alone. Headers without a source get one from tests/CMakeLists.txt.
    std::string file;
    for (const Include& include : includes()) {
        const bool is_first = include.file != file;
        file = include.file;
        fs::path header(file);
        header.replace_extension(".h");
        if (is_first && file.ends_with(".cpp") && fs::exists(HONE_SOURCE_DIR / header)) {
            EXPECT_EQ(include.target, "hone/" + header.generic_string())
                << file << ":" << include.line;
        }
    }
}

TEST(Architecture, OneRoomNamesEachForeignApi) {
    struct Api {
        const char* prefix;
        const char* room;
    };
    static constexpr std::array kApis{Api{"vulkan/", "backends/vulkan/"},
                                      Api{"spirv_cross/spirv_cross", "backends/vulkan/"},
                                      Api{"glslang/", "passes/glsl/"},
                                      Api{"spirv-tools/", "passes/glsl/"},
                                      Api{"embree", "backends/embree/"},
                                      Api{"OpenEXR/", "core/image/"},
                                      Api{"png.h", "core/image/"},
                                      Api{"jpeglib.h", "core/image/"},
                                      Api{"tiny_gltf.h", "core/scene/"},
                                      Api{"meshoptimizer.h", "core/scene/"},
                                      Api{"CLI/", "cli/"}};
    for (const Include& include : includes())
        for (const Api& api : kApis)
            if (include.target.starts_with(api.prefix)) {
                EXPECT_TRUE(include.file.starts_with(api.room))
                    << include.file << ":" << include.line << " includes " << include.target;
            }
}

TEST(Architecture, CoreIncludesNoThreadPool) {
    for (const Include& include : includes())
        if (include.target.starts_with("tbb/")) {
            EXPECT_FALSE(include.file.starts_with("core/")) << include.file << ":" << include.line;
        }
}

TEST(Architecture, EveryFileNamesItsLicence) {
    for (const fs::path& path : sources()) {
        std::ifstream file(path);
        std::string first;
        std::getline(file, first);
        // A C header has no other comments.
        if (first.starts_with("/*")) {
            EXPECT_EQ(first, "/* SPDX-License-Identifier: Apache-2.0 */") << path;
        } else {
            EXPECT_EQ(first, "// SPDX-License-Identifier: Apache-2.0") << path;
        }
    }
}

TEST(Architecture, PassesOpenWithTheirManualPage) {
    for (const fs::path& path : sources()) {
        const std::string relative = fs::relative(path, HONE_SOURCE_DIR).generic_string();
        std::ifstream file(path);
        const std::string text((std::istreambuf_iterator<char>(file)), {});
        if (!relative.starts_with("passes/") ||
            text.find("return PassType(\"") == std::string::npos)
            continue;
        const std::size_t at = text.find("return PassType(\"") + 17;
        const std::string name = text.substr(at, text.find('"', at) - at);
        const std::string head = text.substr(0, text.find("#include"));
        EXPECT_NE(head.find("// " + name + ": "), std::string::npos)
            << relative << " has no manual page for " << name;
    }
}

} // namespace
} // namespace hone
