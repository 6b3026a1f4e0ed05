// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/embree/embree_device.h"

#include "hone/core/error.h"
#include "hone/core/log.h"

#include <algorithm>
#include <string>

namespace hone {
namespace {

const char* errorName(RTCError error) {
    switch (error) {
    case RTC_ERROR_NONE:
        return "RTC_ERROR_NONE";
    case RTC_ERROR_INVALID_ARGUMENT:
        return "RTC_ERROR_INVALID_ARGUMENT";
    case RTC_ERROR_INVALID_OPERATION:
        return "RTC_ERROR_INVALID_OPERATION";
    case RTC_ERROR_OUT_OF_MEMORY:
        return "RTC_ERROR_OUT_OF_MEMORY";
    case RTC_ERROR_UNSUPPORTED_CPU:
        return "RTC_ERROR_UNSUPPORTED_CPU";
    case RTC_ERROR_CANCELLED:
        return "RTC_ERROR_CANCELLED";
    default:
        return "RTC_ERROR_UNKNOWN";
    }
}

} // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr)) {
    if (handle() == nullptr)
        throw DeviceError(std::string("rtcNewDevice failed: ") +
                          errorName(rtcGetDeviceError(nullptr)) +
                          "; Embree " RTC_VERSION_STRING " needs a 64-bit processor with SSE2");
    rtcSetDeviceErrorFunction(
        handle(),
        [](void* self, RTCError code, const char* text) {
            logger().debug("Embree: {}: {}", errorName(code), text != nullptr ? text : "");
            RTCError none = RTC_ERROR_NONE;
            static_cast<EmbreeDevice*>(self)->error_.compare_exchange_strong(none, code);
        },
        this);
    rtcSetDeviceMemoryMonitorFunction(
        handle(),
        [](void* self, ssize_t bytes, bool) {
            static_cast<EmbreeDevice*>(self)->bytes_ += bytes;
            return true;
        },
        this);
}

std::size_t EmbreeDevice::bytes() const {
    return static_cast<std::size_t>(std::max<std::int64_t>(bytes_, 0));
}

void EmbreeDevice::check(const char* call) {
    const RTCError error = error_.exchange(RTC_ERROR_NONE);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw OutOfMemory(std::string(call) + ": Embree has no memory for the scene");
    if (error != RTC_ERROR_NONE)
        throw DeviceError(std::string(call) + " failed: " + errorName(error));
}

} // namespace hone
