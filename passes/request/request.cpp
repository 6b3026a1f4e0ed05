// SPDX-License-Identifier: Apache-2.0
//
// request: takes the next batch of pixels to trace.
//
// Each execution lists the next pixels of the order, in tile order, as packets of rays want them.
// Once every pixel had its turn it begins again with the following samples, until all `samples` are
// requested; then the list is empty. Sample numbers, not time, say what is traced, so the final
// image depends neither on the order nor on the batch.
//
// Without accumulation all pixels of a visit get the same samples. With it, a pixel gets
// `per_visit` samples, or as many as `counts` says, after those that it has, until it has all;
// finished pixels are passed over. A batch ends when it has `batch` pixels or its samples would be
// more than `max_samples`, and at the end of the order. An order of sort's strategy select is in
// tile order within its batches, so `max_samples` cuts those by place, not by error; radix is
// exact.
//
// in   order  PixelList (optional): whom to trace first; without it all pixels in tile order
// in   state  Cursor (optional): how many batches were taken (with accumulation: the place in the
//                                order that is next); without it begins at the first
// in   error  Error (optional): only tells `worst` and the counter
// in   counts        SampleCounts (optional): samples of each pixel's visits; needs accumulation
// in   accumulation  Accumulation (optional): what was traced so far
// out  requests  RequestList: (pixel, first sample, sample count)
// out  state  Cursor, in place
// out  worst  Scalar: greatest expected error of the batch, for a loop's stop rule "below"; 0 of an
//             empty one; without `error` as great as can be, so that it is below nothing
// params  batch        pixels in a batch (8192); 0 = all
//         samples      samples per pixel when finished (1)
//         per_visit    samples per pixel in one batch; 0 = all of them at once
//         max_samples  samples in a batch, each a primary ray and what follows it; at least one
//                      pixel is requested; needs accumulation; 0 = no limit
// counters  pixels  requested, again in each visit
//           worst_expect_bits  greatest expected error of the batch, as the bits of a float
//
//     "request": { "type": "request", "in": { "order": "sort.order", "state": "~state" },
//                  "params": { "batch": "$batch", "samples": "$samples" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5 (requests for the worst pixels first, and
// more often).
#include "hone/core/error.h"
#include "hone/core/image/tile_order.h"
#include "hone/core/trace/sample.glsl.h"
#include "hone/passes/passes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace hone {
namespace {

class RequestPass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const TileOrder tiles(context.extent);
        Value& out = context.out("requests");
        out.count = 0;
        const std::size_t pixels = std::size_t{context.extent.x} * context.extent.y;
        const uint wanted = context.param<uint>("batch");
        const std::size_t batch = wanted == 0 ? pixels : wanted;
        if (context.has("accumulation"))
            requestMissing(context, tiles, batch, out);
        else
            requestVisit(context, tiles, batch, out);

        context.counters->add("pixels", out.count);
        float& worst = context.out("worst").as<float>().front();
        worst = out.count == 0 ? 0.0f : std::numeric_limits<float>::max();
        if (out.count > 0 && context.has("error")) {
            worst = worstExpect(context.in("error").as<vec2>(), out.as<uvec3>());
            context.counters->set("worst_expect_bits", std::bit_cast<uint>(worst));
        }
    }

private:
    static float worstExpect(std::span<const vec2> error, std::span<const uvec3> requests) {
        float worst = 0;
        for (const uvec3& request : requests)
            worst = std::max(worst, error[request.x].x);
        return worst;
    }

    /// The next batch, where all pixels of a visit get the same samples.
    void requestVisit(PassContext& context, const TileOrder& tiles, std::size_t batch, Value& out) {
        if (context.has("counts") || context.param<uint>("max_samples") > 0)
            throw GraphError("pass \"" + std::string(context.pass_name) +
                             "\": what each pixel lacks must be known for the input "
                             "\"counts\" and the parameter \"max_samples\"; connect the "
                             "carried accumulation to the input \"accumulation\"");
        const std::size_t pixels = std::size_t{context.extent.x} * context.extent.y;
        const std::size_t listed = context.has("order") ? context.in("order").count : pixels;
        uint& batches_taken = context.out("state").as<uint>().front();

        // Where the cursor stands: which visit, which batch of it.
        const std::size_t batches = (listed + batch - 1) / batch;
        const uint samples = context.param<uint>("samples");
        const uint per_visit = context.param<uint>("per_visit");
        const uint visit_samples = per_visit == 0 ? samples : std::min(per_visit, samples);
        if (batches == 0 || batches_taken / batches * visit_samples >= samples)
            return;
        const uint first_sample = static_cast<uint>(batches_taken / batches) * visit_samples;
        const uint sample_count = std::min(visit_samples, samples - first_sample);
        const std::size_t begin = batches_taken % batches * batch;
        const std::size_t count = std::min(batch, listed - begin);

        const std::span<uvec3> requests = out.capacity<uvec3>().first(count);
        if (context.has("order"))
            requestListed(
                tiles, context.in("order").as<uint>().subspan(begin, count),
                [&](uint pixel) { return uvec3(pixel, first_sample, sample_count); }, requests);
        else
            requestRanks(tiles, begin, uvec3(0, first_sample, sample_count), requests);
        out.count = static_cast<uint>(count);
        ++batches_taken;
    }

    /// The next pixels that lack samples, each from the first that it lacks.
    void requestMissing(PassContext& context, const TileOrder& tiles, std::size_t batch,
                        Value& out) {
        const std::span<const uint> order =
            context.has("order") ? context.in("order").as<uint>() : allPixels(tiles);
        const std::span<const Accumulated> taken = context.in("accumulation").as<Accumulated>();
        const std::span<const uint> counts =
            context.has("counts") ? context.in("counts").as<uint>() : std::span<uint>();
        const uint samples = context.param<uint>("samples");
        const uint per_visit = context.param<uint>("per_visit");
        const uint max_samples = context.param<uint>("max_samples");
        const auto request = [&](uint pixel) {
            const uint visit = !counts.empty()  ? std::max(counts[pixel], 1u)
                               : per_visit == 0 ? samples
                                                : per_visit;
            const uint first = std::min(taken[pixel].count, samples);
            return uvec3(pixel, first, std::min(visit, samples - first));
        };

        // From the cursor to the end of the order; from its begin if nothing is missing there.
        chosen_.clear();
        std::uint64_t chosen_samples = 0;
        std::size_t next = context.out("state").as<uint>().front();
        for (std::size_t seen = 0; seen < order.size() && chosen_.size() < batch; ++seen) {
            if (next >= order.size()) {
                if (!chosen_.empty())
                    break;
                next = 0;
            }
            const uint count = request(order[next]).z;
            if (count > 0) {
                chosen_samples += count;
                if (max_samples > 0 && chosen_samples > max_samples && !chosen_.empty())
                    break;
                chosen_.push_back(order[next]);
            }
            ++next;
        }
        context.out("state").as<uint>().front() = static_cast<uint>(next);
        requestListed(tiles, chosen_, request, out.capacity<uvec3>().first(chosen_.size()));
        out.count = static_cast<uint>(chosen_.size());
    }

    std::span<const uint> allPixels(const TileOrder& tiles) {
        if (all_extent_ == tiles.extent())
            return all_pixels_;
        all_pixels_.clear();
        for (uint tile = 0; tile < tiles.tiles().x * tiles.tiles().y; ++tile)
            tiles.forEachPixel(tile, [&](uint pixel) { all_pixels_.push_back(pixel); });
        all_extent_ = tiles.extent();
        return all_pixels_;
    }

    /// request(pixel) for the pixels of the list, each of which is in it once, in tile order.
    template <class Request>
    void requestListed(const TileOrder& tiles, std::span<const uint> pixels, const Request& request,
                       std::span<uvec3> requests) {
        if (copyWhileInOrder(tiles, pixels, request, requests))
            return;
        // A bit for each place in tile order sorts them.
        is_requested_.assign((tiles.keyCount() + 63) / 64, 0);
        for (uint pixel : pixels) {
            const uint key = tiles.key(pixel);
            is_requested_[key / 64] |= std::uint64_t{1} << (key % 64);
        }
        std::size_t next = 0;
        for (std::size_t word = 0; word < is_requested_.size(); ++word)
            for (std::uint64_t bits = is_requested_[word]; bits != 0; bits &= bits - 1)
                requests[next++] = request(tiles.pixelOfKey(
                    static_cast<uint>(word * 64 + static_cast<uint>(std::countr_zero(bits)))));
    }

    /// False when the list is not in tile order, as that of sort's strategy radix.
    template <class Request>
    static bool copyWhileInOrder(const TileOrder& tiles, std::span<const uint> pixels,
                                 const Request& request, std::span<uvec3> requests) {
        uint next_key = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const uint key = tiles.key(pixels[i]);
            if (key < next_key)
                return false;
            next_key = key + 1;
            requests[i] = request(pixels[i]);
        }
        return true;
    }

    /// The pixels of ranks begin, begin + 1, ... in tile order.
    static void requestRanks(const TileOrder& tiles, std::size_t begin, uvec3 request,
                             std::span<uvec3> requests) {
        const auto first = static_cast<uint>(begin);
        const uint last = first + static_cast<uint>(requests.size()) - 1;
        tbb::parallel_for(tiles.tileOfRank(first), tiles.tileOfRank(last) + 1, [&](uint tile) {
            uint rank = tiles.firstRank(tile);
            uvec3 mine = request;
            tiles.forEachPixel(tile, [&](uint pixel) {
                if (rank >= first && rank <= last) {
                    mine.x = pixel;
                    requests[rank - first] = mine;
                }
                ++rank;
            });
        });
    }

    std::vector<std::uint64_t> is_requested_; ///< by key
    std::vector<uint> chosen_;
    std::vector<uint> all_pixels_; ///< in tile order, of an image of this size:
    uvec2 all_extent_{0, 0};
};

std::size_t batchSize(const SizeQuery& query) {
    const std::size_t pixels = std::size_t{query.extent.x} * query.extent.y;
    const uint batch = query.params.get<uint>("batch");
    return batch == 0 ? pixels : std::min<std::size_t>(batch, pixels);
}

} // namespace

PassType requestPass() {
    return PassType("request", "Takes the next batch of pixels to trace")
        .inOptional("order", types::kPixelList, "whom to trace first; none: all, in tile order")
        .inOptional("state", types::kCursor, "how far the order was requested; none: begins anew")
        .inOptional("error", types::kError, "what \"worst\" and progress tell; changes no request")
        .inOptional("counts", types::kSampleCounts, "samples of each pixel's visits")
        .inOptional("accumulation", types::kAccumulation, "what was traced so far")
        .out("requests", types::kRequestList, "the batch, in tile order; empty when all is done",
             batchSize)
        .outInPlace("state", types::kCursor, "state", "a batch further",
                    [](const SizeQuery&) { return std::size_t{1}; })
        .out("worst", types::kScalar, "greatest expected error of the batch",
             [](const SizeQuery&) { return std::size_t{1}; })
        .param("batch", 8192u, {.min = 0, .max = {}}, "pixels in a batch; 0 = all")
        .param("samples", 1u, {.min = 1, .max = {}}, "samples per pixel when finished")
        .param("per_visit", 0u, {.min = 0, .max = {}},
               "samples per pixel in one batch; 0 = all of them at once")
        .param("max_samples", 0u, {.min = 0, .max = {}},
               "samples in a batch, given the accumulation; 0 = no limit")
        .implementedBy<RequestPass>(Domain::kHost);
}

} // namespace hone
