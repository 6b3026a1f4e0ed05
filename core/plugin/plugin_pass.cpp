// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/plugin_pass.h"

#include "hone/core/log.h"
#include "hone/core/plugin/plugin_host.h"
#include "hone/core/plugin/plugin_output.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace hone {
namespace {

hone_word wordOf(const ParamDecl& decl, const ParamValue& value) {
    hone_word word{};
    if (const bool* flag = std::get_if<bool>(&value))
        word.u = *flag ? 1 : 0;
    else if (const uint* number = std::get_if<uint>(&value))
        word.u = *number;
    else if (const float* real = std::get_if<float>(&value))
        word.f = *real;
    else
        word.u = static_cast<uint>(std::ranges::find(decl.choices, std::get<std::string>(value)) -
                                   decl.choices.begin());
    return word;
}

void writeWords(const PassType& type, const PassParams& params, std::span<hone_word> words) {
    for (std::size_t i = 0; i < type.params.size(); ++i)
        words[i] = wordOf(type.params[i], params.value(type.params[i].name));
}

/// A size that a plug-in asks for.
class PluginSize {
public:
    PluginSize(std::shared_ptr<const PluginLibrary> library, std::size_t pass, std::size_t output)
        : library_(std::move(library)), pass_(&library_->passes[pass]), output_(output) {}

    std::size_t operator()(const SizeQuery& query) const {
        const PassType& type = pass_->type;
        std::array<hone_word, kMostPluginParams> params{};
        std::array<std::size_t, kMostPluginPorts> capacities{};
        writeWords(type, query.params, params);
        for (std::size_t i = 0; i < type.inputs.size(); ++i)
            if (type.inputs[i].type.stride != 0)
                capacities[i] = query.input(type.inputs[i].name);
        const hone_size_query asked{.struct_size = sizeof asked,
                                    .output = static_cast<std::uint32_t>(output_),
                                    .width = query.extent.x,
                                    .height = query.extent.y,
                                    .params = params.data(),
                                    .capacities = capacities.data(),
                                    .param_count = type.params.size(),
                                    .input_count = type.inputs.size()};
        const auto who = [&] {
            return "plug-in " + printable(library_->info.file) + ": pass type \"" + type.name +
                   "\": output \"" + type.outputs[output_].name + "\"";
        };
        std::size_t elements = 0;
        callPlugin(who, "size", [&](hone_error*) {
            elements = pass_->sizes[output_](&asked);
            return hone_status{HONE_OK};
        });
        if (elements > std::numeric_limits<uint>::max())
            throw PluginError(who() + ": size answered " + std::to_string(elements) +
                              " elements, more than 32 bits can count");
        return elements;
    }

private:
    std::shared_ptr<const PluginLibrary> library_;
    const PluginPassType* pass_;
    std::size_t output_;
};

class PluginPass final : public RenderPass {
public:
    PluginPass(std::shared_ptr<const PluginLibrary> library, std::size_t index)
        : library_(std::move(library)), declared_(library_->passes[index]), table_(declared_.table),
          host_(makeHost(*library_)) {
        if (table_.create == nullptr)
            return;
        call("create", [&](hone_error* error) { return table_.create(&host_, &pass_, error); });
        if (pass_ == nullptr)
            fail("create said that all is well, but made nothing");
    }

    ~PluginPass() override {
        try {
            if (pass_ != nullptr)
                table_.destroy(pass_);
        } catch (...) {
            logger().warn("{}: destroy threw an exception", who());
        }
    }

    PluginPass(const PluginPass&) = delete;
    PluginPass& operator=(const PluginPass&) = delete;

    void execute(PassContext& context) override {
        node_ = context.pass_name;
        context_ = &context;
        unknown_counter_.reset();
        showInputs();
        showOutputs();
        const hone_run run = makeRun();
        bool gave_up = false;
        call("execute", [&](hone_error* error) {
            const hone_status status = table_.execute(pass_, &host_, &run, error);
            gave_up = status == HONE_INTERRUPTED;
            return gave_up ? hone_status{HONE_OK} : status;
        });
        if (unknown_counter_)
            fail("execute counted by counter " + std::to_string(*unknown_counter_) + " of " +
                 std::to_string(declared_.counters.size()));
        if (gave_up && !context.interrupt.isDue())
            fail("execute gave up, although nobody had asked it to");
        if (gave_up)
            throw Interrupted();
        takeOutputs();
    }

private:
    std::string who() const {
        const std::string& type = declared_.type.name;
        return "plug-in " + printable(library_->info.file) + ": " +
               (node_.empty() ? "pass type \"" + type + "\""
                              : "pass \"" + node_ + "\" (" + type + ")");
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw PluginError(who() + ": " + what);
    }

    template <class Function> void call(const char* name, const Function& function) const {
        callPlugin([this] { return who(); }, name, function);
    }

    /// The edges of a node stay what they are; what flows over them does not.
    void showInputs() {
        std::size_t edges = 0, words = 0;
        for (const InPort& port : declared_.type.inputs)
            for (const BoundPort& bound : context_->inputs)
                if (bound.name == port.name) {
                    ++edges;
                    words += port.edge_params.size();
                }
        inputs_.resize(edges);
        shown_inputs_.resize(edges);
        edge_words_.resize(words);
        params_.resize(declared_.type.params.size());
        writeWords(declared_.type, *context_->params, params_);

        std::size_t edge = 0;
        hone_word* word = edge_words_.data();
        for (std::uint32_t i = 0; i < declared_.type.inputs.size(); ++i) {
            const InPort& port = declared_.type.inputs[i];
            for (const BoundPort& bound : context_->inputs) {
                if (bound.name != port.name)
                    continue;
                hone_input& input = inputs_[edge];
                input = bound.value != nullptr ? show(*bound.value) : hone_input{};
                input.struct_size = sizeof input;
                input.port = i;
                input.params = word;
                for (std::size_t k = 0; k < port.edge_params.size(); ++k)
                    *word++ = wordOf(port.edge_params[k], bound.edge_params != nullptr
                                                              ? (*bound.edge_params)[k]
                                                              : port.edge_params[k].fallback);
                shown_inputs_[edge++] = &input;
            }
        }
    }

    hone_input show(const Value& value) {
        hone_input input{};
        if (value.type->stride != 0) {
            input.data = value.buffer.data;
            input.count = value.count;
        }
        input.width = value.extent.x;
        input.height = value.extent.y;
        input.version = value.version;
        input.camera = reinterpret_cast<const hone_camera*>(value.camera);
        if (value.scene != nullptr) {
            if (scene_version_ != value.scene->version) {
                access_.emplace(*value.scene);
                scene_ = makeScene(*value.scene, *access_);
                scene_version_ = value.scene->version;
            }
            input.scene = &scene_;
        }
        return input;
    }

    void showOutputs() {
        const std::vector<OutPort>& ports = declared_.type.outputs;
        outputs_.resize(ports.size());
        shown_outputs_.resize(ports.size());
        for (std::size_t i = 0; i < ports.size(); ++i) {
            const Value& value = context_->out(ports[i].name);
            const bool is_made = value.type->shape == Shape::kList &&
                                 ports[i].in_place_of.empty() && !context_->goes_on;
            outputs_[i] = {.struct_size = sizeof(hone_output),
                           .width = value.extent.x,
                           .height = value.extent.y,
                           .reserved = 0,
                           .data = value.buffer.data,
                           .count = is_made ? 0 : value.count,
                           .capacity = value.buffer.bytes / value.type->stride};
            shown_outputs_[i] = &outputs_[i];
        }
    }

    void takeOutputs() {
        const std::vector<OutPort>& ports = declared_.type.outputs;
        for (std::size_t i = 0; i < ports.size(); ++i) {
            Value& value = context_->out(ports[i].name);
            const std::size_t capacity = value.buffer.bytes / value.type->stride;
            const auto refuse = [&](const std::string& why) {
                fail("output \"" + ports[i].name + "\": " + why);
            };
            if (value.type->shape == Shape::kList) {
                if (outputs_[i].count > capacity)
                    refuse("it says that " + std::to_string(outputs_[i].count) +
                           " elements are valid, but there is room for " +
                           std::to_string(capacity));
                value.count = static_cast<uint>(outputs_[i].count);
            }
            const Scene* scene = access_ ? access_->scene : nullptr;
            if (const std::string why = whyNotUsable(value, context_->extent, scene); !why.empty())
                refuse(why);
        }
    }

    hone_run makeRun() {
        return {.struct_size = sizeof(hone_run),
                .iteration = context_->iteration,
                .hone = this,
                .node = node_.c_str(),
                .width = context_->extent.x,
                .height = context_->extent.y,
                .seed = context_->seed,
                .inputs = shown_inputs_.data(),
                .input_count = shown_inputs_.size(),
                .outputs = shown_outputs_.data(),
                .output_count = shown_outputs_.size(),
                .params = params_.data(),
                .param_count = params_.size(),
                .is_due = isDue,
                .goes_on = context_->goes_on ? 1u : 0u,
                .reserved = 0,
                .count = count};
    }

    static PluginPass& of(const hone_run* run) { return *static_cast<PluginPass*>(run->hone); }

    static std::int32_t isDue(const hone_run* run) noexcept {
        return of(run).context_->interrupt.isDue() ? 1 : 0;
    }

    static void count(const hone_run* run, std::uint32_t counter, std::uint64_t amount) noexcept {
        PluginPass& pass = of(run);
        if (counter < pass.declared_.counters.size())
            pass.context_->counters->add(pass.declared_.counters[counter], amount);
        else
            pass.unknown_counter_ = counter;
    }

    std::shared_ptr<const PluginLibrary> library_; // first: the code goes last
    const PluginPassType& declared_;
    const hone_pass_type& table_;
    const hone_host host_;
    hone_pass* pass_ = nullptr;

    PassContext* context_ = nullptr; ///< while it executes
    std::string node_;               ///< "" until it does
    std::optional<std::uint32_t> unknown_counter_;
    std::uint64_t scene_version_ = 0;
    std::optional<SceneAccess> access_;
    hone_scene scene_{};
    std::vector<hone_input> inputs_;
    std::vector<const hone_input*> shown_inputs_;
    std::vector<hone_output> outputs_;
    std::vector<hone_output*> shown_outputs_;
    std::vector<hone_word> params_, edge_words_;
};

} // namespace

PassType makePluginPassType(std::shared_ptr<const PluginLibrary> library, std::size_t index) {
    PassType type = library->passes[index].type;
    for (std::size_t i = 0; i < type.outputs.size(); ++i)
        if (library->passes[index].sizes[i] != nullptr)
            type.outputs[i].size = PluginSize(library, index, i);
    type.domain = Domain::kHost;
    type.create = [library = std::move(library), index] {
        return std::make_unique<PluginPass>(library, index);
    };
    return type;
}

} // namespace hone
