// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/command_options.h"
#include "hone/cli/install_paths.h"
#include "hone/cli/interrupt_guard.h"
#include "hone/core/error.h"
#include "hone/core/log.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <tuple>

#include <unistd.h>

namespace hone::cli {
namespace {

/// Runs `command` and turns what it throws into one message and an exit code.
int guarded(const std::function<int()>& command, std::ostream& err) {
    const auto report = [&](const std::exception& problem, int code) {
        err << problem.what() << (std::string_view(problem.what()).ends_with('\n') ? "" : "\n");
        return code;
    };
    try {
        return command();
    } catch (const GraphError& problem) {
        return report(problem, kBadInput);
    } catch (const SceneError& problem) {
        return report(problem, kBadInput);
    } catch (const InputError& problem) {
        return report(problem, kBadInput);
    } catch (const PluginError& problem) {
        return report(problem, kPluginFailed);
    } catch (const DeviceError& problem) {
        return report(problem, kNoDevice);
    } catch (const OutOfMemory& problem) {
        return report(problem, kNoMemory);
    } catch (const std::bad_alloc&) {
        err << "out of memory\n";
        return kNoMemory;
    } catch (const CheckFailed& problem) {
        return report(problem, kTargetNotMet);
    } catch (const OutputError& problem) {
        return report(problem, kNotWritten);
    } catch (const Interrupted& stop) {
        return report(stop, stop.code);
    } catch (const std::exception& problem) {
        err << "internal error, please report it: ";
        return report(problem, kInternal);
    }
}

} // namespace

std::string findGraph(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::is_regular_file(name, ignored))
        return name;
    const fs::path shipped = shippedGraphs() / fs::path(name).filename();
    for (const fs::path& candidate : {shipped, fs::path(shipped.string() + ".json")})
        if (fs::is_regular_file(candidate, ignored))
            return candidate.string();
    return name; // the reader's own message says that it is not there
}

int runCommandLine(int argc, const char* const* argv, std::ostream& out, std::ostream& err,
                   const ConformanceKit& kit) {
    const Console console{out, err, &err == &std::cerr && isatty(STDERR_FILENO) != 0};
    CLI::App app{
        "Render graphs that rasterise first and trace the worst pixels: smart image refinement.\n"
        "First steps:  hone demo   |   hone render sir --scene builtin:cornell   |   hone passes"};
    app.name("hone");
    app.set_version_flag("--version", std::string("hone ") + HONE_VERSION);
    app.require_subcommand(1);
    bool verbose = false;
    app.add_flag("-v,--verbose", verbose, "say what is chosen and built");
    std::vector<std::string> plugins;
    app.add_option("--plugin", plugins,
                   "a plug-in to load; repeatable. Also searched: the folders of HONE_PLUGIN_PATH")
        ->type_name("FILE")
        ->allow_extra_args(false);
    app.fallthrough(); // options of all commands may follow a command's name

    std::function<int()> command;
    const auto chosen = [&command](CLI::App* sub, std::function<int()> run) {
        sub->callback([&command, run = std::move(run)] { command = run; });
    };

    DemoArguments demo_arguments;
    CLI::App* demo_app =
        app.add_subcommand("demo", "render the built-in atrium and show what refinement does");
    demo_app->add_option("-o,--output", demo_arguments.output_directory, "folder for the pictures")
        ->capture_default_str();
    demo_app->add_option("--device", demo_arguments.device,
                         "Vulkan device: part of its name, or its index");
    addSize(demo_app, "--size", demo_arguments.size, "picture size (960x640)");
    chosen(demo_app, [&] { return demo(demo_arguments, console); });

    RenderArguments render_arguments;
    CLI::App* render_app = app.add_subcommand("render", "run a graph and write its outputs");
    render_app
        ->add_option("graph", render_arguments.graph,
                     "graph file, or a shipped graph's name (sir, prt, …)")
        ->required();
    render_app
        ->add_option("--scene", render_arguments.scene, "*.scene.json, .gltf, .glb or builtin:NAME")
        ->capture_default_str();
    CLI::Option* camera_option = render_app->add_option("--camera", render_arguments.camera,
                                                        "a camera of the scene (its first)");
    CLI::Option* frames_option =
        render_app
            ->add_option("--frames", render_arguments.frames,
                         "render so many pictures along a camera path, to numbered files")
            ->check(CLI::Range(1, 1000000))
            ->excludes(camera_option);
    render_app
        ->add_option("--path", render_arguments.path,
                     "the camera path (the scene's first; around its first camera's target where "
                     "it has none)")
        ->needs(frames_option);
    addSize(render_app, "--size", render_arguments.size, "image size (800x600)");
    addOverrides(render_app, render_arguments.overrides);
    render_app
        ->add_option("-o,--output", render_arguments.output_directory, "folder for the images")
        ->capture_default_str();
    render_app->add_option("--device", render_arguments.device,
                           "Vulkan device: part of its name, its index, or none");
    render_app
        ->add_option("--threads", render_arguments.threads,
                     "threads for kernels and rays (0 = all)")
        ->check(CLI::NonNegativeNumber);
    render_app->add_option("--seed", render_arguments.seed, "random numbers' seed (0)");
    render_app->add_option("--max-ms", render_arguments.max_ms, "stop refining after so long")
        ->check(CLI::NonNegativeNumber);
    render_app->add_option("--max-rays", render_arguments.max_rays,
                           "stop refining after so many rays");
    render_app->add_option("--iterations", render_arguments.iterations,
                           "stop refining after so many batches");
    render_app
        ->add_option("--max-copies", render_arguments.max_copies,
                     "exit 1 if more than so many things are copied between memories (0 = none)")
        ->check(CLI::NonNegativeNumber);
    render_app
        ->add_option("--reference", render_arguments.reference,
                     "compare the color output with this image")
        ->excludes(frames_option);
    addPins(render_app, render_arguments.pins);
    render_app->add_option("--trace", render_arguments.trace,
                           "write when each pass ran to this file, for chrome://tracing, Perfetto");
    render_app->add_option("--record", render_arguments.record,
                           "write every ray and its answer to this file, for hone replay");
    render_app
        ->add_option("--record-limit", render_arguments.record_limit,
                     "stop recording at so many bytes (1073741824; units like 4GB work)")
        ->transform(CLI::AsSizeValue(false));
    render_app->add_flag("--validate", render_arguments.validate,
                         "run Vulkan's validation layer; a message fails the run");
    render_app->add_flag("-q,--quiet", render_arguments.quiet, "no progress and no summary");
    render_app->add_flag("--json", render_arguments.json, "one JSON object on standard output");
    chosen(render_app, [&] { return render(render_arguments, console); });

    CheckArguments check_arguments;
    CLI::App* check_app =
        app.add_subcommand("check", "report every problem in graph files; opens no device");
    check_app->add_option("graphs", check_arguments.graphs, "graph files")->required();
    addOverrides(check_app, check_arguments.overrides);
    CLI::Option* plan_option =
        check_app->add_flag("--plan", check_arguments.plan, "print the compiled plan");
    addSize(check_app, "--size", check_arguments.size, "of images: what the plan's memories take")
        ->needs(plan_option);
    check_app->add_flag("--json", check_arguments.json, "one JSON object on standard output");
    chosen(check_app, [&] { return check(check_arguments, console); });

    UpgradeArguments upgrade_arguments;
    CLI::App* upgrade_app =
        app.add_subcommand("upgrade", "rewrite graph files of older versions of the format");
    upgrade_app->add_option("graphs", upgrade_arguments.graphs, "graph files")->required();
    upgrade_app->add_flag("--print", upgrade_arguments.print,
                          "print the new text instead of writing it");
    chosen(upgrade_app, [&] { return upgrade(upgrade_arguments, console); });

    DrawArguments draw_arguments;
    CLI::App* draw_app = app.add_subcommand("draw", "draw a graph: passes, ports, loops, memory");
    draw_app->add_option("graph", draw_arguments.graph, "graph file or shipped graph")->required();
    draw_app->add_option("-o,--output", draw_arguments.output,
                         "*.svg, *.png, *.pdf (with Graphviz) or *.dot (Graphviz' language on "
                         "standard output)");
    addSize(draw_app, "--size", draw_arguments.size, "image size, for memory and times (800x600)");
    addOverrides(draw_app, draw_arguments.overrides);
    CLI::Option* times_option = draw_app->add_flag("--times", draw_arguments.times,
                                                   "run it once and show how long each pass took");
    for (const auto& [name, argument, doc] :
         {std::tuple("--scene", &draw_arguments.scene, "what is rendered then (builtin:atrium)"),
          std::tuple("--camera", &draw_arguments.camera, "a camera of the scene (its first)"),
          std::tuple("--device", &draw_arguments.device,
                     "Vulkan device: part of its name, or none")})
        draw_app->add_option(name, *argument, doc)->needs(times_option);
    chosen(draw_app, [&] { return draw(draw_arguments, console); });

    ExplainArguments explain_arguments;
    CLI::App* explain_app = app.add_subcommand(
        "explain", "what a diagnostic's code means, or why a graph's pass or value is as it is");
    explain_app->add_option("target", explain_arguments.target,
                            "a code, like E0301 (list all), or a graph");
    explain_app->add_option("value", explain_arguments.value, "of the graph: PASS, PASS.PORT");
    addOverrides(explain_app, explain_arguments.overrides);
    explain_app->add_flag("--json", explain_arguments.json, "one JSON object on standard output");
    chosen(explain_app, [&] { return explain(explain_arguments, console); });

    SessionArguments schema_arguments;
    CLI::App* schema_app = app.add_subcommand(
        "schema", "the JSON Schema of graph files, with the passes of plug-ins: for editors");
    chosen(schema_app, [&] { return schema(schema_arguments, console); });

    PassesArguments passes_arguments;
    CLI::App* passes_app =
        app.add_subcommand("passes", "what passes there are, or one pass's ports and parameters");
    passes_app->add_option("name", passes_arguments.name, "a pass type");
    passes_app->add_flag("--json", passes_arguments.json, "one JSON object on standard output");
    chosen(passes_app, [&] { return passes(passes_arguments, console); });

    NewPassArguments new_pass_arguments;
    CLI::App* new_pass_app = app.add_subcommand(
        "new-pass", "write a plug-in's pass to begin with, that builds as it is");
    new_pass_app->add_option("name", new_pass_arguments.name, "what graphs will call it")
        ->required();
    new_pass_app->add_option("-o,--output", new_pass_arguments.output_directory,
                             "a new folder (the name)");
    chosen(new_pass_app, [&] { return newPass(new_pass_arguments, console); });

    CompareArguments compare_arguments;
    CLI::App* compare_app =
        app.add_subcommand("compare", "how far two images (EXR, PNG) are apart");
    compare_app->add_option("a", compare_arguments.a, "an image")->required();
    compare_app->add_option("b", compare_arguments.b, "another; FLIP takes it for the reference")
        ->required();
    compare_app->add_option("--layer", compare_arguments.layer, "which layer of EXR files");
    compare_app->add_option("--heat-map", compare_arguments.heat_map,
                            "PNG of the difference to write");
    compare_app->add_option("--flip-map", compare_arguments.flip_map,
                            "PNG of FLIP's error to write, from 0 (black) to 1 (pale yellow)");
    compare_app
        ->add_option("--ppd", compare_arguments.pixels_per_degree,
                     "pixels of the display in a degree of sight, for FLIP")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    compare_app->add_option("--max-difference", compare_arguments.max_difference,
                            "exit 1 if a channel differs by more");
    compare_app->add_option("--max-differing-bits", compare_arguments.max_differing_bits,
                            "exit 1 if more bits differ (0 = must be identical)");
    compare_app->add_flag("--explain", compare_arguments.explain,
                          "trace each differing pixel again and say why the backends of two EXR "
                          "images differ there; exit 1 if rounding does not explain it");
    compare_app->add_flag("--json", compare_arguments.json, "one JSON object on standard output");
    chosen(compare_app, [&] { return compare(compare_arguments, console); });

    ReplayArguments replay_arguments;
    CLI::App* replay_app = app.add_subcommand(
        "replay", "ask trace backends again what a run asked, and compare their answers");
    replay_app->add_option("file", replay_arguments.file, "what hone render --record wrote")
        ->required();
    replay_app->add_option("--backend", replay_arguments.backend,
                           "which to ask (the recorded one), or all");
    replay_app->add_option("--scene", replay_arguments.scene, "the scene (the recorded one)");
    replay_app->add_option("--device", replay_arguments.device,
                           "Vulkan device: part of its name, its index, or none");
    replay_app->add_flag("--json", replay_arguments.json, "one JSON object on standard output");
    chosen(replay_app, [&] { return replay(replay_arguments, console); });

    SelftestArguments selftest_arguments;
    CLI::App* selftest_app = app.add_subcommand(
        "selftest", "hold the trace backends, on this machine, to what they promise");
    selftest_app
        ->add_option("--backends", selftest_arguments.backends, "which to test (all that are here)")
        ->expected(0, -1)
        ->delimiter(';');
    selftest_app->add_option("--device", selftest_arguments.device,
                             "Vulkan device: part of its name, its index, or none");
    selftest_app->add_flag("--json", selftest_arguments.json, "one JSON object on standard output");
    chosen(selftest_app, [&] { return selftest(selftest_arguments, kit, console); });

    DoctorArguments doctor_arguments;
    CLI::App* doctor_app =
        app.add_subcommand("doctor", "what works on this machine, and what to install");
    doctor_app->add_flag("--json", doctor_arguments.json, "one JSON object on standard output");
    chosen(doctor_app, [&] { return doctor(doctor_arguments, console); });

    BenchPartsArguments bench_arguments;
    CLI::App* bench_app = app.add_subcommand("bench", "measure speed, side by side in one run");
    bench_app->require_subcommand(1);
    CLI::App* parts_app = bench_app->add_subcommand(
        "parts", "each part of a refinement against its bare counterpart");
    parts_app->add_option("--scene", bench_arguments.scene,
                          "scene (Sponza where it is there, else builtin:atrium)");
    parts_app->add_option("--camera", bench_arguments.camera, "a camera of the scene (its first)");
    parts_app
        ->add_option("--repeats", bench_arguments.repeats,
                     "runs of each measurement; the median counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    addSizes(parts_app, bench_arguments.sizes);
    parts_app->add_flag("--json", bench_arguments.json, "one JSON object on standard output");
    chosen(parts_app, [&] { return benchParts(bench_arguments, console); });

    BenchTable1Arguments table1_arguments;
    CLI::App* table1_app = bench_app->add_subcommand(
        "table1", "the paper's Table 1: refinement against pure ray tracing, four views");
    table1_app->add_option("--graph", table1_arguments.graph, "what refines")
        ->capture_default_str();
    table1_app->add_option("--scene", table1_arguments.scene,
                           "scene (Sponza where it is there, else builtin:atrium)");
    table1_app->add_option("--camera", table1_arguments.camera,
                           "whose field of view and lens the views take (the first with a lens)");
    addSizes(table1_app, table1_arguments.sizes);
    table1_app
        ->add_option("--samples", table1_arguments.samples,
                     "samples a pixel (1 16); 1 is the paper's protocol, with lights as points")
        ->check(CLI::PositiveNumber);
    table1_app
        ->add_option("--visibility", table1_arguments.visibility,
                     "who says what each pixel of the raster image sees")
        ->check(CLI::IsMember({"raster", "rays"}))
        ->capture_default_str();
    table1_app
        ->add_option("--repeats", table1_arguments.repeats,
                     "runs of each measurement; the median counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    table1_app->add_flag("--json", table1_arguments.json, "one JSON object on standard output");
    chosen(table1_app, [&] { return benchTable1(table1_arguments, console); });

    BenchTracersArguments tracers_arguments;
    CLI::App* tracers_app = bench_app->add_subcommand(
        "tracers", "every trace backend on the rays of one frame, by kind of ray");
    tracers_app->add_option("--scene", tracers_arguments.scene,
                            "scene (Sponza where it is there, else builtin:atrium)");
    tracers_app->add_option("--camera", tracers_arguments.camera, "a camera of the scene");
    addSize(tracers_app, "--size", tracers_arguments.size, "size of the frame (800x600)");
    tracers_app
        ->add_option("--backends", tracers_arguments.backends,
                     "which to measure (all that work here); the first is compared with")
        ->delimiter(',');
    tracers_app
        ->add_option("--repeats", tracers_arguments.repeats,
                     "runs of each measurement; the median counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    tracers_app->add_flag("--json", tracers_arguments.json, "one JSON object on standard output");
    chosen(tracers_app, [&] { return benchTracers(tracers_arguments, console); });

    BenchExecutorArguments executor_arguments;
    CLI::App* executor_app = bench_app->add_subcommand(
        "executor", "what a graph of many small passes costs besides its passes");
    addSize(executor_app, "--size", executor_arguments.size, "image size (800x600)");
    executor_app->add_option("--passes", executor_arguments.passes, "how many passes")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    executor_app->add_option("--repeats", executor_arguments.repeats, "frames; the median counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    executor_app->add_flag("--json", executor_arguments.json, "one JSON object on standard output");
    chosen(executor_app, [&] { return benchExecutor(executor_arguments, console); });

    MeasureArguments measure_arguments;
    CLI::App* measure_app = app.add_subcommand(
        "measure", "how good a graph's error metrics are against the ray-traced truth");
    measure_app->add_option("graph", measure_arguments.graph, "graph file or shipped graph")
        ->required();
    addMeasureOptions(measure_app, measure_arguments);
    measure_app->add_option("-o,--output", measure_arguments.output_directory,
                            "folder for tables and pictures (none)");
    measure_app->add_flag("--markdown", measure_arguments.markdown, "the table for a document");
    chosen(measure_app, [&] { return measure(measure_arguments, console); });

    FitArguments fit_arguments;
    CLI::App* fit_app =
        app.add_subcommand("fit", "find the weights of a graph's combination of error metrics");
    fit_app->add_option("graph", fit_arguments.graph, "graph file or shipped graph")->required();
    addMeasureOptions(fit_app, fit_arguments);
    fit_app
        ->add_option("--method", fit_arguments.method,
                     "random: the paper's search; nnls: least squares; both writes nnls")
        ->check(CLI::IsMember({"random", "nnls", "both"}))
        ->capture_default_str();
    fit_app->add_option("--tuples", fit_arguments.tuples, "weights that the random search tries")
        ->capture_default_str();
    fit_app->add_option("--greatest", fit_arguments.greatest, "weight that it tries")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    fit_app->add_option("-o,--output", fit_arguments.output,
                        "graph file to write, with the weights (none)");
    chosen(fit_app, [&] { return fit(fit_arguments, console); });

    MeasureArguments figure10_arguments;
    figure10_arguments.views = 1;
    figure10_arguments.output_directory = "out/figure10";
    CLI::App* figure10_app = bench_app->add_subcommand(
        "figure10", "real error, estimated error and difference for every way to combine metrics");
    figure10_app->add_option("--graph", figure10_arguments.graph, "graph file or shipped graph")
        ->capture_default_str();
    addMeasureOptions(figure10_app, figure10_arguments);
    figure10_app
        ->add_option("-o,--output", figure10_arguments.output_directory, "folder for the pictures")
        ->capture_default_str();
    chosen(figure10_app, [&] { return benchFigure10(figure10_arguments, console); });

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& problem) {
        return app.exit(problem, out, err) == 0 ? kOk : kUsage;
    }
    for (SessionArguments* arguments : std::initializer_list<SessionArguments*>{
             &demo_arguments, &render_arguments, &check_arguments, &draw_arguments,
             &explain_arguments, &passes_arguments, &new_pass_arguments, &compare_arguments,
             &doctor_arguments, &replay_arguments, &selftest_arguments, &bench_arguments,
             &table1_arguments, &tracers_arguments, &executor_arguments, &measure_arguments,
             &fit_arguments, &figure10_arguments})
        arguments->plugins = plugins;
    if (verbose)
        logger().set_level(spdlog::level::info);
    return guarded(command, err);
}

} // namespace hone::cli
