// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/report.h"

#include <gtest/gtest.h>

namespace hone::cli {
namespace {

constexpr const char* kHostile = "<script>alert('x')</script>&\"";
constexpr const char* kEscaped = "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;&quot;";

TEST(Report, EscapesWhatHtmlReads) {
    EXPECT_EQ(escapeHtml(kHostile), kEscaped);
    EXPECT_EQ(escapeHtml("plain – text"), "plain – text");
}

TEST(Report, EscapesEveryTextThatItIsGiven) {
    const Image8 pixel{{1, 1}, {255, 0, 0, 255}};
    const std::string html = toHtml({kHostile,
                                     kHostile,
                                     {{kHostile, kHostile, pixel}},
                                     {{kHostile, {kHostile}, {{kHostile}}}}});
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("alert('"), std::string::npos);
    // Twice the title, the summary, the picture's title, twice its caption, the table's title, head
    // and cell.
    std::size_t count = 0;
    for (std::size_t at = html.find(kEscaped); at != std::string::npos;
         at = html.find(kEscaped, at + 1))
        ++count;
    EXPECT_EQ(count, 9u);
}

TEST(Report, KeepsThePicturesInside) {
    const std::string html = toHtml({"t", "s", {{"p", "c", {{1, 1}, {255, 0, 0, 255}}}}, {}});
    // A PNG's first bytes, 89 50 4e 47 0d 0a, in base 64.
    EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0K"), std::string::npos);
    EXPECT_EQ(html.find("http"), std::string::npos);
}

} // namespace
} // namespace hone::cli
