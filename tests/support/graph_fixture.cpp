// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/support/graph_fixture.h"

#include <fstream>
#include <sstream>

namespace hone {

std::string GraphTest::planFile(const std::string& name) {
    const std::string path = std::string(HONE_SOURCE_DIR) + "/tests/core/graph/plans/" + name;
    std::ifstream file(path);
    EXPECT_TRUE(file.is_open()) << path;
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

} // namespace hone
