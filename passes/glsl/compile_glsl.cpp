// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/compile_glsl.h"

#include "hone/core/error.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/optimizer.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <span>

namespace hone {
namespace {

constexpr rlim_t kMaxSeconds = 3;             ///< of processor time
constexpr int kMaxWaitMs = 30'000;            ///< without a word, on a busy machine
constexpr rlim_t kMaxBytes = rlim_t{1} << 30; ///< beyond what the process has
#ifdef __SANITIZE_ADDRESS__                   // maps terabytes
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif
constexpr std::size_t kMaxAnswer = std::size_t{4} << 20;

/// glslang and the SPIR-V optimiser on one text.
CompiledGlsl compileHere(const std::string& source) {
    CompiledGlsl result;
    // The shader must outlive the program that it is linked into.
    glslang::TShader shader(EShLangCompute);
    glslang::TProgram program;
    const char* const text = source.c_str();
    shader.setStrings(&text, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    constexpr auto kRules =
        static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgCascadingErrors);
    // There is nothing to include: no includer is given.
    const bool is_parsed = shader.parse(GetDefaultResources(), 460, false, kRules);
    result.log = shader.getInfoLog();
    if (!is_parsed)
        return result;
    program.addShader(&shader);
    const bool is_linked = program.link(kRules);
    result.log += program.getInfoLog();
    if (!is_linked)
        return result;
    std::vector<std::uint32_t> spirv;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), spirv);

    // Clamp indices (spirv-opt --graphics-robust-access). It checks the SPIR-V, too.
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* message) {
            result.log += std::string("ERROR: ") + message + "\n";
        });
    optimizer.RegisterPass(spvtools::CreateGraphicsRobustAccessPass());
    spvtools::ValidatorOptions validator;
    validator.SetScalarBlockLayout(true);
    spvtools::OptimizerOptions options;
    options.set_validator_options(validator);
    if (!optimizer.Run(spirv.data(), spirv.size(), &result.spirv, options))
        result.spirv.clear();
    return result;
}

/// glslang's state of the process. Its tables of built-in functions are made with the first text,
/// here a trusted one, so that the processes to come inherit them.
struct Glslang {
    Glslang() {
        glslang::InitializeProcess();
        const CompiledGlsl warm =
            compileHere("#version 460\nlayout(local_size_x = 64) in;\nvoid main() {}\n");
        HONE_ASSERT(!warm.spirv.empty(), warm.log);
    }
    ~Glslang() { glslang::FinalizeProcess(); }
};

void writeAll(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = write(file, bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR)
            _exit(1);
        bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
}

void setLimit(__rlimit_resource which, rlim_t value) {
    rlimit limit{};
    getrlimit(which, &limit);
    limit.rlim_cur = std::min(value, limit.rlim_max);
    setrlimit(which, &limit);
}

/// Bytes of address space that the process has taken.
rlim_t bytesMapped() {
    unsigned long pages = 0;
    if (std::FILE* const file = std::fopen("/proc/self/statm", "r")) {
        if (std::fscanf(file, "%lu", &pages) != 1)
            pages = 0;
        std::fclose(file);
    }
    return rlim_t{pages} * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

/// The child: the log's length, the log, the SPIR-V.
[[noreturn]] void answer(const std::string& source, int file) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGPIPE})
        std::signal(signal, SIG_DFL);
    setLimit(RLIMIT_CORE, 0);
    setLimit(RLIMIT_CPU, kMaxSeconds);
    if (const rlim_t mapped = kLimitsMemory ? bytesMapped() : 0; mapped > 0)
        setLimit(RLIMIT_AS, mapped + kMaxBytes);
    try {
        const CompiledGlsl result = compileHere(source);
        const std::uint64_t log_bytes = result.log.size();
        writeAll(file, std::as_bytes(std::span(&log_bytes, 1)));
        writeAll(file, std::as_bytes(std::span(result.log)));
        writeAll(file, std::as_bytes(std::span(result.spirv)));
        _exit(0);
    } catch (...) {
        _exit(1);
    }
}

std::string whyItEnded(int status) {
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return "it takes more than " + std::to_string(kMaxSeconds) + " s to compile";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
        return "it took more than " + std::to_string(kMaxWaitMs / 1000) +
               " s to compile, or somebody ended the compiler";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV)
        return "it is nested too deeply to be compiled";
    if (WIFSIGNALED(status))
        return "the GLSL compiler fell over it (signal " + std::to_string(WTERMSIG(status)) + ")";
    return "it takes more than " + std::to_string(kMaxBytes >> 20) + " MiB to compile";
}

} // namespace

CompiledGlsl compileGlsl(const std::string& source) {
    static const Glslang glslang;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw OutOfMemory("no pipe for compiling a shader: " + std::string(std::strerror(errno)));
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        answer(source, ends[1]);
    }
    close(ends[1]);
    std::string bytes;
    if (child > 0) {
        char block[1 << 14];
        for (ssize_t count = 1; count != 0 && bytes.size() <= kMaxAnswer;) {
            pollfd answers{.fd = ends[0], .events = POLLIN, .revents = 0};
            if (poll(&answers, 1, kMaxWaitMs) == 0)
                kill(child, SIGKILL);
            count = read(ends[0], block, sizeof block);
            if (count > 0)
                bytes.append(block, static_cast<std::size_t>(count));
            else if (count < 0 && errno != EINTR)
                break;
        }
    }
    close(ends[0]);
    if (child < 0)
        throw OutOfMemory("no process for compiling a shader: " +
                          std::string(std::strerror(errno)));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }

    CompiledGlsl result;
    std::uint64_t log_bytes = 0;
    const bool is_whole = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (bytes.size() > kMaxAnswer) {
        result.failure = "what it compiles to is too large";
    } else if (!is_whole || bytes.size() < sizeof log_bytes) {
        result.failure = whyItEnded(status);
    } else {
        std::memcpy(&log_bytes, bytes.data(), sizeof log_bytes);
        result.log = bytes.substr(sizeof log_bytes, log_bytes);
        const std::size_t begin = sizeof log_bytes + result.log.size();
        result.spirv.resize((bytes.size() - begin) / sizeof(std::uint32_t));
        if (!result.spirv.empty())
            std::memcpy(result.spirv.data(), bytes.data() + begin,
                        result.spirv.size() * sizeof(std::uint32_t));
    }
    return result;
}

} // namespace hone
