// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/error.h"
#include "hone/core/pass/pass.h"
#include "hone/core/pass/pass_type.h"
#include "hone/core/scene/scene_buffers.h"

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hone {

/// One pass alone, without a graph: give it inputs by port name, execute it, look at its outputs.
///
///     PassRun run(combinePass());
///     run.extent({2, 1}).param("mode", "max");
///     run.plane<vec2>("errors", {{0.5f, 1.0f}, {0.0f, 0.0f}}, {2.0f}).execute();
///     EXPECT_EQ(run.output<vec2>("error"), ...);
///
/// Outputs are made as an executor makes them: planes have the extent, lists and records what the
/// pass's size rule says, zeroed; an output in place of an input is that input's memory (zeroed
/// memory of its own when the input is not connected). They stay between executions, so the pass
/// can be executed again with other inputs. Throws std::logic_error for ports that the pass does
/// not have and for elements of another size.
///
/// Each execution fails the test if the pass changed an input that no output takes over, or wrote
/// past the end of a buffer that was made here.
class PassRun {
public:
    /// On the host.
    explicit PassRun(PassType type);
    /// Buffers live on `device`, which must outlive this, and kernels run there or, as an executor
    /// chooses for a software device, on the host.
    PassRun(PassType type, Device& device, bool kernels_on_host = false);
    PassRun(const PassRun&) = delete;
    PassRun& operator=(const PassRun&) = delete;

    /// Kernels run on the host after all, over the device's memory: what an executor chooses for a
    /// software device.
    PassRun& kernelsOnHost();
    PassRun& extent(uvec2 size);
    PassRun& seed(std::uint64_t value);
    PassRun& iteration(uint value);
    PassRun& param(std::string_view name, ParamValue value);

    /// The scene (finished) must outlive this; the camera is copied.
    PassRun& scene(const Scene& scene);
    PassRun& camera(const Camera& camera);
    PassRun& tracers(const TraceBackendRegistry& registry);
    PassRun& interrupt(const Interrupt& value);

    /// Feeds a plane, one element a pixel. A second call on a port that takes several edges adds an
    /// edge; on another port it replaces the content. `edge_params` in the order of
    /// InPort::edge_params; missing ones are the defaults.
    template <class T>
    PassRun& plane(std::string_view port, const std::vector<T>& values,
                   std::vector<ParamValue> edge_params = {}) {
        expectStride(port, sizeof(T));
        return bytes(port, std::as_bytes(std::span(values)), 0, std::move(edge_params));
    }
    /// Feeds a list with room for `capacity` elements (at least those given) or a record.
    template <class T>
    PassRun& list(std::string_view port, const std::vector<T>& values, std::size_t capacity = 0) {
        expectStride(port, sizeof(T));
        return bytes(port, std::as_bytes(std::span(values)), capacity);
    }
    /// Feeds a plane, list or record as bytes.
    PassRun& bytes(std::string_view port, std::span<const std::byte> elements,
                   std::size_t capacity = 0, std::vector<ParamValue> edge_params = {});
    /// Feeds another pass's output; the memory is shared. Extent, for an input of type Extent.
    PassRun& input(std::string_view port, const Value& value);

    /// From now on outputs begin with old content, as memory that values share has it, not zeroed.
    PassRun& dirtyOutputs();
    PassRun& execute();
    /// The same after an execution that threw Interrupted.
    PassRun& goOn();

    /// The valid elements of an output after execute().
    template <class T> [[nodiscard]] std::vector<T> output(std::string_view port) const {
        const Value& found = value(port);
        HONE_ASSERT(found.type->stride == sizeof(T), "another element: " + std::string(port));
        const std::span<T> elements = found.as<T>();
        return {elements.begin(), elements.end()};
    }
    [[nodiscard]] const Value& value(std::string_view port) const;
    [[nodiscard]] std::uint64_t counter(std::string_view name) const { return counters_.get(name); }
    void clearCounters() { counters_.clear(); }

private:
    Camera camera_{};
    struct Slot {
        std::string port;
        Value value;
        Buffer memory;
        std::vector<ParamValue> edge_params;
        std::vector<std::byte> before; ///< an input's content when the pass began
    };
    Slot& inputSlot(std::string_view port);
    void expectStride(std::string_view port, std::size_t stride);
    void allocate(Slot& slot, std::size_t bytes);
    void prepareOutputs();
    void rememberInputs();
    void checkMemory() const;

    PassType type_;
    std::unique_ptr<Device> host_;
    Device* device_;
    std::unique_ptr<RenderPass> pass_;
    PassParams params_;
    PassContext context_;
    Counters counters_;
    std::unique_ptr<SceneBuffers> scene_buffers_;
    std::unique_ptr<Tracers> tracers_;
    std::deque<Slot> inputs_; // values are pointed at, so they stay where they are
    std::deque<Slot> outputs_;
    bool has_dirty_outputs_ = false;
};

} // namespace hone
