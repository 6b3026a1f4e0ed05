// SPDX-License-Identifier: Apache-2.0
#include "hone/core/error.h"
#include "hone/core/trace/check/check_backend.h"
#include "hone/core/trace/choice/backend_name.h"
#include "hone/core/trace/trace_backend.h"

#include <algorithm>

namespace hone {

std::unique_ptr<TraceBackend> TraceBackendRegistry::createBare(std::string_view name,
                                                               const Devices& devices) const {
    if (const std::optional<CheckName> check = parseCheckName(name)) {
        const auto inner = [&](std::string_view wanted) -> std::unique_ptr<TraceBackend> {
            if (wanted.empty())
                return nullptr;
            return createBare(wanted == "auto" ? std::string_view(preferred()) : wanted, devices);
        };
        return makeCheckBackend(inner(check->first), inner(check->second), check_report_);
    }
    auto found =
        std::ranges::find_if(entries_, [&](const Entry& entry) { return entry.name == name; });
    HONE_ASSERT(found != entries_.end(), "no trace backend is called " + std::string(name));
    return found->factory(devices);
}

} // namespace hone
