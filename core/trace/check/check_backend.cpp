// SPDX-License-Identifier: Apache-2.0
#include "hone/core/trace/check/check_backend.h"

#include "hone/core/error.h"
#include "hone/core/log.h"
#include "hone/core/printable.h"
#include "hone/core/trace/check/query_kind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace hone {
namespace {

/// Rays of a list whose answers are held against the geometry: so many, and one of so many more.
constexpr std::size_t kJudged = 16, kJudgedOneOf = 512;
/// Rays of a list that are asked again.
constexpr std::size_t kAskedAgain = 64;

bool isFinite(vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

class CheckBackend final : public TraceBackend {
public:
    CheckBackend(std::unique_ptr<TraceBackend> first, std::unique_ptr<TraceBackend> second,
                 CheckReport* report)
        : first_(std::move(first)), second_(std::move(second)),
          report_(report != nullptr ? report : &own_report_) {
        names_ = {first_->caps().name, second_ != nullptr ? second_->caps().name : ""};
    }

    TraceCaps caps() const override {
        TraceCaps caps = first_->caps();
        caps.name = "check(" + names_[0] + (second_ != nullptr ? "," + names_[1] : "") + ")";
        if (second_ != nullptr) {
            const TraceCaps others = second_->caps();
            caps.masked = caps.masked && others.masked;
            caps.updates = caps.updates && others.updates;
            caps.is_reference = caps.is_reference || others.is_reference;
        }
        return caps;
    }

    std::size_t copiedBytes() const override {
        return first_->copiedBytes() + (second_ != nullptr ? second_->copiedBytes() : 0);
    }

    BuildStats build(const Scene& scene, const SceneBuffers* shared) override {
        scene_ = nullptr;
        explainer_.emplace(scene);
        requireMasks(scene);
        BuildStats stats = first_->build(scene, shared);
        if (second_ != nullptr)
            add(stats, second_->build(scene, shared));
        scene_ = &scene;
        version_ = scene.version;
        return stats;
    }

    BuildStats update(std::span<const uint> moved) override {
        require(scene_ != nullptr, "update() was called before build()");
        require(std::ranges::adjacent_find(moved, std::greater_equal<>()) == moved.end() &&
                    (moved.empty() || moved.back() < scene_->instances.size()),
                "update() was called with instances that do not ascend or are not there");
        BuildStats stats = first_->update(moved);
        if (second_ != nullptr)
            add(stats, second_->update(moved));
        version_ = scene_->version;
        return stats;
    }

    void closest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                 const TraceOptions& options) const override {
        check<ClosestKind>(rays, hits, other_hits_, coherence, options, report_->closest);
    }
    void occluded(std::span<const Ray> rays, std::span<uint> occluded, Coherence coherence,
                  const TraceOptions& options) const override {
        check<OccludedKind>(rays, occluded, other_occluded_, coherence, options, report_->occluded);
    }

private:
    static void add(BuildStats& stats, const BuildStats& more) {
        stats.ms += more.ms;
        stats.bytes += more.bytes;
        stats.copied_bytes += more.copied_bytes;
    }

    void require(bool holds, const std::string& otherwise) const {
        if (!holds)
            throw CheckFailed(caps().name + ": " + otherwise);
    }

    void requireMasks(const Scene& scene) const {
        const bool has_masks = std::ranges::any_of(scene.materials, [](const Material& material) {
            return (material.flags & kMaterialMasked) != 0;
        });
        for (const TraceBackend* backend : {first_.get(), second_.get()})
            require(!has_masks || backend == nullptr || backend->caps().masked,
                    "the scene has masked materials, which \"" +
                        (backend == nullptr ? "" : backend->caps().name) +
                        "\" says it does not honour (TraceCaps::masked)");
    }

    template <class Kind>
    void check(std::span<const Ray> rays, std::span<typename Kind::Answer> answers,
               std::vector<typename Kind::Answer>& others, Coherence coherence,
               const TraceOptions& options, CheckCounts& counts) const {
        require(rays.size() == answers.size(),
                std::string("a list of ") + std::to_string(rays.size()) + " rays came with " +
                    std::to_string(answers.size()) + " answers");
        require(scene_ != nullptr, "a query came before build()");
        require(scene_->version == version_,
                "the scene changed after build(): build again, or update() after moveInstance()");
        ++counts.lists;
        counts.rays += rays.size();
        countSpoiled(rays);

        std::ranges::fill(answers, Kind::kUnwritten);
        Kind::ask(*first_, rays, answers, coherence, options);
        requirePossible<Kind>(names_[0], rays, answers);
        askAgain<Kind>(rays, answers);
        judge<Kind>(rays, answers, counts);
        if (second_ == nullptr)
            return;
        others.assign(rays.size(), Kind::kUnwritten);
        Kind::ask(*second_, rays, std::span(others), coherence, options);
        requirePossible<Kind>(names_[1], rays, std::span<const typename Kind::Answer>(others));
        compare<Kind>(rays, answers, others, counts);
    }

    void countSpoiled(std::span<const Ray> rays) const {
        for (const Ray& ray : rays)
            if (!isFinite(ray.origin) || !isFinite(ray.direction)) {
                if (report_->spoiled_rays++ == 0)
                    logger().warn("{}: a ray that is not finite came: {}", caps().name,
                                  toText(ray));
            }
    }

    template <class Kind>
    void requirePossible(const std::string& name, std::span<const Ray> rays,
                         std::span<const typename Kind::Answer> answers) const {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (Kind::isSame(answers[i], Kind::kUnwritten))
                fail<Kind>(rays, i, "\"" + name + "\" left its answer unwritten");
            if (!Kind::isPossible(*scene_, answers[i]))
                fail<Kind>(rays, i,
                           "\"" + name +
                               "\" answers what is not there: " + Kind::text(*scene_, answers[i]));
        }
    }

    /// Exact answers depend neither on the list nor on coherence.
    template <class Kind>
    void askAgain(std::span<const Ray> rays, std::span<const typename Kind::Answer> answers) const {
        std::vector<std::size_t> picked = pick(rays.size(), kAskedAgain);
        std::vector<Ray> again;
        for (const std::size_t i : picked)
            again.push_back(rays[i]);
        std::vector<typename Kind::Answer> coherent(again.size(), Kind::kUnwritten);
        std::vector<typename Kind::Answer> incoherent = coherent;
        Kind::ask(*first_, again, std::span(coherent), Coherence::kCoherent, {.exact = true});
        Kind::ask(*first_, again, std::span(incoherent), Coherence::kIncoherent, {.exact = true});
        const bool is_exact = first_->caps().always_exact;
        for (std::size_t i = 0; i < picked.size(); ++i) {
            const auto answer = answers[picked[i]];
            const auto say = [&](const char* what, auto now, auto before) {
                fail<Kind>(rays, picked[i],
                           "\"" + names_[0] + "\" " + what + ": " + Kind::text(*scene_, now) +
                               " now, " + Kind::text(*scene_, before) + " before");
            };
            if (!Kind::isSame(coherent[i], incoherent[i]))
                say("answers it otherwise in an incoherent list, although exact", incoherent[i],
                    coherent[i]);
            if (Kind::isSame(coherent[i], answer))
                continue;
            if (is_exact || Kind::explain(*explainer_, again[i], answer, coherent[i]).kind ==
                                DifferenceKind::kUnexplained)
                say("answers it otherwise in other company", coherent[i], answer);
        }
    }

    template <class Kind>
    void judge(std::span<const Ray> rays, std::span<const typename Kind::Answer> answers,
               CheckCounts& counts) const {
        for (const std::size_t i : pick(rays.size(), kJudged + rays.size() / kJudgedOneOf)) {
            ++counts.judged;
            const Difference verdict = Kind::explain(*explainer_, rays[i], answers[i], answers[i]);
            if (verdict.kind == DifferenceKind::kUnexplained)
                fail<Kind>(rays, i,
                           "\"" + names_[0] + "\" is wrong: it answers " +
                               Kind::text(*scene_, answers[i], verdict.t_a) + "; " +
                               witnessText(*scene_, verdict));
        }
    }

    template <class Kind>
    void compare(std::span<const Ray> rays, std::span<const typename Kind::Answer> answers,
                 std::span<const typename Kind::Answer> others, CheckCounts& counts) const {
        const std::uint64_t before = counts.unexplained;
        const auto first = compareAnswers<Kind>(*explainer_, rays, answers, others, counts);
        if (!first)
            return;
        const std::size_t i = first->ray;
        throw CheckFailed(place<Kind>(rays, i) +
                          "the answers differ, and rounding does not explain it\n" +
                          describeDifference<Kind>(*scene_, rays[i], first->difference, names_[0],
                                                   answers[i], names_[1], others[i]) +
                          "\n  so do " + std::to_string(counts.unexplained - before - 1) +
                          " more rays of this list");
    }

    template <class Kind>
    [[nodiscard]] std::string place(std::span<const Ray> rays, std::size_t i) const {
        return caps().name + ": " + Kind::kName + " " + std::to_string(i) + " of " +
               std::to_string(rays.size()) + ", scene \"" + printable(scene_->name) + "\": ";
    }

    template <class Kind>
    [[noreturn]] void fail(std::span<const Ray> rays, std::size_t i,
                           const std::string& what) const {
        throw CheckFailed(place<Kind>(rays, i) + what + "\n  ray: " + toText(rays[i]));
    }

    /// At most `most` numbers below `count`, evenly spread.
    static std::vector<std::size_t> pick(std::size_t count, std::size_t most) {
        std::vector<std::size_t> picked(std::min(count, most));
        for (std::size_t i = 0; i < picked.size(); ++i)
            picked[i] = i * count / picked.size();
        return picked;
    }

    std::unique_ptr<TraceBackend> first_, second_;
    std::array<std::string, 2> names_;
    CheckReport own_report_;
    CheckReport* report_;
    const Scene* scene_ = nullptr;
    std::uint64_t version_ = 0;
    std::optional<DifferenceExplainer> explainer_;
    mutable std::vector<Hit> other_hits_;
    mutable std::vector<uint> other_occluded_;
};

} // namespace

std::unique_ptr<TraceBackend> makeCheckBackend(std::unique_ptr<TraceBackend> first,
                                               std::unique_ptr<TraceBackend> second,
                                               CheckReport* report) {
    return std::make_unique<CheckBackend>(std::move(first), std::move(second), report);
}

} // namespace hone
