// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/cli/pin.h"
#include "hone/core/graph/compiled_graph.h"
#include "hone/core/image/flip.h"
#include "hone/core/math.h"
#include "hone/tests/conformance/conformance_kit.h"

#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace hone::cli {

/// What a command ended with; DESIGN: published, tested.
enum ExitCode : int {
    kOk = 0,
    kTargetNotMet = 1,
    kUsage = 2,
    kBadInput = 3,
    kPluginFailed = 4,
    kNoDevice = 5,
    kNoMemory = 6,
    kNotWritten = 7,
    kInterrupted = 130,
    kInternal = 70,
};

/// Holds trace backends to what every one promises (test::runConformance).
using ConformanceKit =
    std::function<std::vector<test::CaseResult>(std::span<const test::TracerUnderTest>)>;

/// Where a command speaks: data for programs to `out`, everything for people to `err`.
struct Console {
    std::ostream& out;
    std::ostream& err;
    bool err_is_terminal = false; ///< live progress and colour only then
};

/// What every command takes that opens a Session.
struct SessionArguments {
    std::vector<std::string> plugins; ///< files to load
};

struct CheckArguments : SessionArguments {
    std::vector<std::string> graphs;
    Overrides overrides;
    bool plan = false; ///< print the plan's dump,
    uvec2 size{0, 0};  ///< with what memories take for this size; 0 = per element
    bool json = false;
};

struct ExplainArguments : SessionArguments {
    std::string target; ///< a diagnostic's code, or a graph; "" = list the codes
    std::string value;  ///< of the graph: "pass", "pass.port"
    Overrides overrides;
    bool json = false;
};

struct PassesArguments : SessionArguments {
    std::string name; ///< "" = list
    bool json = false;
};

struct NewPassArguments : SessionArguments {
    std::string name;             ///< of the pass type
    std::string output_directory; ///< "" = the name, dots as _
};

struct CompareArguments : SessionArguments {
    std::string a, b;
    std::string layer;    ///< of EXR files; "" = the first with three channels
    std::string heat_map; ///< PNG to write; "" = none
    std::string flip_map; ///< the same of FLIP
    double pixels_per_degree = kPixelsPerDegree;
    double max_difference = -1; ///< exit 1 past it; negative = never
    long long max_differing_bits = -1;
    bool explain = false; ///< ask the backends of both images why pixels differ
    bool json = false;
};

struct DoctorArguments : SessionArguments {
    bool json = false;
};

struct RenderArguments : SessionArguments {
    std::string graph;
    std::string scene = "builtin:atrium";
    std::string camera;
    uint frames = 0;  ///< of a camera path; 0 = one picture from the camera
    std::string path; ///< "" = the scene's first
    uvec2 size{800, 600};
    Overrides overrides;
    std::string output_directory = "out";
    std::string device; ///< Vulkan device: part of its name; "none"
    int threads = 0;    ///< 0 = all
    std::uint64_t seed = 0;
    double max_ms = 0;
    std::uint64_t max_rays = 0;
    std::uint64_t iterations = 0;
    long long max_copies = -1; ///< between memories; more fail the run; negative = no limit
    std::string reference;     ///< an image to compare "color" with
    std::string record;        ///< file to write every ray and answer to; "" = none
    std::uint64_t record_limit = std::uint64_t{1} << 30; ///< bytes of it
    std::vector<PinRequest> pins;                        ///< values to save besides the outputs
    std::string trace;     ///< file to write when each pass ran; "" = none
    bool validate = false; ///< Vulkan validation layer; messages fail the run
    bool quiet = false;
    bool json = false;
};

struct DrawArguments : RenderArguments {
    std::string output; ///< *.svg, *.png, *.pdf by Graphviz, *.dot; "" = DOT on standard output
    bool times = false; ///< run the graph once and show how long each pass took
};

struct ReplayArguments : SessionArguments {
    std::string file;
    std::string backend; ///< "" = the one that was recorded; "all"
    std::string scene;   ///< "" = the one that was recorded
    std::string device;
    bool json = false;
};

struct SelftestArguments : SessionArguments {
    std::vector<std::string> backends; ///< empty: all
    std::string device;
    bool json = false;
};

struct DemoArguments : SessionArguments {
    std::string output_directory = "out/demo";
    std::string device;
    uvec2 size{960, 640};
};

struct BenchPartsArguments : SessionArguments {
    std::string scene;
    std::string camera;
    std::vector<uvec2> sizes{{800, 600}, {1024, 768}, {1920, 1080}};
    int repeats = 5;
    bool json = false;
};

struct BenchTable1Arguments : SessionArguments {
    std::string graph = "table1"; ///< what refines
    std::string scene;
    std::string camera; ///< whose field of view and lens the chosen views take
    std::vector<uvec2> sizes{{800, 600}, {1024, 768}, {1920, 1080}};
    std::vector<uint> samples{1, 16};  ///< 1: as the paper did it, lights are points
    std::string visibility = "raster"; ///< who says what the raster image sees, or "rays"
    int repeats = 5;
    bool json = false;
};

struct BenchTracersArguments : SessionArguments {
    std::string scene;
    std::string camera;
    uvec2 size{800, 600};
    std::vector<std::string> backends; ///< empty: all that work here and are no reference
    int repeats = 3;
    bool json = false;
};

struct BenchExecutorArguments : SessionArguments {
    uvec2 size{800, 600};
    int passes = 100;
    int repeats = 21; ///< frames; the median counts
    bool json = false;
};

/// By what raster image and truth may differ while metrics are judged.
enum class MeasuredEffect : std::uint8_t { kAll, kReflection, kShadow, kDof, kNone };

struct MeasureArguments : SessionArguments {
    std::string graph = "sir";
    std::string scene = "builtin:atrium";
    uvec2 size{400, 300};
    Overrides overrides;
    std::string truth = "prt";       ///< the graph whose output "color" is the truth
    std::uint32_t truth_samples = 0; ///< 0 = as many as the graph's own "samples"
    MeasuredEffect effect = MeasuredEffect::kAll;
    std::size_t views = 8;
    std::string output_directory; ///< "" = no files
    std::string device;
    std::uint64_t seed = 0;
    bool markdown = false; ///< the table of measure for documents
    bool json = false;
};

struct FitArguments : MeasureArguments {
    std::string method = "both"; ///< "random", "nnls", "both"
    std::uint64_t tuples = 1000; ///< of the random search
    double greatest = 1;         ///< weight that it tries
    std::string output;          ///< graph file to write; "" = none
};

struct UpgradeArguments {
    std::vector<std::string> graphs;
    bool print = false; ///< the new text on standard output, instead of into the file
};

int check(const CheckArguments& arguments, const Console& console);
int upgrade(const UpgradeArguments& arguments, const Console& console);
int explain(const ExplainArguments& arguments, const Console& console);
/// Prints the JSON Schema of graph files.
int schema(const SessionArguments& arguments, const Console& console);
int passes(const PassesArguments& arguments, const Console& console);
int newPass(const NewPassArguments& arguments, const Console& console);
int compare(const CompareArguments& arguments, const Console& console);
int doctor(const DoctorArguments& arguments, const Console& console);
int render(const RenderArguments& arguments, const Console& console);
int draw(const DrawArguments& arguments, const Console& console);
int replay(const ReplayArguments& arguments, const Console& console);
int selftest(const SelftestArguments& arguments, const ConformanceKit& kit, const Console& console);
int demo(const DemoArguments& arguments, const Console& console);
int benchParts(const BenchPartsArguments& arguments, const Console& console);
int benchTable1(const BenchTable1Arguments& arguments, const Console& console);
int benchTracers(const BenchTracersArguments& arguments, const Console& console);
int benchExecutor(const BenchExecutorArguments& arguments, const Console& console);
int benchFigure10(const MeasureArguments& arguments, const Console& console);
int measure(const MeasureArguments& arguments, const Console& console);
int fit(const FitArguments& arguments, const Console& console);

/// Reads the command line, runs the command, turns exceptions into one message and an exit code.
/// `kit`: what selftest runs; empty where the program was built without.
int runCommandLine(int argc, const char* const* argv, std::ostream& out, std::ostream& err,
                   const ConformanceKit& kit = {});

/// A shipped graph by file or by name: "sir" and "graphs/sir.json" find the installed or source
/// tree's graph when no such file is in the working directory.
[[nodiscard]] std::string findGraph(const std::string& name);

} // namespace hone::cli
