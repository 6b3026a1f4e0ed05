// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/trace_backend.h"

#include "hone/core/error.h"
#include "hone/core/trace/choice/backend_name.h"

#include <algorithm>

namespace hone {

void TraceBackendRegistry::add(std::string name, std::string doc, Factory factory) {
    HONE_ASSERT(!contains(name), "two trace backends are called " + name);
    entries_.push_back({std::move(name), std::move(doc), std::move(factory)});
}

std::vector<std::string> TraceBackendRegistry::names() const {
    std::vector<std::string> result;
    for (const Entry& entry : entries_)
        result.push_back(entry.name);
    return result;
}

const std::string& TraceBackendRegistry::preferred() const {
    HONE_ASSERT(!entries_.empty(), "the program registered no trace backend");
    return entries_.front().name;
}

bool TraceBackendRegistry::contains(std::string_view name) const {
    if (const std::optional<CheckName> check = parseCheckName(name)) {
        const auto is_known = [&](std::string_view inner) {
            return inner.empty() || (inner == "auto" && !entries_.empty()) || contains(inner);
        };
        return is_known(check->first) && is_known(check->second);
    }
    return std::ranges::any_of(entries_, [&](const Entry& entry) { return entry.name == name; });
}

std::unique_ptr<TraceBackend>
TraceBackendRegistry::wrap(std::unique_ptr<TraceBackend> backend) const {
    return wrapper_ ? wrapper_(std::move(backend)) : std::move(backend);
}

} // namespace hone
