// SPDX-License-Identifier: Apache-2.0
#include "hone/core/image/atomic_file.h"

#include "hone/core/error.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace hone {
namespace {

class AtomicFile : public ::testing::Test {
protected:
    void SetUp() override {
        std::filesystem::remove_all(directory_);
        std::filesystem::create_directories(directory_);
    }
    void TearDown() override { std::filesystem::remove_all(directory_); }
    [[nodiscard]] std::string path(const std::string& name) const {
        return (directory_ / name).string();
    }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(directory_), {}));
    }
    static std::string contents(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static std::span<const std::byte> bytesOf(std::string_view text) {
        return std::as_bytes(std::span(text.data(), text.size()));
    }
    static std::string messageOf(const std::string& file, std::string_view text) {
        try {
            writeFileAtomically(file, bytesOf(text));
        } catch (const OutputError& error) {
            return error.what();
        }
        return "no error";
    }

    std::filesystem::path directory_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("hone_atomic_") +
         ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(AtomicFile, WritesAndReplaces) {
    writeFileAtomically(path("a"), bytesOf("first"));
    EXPECT_EQ(contents(path("a")), "first");
    writeFileAtomically(path("a"), bytesOf("second, longer"));
    EXPECT_EQ(contents(path("a")), "second, longer");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, WritesNothingAtAll) {
    writeFileAtomically(path("a"), {});
    EXPECT_EQ(contents(path("a")), "");
}

TEST_F(AtomicFile, LongestNameFits) {
    const std::string name(255, 'n');
    writeFileAtomically(path(name), bytesOf("x"));
    EXPECT_EQ(contents(path(name)), "x");
}

TEST_F(AtomicFile, MissingDirectoryIsAnErrorWithPathAndReason) {
    const std::string message = messageOf(path("absent/a"), "x");
    EXPECT_NE(message.find("absent/a"), std::string::npos);
    EXPECT_NE(message.find("No such file or directory"), std::string::npos) << message;
}

TEST_F(AtomicFile, DirectoryIsNotReplaced) {
    EXPECT_NE(messageOf(directory_.string(), "x").find("is a directory"), std::string::npos);
}

TEST_F(AtomicFile, DeviceIsNotReplaced) {
    EXPECT_NE(messageOf("/dev/null", "x").find("no plain file"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFile, FailedWriteLeavesTheOldFileAndNoTemporary) {
    writeFileAtomically(path("a"), bytesOf("old"));
    // A limit on the file size stands in for a full disk: write() fails half-way.
    rlimit old{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
    rlimit small = old;
    small.rlim_cur = 4096;
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string message = messageOf(path("a"), std::string(100000, 'x'));
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &old), 0);
    std::signal(SIGXFSZ, handler);

    EXPECT_NE(message.find("cannot write: File too large"), std::string::npos) << message;
    EXPECT_EQ(contents(path("a")), "old");
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, OutputDirectoryIsCreatedWithItsParents) {
    requireWritableDirectory(path("x/y/z"));
    EXPECT_TRUE(std::filesystem::is_directory(path("x/y/z")));
    EXPECT_TRUE(std::filesystem::is_empty(path("x/y/z")));
    requireWritableDirectory(path("x/y/z"));
}

TEST_F(AtomicFile, OutputDirectoryThatIsAFileIsAnError) {
    writeFileAtomically(path("a"), bytesOf("x"));
    EXPECT_THROW(requireWritableDirectory(path("a")), OutputError);
    EXPECT_THROW(requireWritableDirectory(path("a/b")), OutputError);
}

TEST_F(AtomicFile, OutputDirectoryThatRefusesFilesIsAnError) {
    // Not even root creates files there.
    EXPECT_THROW(requireWritableDirectory("/proc"), OutputError);
}

} // namespace
} // namespace hone
