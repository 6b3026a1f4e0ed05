// SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C while a graph runs.
#include "hone/cli/commands.h"
#include "hone/tests/cli/command_run.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace hone::cli {
namespace {

/// Sends a signal to this process again and again from some time on, which whoever does not expect
/// it ignores.
class Nagging {
public:
    explicit Nagging(int signal)
        : signal_(signal), previous_(std::signal(signal, SIG_IGN)),
          thread_([signal](const std::stop_token& stop) {
              std::this_thread::sleep_for(std::chrono::milliseconds(600));
              for (; !stop.stop_requested();
                   std::this_thread::sleep_for(std::chrono::milliseconds(10)))
                  std::raise(signal);
          }) {}
    ~Nagging() {
        thread_.request_stop();
        thread_.join();
        std::signal(signal_, previous_);
    }
    Nagging(const Nagging&) = delete;
    Nagging& operator=(const Nagging&) = delete;

private:
    int signal_;
    void (*previous_)(int);
    std::jthread thread_;
};

class InterruptedCommand : public testing::TestWithParam<std::pair<int, int>> {};

// Half a minute's work in iterations of half a second.
TEST_P(InterruptedCommand, RendersWhatIsThereAndEndsWithItsCode) {
    const auto [signal, code] = GetParam();
    const TemporaryFolder folder;
    const Nagging nagging(signal);
    const auto begin = std::chrono::steady_clock::now();
    const CommandRun run =
        runHone({"render", "prt", "--scene", "builtin:cornell", "--size", "64x48", "--set",
                 "samples=20000", "--set", "batch=64", "-o", folder.path("out"), "--json"});
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_LT(passed.count(), 5);
    const nlohmann::json report = run.json();
    EXPECT_EQ(report["stop"], "cancelled");
    for (const nlohmann::json& path : report["outputs"])
        EXPECT_TRUE(std::filesystem::is_regular_file(path.get<std::string>())) << path;
}

// Before the first view's truth, half a minute's work, is traced.
TEST_P(InterruptedCommand, LeavesNothingOfAMeasurement) {
    if (!whyNoRaster().empty())
        GTEST_SKIP() << whyNoRaster();
    const auto [signal, code] = GetParam();
    const std::vector<std::vector<std::string>> commands{{"measure", "sir", "-o", ""},
                                                         {"bench", "figure10", "-o", ""},
                                                         {"fit", "sir", "-o", "fitted.json"}};
    for (std::vector<std::string> arguments : commands) {
        SCOPED_TRACE(arguments.front());
        const TemporaryFolder folder;
        arguments.back() = folder.path(arguments.back());
        for (const char* more :
             {"--scene", "builtin:cornell", "--size", "64x48", "--truth-samples", "20000"})
            arguments.emplace_back(more);
        const Nagging nagging(signal);
        const auto begin = std::chrono::steady_clock::now();
        const CommandRun run = runHone(arguments);
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
        EXPECT_EQ(run.code, code) << run.err;
        EXPECT_LT(passed.count(), 5);
        EXPECT_NE(run.err.find("interrupted while views were measured"), std::string::npos)
            << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    }
}

INSTANTIATE_TEST_SUITE_P(All, InterruptedCommand,
                         testing::Values(std::pair(SIGINT, 130), std::pair(SIGTERM, 143)),
                         [](const auto& test) {
                             return test.param.first == SIGINT ? "Sigint" : "Sigterm";
                         });

} // namespace
} // namespace hone::cli
