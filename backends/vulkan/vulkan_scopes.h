// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/vulkan/vulkan_context.h"
#include "hone/core/device/device.h"

#include <array>
#include <string>
#include <vector>

namespace hone {

/// Named stretches of what is recorded: labels in captures, and time by name. A scope may stay
/// open across submissions; it is then timed in pieces.
class VulkanScopes {
public:
    explicit VulkanScopes(const VulkanContext& context);

    /// `commands` is null while nothing is being recorded.
    void push(VkCommandBuffer commands, std::string_view name);
    void pop(VkCommandBuffer commands);

    /// Call as the first thing of a recording, and as its last.
    void beginRecording(VkCommandBuffer commands);
    void endRecording(VkCommandBuffer commands);
    /// Adds up the times of the recording, once its work is done.
    void collect();
    /// Forgets the times of a recording that failed.
    void discard() { span_count_ = 0; }

    [[nodiscard]] std::vector<ScopeTiming> take();

private:
    static constexpr std::uint32_t kMaxSpans = 1024; ///< per recording; later ones are not timed
    static constexpr std::uint32_t kMaxDepth = 32;
    static constexpr std::uint32_t kUntimed = ~0u;

    struct Total {
        ScopeTiming timing;
        bool is_used = false; ///< since the last take()
    };
    struct Open {
        std::uint32_t total = 0;
        std::uint32_t span = kUntimed;
    };

    [[nodiscard]] std::uint32_t findTotal(std::string_view name);
    void open(VkCommandBuffer commands, Open& scope);
    void close(VkCommandBuffer commands, const Open& scope);

    const VulkanContext* context_;
    OwnedQueryPool queries_; ///< two for each span: begin, end
    std::vector<Total> totals_;
    std::array<Open, kMaxDepth> stack_{};
    std::uint32_t depth_ = 0;
    std::array<std::uint32_t, kMaxSpans> span_totals_{};
    std::uint32_t span_count_ = 0;
    std::array<std::uint64_t, 2 * kMaxSpans> stamps_{};
};

} // namespace hone
