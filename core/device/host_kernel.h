// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/kernel.h"
#include "hone/core/error.h"
#include "hone/core/math.h"
#include "hone/core/scene/scene.glsl.h"
#include "hone/core/trace/ray.glsl.h"
#include "hone/core/trace/sample.glsl.h"

#include <array>
#include <cstring>
#include <string>

namespace hone {

/// What a GLSL buffer is in the native build of a kernel: indexable by uint, with length().
template <class T> class HostArray {
public:
    HostArray(T* data, std::size_t count) : data_(data), count_(count) {}
    T& operator[](std::size_t index) const { return data_[index]; }
    [[nodiscard]] int length() const { return static_cast<int>(count_); }

private:
    T* data_;
    std::size_t count_;
};

/// What a GLSL array of buffers is in the native build: errors[k].data[index].
template <class T, std::size_t N> struct HostArrays {
    struct Element {
        HostArray<T> data{nullptr, 0};
    };
    std::array<Element, N> elements{};
    const Element& operator[](std::size_t k) const { return elements[k]; }
};

/// Base of the struct that a kernel file is included in. Its member functions see GLSL's names.
class HostKernel {
public:
    HostKernel(const Arguments& arguments, const void* params)
        : arguments_(&arguments), params_(params) {}

protected:
    using ivec2 = glm::ivec2;
    using ivec3 = glm::ivec3;
    using uvec2 = glm::uvec2;
    using uvec3 = glm::uvec3;
    using uvec4 = glm::uvec4;
    using vec2 = glm::vec2;
    using vec3 = glm::vec3;
    using vec4 = glm::vec4;
    using mat3 = glm::mat3;
    using mat4 = glm::mat4;
    using mat4x3 = glm::mat4x3;

    // GLSL's functions, found before anything else that has their names.
#define HONE_FUNCTION(name)                                                                        \
    template <class... Operands> static auto name(Operands... operands) {                          \
        return glm::name(operands...);                                                             \
    }
    // clang-format off
    HONE_FUNCTION(abs) HONE_FUNCTION(acos) HONE_FUNCTION(all) HONE_FUNCTION(any)
    HONE_FUNCTION(asin) HONE_FUNCTION(atan) HONE_FUNCTION(bitCount) HONE_FUNCTION(ceil)
    HONE_FUNCTION(clamp) HONE_FUNCTION(cos) HONE_FUNCTION(cross) HONE_FUNCTION(distance)
    HONE_FUNCTION(dot) HONE_FUNCTION(equal) HONE_FUNCTION(exp) HONE_FUNCTION(exp2)
    HONE_FUNCTION(floatBitsToUint) HONE_FUNCTION(floor) HONE_FUNCTION(fract)
    HONE_FUNCTION(greaterThan) HONE_FUNCTION(greaterThanEqual) HONE_FUNCTION(inversesqrt)
    HONE_FUNCTION(isinf) HONE_FUNCTION(isnan) HONE_FUNCTION(length) HONE_FUNCTION(lessThan)
    HONE_FUNCTION(lessThanEqual) HONE_FUNCTION(log) HONE_FUNCTION(log2) HONE_FUNCTION(max)
    HONE_FUNCTION(min) HONE_FUNCTION(mix) HONE_FUNCTION(mod) HONE_FUNCTION(normalize)
    HONE_FUNCTION(pow) HONE_FUNCTION(reflect) HONE_FUNCTION(round) HONE_FUNCTION(sign)
    HONE_FUNCTION(sin) HONE_FUNCTION(smoothstep) HONE_FUNCTION(sqrt) HONE_FUNCTION(step)
    HONE_FUNCTION(tan) HONE_FUNCTION(transpose) HONE_FUNCTION(uintBitsToFloat)
    // clang-format on
#undef HONE_FUNCTION

        /// The bytes bound to `name`, as elements of T. Throws std::logic_error naming the port
        /// when none is bound.
        template <class T>
        HostArray<T> array(const char* name) const {
        const Argument* argument = arguments_->find(name);
        HONE_ASSERT(argument != nullptr, std::string("no buffer is bound to ") + name);
        return {reinterpret_cast<T*>(argument->buffer.data), argument->buffer.bytes / sizeof(T)};
    }

    /// Elements that no edge feeds stay empty.
    template <class T, std::size_t N> HostArrays<T, N> arrays(const char* name) const {
        HostArrays<T, N> result;
        for (uint k = 0; k < N; ++k)
            if (const Argument* argument = arguments_->find(name, k))
                result.elements[k].data = {reinterpret_cast<T*>(argument->buffer.data),
                                           argument->buffer.bytes / sizeof(T)};
        return result;
    }

    template <class T> T parameters() const {
        T value;
        std::memcpy(&value, params_, sizeof(T));
        return value;
    }

private:
    const Arguments* arguments_;
    const void* params_;
};

/// Describes the kernel whose native build is Host and whose SPIR-V is `spirv`.
template <class Host>
constexpr Kernel makeKernel(const char* name, std::span<const std::uint32_t> spirv) {
    return {.name = name,
            .spirv = spirv,
            .params_bytes = sizeof(typename Host::Params),
            .run = [](const Arguments& arguments, const void* params, uint begin, uint end) {
                Host host(arguments, params);
                for (uint index = begin; index < end; ++index)
                    host.kernel(index);
            }};
}

} // namespace hone
