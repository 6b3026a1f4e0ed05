// SPDX-License-Identifier: Apache-2.0
#include "hone/core/printable.h"

#include <gtest/gtest.h>

namespace hone {
namespace {

TEST(Printable, ReplacesControlBytes) {
    EXPECT_EQ(printable("a\x1b[31mb\nc\x7f"), "a?[31mb?c?");
}

TEST(Printable, KeepsTextOfOtherLanguages) {
    EXPECT_EQ(printable("Säule ☂"), "Säule ☂");
}

TEST(Printable, CutsAfter256Bytes) {
    EXPECT_EQ(printable(std::string(1000, 'x')), std::string(256, 'x'));
}

} // namespace
} // namespace hone
