// SPDX-License-Identifier: Apache-2.0
#include "hone/core/graph/upgrade.h"

#include "hone/core/graph/json_reader.h"

#include <algorithm>
#include <functional>

namespace hone {
namespace {

using Kind = JsonValue::Kind;

JsonMember* member(JsonValue& object, std::string_view key) {
    const auto found = std::ranges::find(object.members, key, &JsonMember::key);
    return found != object.members.end() ? &*found : nullptr;
}

class Upgrade {
public:
    explicit Upgrade(const SourceText& source) : source_(&source) {}

    /// To version 2: the mask that error.shadow was is error.kbm10, for error.shadow is now the
    /// penumbra search, which needs shadow_ranges; difference is measure.error.
    void toVersion2(JsonValue& root) {
        forEachPass(root, "", [&](JsonValue& pass, const std::string& pointer) {
            JsonMember* type = member(pass, "type");
            if (type == nullptr || type->value.kind != Kind::kString)
                return;
            JsonMember* in = member(pass, "in");
            const bool has_ranges = in != nullptr && member(in->value, "shadow_ranges") != nullptr;
            if (type->value.text == "difference")
                rename(type->value, pointer + "/type", "measure.error");
            else if (type->value.text == "error.shadow" && !has_ranges)
                rename(type->value, pointer + "/type", "error.kbm10");
        });
    }

    void setVersion(JsonValue& root) {
        JsonMember* version = member(root, "hone");
        const std::string now = std::to_string(kGraphVersion);
        edits.push_back({version->value.span,
                         now,
                         {version->value.span, "/hone", source_},
                         "the format's version is " + now});
        version->value.number = kGraphVersion;
    }

    std::vector<UpgradeEdit> edits;

private:
    using Visit = std::function<void(JsonValue& pass, const std::string& pointer)>;

    /// Visits all passes below "passes" of a graph or a loop.
    void forEachPass(JsonValue& body, const std::string& pointer, const Visit& visit) {
        JsonMember* passes = member(body, "passes");
        if (passes == nullptr)
            return;
        for (JsonMember& pass : passes->value.members) {
            const std::string at = pointerTo(pointer + "/passes", pass.key);
            visit(pass.value, at);
            if (JsonMember* loop = member(pass.value, "loop"))
                forEachPass(loop->value, at + "/loop", visit);
        }
    }

    void rename(JsonValue& type, const std::string& pointer, const std::string& now) {
        edits.push_back({type.span,
                         "\"" + now + "\"",
                         {type.span, pointer, source_},
                         "pass type \"" + type.text + "\" is \"" + now + "\" since version 2"});
        type.text = now;
    }

    const SourceText* source_;
};

} // namespace

std::vector<UpgradeEdit> upgradeTree(JsonValue& root, int version, const SourceText& source) {
    Upgrade upgrade(source);
    if (version < 2)
        upgrade.toVersion2(root);
    if (version < kGraphVersion)
        upgrade.setVersion(root);
    return std::move(upgrade.edits);
}

UpgradedText upgradeText(const SourceText& source, std::vector<Diagnostic>& diagnostics) {
    UpgradedText result;
    result.text = source.text();
    Reporter reporter(source, diagnostics);
    JsonValue root;
    if (!parseJson(source, reporter, root))
        return result;
    const std::optional<int> version = readVersion(JsonReader(reporter), {&root, "", &source});
    if (!version)
        return result;
    result.edits = upgradeTree(root, *version, source);
    // From the end, so that what is still to be replaced stays where it was.
    std::ranges::sort(result.edits, std::ranges::greater{},
                      [](const UpgradeEdit& edit) { return edit.span.begin; });
    for (const UpgradeEdit& edit : result.edits)
        result.text.replace(edit.span.begin, edit.span.length, edit.replacement);
    std::ranges::reverse(result.edits);
    result.is_valid = true;
    return result;
}

} // namespace hone
