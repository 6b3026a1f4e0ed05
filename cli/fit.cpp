// SPDX-License-Identifier: Apache-2.0
//
// hone fit: weights for a graph's linear combination of error metrics (Amann, Chajdas,
// Westermann 2012, section 3.4).
//
// Every fourth view is held out: weights are fitted to the others, and what they are worth is said
// of views that they have not seen.
#include "hone/cli/commands.h"
#include "hone/cli/graph_document.h"
#include "hone/cli/json.h"
#include "hone/cli/measure_stage.h"
#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"
#include "hone/core/measure/weights.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <ostream>

namespace hone::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Weights, and what they are worth.
struct Fit {
    std::string method; ///< "graph": as the file has them; "mean", "random", "nnls"
    std::vector<double> weights;
    double j_train = 0; ///< the sum of squares that is made least
    double rmse_train = 0, rmse_held_out = 0;
    double optimality_residual = 0;
    OverViews spearman, gain; ///< of the combination, over the held-out views
};

/// What a combiner combines, as indices into stage.metrics(). Throws GraphError for what is no
/// metric: a value that a loop carries, or that of the last frame.
std::vector<std::size_t> metricsOf(const MeasureStage& stage, const std::string& pass) {
    std::vector<std::size_t> indices;
    for (const PlannedEdge& edge : stage.graph().findNode(pass)->inputs) {
        const std::string& value = stage.graph().values[edge.value].name;
        const auto metric = std::ranges::find(stage.metrics(), value, &GraphMetric::name);
        if (metric == stage.metrics().end())
            throw GraphError(stage.graph().file + ": \"" + pass + "\" combines \"" + value +
                             "\", whose weight cannot be fitted: only what a pass outside loops "
                             "makes of this frame can be judged");
        indices.push_back(static_cast<std::size_t>(metric - stage.metrics().begin()));
    }
    return indices;
}

/// What a combiner's weights are fitted to.
class FitData {
public:
    FitData(const MeasureStage& stage, const std::string& pass)
        : metrics_(metricsOf(stage, pass)), train_(metrics_.size()), held_out_(metrics_.size()) {
        for (const std::size_t metric : metrics_)
            names_.push_back(stage.metrics()[metric].name);
    }

    void add(const JudgedView& view, bool is_held_out) {
        std::vector<std::vector<float>> metrics;
        for (const std::size_t metric : metrics_)
            metrics.push_back(view.metrics[metric].expect);
        (is_held_out ? held_out_ : train_).add(metrics, view.error.max);
        (is_held_out ? held_out_names_ : train_names_).push_back(view.name);
        if (is_held_out)
            unseen_.push_back({view.truth.extent, std::move(metrics), view.error});
    }

    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
    [[nodiscard]] const SquaredResidual& train() const { return train_; }
    [[nodiscard]] Json views() const {
        return {{"train", train_names_}, {"held_out", held_out_names_}};
    }

    [[nodiscard]] Fit judge(std::string method, std::vector<double> weights) const {
        const auto rmse = [&](const SquaredResidual& residual) {
            return std::sqrt(residual.at(weights) / static_cast<double>(residual.pixels()));
        };
        Fit fit;
        fit.method = std::move(method);
        fit.j_train = train_.at(weights);
        fit.rmse_train = rmse(train_);
        fit.rmse_held_out = rmse(held_out_);
        fit.optimality_residual = optimalityResidual(train_, weights);
        std::vector<double> ranks, gains;
        for (const Unseen& view : unseen_) {
            std::vector<float> expect(view.error.max.size());
            for (std::size_t k = 0; k < weights.size(); ++k)
                for (std::size_t pixel = 0; pixel < expect.size(); ++pixel)
                    expect[pixel] += static_cast<float>(weights[k]) * view.metrics[k][pixel];
            ranks.push_back(spearman(expect, view.error.max));
            gains.push_back(gain(converge(view.error.square, expect, {}),
                                 convergeOracle(view.error.square, {})));
        }
        fit.spearman = overViews(ranks, Better::kGreater);
        fit.gain = overViews(gains, Better::kGreater);
        fit.weights = std::move(weights);
        return fit;
    }

private:
    struct Unseen {
        uvec2 extent;
        std::vector<std::vector<float>> metrics;
        RealError error;
    };

    std::vector<std::size_t> metrics_;
    std::vector<std::string> names_;
    SquaredResidual train_, held_out_;
    std::vector<std::string> train_names_, held_out_names_;
    std::vector<Unseen> unseen_;
};

/// The combiner that no other one takes in. Throws GraphError if there is none or several.
std::string combinerOf(const MeasureStage& stage, const std::string& graph) {
    std::vector<std::string> combiners;
    for (const GraphMetric& metric : stage.metrics())
        if (!metric.mode.empty() && std::ranges::find(combiners, metric.pass) == combiners.end())
            combiners.push_back(metric.pass);
    std::vector<std::string> last = combiners;
    for (const std::string& combiner : combiners)
        for (const PlannedEdge& edge : stage.graph().findNode(combiner)->inputs) {
            const std::string& value = stage.graph().values[edge.value].name;
            std::erase(last, value.substr(0, value.find('.')));
        }
    if (last.empty())
        throw GraphError(graph + ": no pass of type combine outside loops and used graphs, so no "
                                 "weights to fit");
    if (last.size() > 1)
        throw GraphError(graph + ": which pass of type combine is to be fitted, \"" + last[0] +
                         "\" or \"" + last[1] + "\"? Combine them, or leave one");
    return last.front();
}

std::vector<double> weightsOf(const CompiledGraph& graph, const std::string& pass) {
    std::vector<double> weights;
    for (const PlannedEdge& edge : graph.findNode(pass)->inputs)
        weights.push_back(double{std::get<float>(edge.params.front())});
    return weights;
}

/// Throws before hours of measuring if the fitted graph could not be written there, or not find its
/// files.
void requireOutput(const std::string& path, const GraphDocument& graph) {
    namespace fs = std::filesystem;
    const auto folderOf = [](const fs::path& file) {
        return file.has_parent_path() ? file.parent_path() : fs::path(".");
    };
    const fs::path folder = folderOf(path), own = folderOf(graph.path());
    std::error_code ignored; // one that is not there is another one
    if (const std::string file = graph.fileBeside();
        !file.empty() && !fs::equivalent(folder, own, ignored))
        throw InputError(path + ": would not find \"" + file + "\", which lies beside " +
                         graph.path() + "; write the fitted graph there, too: -o " +
                         (own / fs::path(path).filename()).string());
    requireWritableDirectory(folder.string());
}

/// Takes parameters out that nothing reads any more.
void dropUnreadParams(Json& graph) {
    if (!graph.contains("params"))
        return;
    const std::string passes = graph["passes"].dump();
    std::vector<std::string> unread;
    for (const auto& [name, declaration] : graph["params"].items())
        if (passes.find("$" + name + "\"") == std::string::npos)
            unread.push_back(name);
    for (const std::string& name : unread)
        graph["params"].erase(name);
}

/// Writes the graph with other weights, in mode linear.
void writeGraph(const std::string& path, GraphDocument graph, const std::string& pass,
                std::span<const double> weights) {
    Json& node = graph.json["passes"][pass];
    node["params"]["mode"] = "linear";
    Json& edges = node["in"]["errors"];
    if (!edges.is_array())
        edges = Json::array({edges});
    for (std::size_t k = 0; k < weights.size(); ++k) {
        if (edges[k].is_string())
            edges[k] = {{"from", edges[k]}};
        edges[k]["weight"] = static_cast<float>(weights[k]);
    }
    dropUnreadParams(graph.json);
    const std::string text = graph.json.dump(2) + "\n";
    writeFileAtomically(path, std::as_bytes(std::span(text)));
}

Json toJson(const Fit& fit) {
    return {{"method", fit.method},
            {"weights", fit.weights},
            {"j_train", fit.j_train},
            {"rmse_train", fit.rmse_train},
            {"rmse_held_out", fit.rmse_held_out},
            {"optimality_residual", fit.optimality_residual},
            {"spearman_held_out", fit.spearman.mean},
            {"gain_held_out", fit.gain.mean}};
}

void printTable(const std::vector<Fit>& fits, const std::vector<std::string>& names,
                std::ostream& out) {
    const auto line = [&out](const char* pattern, auto... values) {
        char buffer[256];
        std::snprintf(buffer, sizeof buffer, pattern, values...);
        out << buffer;
    };
    line("%-8s %11s %11s %9s %9s  ", "method", "RMSE train", "held out", "Spearman", "gain");
    for (const std::string& name : names)
        line(" %18s", name.c_str());
    out << "\n";
    for (const Fit& fit : fits) {
        line("%-8s %11.5f %11.5f %9.4f %9.4f  ", fit.method.c_str(), fit.rmse_train,
             fit.rmse_held_out, fit.spearman.mean, fit.gain.mean);
        for (const double weight : fit.weights)
            line(" %18.6f", weight);
        out << "\n";
    }
}

} // namespace

int fit(const FitArguments& arguments, const Console& console) {
    GraphDocument graph = readGraphDocument(findGraph(arguments.graph));
    if (!arguments.output.empty())
        requireOutput(arguments.output, graph);
    MeasureStage stage(arguments, console);
    const std::string pass = combinerOf(stage, arguments.graph);
    FitData data(stage, pass);
    const std::size_t views = stage.views().size();
    if (views < 4)
        throw InputError("hone fit holds every fourth view out: it needs --views 4 or more, and "
                         "found " +
                         std::to_string(views));
    for (std::size_t k = 0; k < views; ++k) {
        console.err << "measuring " << stage.views()[k].name << " (" << k + 1 << " of " << views
                    << ")\n";
        data.add(stage.judge(stage.views()[k]), k % 4 == 3);
    }

    const std::size_t n = data.names().size();
    std::vector<Fit> fits;
    fits.push_back(data.judge("graph", weightsOf(stage.graph(), pass)));
    fits.push_back(data.judge("mean", std::vector<double>(n, 1 / static_cast<double>(n))));
    if (arguments.method != "nnls")
        fits.push_back(
            data.judge("random", fitAtRandom(data.train(), {.tuples = arguments.tuples,
                                                            .greatest = arguments.greatest,
                                                            .seed = arguments.seed})));
    if (arguments.method != "random")
        fits.push_back(data.judge("nnls", fitNonNegative(data.train())));
    if (!arguments.output.empty())
        writeGraph(arguments.output, std::move(graph), pass, fits.back().weights);

    if (arguments.json) {
        Json rows = Json::array();
        for (const Fit& row : fits)
            rows.push_back(toJson(row));
        print(console.out, {{"graph", arguments.graph},
                            {"scene", stage.scene().name},
                            {"pass", pass},
                            {"metrics", data.names()},
                            {"views", data.views()},
                            {"fits", std::move(rows)},
                            {"output", arguments.output}});
    } else {
        printTable(fits, data.names(), console.out);
    }
    if (!arguments.output.empty())
        console.err << "wrote " << arguments.output << " with the weights of " << fits.back().method
                    << "\n";
    return kOk;
}

} // namespace hone::cli
