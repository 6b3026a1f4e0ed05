// SPDX-License-Identifier: Apache-2.0
//
// glsl: a shader file as a pass.
//
// A function of a pixel, written in GLSL, compiled when the graph is read and run on any Vulkan
// device. The file says what it takes and gives in lines that begin with #pragma hone; hone writes
// everything else: version, buffers, push constants, and the loop over the pixels.
//
//     #pragma hone doc "Half of an error's best guess, where the picture is dark."
//     #pragma hone in Radiance color "what is looked at"
//     #pragma hone in optional Error guess
//     #pragma hone out Error error
//     #pragma hone param float below = 0.1 min 0 max 1 unit "W/(sr m^2)" "what counts as dark"
//
//     void main() {
//         vec2 e = has_guess ? guess[index] : vec2(1);
//         error = luminance(color[index]) < below ? vec2(0.5 * e.x, e.y) : e;
//     }
//
//     "dark": { "type": "glsl", "shader": "dark.comp", "in": { "color": "raster.color" },
//               "params": { "below": 0.2 } }
//
// Annotations, each a line; a "text" is for people and may be left out:
//     doc "text"                     what the pass does
//     in [optional] TYPE NAME "text" an input: a plane, a list or a record of numbers
//     out TYPE NAME "text"           an output: a plane
//     param float|uint NAME = DEFAULT [min A] [max B] [unit "px"] "text"
//     param bool NAME = true|false "text"
//     param enum NAME = FIRST | SECOND | ... "text"
//
// What main() sees, for the pixel that it is called for:
//     NAME[i]       an element of an input. That of the pixel itself is NAME[index].
//     NAME          an output, a variable: what main() leaves in it becomes the pixel's element; 0
//                   if nothing. Or a parameter.
//     has_NAME      whether an optional input is connected; if not, its elements are 0
//     NAME_count    how many elements a list or record has
//     NAME_CHOICE   the value of an enum parameter for that choice
//     index, count  of this pixel, from 0, row by row from the top left; of all pixels
//     pixel, extent (x, y) of this pixel; width and height
//     neighbour(dx, dy)  the index of the pixel that far to the right and down; at the border, of
//                   the nearest one in the picture
//     luminance(rgb)     of linear RGB with the primaries of sRGB (ITU-R BT.709)
//
// An index beyond an array's end means its last element, one below 0 (or above 2^31) its first, on
// every device. A pixel can write its own elements only, so the result does not depend on the order
// in which pixels are computed. GLSL 4.60 without extensions, images, shared memory or types of
// other than 32 bits; at most 64 KiB of text, 16 ports, 28 parameters and 16 KiB of variables.
// Results may differ between devices in the last bits, as functions like exp() do. A loop that
// never ends hangs the device.
#include "hone/passes/glsl/glsl.h"

#include "hone/core/error.h"
#include "hone/core/graph/reporter.h"
#include "hone/passes/glsl/compile_glsl.h"
#include "hone/passes/glsl/compiler_log.h"
#include "hone/passes/glsl/inspect_spirv.h"
#include "hone/passes/glsl/shader_header.h"
#include "hone/passes/glsl/shader_source.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace hone {
namespace {

constexpr std::size_t kMaxText = std::size_t{64} << 10;

/// The encoder's own push constants, which come first (kernel.glsl.h, HONE_PARAMS).
constexpr std::uint32_t kHeaderBytes = 2 * sizeof(uint);

/// A shader that is ready to run. Offsets are within the parameters of a dispatch.
struct ShaderProgram {
    /// What main() is told of an input beside its elements.
    struct Told {
        std::string port;
        std::size_t has_offset = ParamDecl::npos;
        std::size_t count_offset = ParamDecl::npos;
    };
    std::string name;
    std::vector<std::uint32_t> spirv;
    std::uint64_t content = 0; ///< of the SPIR-V, for Kernel::content
    std::uint32_t params_bytes = 0;
    std::size_t extent_offset = 0;
    std::vector<Told> told;
};

/// FNV-1a, 64 bits.
std::uint64_t hashOf(std::span<const std::uint32_t> words) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const std::byte byte : std::as_bytes(words))
        hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
    return hash;
}

class GlslPass final : public RenderPass {
public:
    explicit GlslPass(ShaderProgram program) : program_(std::move(program)) {}

    void execute(PassContext& context) override {
        std::array<std::byte, kMaxParams> bytes{};
        const std::span<std::byte> params = std::span(bytes).first(program_.params_bytes);
        context.params->writeTo(params);
        const auto write = [&](std::size_t offset, auto value) {
            HONE_ASSERT(offset + sizeof value <= params.size(), program_.name);
            std::memcpy(params.data() + offset, &value, sizeof value);
        };
        write(program_.extent_offset, context.extent);
        for (const ShaderProgram::Told& told : program_.told) {
            const bool is_connected = context.has(told.port);
            if (told.has_offset != ParamDecl::npos)
                write(told.has_offset, is_connected ? 1u : 0u);
            if (told.count_offset != ParamDecl::npos)
                write(told.count_offset, is_connected ? context.in(told.port).count : 0u);
        }

        // What is not connected, or has no room for one element, is a zero to the shader.
        std::array<Argument, kMaxShaderPorts> zeros;
        std::size_t zero_count = 0;
        for (const InPort& port : context.type->inputs)
            if (!context.has(port.name) || context.in(port.name).buffer.bytes < port.type.stride) {
                if (!zero_)
                    zero_ = context.memory->createBuffer(kZeroBytes, "zeros");
                zeros[zero_count++] = {.name = port.name, .buffer = zero_.view()};
            }

        const Kernel kernel{.name = program_.name.c_str(),
                            .spirv = program_.spirv,
                            .params_bytes = program_.params_bytes,
                            .content = program_.content};
        context.dispatchBytes(kernel, params, context.extent.x * context.extent.y,
                              std::span(zeros).first(zero_count));
    }

private:
    static constexpr std::size_t kMaxParams = 120; ///< Vulkan promises 128; the encoder has 8
    static constexpr std::size_t kZeroBytes = 16;  ///< the largest element
    ShaderProgram program_;
    Buffer zero_;
};

/// Names that the shader's author may have meant.
std::vector<std::string> vocabularyOf(const ShaderHeader& header) {
    std::vector<std::string> names{"index", "pixel", "extent", "count", "neighbour", "luminance"};
    for (const ShaderPort& port : header.ports) {
        names.push_back(port.name);
        if (port.is_optional)
            names.push_back(hasMember(port));
        if (port.type.shape != Shape::kPlane)
            names.push_back(countMember(port));
    }
    for (const ShaderParam& param : header.params) {
        names.push_back(param.decl.name);
        for (const std::string& choice : param.decl.choices)
            names.push_back(param.decl.name + "_" + choice);
    }
    return names;
}

ShaderProblem problemAt(const ShaderPlace& place, std::string message, std::string hint) {
    return {place.line, place.column, place.length, std::move(message), std::move(hint)};
}

/// The compiler knows what hone wrote for an annotation as little as its author does: what it says
/// there is about the name.
void nameAnnotations(std::vector<ShaderProblem>& problems, const ShaderHeader& header) {
    const auto rename = [&](const std::string& name, const ShaderPlace& place) {
        for (ShaderProblem& problem : problems)
            if (problem.line == place.line)
                problem = problemAt(place, "GLSL has no place for the name \"" + name + "\"",
                                    "it is a word of the language; choose another name");
    };
    for (const ShaderPort& port : header.ports)
        rename(port.name, port.place);
    for (const ShaderParam& param : header.params)
        rename(param.decl.name, param.place);
}

/// What is wrong with a shader that compiles: what it may not have, what it declares and does not
/// use.
std::vector<ShaderProblem> judge(const ShaderHeader& header, const ShaderFacts& facts,
                                 const std::vector<ShaderLine>& lines) {
    std::vector<ShaderProblem> problems;
    const auto unused = [&](const ShaderPlace& place, std::string message, std::string hint) {
        problems.push_back(problemAt(place, std::move(message), std::move(hint)));
    };
    for (const ShaderFacts::Refused& refused : facts.refused)
        problems.push_back(problemAt(firstPlaceOf(refused.word, lines),
                                     "a shader of hone cannot have " + refused.what, refused.hint));
    for (const std::string& block : facts.buffers) {
        const auto is_it = [&](const ShaderPort& port) { return port.name + "_buffer" == block; };
        if (std::ranges::none_of(header.ports, is_it))
            problems.push_back(problemAt(firstPlaceOf(block, lines),
                                         "the buffer \"" + block + "\" is no port",
                                         "declare it: #pragma hone in TYPE NAME"));
    }
    for (const ShaderPort& port : header.ports)
        if (port.is_output && !facts.uses(port.name))
            unused(port.place, "output \"" + port.name + "\" is never written",
                   "assign it in main(): " + port.name + " = ...");
        else if (!port.is_output && !facts.uses(port.name + "_buffer"))
            unused(port.place, "input \"" + port.name + "\" is never read",
                   "remove the line or read " + port.name + "[index]");
    for (const ShaderParam& param : header.params)
        if (!facts.uses(param.decl.name))
            unused(param.place, "parameter \"" + param.decl.name + "\" is never read",
                   "remove the line or use it in main()");
    return problems;
}

PassType typeOf(const std::string& file, const ShaderHeader& header, const ShaderFacts& facts,
                std::vector<std::uint32_t> spirv) {
    const auto offset = [&](const std::string& constant) {
        return std::size_t{facts.offsetOf(constant) - kHeaderBytes};
    };
    ShaderProgram program;
    program.name = file;
    program.content = hashOf(spirv);
    program.spirv = std::move(spirv);
    for (const ShaderFacts::Member& constant : facts.constants) {
        const std::size_t bytes = constant.name == kExtentMember ? sizeof(uvec2) : sizeof(uint);
        program.params_bytes =
            std::max(program.params_bytes, static_cast<std::uint32_t>(constant.offset + bytes));
    }
    program.params_bytes -= kHeaderBytes;
    program.extent_offset = offset(kExtentMember);

    PassType type(file, header.doc);
    for (const ShaderPort& port : header.ports) {
        if (port.is_output) {
            type.out(port.name, port.type, port.doc);
            continue;
        }
        if (port.is_optional)
            type.inOptional(port.name, port.type, port.doc);
        else
            type.in(port.name, port.type, port.doc);
        ShaderProgram::Told told{.port = port.name};
        if (port.is_optional)
            told.has_offset = offset(hasMember(port));
        if (port.type.shape != Shape::kPlane)
            told.count_offset = offset(countMember(port));
        program.told.push_back(std::move(told));
    }
    for (const ShaderParam& param : header.params) {
        type.params.push_back(param.decl);
        type.into(offset(param.decl.name));
    }
    type.domain = Domain::kDevice;
    type.create = [program = std::move(program)] { return std::make_unique<GlslPass>(program); };
    return type;
}

ShaderPass compileShader(const std::string& file, const std::string& text,
                         std::span<const PortType> types) {
    // What must not reach the compiler.
    if (text.size() > kMaxText)
        return {{},
                {{.message = "the file has " + std::to_string(text.size()) +
                             " bytes; a shader "
                             "has at most " +
                             std::to_string(kMaxText),
                  .hint = "make several passes of it"}}};
    if (text.find('\0') != std::string::npos)
        return {{}, {{.message = "the file is no text: it has a zero byte", .hint = ""}}};
    const std::vector<ShaderLine> lines = linesOf(text);
    ShaderHeader header = parseShaderHeader(text, types);
    std::vector<ShaderProblem> problems = std::move(header.problems);
    std::ranges::move(findForbidden(lines), std::back_inserter(problems));
    if (!problems.empty()) {
        std::ranges::stable_sort(problems, {}, &ShaderProblem::line);
        return {{}, std::move(problems)};
    }

    CompiledGlsl compiled = compileGlsl(wholeSource(header));
    if (!compiled.failure.empty())
        return {{},
                {{.message = "the shader cannot be compiled: " + compiled.failure,
                  .hint = "make it smaller or simpler"}}};
    problems = readCompilerLog(compiled.log, lines, vocabularyOf(header));
    nameAnnotations(problems, header);
    if (compiled.spirv.empty() && problems.empty())
        problems.push_back(
            {.message = "the shader cannot be compiled: " + compiled.log, .hint = ""});
    if (!problems.empty())
        return {{}, std::move(problems)};

    const ShaderFacts facts = inspectSpirv(compiled.spirv);
    if (problems = judge(header, facts, lines); !problems.empty())
        return {{}, std::move(problems)};
    return {typeOf(file, header, facts, std::move(compiled.spirv)), {}};
}

} // namespace

ShaderCompiler glslCompiler(const PassRegistry& registry) {
    return [&registry](const std::string& file, const std::string& text) -> ShaderPass {
        try {
            return compileShader(file, text, graphTypes(registry));
        } catch (const std::exception& error) {
            return {{},
                    {{.message = std::string("the shader cannot be compiled: ") + error.what(),
                      .hint = ""}}};
        }
    };
}

} // namespace hone
