// SPDX-License-Identifier: Apache-2.0
//
// E01xx the file, E02xx its keys, E03xx names, E04xx edges, E05xx parameters, E06xx loops, E07xx
// placement; W08xx harmless.
#include "hone/core/graph/diagnostic_codes.h"

#include <algorithm>

namespace hone {
namespace {

constexpr Severity kError = Severity::kError;
constexpr Severity kWarning = Severity::kWarning;

constexpr DiagnosticCode kCodes[] = {
    {"E0101", kError, "the file is not valid JSON",
     "A graph file is JSON, in which // and /* */ comments are allowed. The place is where the "
     "text stopped making sense; what is wrong often stands just before it: a missing comma, a "
     "comma after the last element, a quote that was not closed.",
     R"({ "type": "sort", })", R"({ "type": "sort" })"},
    {"E0102", kError, "a key is written twice",
     "One object has two members of the same name, and only one of them could count. Two passes "
     "of one name are this, too. Remove or rename one; the report shows both places.",
     R"("params": { "batch": 64, "batch": 128 })", R"("params": { "batch": 128 })"},
    {"E0103", kError, "the file is nested too deeply",
     "Objects and lists may be nested 64 levels deep. No graph needs a tenth of that; the file "
     "was probably made by a program that went wrong.",
     "", ""},
    {"E0104", kError, "the graph is too large",
     "A file may have 16 MiB and 262144 values; a graph may have 4096 passes and 16384 edges. The "
     "limits keep a broken file from taking all memory.",
     "", ""},
    {"E0105", kError, "a name is too long",
     "Names may have 256 bytes. Put explanations under \"doc\".", "", ""},
    {"E0106", kError, "the file cannot be read",
     "It does not exist, is a folder, or you may not read it. Shipped graphs are found by their "
     "name alone: hone render sir.",
     "", ""},
    {"E0201", kError, "a key has no meaning here",
     "Every key of a graph file means something, so a key that is not known is a typing mistake, "
     "or stands in the wrong object. Comments do not need keys: write // or \"doc\".",
     R"("sort": { "type": "sort", "inn": { "error": "combine.error" } })",
     R"("sort": { "type": "sort", "in": { "error": "combine.error" } })"},
    {"E0202", kError, "a value is of the wrong kind",
     "Here a string, a number, a list or an object is needed, and something else is written; or a "
     "string that names something is empty. The report says which of them was expected.",
     R"("in": [ "raster.color" ])", R"("in": { "color": "raster.color" })"},
    {"E0203", kError, "something that must be written is missing",
     "A graph needs its version (\"hone\"), a pass needs a \"type\" or a \"loop\", an edge needs "
     "\"from\", a parameter of the graph needs a \"type\" and a \"default\", and an enum its "
     "\"choices\".",
     R"("batch": { "type": "uint" })", R"("batch": { "type": "uint", "default": 8192 })"},
    {"E0204", kError, "the graph's version is not one that this program reads",
     "\"hone\" is the version of the graph language, a whole number. A graph of a newer version "
     "needs a newer hone.",
     R"("hone": 1000)", R"("hone": 2)"},
    {"E0205", kError, "this cannot be a name",
     "Names are made of letters, digits, \"_\" and \"-\", because \".\", \"$\", \"~\" and \"@\" "
     "have a "
     "meaning where a name is used. \"stats\" is taken in loops: it is what every loop says about "
     "its iterations.",
     R"("my.pass": { "type": "sort" })", R"("my_pass": { "type": "sort" })"},
    {"E0206", kError, "one name means two things",
     "A graph's input and its parameter are both written \"$name\", and passes inside a loop see "
     "those outside; each name must mean one thing. Rename one of the two.",
     "", ""},
    {"E0208", kError, "the graph has no outputs",
     "Passes run because an output needs them; without outputs nothing would run.", "",
     R"("outputs": { "color": "raster.color" })"},
    {"E0301", kError, "there is no such pass type",
     "hone passes lists the types that this program knows. A type may also come from a plug-in "
     "that was not loaded.",
     R"({ "type": "eror.shadow" })", R"({ "type": "error.shadow" })"},
    {"E0302", kError, "the pass has no such input",
     "\"in\" names the inputs that the pass's type declares; hone passes TYPE lists them.",
     R"({ "type": "sort", "in": { "errors": "combine.error" } })",
     R"({ "type": "sort", "in": { "error": "combine.error" } })"},
    {"E0303", kError, "there is no such pass",
     "An edge names a pass that is neither in this loop nor outside it. \"a.b\" is output b of "
     "pass a, \"$x\" an input of the graph, \"~x\" a carried value.",
     R"("in": { "error": "combin.error" })", R"("in": { "error": "combine.error" })"},
    {"E0304", kError, "the pass has no such output",
     "An edge comes from an output that a pass's type declares, or from a value that a loop "
     "carries; hone passes TYPE lists them. A loop also has the output \"stats\".",
     R"("in": { "error": "combine" })", R"("in": { "error": "combine.error" })"},
    {"E0305", kError, "the graph has no such input",
     "\"$name\" on an edge is an input of the graph, declared under \"inputs\". Parameters are "
     "written in the same way, but under \"params\".",
     R"("in": { "scene": "$scen" })", R"("in": { "scene": "$scene" })"},
    {"E0306", kError, "no such carried value is seen from here",
     "\"~name\" is a value that a loop carries, as it is in this iteration: it can be read inside "
     "that loop only. After the loop its last value is the output \"loop.name\", which cannot be "
     "read inside.",
     R"("outputs": { "color": "~image" })", R"("outputs": { "color": "refine.image" })"},
    {"E0307", kError, "graph inputs are not of this type",
     "What is given to a graph from outside is a \"scene\", a \"camera\" or an \"extent\" (the "
     "size of the image in pixels).",
     R"("inputs": { "scene": "gltf" })", R"("inputs": { "scene": "scene" })"},
    {"E0308", kError, "a plug-in that the graph needs is not loaded",
     "The graph takes pass types from it. Name the plug-in's file with --plugin, or put its "
     "folder into HONE_PLUGIN_PATH. Graphs themselves never load code.",
     "", ""},
    {"E0309", kError, "a plug-in does not have what the graph takes from it",
     "The plug-in is loaded, but another version of it: hone passes lists what it has.", "", ""},
    {"E0310", kError, "a file that the graph names cannot be read",
     "A graph or shader that a pass is made of is looked for in the folder of the graph that "
     "names it, then among the shipped graphs. Links that lead out of a folder are not followed.",
     "", ""},
    {"E0311", kError, "a file must lie beside the graph",
     "A graph may name files of its own folder and of folders in it, with no \"..\" and no "
     "absolute path: so that opening a graph reads nothing else.",
     R"("shader": "../other/gain.comp")", R"("shader": "gain.comp")"},
    {"E0312", kError, "graphs use each other in a circle",
     "A graph that is used as a pass is copied into the one that uses it, so it cannot contain "
     "itself. To repeat work, use a \"loop\".",
     "", ""},
    {"E0313", kError, "this program cannot compile shaders",
     "Passes of type \"glsl\" need a compiler, which the program that embeds hone did not give.",
     "", ""},
    {"E0314", kError, "a shader is not right",
     "The place is in the shader's file: what its declarations or the GLSL compiler complain of.",
     "", ""},
    {"E0401", kError, "an edge joins two meanings",
     "Ports connect when their types are the same: a depth is no error, though both are numbers. "
     "The report says what both ends are, and which outputs of the graph would fit.",
     R"({ "type": "sort", "in": { "error": "raster.color" } })",
     R"({ "type": "sort", "in": { "error": "combine.error" } })"},
    {"E0402", kError, "a required input is not connected",
     "The pass cannot run without it. Inputs that hone passes TYPE calls optional may be left out.",
     R"("sort": { "type": "sort" })",
     R"("sort": { "type": "sort", "in": { "error": "combine.error" } })"},
    {"E0403", kError, "an input takes one edge, not a list",
     "Only inputs that hone passes TYPE marks \"several edges\" take a list.",
     R"("in": { "error": [ "a.error", "b.error" ] })",
     R"("in": { "errors": [ "a.error", "b.error" ] })"},
    {"E0404", kError, "an input has too many edges",
     "A list of edges may have 8. Join some of them in a pass before this one.", "", ""},
    {"E0405", kError, "passes wait for each other",
     "Each of these passes needs what another of them writes, so none can be first. The report "
     "prints the circle. To repeat work, put the passes into a \"loop\" and carry a value from "
     "one iteration to the next.",
     R"("a": { "type": "add", "in": { "color": "b.result" } },
"b": { "type": "add", "in": { "color": "a.result" } })",
     ""},
    {"E0406", kError, "an output is not of the type that it is said to be",
     "\"type\" on an output is a promise to those who use the graph as a pass, and is checked.",
     R"("color": { "from": "raster.depth", "type": "Radiance" })",
     R"("color": { "from": "raster.color", "type": "Radiance" })"},
    {"E0501", kError, "there is no such parameter",
     "The pass's type declares which parameters it has, and its input which an edge may have; "
     "hone passes TYPE lists both.",
     R"("params": { "metrik": 4 })", R"("params": { "metric": 4 })"},
    {"E0502", kError, "a parameter's value is of the wrong type",
     "A bool is true or false, a uint is a whole number from 0 to 4294967295, a float is a "
     "number, an enum is one of its choices as a string. Numbers and bools are written without "
     "quotes.",
     R"("params": { "batch": "64" })", R"("params": { "batch": 64 })"},
    {"E0503", kError, "a parameter is out of range",
     "The declaration has a least and a greatest value, both allowed; hone passes TYPE prints "
     "them. A value that comes from a graph parameter must fit the pass, too: give the graph "
     "parameter the same \"min\" and \"max\".",
     R"("params": { "metric": 9 })", R"("params": { "metric": 4 })"},
    {"E0504", kError, "an enum has no such choice", "Choices are written as strings; case counts.",
     R"("params": { "mode": "maximum" })", R"("params": { "mode": "max" })"},
    {"E0505", kError, "the graph has no such parameter",
     "\"$name\" under \"params\" takes the value of a parameter that the graph declares. Declare "
     "it under the graph's \"params\", or correct the name.",
     R"("params": { "batch": "$bach" })", R"("params": { "batch": "$batch" })"},
    {"E0506", kError, "nothing reads a parameter",
     "Setting it would do nothing, which whoever sets it would not expect. Use it as \"$name\", "
     "or remove its declaration.",
     "", ""},
    {"E0507", kError, "a parameter's declaration contradicts itself",
     "Its \"type\" is bool, uint, float or enum; \"min\" is not above \"max\"; choices are listed "
     "or come \"from\": \"trace_backends\".",
     R"("gain": { "type": "double", "default": 1 })",
     R"("gain": { "type": "float", "default": 1 })"},
    {"E0508", kError, "a graph parameter is of another type than what it feeds",
     "A graph's parameter and the pass's parameter must have the same type; only a uint may feed "
     "a float.",
     "", ""},
    {"E0509", kError, "what an override sets does not exist",
     "--set takes a parameter of the graph (batch=64) or of a pass, with the loops around it "
     "(refine.trace.max_depth=2). hone check --plan GRAPH prints the names.",
     "", ""},
    {"E0510", kError, "there is no such trace backend",
     "hone doctor lists the trace backends of this program. \"auto\" is the fastest that works "
     "here; check(name) holds one against the geometry.",
     R"("params": { "backend": "embre" })", R"("params": { "backend": "embree" })"},
    {"E0511", kError, "a running graph cannot switch passes on and off",
     "The parameter stands in a \"when\", which decides what is compiled. Compile the graph again "
     "with the new value: on the command line, --set does.",
     "", ""},
    {"E0512", kError, "\"when\" needs a parameter of another type",
     "A bool switches by itself; an enum by a list of the choices with which the pass runs.",
     R"("when": "$mode")", R"("when": { "$mode": [ "all", "shadows" ] })"},
    {"E0601", kError, "a loop may never end",
     "A list that is to become empty may never do so. One of the loop's stop rules must be a "
     "limit above 0: of iterations, rays or ms.",
     R"("stop": [ { "empty": "request.requests" } ])",
     R"("stop": [ { "empty": "request.requests" }, { "iterations": 1000 } ])"},
    {"E0602", kError, "a loop does not say what a carried value becomes",
     "Each value under \"carry\" needs its counterpart under \"next\": what it is in the next "
     "iteration. A value that stays the same is no carried value: passes inside a loop read what "
     "is outside.",
     R"("carry": { "image": "raster.color" }, "next": {})",
     R"("carry": { "image": "raster.color" }, "next": { "image": "blend.image" })"},
    {"E0603", kError, "\"next\" speaks of a value that the loop does not carry",
     "\"next\" gives new values to what \"carry\" names. Add it there, with the value that it "
     "begins with, or correct the name.",
     "", ""},
    {"E0604", kError, "a carried value changes its type",
     "What is carried must be the same type in every iteration.", "", ""},
    {"E0605", kError, "this cannot be carried",
     "A loop carries values that have elements: planes, lists, records. Scenes and cameras are "
     "read from outside. {\"zero\": \"Type\"} names a port type, as hone passes TYPE prints them.",
     R"("carry": { "sum": { "zero": "Acumulation" } })",
     R"("carry": { "sum": { "zero": "Accumulation" } })"},
    {"E0606", kError, "a stop rule watches what it cannot",
     "\"empty\" asks whether a list has no elements; a plane has one a pixel, always. \"below\" "
     "compares a Scalar with its limit.",
     R"("stop": [ { "empty": "trace.color" } ])", R"("stop": [ { "empty": "request.requests" } ])"},
    {"E0607", kError, "all that feeds an input is switched off",
     "The pass still runs, and its input has nothing left. Give the pass a \"when\" of its own, "
     "or the input an edge that stays.",
     "", ""},
    {"E0608", kError, "what may be switched off is needed",
     "A pass with a \"when\" that is off has no outputs. \"bypass\" says what stands in for each "
     "of them; passes that are switched by the same parameter need none.",
     R"("blur": { "type": "depth_of_field", "when": "$lens", "in": { "image": "raster.color" } })",
     R"("blur": { "type": "depth_of_field", "when": "$lens", "in": { "image": "raster.color" },
          "bypass": { "image": "raster.color" } })"},
    {"E0609", kError, "\"bypass\" without \"when\"",
     "A pass that always runs needs nothing to stand in for its outputs.", "", ""},
    {"E0610", kError, "the last frame's value cannot be used so",
     "\"pass.port@-1\" is what the value was in the last frame; older frames are not kept. Inputs "
     "of passes and what a carried value begins with may use it; values made inside a loop have "
     "iterations instead: \"carry\" them.",
     R"({ "from": "blend.image@-2", "initial": "raster.color" })",
     R"({ "from": "blend.image@-1", "initial": "raster.color" })"},
    {"E0611", kError, "a history and its beginning belong together",
     "In the first frame there is no last one: \"initial\" says what is used then, a value or "
     "zeroes. Values of this frame have no \"initial\".",
     R"("in": { "image": "blend.image@-1" })",
     R"("in": { "image": { "from": "blend.image@-1", "initial": { "zero": "Radiance" } } })"},
    {"E0701", kError, "there is no such place to run on",
     "\"on\" is \"host\", \"device\" or \"auto\".", R"("on": "gpu")", R"("on": "device")"},
    {"E0702", kError, "the pass cannot run there",
     "Some passes are written for the host alone, and drawing needs the device. Leave \"on\" out: "
     "hone then chooses what works.",
     "", ""},
    {"W0801", kWarning, "no pass reads an input of the graph",
     "It does no harm, but whoever gives it will wonder why it changes nothing.", "", ""},
    {"W0802", kWarning, "the graph uses a word of an older version",
     "It is read as what it meant then. hone upgrade rewrites the file.", "", ""},
};

} // namespace

std::span<const DiagnosticCode> diagnosticCodes() {
    return kCodes;
}

const DiagnosticCode* findDiagnosticCode(std::string_view code) {
    std::string upper(code);
    for (char& c : upper)
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    const auto found = std::ranges::find(kCodes, upper, &DiagnosticCode::code);
    return found != std::end(kCodes) ? &*found : nullptr;
}

} // namespace hone
