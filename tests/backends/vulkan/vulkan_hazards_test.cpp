// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_hazards.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hone {
namespace {

class VulkanHazardsTest : public testing::Test {
protected:
    BufferUse reads(std::size_t begin, std::size_t bytes) { return {view(begin, bytes), false}; }
    BufferUse writes(std::size_t begin, std::size_t bytes) { return {view(begin, bytes), true}; }
    BufferView view(std::size_t begin, std::size_t bytes) {
        return {.handle = 1, .offset = begin, .bytes = bytes, .data = memory.data() + begin};
    }
    bool wait(std::vector<BufferUse> uses) { return hazards.mustWait(uses); }

    std::vector<std::byte> memory = std::vector<std::byte>(1024);
    VulkanHazards hazards;
};

TEST_F(VulkanHazardsTest, LetReadersOfTheSameBytesRunTogether) {
    EXPECT_FALSE(wait({reads(0, 64)}));
    EXPECT_FALSE(wait({reads(0, 64), reads(32, 64)}));
}

TEST_F(VulkanHazardsTest, MakeAReaderWaitForTheWriter) {
    EXPECT_FALSE(wait({writes(0, 64)}));
    EXPECT_TRUE(wait({reads(63, 1)}));
}

TEST_F(VulkanHazardsTest, MakeAWriterWaitForReadersAndWriters) {
    EXPECT_FALSE(wait({reads(0, 64)}));
    EXPECT_TRUE(wait({writes(0, 1)}));
    EXPECT_TRUE(wait({writes(0, 64)}));
}

TEST_F(VulkanHazardsTest, TellNeighboursApart) {
    EXPECT_FALSE(wait({writes(0, 64)}));
    EXPECT_FALSE(wait({writes(64, 64)}));
    EXPECT_FALSE(wait({reads(128, 64)}));
}

TEST_F(VulkanHazardsTest, ForgetWhatABarrierEnded) {
    EXPECT_FALSE(wait({writes(0, 64), writes(128, 64)}));
    EXPECT_TRUE(wait({reads(0, 64), writes(256, 64)}));
    EXPECT_FALSE(wait({reads(128, 64)})) << "the barrier was for this, too";
    EXPECT_TRUE(wait({reads(256, 64)}));
}

TEST_F(VulkanHazardsTest, SeeThatTwoBuffersShareMemory) {
    EXPECT_FALSE(wait({writes(0, 64)}));
    BufferUse imported = reads(0, 64);
    imported.buffer.handle = 2;
    EXPECT_TRUE(wait({imported}));
}

TEST_F(VulkanHazardsTest, WaitForWhatIsUnknown) {
    EXPECT_FALSE(hazards.mustWaitForAll()) << "nothing was recorded";
    EXPECT_TRUE(wait({reads(0, 4)}));
    EXPECT_FALSE(wait({reads(8, 4)}));
    EXPECT_TRUE(hazards.mustWaitForAll());
    EXPECT_TRUE(hazards.mustWaitForAll());
    hazards.clear();
    EXPECT_FALSE(wait({writes(0, 4)}));
}

TEST_F(VulkanHazardsTest, NeverLetTwoThatMeetRunTogether) {
    // Against the definition, for 1000 operations of up to 4 uses.
    std::mt19937 random(1);
    std::vector<BufferUse> since;
    for (int i = 0; i < 1000; ++i) {
        std::vector<BufferUse> uses;
        for (auto n = random() % 5; n > 0; --n) {
            const std::size_t begin = random() % 1000;
            const std::size_t bytes = random() % (1024 - begin);
            uses.push_back(random() % 8 == 0 ? writes(begin, bytes / 16) : reads(begin, bytes));
        }
        bool meets = false;
        for (const BufferUse& a : since)
            for (const BufferUse& b : uses)
                meets |= (a.is_written || b.is_written) && a.buffer.bytes > 0 &&
                         b.buffer.bytes > 0 && a.buffer.data < b.buffer.data + b.buffer.bytes &&
                         b.buffer.data < a.buffer.data + a.buffer.bytes;
        const bool waits = wait(uses);
        EXPECT_TRUE(waits || !meets) << "operation " << i;
        if (waits)
            since.clear();
        since.insert(since.end(), uses.begin(), uses.end());
    }
}

} // namespace
} // namespace hone
