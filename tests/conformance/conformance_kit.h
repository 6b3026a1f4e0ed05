// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/device/device.h"
#include "hone/core/trace/trace_backend.h"

#include <functional>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hone::test {

/// A tracer that the conformance suite runs on.
struct TracerUnderTest {
    std::string name; ///< letters, digits and _
    /// May throw DeviceError where the machine lacks what it needs: its cases are skipped then,
    /// with that reason.
    std::function<std::unique_ptr<TraceBackend>()> make;
    bool is_brute = false; ///< tests every triangle: gets smaller scenes
    bool is_slow = false;  ///< answers few rays a second, or takes long for each list: gets fewer
    /// The device whose buffers its lists may lie in; empty: none.
    std::function<Device*()> memory = {};
};

/// By its name, where GoogleTest prints parameters.
void PrintTo(const TracerUnderTest& tracer, std::ostream* out);

/// What became of one case on one tracer.
struct CaseResult {
    enum class Outcome : std::uint8_t { kPassed, kFailed, kSkipped };
    std::string tracer = {}; ///< TracerUnderTest::name
    std::string name = {};   ///< what it says: SeesTheNearestOfManyLayers
    Outcome outcome = Outcome::kPassed;
    std::string message = {}; ///< why it failed or was skipped
    double ms = 0;
};

/// Runs the suite, all that every trace backend promises (trace_backend.h), on these tracers.
/// Prints nothing. Once in a program, and not inside another GoogleTest run.
///
/// A backend that lives elsewhere links hone::conformance and calls this; or, for a GoogleTest
/// program of its own, addTracer() (conformance.h) before testing::InitGoogleTest.
[[nodiscard]] std::vector<CaseResult> runConformance(std::span<const TracerUnderTest> tracers);

} // namespace hone::test
