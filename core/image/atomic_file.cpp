// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/atomic_file.h"

#include "hone/core/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace hone {
namespace {

[[noreturn]] void fail(const std::string& path, const char* step, int error) {
    throw OutputError(path + ": cannot " + step + ": " + std::generic_category().message(error));
}

std::string directoryOf(const std::string& path) {
    std::string parent = std::filesystem::path(path).parent_path().string();
    return parent.empty() ? "." : parent;
}

/// A new file in `directory` that removes itself unless it was renamed. Created with the mode that
/// the user's umask gives, which mkstemp would not.
class TemporaryFile {
public:
    TemporaryFile(const std::string& directory, const std::string& wanted) : wanted_(wanted) {
        static std::atomic<unsigned> counter{0}; // names only; two threads never share one
        for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt) {
            path_ = directory + "/.hone-" + std::to_string(::getpid()) + "-" +
                    std::to_string(counter++) + ".tmp";
            file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (file_ < 0 && errno != EEXIST && errno != EINTR)
                break;
        }
        if (file_ < 0) {
            path_.clear();
            fail(wanted_, "create a temporary file beside it", errno);
        }
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (file_ >= 0)
            ::close(file_);
        if (!path_.empty())
            ::unlink(path_.c_str());
    }

    void write(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = ::write(file_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR)
                continue;
            if (written < 0)
                fail(wanted_, "write", errno);
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
    }

    /// Bytes on the disk first, the name second: the other order may leave an empty file after a
    /// power cut. Network file systems report a full disk as late as here or at close.
    void renameTo(const std::string& path) {
        if (::fsync(file_) != 0)
            fail(wanted_, "flush to the disk", errno);
        if (::close(std::exchange(file_, -1)) != 0)
            fail(wanted_, "close", errno);
        if (::rename(path_.c_str(), path.c_str()) != 0)
            fail(wanted_, "rename the finished file to it", errno);
        path_.clear();
    }

private:
    std::string wanted_;
    std::string path_;
    int file_ = -1;
};

/// Makes a rename last. Some file systems cannot flush a directory and say EINVAL: their business.
void flushDirectory(const std::string& directory, const std::string& wanted) {
    const int file = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0)
        fail(wanted, "open its directory to flush it", errno);
    const int error = ::fsync(file) == 0 ? 0 : errno;
    ::close(file);
    if (error != 0 && error != EINVAL && error != ENOTSUP)
        fail(wanted, "flush its directory", error);
}

} // namespace

void writeFileAtomically(const std::string& path, std::span<const std::byte> bytes) {
    // A rename would replace /dev/null or a pipe by a plain file.
    struct stat status {};
    if (::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
        throw OutputError(path + (S_ISDIR(status.st_mode)
                                      ? ": is a directory; name a file to write"
                                      : ": is no plain file; name a file to write"));

    const std::string directory = directoryOf(path);
    TemporaryFile temporary(directory, path);
    temporary.write(bytes);
    temporary.renameTo(path);
    flushDirectory(directory, path);
}

void requireWritableDirectory(const std::string& path) {
    const std::string directory = path.empty() ? "." : path;
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
        fail(directory, "create this directory", error.value());
    if (!std::filesystem::is_directory(directory, error))
        throw OutputError(directory + ": is no directory; name one to write results to");
    // Only trying tells: permission bits say nothing about read-only file systems, quotas or root.
    TemporaryFile probe(directory, directory);
}

} // namespace hone
