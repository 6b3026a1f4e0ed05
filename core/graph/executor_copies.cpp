// SPDX-License-Identifier: Apache-2.0
//
// What is known before anything runs: which bytes must exist twice.
#include "hone/core/graph/executor_state.h"
#include "hone/core/pass/pass_type.h"

#include <algorithm>

namespace hone {

void Executor::State::prepareTracers() {
    for (NodeId id = 0; id < nodes.size(); ++id) {
        const PlannedNode& node = graph.nodes[id];
        if (node.type == nullptr || !node.culled.empty())
            continue;
        const auto backend =
            std::ranges::find_if(node.type->params, &ParamDecl::from_trace_backends);
        const auto scene_input = std::ranges::find_if(nodes[id].inputs, [](const BoundPort& port) {
            return port.value != nullptr && port.value->scene != nullptr;
        });
        if (backend != node.type->params.end() && scene_input != nodes[id].inputs.end())
            static_cast<void>(
                tracers.get(node.params.get<std::string>(backend->name), *scene_input->value));
    }
}

void Executor::prepare() {
    state_->prepareInputs();
    state_->prepareTracers();
}

std::vector<MemoryCopy> Executor::copies() const {
    std::vector<MemoryCopy> all = state_->tracers.copies();
    if (state_->scene_buffers) {
        const std::span<const MemoryCopy> arrays = state_->scene_buffers->copies();
        all.insert(all.begin(), arrays.begin(), arrays.end());
    }
    return all;
}

} // namespace hone
