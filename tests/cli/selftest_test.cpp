// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <sstream>

namespace hone::cli {
namespace {

using test::CaseResult;

/// A kit of three cases; the second ends on the first backend as the test says.
ConformanceKit threeCases(CaseResult::Outcome second, const std::string& message) {
    return [=](std::span<const test::TracerUnderTest> tracers) {
        std::vector<CaseResult> results;
        for (const test::TracerUnderTest& tracer : tracers)
            for (const char* name : {"SeesThis", "SeesThat", "SeesAll"}) {
                results.push_back({.tracer = tracer.name, .name = name, .ms = 2});
                if (results.size() == 2) {
                    results.back().outcome = second;
                    results.back().message = message;
                }
            }
        return results;
    };
}

struct Outcome {
    int code;
    std::string out, err;
};

Outcome selftestWith(const ConformanceKit& kit, std::vector<std::string> backends,
                     bool json = false) {
    std::ostringstream out, err;
    SelftestArguments arguments;
    arguments.backends = std::move(backends);
    arguments.device = "none";
    arguments.json = json;
    const int code = selftest(arguments, kit, {out, err});
    return {code, out.str(), err.str()};
}

TEST(Selftest, CountsWhatPassed) {
    const Outcome run =
        selftestWith(threeCases(CaseResult::Outcome::kPassed, ""), {"embree", "brute"}, true);
    EXPECT_EQ(run.code, 0);
    const nlohmann::json json = nlohmann::json::parse(run.out);
    ASSERT_EQ(json["backends"].size(), 2u);
    EXPECT_EQ(json["backends"][1]["name"], "brute");
    EXPECT_EQ(json["backends"][1]["passed"], 3);
    EXPECT_EQ(json["backends"][1]["ms"], 6.0);
}

TEST(Selftest, NamesWhatFailed) {
    const Outcome run =
        selftestWith(threeCases(CaseResult::Outcome::kFailed, "two\nlines"), {"embree"});
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.out.find("embree: failed: SeesThat\n    two\n    lines\n"), std::string::npos)
        << run.out;
}

TEST(Selftest, SaysWhyACaseWasSkipped) {
    const Outcome run =
        selftestWith(threeCases(CaseResult::Outcome::kSkipped, "no device"), {"embree"});
    EXPECT_EQ(run.code, 0);
    EXPECT_NE(run.out.find("embree: skipped: SeesThat\n    no device\n"), std::string::npos);
}

TEST(Selftest, RefusesUnknownBackendsAndBuildsWithoutTheKit) {
    const Outcome unknown =
        selftestWith(threeCases(CaseResult::Outcome::kPassed, ""), {"check(embre)"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_NE(unknown.err.find("did you mean \"check(embree)\"?"), std::string::npos);
    const Outcome without = selftestWith({}, {"embree"});
    EXPECT_EQ(without.code, 2);
    EXPECT_NE(without.err.find("HONE_SELFTEST"), std::string::npos);
}

// The suite itself, in a process of its own.
TEST(Selftest, PassesOnTheReference) {
    FILE* pipe = popen(HONE_PROGRAM " selftest --backends brute --device none --json", "r");
    ASSERT_NE(pipe, nullptr);
    std::string out;
    std::array<char, 4096> part;
    while (const std::size_t count = fread(part.data(), 1, part.size(), pipe))
        out.append(part.data(), count);
    const int status = pclose(pipe);
    EXPECT_EQ(status, 0);
    const nlohmann::json json = nlohmann::json::parse(out);
    EXPECT_GE(json["backends"][0]["passed"], 60);
    EXPECT_EQ(json["backends"][0]["failed"], 0) << out;
}

} // namespace
} // namespace hone::cli
