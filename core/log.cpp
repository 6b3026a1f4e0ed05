// SPDX-License-Identifier: Apache-2.0
#include "hone/core/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>

namespace hone {
namespace {

std::unique_ptr<spdlog::logger>& instance() {
    static std::unique_ptr<spdlog::logger> current = [] {
        auto made = std::make_unique<spdlog::logger>(
            "hone", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
        made->set_pattern("%^%l%$: %v");
        made->set_level(spdlog::level::warn);
        return made;
    }();
    return current;
}

} // namespace

spdlog::logger& logger() {
    return *instance();
}

void setLogger(std::unique_ptr<spdlog::logger> replacement) {
    instance() = std::move(replacement);
}

} // namespace hone
