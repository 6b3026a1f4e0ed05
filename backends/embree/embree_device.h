// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/backends/embree/embree_shim.h"

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace hone {

/// Embree itself, with the first error it reported and the memory it holds. Not movable: Embree's
/// callbacks point into it.
class EmbreeDevice {
public:
    /// Throws DeviceError if the library cannot start.
    EmbreeDevice();
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    [[nodiscard]] RTCDevice handle() const { return device_.handle(); }
    [[nodiscard]] std::size_t bytes() const;
    /// Throws OutOfMemory or DeviceError, naming `call`, if Embree reported an error since the last
    /// check.
    void check(const char* call);

private:
    std::atomic<std::int64_t> bytes_ = 0;
    std::atomic<RTCError> error_ = RTC_ERROR_NONE;
    DeviceOwner device_; // last, so that it goes first: its release still reports memory
};

} // namespace hone
