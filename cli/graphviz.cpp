// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/graphviz.h"

#include "hone/core/error.h"
#include "hone/core/printable.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace hone::cli {
namespace {

/// A file without a name: gone when it is closed, whatever happens. Through files, not pipes,
/// neither side can wait for the other.
struct ScratchFile {
    ScratchFile() : file(std::tmpfile(), &std::fclose) {
        if (file == nullptr)
            throw OutputError(std::string("cannot create a temporary file: ") +
                              std::strerror(errno));
    }
    [[nodiscard]] std::string text() const {
        std::rewind(file.get());
        std::string result;
        char block[4096];
        while (const std::size_t bytes = std::fread(block, 1, sizeof block, file.get()))
            result.append(block, bytes);
        return result;
    }
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file;
};

} // namespace

std::string runDot(const std::string& drawing, const std::string& format) {
    const ScratchFile in, out, err;
    std::fwrite(drawing.data(), 1, drawing.size(), in.file.get());
    if (std::fflush(in.file.get()) != 0)
        throw OutputError(std::string("cannot write a temporary file: ") + std::strerror(errno));
    std::rewind(in.file.get());

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(in.file.get()), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(out.file.get()), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(err.file.get()), STDERR_FILENO);
    std::string program = "dot";
    std::string option = "-T" + format;
    char* const arguments[] = {program.data(), option.data(), nullptr};
    pid_t child = 0;
    const int failure = posix_spawnp(&child, "dot", &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0)
        throw OutputError(std::string("cannot run Graphviz' dot: ") + std::strerror(failure) +
                          "; install it (apt-get install graphviz), or write its language: "
                          "-o FILE.dot");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    // A shell's 127: some systems tell only there that there is no such program.
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw OutputError("Graphviz' dot failed: " + printable(err.text()) +
                          "; -o FILE.dot writes what it was given");
    return out.text();
}

} // namespace hone::cli
