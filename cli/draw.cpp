// SPDX-License-Identifier: Apache-2.0
//
// hone draw: a graph as a picture.
#include "hone/cli/commands.h"
#include "hone/cli/draw_dot.h"
#include "hone/cli/graphviz.h"
#include "hone/cli/interrupt_guard.h"
#include "hone/cli/run.h"
#include "hone/core/error.h"
#include "hone/core/image/atomic_file.h"

#include <filesystem>
#include <ostream>

namespace hone::cli {

int draw(const DrawArguments& arguments, const Console& console) {
    // Before any work: can the drawing be kept?
    const std::filesystem::path file(arguments.output);
    const std::string ending = file.extension().string();
    const bool is_laid_out = ending == ".svg" || ending == ".png" || ending == ".pdf";
    if (!file.empty()) {
        if (!is_laid_out && ending != ".dot")
            throw OutputError(arguments.output +
                              ": a drawing is .svg, .png, .pdf or .dot; name one of these");
        requireWritableDirectory(file.parent_path().string());
    }
    std::string dot;
    DrawOptions options{.size = arguments.size, .times = {}};
    if (arguments.times) {
        const InterruptGuard interrupts;
        const std::unique_ptr<Stage> stage = makeStage(arguments, console);
        stage->executor->prepare();
        runWithProgress(*stage, arguments, console);
        if (const int signal = InterruptGuard::requested())
            return signal;
        const std::vector<NodeReport> times = stage->executor->nodes();
        options.scene = &stage->scene;
        options.times = times;
        dot = toDot(stage->executor->graph(), options);
    } else {
        const Session session(arguments.plugins);
        dot = toDot(loadGraph(findGraph(arguments.graph), session.catalog(), arguments.overrides),
                    options);
    }
    if (file.empty()) {
        console.out << dot;
        return kOk;
    }
    const std::string drawing = is_laid_out ? runDot(dot, ending.substr(1)) : dot;
    writeFileAtomically(arguments.output, std::as_bytes(std::span(drawing)));
    console.err << "wrote " << arguments.output << "\n";
    return kOk;
}

} // namespace hone::cli
