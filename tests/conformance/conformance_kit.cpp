// SPDX-License-Identifier: Apache-2.0
#include "hone/tests/conformance/conformance_kit.h"

#include "hone/tests/conformance/conformance.h"

#include <tuple>

namespace hone::test {
namespace {

/// Takes down results where GoogleTest would print them.
class ResultListener final : public testing::EmptyTestEventListener {
public:
    explicit ResultListener(std::vector<CaseResult>& results) : results_(results) {}

    void OnTestEnd(const testing::TestInfo& info) override {
        const std::string name = info.name(); // "SeesThat/tracer"
        const std::size_t slash = name.rfind('/');
        if (slash == std::string::npos)
            return;
        const testing::TestResult& result = *info.result();
        CaseResult found{.tracer = name.substr(slash + 1), .name = name.substr(0, slash)};
        found.ms = static_cast<double>(result.elapsed_time());
        if (result.Skipped())
            found.outcome = CaseResult::Outcome::kSkipped;
        if (result.Failed())
            found.outcome = CaseResult::Outcome::kFailed;
        for (int i = 0; i < result.total_part_count(); ++i) {
            const testing::TestPartResult& part = result.GetTestPartResult(i);
            if (part.passed())
                continue;
            found.message += (found.message.empty() ? "" : "\n") + std::string(part.message());
        }
        results_.push_back(std::move(found));
    }

private:
    std::vector<CaseResult>& results_;
};

} // namespace

std::vector<CaseResult> runConformance(std::span<const TracerUnderTest> tracers) {
    for (const TracerUnderTest& tracer : tracers)
        addTracer(tracer);
    int argc = 1;
    char name[] = "conformance";
    char* argv[] = {name, nullptr};
    testing::InitGoogleTest(&argc, argv);
    // Whatever the environment says: these cases, once, in their order.
    GTEST_FLAG_SET(filter, "All/TracerConformance.*");
    GTEST_FLAG_SET(output, "");
    GTEST_FLAG_SET(repeat, 1);
    GTEST_FLAG_SET(shuffle, false);
    GTEST_FLAG_SET(break_on_failure, false);
    GTEST_FLAG_SET(fail_fast, false);

    std::vector<CaseResult> results;
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    ResultListener listener(results);
    listeners.Append(&listener);
    std::ignore = RUN_ALL_TESTS(); // its verdict is in the results
    listeners.Release(&listener);
    return results;
}

} // namespace hone::test
