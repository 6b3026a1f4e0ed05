// SPDX-License-Identifier: Apache-2.0
//
// hone selftest: holds the trace backends of this program, on this machine, to what every one
// promises.
#include "hone/cli/commands.h"
#include "hone/cli/json.h"
#include "hone/cli/session.h"

#include "hone/core/error.h"
#include "hone/core/graph/reporter.h"
#include "hone/core/trace/choice/backend_name.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;
using test::CaseResult;
using Outcome = CaseResult::Outcome;

struct Tested {
    std::string name;
    std::string problem; ///< why it could not be tested; "" if it could
    TraceCaps caps;
    std::vector<CaseResult> cases;

    [[nodiscard]] std::ptrdiff_t count(Outcome outcome) const {
        return std::ranges::count(cases, outcome, &CaseResult::outcome);
    }
    [[nodiscard]] double ms() const {
        double sum = 0;
        for (const CaseResult& result : cases)
            sum += result.ms;
        return sum;
    }
};

/// GoogleTest's names have letters, digits and _ only.
std::string testName(std::size_t number) {
    return "backend" + std::to_string(number);
}

std::vector<Tested> findBackends(const std::vector<std::string>& names, const Session& session,
                                 const Devices& devices) {
    std::vector<Tested> backends;
    for (const std::string& name : names) {
        Tested tested{.name = name, .problem = {}, .caps = {}, .cases = {}};
        try {
            tested.caps = session.traceBackends().create(name, devices)->caps();
        } catch (const DeviceError& problem) {
            tested.problem = problem.what();
        }
        backends.push_back(std::move(tested));
    }
    return backends;
}

void runCases(std::vector<Tested>& backends, const Session& session, const Devices& devices,
              const ConformanceKit& kit) {
    std::vector<test::TracerUnderTest> tracers;
    for (std::size_t i = 0; i < backends.size(); ++i) {
        const Tested& tested = backends[i];
        if (!tested.problem.empty())
            continue;
        const bool is_on_device = tested.caps.memory == TraceMemory::kDevice;
        tracers.push_back(
            {.name = testName(i),
             .make = [&session, &devices,
                      name = tested.name] { return session.traceBackends().create(name, devices); },
             .is_brute = tested.caps.is_reference,
             .is_slow = is_on_device && devices.memory().info().is_software,
             .memory = [&devices] { return &devices.memory(); }});
    }
    if (tracers.empty())
        return;
    for (CaseResult& result : kit(tracers))
        for (std::size_t i = 0; i < backends.size(); ++i)
            if (result.tracer == testName(i))
                backends[i].cases.push_back(std::move(result));
}

Json toJson(const Tested& tested) {
    Json failures = Json::array(), skips = Json::array();
    for (const CaseResult& result : tested.cases) {
        if (result.outcome == Outcome::kFailed)
            failures.push_back({{"case", result.name}, {"message", result.message}});
        if (result.outcome == Outcome::kSkipped)
            skips.push_back({{"case", result.name}, {"reason", result.message}});
    }
    return {{"name", tested.name},
            {"version", tested.caps.version},
            {"runs_on", tested.caps.runs_on},
            {"problem", tested.problem},
            {"passed", tested.count(Outcome::kPassed)},
            {"failed", tested.count(Outcome::kFailed)},
            {"skipped", tested.count(Outcome::kSkipped)},
            {"ms", tested.ms()},
            {"failures", failures},
            {"skips", skips}};
}

std::string indented(const std::string& text) {
    std::string result = "    ";
    for (const char c : text)
        result += c == '\n' ? std::string("\n    ") : std::string(1, c);
    return result;
}

void printTable(std::ostream& out, const std::vector<Tested>& backends) {
    out << std::left << std::setw(24) << "backend" << std::right << std::setw(8) << "passed"
        << std::setw(8) << "failed" << std::setw(9) << "skipped" << std::setw(9) << "ms"
        << "   runs on\n";
    for (const Tested& tested : backends) {
        out << std::left << std::setw(24) << tested.name << std::right;
        if (!tested.problem.empty())
            out << "  not here: " << tested.problem << "\n";
        else
            out << std::setw(8) << tested.count(Outcome::kPassed) << std::setw(8)
                << tested.count(Outcome::kFailed) << std::setw(9) << tested.count(Outcome::kSkipped)
                << std::setw(9) << std::llround(tested.ms()) << "   " << tested.caps.runs_on
                << "\n";
    }
    for (const Tested& tested : backends)
        for (const CaseResult& result : tested.cases)
            if (result.outcome != Outcome::kPassed)
                out << tested.name
                    << (result.outcome == Outcome::kFailed ? ": failed: " : ": skipped: ")
                    << result.name << "\n"
                    << indented(result.message) << "\n";
}

} // namespace

int selftest(const SelftestArguments& arguments, const ConformanceKit& kit,
             const Console& console) {
    if (!kit) {
        console.err << "this hone was built without its conformance suite: build it where "
                       "GoogleTest is installed (-DHONE_SELFTEST=ON)\n";
        return kUsage;
    }
    Session session(arguments.plugins);
    std::vector<std::string> names = arguments.backends;
    if (names.empty()) {
        names = session.traceBackends().names();
        std::erase(names, "null"); // promises nothing
    }
    for (std::string& name : names) {
        if (name == "auto")
            name = session.traceBackends().preferred();
        if (session.traceBackends().contains(name))
            continue;
        const std::vector<std::string> known = session.traceBackends().names();
        console.err << "this program has no trace backend \"" << name << "\"; "
                    << suggest(name, similarNames(name, known), "it has") << "\n";
        return kUsage;
    }
    const Devices devices = session.openDevices(arguments.device, false);

    std::vector<Tested> backends = findBackends(names, session, devices);
    runCases(backends, session, devices, kit);

    Json rows = Json::array();
    std::ptrdiff_t tested = 0, failed = 0;
    for (const Tested& backend : backends) {
        rows.push_back(toJson(backend));
        tested += backend.problem.empty() ? 1 : 0;
        failed += backend.count(Outcome::kFailed);
    }
    if (arguments.json)
        print(console.out, {{"backends", rows}});
    else
        printTable(console.out, backends);
    // Of all backends some may be missing; those that were asked for may not.
    const bool is_missing =
        tested == 0 || (!arguments.backends.empty() && tested < std::ssize(backends));
    return failed > 0 ? kTargetNotMet : is_missing ? kNoDevice : kOk;
}

} // namespace hone::cli
