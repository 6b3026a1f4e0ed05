// SPDX-License-Identifier: Apache-2.0
#include "hone/backends/vulkan/vulkan_reflection.h"

#include "hone/core/error.h"

#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

namespace hone {
namespace {

/// A spirv-cross context; all that comes from it lives as long.
class Reflector {
public:
    Reflector(std::span<const std::uint32_t> spirv, const char* shader) : shader_(shader) {
        spvc_context context = nullptr;
        if (spvc_context_create(&context) != SPVC_SUCCESS)
            throw OutOfMemory("no memory to read the shader " + shader_);
        context_.reset(context);
        spvc_parsed_ir ir = nullptr;
        check(spvc_context_parse_spirv(context, spirv.data(), spirv.size(), &ir));
        check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir,
                                           SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_));
        // Only what main() reaches: a declared but unused buffer needs no argument.
        spvc_set active = nullptr;
        check(spvc_compiler_get_active_interface_variables(compiler_, &active));
        check(spvc_compiler_create_shader_resources_for_active_variables(compiler_, &resources_,
                                                                         active));
    }

    [[nodiscard]] std::span<const spvc_reflected_resource> list(spvc_resource_type type) const {
        const spvc_reflected_resource* items = nullptr;
        std::size_t count = 0;
        check(spvc_resources_get_resource_list_for_type(resources_, type, &items, &count));
        return {items, count};
    }

    [[nodiscard]] ShaderBinding binding(const spvc_reflected_resource& resource) const {
        ShaderBinding result;
        constexpr std::string_view kSuffix = "_buffer";
        result.name = spvc_compiler_get_name(compiler_, resource.base_type_id);
        if (!result.name.ends_with(kSuffix))
            throw DeviceError(shader_ + ": the storage buffer \"" + result.name +
                              "\" must be declared as `buffer NAME_buffer { ... }`");
        result.name.resize(result.name.size() - kSuffix.size());
        spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.type_id);
        if (spvc_type_get_num_array_dimensions(type) > 0)
            result.elements = spvc_type_get_array_dimension(type, 0);
        result.is_written = !isReadOnly(resource);
        result.binding_word = decoration(resource, SpvDecorationBinding, result.name);
        result.set_word = decoration(resource, SpvDecorationDescriptorSet, result.name);
        return result;
    }

    [[nodiscard]] std::uint32_t declaredBytes(const spvc_reflected_resource& resource) const {
        std::size_t bytes = 0;
        check(spvc_compiler_get_declared_struct_size(
            compiler_, spvc_compiler_get_type_handle(compiler_, resource.base_type_id), &bytes));
        return static_cast<std::uint32_t>(bytes);
    }

    [[nodiscard]] uint workgroup(unsigned axis) const {
        return spvc_compiler_get_execution_mode_argument_by_index(compiler_,
                                                                  SpvExecutionModeLocalSize, axis);
    }

    [[nodiscard]] bool isCompute() const {
        return spvc_compiler_get_execution_model(compiler_) == SpvExecutionModelGLCompute;
    }

private:
    void check(spvc_result result) const {
        if (result != SPVC_SUCCESS)
            throw DeviceError(shader_ + ": the SPIR-V cannot be read: " +
                              spvc_context_get_last_error_string(context_.get()));
    }

    bool isReadOnly(const spvc_reflected_resource& resource) const {
        const SpvDecoration* decorations = nullptr;
        std::size_t count = 0;
        check(spvc_compiler_get_buffer_block_decorations(compiler_, resource.id, &decorations,
                                                         &count));
        const std::span<const SpvDecoration> all{decorations, count};
        return std::ranges::find(all, SpvDecorationNonWritable) != all.end();
    }

    std::size_t decoration(const spvc_reflected_resource& resource, SpvDecoration which,
                           const std::string& name) const {
        unsigned word = 0;
        if (!spvc_compiler_get_binary_offset_for_decoration(compiler_, resource.id, which, &word))
            throw DeviceError(shader_ + ": the storage buffer " + name +
                              " has no binding; compile with --auto-map-bindings");
        return word;
    }

    struct Destroy {
        void operator()(spvc_context context) const { spvc_context_destroy(context); }
    };

    std::string shader_;
    std::unique_ptr<spvc_context_s, Destroy> context_;
    spvc_compiler compiler_ = nullptr;
    spvc_resources resources_ = nullptr;
};

} // namespace

ShaderReflection reflectShader(std::span<const std::uint32_t> spirv, const char* shader) {
    const Reflector reflector(spirv, shader);
    ShaderReflection result;
    for (const auto& resource : reflector.list(SPVC_RESOURCE_TYPE_STORAGE_BUFFER))
        result.bindings.push_back(reflector.binding(resource));
    for (const auto& resource : reflector.list(SPVC_RESOURCE_TYPE_PUSH_CONSTANT))
        result.push_constant_bytes = reflector.declaredBytes(resource);
    for (spvc_resource_type type :
         {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, SPVC_RESOURCE_TYPE_STORAGE_IMAGE,
          SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, SPVC_RESOURCE_TYPE_SEPARATE_IMAGE})
        if (!reflector.list(type).empty())
            throw DeviceError(std::string(shader) +
                              ": shaders of hone use storage buffers and push constants only");
    if (reflector.isCompute())
        result.workgroup = {reflector.workgroup(0), reflector.workgroup(1), reflector.workgroup(2)};
    return result;
}

} // namespace hone
