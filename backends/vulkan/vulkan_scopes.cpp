// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_scopes.h"

#include "hone/core/error.h"

namespace hone {

VulkanScopes::VulkanScopes(const VulkanContext& context) : context_(&context) {
    if (context.timestampPeriodNs() == 0)
        return;
    const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .pNext = nullptr,
                                     .flags = 0,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 2 * kMaxSpans,
                                     .pipelineStatistics = 0};
    queries_ = OwnedQueryPool(context.device(), info);
    context.setName(VK_OBJECT_TYPE_QUERY_POOL, queries_.handle(), "scope times");
}

std::uint32_t VulkanScopes::findTotal(std::string_view name) {
    for (std::uint32_t i = 0; i < totals_.size(); ++i)
        if (totals_[i].timing.name == name)
            return i;
    totals_.push_back({{std::string(name), 0}, false});
    return static_cast<std::uint32_t>(totals_.size() - 1);
}

void VulkanScopes::open(VkCommandBuffer commands, Open& scope) {
    context_->beginLabel(commands, totals_[scope.total].timing.name.c_str());
    scope.span = kUntimed;
    if (queries_.handle() == VK_NULL_HANDLE || span_count_ == kMaxSpans)
        return;
    scope.span = span_count_++;
    span_totals_[scope.span] = scope.total;
    // All commands, also at the begin: the clock starts when the work before is done.
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.handle(),
                         2 * scope.span);
}

void VulkanScopes::close(VkCommandBuffer commands, const Open& scope) {
    if (scope.span != kUntimed)
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.handle(),
                             2 * scope.span + 1);
    context_->endLabel(commands);
}

void VulkanScopes::push(VkCommandBuffer commands, std::string_view name) {
    HONE_ASSERT(depth_ < kMaxDepth, "scopes nest too deeply at " + std::string(name));
    Open& scope = stack_[depth_++];
    scope = {findTotal(name), kUntimed};
    if (commands != VK_NULL_HANDLE)
        open(commands, scope);
}

void VulkanScopes::pop(VkCommandBuffer commands) {
    HONE_ASSERT(depth_ > 0, "endScope() without beginScope()");
    --depth_;
    if (commands != VK_NULL_HANDLE)
        close(commands, stack_[depth_]);
}

void VulkanScopes::beginRecording(VkCommandBuffer commands) {
    span_count_ = 0;
    if (queries_.handle() != VK_NULL_HANDLE)
        vkCmdResetQueryPool(commands, queries_.handle(), 0, 2 * kMaxSpans);
    for (std::uint32_t i = 0; i < depth_; ++i)
        open(commands, stack_[i]);
}

void VulkanScopes::endRecording(VkCommandBuffer commands) {
    for (std::uint32_t i = depth_; i > 0; --i)
        close(commands, stack_[i - 1]);
}

void VulkanScopes::collect() {
    if (span_count_ == 0)
        return;
    HONE_VULKAN(vkGetQueryPoolResults(context_->device(), queries_.handle(), 0, 2 * span_count_,
                                      2 * span_count_ * sizeof(std::uint64_t), stamps_.data(),
                                      sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT));
    for (std::uint32_t span = 0; span < span_count_; ++span) {
        Total& total = totals_[span_totals_[span]];
        const std::uint64_t ticks = stamps_[2 * span + 1] - stamps_[2 * span];
        total.timing.ms += static_cast<double>(ticks) * context_->timestampPeriodNs() * 1e-6;
        total.is_used = true;
    }
    span_count_ = 0;
}

std::vector<ScopeTiming> VulkanScopes::take() {
    std::vector<ScopeTiming> result;
    for (Total& total : totals_) {
        if (total.is_used)
            result.push_back(total.timing);
        total.timing.ms = 0;
        total.is_used = false;
    }
    return result;
}

} // namespace hone
